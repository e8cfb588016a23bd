//! The colours of places on a mesh: each has that of the contact nearest to it, on ground that faces a similar way.

use std::collections::HashMap;

use nalgebra::{Point3, Vector3};
use plotters::style::RGBColor;

/// The cosine of the greatest angle between the normals of a place and of a contact whose colour it has.
const SIMILAR: f64 = 0.7;
/// A place has the colour of a contact at most so many mean distances of contacts away.
const REACH: f64 = 3.0;
/// The period of the stripes of a striped colour, pixels, and their width.
const STRIPES: (usize, usize) = (26, 3);

/// A contact with its class.
#[derive(Clone, Copy, Debug)]
pub(super) struct PaintedContact {
    pub(super) point: Point3<f64>,
    pub(super) normal: Vector3<f64>,
    pub(super) class: u8,
    /// Whether its colour has stripes.
    pub(super) striped: bool,
}

/// The colours of the classes of contacts, and which contact is near a place.
pub(super) struct Paint {
    contacts: Vec<PaintedContact>,
    /// The contacts in each cube of a grid.
    cubes: HashMap<[i64; 3], Vec<u32>>,
    /// The side of a cube, and the greatest distance of a contact whose colour a place has.
    reach_m: f64,
    /// That of places without a contact nearby is the last one.
    colours: Vec<[u8; 3]>,
}

/// What a pixel of a place has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// A colour, by its number.
    Colour(u8),
    /// A stripe over it.
    Stripe,
}

impl Paint {
    /// From contacts that are some distance apart in the mean, and the colours of their classes. `none`: the colour of places without a contact
    /// nearby.
    pub(super) fn new(contacts: Vec<PaintedContact>, spacing_m: f64, (colours, none): (&[RGBColor], RGBColor)) -> Self {
        let reach_m = (REACH * spacing_m).max(f64::MIN_POSITIVE);
        let mut cubes: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (number, contact) in (0..).zip(&contacts) {
            cubes.entry(cube(&contact.point, reach_m)).or_default().push(number);
        }
        let colours = colours.iter().chain([&none]).map(|RGBColor(r, g, b)| [*r, *g, *b]).collect();
        Self { contacts, cubes, reach_m, colours }
    }

    /// The colours by their numbers.
    pub(super) fn colours(&self) -> &[[u8; 3]] {
        &self.colours
    }

    /// The tone of a place whose facet has this normal, in a pixel of a row and a column.
    pub(super) fn of(&self, place: &Point3<f64>, normal: &Vector3<f64>, (row, column): (usize, usize)) -> Tone {
        let (period, width) = STRIPES;
        match self.nearest(place, normal) {
            None => Tone::Colour(u8::try_from(self.colours.len() - 1).unwrap_or(u8::MAX)),
            Some(contact) if contact.striped && (row + column) % period < width => Tone::Stripe,
            Some(contact) => Tone::Colour(contact.class),
        }
    }

    /// The contact nearest to a place, on ground that faces a similar way.
    fn nearest(&self, place: &Point3<f64>, normal: &Vector3<f64>) -> Option<&PaintedContact> {
        let middle = cube(place, self.reach_m);
        let (mut best, mut least_m2) = (None, self.reach_m * self.reach_m);
        for step in 0..27_i64 {
            let beside = [step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1];
            let cell = [0, 1, 2].map(|axis| middle[axis].saturating_add(beside[axis]));
            for number in self.cubes.get(&cell).into_iter().flatten() {
                let contact = &self.contacts[*number as usize];
                let away_m2 = (contact.point - place).norm_squared();
                if away_m2 < least_m2 && contact.normal.dot(normal) >= SIMILAR {
                    (best, least_m2) = (Some(contact), away_m2);
                }
            }
        }
        best
    }
}

/// The cube of a grid in which a point lies.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, far from any mesh")]
fn cube(point: &Point3<f64>, side_m: f64) -> [i64; 3] {
    [point.x, point.y, point.z].map(|coordinate| (coordinate / side_m).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Draw;

    #[test]
    fn a_place_has_the_colour_of_the_nearest_contact_that_faces_its_way() {
        let draw = &mut Draw::seeded(2101);
        let normals = [Vector3::z(), Vector3::x(), -Vector3::z()];
        let contacts: Vec<PaintedContact> = (0..200_u8)
            .map(|number| PaintedContact {
                point: Point3::new(draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0), draw.uniform(-1.0, 1.0)),
                normal: normals[usize::from(number % 3)],
                class: number % 5,
                striped: number % 4 == 0,
            })
            .collect();
        let colours = [RGBColor(1, 0, 0), RGBColor(2, 0, 0), RGBColor(3, 0, 0), RGBColor(4, 0, 0), RGBColor(5, 0, 0)];
        let paint = Paint::new(contacts.clone(), 0.4, (&colours, RGBColor(9, 9, 9)));
        assert_eq!((paint.colours().len(), paint.colours()[5]), (6, [9, 9, 9]));
        let (mut near, mut far) = (0, 0);
        for _ in 0..2000 {
            let place = Point3::new(draw.uniform(-7.0, 7.0), draw.uniform(-7.0, 7.0), draw.uniform(-1.5, 1.5));
            let normal = Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)).normalize();
            let away = |contact: &&PaintedContact| (contact.point - place).norm();
            let similar = contacts.iter().filter(|contact| contact.normal.dot(&normal) >= SIMILAR);
            let expected = similar.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|contact| away(contact) < REACH * 0.4);
            // Off the stripes, and on one.
            let plain = Tone::Colour(expected.map_or(5, |contact| contact.class));
            assert_eq!(paint.of(&place, &normal, (STRIPES.1, 0)), plain);
            let has_stripe = expected.is_some_and(|contact| contact.striped);
            assert_eq!(paint.of(&place, &normal, (0, 0)), if has_stripe { Tone::Stripe } else { plain });
            if expected.is_some() { near += 1 } else { far += 1 }
        }
        assert!(near > 300 && far > 300, "{near} {far}");
    }
}

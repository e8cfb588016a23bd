//! Legs between posts: all legs of one offset cross the same edges and facets, so that these are found once.

use nalgebra::Vector2;

use crate::terrain::GeoReference;

/// A position within this many post spacings of a line of the lattice is on it, as in [`slice`](crate::terrain::slice()).
const ON_THE_LINE: f64 = 1e-9;

/// A post, in columns to the east and rows to the south of the leg's beginning.
pub(super) type Place = (i32, i32);

/// The half of a square of posts: north-east or south-west of its diagonal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    NorthEast,
    SouthWest,
}

/// A triangle of the DEM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Facet {
    /// Column and row of the north-west post of its square.
    square: Place,
    half: Half,
}

impl Facet {
    /// Its posts: the gradient is (first - second) per column to the east and (third - last) per row to the north.
    pub(super) const fn corners(self) -> [Place; 4] {
        let (col, row) = self.square;
        match self.half {
            Half::NorthEast => [(col + 1, row), (col, row), (col + 1, row), (col + 1, row + 1)],
            Half::SouthWest => [(col + 1, row + 1), (col, row + 1), (col, row), (col, row + 1)],
        }
    }
}

/// The height at a place as a weighted sum of those of posts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blend {
    places: [Place; 3],
    weights: [f64; 3],
    count: usize,
}

impl Blend {
    /// The posts with their weights.
    pub(super) fn terms(&self) -> impl Iterator<Item = (Place, f64)> + '_ {
        self.places.iter().copied().zip(self.weights.iter().copied()).take(self.count)
    }

    /// At a position on the lattice, as a slice interpolates it: at a post its own height, on an edge between its two posts, and on a
    /// facet between three.
    fn at(place: Vector2<f64>) -> Self {
        let (col, row) = (floor(place.x), floor(place.y));
        let (u, v) = (place.x - f64::from(col), place.y - f64::from(row));
        let (here, opposite) = ((col, row), (col + 1, row + 1));
        let two = |other: Place, share: f64| Self { places: [here, other, here], weights: [1.0 - share, share, 0.0], count: 2 };
        match (u, v) {
            (0.0, 0.0) => Self { places: [here; 3], weights: [1.0, 0.0, 0.0], count: 1 },
            (0.0, _) => two((col, row + 1), v),
            (_, 0.0) => two((col + 1, row), u),
            _ if (u - v).abs() <= ON_THE_LINE => two(opposite, u),
            _ if u > v => Self { places: [here, (col + 1, row), opposite], weights: [1.0 - u, u - v, v], count: 3 },
            _ => Self { places: [here, (col, row + 1), opposite], weights: [1.0 - v, v - u, u], count: 3 },
        }
    }
}

/// A vertex of a leg's slice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// Distance along the leg, m.
    pub(super) x_m: f64,
    /// Its height.
    pub(super) height: Blend,
}

/// The part of a leg between two vertices, on one facet or along the common edge of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its horizontal length, m.
    pub(super) run_m: f64,
    /// Its facet.
    pub(super) facet: Facet,
    /// The facet on the other side of the edge along which it runs.
    pub(super) other: Option<Facet>,
}

/// The slice of every leg of one offset.
#[derive(Clone, Debug)]
pub(super) struct Template {
    /// The direction on the map, a unit vector.
    pub(super) heading: Vector2<f64>,
    pub(super) vertices: Vec<Vertex>,
    pub(super) pieces: Vec<Piece>,
}

impl Template {
    /// The slice from a post to the one at an offset (posts to the east and to the north), and beyond both by a distance, m.
    pub(super) fn new(map: &GeoReference, offset: (i32, i32), beyond_m: f64) -> Self {
        let step = Vector2::new(f64::from(offset.0), -f64::from(offset.1));
        let away = Vector2::new(step.x * map.dx_m(), -step.y * map.dy_m());
        let run_m = libm::hypot(away.x, away.y);
        let beyond = beyond_m / run_m;
        let shares = shares(step, beyond);
        let place = |share: f64| (step * share).map(nearly_whole);
        let vertices = shares.iter().map(|share| Vertex { x_m: share * run_m, height: Blend::at(place(*share)) }).collect();
        let pieces = shares
            .windows(2)
            .map(|pair| {
                let (facet, other) = facets_at(step * (0.5 * (pair[0] + pair[1])), offset);
                Piece { run_m: (pair[1] - pair[0]) * run_m, facet, other }
            })
            .collect();
        Self { heading: away / run_m, vertices, pieces }
    }
}

/// Where a line along `step`, a whole number of columns and rows, crosses the lines of the lattice, as shares of it, from `-beyond` to
/// `1 + beyond`, both included.
fn shares(step: Vector2<f64>, beyond: f64) -> Vec<f64> {
    let (low, high) = (-beyond, 1.0 + beyond);
    let mut shares = vec![low, high];
    for change in [step.x, step.y, step.x - step.y] {
        if change != 0.0 {
            let (first, last) = if change > 0.0 { (low * change, high * change) } else { (high * change, low * change) };
            shares.extend((floor(first)..=floor(last) + 1).map(|line| f64::from(line) / change));
        }
    }
    shares.retain(|share| (low..=high).contains(share));
    shares.sort_by(f64::total_cmp);
    let closest = ON_THE_LINE / step.amax();
    // The ends stay; of other places that are one, the first does.
    let mut apart: Vec<f64> = Vec::with_capacity(shares.len());
    for share in shares {
        if apart.last().is_none_or(|last| share - last > closest) {
            apart.push(share);
        }
    }
    if let Some(last) = apart.last_mut() {
        *last = high;
    }
    apart
}

/// The facet at the middle of a piece, and the one beyond the edge that the piece runs along.
fn facets_at(middle: Vector2<f64>, (east, north): (i32, i32)) -> (Facet, Option<Facet>) {
    let (col, row) = (floor(middle.x), floor(middle.y));
    let facet = |col, row, half| Facet { square: (col, row), half };
    if north == 0 {
        (facet(col, 0, Half::NorthEast), Some(facet(col, -1, Half::SouthWest)))
    } else if east == 0 {
        (facet(0, row, Half::SouthWest), Some(facet(-1, row, Half::NorthEast)))
    } else if east == -north {
        (facet(col, row, Half::NorthEast), Some(facet(col, row, Half::SouthWest)))
    } else {
        let (u, v) = (middle.x - f64::from(col), middle.y - f64::from(row));
        (facet(col, row, if u > v { Half::NorthEast } else { Half::SouthWest }), None)
    }
}

fn nearly_whole(value: f64) -> f64 {
    let whole = value.round();
    if (value - whole).abs() <= ON_THE_LINE { whole } else { value }
}

#[expect(clippy::cast_possible_truncation, reason = "a few posts; the cast saturates")]
fn floor(value: f64) -> i32 {
    value.floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        quantity::MapPoint,
        terrain::{Dem, slice},
        world::Neighbours,
    };

    /// The vertices and facets of a template are those of the slice, with and without ground beyond the ends.
    #[test]
    fn a_template_is_the_slice_between_its_posts() {
        let map = GeoReference::local(MapPoint::new(7.0, 20.0), 1.1, 0.7).unwrap();
        let draw = &mut crate::draw::Draw::seeded(2208);
        let dem = Dem::new(21, 21, (0..441).map(|_| draw.uniform(-1.0, 1.0)).collect(), map.clone()).unwrap();
        for offset in Neighbours::ThirtyTwo.offsets() {
            for beyond_m in [0.0, 0.23, 0.7, 1.9] {
                let template = Template::new(&map, offset, beyond_m);
                let aside = template.heading * beyond_m;
                let (col, row) = (10 + offset.0, 10 - offset.1);
                let ends =
                    [map.post(10, 10) - aside, map.post(usize::try_from(row).unwrap(), usize::try_from(col).unwrap()) + aside];
                let profile = slice(&dem, ends[0], ends[1]).unwrap();
                assert_eq!(profile.points.len(), template.vertices.len(), "{offset:?} {beyond_m}");
                let post = |(col, row): Place| {
                    dem.elevation(usize::try_from(10 + row).unwrap(), usize::try_from(10 + col).unwrap()).unwrap()
                };
                for (point, vertex) in profile.points.iter().zip(&template.vertices) {
                    let z_m: f64 = vertex.height.terms().map(|(place, weight)| weight * post(place)).sum();
                    assert!((point.x_m - beyond_m - vertex.x_m).abs() < 1e-12 && (point.z_m - z_m).abs() < 1e-12);
                }
                for (facet, piece) in profile.facets.iter().zip(&template.pieces) {
                    let candidates = std::iter::once(piece.facet).chain(piece.other).map(|facet| {
                        let [east, west, north, south] = facet.corners().map(post);
                        Vector2::new((east - west) / map.dx_m(), (north - south) / map.dy_m())
                    });
                    let steepest = candidates.max_by(|a, b| {
                        let across = |gradient: &Vector2<f64>| gradient.perp(&template.heading).abs();
                        across(a).total_cmp(&across(b))
                    });
                    let gradient = Vector2::new(-facet.normal.x, -facet.normal.y) / facet.normal.z;
                    assert!((steepest.unwrap() - gradient).amax() < 1e-12, "{offset:?} {beyond_m}");
                }
            }
        }
    }
}

//! The ground under a footprint, fitted a second time: along rays from the contact, instead of facet by facet.

use std::{f64::consts::TAU, ops::ControlFlow};

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::ground::{Around, Element, Profiles, Surface};

/// Rays around a contact on a map, one in the middle of each equal angle. More rays come closer to the integral over all directions;
/// with these the slope is within [`RAY_TOLERANCE`] of it.
const RAYS: u32 = 512;

/// Greatest error of the slope and of the residual found by rays, as a share of the residual (for the slope: over half a footprint):
/// 1.5e-5 on random ground, and more on sharper peaks.
pub(super) const RAY_TOLERANCE: f64 = 4e-4;

/// Sides of the polygon around the footprint.
const SIDES: f64 = 16.0;

/// A distance short of the footprint's border by less than this share of it is rounding.
const SHORT: f64 = 1e-8;

/// What is found under the footprint of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) enum Footing {
    /// The hopper has no footprint, or the point is no contact of this ground.
    NotAsked,
    /// The ground is not known as far as the footprint reaches.
    Unknown,
    /// The fit.
    Fitted(Fitted),
}

/// The ground fitted around a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    /// Inclination from the horizontal, rad.
    pub(super) tilt_rad: f64,
    /// The greatest distance of the ground from it that was met, m; at most the true one, within the tolerance.
    pub(super) residual_m: f64,
}

/// Fits the ground around a contact; `None` where it is not known as far as the footprint reaches.
pub(super) type FootprintFit<S> = fn(&S, &<S as Surface>::Contact, f64) -> Option<Fitted>;

/// Sums over one ray: of 1, x, and x^2, each with the weight of its ring, and of z and x z.
#[derive(Clone, Copy, Default)]
struct Sums {
    moments: [f64; 3],
    of_z: [f64; 2],
}

/// Fits the ground around a contact; `None` where it is not known as far as the footprint reaches.
pub(super) fn fitted<S: Profiles>(surface: &S, at: &S::Contact, footprint_m: f64) -> Option<Fitted> {
    let half_m = 0.5 * footprint_m;
    let around = surface.around(at, half_m);
    let headings: Vec<Vector2<f64>> = match around {
        Around::Profile { .. } => vec![Vector2::new(1.0, 0.0), Vector2::new(-1.0, 0.0)],
        Around::Map => (0..RAYS)
            .map(|ray| (f64::from(ray) + 0.5) * TAU / f64::from(RAYS))
            .map(|a| Vector2::new(libm::cos(a), libm::sin(a)))
            .collect(),
    };
    // The ring of a ray widens with the distance on a map.
    let power = i32::from(around == Around::Map);
    let reach_m = |heading: &Vector2<f64>| match around {
        Around::Profile { .. } => half_m,
        Around::Map => {
            let side = TAU / SIDES;
            let angle = libm::atan2(heading.y, heading.x);
            half_m / libm::cos(angle - (angle / side).round() * side)
        }
    };
    let mut base_m = None;
    let mut sums = vec![Sums::default(); headings.len()];
    let mut corners: Vec<(Vector3<f64>, f64)> = Vec::new();
    let mut known_m = vec![0.0f64; headings.len()];
    surface.rays(at, 1.05 * half_m, &headings, &mut |ray, element: &Element| {
        let (heading, end_m) = (headings[ray], reach_m(&headings[ray]));
        let base = *base_m.get_or_insert(element.from_z_m);
        let (from_m, to_m) = (element.from_m, element.to_m.min(end_m));
        if to_m > from_m {
            let slope = (element.to_z_m - element.from_z_m) / (element.to_m - element.from_m);
            let level_m = (element.from_z_m - base) - slope * from_m;
            // The integral of x^n from one end to the other.
            let power_of = |n: i32| (to_m.powi(n + 1) - from_m.powi(n + 1)) / f64::from(n + 1);
            let powers = [0, 1, 2, 3].map(|n| power_of(n + power));
            let sum = &mut sums[ray];
            for (i, moment) in sum.moments.iter_mut().enumerate() {
                *moment += powers[i];
            }
            for (i, of_z) in sum.of_z.iter_mut().enumerate() {
                *of_z += level_m * powers[i] + slope * powers[i + 1];
            }
            for x_m in [from_m, to_m] {
                corners.push((Vector3::new(1.0, heading.x * x_m, heading.y * x_m), level_m + slope * x_m));
            }
            known_m[ray] = to_m;
        }
        if element.to_m >= end_m { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let reaches =
        |(known_m, heading): (&f64, &Vector2<f64>)| *known_m >= reach_m(heading) * (1.0 - SHORT) - surface.position_rounding_m();
    if !known_m.iter().zip(&headings).all(reaches) {
        return None;
    }
    // The normal equations of z = a + b x + c y over the rays: exact for a plane.
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (sum, heading) in sums.iter().zip(&headings) {
        let [one, x, xx] = sum.moments;
        let (east, north) = (heading.x, heading.y);
        normal += Matrix3::new(
            one,
            x * east,
            x * north,
            x * east,
            xx * east * east,
            xx * east * north,
            x * north,
            xx * east * north,
            xx * north * north,
        );
        right += Vector3::new(sum.of_z[0], sum.of_z[1] * east, sum.of_z[1] * north);
    }
    if around != Around::Map {
        // Nothing is known across a profile.
        normal[(2, 2)] = 1.0;
    }
    let plane = normal.try_inverse()? * right;
    let residual_m = corners.iter().map(|(at, z)| (z - plane.dot(at)).abs()).fold(0.0, f64::max);
    let along_rad = libm::atan(libm::hypot(plane.y, plane.z));
    let tilt_rad = match around {
        Around::Map => along_rad,
        // The upward normal leans by both angles.
        Around::Profile { cross_slope } => libm::acos((libm::cos(along_rad) * libm::cos(libm::atan(cross_slope))).min(1.0)),
    };
    let tilt_rad = if matches!(around, Around::Profile { cross_slope: 0.0 }) { along_rad } else { tilt_rad };
    Some(Fitted { tilt_rad, residual_m })
}

//! Whether feet push in a direction, by forces that add up to it: another road than the planner's planes that touch two cones.
//!
//! ```text
//!     v is what the feet push in if forces f_i within the cones add up to it. The nearest point of the sum of the cones to v is found on at
//!     most three rays of them; then the ray that goes farthest along what is left is added, until none goes along it at all.
//! ```
//!
//! Source: E. G. Gilbert 1966, *An iterative procedure for computing the minimum of a quadratic form on a convex set*, for cones.

use nalgebra::Vector3;

use crate::ground::Foothold;

/// Rays after which the search ends: it takes a dozen.
const ROUNDS: u32 = 200;

/// What is left of a direction of length 1 when forces of the feet, each within its friction cone, take what they can of it.
pub(super) fn left_of(direction: Vector3<f64>, feet: &[Foothold]) -> f64 {
    let mut nearest = Nearest { left: direction, rays: Vec::with_capacity(4) };
    for _ in 0..ROUNDS {
        let left = nearest.left;
        let along = |ray: &Vector3<f64>| ray.dot(&left);
        let rays = feet.iter().map(|foot| ray_along(left, foot));
        let Some(ray) = rays.max_by(|a, b| along(a).total_cmp(&along(b))) else { break };
        if along(&ray) <= f64::EPSILON {
            break;
        }
        nearest.rays.push(ray);
        let next = on_rays(direction, &nearest.rays);
        if next.left.norm() >= left.norm() {
            break;
        }
        nearest = next;
    }
    nearest.left.norm()
}

/// The nearest point of the sum of some rays.
struct Nearest {
    /// From it to the direction.
    left: Vector3<f64>,
    /// Those that it lies on, at most three.
    rays: Vec<Vector3<f64>>,
}

/// The ray of the cone of a foot, of length 1, that goes farthest along a direction.
fn ray_along(direction: Vector3<f64>, foot: &Foothold) -> Vector3<f64> {
    let mu = foot.friction.coefficient();
    let along = direction.dot(&foot.normal);
    let across = direction - foot.normal * along;
    let side = across.norm();
    if side <= mu * along {
        return direction / direction.norm();
    }
    let tip = if side > 0.0 { foot.normal + across * (mu / side) } else { foot.normal };
    tip.normalize()
}

/// The nearest point of the sum of at most four rays to a direction: the best of all choices of at most three.
fn on_rays(direction: Vector3<f64>, rays: &[Vector3<f64>]) -> Nearest {
    let mut best = Nearest { left: direction, rays: Vec::new() };
    for chosen in 1..1_usize << rays.len() {
        let of: Vec<Vector3<f64>> = rays.iter().enumerate().filter(|(i, _)| chosen >> i & 1 == 1).map(|(_, ray)| *ray).collect();
        let Some(shares) = shares_of(direction, &of) else { continue };
        if shares.iter().any(|share| *share < 0.0) {
            continue;
        }
        let left = of.iter().zip(&shares).fold(direction, |left, (ray, share)| left - ray * *share);
        if left.norm() < best.left.norm() {
            best = Nearest { left, rays: of };
        }
    }
    best
}

/// How much of each ray gives the point of their span nearest to a direction; `None` if they are not independent, or more than three.
fn shares_of(direction: Vector3<f64>, rays: &[Vector3<f64>]) -> Option<Vec<f64>> {
    match rays {
        [a] => Some(vec![a.dot(&direction)]),
        [a, b] => {
            // By the normal of both: rays that are nearly alike keep their digits.
            let normal = a.cross(b);
            let square = normal.norm_squared();
            let inside = direction - normal * (normal.dot(&direction) / square);
            (square > 0.0).then(|| vec![inside.cross(b).dot(&normal) / square, a.cross(&inside).dot(&normal) / square])
        }
        [a, b, c] => {
            let volume = a.dot(&b.cross(c));
            (volume != 0.0).then(|| {
                let of = |x: &Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>| x.dot(&y.cross(z)) / volume;
                vec![of(&direction, b, c), of(a, &direction, c), of(a, b, &direction)]
            })
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::{
        ballistics::stance::ConeKind,
        draw::Draw,
        quantity::{Angle, FacetId},
        world::FrictionCone,
    };

    fn foot(normal: Vector3<f64>, mu: f64) -> Foothold {
        let friction = FrictionCone::new(mu).unwrap();
        let (point_m, facet) = (Point3::origin(), FacetId(0));
        Foothold { limb: 0, point_m, normal, facet, friction, spread: Angle::from_degrees(0.0), worst_normal: normal, area_m2: 1.0 }
    }

    /// Directions on the edge of the sum of cones, where projections onto one cone after another do not end, and beside it.
    #[test]
    fn what_is_left_is_the_distance_from_the_sum_of_the_cones() {
        let mut draw = Draw::seeded(5);
        let (mut on_edge, mut outside) = (0, 0);
        for _ in 0..2_000 {
            let tilt = [0.002, 0.05, 0.4, 1.2][draw.below(4)];
            let mu = [0.1, 0.8, 1.3][draw.below(3)];
            let count = 1 + draw.below(5);
            let feet: Vec<Foothold> = (0..count)
                .map(|_| {
                    let (turn, tilt) = (draw.uniform(0.0, std::f64::consts::TAU), tilt * draw.unit());
                    foot(Vector3::new(tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()), mu)
                })
                .collect();
            let cones: Vec<_> = feet.iter().filter_map(Foothold::cone).collect();
            let cone = ConeKind::Exact.cone(&cones);
            let turn = draw.uniform(0.0, std::f64::consts::TAU);
            let heading = nalgebra::Vector2::new(turn.cos(), turn.sin());
            let slopes = cone.takeoff_slopes(heading);
            if slopes.is_empty() || !slopes.lower.is_finite() {
                continue;
            }
            let at = |slope: f64| Vector3::new(heading.x, heading.y, slope).normalize();
            // The lower edge of the cut, and a degree below and above it.
            assert!(left_of(at(slopes.lower), &feet) <= 1.0e-6, "{feet:?} {slopes:?}");
            on_edge += 1;
            let below = Angle::from_radians(slopes.lower.atan() - 0.02).radians().tan();
            if below < slopes.lower {
                let left = left_of(at(below), &feet);
                assert!(left > 1.0e-7 && left <= 0.02 + 1.0e-9, "{left} {feet:?}");
                outside += 1;
            }
        }
        assert!(on_edge > 1_000 && outside > 1_000, "{on_edge} {outside}");
    }
}

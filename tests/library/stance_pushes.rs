//! Spin, force and stroke of a push against sampled distributions of force, planted answers, and a simulated push.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its contacts should stop")]

use chta::{
    ballistics::{
        LineOfSight,
        stance::{
            Bounds, ConeSum, ContactCone, Foothold, Limb, PlaneCut, forces_of_least_spin, greatest_force_n,
            greatest_push_speed_m_s, holds_upright, least_spin_m2_s, push_force_n, push_slope, spin_free_cut,
        },
    },
    world::FrictionCone,
};
use nalgebra::{Vector2, Vector3};

use super::stance_cones::{direction, heading, stance};
use crate::support::Draw;

/// A force inside a cone, of a size from 0 to 1; now and then on its edge.
fn force_in(draw: &mut Draw, cone: &ContactCone) -> Vector3<f64> {
    let normal = cone.normal();
    let aside = direction(draw).cross(&normal).normalize();
    let share = if draw.chance(0.3) { 1.0 - 1e-12 } else { draw.unit().sqrt() };
    (normal + aside * share * cone.friction().coefficient()).normalize() * draw.unit()
}

/// Contacts on a sphere of half a metre to a metre below or about the centre of mass.
fn footholds(draw: &mut Draw) -> Vec<Foothold> {
    let scale_m = draw.log_uniform(0.05, 5.0);
    stance(draw).into_iter().map(|cone| Foothold { cone, arm_m: direction(draw) * draw.uniform(0.3, 1.0) * scale_m }).collect()
}

fn spin(footholds: &[Foothold], forces: &[Vector3<f64>]) -> Vector3<f64> {
    footholds.iter().zip(forces).map(|(foot, force)| foot.arm_m.cross(force)).sum()
}

/// The nearest force inside a cone.
fn projected(cone: &ContactCone, force: Vector3<f64>) -> Vector3<f64> {
    let (normal, mu) = (cone.normal(), cone.friction().coefficient());
    let up = force.dot(&normal);
    let aside = force - normal * up;
    if aside.norm() <= mu * up {
        force
    } else if mu * aside.norm() <= -up {
        Vector3::zeros()
    } else {
        // A little inside, so that rounding leaves it there.
        let edge = normal + aside.normalize() * (mu * (1.0 - 1e-14));
        edge * (force.dot(&edge) / edge.norm_squared())
    }
}

/// Forces that nearly give a velocity and spin as little as they can, by projected gradients with momentum from where they are.
fn descend(footholds: &[Foothold], forces: &mut [Vector3<f64>], rounds: usize) {
    const WEIGHT: f64 = 3.0;
    let velocity: Vector3<f64> = forces.iter().sum();
    let arm_m = footholds.iter().map(|foot| foot.arm_m.norm()).fold(0.0, f64::max);
    let contacts: f64 = footholds.iter().map(|_| 1.0).sum();
    let step = 1.0 / (contacts * (WEIGHT * WEIGHT + 1.0));
    let mut ahead = forces.to_vec();
    let mut momentum = 1.0f64;
    for _ in 0..rounds {
        let missing = (ahead.iter().sum::<Vector3<f64>>() - velocity) * (WEIGHT * WEIGHT);
        let turning = spin(footholds, &ahead) / (arm_m * arm_m);
        let next_momentum = f64::midpoint(1.0, (1.0 + 4.0 * momentum * momentum).sqrt());
        for ((foot, force), ahead) in footholds.iter().zip(forces.iter_mut()).zip(&mut ahead) {
            let next = projected(&foot.cone, *ahead - (missing + turning.cross(&foot.arm_m)) * step);
            *ahead = next + (next - *force) * ((momentum - 1.0) / next_momentum);
            *force = next;
        }
        momentum = next_momentum;
    }
}

/// Stances and forces drawn at random; returns how many, how many of them must spin, and how often forces that were brought to spin little
/// came near the bound of their own velocity.
fn spins(stances: usize, seed: u64) -> [usize; 3] {
    let draw = &mut Draw::seeded(seed);
    let mut seen = [0; 3];
    let mut loose = 0;
    for _ in 0..stances {
        let feet = footholds(draw);
        let mut forces: Vec<Vector3<f64>> = feet.iter().map(|foot| force_in(draw, &foot.cone)).collect();
        let arm_m = feet.iter().map(|foot| foot.arm_m.norm()).fold(0.0, f64::max);
        for round in 0..2 {
            let velocity: Vector3<f64> = forces.iter().sum();
            let scale = arm_m * velocity.norm();
            if velocity.norm() < 0.05 {
                break;
            }
            // A force on the edge of the only cone may be outside by rounding.
            let Some(Bounds { lower, upper }) = least_spin_m2_s(&feet, velocity) else {
                assert!(feet.len() == 1 || round == 1, "{feet:?} {velocity:?}");
                continue;
            };
            let told = || format!("{lower} to {upper} of {scale}, {feet:?} {velocity:?}");
            assert!(0.0 <= lower && lower <= upper, "{}", told());
            // Narrow cones that have to press together hard may need more steps than are taken.
            assert!(upper - lower < 1e-4 * scale || upper == f64::INFINITY, "{}", told());
            loose += usize::from(upper - lower > 1e-6 * scale);
            let found = spin(&feet, &forces).norm();
            assert!(found >= lower - 1e-9 * scale, "{found}: {}", told());
            if round == 0 {
                descend(&feet, &mut forces, 400);
            } else {
                seen[0] += 1;
                seen[1] += usize::from(lower > 1e-3 * scale);
                seen[2] += usize::from(found <= upper + 0.01 * scale);
            }
        }
    }
    assert!(loose * 1_000 <= stances, "{loose} of {stances} with bounds more than 1e-6 apart");
    seen
}

#[test]
fn no_distribution_of_force_spins_less_than_the_bound() {
    let [all, spinning, near] = spins(300, 41);
    assert!(all > 200 && spinning * 5 > all && near * 20 > all * 19, "{all} {spinning} {near}");
}

#[test]
#[ignore = "ten thousand stances"]
fn no_distribution_of_force_spins_less_than_the_bound_in_ten_thousand_stances() {
    let [all, spinning, near] = spins(10_000, 42);
    assert!(all > 9_000 && spinning * 5 > all && near * 20 > all * 19, "{all} {spinning} {near}");
}

/// Contacts and forces without spin: one contact is moved so that force and moment are at a right angle, then the centre of mass.
fn without_spin(draw: &mut Draw) -> Option<(Vec<Foothold>, Vector3<f64>)> {
    let mut feet = footholds(draw);
    let forces: Vec<Vector3<f64>> = feet.iter().map(|foot| force_in(draw, &foot.cone)).collect();
    let force: Vector3<f64> = forces.iter().sum();
    let way = forces[0].cross(&force);
    if force.norm() < 0.1 || (feet.len() > 1 && way.norm() < 1e-3) {
        return None;
    }
    if feet.len() > 1 {
        // (w x f).F = w.(f x F)
        let excess = spin(&feet, &forces).dot(&force);
        feet[0].arm_m -= way * (excess / way.norm_squared());
    }
    let mass_centre = force.cross(&spin(&feet, &forces)) / force.norm_squared();
    for foot in &mut feet {
        foot.arm_m -= mass_centre;
    }
    Some((feet, force))
}

#[test]
fn planted_pushes_without_spin_are_found_and_directions_beside_them_are_not() {
    let draw = &mut Draw::seeded(43);
    let (mut planted, mut closed, mut empty, mut open) = (0, 0, 0, 0);
    let (mut outside, mut proved) = (0, 0);
    for _ in 0..1_000 {
        let Some((feet, force)) = without_spin(draw) else { continue };
        planted += 1;
        let arm_m = feet.iter().map(|foot| foot.arm_m.norm()).fold(0.0, f64::max);
        let told = || format!("{feet:?} {force:?}");
        let along = force.xy().try_normalize(0.0).unwrap();
        let cut = spin_free_cut(&feet, along);
        let at = [force.xy().norm(), force.z];
        let within = |direction: [f64; 2]| match cut {
            PlaneCut::Between { lower, upper } => {
                let beside = |side: [f64; 2]| (side[0] * direction[1] - side[1] * direction[0]).abs() / side[0].hypot(side[1]);
                cut.contains(direction) || beside(lower).min(beside(upper)) < 1e-6 * direction[0].hypot(direction[1])
            }
            cut => cut.contains(direction),
        };
        if feet.len() > 1 {
            assert!(within(at), "{cut:?}, {}", told());
            let spin = least_spin_m2_s(&feet, force * (1.0 - 1e-15)).map_or(0.0, |bounds| bounds.upper);
            assert!(spin < 1e-6 * arm_m * force.norm(), "{spin}, {}", told());
        }
        // Another heading: what is outside needs spin, what is inside none.
        let e = heading(draw);
        let cut = spin_free_cut(&feet, e);
        let cones: Vec<ContactCone> = feet.iter().map(|foot| foot.cone).collect();
        let sum = ConeSum::new(&cones);
        let mut check = |direction: [f64; 2], free: bool| {
            let velocity = Vector3::new(e.x * direction[0], e.y * direction[0], direction[1]).normalize();
            if !sum.contains(velocity) {
                assert!(!free || sum.cut(e).opening().is_some(), "{}", told());
                return;
            }
            let spin = least_spin_m2_s(&feet, velocity).unwrap();
            if free {
                assert!(spin.lower < 1e-6 * arm_m, "{spin:?} {cut:?} {}", told());
            } else {
                // No push without spin was found; that no such push exists is proved unless the contacts press together very hard.
                assert!(spin.upper > 1e-8 * arm_m, "{spin:?} {direction:?} {cut:?} {}", told());
                outside += 1;
                proved += usize::from(spin.lower > 0.0);
            }
        };
        match cut {
            PlaneCut::Nothing => {
                empty += 1;
                let (sine, cosine) = draw.uniform(-3.1, 3.1).sin_cos();
                check([cosine, sine], false);
            }
            PlaneCut::Everything => check([0.6, 0.8], true),
            PlaneCut::Between { lower, upper } => {
                let opening = cut.opening().unwrap().radians();
                open += usize::from(opening > 1e-3);
                closed += usize::from(opening < 1e-6);
                for (side, outwards) in [(lower, -1.0), (upper, 1.0)] {
                    let turned =
                        |angle: f64| [side[0] * angle.cos() - side[1] * angle.sin(), side[0] * angle.sin() + side[1] * angle.cos()];
                    check(turned(0.0), true);
                    if opening < std::f64::consts::PI - 2e-3 {
                        check(turned(outwards * 1e-3), false);
                    }
                    if opening > 2e-6 {
                        check(turned(outwards * -1e-6), true);
                    }
                }
            }
        }
    }
    assert!(planted > 700 && open > 200 && closed > 20 && empty > 200, "{planted} {open} {closed} {empty}");
    assert!(outside > 500 && proved * 100 > outside * 98, "{proved} of {outside}");
}

/// Two feet apart in the plane of travel, a slope between them: who stands, slides or topples.
#[test]
fn rest_takes_friction_and_a_mass_centre_over_the_feet() {
    let level = ContactCone::new(Vector3::z(), FrictionCone::new(0.5).unwrap()).unwrap();
    let foot = |x: f64, y: f64| Foothold { cone: level, arm_m: Vector3::new(x, y, -0.5) };
    assert!(holds_upright(&[foot(0.0, 0.0)]), "a foot straight below");
    assert!(!holds_upright(&[foot(0.01, 0.0)]), "a foot beside the centre of mass");
    assert!(holds_upright(&[foot(0.2, 0.0), foot(-0.2, 0.0)]));
    assert!(!holds_upright(&[foot(0.2, 0.01), foot(-0.2, 0.01)]));
    // On the border of the triangle of the feet.
    assert!(holds_upright(&[foot(0.2, 0.0), foot(-0.2, 0.0), foot(0.0, 0.3)]));
    assert!(!holds_upright(&[foot(0.2, 1e-6), foot(-0.2, 1e-6), foot(0.0, 0.3)]));
    // Between two walls the friction holds a robot whose contacts are at the height of its centre of mass or not.
    let wall = |x: f64| ContactCone::new(Vector3::new(-x, 0.0, 0.0), FrictionCone::new(0.5).unwrap()).unwrap();
    let grip = |x: f64, z: f64| Foothold { cone: wall(x), arm_m: Vector3::new(x, 0.0, z) };
    assert!(holds_upright(&[grip(1.0, 0.3), grip(-1.0, 0.1)]));
    assert!(!holds_upright(&[]));
}

/// A planted optimum: the forces that do most along any u are the most along their own sum.
fn forces(stances: usize, seed: u64) -> [usize; 2] {
    let draw = &mut Draw::seeded(seed);
    let mut seen = [0; 2];
    for _ in 0..stances {
        let limbs: Vec<Limb> =
            stance(draw).into_iter().map(|cone| Limb::new(cone, draw.log_uniform(1.0, 300.0)).unwrap()).collect();
        let whole: f64 = limbs.iter().map(Limb::force_max_n).sum();
        let u = direction(draw);
        let most = |limb: &Limb| {
            let (normal, mu) = (limb.cone().normal(), limb.cone().friction().coefficient());
            let angle = u.angle(&normal);
            let edge = u - normal * u.dot(&normal);
            let force = if angle <= mu.atan() { u } else { (normal + edge.normalize() * mu).normalize() };
            let gain = (angle - mu.atan()).max(0.0).cos().max(0.0);
            assert!((gain - force.dot(&u).max(0.0)).abs() < 1e-9, "the formula of g");
            if gain > 0.0 { force * limb.force_max_n() } else { Vector3::zeros() }
        };
        let planted: Vector3<f64> = limbs.iter().map(most).sum();
        if planted.norm() > 0.01 * whole {
            let found = greatest_force_n(&limbs, planted.normalize());
            let told = || format!("{found:?} for {}, {limbs:?} {u:?}", planted.norm());
            // The best u is known, so no other is better; on the border of the cone only the bound from above is near.
            assert!(found.upper >= planted.norm() - 1e-8 * whole, "{}", told());
            assert!(found.lower <= planted.norm() + 1e-8 * whole, "{}", told());
            if found.upper - found.lower < 1e-6 * whole {
                seen[0] += 1;
                assert!((found.upper - planted.norm()).abs() < 2e-6 * whole, "{}", told());
            }
        }
        // Any forces at all never do more than the bound along their sum.
        for _ in 0..10 {
            let drawn: Vector3<f64> = limbs.iter().map(|limb| force_in(draw, &limb.cone()) * limb.force_max_n()).sum();
            if drawn.norm() > 0.01 * whole {
                let found = greatest_force_n(&limbs, drawn.normalize());
                assert!(limbs.len() == 1 || drawn.norm() <= found.upper + 1e-8 * whole, "{drawn:?} {found:?} {limbs:?}");
                assert!(found.lower <= found.upper + 1e-9 * whole);
                seen[1] += usize::from(found.upper - found.lower < 1e-6 * whole);
            }
        }
    }
    seen
}

#[test]
fn no_distribution_of_force_is_larger_than_the_bound() {
    let [planted, near] = forces(500, 44);
    assert!(planted > 300 && near > 3_500, "{planted} {near}");
}

#[test]
#[ignore = "ten thousand stances"]
fn no_distribution_of_force_is_larger_than_the_bound_in_ten_thousand_stances() {
    let [planted, near] = forces(10_000, 45);
    assert!(planted > 8_000 && near > 90_000, "{planted} {near}");
}

/// A push with the force of the formula, from rest and in small steps, takes off with the velocity that was asked for, at the end of the stroke.
#[test]
fn a_simulated_push_takes_off_as_the_formula_says() {
    let draw = &mut Draw::seeded(46);
    for _ in 0..200 {
        let (gravity, stroke_m) = (draw.gravity(), draw.log_uniform(0.01, 1.0));
        let (x_m, b) = (draw.log_uniform(0.1, 100.0), draw.uniform(-2.0, 2.0));
        let m = b + draw.log_uniform(0.01, 10.0);
        let sight = LineOfSight::along(x_m, b);
        let speed_m_s = (gravity * x_m * (1.0 + m * m) / (2.0 * (m - b))).sqrt();
        let force = push_force_n(m, speed_m_s, stroke_m, gravity);
        let slope = push_slope(m, sight, stroke_m);
        assert!((force.y / force.x - slope).abs() < 1e-11 * (1.0 + slope.abs()) * (1.0 + x_m / stroke_m).min(1e3), "{slope}");
        let (mut position, mut velocity) = (Vector2::<f64>::zeros(), Vector2::zeros());
        let step_s = 2.0 * stroke_m / speed_m_s / 2_000.0;
        while position.norm() < stroke_m {
            let acceleration = force - Vector2::new(0.0, gravity);
            position += velocity * step_s + acceleration * (0.5 * step_s * step_s);
            velocity += acceleration * step_s;
        }
        assert!((velocity.norm() / speed_m_s - 1.0).abs() < 2e-3, "{velocity:?} {speed_m_s}");
        assert!((velocity.y / velocity.x - m).abs() < 1e-9 * (1.0 + m.abs()), "{velocity:?} {m}");
    }
}

/// The greatest speed of a push: forces drawn at random, with the weight taken away, never push faster along their own line; and a planted
/// optimum is met.
fn speeds(stances: usize, seed: u64) -> [usize; 3] {
    let draw = &mut Draw::seeded(seed);
    let mut seen = [0; 3];
    for _ in 0..stances {
        let limbs: Vec<Limb> =
            stance(draw).into_iter().map(|cone| Limb::new(cone, draw.log_uniform(1.0, 300.0)).unwrap()).collect();
        let whole: f64 = limbs.iter().map(Limb::force_max_n).sum();
        let (gravity, mass_kg, stroke_m) = (draw.gravity(), draw.log_uniform(0.1, 20.0), draw.log_uniform(0.05, 0.5));
        let drawn: Vector3<f64> = limbs.iter().map(|limb| force_in(draw, &limb.cone()) * limb.force_max_n()).sum();
        let net = drawn - Vector3::z() * (mass_kg * gravity);
        if net.norm() < 0.01 * whole {
            continue;
        }
        let speed_m_s = (2.0 * stroke_m * net.norm() / mass_kg).sqrt();
        let found = greatest_push_speed_m_s(&limbs, net.normalize(), stroke_m, mass_kg, gravity);
        let Some(found) = found else {
            assert!(limbs.len() == 1, "{limbs:?} {net:?}");
            continue;
        };
        seen[0] += 1;
        assert!(limbs.len() == 1 || speed_m_s <= found.upper * (1.0 + 1e-7), "{speed_m_s} {found:?} {limbs:?}");
        if found.upper - found.lower < 1e-6 * found.upper {
            seen[1] += 1;
            // The net force at this speed is one of the limbs: with the weight, no larger than they are along its own line.
            let force = net.normalize() * (mass_kg * found.lower.powi(2) / (2.0 * stroke_m)) + Vector3::z() * (mass_kg * gravity);
            let most = greatest_force_n(&limbs, force.normalize());
            // The border of a single cone is missed by the last digits.
            let fits = force.norm() <= most.upper * (1.0 + 1e-6) + 1e-6 * whole;
            assert!(fits || limbs.len() == 1, "{force:?} {most:?} {limbs:?}");
            seen[2] += usize::from(force.norm() >= most.lower * (1.0 - 1e-4));
        }
    }
    seen
}

#[test]
fn no_push_is_faster_than_the_bound() {
    let [all, near, largest] = speeds(1_000, 47);
    assert!(all > 600 && near * 10 > all * 7 && largest * 4 > near, "{all} {near} {largest}");
}

#[test]
#[ignore = "ten thousand stances"]
fn no_push_is_faster_than_the_bound_in_ten_thousand_stances() {
    let [all, near, largest] = speeds(10_000, 48);
    assert!(all > 9_000 && near * 10 > all * 9 && largest * 4 > near, "{all} {near} {largest}");
}

#[test]
fn limbs_without_strength_are_refused() {
    let level = ContactCone::new(Vector3::z(), FrictionCone::new(0.5).unwrap()).unwrap();
    for force_n in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Limb::new(level, force_n).is_err(), "{force_n}");
    }
    assert_eq!(greatest_force_n(&[], Vector3::z()), Bounds { lower: 0.0, upper: 0.0 });
    assert!(greatest_push_speed_m_s(&[], Vector3::z(), 0.2, 5.0, 1.0).is_none());
    assert!(least_spin_m2_s(&[], Vector3::z()).is_none());
    assert_eq!(spin_free_cut(&[], Vector2::x()), PlaneCut::Nothing);
}

/// Each of the forces lies in its cone, they add up to the push, and their moment is the least.
#[test]
fn the_forces_of_least_spin_add_up_and_spin_as_little_as_the_bound_says() {
    let draw = &mut Draw::seeded(95);
    let (mut found, mut none) = (0, 0);
    for _ in 0..3_000 {
        let footholds = footholds(draw);
        let push = direction(draw) * draw.log_uniform(1e-3, 1e3);
        let (Some(forces), Some(bounds)) = (forces_of_least_spin(&footholds, push), least_spin_m2_s(&footholds, push)) else {
            let cones: Vec<ContactCone> = footholds.iter().map(|foot| foot.cone).collect();
            // Only beside the cone, or so near to its edge that no forces were found to 1e-7.
            let inside = ConeSum::new(&cones).contains(push * 1.0);
            assert!(!inside || least_spin_m2_s(&footholds, push).is_some_and(|bounds| bounds.upper.is_infinite()));
            none += 1;
            continue;
        };
        found += 1;
        let arm_m = footholds.iter().map(|foot| foot.arm_m.norm()).fold(0.0, f64::max);
        let size = forces.iter().map(Vector3::norm).sum::<f64>();
        for (foot, force) in footholds.iter().zip(&forces) {
            let normal = foot.cone.normal();
            let up = force.dot(&normal);
            let aside = (force - normal * up).norm();
            assert!(aside <= foot.cone.friction().coefficient() * up + 1e-9 * size, "{force} {foot:?}");
        }
        let sum: Vector3<f64> = forces.iter().sum();
        assert!((sum - push).norm() <= 2e-7 * push.norm() + 1e-12 * size, "{sum} {push}");
        let moment = spin(&footholds, &forces).norm();
        assert!((moment - bounds.upper).abs() <= 1e-6 * push.norm() * arm_m + 1e-9 * size * arm_m, "{moment} {bounds:?}");
    }
    assert!(found > 500 && none > 200, "{found} {none}");
}

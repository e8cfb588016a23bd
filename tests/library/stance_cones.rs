//! The cone of a stance against a second road: the support function over its dual cone, whose boundary is cut into arcs of circles by
//! trigonometry. And every degenerate case, and the errata of the paper, as a case each.

#![allow(clippy::unwrap_used, reason = "a test that cannot build its contacts should stop")]

use std::f64::consts::{PI, TAU};

use chta::{
    ballistics::stance::{ConeKind, ConeSum, ContactCone, PlaneCut, PyramidEdges},
    quantity::{Angle, SlopeInterval},
    world::{FrictionCone, PreparedCone},
};
use nalgebra::{Vector2, Vector3};

use crate::support::Draw;

const PYRAMIDS: [PyramidEdges; 3] = [PyramidEdges::Four, PyramidEdges::Eight, PyramidEdges::Sixteen];

fn contact(normal: Vector3<f64>, mu: f64) -> ContactCone {
    ContactCone::new(normal, FrictionCone::new(mu).unwrap()).unwrap()
}

pub(crate) fn direction(draw: &mut Draw) -> Vector3<f64> {
    loop {
        let v = Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0));
        if (0.01..1.0).contains(&v.norm_squared()) {
            return v.normalize();
        }
    }
}

pub(crate) fn heading(draw: &mut Draw) -> Vector2<f64> {
    let (sine, cosine) = draw.uniform(-PI, PI).sin_cos();
    Vector2::new(cosine, sine)
}

/// One to six contacts: rough ground, walls, anywhere; among them normals that are the same, nearly the same, opposite, or in one plane.
pub(crate) fn stance(draw: &mut Draw) -> Vec<ContactCone> {
    let count = 1 + draw.below(6);
    let kind = draw.below(4);
    let roughness = draw.uniform(0.0, 0.7);
    let mut contacts: Vec<ContactCone> = Vec::new();
    for _ in 0..count {
        let mut normal = match kind {
            0 => direction(draw),
            1 => (Vector3::z() + direction(draw) * roughness).normalize(),
            2 => Vector3::new(draw.uniform(-1.0, 1.0), 0.0, draw.uniform(-1.0, 1.0)).normalize(),
            _ => (Vector3::new(draw.sign(), 0.0, draw.uniform(-0.2, 0.5)) + direction(draw) * roughness).normalize(),
        };
        if let Some(other) = contacts.first()
            && draw.chance(0.15)
        {
            normal = match draw.below(3) {
                0 => other.normal(),
                1 => -other.normal(),
                _ => (other.normal() + direction(draw) * draw.log_uniform(1e-9, 1e-3)).normalize(),
            };
        }
        let mu = match contacts.first() {
            Some(other) if draw.chance(0.5) => other.friction().coefficient(),
            _ => draw.log_uniform(0.05, 1.3),
        };
        contacts.push(contact(normal, mu));
    }
    contacts
}

/// The unit vectors of the dual cone: a region of the sphere bounded by arcs of circles.
struct Dual {
    caps: Vec<(Vector3<f64>, f64)>,
    arcs: Vec<Arc>,
}

/// `u(psi) = centre + first cos psi + second sin psi` for psi from `from` to `to`.
struct Arc {
    centre: Vector3<f64>,
    first: Vector3<f64>,
    second: Vector3<f64>,
    from: f64,
    to: f64,
}

impl Arc {
    fn at(&self, psi: f64) -> Vector3<f64> {
        self.centre + self.first * psi.cos() + self.second * psi.sin()
    }

    /// The least product with a direction, over the arc.
    fn least(&self, d: Vector3<f64>) -> f64 {
        let (x, y) = (d.dot(&self.first), d.dot(&self.second));
        let ends = d.dot(&self.at(self.from)).min(d.dot(&self.at(self.to)));
        let opposite = (-y).atan2(-x);
        let inside = [opposite, opposite + TAU, opposite - TAU].into_iter().any(|psi| self.from <= psi && psi <= self.to);
        if inside { d.dot(&self.centre) - x.hypot(y) } else { ends }
    }
}

impl Dual {
    fn of(contacts: &[ContactCone]) -> Self {
        let caps: Vec<(Vector3<f64>, f64)> =
            contacts.iter().map(|contact| (contact.normal(), contact.friction().coefficient().atan().sin())).collect();
        let mut arcs = Vec::new();
        for (centre, sine) in &caps {
            let first = centre.cross(&Vector3::ith(centre.iamin(), 1.0)).normalize();
            let second = centre.cross(&first);
            let cosine = (1.0 - sine * sine).sqrt();
            let circle = |from, to| Arc { centre: centre * *sine, first: first * cosine, second: second * cosine, from, to };
            // Where the circle passes the border of another cap.
            let mut ends = vec![-PI, PI];
            let whole = circle(-PI, PI);
            for (other, least) in &caps {
                let (x, y) = (other.dot(&whole.first), other.dot(&whole.second));
                let part = (least - other.dot(&whole.centre)) / x.hypot(y);
                if part.abs() <= 1.0 {
                    let middle = y.atan2(x);
                    for psi in [middle - part.acos(), middle + part.acos()] {
                        ends.push((psi + 3.0 * PI).rem_euclid(TAU) - PI);
                    }
                }
            }
            ends.sort_by(f64::total_cmp);
            for pair in ends.windows(2) {
                let arc = circle(pair[0], pair[1]);
                let middle = arc.at(0.5 * (pair[0] + pair[1]));
                if caps.iter().all(|(other, least)| middle.dot(other) >= least - 1e-12) {
                    arcs.push(arc);
                }
            }
        }
        Self { caps, arcs }
    }

    /// The least product of a unit vector of the dual cone with a direction; infinite if the dual cone is the origin alone.
    fn support(&self, d: Vector3<f64>) -> f64 {
        if self.caps.iter().all(|(normal, sine)| -d.dot(normal) > *sine) {
            return -1.0;
        }
        self.arcs.iter().map(|arc| arc.least(d)).fold(f64::INFINITY, f64::min)
    }
}

fn in_plane(heading: Vector2<f64>, [ahead, up]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(heading.x * ahead, heading.y * ahead, up).normalize()
}

fn turned([x, z]: [f64; 2], angle: f64) -> [f64; 2] {
    [x * angle.cos() - z * angle.sin(), x * angle.sin() + z * angle.cos()]
}

#[derive(Debug, Default)]
struct Seen {
    nothing: usize,
    between: usize,
    everything: usize,
    beyond_pairs: usize,
    grazing: usize,
}

/// Compares stances with the second road; returns how often each answer occurred.
fn compare(stances: usize, seed: u64) -> Seen {
    let draw = &mut Draw::seeded(seed);
    let mut seen = Seen::default();
    for _ in 0..stances {
        let contacts = stance(draw);
        let sum = ConeSum::new(&contacts);
        let dual = Dual::of(&contacts);
        let told = || format!("{contacts:?}");
        assert_eq!(sum.is_everything(), dual.arcs.is_empty(), "{}", told());
        if sum.is_everything() {
            seen.everything += 1;
            let pairs =
                contacts.iter().enumerate().flat_map(|(at, one)| contacts[at + 1..].iter().map(move |other| [*one, *other]));
            seen.beyond_pairs += usize::from(!pairs.into_iter().any(|pair| ConeSum::new(&pair).is_everything()));
            continue;
        }
        let e = heading(draw);
        let across = Vector3::new(-e.y, e.x, 0.0);
        match sum.cut(e) {
            PlaneCut::Everything => panic!("a plane inside the cone: {}", told()),
            PlaneCut::Nothing => {
                // The plane misses the cone if one of its normals is inside the dual cone.
                seen.nothing += 1;
                let within = |w: Vector3<f64>| dual.caps.iter().all(|(normal, sine)| w.dot(normal) > sine - 1e-12);
                assert!(within(across) || within(-across), "heading {e:?}, {}", told());
            }
            cut @ PlaneCut::Between { lower, upper } => {
                seen.between += 1;
                let width = cut.opening().unwrap().radians();
                for (side, outwards) in [(lower, -1.0), (upper, 1.0)] {
                    let at = |angle: f64| dual.support(in_plane(e, turned(side, angle)));
                    assert!(at(0.0) > -1e-12, "side {side:?} is {} outside, heading {e:?}, {}", at(0.0), told());
                    if width < 1e-6 {
                        seen.grazing += 1;
                    } else {
                        assert!(at(-1e-9 * outwards) > 0.0, "side {side:?} is too wide, heading {e:?}, {}", told());
                    }
                    assert!(
                        width > PI - 1e-6 || at(1e-9 * outwards) < 0.0,
                        "side {side:?} is too narrow, heading {e:?}, {}",
                        told()
                    );
                }
                slopes_are_those_of_directions(draw, &sum, &dual, e);
            }
        }
    }
    seen
}

/// Take-off and landing slopes against directions drawn one by one.
fn slopes_are_those_of_directions(draw: &mut Draw, sum: &ConeSum, dual: &Dual, e: Vector2<f64>) {
    let (takeoff, landing) = (sum.takeoff_slopes(e), sum.landing_slopes(e));
    for _ in 0..3 {
        let slope = draw.uniform(-1.57, 1.57).tan();
        let velocity = in_plane(e, [1.0, slope]);
        for (slopes, reversed) in [(takeoff, velocity), (landing, -velocity)] {
            let support = dual.support(reversed);
            assert_eq!(sum.contains(reversed), slopes.contains(slope) || (sum.contains(reversed) && support.abs() < 1e-9));
            assert!(support.abs() < 1e-9 || slopes.contains(slope) == (support > 0.0), "{slopes:?} at {slope}, {support}, {sum:?}");
        }
    }
}

#[test]
fn the_sum_is_what_the_dual_cone_supports() {
    let seen = compare(10_000, 21);
    assert!(seen.nothing > 500 && seen.between > 3_000 && seen.everything > 1_000, "{seen:?}");
    // Force closure that no pair of contacts shows.
    assert!(seen.beyond_pairs > 50, "{seen:?}");
    assert!(seen.grazing < 20, "{seen:?}");
}

#[test]
#[ignore = "a hundred thousand stances"]
fn the_sum_is_what_the_dual_cone_supports_in_a_hundred_thousand_stances() {
    let seen = compare(100_000, 22);
    assert!(seen.between > 30_000 && seen.beyond_pairs > 500, "{seen:?}");
}

fn is_inside(inner: SlopeInterval, outer: SlopeInterval, tolerance: f64) -> bool {
    let angles = |slopes: SlopeInterval| slopes.angles().map(|angles| [angles.min.radians(), angles.max.radians()]);
    match (angles(inner), angles(outer)) {
        (None, _) => true,
        // A plane that touches the inner cone may miss the outer one by rounding.
        (Some([low, high]), None) => high - low < 1e-6,
        (Some([low, high]), Some([least, greatest])) => low >= least - tolerance && high <= greatest + tolerance,
    }
}

/// Kc inside Kc+ inside K, and each pyramid inside the next inside K: by slopes, and by directions on the border of each.
fn nested(stances: usize, seed: u64) -> [usize; 3] {
    let draw = &mut Draw::seeded(seed);
    let mut wider = [0; 3];
    for _ in 0..stances {
        let contacts = stance(draw);
        let exact = ConeSum::new(&contacts);
        let dual = Dual::of(&contacts);
        let e = heading(draw);
        let chains: [Vec<ConeSum>; 2] = [
            [ConeKind::Kc, ConeKind::KcPlus].map(|kind| kind.cone(&contacts)).to_vec(),
            PYRAMIDS.map(|edges| ConeKind::Pyramid(edges).cone(&contacts)).to_vec(),
        ];
        for chain in &chains {
            for (at, inner) in chain.iter().enumerate() {
                let outer = chain.get(at + 1).unwrap_or(&exact);
                for (inner, outer) in
                    [(inner.takeoff_slopes(e), outer.takeoff_slopes(e)), (inner.landing_slopes(e), outer.landing_slopes(e))]
                {
                    assert!(is_inside(inner, outer, 1e-7), "{inner:?} {outer:?} {contacts:?} {e:?}");
                }
                if let PlaneCut::Between { lower, upper } = inner.cut(e) {
                    for side in [lower, upper] {
                        let out = dual.support(in_plane(e, side));
                        assert!(out > -1e-12, "{out} {inner:?} {contacts:?} {e:?}");
                    }
                }
            }
        }
        let opening = |cone: &ConeSum| cone.cut(e).opening().map_or(0.0, Angle::radians);
        let widths = [opening(&chains[0][0]), opening(&chains[0][1]), opening(&exact)];
        wider[0] += usize::from(widths[1] > widths[0] + 1e-6);
        wider[1] += usize::from(widths[2] > widths[1] + 1e-6);
        wider[2] += usize::from(widths[2] > opening(&chains[1][2]) + 1e-6);
    }
    wider
}

#[test]
fn the_narrower_cones_are_inside() {
    let wider = nested(2_000, 23);
    assert!(wider.into_iter().all(|count| count > 200), "{wider:?}");
}

#[test]
#[ignore = "a hundred thousand stances"]
fn the_narrower_cones_are_inside_in_a_hundred_thousand_stances() {
    let wider = nested(100_000, 24);
    assert!(wider.into_iter().all(|count| count > 20_000), "{wider:?}");
}

/// For one contact every kind but the pyramids is the cone of the contact to the last bit.
#[test]
fn one_contact_is_a_prepared_cone() {
    let draw = &mut Draw::seeded(25);
    for _ in 0..20_000 {
        let (normal, mu, e) = (direction(draw), draw.log_uniform(1e-3, 1e2), heading(draw));
        let prepared = PreparedCone::new(FrictionCone::new(mu).unwrap());
        for kind in [ConeKind::Exact, ConeKind::Kc, ConeKind::KcPlus] {
            let cone = kind.cone(&[contact(normal, mu)]);
            let bits = |slopes: SlopeInterval| [slopes.lower.to_bits(), slopes.upper.to_bits()];
            assert_eq!(bits(cone.takeoff_slopes(e)), bits(prepared.slopes(normal, e)));
            assert_eq!(bits(cone.landing_slopes(e)), bits(prepared.slopes(-normal, e)));
            assert_eq!(cone.cut(e).takeoff_slopes(), cone.takeoff_slopes(e));
            assert_eq!(cone.cut(e).landing_slopes(), cone.landing_slopes(e));
        }
    }
}

/// All sums of two edges, one on either side of the plane, sorted by angle; the largest gap is the outside.
fn brute_pyramid(contacts: &[ContactCone], edges: u32, e: Vector2<f64>) -> Vec<f64> {
    let rays: Vec<Vector3<f64>> = contacts
        .iter()
        .flat_map(|contact| {
            let normal = contact.normal();
            let first = Vector3::ith(normal.iamin(), 1.0);
            let first = (first - normal * first.dot(&normal)).normalize();
            let phi = contact.friction().coefficient().atan();
            (0..edges).map(move |edge| {
                let turn = TAU * f64::from(edge) / f64::from(edges);
                normal * phi.cos() + (first * turn.cos() + normal.cross(&first) * turn.sin()) * phi.sin()
            })
        })
        .collect();
    let mut angles = Vec::new();
    for (at, one) in rays.iter().enumerate() {
        for other in &rays[at + 1..] {
            let [p, q] = [one, other].map(|ray| ray.y * e.x - ray.x * e.y);
            if p * q < 0.0 {
                let ray = one * q.abs() + other * p.abs();
                if ray.norm() > 1e-9 {
                    angles.push(ray.z.atan2(ray.x * e.x + ray.y * e.y));
                }
            }
        }
    }
    angles.sort_by(f64::total_cmp);
    angles
}

#[test]
fn pyramids_are_the_hull_of_all_sums_of_two_edges() {
    let draw = &mut Draw::seeded(26);
    let mut compared = 0;
    for _ in 0..400 {
        // Normals drawn apart: equal ones have edges in common, which the plain version takes for a plane.
        let contacts: Vec<ContactCone> =
            (0..=draw.below(3)).map(|_| contact(direction(draw), draw.log_uniform(0.05, 1.3))).collect();
        let e = heading(draw);
        for edges in PYRAMIDS {
            let angles = brute_pyramid(&contacts, edges.count(), e);
            let cut = ConeKind::Pyramid(edges).cone(&contacts).cut(e);
            let Some((&first, &last)) = angles.first().zip(angles.last()) else {
                assert_eq!(cut, PlaneCut::Nothing, "{contacts:?}");
                continue;
            };
            let after = first + TAU - last;
            let gap = angles.windows(2).map(|pair| pair[1] - pair[0]).fold(after, f64::max);
            match cut {
                PlaneCut::Nothing => panic!("{contacts:?} {e:?}"),
                PlaneCut::Everything => assert!(gap < PI + 1e-9, "{gap} {contacts:?} {e:?}"),
                PlaneCut::Between { .. } => {
                    let opening = cut.opening().unwrap().radians();
                    assert!((TAU - gap - opening).abs() < 1e-9, "{gap} {opening} {contacts:?} {e:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

/// The rows of the table of degenerate cases.
mod degenerate {
    use super::*;

    fn slopes(contacts: &[ContactCone]) -> SlopeInterval {
        ConeSum::new(contacts).takeoff_slopes(Vector2::x())
    }

    #[test]
    fn no_contact_and_a_plane_that_misses_have_no_direction() {
        assert!(ConeSum::new(&[]).is_nothing());
        assert_eq!(ConeSum::new(&[]).cut(Vector2::x()), PlaneCut::Nothing);
        let walls = [contact(Vector3::y(), 0.4), contact(Vector3::new(0.0, 0.8, 0.6), 0.4)];
        assert_eq!(ConeSum::new(&walls).cut(Vector2::x()), PlaneCut::Nothing);
        assert!(slopes(&walls).is_empty() && ConeSum::new(&walls).landing_slopes(Vector2::x()).is_empty());
        assert!(!ConeSum::new(&walls).holds_weight());
    }

    #[test]
    fn of_equal_normals_and_of_nested_cones_the_wider_rules() {
        let normal = Vector3::new(-0.6, 0.0, 0.8);
        let alone = slopes(&[contact(normal, 0.7)]);
        assert_eq!(slopes(&[contact(normal, 0.7), contact(normal, 0.7)]), alone);
        assert_eq!(slopes(&[contact(normal, 0.2), contact(normal, 0.7), contact(normal, 0.3)]), alone);
        let inside = contact(Vector3::new(-0.6, 0.1, 0.8).normalize(), 0.3);
        assert_eq!(slopes(&[inside, contact(normal, 0.7)]), alone);
        assert_eq!(slopes(&[contact(normal, 0.7), inside, inside]), alone);
        // One cone touches the other from inside: 0.2 of half-angle, 0.1 aside, in one of 0.3.
        let aside = |angle: f64| Vector3::new(angle.sin(), 0.0, angle.cos());
        let touching = slopes(&[contact(aside(0.0), 0.3f64.tan()), contact(aside(0.1), 0.2f64.tan())]);
        assert!((touching.lower - (PI / 2.0 - 0.3).tan()).abs() < 1e-12, "{touching:?}");
    }

    #[test]
    fn opposite_normals_push_every_way() {
        for mu in [1e-9, 1e-3, 0.5, 3.0] {
            for normal in [Vector3::x(), Vector3::z(), Vector3::new(0.48, 0.6, 0.64)] {
                let sum = ConeSum::new(&[contact(normal, mu), contact(-normal, 0.1)]);
                assert!(sum.is_everything() && sum.holds_weight(), "{normal:?}");
                assert_eq!(sum.takeoff_slopes(Vector2::y()), SlopeInterval::ALL);
                assert_eq!(sum.landing_slopes(Vector2::y()), SlopeInterval::ALL);
            }
        }
        let none = FrictionCone::new(0.0).unwrap();
        assert!(ContactCone::new(Vector3::z(), none).is_err());
    }

    /// Two normals in the plane of travel, this much less than `pi - phi_1 - phi_2` apart.
    fn nearly_opposite(less_deg: f64) -> [ContactCone; 2] {
        let phi = [0.4f64, 0.3];
        let apart = PI - phi[0] - phi[1] - less_deg.to_radians();
        // Symmetric in their outer edges about the vertical: these are at +-90 degrees from it at an angle of pi - phi_1 - phi_2.
        let [left, right] = [PI / 2.0 - phi[0], apart - PI / 2.0 + phi[0]];
        [
            contact(Vector3::new(-left.sin(), 0.0, left.cos()), phi[0].tan()),
            contact(Vector3::new(right.sin(), 0.0, right.cos()), phi[1].tan()),
        ]
    }

    #[test]
    fn normals_that_leave_a_half_space_leave_a_half_plane() {
        let half = ConeSum::new(&nearly_opposite(0.0));
        assert!(!half.is_everything());
        for e in [Vector2::x(), -Vector2::x(), Vector2::y(), Vector2::new(0.6, 0.8)] {
            let cut = half.cut(e);
            assert!((cut.opening().unwrap().degrees() - 180.0).abs() < 1e-9, "{cut:?}");
            assert!(half.takeoff_slopes(e).lower.abs() < 1e-7 && half.takeoff_slopes(e).upper == f64::INFINITY);
            assert!(half.landing_slopes(e).upper.abs() < 1e-7 && half.landing_slopes(e).lower == f64::NEG_INFINITY);
        }
        // With a third contact on its side the half-space stays; with one below it grows to all of space.
        let [one, other] = nearly_opposite(0.0);
        let with_third = ConeSum::new(&[one, contact(Vector3::z(), 0.5), other]);
        assert_eq!(with_third.cut(Vector2::x()), half.cut(Vector2::x()));
        assert!(ConeSum::new(&[one, contact(-Vector3::z(), 0.5), other]).is_everything());
        // The half-space, on its side: the plane of travel is its border.
        let aside = half_space_aside();
        assert_eq!(aside.cut(Vector2::x()), PlaneCut::Everything);
        assert_eq!(aside.takeoff_slopes(Vector2::x()), SlopeInterval::ALL);
        // Seen along its normal it faces ahead: every slope of take-off, none of landing.
        assert_eq!(aside.takeoff_slopes(Vector2::y()), SlopeInterval::ALL);
        assert!(aside.landing_slopes(Vector2::y()).is_empty());
        assert_eq!(aside.landing_slopes(-Vector2::y()), SlopeInterval::ALL);
    }

    /// The half-space of directions with a part towards +y: the contacts are at +-phi from the x axis, each with friction angle phi.
    fn half_space_aside() -> ConeSum {
        let [sine, cosine] = [0.6, 0.8];
        ConeSum::new(&[contact(Vector3::new(cosine, sine, 0.0), 0.75), contact(Vector3::new(-cosine, sine, 0.0), 0.75)])
    }

    #[test]
    fn a_little_less_is_nearly_a_half_plane_and_a_little_more_is_everything() {
        let nearly = ConeSum::new(&nearly_opposite(1e-4));
        let cut = nearly.cut(Vector2::x());
        let opening_deg = cut.opening().unwrap().degrees();
        assert!((opening_deg - (180.0 - 1e-4)).abs() < 1e-9, "{opening_deg}");
        for tilt in [1e-4, 1e-7] {
            assert!(!ConeSum::new(&nearly_opposite(tilt)).is_everything());
            assert!(ConeSum::new(&nearly_opposite(-tilt)).is_everything());
        }
    }

    #[test]
    fn a_plane_that_touches_a_cone_has_one_ray() {
        // sin phi = 0.6 = the part of the normal across the plane.
        let touching = contact(Vector3::new(0.0, 0.6, 0.8), 0.75);
        let cut = ConeSum::new(&[touching]).cut(Vector2::x());
        assert_eq!(cut.opening().map(Angle::degrees), Some(0.0), "{cut:?}");
        assert!(cut.contains([0.0, 1.0]) && !cut.contains([0.0, -1.0]));
        // Two cones touched from either side: the plane joins their edges, as one ray.
        let both = ConeSum::new(&[touching, contact(Vector3::new(0.0, -0.6, 0.8), 0.75)]);
        assert!(both.holds_weight());
    }
}

/// Errata of Campana, Fernbach, Tonneau, Taix and Laumond 2016, each as a case.
mod errata {
    use super::*;

    /// Kc is inside K for a unit axis only: `n_c.v >= |v| cos phi` with the bare sum lets directions in that no contacts produce.
    #[test]
    fn the_bare_sum_of_normals_lets_directions_out_of_the_cone() {
        let draw = &mut Draw::seeded(31);
        let (mut bare_out, mut unit_out, mut all) = (0, 0, 0);
        for _ in 0..4_000 {
            let contacts: Vec<ContactCone> =
                (0..2 + draw.below(3)).map(|_| contact((Vector3::z() + direction(draw) * 0.5).normalize(), 0.5)).collect();
            let sum = ConeSum::new(&contacts);
            let axis: Vector3<f64> = contacts.iter().map(ContactCone::normal).sum();
            let cosine = 1.0 / 1.25f64.sqrt();
            let v = direction(draw);
            if axis.dot(&v) >= cosine {
                all += 1;
                bare_out += usize::from(!sum.contains(v));
                unit_out += usize::from(axis.normalize().dot(&v) >= cosine && !sum.contains(v));
            }
        }
        assert!(bare_out * 10 > all && unit_out == 0, "{bare_out} and {unit_out} of {all}");
    }

    /// `n_c = 0` is called invalid, though such a stance holds every force.
    #[test]
    fn normals_that_cancel_hold_everything() {
        let chimney = [contact(Vector3::x(), 0.3), contact(-Vector3::x(), 0.3)];
        assert!(ConeKind::Kc.cone(&chimney).is_nothing());
        assert!(ConeKind::KcPlus.cone(&chimney).is_everything());
        assert!(ConeKind::Exact.cone(&chimney).is_everything());
        assert!(PYRAMIDS.iter().all(|edges| ConeKind::Pyramid(*edges).cone(&chimney).is_everything()));
    }

    /// Equal friction for all contacts narrows the cone: floor of 0.2 and wall of 0.8.
    #[test]
    fn the_least_friction_of_all_is_not_the_friction_of_each() {
        let [floor, wall] = [Vector3::z(), Vector3::x()];
        let each = ConeSum::new(&[contact(floor, 0.2), contact(wall, 0.8)]).takeoff_slopes(Vector2::x());
        let least = ConeSum::new(&[contact(floor, 0.2), contact(wall, 0.2)]).takeoff_slopes(Vector2::x());
        assert!((each.lower + 0.8).abs() < 1e-12 && (least.lower + 0.2).abs() < 1e-12, "{each:?} {least:?}");
    }

    /// Three walls at 120 degrees of a pit: no two of them hold everything, all three do.
    #[test]
    fn force_closure_may_take_three_contacts() {
        let wall = |turn: f64| contact(Vector3::new(turn.cos(), turn.sin(), 0.0), 0.1);
        let walls = [0.0, TAU / 3.0, 2.0 * TAU / 3.0].map(wall);
        assert!(ConeSum::new(&walls).is_everything());
        for (one, other) in [(0, 1), (1, 2), (2, 0)] {
            assert!(!ConeSum::new(&[walls[one], walls[other]]).is_everything());
        }
    }

    /// Section 4 draws the landing within `X_max = v^2 / g`, which needs a take-off at 45 degrees: friction of at least 1.
    #[test]
    fn the_greatest_reach_on_level_ground_needs_a_friction_of_one() {
        let reach = |mu: f64| {
            let steepest_use = ConeKind::Kc.cone(&[contact(Vector3::z(), mu)]).takeoff_slopes(Vector2::x()).lower.max(1.0);
            // The speed of the arc over X = 1 m for g = 1 m/s^2; X_max goes with its square.
            let arc = chta::ballistics::Arc::new(chta::ballistics::LineOfSight::new(1.0, 0.0), steepest_use, 1.0);
            1.0 / arc.takeoff_speed_m_s().powi(2)
        };
        assert!((reach(1.0) - 1.0).abs() < 1e-12 && (reach(1.3) - 1.0).abs() < 1e-12);
        // s = 1 / 0.6: 2 s / (1 + s^2) = 0.882.
        assert!((reach(0.6) - 0.882_352_941_176_470_6).abs() < 1e-12, "{}", reach(0.6));
    }
}

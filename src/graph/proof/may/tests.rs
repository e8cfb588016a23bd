//! Checks every refusal of the interval test at points of both cells in exact rational arithmetic.

use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed, Zero};

use super::*;
use crate::{
    chain::{ConstrainedChain, PolygonalChain},
    draw::Draw,
    graph::proof::{
        Sound,
        cell::{partition, stretch},
        tests::drawn_chain,
    },
    quantity::Outwards,
    world::{ClearanceRule, Gravity, Hopper, HopperLimits},
};

fn exact(number: f64) -> BigRational {
    BigRational::from_f64(number).unwrap()
}

/// A position on the chain in exact arithmetic: its x, its height on the straight line, and its site.
struct Place {
    x: BigRational,
    z: BigRational,
    site: Site,
}

impl Place {
    fn at(chain: &PolygonalChain, site: Site, x_m: f64) -> Self {
        let x = exact(x_m);
        let z = match site {
            Site::Vertex(vertex) => exact(chain.vertices()[vertex.index()].z_m),
            Site::Inside(segment) => {
                let [a, b] = [0, 1].map(|end| chain.vertices()[segment.index() + end]);
                let slope = (exact(b.z_m) - exact(a.z_m)) / (exact(b.x_m) - exact(a.x_m));
                exact(a.z_m) + slope * (&x - exact(a.x_m))
            }
        };
        Self { x, z, site }
    }
}

/// Whether any arc from one position to another satisfies all limits, speeds with their tolerance. Each limit bounds the
/// loft, the two speeds by `n^2 - 2 h n + 1 + b^2 <= 0` with the smaller `h` of both; of the lofts that the other limits
/// allow it suffices to test the one nearest to `h`.
fn is_hop(chain: &ConstrainedChain, hopper: &Hopper, g: f64, takeoff: &Place, landing: &Place) -> bool {
    let forward = takeoff.x < landing.x;
    let direction = if forward { Direction::Forward } else { Direction::Reverse };
    let rule = |place: &Place, contact| {
        let station = chain.geometry().vertices();
        let segment = match place.site {
            Site::Inside(segment) => Some(segment.index()),
            Site::Vertex(v) if (contact == Contact::Takeoff) == forward => (v.index() + 1 < station.len()).then_some(v.index()),
            Site::Vertex(v) => v.index().checked_sub(1),
        };
        segment.and_then(|segment| chain.segments()[segment].check_contact(contact, direction).ok())
    };
    let (Some(from), Some(to)) = (rule(takeoff, Contact::Takeoff), rule(landing, Contact::Landing)) else { return false };
    let run = (&landing.x - &takeoff.x).abs();
    let b = (&landing.z - &takeoff.z) / &run;
    let two = BigRational::from_i32(2).unwrap();
    let mut lower = BigRational::zero();
    let mut upper: Option<BigRational> = None;
    let mut raise = |bound: BigRational| lower = lower.clone().max(bound);
    let mut cap = |bound: BigRational| upper = Some(upper.take().map_or(bound.clone(), |known| known.min(bound)));
    for (slope, sign) in [(from.slopes().lower, 1), (-to.slopes().upper, -1)] {
        if slope.is_finite() {
            raise(exact(slope) - if sign > 0 { b.clone() } else { -b.clone() });
        }
    }
    for (slope, sign) in [(from.slopes().upper, 1), (-to.slopes().lower, -1)] {
        if slope.is_finite() {
            cap(exact(slope) - if sign > 0 { b.clone() } else { -b.clone() });
        }
    }
    if let Some(time_s) = hopper.limits().flight_time_max_s {
        cap(exact(g) * exact(time_s) * exact(time_s) / (&two * &run));
    }
    // The ground between the ends, by distance from the take-off.
    let mut ground: Vec<(BigRational, BigRational)> = chain
        .geometry()
        .vertices()
        .iter()
        .map(|vertex| (exact(vertex.x_m), exact(vertex.z_m)))
        .filter(|(x, _)| {
            (x - &takeoff.x).is_positive() == forward
                && (&landing.x - x).is_positive() == forward
                && *x != takeoff.x
                && *x != landing.x
        })
        .map(|(x, z)| ((x - &takeoff.x).abs(), z))
        .collect();
    ground.push((BigRational::zero(), takeoff.z.clone()));
    ground.push((run.clone(), landing.z.clone()));
    ground.sort();
    let eps = exact(hopper.limits().clearance_m);
    if let Some(taper) = hopper.limits().clearance_rule.taper().filter(|_| eps.is_positive()) {
        let ramp = (&eps / exact(taper)).min(&run / &two);
        for kink in [ramp.clone(), &run - &ramp] {
            let next = ground.iter().position(|(d, _)| *d >= kink).unwrap();
            let ((d, z), (e, y)) = (&ground[next - 1], &ground[next]);
            let height = z + (y - z) * (&kink - d) / (e - d);
            ground.insert(next, (kink, height));
        }
    }
    let ends = (BigRational::zero(), run.clone());
    for (d, z) in ground.iter().filter(|(d, _)| *d != ends.0 && *d != ends.1) {
        let e = &run - d;
        let kept = match hopper.limits().clearance_rule {
            ClearanceRule::Vertex => eps.clone(),
            ClearanceRule::Tapered(taper) => eps.clone().min(exact(taper) * d).min(exact(taper) * &e),
        };
        let top = z + kept;
        raise((&top - &takeoff.z) / d + (&top - &landing.z) / &e);
    }
    let ratio = |speed: f64| {
        let v = exact(speed) * (BigRational::one() + exact(SPEED_TOLERANCE));
        &v * &v / (exact(g) * &run)
    };
    let half_sum = (ratio(from.speed_max_m_s()) - &b).min(ratio(to.speed_max_m_s()) + &b);
    let nearest = half_sum.clone().max(lower.clone());
    let nearest = upper.as_ref().map_or(nearest.clone(), |upper| nearest.clone().min(upper.clone()));
    let left = upper.as_ref().is_none_or(|upper| lower <= *upper && upper.is_positive());
    let is_slow_enough =
        |n: &BigRational| n * n - &two * &half_sum * n + BigRational::one() + &b * &b <= BigRational::zero() && n.is_positive();
    if !(left && is_slow_enough(&nearest)) {
        return false;
    }
    // Speeds are continuous in the loft: between a slower and a faster arc of one interval lies every speed.
    let known = [Some(lower), Some(nearest.clone()), upper];
    let speeds_squared: Vec<_> = known
        .into_iter()
        .flatten()
        .filter(is_slow_enough)
        .map(|n| exact(g) * &run * (BigRational::one() + (&b + &n) * (&b + &n)) / (&two * n))
        .collect();
    let squared = |speed: f64, sign: i32| {
        let v = exact(speed) * (BigRational::one() + BigRational::from_i32(sign).unwrap() * exact(SPEED_TOLERANCE));
        &v * &v
    };
    let slower = |speed: f64| speeds_squared.iter().any(|found| *found <= squared(speed, 1));
    let faster = |speed: f64| speeds_squared.iter().any(|found| *found >= squared(speed, -1));
    hopper.limits().takeoff_speed_min_m_s.is_none_or(faster)
        && hopper.limits().takeoff_speed_levels.is_none_or(|levels| levels.as_slice().iter().any(|v| slower(*v) && faster(*v)))
}

/// The number of refused pairs of cells, and the number of refusals that are wrong for some pair of points.
fn refusals(chains: usize) -> (usize, usize) {
    let draw = &mut Draw::seeded(71);
    let (mut refused, mut wrong) = (0, 0);
    for _ in 0..chains {
        let chain = drawn_chain(draw);
        let hopper = Hopper::new(HopperLimits { apex_height_max_m: None, ..*chain.hopper().limits() }).unwrap();
        let test = HopTest::new(chain.with_hopper(&hopper, chain.gravity()).unwrap());
        let prover = Prover::<Sound>::new(&test);
        let geometry = chain.geometry();
        let (first, last) = (geometry.vertex_station(VertexId(0)), geometry.station(geometry.extent_m().1).unwrap());
        let whole = partition::<Sound>(geometry, prover.slopes(), [&first, &last]);
        // Stretches of all widths, some of them single points.
        let cells: Vec<_> = whole
            .iter()
            .flat_map(|cell| {
                let Site::Inside(segment) = cell.site else { return vec![*cell] };
                let inside =
                    |draw: &mut Draw| draw.uniform(cell.from_m, cell.to_m).clamp(cell.from_m.next_up(), cell.to_m.next_down());
                let (a, b) = (inside(draw), inside(draw));
                let cut = [(cell.from_m, a.min(b)), (a.min(b), a.max(b)), (a, a), (b.max(a), cell.to_m)];
                cut.map(|(from_m, to_m)| stretch::<Sound>(geometry, prover.slopes(), segment, from_m, to_m)).to_vec()
            })
            .collect();
        for _ in 0..30 {
            let (a, b) = (&cells[draw.below(cells.len())], &cells[draw.below(cells.len())]);
            let apart = a.to_m <= b.from_m || b.to_m <= a.from_m;
            if !apart || a == b || prover.may(a, b).is_ok() {
                continue;
            }
            refused += 1;
            // Interior points only: an end of a stretch may be a vertex, which is a cell of its own.
            let point = |draw: &mut Draw, cell: &Cell<Outwards>| match (cell.from_m < cell.to_m, draw.below(3)) {
                (false, _) => cell.from_m,
                (true, 0) => cell.from_m.next_up(),
                (true, 1) => cell.to_m.next_down(),
                (true, _) => draw.uniform(cell.from_m, cell.to_m).clamp(cell.from_m.next_up(), cell.to_m.next_down()),
            };
            let caught = (0..3).any(|_| {
                let (from_m, to_m) = (point(draw, a), point(draw, b));
                let (from, to) = (Place::at(geometry, a.site, from_m), Place::at(geometry, b.site, to_m));
                from_m != to_m && is_hop(&chain, &hopper, chain.gravity().m_s2(), &from, &to)
            });
            wrong += usize::from(caught);
        }
    }
    (refused, wrong)
}

#[test]
fn no_refusal_is_wrong_in_exact_arithmetic() {
    let (refused, wrong) = refusals(30);
    assert!(refused > 400, "only {refused} refusals");
    assert_eq!(wrong, 0, "of {refused} refusals");
}

#[test]
fn a_refused_pair_of_cells_stays_refused_after_splitting() {
    // A run of exactly one reach at 45 degrees, v^2 / g = 25 m, is feasible; a run longer by a millionth is not.
    let line = crate::chain::LineConstraints::from_cone(0.0, crate::quantity::Angle::from_degrees(60.0), 5.0, 5.0);
    let form = crate::chain::GroundForm::Explicit { forward: Some(line), reverse: Some(line) };
    let points = [(0.0, 0.0), (25.0, 0.0), (25.000_025, 0.0), (60.0, 0.0)].map(|(x, z)| crate::quantity::ChainPoint::new(x, z));
    let geometry =
        PolygonalChain::new(points.to_vec(), vec![crate::chain::SegmentGround { form, keep_out: false }; 3], None).unwrap();
    let surface = crate::world::SurfaceProperties { grip: None, rest: crate::world::RestSlope::Unlimited };
    let chain = ConstrainedChain::new(geometry, &Hopper::UNLIMITED, Gravity::new(1.0).unwrap(), &surface).unwrap();
    let test = HopTest::new(chain.with_hopper(&Hopper::UNLIMITED, Gravity::new(1.0).unwrap()).unwrap());
    let prover = Prover::<Sound>::new(&test);
    let at = |x_m| chain.geometry().station(x_m).unwrap();
    let cells = partition::<Sound>(chain.geometry(), prover.slopes(), [&at(0.0), &at(60.0)]);
    let [start, _, one_reach, _, beyond, ..] = &cells[..] else { panic!("{cells:?}") };
    assert_eq!(prover.may(start, one_reach), Ok(()));
    assert_eq!(prover.may(one_reach, start), Ok(()));
    assert_eq!(prover.may(start, beyond), Err(Limit::TakeoffSpeed));
}

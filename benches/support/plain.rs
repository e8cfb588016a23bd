//! The plain hop test, the reference for the sweep: pair by pair, cheap limits first, the terrain only for the remaining pairs and
//! only up to the first vertex whose bound exceeds the greatest take-off slope. It counts the same feasible pairs.

use chta::{
    ballistics::{LineOfSight, limits},
    chain::{Site, Station},
    hop::HopTest,
    quantity::{ChainPoint, SlopeInterval},
    world::{Contact, Direction},
};

/// The feasible lofts of a hop between two vertices, `None` where there are none.
///
/// The bound of a vertex is computed with one division, `n >= (h - b d) X / (d (X - d))` for a vertex `h` (with the clearance)
/// above the take-off at distance `d`, and its maximum without regard to NaN: about as fast as this loop can be.
#[inline]
pub(crate) fn lofts(test: &HopTest, takeoff: &Station, landing: &Station) -> Option<SlopeInterval> {
    let direction = Direction::between(takeoff.point.x_m, landing.point.x_m)?;
    let chain = test.chain();
    let from = chain.ruling(takeoff, Contact::Takeoff, direction)?.allowed(Contact::Takeoff, direction)?;
    let to = chain.ruling(landing, Contact::Landing, direction)?.allowed(Contact::Landing, direction)?;
    let run_m = (landing.point.x_m - takeoff.point.x_m).abs();
    let sight = LineOfSight::new(run_m, landing.point.z_m - takeoff.point.z_m);
    let cheap = limits::speeds(sight, from.speed_max_m_s(), to.speed_max_m_s(), test.gravity_m_s2())
        .intersect(limits::takeoff_cone(sight, from.slopes()))
        .intersect(limits::landing_cone(sight, to.slopes()));
    if cheap.is_empty() || cheap.upper <= 0.0 {
        return None;
    }
    let (b, clearance) = (sight.slope(), test.clearance());
    let mut lower = cheap.lower;
    if clearance.has_kinks() {
        let kink_m = clearance.kink_m(run_m) * direction.sign();
        for (contact, x_m, slope) in
            [(takeoff.point, takeoff.point.x_m + kink_m, b), (landing.point, landing.point.x_m - kink_m, -b)]
        {
            let ground = chain.geometry().station(x_m).ok()?.point;
            lower = lower.max(clearance.kink_loft((ground.z_m - contact.z_m) / kink_m.abs() - slope, run_m));
        }
        if lower > cheap.upper {
            return None;
        }
    }
    for vertex in between(chain.geometry().vertices(), takeoff, landing) {
        let d = (vertex.x_m - takeoff.point.x_m).abs();
        let bound = ((vertex.z_m - takeoff.point.z_m + clearance.at_m(d, run_m - d)) - b * d) * run_m / (d * (run_m - d));
        if bound > lower {
            lower = bound;
            if lower > cheap.upper {
                return None;
            }
        }
    }
    Some(SlopeInterval { lower, upper: cheap.upper })
}

/// The vertices between two others.
#[inline]
fn between<'a>(vertices: &'a [ChainPoint], a: &Station, b: &Station) -> &'a [ChainPoint] {
    let (Site::Vertex(a), Site::Vertex(b)) = (a.site, b.site) else { return &[] };
    let (first, end) = (a.index().min(b.index()) + 1, a.index().max(b.index()));
    &vertices[first..end.max(first)]
}

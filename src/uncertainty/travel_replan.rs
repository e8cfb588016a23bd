//! Replanning of missions that drive and hop, by what the best mission takes from every node to the goal.

use super::travel::Choice;
use crate::{
    ballistics::{Arc, LineOfSight, TakeoffChoice},
    drive::DriveGround,
    flight::Command,
    ground::{DemGround, MapPosition, Surface, Windows},
    planner::{Amount, LeastAmounts, SurfaceNode, SurfaceNodes, Travel, TravelField, drive_amounts},
};

/// A robot that replans drives to nodes within so many spacings of where it believes to be.
const NEAR_SPACINGS: f64 = 2.0;
/// Nodes nearer than this share of a spacing are no step forward: a robot that errs would drive to them again and again.
const TOO_NEAR_SPACINGS: f64 = 0.3;

/// What the best missions take from all nodes to the goal.
#[derive(Clone, Debug)]
pub struct TravelToGo {
    /// The nodes, the goal among their single places.
    nodes: SurfaceNodes,
    /// The totals from every node to the goal.
    field: TravelField,
    /// Whether it drives, hops or does both.
    travel: Travel,
    /// What every hop takes at least.
    least: LeastAmounts,
}

impl TravelToGo {
    /// The totals of a field over these nodes of a ground, by these means.
    pub fn new(ground: &DemGround, nodes: SurfaceNodes, field: TravelField, travel: Travel) -> Self {
        Self { nodes, field, travel, least: LeastAmounts::over_dem(ground) }
    }

    /// The next move from where the robot believes to be: a drive to a node nearby or a hop, by which the first amount of the field is least
    /// to the goal; `None` if no move leads on.
    pub(super) fn next(
        &self,
        drive: &DriveGround<'_>,
        ground: &DemGround,
        believed: &MapPosition,
        takeoff: TakeoffChoice,
    ) -> Option<Choice> {
        let first = self.field.amounts()[0];
        let mut best: Option<(f64, Choice)> = None;
        let mut offer = |total: f64, choice: Choice| {
            if best.as_ref().is_none_or(|(least, _)| total < *least) {
                best = Some((total, choice));
            }
        };
        if self.travel.drives() {
            let near_m = NEAR_SPACINGS * self.nodes.lattice().spacing_m();
            let too_near_m = TOO_NEAR_SPACINGS * self.nodes.lattice().spacing_m();
            let is_forward = |to: &MapPosition, left: f64| left == 0.0 || (to.at - believed.at).norm() > too_near_m;
            for (to, left) in self.about(ground, believed, near_m, first).filter(|(to, left)| is_forward(to, *left)) {
                if let Ok(leg) = drive.leg(believed, &to) {
                    offer(left + drive_amounts(drive.rover(), &leg, 0.0).of(first), Choice::Drive(to));
                }
            }
        }
        if self.travel.hops() {
            let least = best.as_ref().map_or(f64::INFINITY, |(least, _)| *least);
            if let Some((total, command)) = self.best_hop(ground, believed, takeoff, least) {
                return if total < least { Some(Choice::Hop(command)) } else { best.map(|(_, choice)| choice) };
            }
        }
        best.map(|(_, choice)| choice)
    }

    /// Nodes in a square about a place that lead to the goal, with what is left from them.
    fn about<'n>(
        &'n self,
        ground: &'n DemGround,
        at: &MapPosition,
        near_m: f64,
        first: Amount,
    ) -> impl Iterator<Item = (MapPosition, f64)> + 'n {
        let known = move |node: SurfaceNode| Some((self.nodes.position(ground, node)?, self.field.total(node, first)?));
        self.nodes.about(at.at, near_m).filter_map(known)
    }

    /// The hop by which least is left, of those that take less than `least` in all.
    fn best_hop(
        &self,
        ground: &DemGround,
        believed: &MapPosition,
        takeoff: TakeoffChoice,
        mut least: f64,
    ) -> Option<(f64, Command<MapPosition>)> {
        let first = self.field.amounts()[0];
        let limits = *ground.hopper().limits();
        let reach_m = SurfaceNodes::reach_m(ground);
        let at_least = |(to, left): (MapPosition, f64)| {
            let run_m = libm::hypot(to.at.x - believed.at.x, to.at.y - believed.at.y);
            let sight = (run_m > 0.0).then(|| LineOfSight::new(run_m, to.z_m - believed.z_m))?;
            Some((left + self.least.of_hop(sight).of(first), to, left))
        };
        let candidates = self.about(ground, believed, reach_m, first).filter_map(at_least);
        let mut candidates: Vec<_> = candidates.filter(|(total, ..)| *total < least).collect();
        // The least bound first: once a hop takes no more than the next bound, the rest of the list is of no use.
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = None;
        for (bound, to, left) in candidates {
            if bound >= least {
                break;
            }
            let Some(windows) = ground.windows(believed, &to) else { continue };
            let Some(lofts) = windows.lofts.first() else { continue };
            let Some((_, heading)) = ground.course(believed, &to) else { continue };
            let arc = Arc::new(windows.sight, ground.envelope().loft(takeoff, windows.sight, *lofts), ground.gravity_m_s2());
            let total = left + first.of_arc(&arc, &limits, false);
            if total < least {
                least = total;
                best = Some((total, Command::of_arc(&arc, heading, to)));
            }
        }
        best
    }
}

//! The moves of a robot with legs that walks and hops over a DEM, each walked or flown again by the independent checker.

use super::{
    LegsRouteError, LegsRouted, MeshRouteError,
    objective::roadmap_question,
    travel::{Driven, agreed, drive_leg, driven_again, hop_leg, sums_record},
};
use crate::{
    drive::DriveGround,
    ground::{DemGround, Stance, StanceGround},
    path::HopPath,
    planner::{
        WalkingStances,
        roadmap::{GrownRoadmap, Left, RoadmapMove, RoadmapPath},
    },
    progress::Cancelled,
    report::{DriveRefusalRecord, HopRecord, LegsWalkRecord, TravelLegRecord, TravelTotalsRecord},
    scenario::{DriveKeys, Scenario},
    terrain::{MapProjection, OverlaidDem},
    uncertainty::LegsWalking,
};

/// The ground that a robot walks over, and how it walks.
#[derive(Clone, Debug)]
pub(super) struct Walking {
    ground: DemGround,
    keys: DriveKeys,
}

impl Walking {
    /// Of a scenario with `[drive]`; `None` of one that hops alone. `map`: under the limits that planning may use.
    pub(super) fn of(scenario: &Scenario, map: Option<OverlaidDem>) -> Option<Self> {
        let keys = scenario.drives()?.clone();
        let ground = DemGround::new(map?, &scenario.hopper, scenario.body.gravity, &scenario.surface);
        Some(Self { ground, keys })
    }

    /// The stances with the lines between them.
    pub(super) fn over<'a>(&'a self, stances: &'a StanceGround) -> WalkingStances<'a> {
        WalkingStances::new(stances, DriveGround::new(&self.ground, &self.keys.rover), self.keys.travel)
    }

    /// The record without a path.
    pub(super) fn record(&self, grown: &GrownRoadmap<Stance>) -> LegsWalkRecord {
        let walks = grown.roadmap.walks();
        LegsWalkRecord {
            travel: self.keys.travel,
            neighbours: self.keys.rover.limits().neighbours.count(),
            lines_tested: walks.tested(),
            refusals: DriveRefusalRecord::rows(walks.refusals()),
            legs: Vec::new(),
            totals: None,
        }
    }

    /// What walking assumes.
    pub(super) fn assumption() -> String {
        "walking is judged by the limits of [drive] along the straight line under the root: neither the feet nor the trunk are looked at between \
             two stances"
                .to_owned()
    }

    /// How it walks in trials of a plan.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn in_trials(&self, routed: &LegsRouted, scenario: &Scenario) -> Result<LegsWalking, Cancelled> {
        let (objective, budgets) = (scenario.full_objective(), scenario.total_budgets());
        let question = roadmap_question(scenario, &objective, &budgets);
        let roadmap = &routed.grown.roadmap;
        let left = roadmap.left(&self.over(&routed.ground), routed.grown.ends, &question)?;
        let aims = left.into_iter().enumerate().filter_map(|(node, left)| Some((roadmap.contact(node).clone(), left?)));
        let mut aims: Vec<(Stance, Left)> = aims.collect();
        aims.sort_by(|(_, a), (_, b)| a.amount.total_cmp(&b.amount).then(a.time_s.total_cmp(&b.time_s)));
        let DriveKeys { rover, travel, .. } = &self.keys;
        let amount = objective.amounts()[0];
        Ok(LegsWalking { ground: self.ground.clone(), rover: rover.clone(), travel: *travel, amount, aims })
    }

    /// The moves of a path, and their sums, which are those of the search.
    ///
    /// # Errors
    /// A line that does not pass its check, or sums that differ.
    pub(super) fn moves(
        &self,
        stances: &StanceGround,
        (found, between, path): (&RoadmapPath, &[&Stance], &HopPath),
        projection: Option<&MapProjection>,
    ) -> Result<(Vec<TravelLegRecord>, TravelTotalsRecord), LegsRouteError> {
        let over = self.over(stances);
        let limits = stances.mesh().envelope().hopper().limits();
        let rover = &self.keys.rover;
        let mut rows = HopRecord::rows(path, projection).into_iter().zip(&path.hops);
        let (mut legs, mut walked, mut stretches) = (Vec::new(), Vec::<Driven>::new(), 0);
        let (mut mission_time_s, mut energy_j_kg, mut travelled_m) = (0.0, 0.0, 0.0);
        for (number, each) in found.moves.iter().enumerate() {
            let leg = number + 1;
            match each {
                RoadmapMove::Walk => {
                    let [Some(from), Some(to)] = [number, leg].map(|at| over.place(between[at])) else {
                        return Err(MeshRouteError::Lost.into());
                    };
                    let driven = driven_again((&self.ground, rover), &[from, to]).map_err(Box::new)?;
                    let row = drive_leg(rover, &driven, leg);
                    stretches += u64::from(number == 0 || found.moves[number - 1] != RoadmapMove::Walk);
                    mission_time_s += row.time_s;
                    energy_j_kg += row.energy_j_kg;
                    travelled_m += row.distance_m;
                    legs.push(TravelLegRecord::Drive(Box::new(row)));
                    walked.push(driven);
                }
                RoadmapMove::Hop(_) => {
                    let (mut row, hop) = rows.next().ok_or(MeshRouteError::Lost)?;
                    row.takeoff_x_m = travelled_m;
                    travelled_m += hop.run_m();
                    row.landing_x_m = travelled_m;
                    let row = hop_leg((limits, leg == found.moves.len()), (row, hop), leg);
                    mission_time_s += row.time_s;
                    energy_j_kg += row.energy_j_kg;
                    legs.push(TravelLegRecord::Hop(Box::new(row)));
                }
            }
        }
        let sums = [mission_time_s, energy_j_kg, travelled_m];
        agreed(&found.totals, sums).map_err(Box::new)?;
        let walked: Vec<&Driven> = walked.iter().collect();
        Ok((legs, sums_record((limits, rover), (&walked, stretches), path, sums)))
    }
}

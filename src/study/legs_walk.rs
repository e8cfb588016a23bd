//! The moves of a robot with legs that walks and hops over a DEM, each walked or flown again by the independent checker.

use super::{
    FreeRouteError, LegsRouteError, MeshRouteError,
    travel::{DriveDefect, Driven, differs, drive_leg, driven_again, hop_leg},
};
use crate::{
    drive::DriveGround,
    ground::{DemGround, Stance, StanceGround},
    path::HopPath,
    planner::{
        Amount, Amounts, WalkingStances,
        roadmap::{GrownRoadmap, RoadmapMove, RoadmapPath},
    },
    report::{DriveRefusalRecord, HopRecord, LegsWalkRecord, TravelLegRecord, TravelTotalsRecord},
    scenario::{DriveKeys, Scenario},
    terrain::{MapProjection, OverlaidDem},
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

    /// What walking assumes, and what it leaves out.
    pub(super) fn assumptions(scenario: &Scenario) -> Vec<String> {
        let mut found = vec![
            "walking is judged by the limits of [drive] along the straight line under the root: neither the feet nor the trunk are looked at between \
             two stances"
                .to_owned(),
        ];
        if scenario.uncertainty.is_some() {
            found.push("[uncertainty] changes nothing here: trials of a robot that walks are not made".to_owned());
        }
        found
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
        agreed(&found.totals, [mission_time_s, energy_j_kg, travelled_m])?;
        let lines = || walked.iter().flat_map(|driven| &driven.legs);
        let drive_length_m = lines().map(|line| line.length_m).sum::<f64>();
        let rate = rover.limits().failure_per_m;
        let flown = &path.totals;
        let totals = TravelTotalsRecord {
            hops: path.hops.len() as u64,
            drive_legs: stretches,
            mission_time_s,
            drive_time_s: lines().map(|line| line.time_s).sum(),
            flight_time_s: flown.flight_time_s,
            energy_j_kg,
            energy_j: limits.mass_kg.map(|mass_kg| mass_kg * energy_j_kg),
            delta_v_m_s: flown.delta_v_m_s,
            propellant_kg: flown.propellant.map(|propellant| propellant.used_kg),
            peak_takeoff_speed_m_s: flown.peak_takeoff_speed_m_s,
            distance_m: travelled_m,
            drive_length_m,
            climb_m: lines().map(|line| line.climb_m).sum(),
            descent_m: lines().map(|line| line.descent_m).sum(),
            drive_success: (rate > 0.0).then(|| libm::exp(-rate * drive_length_m)),
        };
        Ok((legs, totals))
    }
}

/// Refuses sums over the moves that are not those of the search.
fn agreed(planned: &Amounts, sums: [f64; 3]) -> Result<(), LegsRouteError> {
    for (amount, sum) in [Amount::MissionTime, Amount::Energy, Amount::Distance].into_iter().zip(sums) {
        if differs(planned.of(amount), sum) {
            let problem = format!("the moves add up to {sum} in {amount}, and the search has {}", planned.of(amount));
            return Err(Box::new(FreeRouteError::Drive(DriveDefect(problem))).into());
        }
    }
    Ok(())
}

//! The picture of a mission over targets.

use super::{
    super::captions::{conditions, title},
    TargetsPlanned, TargetsSimulated,
};
use crate::{
    figure::{Caption, FigureError, Picture, TargetMark, TargetsFigure, VisitRow, draw_targets},
    report::{TargetsAnswer, TripRecord, VisitRecord},
};

impl TargetsPlanned {
    /// The picture: the legs from above, the targets with their visits, and a table of the visits.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        self.picture_with(Vec::new())
    }

    /// The same with more lines above it.
    fn picture_with(&self, lines: Vec<String>) -> Result<Picture, FigureError> {
        let answer = &self.answer;
        let scenario = &self.case.scenario;
        let legs = self.legs.iter().map(|leg| {
            let hops = leg.route.path.iter().flat_map(|path| &path.hops);
            let first = hops.clone().next().and_then(|hop| hop.takeoff.map());
            first.into_iter().chain(hops.filter_map(|hop| hop.landing.map())).collect()
        });
        let name = |number: usize| match answer.targets[number].visit {
            Some(visit) => format!("target {}: visit {visit}", number + 1),
            None => format!("target {}: left out", number + 1),
        };
        let targets = self.stops[1..].iter().enumerate().map(|(number, at)| TargetMark {
            at: *at,
            name: name(number),
            is_visited: answer.targets[number].visit.is_some(),
        });
        let columns = [
            ("hops", ""),
            ("distance", "m"),
            ("energy", "J/kg"),
            ("time", "s"),
            ("hops so far", ""),
            ("energy so far", "J/kg"),
            ("at arrival", "s"),
        ];
        draw_targets(&TargetsFigure {
            caption: Caption {
                title: title("A mission over several targets", scenario),
                lines: [conditions(scenario), result(answer)].into_iter().chain(lines).collect(),
            },
            dem: self.ground.terrain().dem(),
            start: self.stops[0],
            targets: targets.collect(),
            legs: legs.collect(),
            columns: columns.map(|(name, unit)| (name.to_owned(), unit.to_owned())).to_vec(),
            visits: answer.visits.iter().map(row).collect(),
        })
    }
}

impl TargetsSimulated {
    /// The picture of the plan, with what its trials show.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        let shown = self.answer.simulation.as_ref().map(|record| {
            let [low, high] = record.success_rate_ci95.map(|share| 100.0 * share);
            format!(
                "{} trials, {}: {:.1} % fly the whole mission (95 % interval {low:.1} to {high:.1} %)",
                record.trials,
                record.policy,
                100.0 * record.success_rate
            )
        });
        self.planned.picture_with(shown.into_iter().collect())
    }
}

fn result(answer: &TargetsAnswer) -> String {
    let of = format!("{}: {} of {} targets visited", answer.verdict, answer.targets_visited, answer.targets.len());
    let home = if answer.return_to_start { " and back to the start" } else { "" };
    let order = match answer.order {
        crate::planner::VisitOrder::Best if answer.best_over_nodes => "the best order over these nodes",
        crate::planner::VisitOrder::Best => "an order that is not proved to be the best",
        crate::planner::VisitOrder::Given => "the order given",
    };
    answer.hops.map_or_else(|| format!("{of}{home}"), |hops| format!("{of}{home} in {hops} hops, in {order}"))
}

fn row(visit: &VisitRecord) -> VisitRow {
    let stop = |target: Option<usize>| target.map_or_else(|| "start".to_owned(), |target| format!("target {target}"));
    let TripRecord { hops, distance_m, energy_j_kg, mission_time_s, .. } = visit.leg;
    let arrival = &visit.arrival;
    VisitRow {
        leg: format!("{} to {}", stop(visit.from_target), stop(visit.target)),
        numbers: vec![
            hops.to_string(),
            format!("{distance_m:.1}"),
            format!("{energy_j_kg:.2}"),
            format!("{mission_time_s:.1}"),
            arrival.hops.to_string(),
            format!("{:.2}", arrival.energy_j_kg),
            format!("{:.1}", arrival.mission_time_s),
        ],
    }
}

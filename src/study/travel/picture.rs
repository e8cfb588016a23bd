//! The picture of a mission.

use super::{
    super::captions::{conditions, title, wheels},
    TravelSimulated,
    plan::TravelPlanned,
    walk::{Driven, Stretch},
};
use crate::{
    figure::{Caption, FigureError, Picture, TravelFigure, TravelLine, draw_travel},
    ground::Surface,
    path::Hop,
    quantity::{ChainPoint, MapPoint},
    report::TravelTotalsRecord,
    terrain::slice,
};

/// Points of an arc that is drawn.
const ARC_POINTS: u32 = 33;

impl TravelPlanned {
    /// The picture: the mission from above, and as a profile over the distance travelled.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        self.picture_with(Vec::new())
    }

    /// The same with more lines above it.
    fn picture_with(&self, lines: Vec<String>) -> Result<Picture, FigureError> {
        let at = |[x_m, y_m, _]: [f64; 3]| MapPoint::new(x_m, y_m);
        let answer = &self.answer;
        draw_travel(&TravelFigure {
            caption: Caption {
                title: title("A mission that may drive and hop", &self.case.scenario),
                lines: [conditions(&self.case.scenario), wheels(&self.case.scenario), self.result()]
                    .into_iter()
                    .chain(lines)
                    .collect(),
            },
            dem: self.ground.terrain().dem(),
            start: at(answer.start_m),
            goal: at(answer.goal_m),
            legs: self.lines(),
            nearest: answer.stopped.as_ref().map(|stopped| at(stopped.nearest_m)),
        })
    }

    fn result(&self) -> String {
        let answer = &self.answer;
        let Some(TravelTotalsRecord { hops, drive_legs, mission_time_s, energy_j_kg, drive_length_m, .. }) = answer.totals else {
            return format!("{}: the goal was not reached over these nodes", answer.verdict);
        };
        format!(
            "{}: {drive_legs} drive legs ({drive_length_m:.1} m) and {hops} hops in {mission_time_s:.0} s, {energy_j_kg:.1} J/kg",
            answer.verdict
        )
    }

    fn lines(&self) -> Vec<TravelLine> {
        let (mut lines, mut travelled_m) = (Vec::new(), 0.0);
        for stretch in &self.stretches {
            match stretch {
                Stretch::Drive(driven) => lines.push(self.driven(driven, &mut travelled_m)),
                Stretch::Hops(path) => lines.extend(path.hops.iter().map(|hop| self.hop(hop, &mut travelled_m))),
            }
        }
        lines
    }

    /// The ground from one place to another, over the distance travelled.
    fn ground_between(&self, from: MapPoint, to: MapPoint, travelled_m: f64) -> Vec<ChainPoint> {
        let profile = slice(self.ground.terrain().dem(), from, to);
        let points = profile.map(|profile| profile.points).unwrap_or_default();
        points.iter().map(|point| ChainPoint::new(travelled_m + point.x_m, point.z_m)).collect()
    }

    fn driven(&self, driven: &Driven, travelled_m: &mut f64) -> TravelLine {
        let mut profile = Vec::new();
        for (pair, leg) in driven.places.windows(2).zip(&driven.legs) {
            profile.extend(self.ground_between(pair[0].at, pair[1].at, *travelled_m));
            *travelled_m += leg.run_m;
        }
        TravelLine { drives: true, plan: driven.places.iter().map(|place| place.at).collect(), profile, ground: Vec::new() }
    }

    fn hop(&self, hop: &Hop, travelled_m: &mut f64) -> TravelLine {
        let from_m = *travelled_m;
        *travelled_m += hop.run_m();
        let arc = hop.flight_points(self.ground.gravity_m_s2(), ARC_POINTS);
        let plan: Vec<MapPoint> = hop.takeoff.map().into_iter().chain(hop.landing.map()).collect();
        let ground = match plan[..] {
            [from, to] => self.ground_between(from, to, from_m),
            _ => Vec::new(),
        };
        let profile = arc.into_iter().map(|(share, point)| ChainPoint::new(from_m + share * hop.run_m(), point.z_m)).collect();
        TravelLine { drives: false, plan, profile, ground }
    }
}

impl TravelSimulated {
    /// The picture of the plan, with what its trials show.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        let shown = self.answer.simulation.as_ref().map(|record| {
            let [low, high] = record.success_ci95.map(|share| 100.0 * share);
            format!(
                "{} trials, {}: {:.1} % reach the goal (95 % interval {low:.1} to {high:.1} %)",
                record.trials,
                record.policy,
                100.0 * record.success_rate
            )
        });
        self.planned.picture_with(shown.into_iter().collect())
    }
}

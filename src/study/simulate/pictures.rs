//! The pictures of trials.

use nalgebra::Vector2;

use super::{Drifted, Simulated};
use crate::{
    figure::{
        Caption, ConvergencePoint, DensityFigure, ErrorQuantiles, FigureError, Flight, FlownFigure, FlownTrial, LandingBoxes,
        LandingCloud, LandingEllipse, LandingMapFigure, OutcomeBars, Picture, SimulationFigure, Success, draw_density,
        draw_landing_map, draw_simulation,
    },
    path::Hop,
    quantity::{ChainPoint, MapPoint},
    report::{DensityRecord, DriftAnswer},
    scenario::Scenario,
    uncertainty::{Distribution, HopRecord, LandingSummary, RestDensity, Summary, TrialOutcome, Uncertainty, Wilson},
};

impl Simulated {
    /// The sheet with all panels of the trials; `None` if nothing was flown.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Option<Result<Picture, FigureError>> {
        let first = self.summaries.first()?;
        Some(trials_picture(&self.planned.case.scenario, &self.summaries, bundle(self, first)))
    }

    /// The landings on the map, under the first policy; `None` without a map or if nothing was flown.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn landing_map(&self) -> Option<Result<Picture, FigureError>> {
        let (dem, summary) = (self.dem()?, self.summaries.first()?);
        let ends: Vec<_> = self.planned.path.iter().flat_map(|path| &path.hops).filter_map(Hop::map_ends).collect();
        let path = ends.first().map(|(takeoff, _)| *takeoff).into_iter().chain(ends.iter().map(|(_, landing)| *landing)).collect();
        let clouds = summary.landings.iter().zip(&ends).map(|(landing, (_, planned))| cloud(landing, *planned, summary)).collect();
        let caption = caption(&self.planned.case.scenario, std::iter::once(summary));
        Some(draw_landing_map(&LandingMapFigure { caption, dem, path, clouds }))
    }
}

impl Simulated {
    /// Where the trials end on the map, with the shares that the answer states; `None` if nothing was flown.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn density_map(&self, density: &RestDensity) -> Option<Result<Picture, FigureError>> {
        let summary = self.summaries.first()?;
        let ends: Vec<_> = self.planned.path.iter().flat_map(|path| &path.hops).filter_map(Hop::map_ends).collect();
        let path = ends.first().map(|(takeoff, _)| *takeoff).into_iter().chain(ends.iter().map(|(_, landing)| *landing)).collect();
        let mut caption = caption(&self.planned.case.scenario, std::iter::once(summary));
        caption.lines.extend(DensityRecord::new(density).lines());
        Some(draw_rests(density, caption, path))
    }
}

impl Drifted {
    /// Where the trials end on the map, about the start.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn density_map(&self, density: &RestDensity) -> Result<Picture, FigureError> {
        let keys = self.scenario.uncertainty.clone().unwrap_or_default();
        let DriftAnswer { takeoff_speed_m_s, takeoff_angle_deg, hops, trials, .. } = &self.answer;
        let [low, high] = trials.success_rate_ci95;
        let mut lines = vec![
            format!(
                "{hops} hops in any direction, each at {takeoff_speed_m_s} m/s and {takeoff_angle_deg} deg; seed {}",
                keys.seed
            ),
            format_errors(&keys.errors),
            format!(
                "{} of {} trials fly all hops and rest after each, {:.4} (95 % interval {low:.4} to {high:.4})",
                trials.outcomes.reached, trials.trials, trials.success_rate
            ),
        ];
        lines.extend(DensityRecord::new(density).lines());
        draw_rests(density, Caption { title: self.scenario.title.clone().unwrap_or_default(), lines }, vec![self.start])
    }
}

/// The picture of where trials end.
pub(in crate::study) fn draw_rests(density: &RestDensity, caption: Caption, path: Vec<MapPoint>) -> Result<Picture, FigureError> {
    draw_density(&DensityFigure {
        caption,
        dem: density.dem(),
        shares: &density.ends(),
        value_name: "share of all trials that end in the cell of a post".to_owned(),
        path,
        area: density.area_outlines(),
    })
}

/// The sheet with all panels of trials; without `flown` none of their flights.
///
/// # Errors
/// [`FigureError`].
pub(in crate::study) fn trials_picture(
    scenario: &Scenario,
    summaries: &[Summary],
    flown: Option<FlownFigure>,
) -> Result<Picture, FigureError> {
    draw_simulation(&SimulationFigure {
        caption: caption(scenario, summaries.iter()),
        flown,
        errors: summaries.iter().map(boxes).collect(),
        outcomes: summaries.iter().map(bars).collect(),
    })
}

/// The caption: what was flown, under which errors, and the success rates.
fn caption<'a>(scenario: &Scenario, summaries: impl Iterator<Item = &'a Summary>) -> Caption {
    let keys = scenario.uncertainty.clone().unwrap_or_default();
    let mut lines =
        vec![format!("{}; goal tolerance {} m; seed {}", format_errors(&keys.errors), keys.goal_tolerance_m, keys.seed)];
    lines.extend(summaries.map(|summary| {
        let Wilson { rate, low, high } = summary.success;
        format!(
            "{}: {} of {} trials reach the goal, {rate:.4} (95 % interval {low:.4} to {high:.4})",
            summary.policy.name(),
            summary.outcomes.of(TrialOutcome::Reached),
            summary.trials
        )
    }));
    Caption { title: scenario.title.clone().unwrap_or_default(), lines }
}

/// The deviations that are not zero, each with its unit.
fn format_errors(errors: &Uncertainty) -> String {
    let given = errors.by_key().into_iter().filter(|(_, deviation, _)| *deviation > 0.0);
    let words: Vec<String> = given
        .map(|(key, deviation, unit)| {
            let name = key.trim_end_matches("_m_s").trim_end_matches("_m").trim_end_matches("_deg").trim_end_matches("_fraction");
            let name = name.replace("_sigma", "").replace('_', " ").replace("takeoff", "take-off");
            format!("{name} {} {unit}", shortest(deviation))
        })
        .collect();
    let deviations = match errors.distribution {
        Distribution::Normal => "standard deviations",
        Distribution::Uniform => "uniform, standard deviations",
    };
    let stated = (!words.is_empty()).then(|| format!("{deviations}: {}", words.join(", ")));
    let measured = errors.measured.as_ref().map(|rows| format!("errors of {} measured hops", rows.row_count()));
    let parts: Vec<String> = measured.into_iter().chain(stated).collect();
    if parts.is_empty() { "no errors".to_owned() } else { parts.join("; ") }
}

/// A number without the rounding digits that a conversion of angles adds.
fn shortest(number: f64) -> String {
    let text = format!("{number:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Box plots of one policy.
fn boxes(summary: &Summary) -> LandingBoxes {
    let landings = summary.landings.iter().map(|landing| {
        let error = &landing.error;
        ErrorQuantiles {
            count: landing.count,
            mean_m: error.mean_m,
            q05_m: error.q05_m,
            q25_m: error.q25_m,
            q50_m: error.q50_m,
            q75_m: error.q75_m,
            q95_m: error.q95_m,
            max_m: error.max_m,
        }
    });
    LandingBoxes { name: summary.policy.name().to_owned(), landings: landings.collect() }
}

/// Outcomes and convergence of one policy.
fn bars(summary: &Summary) -> OutcomeBars {
    let success = |wilson: &Wilson| Success { rate: wilson.rate, low: wilson.low, high: wilson.high };
    OutcomeBars {
        policy: summary.policy.name().to_owned(),
        counts: summary.outcomes.each().map(|(outcome, count)| (outcome.name().to_owned(), count)).collect(),
        success: success(&summary.success),
        convergence: summary
            .convergence
            .iter()
            .map(|point| ConvergencePoint { trials: point.trials, success: success(&point.success) })
            .collect(),
    }
}

/// The recorded trials over the profile; on a map in side view, and only where the transect has no bend.
fn bundle(simulated: &Simulated, summary: &Summary) -> Option<FlownFigure> {
    let geometry = simulated.planned.test.chain().geometry();
    if !geometry.bends().is_empty() {
        return None;
    }
    let side = Side::of(simulated)?;
    let trials = summary.trajectories.iter().map(|trajectory| FlownTrial {
        flights: trajectory.hops.iter().filter(|hop| hop.landed).filter_map(|hop| side.flight(hop)).collect(),
        reached: trajectory.trial.outcome == TrialOutcome::Reached,
    });
    Some(FlownFigure {
        ground: geometry.vertices().to_vec(),
        planned: simulated.planned.path.iter().flat_map(|path| &path.hops).map(Flight::from).collect(),
        trials: trials.collect(),
        trials_in_all: summary.trials,
    })
}

/// The vertical plane on which flights are projected.
struct Side {
    origin: Vector2<f64>,
    along: Vector2<f64>,
    first_x_m: f64,
}

impl Side {
    fn of(simulated: &Simulated) -> Option<Self> {
        let geometry = simulated.planned.test.chain().geometry();
        let (first_x_m, _) = geometry.extent_m();
        if simulated.dem().is_none() {
            return Some(Self { origin: Vector2::new(first_x_m, 0.0), along: Vector2::x(), first_x_m });
        }
        let (first, last) = geometry.map_points().and_then(|points| points.first().zip(points.last()))?;
        Some(Self { origin: first.coords, along: (last - first).try_normalize(0.0)?, first_x_m })
    }

    /// A flown hop in side view; `None` for a hop perpendicular to the plane.
    fn flight(&self, hop: &HopRecord) -> Option<Flight> {
        let seen = |place: nalgebra::Point3<f64>| {
            ChainPoint::new(self.first_x_m + (place.coords.xy() - self.origin).dot(&self.along), place.z)
        };
        let (from, to) = (seen(hop.takeoff_m), seen(hop.contact_m));
        let speed_along_m_s = (hop.heading.dot(&self.along) * hop.horizontal_m_s).abs();
        (speed_along_m_s > 0.0 && from.x_m != to.x_m).then(|| Flight {
            from,
            to,
            takeoff_slope: hop.takeoff_vertical_m_s / speed_along_m_s,
        })
    }
}

/// The landings of one hop on the map.
fn cloud(landing: &LandingSummary, planned: MapPoint, summary: &Summary) -> LandingCloud {
    let kept = summary.trajectories.iter().flat_map(|trajectory| &trajectory.hops);
    LandingCloud {
        hop: landing.hop as usize,
        planned,
        landings: kept
            .filter(|hop| hop.landed && hop.hop == landing.hop)
            .map(|hop| MapPoint::from(hop.rest_m.coords.xy()))
            .collect(),
        count: landing.count,
        ellipse: landing.ellipse.as_ref().map(|ellipse| LandingEllipse {
            centre: ellipse.centre,
            semi_major_m: ellipse.semi_major_m,
            semi_minor_m: ellipse.semi_minor_m,
            heading_deg: ellipse.orientation.degrees(),
        }),
    }
}

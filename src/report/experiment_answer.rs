//! The results of the experiments, as plain data and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ErrorRecord, SensitivityAnswer, text::Sheet};
use crate::{
    path::Hop,
    uncertainty::experiments::{DriftExperiment, DriftLanding, DriftReading, Experiment},
};

/// The answer of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ExperimentAnswer {
    /// Of `worst-drift`.
    WorstDrift(WorstDriftAnswer),
    /// Of `cone-width`.
    ConeWidth(ConeWidthAnswer),
    /// Of `sensitivity`.
    Sensitivity(SensitivityAnswer),
}

/// The answer of `worst-drift`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorstDriftAnswer {
    /// The experiment's name.
    pub experiment: Experiment,
    /// The interpretation of the paper.
    pub reading: DriftReading,
    /// The seed of all draws.
    pub seed: u64,
    /// Flights from each landing.
    pub flights: u32,
    /// Variance of the noise on each axis.
    pub noise_variance_m2: f64,
    /// Variances of the take-off along, across and up.
    pub takeoff_variances_m2: [f64; 3],
    /// The landings, hop by hop.
    pub landings: Vec<DriftRecord>,
}

/// The landings of one hop of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriftRecord {
    /// The hop's number, from 1.
    pub hop: usize,
    /// The number of flights that landed.
    pub count: usize,
    /// The number of flights that never landed.
    pub lost: u32,
    /// Quantiles of the distance in three dimensions from the planned landing.
    #[serde(flatten)]
    pub error: ErrorRecord,
    /// The landing from which the next hop starts: its position along the chain.
    pub farthest_x_m: f64,
    /// Its distance to the left of the plane of travel.
    pub farthest_y_m: f64,
}

impl DriftRecord {
    fn rows(landings: &[DriftLanding]) -> Vec<Self> {
        let row = |(i, landing): (usize, &DriftLanding)| Self {
            hop: i + 1,
            count: landing.errors_m.len(),
            lost: landing.lost,
            error: ErrorRecord::of(&landing.errors_m),
            farthest_x_m: landing.farthest_m.x,
            farthest_y_m: landing.farthest_m.y,
        };
        landings.iter().enumerate().map(row).collect()
    }
}

/// Rows of errors as text, under their header.
fn error_rows(sheet: &mut Sheet, rows: &[DriftRecord]) {
    sheet.line(format_args!(
        "{:>5}{:>10}{:>6}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}",
        "hop", "landings", "lost", "mean", "5 %", "25 %", "50 %", "75 %", "95 %", "max"
    ));
    for row in rows {
        let numbers = row.error.each().map(|number| number.map_or(format!("{:>10}", "-"), |n| format!("{n:>10.3}"))).concat();
        sheet.line(format_args!("{:>5}{:>10}{:>6}{numbers}", row.hop, row.count, row.lost));
    }
}

impl WorstDriftAnswer {
    /// From the landings of an experiment.
    pub fn new(numbers: &DriftExperiment, landings: &[DriftLanding]) -> Self {
        Self {
            experiment: Experiment::WorstDrift,
            reading: numbers.reading,
            seed: numbers.seed,
            flights: numbers.flights,
            noise_variance_m2: numbers.noise_variance_m2,
            takeoff_variances_m2: numbers.takeoff_variances_m2,
            landings: DriftRecord::rows(landings),
        }
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "worst drift, {}: {} flights from the farthest landing of each hop, seed {}\ndistance from the planned landing (m)",
            self.reading, self.flights, self.seed
        ));
        error_rows(&mut sheet, &self.landings);
        sheet.into_text()
    }
}

/// The answer of `cone-width`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConeWidthAnswer {
    /// The experiment's name.
    pub experiment: Experiment,
    /// The seed of all draws.
    pub seed: u64,
    /// Flights from each landing.
    pub flights: u32,
    /// The horizontal speed at which the speed-dependent displacement equals the paper's.
    pub reference_horizontal_speed_m_s: f64,
    /// From the widest cones to the narrowest.
    pub widths: Vec<ConeWidthRecord>,
}

/// One width of the cones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ConeWidthRecord {
    /// Cone width as a fraction of the original distance from the vertical.
    pub cone_share: f64,
    /// Mean width of the segments' take-off cones.
    pub takeoff_cone_deg: f64,
    /// Hops of the planned path; null without a path.
    pub hops: Option<usize>,
    /// Mean of the hops' take-off angles.
    pub mean_takeoff_angle_deg: Option<f64>,
    /// Mean of the hops' horizontal speeds.
    pub mean_horizontal_speed_m_s: Option<f64>,
    /// Errors over all landings, with the paper's displacement, equally distributed after every landing.
    pub all_landings_fixed: ErrorRecord,
    /// Errors of the last landing only.
    pub last_landing_fixed: ErrorRecord,
    /// Root mean square spread of one hop's landings about their own mean, from the second hop on.
    pub landing_spread_fixed_m: Option<f64>,
    /// Errors over all landings, with a displacement proportional to the horizontal speed, as the paper argues.
    pub all_landings_with_speed: ErrorRecord,
    /// Errors of the last landing only.
    pub last_landing_with_speed: ErrorRecord,
    /// Root mean square spread of one hop's landings about their own mean, from the second hop on.
    pub landing_spread_with_speed_m: Option<f64>,
}

impl ConeWidthAnswer {
    /// No width tried yet.
    pub fn new(numbers: &DriftExperiment, reference_horizontal_speed_m_s: f64) -> Self {
        Self {
            experiment: Experiment::ConeWidth,
            seed: numbers.seed,
            flights: numbers.flights,
            reference_horizontal_speed_m_s,
            widths: Vec::new(),
        }
    }

    /// A width at which no path was found.
    pub fn add_none(&mut self, (cone_share, takeoff_cone_deg): (f64, f64)) {
        let none = ErrorRecord::default();
        self.widths.push(ConeWidthRecord {
            cone_share,
            takeoff_cone_deg,
            hops: None,
            mean_takeoff_angle_deg: None,
            mean_horizontal_speed_m_s: None,
            all_landings_fixed: none,
            last_landing_fixed: none,
            landing_spread_fixed_m: None,
            all_landings_with_speed: none,
            last_landing_with_speed: none,
            landing_spread_with_speed_m: None,
        });
    }

    /// A width with its path, and the landings under both laws of bounce-and-roll displacement.
    pub fn add(
        &mut self,
        (cone_share, takeoff_cone_deg): (f64, f64),
        hops: &[Hop],
        fixed: &[DriftLanding],
        with_speed: &[DriftLanding],
    ) {
        #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
        let mean = |of: fn(&Hop) -> f64| (!hops.is_empty()).then(|| hops.iter().map(of).sum::<f64>() / hops.len() as f64);
        let all = |landings: &[DriftLanding]| {
            let errors: Vec<f64> = landings.iter().flat_map(|landing| &landing.errors_m).copied().collect();
            ErrorRecord::of(&errors)
        };
        let last = |landings: &[DriftLanding]| {
            // If no flight landed at some hop, there is no last landing.
            let reached = landings.last().filter(|_| landings.len() == hops.len());
            reached.map_or(ErrorRecord::default(), |landing| ErrorRecord::of(&landing.errors_m))
        };
        // The first hop starts at a point, without scatter.
        #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
        let spread = |landings: &[DriftLanding]| {
            let squares: Vec<f64> =
                landings.iter().skip(1).filter_map(DriftLanding::spread_m).map(|spread_m| spread_m * spread_m).collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        self.widths.push(ConeWidthRecord {
            cone_share,
            takeoff_cone_deg,
            hops: Some(hops.len()),
            mean_takeoff_angle_deg: mean(|hop| hop.takeoff_angle.degrees()),
            mean_horizontal_speed_m_s: mean(Hop::horizontal_speed_m_s),
            all_landings_fixed: all(fixed),
            last_landing_fixed: last(fixed),
            landing_spread_fixed_m: spread(fixed),
            all_landings_with_speed: all(with_speed),
            last_landing_with_speed: last(with_speed),
            landing_spread_with_speed_m: spread(with_speed),
        });
    }

    /// The answer as text.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "cone width: {} flights from the farthest landing of each hop, seed {}\nspread: of one hop's landings about their own mean; last: \
             median distance of the last hop's landings from the goal",
            self.flights, self.seed
        ));
        sheet.line(format_args!(
            "{:>7}{:>6}{:>11}{:>13}{:>24}{:>24}",
            "cones", "hops", "take-off", "across", "drift fixed (m)", "drift with speed (m)"
        ));
        sheet.line(format_args!(
            "{:>7}{:>6}{:>11}{:>13}{:>12}{:>12}{:>12}{:>12}",
            "", "", "(deg)", "(m/s)", "spread", "last", "spread", "last"
        ));
        for width in &self.widths {
            let number = |number: Option<f64>, digits: usize| number.map_or("-".to_owned(), |n| format!("{n:.digits$}"));
            let hops = width.hops.map_or("none".to_owned(), |hops| hops.to_string());
            sheet.line(format_args!(
                "{:>7}{hops:>6}{:>11}{:>13}{:>12}{:>12}{:>12}{:>12}",
                width.cone_share,
                number(width.mean_takeoff_angle_deg, 2),
                number(width.mean_horizontal_speed_m_s, 3),
                number(width.landing_spread_fixed_m, 3),
                number(width.last_landing_fixed.q50_m, 3),
                number(width.landing_spread_with_speed_m, 3),
                number(width.last_landing_with_speed.q50_m, 3),
            ));
        }
        sheet.into_text()
    }
}

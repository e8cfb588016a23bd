//! Pictures of whole answers.

use super::{
    Caption, ConeWidthFigure, ConeWidthPoint, ErrorQuantiles, LandingBoxes, LandingErrorFigure, SensitivityBar, SensitivityFigure,
    Success, TradeAxis, TradeCell, TradeFigure,
};
use crate::report::{
    ConeWidthAnswer, ErrorRecord, SensitivityAnswer, SweptKeyRecord, TradeAnswer, TradeRow, WorstDriftAnswer, with_unit,
};

fn quantiles(count: usize, error: &ErrorRecord) -> ErrorQuantiles {
    let [mean, q05, q25, q50, q75, q95, max] = error.each().map(|number| number.unwrap_or(0.0));
    ErrorQuantiles { count: count as u64, mean_m: mean, q05_m: q05, q25_m: q25, q50_m: q50, q75_m: q75, q95_m: q95, max_m: max }
}

impl LandingErrorFigure {
    /// Box plots per landing, as the CHTA paper's Fig. 6b.
    pub fn of_worst_drift(answer: &WorstDriftAnswer, title: &str) -> Self {
        let words = format!(
            "{} flights from the farthest landing of each hop, {}; noise {} m², take-off scattered by {:?} m²; seed {}",
            answer.flights, answer.reading, answer.noise_variance_m2, answer.takeoff_variances_m2, answer.seed
        );
        let landings = answer.landings.iter().map(|landing| quantiles(landing.count, &landing.error)).collect();
        Self {
            caption: Caption::new(format!("Worst drift: {title}"), words),
            series: vec![LandingBoxes { name: String::new(), landings }],
        }
    }
}

impl ConeWidthFigure {
    /// Landing errors against the width of the cones, with the displacement proportional to horizontal speed.
    pub fn of(answer: &ConeWidthAnswer, title: &str) -> Self {
        let words = format!(
            "both cones narrowed about the vertical; drift after a landing in proportion to its horizontal speed; {} flights from the \
             farthest landing of each hop, seed {}",
            answer.flights, answer.seed
        );
        let points = answer.widths.iter().map(|width| ConeWidthPoint {
            width_deg: width.takeoff_cone_deg,
            hops: width.hops.map(|hops| hops as u64),
            errors: quantiles(width.hops.unwrap_or(0) * answer.flights as usize, &width.all_landings_with_speed),
        });
        Self { caption: Caption::new(format!("Cone width: {title}"), words), points: points.collect() }
    }
}

impl SensitivityFigure {
    /// What each error costs, from the one that costs most.
    pub fn of(answer: &SensitivityAnswer, title: &str) -> Self {
        let [low, high] = answer.success_rate_ci95;
        let words = format!(
            "each error in turn taken away, on the same draws; {}, {} trials each, seed {}; with all errors {:.4} reach the goal (95 % interval \
             {low:.4} to {high:.4})",
            answer.policy, answer.trials, answer.seed, answer.success_rate
        );
        let bars = answer.errors.iter().map(|row| SensitivityBar {
            name: error_words(&row.setting()),
            cost: Success { rate: row.cost, low: row.cost_ci95[0], high: row.cost_ci95[1] },
        });
        Self { caption: Caption::new(format!("What each error costs: {title}"), words), bars: bars.collect() }
    }
}

/// An error with its size in words, from the key and the value of a scenario: `take-off angle 0.3 deg`.
fn error_words(setting: &str) -> String {
    const UNITS: [(&str, &str); 4] = [("_m_s", " m/s"), ("_m", " m"), ("_deg", " deg"), ("_fraction", " of the value")];
    let (key, value) = setting.split_once(" = ").unwrap_or((setting, ""));
    let unit = UNITS.iter().find(|(ending, _)| key.ends_with(ending));
    let name = unit.and_then(|(ending, _)| key.strip_suffix(ending)).unwrap_or(key);
    let name = name.trim_end_matches("_sigma").replace('_', " ").replace("takeoff", "take-off");
    match value {
        "" => name,
        _ => format!("{name} {value}{}", unit.map_or("", |(_, unit)| unit)),
    }
}

impl TradeFigure {
    /// The cells of a trade, with a title and a line below it: the first key along the horizontal axis, the second along the
    /// vertical.
    pub fn of(answer: &TradeAnswer, title: impl Into<String>, line: impl Into<String>) -> Self {
        let axis = |v: &SweptKeyRecord| TradeAxis { name: axis_words(&v.key), values: v.values.clone() };
        let mut vary = answer.vary.iter().map(axis);
        Self {
            caption: Caption::new(title, format!("{}; {}", line.into(), answer.summary())),
            x: vary.next().unwrap_or_default(),
            y: vary.next(),
            cells: answer.by_lines().flatten().map(cell).collect(),
        }
    }
}

/// A key of a scenario as the name of an axis: `hopper.takeoff_speed_max_m_s` is "greatest take-off speed (m/s)".
fn axis_words(key: &str) -> String {
    let labelled = with_unit(key);
    let unit = labelled.strip_prefix(key).unwrap_or_default();
    let name = key.rsplit('.').next().unwrap_or(key);
    let ending = ["_m_s2", "_m_s", "_j_kg", "_deg", "_kg", "_m", "_s", "_j"].into_iter().find(|ending| name.ends_with(ending));
    let mut parts: Vec<&str> = ending.and_then(|ending| name.strip_suffix(ending)).unwrap_or(name).split('_').collect();
    let (mut before, mut after) = ("", "");
    let mut taken = |part: &str| {
        let at = parts.iter().position(|one| *one == part);
        at.map(|at| parts.remove(at)).is_some()
    };
    if taken("max") {
        before = "greatest ";
    } else if taken("min") {
        before = "least ";
    }
    if taken("sigma") {
        after = if taken("fraction") { ", standard deviation as a share of it" } else { ", standard deviation" };
    }
    let words: Vec<&str> = parts.into_iter().map(|part| if part == "takeoff" { "take-off" } else { part }).collect();
    format!("{before}{}{after}{unit}", words.join(" "))
}

fn cell(row: &TradeRow) -> TradeCell {
    match row.hops {
        Some(hops) => TradeCell::Hops(hops),
        None if row.error.is_some() => TradeCell::Failed,
        None if row.is_closed() => TradeCell::Untraversable,
        None => TradeCell::Open,
    }
}

#[cfg(test)]
mod tests {
    use super::{axis_words, error_words};

    #[test]
    fn errors_are_named_in_words_with_their_unit() {
        for (setting, words) in [
            ("takeoff_speed_sigma_fraction = 0.005", "take-off speed 0.005 of the value"),
            ("takeoff_speed_sigma_m_s = 0.02", "take-off speed 0.02 m/s"),
            ("takeoff_angle_sigma_deg = 0.5", "take-off angle 0.5 deg"),
            ("drift_along_sigma_m = 0.1", "drift along 0.1 m"),
            ("friction_sigma = 0.02", "friction 0.02"),
            ("measured", "measured"),
        ] {
            assert_eq!(error_words(setting), words);
        }
    }

    #[test]
    fn axes_are_named_in_words_with_their_unit() {
        for (key, words) in [
            ("hopper.takeoff_speed_max_m_s", "greatest take-off speed (m/s)"),
            ("hopper.takeoff_angle_min_deg", "least take-off angle (deg)"),
            ("surface.friction_coefficient", "friction coefficient"),
            ("body.gravity_m_s2", "gravity (m/s²)"),
            ("hopper.clearance_m", "clearance (m)"),
            ("uncertainty.takeoff_speed_sigma_fraction", "take-off speed, standard deviation as a share of it"),
            ("uncertainty.heading_sigma_deg", "heading, standard deviation (deg)"),
            ("search.points_per_segment", "points per segment"),
        ] {
            assert_eq!(axis_words(key), words);
        }
    }
}

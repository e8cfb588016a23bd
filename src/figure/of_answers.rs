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
            name: row.setting(),
            cost: Success { rate: row.cost, low: row.cost_ci95[0], high: row.cost_ci95[1] },
        });
        Self { caption: Caption::new(format!("What each error costs: {title}"), words), bars: bars.collect() }
    }
}

impl TradeFigure {
    /// The cells of a trade, with a title and a line below it: the first key along the horizontal axis, the second along the
    /// vertical.
    pub fn of(answer: &TradeAnswer, title: impl Into<String>, line: impl Into<String>) -> Self {
        let axis = |v: &SweptKeyRecord| TradeAxis { name: with_unit(&v.key), values: v.values.clone() };
        let mut vary = answer.vary.iter().map(axis);
        Self {
            caption: Caption::new(title, format!("{}; {}", line.into(), answer.summary())),
            x: vary.next().unwrap_or_default(),
            y: vary.next(),
            cells: answer.by_lines().flatten().map(cell).collect(),
        }
    }
}

fn cell(row: &TradeRow) -> TradeCell {
    match row.hops {
        Some(hops) => TradeCell::Hops(hops),
        None if row.error.is_some() => TradeCell::Failed,
        None if row.is_closed() => TradeCell::Untraversable,
        None => TradeCell::Open,
    }
}

//! The answer of a trade with its picture.

use super::{Case, CellError, Proof, SweptKey, Trade, TradeError, TradedCells, Variation, free_route::along_transect};
#[cfg(feature = "plot")]
use crate::figure::{FigureError, Picture, TradeFigure, draw_trade};
use crate::{
    progress::Progress,
    report::{DeratingRecord, TradeAnswer},
};

/// A verdict for every value of one or two keys, with everything that its views need.
#[derive(Debug)]
pub struct Traded {
    /// The first case, with the first value of every key.
    pub first: Case,
    /// The answer as plain data.
    pub answer: TradeAnswer,
    /// The warnings about the rows.
    pub warnings: Vec<String>,
    /// The cells without an answer: which row, and the reason.
    pub failed: Vec<(usize, CellError)>,
}

impl Traded {
    /// Words the errors of the rows in the caller's way.
    pub fn word_errors(&mut self, sentence: impl Fn(CellError) -> String) {
        for (row, error) in self.failed.drain(..) {
            if let Some(row) = self.answer.rows.get_mut(row) {
                row.error = Some(sentence(error));
            }
        }
    }
}

/// Finds the verdict for every value of one or two keys. The first case of the variation is that of [`Trade::first_cell`].
///
/// # Errors
/// [`TradeError`].
pub fn trade(
    variation: &Variation,
    swept: &[SweptKey],
    proof: Option<Proof>,
    progress: &dyn Progress,
) -> Result<Traded, TradeError> {
    if proof.is_some() {
        along_transect(&variation.first.scenario, "bounds that hold at any resolution are proved")?;
    }
    let trade = Trade::new(&variation.entries, variation.base(), &variation.survey, swept)?;
    let TradedCells { answer, failed, route_warnings } = trade.run(proof.map(|proof| proof.budget_cells), progress)?;
    let first = variation.first.clone();
    let mut warnings = answer.warnings();
    warnings.extend(route_warnings);
    // Where the shares are varied, the rows have them.
    let shares_vary = swept.iter().any(|key| key.key().0 == "derating");
    let derating = DeratingRecord::of(&first.scenario.derating).filter(|_| !shares_vary);
    warnings.extend(derating.map(|derating| derating.sentence()));
    Ok(Traded { first, answer, warnings, failed })
}

#[cfg(feature = "plot")]
impl Traded {
    /// The heat map.
    ///
    /// # Errors
    /// [`FigureError`].
    pub fn picture(&self) -> Result<Picture, FigureError> {
        use super::captions::{SpeedLimit, title};

        let Case { scenario, prepared, .. } = &self.first;
        let varied = |key: &str| self.answer.vary.iter().any(|v| v.key == key);
        let mut line = Vec::new();
        for (end, key, station) in [("from", "terrain.start_x_m", prepared.start), ("to", "terrain.goal_x_m", prepared.goal)] {
            line.extend(station.filter(|_| !varied(key)).map(|station| format!("{end} x = {:.3} m", station.point.x_m)));
        }
        line.extend(scenario.body.name.clone().filter(|_| !varied("body.gravity_m_s2")));
        line.extend(SpeedLimit::stated(&scenario.hopper).filter(|limit| !varied(limit.key)).map(|limit| limit.to_string()));
        draw_trade(&TradeFigure::of(&self.answer, title("Fewest hops", scenario), line.join(", ")))
    }
}

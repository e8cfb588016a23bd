//! Keys that are varied: the least capability, and a verdict for every value.

use std::path::PathBuf;

use super::{
    super::{AskError, Draft, Purpose, Reply},
    OVER_FACETS, refuse,
};
use crate::{
    ballistics::stance::ConeKind,
    progress::Progress,
    report::DocumentKind,
    study::{LegsTradeQuestion, Proof, Requirement, SweptKey, Trade, legs_trade, require, trade},
};

impl Draft {
    /// Finds the least capability with which the goal can be reached.
    ///
    /// # Errors
    /// [`AskError`]. That no value is enough is an answer.
    pub fn require(&self, requirement: &Requirement, progress: &dyn Progress) -> Result<Reply, AskError> {
        let open = self.vary(vec![requirement.strongest(&self.entries)], Purpose::Require)?;
        open.first.case.ends()?;
        let required = require(&open.variation, requirement, progress)?;
        let holds = required.answer.reachable_at.is_some();
        let shown = open.opened(required.shown, &required.shown_entries)?;
        let json = shown.document(DocumentKind::Require, &required.warnings, &required.answer)?;
        Ok(Reply::new(DocumentKind::Require, json, holds))
    }

    /// Finds a verdict for every value of one or two keys.
    ///
    /// # Errors
    /// [`AskError`]. That a value has no answer is stated in its row.
    pub fn trade(&self, swept: &[SweptKey], proof: Option<Proof>, progress: &dyn Progress) -> Result<Reply, AskError> {
        refuse(&[(self.asks_over_facets(Purpose::Trade), "numbers that are varied")], OVER_FACETS)?;
        let open = self.vary(Trade::some_cells(&self.entries, swept, "varied")?, Purpose::Trade)?;
        open.first.case.ends()?;
        let mut traded = trade(&open.variation, swept, proof, progress)?;
        traded.word_errors(|error| error.to_string());
        let json = open.first.document(DocumentKind::Trade, &traded.warnings, &traded.answer)?;
        let reply = Reply::new(DocumentKind::Trade, json, traded.answer.is_traversable());
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(traded.picture()));
        Ok(reply)
    }

    /// Compares robots with legs and kinds of cones over the ground of the scenario; none of either: that of the scenario.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn trade_legs(&self, robots: Vec<PathBuf>, cones: Vec<ConeKind>, progress: &dyn Progress) -> Result<Reply, AskError> {
        let open = self.facets(Purpose::Trade)?.ok_or(AskError::NotHere {
            what: "robots or cones that are varied",
            why: "this scenario has no robot.file with a free route",
        })?;
        let question = LegsTradeQuestion { scenario: &open.scenario, base: &open.base, robots, cones };
        let traded = legs_trade(&question, progress)?;
        let json = open.document(DocumentKind::TradeLegs, &traded.warnings, &traded.answer)?;
        Ok(Reply::new(DocumentKind::TradeLegs, json, traded.answer.is_traversable()))
    }
}

//! Keys that are varied: the least capability, and a verdict for every value.

use super::{
    super::{AskError, Draft, Purpose, Reply},
    OVER_FACETS, refuse,
};
use crate::{
    progress::Progress,
    report::DocumentKind,
    study::{Proof, Requirement, SweptKey, Trade, require, trade},
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
}

//! Slices in all directions from one point.

use std::path::PathBuf;

use super::super::{AskError, Draft, Purpose, Reply, map::inputs};
use crate::{
    progress::Progress,
    quantity::MapPoint,
    report::{Document, DocumentKind},
    study::fan::{FanQuestion, PreparedFan},
    terrain::MapPlace,
};

/// What is asked of a fan.
#[derive(Clone, Debug)]
pub struct FanAsked {
    /// Another DEM than the scenario's.
    pub dem: Option<PathBuf>,
    /// Where all slices begin, m.
    pub from_m: MapPoint,
    /// How many there are, equally spaced clockwise from grid north.
    pub headings: u32,
    /// How long they are at most, m.
    pub length_m: f64,
    /// The most memory, bytes, that the fan may need.
    pub memory_max_bytes: Option<u64>,
}

impl Draft {
    /// Analyses all directions from a point of a DEM.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn fan(&self, asked: &FanAsked, progress: &dyn Progress) -> Result<Reply, AskError> {
        let open = self.clone().map(asked.dem.clone(), Purpose::Fan)?;
        let question = FanQuestion {
            scenario: &open.scenario,
            base: &open.base,
            dem: &open.dem,
            from: MapPlace::Metres(asked.from_m),
            headings: asked.headings,
            length_m: asked.length_m,
            memory_max_bytes: asked.memory_max_bytes,
        };
        let prepared = PreparedFan::new(&question)?;
        let study = prepared.answered(&question, progress)?;
        let warnings = [&open.warnings[..], &study.warnings].concat();
        let document =
            Document::new(DocumentKind::Fan, open.document.clone(), inputs(&open.files(), self)?, warnings, &study.answer);
        let json = document.on_map(prepared.projection.as_ref().ok()).to_json()?;
        let reply = Reply::new(DocumentKind::Fan, json, true);
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || {
            let title = format!("How far in how few hops: {}", open.title_of_map());
            let answer = &study.answer;
            let [x, y] = answer.from_m;
            let line = format!(
                "{} headings from ({x}, {y}) m, at most {} m; {}; {} headings lead to their far end",
                answer.headings,
                answer.length_m,
                crate::study::conditions(&open.scenario),
                answer.reached_ends()
            );
            Some(Ok(crate::figure::draw_rose(answer, &title, &line)))
        });
        Ok(reply)
    }
}

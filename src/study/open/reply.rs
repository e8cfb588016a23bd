//! An answer as callers take it: its document and its picture.

use std::fmt;
#[cfg(feature = "plot")]
use std::sync::Arc;

#[cfg(feature = "plot")]
use crate::figure::{FigureError, Picture};
use crate::{quantity::ChainPoint, report::DocumentKind};

/// How a picture is drawn, when it is wanted.
#[cfg(feature = "plot")]
type Draw = Arc<dyn Fn() -> Option<Result<Picture, FigureError>> + Send + Sync>;

/// An answer.
#[derive(Clone)]
pub struct Reply {
    /// The kind of its document.
    pub kind: DocumentKind,
    /// Its document, as the command writes it.
    pub json: String,
    /// Whether the answer is yes: a path exists, a hop is feasible, a success is shown.
    pub holds: bool,
    /// The ground along the path, by the distance that its hops are counted from. Empty if the path is not along a chain or over slices of a DEM.
    pub ground: Vec<ChainPoint>,
    #[cfg(feature = "plot")]
    draw: Option<Draw>,
}

impl Reply {
    /// An answer without a picture.
    pub(super) fn new(kind: DocumentKind, json: String, holds: bool) -> Self {
        Self {
            kind,
            json,
            holds,
            ground: Vec::new(),
            #[cfg(feature = "plot")]
            draw: None,
        }
    }

    /// The same over the ground of a path.
    pub(super) fn over(self, ground: &[ChainPoint]) -> Self {
        Self { ground: ground.to_vec(), ..self }
    }

    /// The same with its picture.
    #[cfg(feature = "plot")]
    pub(super) fn drawn(self, draw: impl Fn() -> Option<Result<Picture, FigureError>> + Send + Sync + 'static) -> Self {
        Self { draw: Some(Arc::new(draw)), ..self }
    }

    /// Its picture, drawn now; `None` where such an answer has none.
    #[cfg(feature = "plot")]
    pub fn picture(&self) -> Option<Result<Picture, FigureError>> {
        self.draw.as_ref().and_then(|draw| draw())
    }
}

impl fmt::Debug for Reply {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reply").field("kind", &self.kind).field("holds", &self.holds).finish_non_exhaustive()
    }
}

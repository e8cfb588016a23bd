//! The experiment of the CHTA paper, and a test of a claim that the paper leaves untested.

mod cone_width;
mod ground;
mod worst_drift;

pub use cone_width::{CONE_SHARES, DriftLaw, cone_width, narrowed};
pub use worst_drift::{DriftExperiment, DriftLanding, DriftReading, worst_drift};

/// The experiments, with their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// The paper's experiment: the farthest of a hundred landings is the start of the next hundred flights (P section V-B, Fig.
    /// 6b).
    WorstDrift,
    /// Narrower cones about the vertical on the same draws (P section V-B, last sentence).
    ConeWidth,
}

impl Experiment {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::WorstDrift, Self::ConeWidth];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::WorstDrift => "worst-drift",
            Self::ConeWidth => "cone-width",
        }
    }
}

crate::quantity::by_name!(Experiment, Experiment::ALL);

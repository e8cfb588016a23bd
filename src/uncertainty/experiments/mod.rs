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
    /// What each error costs: success without each in turn, on the same draws.
    Sensitivity,
}

impl Experiment {
    /// Whether it flies the trials of `[uncertainty]`.
    pub const fn flies_trials(self) -> bool {
        matches!(self, Self::Sensitivity)
    }

    /// All of them.
    pub const ALL: [Self; 3] = [Self::WorstDrift, Self::ConeWidth, Self::Sensitivity];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::WorstDrift => "worst-drift",
            Self::ConeWidth => "cone-width",
            Self::Sensitivity => "sensitivity",
        }
    }
}

crate::quantity::by_name!(Experiment, Experiment::ALL);

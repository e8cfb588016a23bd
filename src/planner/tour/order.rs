//! In which order targets are visited.

/// In which order targets are visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum VisitOrder {
    /// The best one by the objective.
    #[default]
    Best,
    /// As they are given.
    Given,
}

impl VisitOrder {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Best, Self::Given];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Best => "best",
            Self::Given => "given",
        }
    }
}

crate::quantity::by_name!(VisitOrder, VisitOrder::ALL);

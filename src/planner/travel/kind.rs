//! By what a machine travels.

/// By what a machine travels that can hop and drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Travel {
    /// It hops or drives, whichever is better.
    #[default]
    Both,
    /// It only drives.
    Drive,
    /// It only hops.
    Hop,
}

impl Travel {
    /// All of them, the default first.
    pub const ALL: [Self; 3] = [Self::Both, Self::Drive, Self::Hop];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::Drive => "drive",
            Self::Hop => "hop",
        }
    }

    /// Whether it hops.
    pub const fn hops(self) -> bool {
        !matches!(self, Self::Drive)
    }

    /// Whether it drives.
    pub const fn drives(self) -> bool {
        !matches!(self, Self::Hop)
    }
}

crate::quantity::by_name!(Travel, Travel::ALL);

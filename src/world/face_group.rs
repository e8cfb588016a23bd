//! The surface of a named group of faces of a mesh, where it differs from the rest.

use std::collections::BTreeMap;

use super::{FrictionCone, RestSlope};

/// What a scenario states of a group of faces: what it does not state is that of the whole surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceGroup {
    /// Its friction.
    pub friction: Option<FrictionCone>,
    /// The steepest slope to rest on there: an angle, or none.
    pub rest: Option<RestSlope>,
    /// Whether no hop may begin or end there; flying over it is allowed.
    pub keep_out: bool,
}

/// Groups of faces by their names.
pub type FaceGroups = BTreeMap<String, FaceGroup>;

impl FaceGroup {
    /// The stricter of each limit of two groups that one face belongs to.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let less = |a: FrictionCone, b: FrictionCone| if b.coefficient() < a.coefficient() { b } else { a };
        let rest = match (self.rest, other.rest) {
            (Some(RestSlope::AtMost(a)), Some(RestSlope::AtMost(b))) => Some(RestSlope::AtMost(if b < a { b } else { a })),
            (Some(RestSlope::Unlimited), Some(other)) => Some(other),
            (one, other) => one.or(other),
        };
        Self {
            friction: self.friction.map_or(other.friction, |a| Some(other.friction.map_or(a, |b| less(a, b)))),
            rest,
            keep_out: self.keep_out || other.keep_out,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Angle;

    #[test]
    fn of_two_groups_the_stricter_limit_counts() {
        let friction = |mu| FrictionCone::new(mu).ok();
        let at = |degrees| Some(RestSlope::AtMost(Angle::from_degrees(degrees)));
        let one = FaceGroup { friction: friction(0.4), rest: at(20.0), keep_out: false };
        let other = FaceGroup { friction: friction(0.6), rest: at(10.0), keep_out: true };
        let both = FaceGroup { friction: friction(0.4), rest: at(10.0), keep_out: true };
        assert_eq!((one.and(other), other.and(one)), (both, both));
        let none = FaceGroup::default();
        assert_eq!((one.and(none), none.and(one)), (one, one));
        let free = FaceGroup { rest: Some(RestSlope::Unlimited), ..none };
        assert_eq!((one.and(free).rest, free.and(one).rest, free.and(none).rest), (at(20.0), at(20.0), Some(RestSlope::Unlimited)));
    }
}

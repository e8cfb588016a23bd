//! The groups of faces of a scenario, as they are typed.

use super::{
    Kind,
    values::{fits, number},
};
use crate::{
    quantity::Angle,
    world::{FaceGroup, FaceGroups, FrictionCone, RestSlope},
};

/// Groups of faces; `None` if a key of one is unknown, or has no value that it takes.
pub(super) fn face_groups(value: &toml::Value) -> Option<FaceGroups> {
    let groups = value.as_table().filter(|groups| !groups.is_empty())?;
    let group = |value: &toml::Value| {
        let keys = value.as_table().filter(|keys| !keys.is_empty())?;
        let mut group = FaceGroup::default();
        for (name, value) in keys {
            match name.as_str() {
                "friction_coefficient" => {
                    let friction = number(value).filter(|friction| (0.0..=1e6).contains(friction))?;
                    group.friction = Some(FrictionCone::new(friction).ok()?);
                }
                "rest_slope_max_deg" if fits(value, Kind::AngleOrUnlimited) => {
                    let angle = number(value).filter(|degrees| degrees.is_finite());
                    group.rest =
                        Some(angle.map_or(RestSlope::Unlimited, |degrees| RestSlope::AtMost(Angle::from_degrees(degrees))));
                }
                "keep_out" => group.keep_out = value.as_bool()?,
                _ => return None,
            }
        }
        Some(group)
    };
    groups.iter().map(|(name, value)| Some((name.clone(), group(value)?))).collect()
}

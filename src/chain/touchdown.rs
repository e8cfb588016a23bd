//! The landing of a hopper with brakes: the touchdown straight down, instead of the end of the arc.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{ContactRule, GroundRefusal, LineConstraints};
use crate::{
    quantity::{Angle, AngleInterval},
    world::{FrictionCone, tolerant_speed_m_s},
};

/// The rule of a landing with brakes on a segment: every arc may end there, or none.
///
/// The direction is straight down. It lies in the friction cone where the angle between the vertical and the surface normal is at
/// most the friction angle, in three dimensions; since the vertical lies in every plane of travel, that is the same as in the cone
/// cut by that plane. Stated landing angles must contain -90 degrees.
///
/// ```text
///     tan(inclination) <= mu,    or    l1 <= -90 deg <= l2;        touchdown speed <= landing speed limit
/// ```
///
/// # Arguments
/// `line`: what the ground states for this direction of travel; `held_by`: with friction, the tangent of the inclination of the
/// surface and the cone; `touchdown_m_s`: the touchdown speed.
///
/// # Errors
/// The refusal, if no arc may end there.
pub(super) fn touchdown_rule(
    line: Result<LineConstraints, GroundRefusal>,
    held_by: Option<(f64, FrictionCone)>,
    touchdown_m_s: f64,
) -> Result<ContactRule, GroundRefusal> {
    if let Some((tilt, friction)) = held_by
        && tilt > friction.coefficient()
    {
        return Err(GroundRefusal::TouchdownSlope { tilt: Angle::from_slope(tilt), friction });
    }
    let stated = line?.landing;
    let (angles, max_m_s) = (stated.angles(), stated.speed_max_m_s());
    if max_m_s <= 0.0 {
        return Err(GroundRefusal::SpeedZero);
    }
    if held_by.is_none() && !contains_straight_down(angles) {
        return Err(GroundRefusal::TouchdownCone { angles });
    }
    if touchdown_m_s > tolerant_speed_m_s(max_m_s) {
        return Err(GroundRefusal::TouchdownSpeed { touchdown_m_s, max_m_s });
    }
    let every = AngleInterval { min: Angle::from_radians(-PI), max: Angle::from_radians(PI) };
    Ok(ContactRule::new(every, f64::INFINITY))
}

/// Whether landing angles contain the direction straight down.
pub(crate) fn contains_straight_down(angles: AngleInterval) -> bool {
    angles.min.radians() <= -FRAC_PI_2 && -FRAC_PI_2 <= angles.max.radians()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(min: f64, max: f64) -> AngleInterval {
        AngleInterval::from_degrees(min, max)
    }

    /// Rows by hand: on a slope of 20 degrees the vertical is 20 degrees off the normal.
    #[test]
    fn a_touchdown_is_allowed_for_every_arc_or_for_none() {
        let cone = |angle_deg: f64| FrictionCone::new(Angle::from_degrees(angle_deg).slope()).unwrap();
        let line = |landing, speed| {
            let rule = |angles, speed| ContactRule::new(angles, speed);
            Ok(LineConstraints { takeoff: rule(degrees(0.0, 90.0), 9.0), landing: rule(landing, speed) })
        };
        let tilt = Angle::from_degrees(20.0).slope();
        let rows = [
            ("friction holds", line(degrees(-100.0, -50.0), 3.0), Some((tilt, cone(20.1))), 2.0, "allowed"),
            ("friction does not hold", line(degrees(-100.0, -50.0), 3.0), Some((tilt, cone(19.9))), 2.0, "slope"),
            (
                "exactly the friction angle",
                line(degrees(-100.0, -50.0), 3.0),
                Some((0.5, FrictionCone::new(0.5).unwrap())),
                2.0,
                "allowed",
            ),
            ("the cone of the arc does not count", line(degrees(-60.0, -50.0), 3.0), Some((tilt, cone(25.0))), 2.0, "allowed"),
            ("stated angles", line(degrees(-100.0, -50.0), 3.0), None, 2.0, "allowed"),
            ("stated up to straight down", line(degrees(-90.0, -50.0), 3.0), None, 2.0, "allowed"),
            ("stated short of it", line(degrees(-89.9, -50.0), 3.0), None, 2.0, "cone"),
            ("stated beyond it", line(degrees(-120.0, -90.1), 3.0), None, 2.0, "cone"),
            ("as fast as allowed", line(degrees(-100.0, -50.0), 2.0), None, 2.0, "allowed"),
            ("too fast", line(degrees(-100.0, -50.0), 1.9), None, 2.0, "speed"),
            ("speed 0", line(degrees(-100.0, -50.0), 0.0), None, 0.0, "zero"),
            ("no ground", Err(GroundRefusal::NoGround), None, 2.0, "none"),
        ];
        for (what, line, held_by, speed, expected) in rows {
            let found = match touchdown_rule(line, held_by, speed) {
                Ok(rule) => {
                    assert_eq!(rule.slopes(), crate::quantity::SlopeInterval::ALL, "{what}");
                    assert_eq!(rule.speed_max_m_s(), f64::INFINITY, "{what}");
                    "allowed"
                }
                Err(GroundRefusal::TouchdownSlope { .. }) => "slope",
                Err(GroundRefusal::TouchdownCone { .. }) => "cone",
                Err(GroundRefusal::TouchdownSpeed { .. }) => "speed",
                Err(GroundRefusal::SpeedZero) => "zero",
                Err(_) => "none",
            };
            assert_eq!(found, expected, "{what}");
        }
    }
}

//! Shares of the limits that planning may use, so that the machine keeps a reserve.

use super::{FrictionCone, Grip, Hopper, HopperProblem, InvalidHopper, SpeedLevels, SurfaceProperties, tolerant_speed_m_s};

/// Shares of the limits that planning may use, each above 0 and at most 1. What is planned is flown under the whole limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derating {
    /// Of the greatest take-off speed.
    pub takeoff_speed: f64,
    /// Of the greatest landing speed.
    pub landing_speed: f64,
    /// Of the friction coefficient, and of a rest slope that follows from it.
    pub friction: f64,
}

impl Default for Derating {
    fn default() -> Self {
        Self::NONE
    }
}

impl Derating {
    /// The whole limits.
    pub const NONE: Self = Self { takeoff_speed: 1.0, landing_speed: 1.0, friction: 1.0 };

    /// Whether planning may use the whole limits.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The shares other than 1, for a sentence: `0.9 of the take-off speed`.
    pub fn shares(&self) -> String {
        let named = [
            (self.takeoff_speed, "the take-off speed"),
            (self.landing_speed, "the landing speed"),
            (self.friction, "the friction coefficient"),
        ];
        let said = named.into_iter().filter(|(share, _)| *share != 1.0);
        said.map(|(share, what)| format!("{} of {what}", crate::quantity::format_number(share))).collect::<Vec<_>>().join(", ")
    }

    /// The hopper that planning may use. Of a machine with few take-off speeds the greatest is its greatest level; levels beyond its share
    /// are left out.
    ///
    /// # Errors
    /// [`InvalidHopper`] where the share leaves less than another limit wants: no level, or a greatest speed below the least one, the step
    /// of speeds or the touchdown speed.
    ///
    /// # Examples
    /// ```
    /// use chta::world::{Derating, Hopper};
    /// let hopper = Hopper::with_speeds(10.0, 8.0).unwrap();
    /// let derated = Derating { takeoff_speed: 0.5, ..Derating::NONE }.hopper(&hopper).unwrap();
    /// assert_eq!((derated.limits().takeoff_speed_max_m_s, derated.limits().landing_speed_max_m_s), (5.0, 8.0));
    /// ```
    pub fn hopper(&self, hopper: &Hopper) -> Result<Hopper, InvalidHopper> {
        let mut limits = *hopper.limits();
        limits.landing_speed_max_m_s *= self.landing_speed;
        if self.takeoff_speed != 1.0 {
            let highest_m_s = limits.takeoff_speed_levels.map_or(f64::INFINITY, |levels| levels.highest_m_s());
            limits.takeoff_speed_max_m_s = self.takeoff_speed * limits.takeoff_speed_max_m_s.min(highest_m_s);
            if let Some(levels) = limits.takeoff_speed_levels {
                let most_m_s = tolerant_speed_m_s(limits.takeoff_speed_max_m_s);
                let left: Vec<f64> = levels.as_slice().iter().copied().filter(|speed_m_s| *speed_m_s <= most_m_s).collect();
                let none = |_| {
                    InvalidHopper(vec![HopperProblem {
                        key: "takeoff_speed_levels_m_s",
                        found: levels.lowest_m_s(),
                        expected: "a level within the derated greatest take-off speed",
                    }])
                };
                limits.takeoff_speed_levels = Some(SpeedLevels::new(&left).map_err(none)?);
            }
        }
        Hopper::new(limits)
    }

    /// The grip that planning may use; angles from the slope stay as they are.
    pub fn surface(&self, surface: &SurfaceProperties) -> SurfaceProperties {
        let grip = match surface.grip {
            Some(Grip::Friction(cone)) => Some(Grip::Friction(self.cone(cone))),
            other => other,
        };
        SurfaceProperties { grip, ..*surface }
    }

    /// The friction cone that planning may use.
    pub fn cone(&self, cone: FrictionCone) -> FrictionCone {
        FrictionCone::new(cone.coefficient() * self.friction).unwrap_or(cone)
    }
}

#[cfg(test)]
mod tests {
    use super::{super::HopperLimits, *};

    type Case<'a> = (&'a [f64], f64, f64, Option<&'a [f64]>);

    #[test]
    fn shares_of_levels_leave_the_lower_ones_or_are_refused() {
        let with = |levels: &[f64], max_m_s: f64| {
            let levels = Some(SpeedLevels::new(levels).expect("levels"));
            Hopper::new(HopperLimits { takeoff_speed_levels: levels, ..HopperLimits::with_speeds(max_m_s, 8.0) }).expect("a hopper")
        };
        // The levels and the greatest speed, the share, and the levels left.
        let cases: [Case<'_>; 5] = [
            (&[1.0, 2.0, 4.0], f64::INFINITY, 0.5, Some(&[1.0, 2.0])),
            (&[1.0, 2.0, 4.0], 5.0, 0.5, Some(&[1.0, 2.0])),
            (&[1.0, 2.0, 4.0], 5.0, 0.49, Some(&[1.0])),
            (&[1.0, 2.0, 4.0], 5.0, 1.0, Some(&[1.0, 2.0, 4.0])),
            (&[4.0], 5.0, 0.9, None),
        ];
        for (levels, max_m_s, takeoff_speed, left) in cases {
            let derated = Derating { takeoff_speed, ..Derating::NONE }.hopper(&with(levels, max_m_s));
            match (derated, left) {
                (Ok(derated), Some(left)) => {
                    let found = derated.limits().takeoff_speed_levels.expect("levels");
                    assert_eq!(found.as_slice(), left, "{levels:?} at {takeoff_speed}");
                }
                (Err(refused), None) => assert!(refused.to_string().contains("takeoff_speed_levels_m_s is 4"), "{refused}"),
                other => panic!("{levels:?} at {takeoff_speed}: {other:?}"),
            }
        }
    }
}

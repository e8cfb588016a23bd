//! The robot: the limits of its actuator and its body.

use std::fmt;

use super::{CommandSteps, Gravity, LandingMode, Restitution, SpeedLevels, propulsion, steps};
use crate::quantity::Angle;

/// Where a hopper keeps its clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClearanceRule {
    /// Over all ground flown over, tapered towards both contacts: over the ground at horizontal distances `d` from the take-off
    /// and `e` from the landing the height kept is `min(clearance, k d, k e)`. The number is `k`, metres gained per metre.
    Tapered(f64),
    /// Over every vertex of the profile between take-off and landing, in full (the CHTA paper's rule). It depends on how finely
    /// the ground is divided.
    Vertex,
}

impl ClearanceRule {
    /// The taper that holds unless another is given: half a metre of clearance per metre from either contact.
    pub const DEFAULT_TAPER: f64 = 0.5;
    /// The rule that holds unless another is given.
    pub const TAPERED: Self = Self::Tapered(Self::DEFAULT_TAPER);
    /// The names of all rules, the default first.
    pub const NAMES: [&str; 2] = [Self::TAPERED.name(), Self::Vertex.name()];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tapered(_) => "tapered",
            Self::Vertex => "vertex",
        }
    }

    /// The taper, if the rule has one.
    pub const fn taper(self) -> Option<f64> {
        match self {
            Self::Tapered(taper) => Some(taper),
            Self::Vertex => None,
        }
    }
}

/// The limits of a ballistic hopper as stated, not yet checked: [`Hopper::new`] does that.
///
/// The two speeds are infinite if only the chain's explicit constraints limit them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopperLimits {
    /// Greatest take-off speed, m/s.
    pub takeoff_speed_max_m_s: f64,
    /// Greatest landing speed, m/s.
    pub landing_speed_max_m_s: f64,
    /// Height to keep above the ground flown over, m (epsilon in the CHTA paper).
    pub clearance_m: f64,
    /// Where this height is kept.
    pub clearance_rule: ClearanceRule,
    /// Least take-off angle from the horizontal that the mechanism allows.
    pub takeoff_angle_min: Option<Angle>,
    /// Greatest take-off angle from the horizontal that the mechanism allows.
    pub takeoff_angle_max: Option<Angle>,
    /// Greatest apex above the take-off point, m.
    pub apex_height_max_m: Option<f64>,
    /// Longest flight, s.
    pub flight_time_max_s: Option<f64>,
    /// Least take-off speed that the machine can be commanded, m/s.
    pub takeoff_speed_min_m_s: Option<f64>,
    /// The only take-off speeds that the machine can be commanded.
    pub takeoff_speed_levels: Option<SpeedLevels>,
    /// The steps of its commands.
    pub steps: CommandSteps,
    /// Radius of the ball that the hopper is in flight, m, over meshes alone; 0 counts as none: a point.
    pub radius_m: Option<f64>,
    /// Diameter of the ground that the hopper stands on, m. The plane fitted over it is then held against the rest slope, instead of
    /// the facet under the contact; 0 counts as none.
    pub footprint_m: Option<f64>,
    /// Greatest deviation of the ground under the footprint from the plane fitted over it, m.
    pub roughness_max_m: Option<f64>,
    /// Mass at the start, kg, used for energies and propellant.
    pub mass_kg: Option<f64>,
    /// Rest between hops, s, only used for the mission time: the older name of `settling_time_s`.
    pub rest_time_s: Option<f64>,
    /// How it lands.
    pub landing: LandingMode,
    /// Delta-v of every hop beyond its changes of velocity, m/s: gravity and steering losses.
    pub hop_delta_v_overhead_m_s: Option<f64>,
    /// Specific impulse, s, for the propellant.
    pub isp_s: Option<f64>,
    /// The propellant that it has at the start, kg.
    pub propellant_max_kg: Option<f64>,
    /// Time to prepare a hop, s.
    pub preparation_time_s: Option<f64>,
    /// Time to settle after a landing, s.
    pub settling_time_s: Option<f64>,
    /// Energy to prepare a hop, J, from the energy store.
    pub preparation_energy_j: Option<f64>,
    /// Share of the energy taken from the store that becomes motion; 1 unless given.
    pub efficiency: Option<f64>,
    /// How it bounces after its first contact, in trials; `None`: it stays where it lands.
    pub restitution: Option<Restitution>,
}

impl HopperLimits {
    /// No limits of the hopper: all limits come from the chain.
    pub const UNLIMITED: Self = Self {
        takeoff_speed_max_m_s: f64::INFINITY,
        landing_speed_max_m_s: f64::INFINITY,
        clearance_m: 0.0,
        clearance_rule: ClearanceRule::TAPERED,
        takeoff_angle_min: None,
        takeoff_angle_max: None,
        apex_height_max_m: None,
        flight_time_max_s: None,
        takeoff_speed_min_m_s: None,
        takeoff_speed_levels: None,
        steps: CommandSteps::CONTINUOUS,
        radius_m: None,
        footprint_m: None,
        roughness_max_m: None,
        mass_kg: None,
        rest_time_s: None,
        landing: LandingMode::Ballistic,
        hop_delta_v_overhead_m_s: None,
        isp_s: None,
        propellant_max_kg: None,
        preparation_time_s: None,
        settling_time_s: None,
        preparation_energy_j: None,
        efficiency: None,
        restitution: None,
    };

    /// The two speed limits that every analysis needs, without other limits.
    pub const fn with_speeds(takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64) -> Self {
        Self { takeoff_speed_max_m_s, landing_speed_max_m_s, ..Self::UNLIMITED }
    }
}

impl Default for HopperLimits {
    fn default() -> Self {
        Self::UNLIMITED
    }
}

/// A ballistic hopper: a point mass with valid limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hopper {
    limits: HopperLimits,
}

/// One invalid limit of a hopper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopperProblem {
    /// The limit, by its key in a scenario's table `hopper`.
    pub key: &'static str,
    /// What was found, in the unit that the key names.
    pub found: f64,
    /// What is expected.
    pub expected: &'static str,
}

/// All invalid limits of a hopper.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct InvalidHopper(pub Vec<HopperProblem>);

/// What is expected of a number that may be 0.
pub(super) const NOT_NEGATIVE: &str = "a finite number of at least 0";

/// What is expected of a number that may not be 0.
pub(super) const POSITIVE: &str = "a finite number above 0";

pub(super) fn not_negative(number: f64) -> bool {
    number.is_finite() && number >= 0.0
}

pub(super) fn positive(number: f64) -> bool {
    number.is_finite() && number > 0.0
}

/// The problems found among single values.
#[derive(Default)]
pub(super) struct Problems(pub(super) Vec<HopperProblem>);

impl Problems {
    /// Notes a value that is given and does not hold.
    pub(super) fn ask(&mut self, key: &'static str, value: Option<f64>, holds: impl Fn(f64) -> bool, expected: &'static str) {
        self.0.extend(value.filter(|&value| !holds(value)).map(|found| HopperProblem { key, found, expected }));
    }
}

impl fmt::Display for HopperProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "hopper.{} is {}, expected {}", self.key, self.found, self.expected)
    }
}

impl Hopper {
    /// A hopper without limits of its own: all limits come from the chain.
    pub const UNLIMITED: Self = Self { limits: HopperLimits::UNLIMITED };

    /// A hopper with these limits.
    ///
    /// # Errors
    /// [`InvalidHopper`] with every invalid limit.
    ///
    /// # Examples
    /// ```
    /// use chta::world::{Hopper, HopperLimits};
    /// let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(8.0, 8.0) }).unwrap();
    /// assert_eq!(hopper.limits().clearance_m, 0.1);
    /// let wrong = HopperLimits { clearance_m: -5.0, apex_height_max_m: Some(f64::NAN), ..HopperLimits::default() };
    /// assert_eq!(
    ///     Hopper::new(wrong).unwrap_err().to_string(),
    ///     "hopper.clearance_m is -5, expected a finite number of at least 0; \
    ///      hopper.apex_height_max_m is NaN, expected a finite number of at least 0"
    /// );
    /// ```
    pub fn new(limits: HopperLimits) -> Result<Self, InvalidHopper> {
        const ELEVATION: &str = "an angle from -90 to 90 degrees";
        // No destructuring with `..`, so that a new limit cannot be left unchecked.
        let HopperLimits {
            takeoff_speed_max_m_s,
            landing_speed_max_m_s,
            clearance_m,
            clearance_rule,
            takeoff_angle_min,
            takeoff_angle_max,
            apex_height_max_m,
            flight_time_max_s,
            takeoff_speed_min_m_s,
            takeoff_speed_levels,
            // `steps::problems` checks these.
            steps: _,
            radius_m,
            footprint_m,
            roughness_max_m,
            mass_kg,
            rest_time_s,
            // `propulsion::problems` checks these, and the rest time beside them.
            landing: _,
            hop_delta_v_overhead_m_s: _,
            isp_s: _,
            propellant_max_kg: _,
            preparation_time_s: _,
            settling_time_s: _,
            preparation_energy_j: _,
            efficiency: _,
            // Valid by construction.
            restitution: _,
        } = limits;
        let speed = |number: f64| number > 0.0;
        // The bound is a right angle in radians: 90 in degrees may be rounded.
        let elevation = |angle: Angle| angle.radians().abs() <= std::f64::consts::FRAC_PI_2;
        let angle = |key, angle: Option<Angle>| (key, angle.is_none_or(elevation), angle.map_or(0.0, Angle::degrees), ELEVATION);
        let number = |key, number: Option<f64>, holds: fn(f64) -> bool, expected| {
            (key, number.is_none_or(holds), number.unwrap_or(0.0), expected)
        };
        let in_order = match (takeoff_angle_min, takeoff_angle_max) {
            (Some(min), Some(max)) => !(elevation(min) && elevation(max) && min > max),
            _ => true,
        };
        let checked = [
            number("takeoff_speed_max_m_s", Some(takeoff_speed_max_m_s), speed, "a number above 0"),
            number("landing_speed_max_m_s", Some(landing_speed_max_m_s), speed, "a number above 0"),
            number("clearance_m", Some(clearance_m), not_negative, NOT_NEGATIVE),
            number("clearance_taper", clearance_rule.taper(), positive, POSITIVE),
            angle("takeoff_angle_min_deg", takeoff_angle_min),
            angle("takeoff_angle_max_deg", takeoff_angle_max),
            (
                "takeoff_angle_min_deg",
                in_order,
                takeoff_angle_min.map_or(0.0, Angle::degrees),
                "no more than takeoff_angle_max_deg",
            ),
            number("apex_height_max_m", apex_height_max_m, not_negative, NOT_NEGATIVE),
            number("flight_time_max_s", flight_time_max_s, positive, POSITIVE),
            number("takeoff_speed_min_m_s", takeoff_speed_min_m_s, positive, POSITIVE),
            (
                "takeoff_speed_min_m_s",
                !takeoff_speed_min_m_s.is_some_and(|least_m_s| least_m_s > takeoff_speed_max_m_s),
                takeoff_speed_min_m_s.unwrap_or(0.0),
                "no more than takeoff_speed_max_m_s",
            ),
            (
                "takeoff_speed_levels_m_s",
                !takeoff_speed_levels.is_some_and(|levels| levels.highest_m_s() > takeoff_speed_max_m_s),
                takeoff_speed_levels.map_or(0.0, |levels| levels.highest_m_s()),
                "no level above takeoff_speed_max_m_s",
            ),
            (
                "takeoff_speed_levels_m_s",
                !takeoff_speed_levels.zip(takeoff_speed_min_m_s).is_some_and(|(levels, least)| levels.lowest_m_s() < least),
                takeoff_speed_levels.map_or(0.0, |levels| levels.lowest_m_s()),
                "no level below takeoff_speed_min_m_s",
            ),
            number("radius_m", radius_m, not_negative, NOT_NEGATIVE),
            number("footprint_m", footprint_m, not_negative, NOT_NEGATIVE),
            number("roughness_max_m", roughness_max_m, not_negative, NOT_NEGATIVE),
            (
                "roughness_max_m",
                roughness_max_m.is_none_or(|_| footprint_m.is_some_and(|footprint_m| footprint_m != 0.0)),
                roughness_max_m.unwrap_or(0.0),
                "a footprint_m above 0 beside it, over which the roughness is measured",
            ),
            number("mass_kg", mass_kg, positive, POSITIVE),
            number("rest_time_s", rest_time_s, not_negative, NOT_NEGATIVE),
        ];
        let problems: Vec<_> = checked
            .into_iter()
            .filter(|(_, holds, ..)| !holds)
            .map(|(key, _, found, expected)| HopperProblem { key, found, expected })
            .chain(steps::problems(&limits))
            .chain(propulsion::problems(&limits))
            .collect();
        if problems.is_empty() { Ok(Self { limits }) } else { Err(InvalidHopper(problems)) }
    }

    /// A hopper with the two speed limits that every analysis needs, without other limits.
    ///
    /// # Errors
    /// [`InvalidHopper`] if a speed is not above 0.
    pub fn with_speeds(takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64) -> Result<Self, InvalidHopper> {
        Self::new(HopperLimits::with_speeds(takeoff_speed_max_m_s, landing_speed_max_m_s))
    }

    /// The same hopper with speed limits below the escape speed of the body under this gravity, since a faster hop never lands, and with
    /// the greatest take-off speed that it can command. A speed without limit stays so, since the chain's own limits then apply, which
    /// the chain caps in the same way; so does the landing speed of a hopper that brakes, which is not one of an arc.
    #[must_use]
    pub fn below_escape(&self, gravity: Gravity) -> Self {
        let capped = |speed_m_s: f64| if speed_m_s.is_finite() { speed_m_s.min(gravity.speed_cap_m_s()) } else { speed_m_s };
        let takeoff_speed_max_m_s = self.limits.steps.speed_not_above_m_s(capped(self.limits.takeoff_speed_max_m_s));
        let landing_m_s = self.limits.landing_speed_max_m_s;
        let landing_speed_max_m_s = if self.limits.landing.brakes() { landing_m_s } else { capped(landing_m_s) };
        Self { limits: HopperLimits { takeoff_speed_max_m_s, landing_speed_max_m_s, ..self.limits } }
    }

    /// A hopper that takes any command up to this one's greatest: what an analysis without its steps assumes.
    #[must_use]
    pub fn with_any_command(&self) -> Self {
        let takeoff_speed_max_m_s = self.limits.steps.speed_not_above_m_s(self.limits.takeoff_speed_max_m_s);
        Self { limits: HopperLimits { takeoff_speed_max_m_s, steps: CommandSteps::CONTINUOUS, ..self.limits } }
    }

    /// Its limits.
    #[inline]
    pub const fn limits(&self) -> &HopperLimits {
        &self.limits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The keys of the problems that a change to the limits of a valid hopper causes.
    fn refused(change: impl FnOnce(&mut HopperLimits)) -> Vec<&'static str> {
        let mut limits = HopperLimits::with_speeds(8.0, 8.0);
        change(&mut limits);
        Hopper::new(limits).map_or_else(|InvalidHopper(problems)| problems.iter().map(|p| p.key).collect(), |_| Vec::new())
    }

    #[test]
    fn invalid_limits_are_refused_by_key() {
        let degrees = Angle::from_degrees;
        for bad in [f64::NAN, -1.0, f64::NEG_INFINITY] {
            assert_eq!(refused(|l| l.takeoff_speed_max_m_s = bad), ["takeoff_speed_max_m_s"], "{bad}");
            assert_eq!(refused(|l| l.landing_speed_max_m_s = bad), ["landing_speed_max_m_s"], "{bad}");
        }
        for bad in [f64::NAN, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(refused(|l| l.clearance_m = bad), ["clearance_m"], "{bad}");
            assert_eq!(refused(|l| l.clearance_rule = ClearanceRule::Tapered(bad)), ["clearance_taper"], "{bad}");
            assert_eq!(refused(|l| l.apex_height_max_m = Some(bad)), ["apex_height_max_m"], "{bad}");
            assert_eq!(refused(|l| l.flight_time_max_s = Some(bad)), ["flight_time_max_s"], "{bad}");
            assert_eq!(refused(|l| l.takeoff_speed_min_m_s = Some(bad)).first(), Some(&"takeoff_speed_min_m_s"), "{bad}");
            assert_eq!(refused(|l| l.steps.takeoff_angle = Some(degrees(bad))), ["takeoff_angle_step_deg"], "{bad}");
            assert_eq!(refused(|l| l.steps.takeoff_speed_m_s = Some(bad)), ["takeoff_speed_step_m_s"], "{bad}");
            assert_eq!(refused(|l| l.steps.heading = Some(degrees(bad))), ["heading_step_deg"], "{bad}");
            assert_eq!(refused(|l| l.mass_kg = Some(bad)), ["mass_kg"], "{bad}");
            assert_eq!(refused(|l| l.rest_time_s = Some(bad)), ["rest_time_s"], "{bad}");
        }
        for bad in [f64::NAN, 90.1, -91.0, f64::INFINITY] {
            assert_eq!(refused(|l| l.takeoff_angle_min = Some(degrees(bad))), ["takeoff_angle_min_deg"], "{bad}");
            assert_eq!(refused(|l| l.takeoff_angle_max = Some(degrees(bad))), ["takeoff_angle_max_deg"], "{bad}");
        }
        assert_eq!(refused(|l| l.clearance_rule = ClearanceRule::Tapered(0.0)), ["clearance_taper"]);
        let levels = |list: &[f64]| SpeedLevels::new(list).ok();
        assert_eq!(refused(|l| l.takeoff_speed_min_m_s = Some(8.5)), ["takeoff_speed_min_m_s"]);
        assert_eq!(refused(|l| l.takeoff_speed_levels = levels(&[2.0, 8.5])), ["takeoff_speed_levels_m_s"]);
        let below = |l: &mut HopperLimits| {
            l.takeoff_speed_levels = levels(&[2.0, 8.0]);
            l.takeoff_speed_min_m_s = Some(2.5);
        };
        assert_eq!(refused(below), ["takeoff_speed_levels_m_s"]);
        let reversed = |l: &mut HopperLimits| {
            l.takeoff_angle_min = Some(degrees(60.0));
            l.takeoff_angle_max = Some(degrees(30.0));
        };
        assert_eq!(refused(reversed), ["takeoff_angle_min_deg"]);
    }

    #[test]
    fn the_ends_of_the_ranges_are_accepted() {
        let right = Angle::from_degrees(90.0);
        let limits = HopperLimits {
            takeoff_angle_min: Some(-right),
            takeoff_angle_max: Some(right),
            apex_height_max_m: Some(0.0),
            rest_time_s: Some(0.0),
            ..HopperLimits::UNLIMITED
        };
        assert_eq!(Hopper::new(limits).map(|hopper| *hopper.limits()), Ok(limits));
    }
}

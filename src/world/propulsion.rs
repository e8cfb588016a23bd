//! How a hopper lands, what a hop takes from its stores, and how long it takes on the ground.

use super::{
    HopperLimits, HopperProblem,
    hopper::{NOT_NEGATIVE, POSITIVE, Problems, not_negative, positive},
};

/// How a hopper comes down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LandingMode {
    /// It meets the ground at the end of its arc.
    #[default]
    Ballistic,
    /// It brakes just over the ground and touches down straight down: limits of a landing hold for the touchdown, not for the arc.
    Braked {
        /// The speed of the touchdown, m/s.
        touchdown_speed_m_s: f64,
    },
}

impl LandingMode {
    /// The names of both modes, the default first.
    pub const NAMES: [&str; 2] = [Self::Ballistic.name(), Self::Braked { touchdown_speed_m_s: 0.0 }.name()];

    /// The name in scenarios.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ballistic => "ballistic",
            Self::Braked { .. } => "braked",
        }
    }

    /// The speed of a braked touchdown, m/s; `None` without brakes.
    #[inline]
    pub const fn touchdown_speed_m_s(self) -> Option<f64> {
        match self {
            Self::Ballistic => None,
            Self::Braked { touchdown_speed_m_s } => Some(touchdown_speed_m_s),
        }
    }

    /// Whether it brakes.
    #[inline]
    pub const fn brakes(self) -> bool {
        matches!(self, Self::Braked { .. })
    }
}

impl HopperLimits {
    /// The greatest speed at which an arc may end, m/s: infinite with brakes.
    #[inline]
    pub const fn arc_landing_speed_max_m_s(&self) -> f64 {
        if self.landing.brakes() { f64::INFINITY } else { self.landing_speed_max_m_s }
    }

    /// The time to settle after a landing, s: `settling_time_s`, or `rest_time_s`, its older name.
    pub const fn settling_s(&self) -> Option<f64> {
        match self.settling_time_s {
            Some(time_s) => Some(time_s),
            None => self.rest_time_s,
        }
    }

    /// The time that a journey of some hops takes on the ground, s; `None` if neither time is given.
    ///
    /// ```text
    ///     N preparation + (N - 1) settling
    /// ```
    ///
    /// Each hop is prepared, the first too; the journey ends with the last landing, so the hopper settles between hops.
    ///
    /// # Examples
    /// ```
    /// use chta::world::HopperLimits;
    /// let limits = HopperLimits { preparation_time_s: Some(60.0), settling_time_s: Some(10.0), ..HopperLimits::UNLIMITED };
    /// assert_eq!(limits.ground_time_s(3), Some(200.0));
    /// assert_eq!(limits.ground_time_s(0), Some(0.0));
    /// // An old rest time is a settling time.
    /// assert_eq!(HopperLimits { rest_time_s: Some(30.0), ..HopperLimits::UNLIMITED }.ground_time_s(3), Some(60.0));
    /// ```
    pub fn ground_time_s(&self, hops: usize) -> Option<f64> {
        #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
        let (prepared, settled) = (hops as f64, hops.saturating_sub(1) as f64);
        match (self.preparation_time_s, self.settling_s()) {
            (None, None) => None,
            (None, Some(settling_s)) => Some(settling_s * settled),
            (Some(preparation_s), settling_s) => Some(preparation_s * prepared + settling_s.unwrap_or(0.0) * settled),
        }
    }

    /// The energy that hops take from the store, per unit mass, J/kg.
    ///
    /// ```text
    ///     (sum of v_t^2 / 2) / efficiency + N preparation energy / mass
    /// ```
    ///
    /// # Examples
    /// ```
    /// use chta::world::HopperLimits;
    /// let spring = HopperLimits { efficiency: Some(0.5), mass_kg: Some(2.0), preparation_energy_j: Some(10.0), ..HopperLimits::UNLIMITED };
    /// // Two hops with 6 J/kg of motion in all: 12 J/kg from the store, and 10 J/kg to prepare them.
    /// assert_eq!(spring.store_energy_j_kg(6.0, 2), 22.0);
    /// assert_eq!(HopperLimits::UNLIMITED.store_energy_j_kg(6.0, 2), 6.0);
    /// ```
    pub fn store_energy_j_kg(&self, kinetic_j_kg: f64, hops: usize) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most a million hops")]
        let prepared = hops as f64;
        let of_motion = kinetic_j_kg / self.efficiency.unwrap_or(1.0);
        match (self.preparation_energy_j, self.mass_kg) {
            (Some(energy_j), Some(mass_kg)) => of_motion + prepared * energy_j / mass_kg,
            _ => of_motion,
        }
    }

    /// Whether it has brakes, an overhead or a specific impulse: whether its delta-v says more than its take-off speeds.
    pub const fn is_propulsive(&self) -> bool {
        self.landing.brakes() || self.hop_delta_v_overhead_m_s.is_some() || self.isp_s.is_some()
    }

    /// Whether energies in answers are more than those of motion.
    pub const fn counts_store_energy(&self) -> bool {
        self.efficiency.is_some() || self.preparation_energy_j.is_some()
    }
}

/// What is wrong with the limits that this file is about.
pub(super) fn problems(limits: &HopperLimits) -> Vec<HopperProblem> {
    let mut problems = Problems::default();
    let mut ask = |key, value, holds: &dyn Fn(f64) -> bool, expected| problems.ask(key, value, holds, expected);
    let touchdown = limits.landing.touchdown_speed_m_s();
    ask("touchdown_speed_m_s", touchdown, &not_negative, NOT_NEGATIVE);
    ask(
        "touchdown_speed_m_s",
        touchdown.filter(|&speed| not_negative(speed)),
        &|speed| speed <= limits.landing_speed_max_m_s,
        "no more than landing_speed_max_m_s, which holds for the touchdown",
    );
    ask("hop_delta_v_overhead_m_s", limits.hop_delta_v_overhead_m_s, &not_negative, NOT_NEGATIVE);
    ask("isp_s", limits.isp_s, &positive, POSITIVE);
    ask("isp_s", limits.isp_s, &|_| limits.mass_kg.is_some(), "a hopper.mass_kg beside it, of which the propellant is a share");
    ask("propellant_max_kg", limits.propellant_max_kg, &positive, POSITIVE);
    ask(
        "propellant_max_kg",
        limits.propellant_max_kg,
        &|_| limits.isp_s.is_some(),
        "a hopper.isp_s beside it, without which the propellant of a hop is not known",
    );
    ask(
        "propellant_max_kg",
        limits.propellant_max_kg,
        &|propellant| limits.mass_kg.is_none_or(|mass| propellant < mass),
        "less than hopper.mass_kg, the mass at the start with all propellant",
    );
    ask("preparation_time_s", limits.preparation_time_s, &not_negative, NOT_NEGATIVE);
    ask("settling_time_s", limits.settling_time_s, &not_negative, NOT_NEGATIVE);
    ask(
        "rest_time_s",
        limits.rest_time_s,
        &|_| limits.preparation_time_s.is_none() && limits.settling_time_s.is_none(),
        "not to stand beside preparation_time_s or settling_time_s: it is the old name of settling_time_s, so keep one of the two",
    );
    ask("preparation_energy_j", limits.preparation_energy_j, &not_negative, NOT_NEGATIVE);
    ask(
        "preparation_energy_j",
        limits.preparation_energy_j,
        &|_| limits.mass_kg.is_some(),
        "a hopper.mass_kg beside it, since energies are stated per unit mass",
    );
    ask("efficiency", limits.efficiency, &|share| share > 0.0 && share <= 1.0, "a share above 0 and at most 1");
    problems.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Hopper, InvalidHopper};

    /// Whether a hopper is refused, and by which key: the right answer of each row follows from the meaning of the keys.
    #[test]
    fn keys_that_contradict_each_other_are_refused_by_name() {
        let braked = |touchdown_speed_m_s| LandingMode::Braked { touchdown_speed_m_s };
        let base = HopperLimits { mass_kg: Some(50.0), isp_s: Some(220.0), ..HopperLimits::with_speeds(8.0, 4.0) };
        let rows: [(&str, HopperLimits, Option<&str>); 19] = [
            ("as fast as allowed", HopperLimits { landing: braked(4.0), ..base }, None),
            ("a touchdown at rest", HopperLimits { landing: braked(0.0), ..base }, None),
            ("too fast", HopperLimits { landing: braked(4.1), ..base }, Some("touchdown_speed_m_s")),
            ("negative", HopperLimits { landing: braked(-1.0), ..base }, Some("touchdown_speed_m_s")),
            ("not a number", HopperLimits { landing: braked(f64::NAN), ..base }, Some("touchdown_speed_m_s")),
            ("no mass", HopperLimits { mass_kg: None, ..base }, Some("isp_s")),
            ("no impulse", HopperLimits { isp_s: Some(0.0), ..base }, Some("isp_s")),
            ("propellant", HopperLimits { propellant_max_kg: Some(49.0), ..base }, None),
            ("all propellant", HopperLimits { propellant_max_kg: Some(50.0), ..base }, Some("propellant_max_kg")),
            ("no engine", HopperLimits { propellant_max_kg: Some(5.0), isp_s: None, ..base }, Some("propellant_max_kg")),
            ("overhead", HopperLimits { hop_delta_v_overhead_m_s: Some(-1.0), ..base }, Some("hop_delta_v_overhead_m_s")),
            ("old time alone", HopperLimits { rest_time_s: Some(5.0), ..base }, None),
            ("two times", HopperLimits { rest_time_s: Some(5.0), settling_time_s: Some(5.0), ..base }, Some("rest_time_s")),
            ("old and new", HopperLimits { rest_time_s: Some(5.0), preparation_time_s: Some(0.0), ..base }, Some("rest_time_s")),
            ("efficiency 0", HopperLimits { efficiency: Some(0.0), ..base }, Some("efficiency")),
            ("efficiency 1", HopperLimits { efficiency: Some(1.0), ..base }, None),
            ("efficiency 1.1", HopperLimits { efficiency: Some(1.1), ..base }, Some("efficiency")),
            ("energy", HopperLimits { preparation_energy_j: Some(5.0), ..base }, None),
            (
                "energy of nothing",
                HopperLimits { preparation_energy_j: Some(5.0), mass_kg: None, isp_s: None, ..base },
                Some("preparation_energy_j"),
            ),
        ];
        for (what, limits, expected) in rows {
            let keys = Hopper::new(limits).map_or_else(|InvalidHopper(all)| all.iter().map(|p| p.key).collect(), |_| Vec::new());
            assert_eq!(keys, Vec::from_iter(expected), "{what}");
        }
    }
}

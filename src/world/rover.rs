//! A machine that drives: the limits of its wheels, its speed on slopes, and what driving takes.

use std::fmt;

use super::hopper::{NOT_NEGATIVE, POSITIVE, not_negative, positive};
use crate::quantity::Angle;

/// The nodes about a node to which it drives in a straight line.
///
/// ```text
///     . 3 3 . 3 3 .       1  8 neighbours
///     3 . 2 . 2 . 3       2  16 neighbours have these too
///     3 2 1 1 1 2 3       3  32 neighbours have these too
///     . . 1 o 1 . .
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Neighbours {
    /// Along the lines of the lattice and their diagonals.
    Eight,
    /// The moves of a knight too.
    #[default]
    Sixteen,
    /// Three nodes along and one or two aside too.
    ThirtyTwo,
}

impl Neighbours {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Eight, Self::Sixteen, Self::ThirtyTwo];

    /// How many there are.
    pub const fn count(self) -> usize {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
            Self::ThirtyTwo => 32,
        }
    }

    /// Those of this number.
    pub fn of_count(count: u64) -> Option<Self> {
        Self::ALL.into_iter().find(|neighbours| neighbours.count() as u64 == count)
    }

    /// Where they lie, in nodes to the east and to the north: counterclockwise from east. None lies behind another one.
    ///
    /// # Examples
    /// ```
    /// use chta::world::Neighbours;
    /// assert_eq!(Neighbours::Sixteen.offsets()[..3], [(1, 0), (2, 1), (1, 1)]);
    /// assert!(Neighbours::ALL.iter().all(|neighbours| neighbours.offsets().len() == neighbours.count()));
    /// ```
    pub fn offsets(self) -> Vec<(i32, i32)> {
        let octant: &[(i32, i32)] = match self {
            Self::Eight => &[(1, 0)],
            Self::Sixteen => &[(1, 0), (2, 1)],
            Self::ThirtyTwo => &[(1, 0), (3, 1), (2, 1), (3, 2)],
        };
        // An octant, its mirror image beyond the diagonal, and both turned by a quarter three times.
        let mirrored = octant[1..].iter().rev().map(|&(x, y)| (y, x));
        let quarter: Vec<_> = octant.iter().copied().chain([(1, 1)]).chain(mirrored).collect();
        let mut offsets = quarter.clone();
        for _ in 0..3 {
            let turned: Vec<_> = offsets[offsets.len() - quarter.len()..].iter().map(|&(x, y)| (-y, x)).collect();
            offsets.extend(turned);
        }
        offsets
    }

    /// By which share a path along these directions over flat ground without obstacles is longer than the straight line, at most:
    /// `1 / cos(gap / 2) - 1` for the widest gap between two neighbouring directions.
    ///
    /// # Examples
    /// ```
    /// use chta::world::Neighbours;
    /// let shares = Neighbours::ALL.map(|neighbours| (1e4 * neighbours.elongation()).round() / 1e4);
    /// assert_eq!(shares, [0.0824, 0.0275, 0.0131]);
    /// ```
    pub fn elongation(self) -> f64 {
        let headings: Vec<f64> = self.offsets().iter().map(|&(x, y)| libm::atan2(f64::from(y), f64::from(x))).collect();
        // The widest gap is beside the lines of the lattice, so that those from -180 degrees on need no look.
        let widest = headings.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
        1.0 / libm::cos(0.5 * widest) - 1.0
    }
}

/// The share of its speed that a rover loses by slip, over the slope of the ground along its way: straight between stated slopes, and
/// constant beyond them. Where no slope below 0 is stated, it goes by the steepness, up or down.
#[derive(Clone, Debug, PartialEq)]
pub struct SlipCurve {
    /// As stated: slopes in degrees, ascending, with shares.
    stated: Vec<[f64; 2]>,
    /// The same with the tangents of the slopes.
    points: Vec<(f64, f64)>,
    by_steepness: bool,
}

impl Default for SlipCurve {
    /// No slip.
    fn default() -> Self {
        Self { stated: Vec::new(), points: Vec::new(), by_steepness: true }
    }
}

impl SlipCurve {
    /// What is expected of the points of a curve.
    const EXPECTED: &str =
        "pairs of a slope from -89 to 89 degrees, ascending, and a share from 0 to below 1, the most that an edge may lose";

    /// A curve through points: slope in degrees, share from 0 to below 1.
    ///
    /// # Errors
    /// What is expected: slopes that ascend from -89 to 89 degrees, shares from 0 to below 1.
    ///
    /// # Examples
    /// ```
    /// use chta::world::SlipCurve;
    /// let slip = SlipCurve::new(&[[0.0, 0.0], [45.0, 0.4]])?;
    /// let shares = [0.5, -0.5, 9.0].map(|slope| (1e6 * slip.share(slope)).round() / 1e6);
    /// assert_eq!(shares, [0.2, 0.2, 0.4]);
    /// # Ok::<(), &'static str>(())
    /// ```
    pub fn new(points_deg: &[[f64; 2]]) -> Result<Self, &'static str> {
        let holds = points_deg.iter().all(|[slope, share]| slope.abs() <= 89.0 && (0.0..1.0).contains(share))
            && points_deg.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if !holds {
            return Err(Self::EXPECTED);
        }
        let points = points_deg.iter().map(|[slope, share]| (Angle::from_degrees(*slope).slope(), *share)).collect();
        Ok(Self { stated: points_deg.to_vec(), points, by_steepness: points_deg.iter().all(|[slope, _]| *slope >= 0.0) })
    }

    /// The share lost on a slope, given as its tangent along the way; straight in the tangent between the points. 0 without a point.
    #[inline]
    pub fn share(&self, slope: f64) -> f64 {
        if self.points.is_empty() {
            return 0.0;
        }
        let slope = if self.by_steepness { slope.abs() } else { slope };
        let after = self.points.partition_point(|(at, _)| *at < slope);
        match (after.checked_sub(1).map(|before| self.points[before]), self.points.get(after)) {
            (None, None) => 0.0,
            (Some((_, share)), None) => share,
            (None, Some((_, share))) => *share,
            (Some((from, low)), Some((to, high))) => low + (high - low) * ((slope - from) / (to - from)),
        }
    }

    /// Its points as stated: slopes in degrees, and shares.
    pub fn points_deg(&self) -> &[[f64; 2]] {
        &self.stated
    }
}

/// What a machine that drives states, not yet checked: [`Rover::new`] does that.
#[derive(Clone, Debug, PartialEq)]
pub struct RoverLimits {
    /// The speed over level ground, m/s.
    pub speed_m_s: f64,
    /// The steepest slope that it climbs, along its way; 90 degrees: any.
    pub slope_up_max: Angle,
    /// The steepest slope that it descends; `None`: as for climbs.
    pub slope_down_max: Option<Angle>,
    /// The steepest slope across its way; `None`: as for climbs.
    pub cross_slope_max: Option<Angle>,
    /// The greatest difference of height between its axles, m; needs the wheelbase.
    pub step_max_m: Option<f64>,
    /// The greatest deviation of the ground from the plane fitted over a disc of the wheelbase, m; needs the wheelbase.
    pub roughness_max_m: Option<f64>,
    /// The distance between its axles, m.
    pub wheelbase_m: Option<f64>,
    /// The time to turn on the spot, s/deg; 0: turns take no time.
    pub turn_s_per_deg: f64,
    /// To which nodes it drives in straight lines.
    pub neighbours: Neighbours,
    /// Force to roll over level ground, as a share of the weight.
    pub rolling_resistance: f64,
    /// Share of the energy taken from the store that moves it.
    pub efficiency: f64,
    /// Power taken from the store while it drives and turns, W; needs the mass.
    pub idle_power_w: f64,
    /// The speed lost on slopes.
    pub slip: SlipCurve,
    /// The rate of failures that end the mission, per metre driven.
    pub failure_per_m: f64,
    /// Standard deviation of the heading of each drive leg.
    pub heading_sigma: Angle,
    /// Standard deviation of the length driven, as a share of it.
    pub length_sigma_fraction: f64,
}

impl RoverLimits {
    /// Whether it drives as commanded: without errors of heading and length, and without failures.
    pub fn is_exact(&self) -> bool {
        self.heading_sigma.degrees() == 0.0 && self.length_sigma_fraction == 0.0 && self.failure_per_m == 0.0
    }

    /// A rover of a speed that climbs, descends and crosses slopes up to an angle, and states nothing else.
    pub fn new(speed_m_s: f64, slope_max: Angle) -> Self {
        Self {
            speed_m_s,
            slope_up_max: slope_max,
            slope_down_max: None,
            cross_slope_max: None,
            step_max_m: None,
            roughness_max_m: None,
            wheelbase_m: None,
            turn_s_per_deg: 0.0,
            neighbours: Neighbours::default(),
            rolling_resistance: 0.0,
            efficiency: 1.0,
            idle_power_w: 0.0,
            slip: SlipCurve::default(),
            failure_per_m: 0.0,
            heading_sigma: Angle::from_degrees(0.0),
            length_sigma_fraction: 0.0,
        }
    }
}

/// A machine that drives, with valid limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Rover {
    limits: RoverLimits,
    /// Tangents of the steepest slopes up, down and across; infinite where nothing limits them.
    slopes: [f64; 3],
    /// Mass, kg, where idle power needs it.
    mass_kg: Option<f64>,
}

/// One invalid limit of a rover.
#[derive(Clone, Debug, PartialEq)]
pub struct RoverProblem {
    /// The limit, by its key in a scenario's table `drive`.
    pub key: &'static str,
    /// What was found.
    pub found: String,
    /// What is expected.
    pub expected: &'static str,
}

/// All invalid limits of a rover.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct InvalidRover(pub Vec<RoverProblem>);

impl fmt::Display for RoverProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "drive.{} is {}, expected {}", self.key, self.found, self.expected)
    }
}

impl Rover {
    /// A rover of these limits.
    ///
    /// # Arguments
    /// `mass_kg`: the mass of the machine; needed where it states an idle power, because energies are per unit mass.
    ///
    /// # Errors
    /// [`InvalidRover`]: all limits that are no numbers of their kind, and those that another one needs.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::{Rover, RoverLimits}};
    /// assert!(Rover::new(RoverLimits::new(0.1, Angle::from_degrees(20.0)), None).is_ok());
    /// let wrong = Rover::new(RoverLimits::new(0.0, Angle::from_degrees(20.0)), None);
    /// assert_eq!(wrong.unwrap_err().to_string(), "drive.speed_m_s is 0, expected a finite number above 0");
    /// ```
    pub fn new(limits: RoverLimits, mass_kg: Option<f64>) -> Result<Self, InvalidRover> {
        /// What is expected of the steepest slopes.
        const SLOPE: &str = "an angle from 0 to 90 degrees, or inf";
        let mut problems = Vec::new();
        let mut ask = |key, value: Option<f64>, holds: &dyn Fn(f64) -> bool, expected| {
            let wrong = value.filter(|&value| !holds(value));
            problems.extend(wrong.map(|found| RoverProblem { key, found: found.to_string(), expected }));
        };
        let is_slope = |degrees: f64| (0.0..=90.0).contains(&degrees);
        ask("speed_m_s", Some(limits.speed_m_s), &positive, POSITIVE);
        ask("slope_up_max_deg", Some(limits.slope_up_max.degrees()), &is_slope, SLOPE);
        ask("slope_down_max_deg", limits.slope_down_max.map(Angle::degrees), &is_slope, SLOPE);
        ask("cross_slope_max_deg", limits.cross_slope_max.map(Angle::degrees), &is_slope, SLOPE);
        ask("step_max_m", limits.step_max_m, &not_negative, NOT_NEGATIVE);
        ask("roughness_max_m", limits.roughness_max_m, &not_negative, NOT_NEGATIVE);
        ask("wheelbase_m", limits.wheelbase_m, &positive, POSITIVE);
        ask("turn_s_per_deg", Some(limits.turn_s_per_deg), &not_negative, NOT_NEGATIVE);
        ask("rolling_resistance", Some(limits.rolling_resistance), &not_negative, NOT_NEGATIVE);
        ask("drive_efficiency", Some(limits.efficiency), &|share| share > 0.0 && share <= 1.0, "a number above 0 and at most 1");
        ask("idle_power_w", Some(limits.idle_power_w), &not_negative, NOT_NEGATIVE);
        ask("failure_per_m", Some(limits.failure_per_m), &not_negative, NOT_NEGATIVE);
        ask("heading_sigma_deg", Some(limits.heading_sigma.degrees()), &not_negative, NOT_NEGATIVE);
        ask("length_sigma_fraction", Some(limits.length_sigma_fraction), &not_negative, NOT_NEGATIVE);
        let absent = |key, expected| RoverProblem { key, found: "absent".to_owned(), expected };
        if limits.wheelbase_m.is_none() && (limits.step_max_m.is_some() || limits.roughness_max_m.is_some()) {
            problems.push(absent("wheelbase_m", "the distance over which drive.step_max_m and drive.roughness_max_m are judged"));
        }
        let mass_kg = mass_kg.filter(|mass| positive(*mass));
        if limits.idle_power_w > 0.0 && mass_kg.is_none() {
            problems.push(RoverProblem {
                key: "idle_power_w",
                found: limits.idle_power_w.to_string(),
                expected: "a value for hopper.mass_kg beside it: energies are per unit mass",
            });
        }
        if !problems.is_empty() {
            return Err(InvalidRover(problems));
        }
        let steepest = |slope: Option<Angle>| {
            let slope = slope.unwrap_or(limits.slope_up_max);
            if slope.degrees() >= 90.0 { f64::INFINITY } else { slope.slope() }
        };
        let slopes = [Some(limits.slope_up_max), limits.slope_down_max, limits.cross_slope_max].map(steepest);
        Ok(Self { limits, slopes, mass_kg })
    }

    /// What it states.
    pub const fn limits(&self) -> &RoverLimits {
        &self.limits
    }

    /// The tangents of the steepest slopes that it climbs, descends and crosses; infinite where nothing limits them.
    pub const fn slopes(&self) -> [f64; 3] {
        self.slopes
    }

    /// The speed over ground of a slope along the way, given as its tangent, m/s: `v(s) = v0 (1 - slip(s))`.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::{Rover, RoverLimits, SlipCurve}};
    /// let limits = RoverLimits { slip: SlipCurve::new(&[[0.0, 0.0], [45.0, 0.5]]).unwrap(), ..RoverLimits::new(0.2, Angle::from_degrees(45.0)) };
    /// let rover = Rover::new(limits, None)?;
    /// assert_eq!(rover.speed_m_s(0.0), 0.2);
    /// assert!([1.0, -1.0].iter().all(|slope| (rover.speed_m_s(*slope) - 0.1).abs() < 1e-12));
    /// # Ok::<(), chta::world::InvalidRover>(())
    /// ```
    #[inline]
    pub fn speed_m_s(&self, slope: f64) -> f64 {
        self.limits.speed_m_s * (1.0 - self.limits.slip.share(slope))
    }

    /// The energy from the store for each metre of way on a slope along it, given as its tangent, per unit mass, J/(kg m):
    ///
    /// ```text
    ///     max(0, g (c_rr cos a + sin a) / eta) + P_idle / (m v(a))
    /// ```
    ///
    /// with rolling resistance `c_rr`, efficiency `eta`, idle power `P_idle`, mass `m` and speed `v`. Downhill, where gravity drives it, the
    /// wheels take nothing and give nothing back.
    ///
    /// # Examples
    /// ```
    /// use chta::{quantity::Angle, world::{Rover, RoverLimits}};
    /// let limits = RoverLimits { rolling_resistance: 0.1, efficiency: 0.5, idle_power_w: 2.0, ..RoverLimits::new(0.1, Angle::from_degrees(45.0)) };
    /// let rover = Rover::new(limits, Some(10.0))?;
    /// // Over level ground at 10 m/s^2: 10 * 0.1 / 0.5 + 2 / (10 * 0.1).
    /// assert!((rover.energy_j_kg_m(0.0, 10.0) - 4.0).abs() < 1e-12);
    /// assert!((rover.energy_j_kg_m(-1.0, 10.0) - 2.0).abs() < 1e-12);
    /// # Ok::<(), chta::world::InvalidRover>(())
    /// ```
    #[inline]
    pub fn energy_j_kg_m(&self, slope: f64, gravity_m_s2: f64) -> f64 {
        let limits = &self.limits;
        let cosine = 1.0 / (1.0 + slope * slope).sqrt();
        let wheels = gravity_m_s2 * cosine * (limits.rolling_resistance + slope) / limits.efficiency;
        wheels.max(0.0) + self.idle_j_kg_s() / self.speed_m_s(slope)
    }

    /// The idle power per unit mass, W/kg.
    pub fn idle_j_kg_s(&self) -> f64 {
        self.mass_kg.map_or(0.0, |mass_kg| self.limits.idle_power_w / mass_kg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_in_order_and_none_hides_another() {
        for neighbours in Neighbours::ALL {
            let offsets = neighbours.offsets();
            assert_eq!(offsets.len(), neighbours.count());
            let turns = |(a, b): (&(i32, i32), &(i32, i32))| a.0 * b.1 - a.1 * b.0 > 0;
            assert!(offsets.iter().zip(offsets.iter().cycle().skip(1)).all(turns), "{offsets:?}");
            assert!(offsets.iter().all(|(x, y)| offsets.contains(&(-x, -y)) && offsets.contains(&(*y, *x))));
        }
    }

    #[test]
    fn all_problems_are_stated_at_once() {
        let limits = RoverLimits {
            step_max_m: Some(0.1),
            efficiency: 0.0,
            idle_power_w: 1.0,
            ..RoverLimits::new(f64::NAN, Angle::from_degrees(91.0))
        };
        let InvalidRover(problems) = Rover::new(limits, None).unwrap_err();
        let keys: Vec<_> = problems.iter().map(|problem| problem.key).collect();
        assert_eq!(keys, ["speed_m_s", "slope_up_max_deg", "drive_efficiency", "wheelbase_m", "idle_power_w"]);
    }

    #[test]
    fn invalid_curves_are_refused() {
        for wrong in [&[[10.0, 0.1], [10.0, 0.2]][..], &[[0.0, 1.0]], &[[0.0, -0.1]], &[[90.0, 0.1]], &[[f64::NAN, 0.1]]] {
            assert!(SlipCurve::new(wrong).is_err(), "{wrong:?}");
        }
        let signed = SlipCurve::new(&[[-45.0, 0.1], [45.0, 0.3]]).unwrap();
        assert!((signed.share(-1.0) - 0.1).abs() < 1e-12 && (signed.share(1.0) - 0.3).abs() < 1e-12);
    }
}

//! What no path between two points can do without, whatever ground and nodes lie between.

use crate::world::tolerant_speed_m_s;

/// Rounding errors of a bound are far smaller than this share of it, by which every bound is reduced.
const SHAVED: f64 = 1.0 - 1e-9;

/// Lower bounds on every path of hops between two points, from the greatest speeds alone.
///
/// ```text
///     C   straight length in three dimensions,  Z   climb (negative downhill),  n   hops
///
///     of one hop (its least speeds):    g (C + Z) <= v_t^2,       g (C - Z) <= v_l^2,       2 C <= (v_t + v_l) T
///     of a path:                        n >= max( g (C + Z) / v_t,max^2,  g (C - Z) / v_l,max^2 )
///                                       sum of v_t      >= g (C + Z) / v_t,max
///                                       sum of v_t^2/2  >= g (C + Z) / 2
///                                       flight time     >= 2 C / (v_t,max + v_l,max)
/// ```
///
/// The first inequality is that of [`LineOfSight::min_speed_ratio`](super::LineOfSight::min_speed_ratio), the second is its time reversal; the
/// third holds since the chord is the mean of both velocities times the time. Of a path the climbs add up to `Z`, and the lengths to `C` or
/// more, so that the bounds of the hops add up: each bound is consistent along every path.
///
/// Both speeds count with the tolerance of the speed limits, and every bound is a billionth smaller, for rounding.
///
/// # Units
/// Speeds in m/s, gravity in m/s^2, lengths in m, time in s, energy in J/kg.
///
/// # Degenerate
/// A speed without limit bounds nothing, as the landing speed of a machine that brakes over the ground (the landing speed of its arcs is
/// infinite). Two different points are at least one hop apart; from a point to itself it takes none. With a speed of 0 there is no hop.
///
/// # Examples
/// ```
/// use chta::ballistics::PathBounds;
/// // 5 m/s up, 9 m/s down, g = 1.62: one hop spans v_l^2 / g = 50 m of level ground by its landing speed and 15.43 m by its take-off speed.
/// let bounds = PathBounds::new(5.0, 9.0, 1.62);
/// assert_eq!([15.0, 16.0, 31.0].map(|run_m| bounds.hops(run_m, 0.0)), [Some(1), Some(2), Some(3)]);
/// // 40 m along, 30 m down: C = 50, Z = -30, g (C + Z) = 32.4 and g (C - Z) = 129.6, against 25 and 81: two hops. Back up it takes six.
/// assert_eq!([bounds.hops(40.0, -30.0), bounds.hops(40.0, 30.0)], [Some(2), Some(6)]);
/// // Its take-off speeds add up to 129.6 / 5 m/s at least, its energies to 129.6 / 2 J/kg.
/// assert!((bounds.takeoff_speeds_m_s(40.0, 30.0) - 25.92).abs() < 1e-6 && (bounds.energy_j_kg(40.0, 30.0) - 64.8).abs() < 1e-6);
/// assert!((bounds.flight_time_s(40.0, 30.0) - 100.0 / 14.0).abs() < 1e-6);
/// assert_eq!((bounds.hops(0.0, 0.0), PathBounds::new(0.0, 9.0, 1.62).hops(1.0, 0.0)), (Some(0), None));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathBounds {
    takeoff_m_s: f64,
    landing_m_s: f64,
    gravity_m_s2: f64,
}

impl PathBounds {
    /// For the greatest take-off speed and the greatest landing speed of an arc, as stated, and gravity.
    pub fn new(takeoff_speed_max_m_s: f64, landing_speed_max_m_s: f64, gravity_m_s2: f64) -> Self {
        let [takeoff_m_s, landing_m_s] = [takeoff_speed_max_m_s, landing_speed_max_m_s].map(tolerant_speed_m_s);
        Self { takeoff_m_s, landing_m_s, gravity_m_s2 }
    }

    /// The fewest hops over a horizontal distance and a climb; `None` where no hop has these speeds.
    pub fn hops(&self, run_m: f64, climb_m: f64) -> Option<u64> {
        let [rising, falling] = ends(run_m, climb_m);
        if rising + falling == 0.0 {
            return Some(0);
        }
        let by = |speed_m_s: f64, length_m: f64| {
            if length_m == 0.0 { 0.0 } else { self.gravity_m_s2 * length_m / speed_m_s / speed_m_s }
        };
        let hops = by(self.takeoff_m_s, rising).max(by(self.landing_m_s, falling));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "finite and not negative; the cast saturates")]
        hops.is_finite().then_some(((hops * SHAVED).ceil() as u64).max(1))
    }

    /// Whether one hop may span a straight line of this length and climb, by these speeds alone: quick, and never wrong about a hop that
    /// exists.
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::PathBounds;
    /// // g (C + Z) <= 25 at the take-off, g (C - Z) <= 169 at the landing.
    /// let bounds = PathBounds::new(5.0, 13.0, 1.62);
    /// assert!(bounds.span(15.0, 0.0) && !bounds.span(16.0, 0.0) && bounds.span(50.0, -40.0) && !bounds.span(50.0, -30.0));
    /// ```
    #[inline]
    pub fn span(&self, straight_m: f64, climb_m: f64) -> bool {
        let by = |length_m: f64, speed_m_s: f64| SHAVED * self.gravity_m_s2 * length_m <= speed_m_s * speed_m_s;
        by(straight_m + climb_m, self.takeoff_m_s) && by(straight_m - climb_m, self.landing_m_s)
    }

    /// The least sum of take-off speeds, m/s.
    pub fn takeoff_speeds_m_s(&self, run_m: f64, climb_m: f64) -> f64 {
        SHAVED * self.gravity_m_s2 * ends(run_m, climb_m)[0] / self.takeoff_m_s
    }

    /// The least sum of `v_t^2 / 2`, J/kg.
    pub fn energy_j_kg(&self, run_m: f64, climb_m: f64) -> f64 {
        0.5 * SHAVED * self.gravity_m_s2 * ends(run_m, climb_m)[0]
    }

    /// The least flight time, s; 0 without a limit of both speeds.
    pub fn flight_time_s(&self, run_m: f64, climb_m: f64) -> f64 {
        let [rising, falling] = ends(run_m, climb_m);
        SHAVED * (rising + falling) / (self.takeoff_m_s + self.landing_m_s)
    }
}

/// `C + Z` and `C - Z`, neither by a difference of close numbers: their product is the square of the horizontal distance.
fn ends(run_m: f64, climb_m: f64) -> [f64; 2] {
    let large_m = libm::hypot(run_m, climb_m) + climb_m.abs();
    let small_m = if large_m == 0.0 { 0.0 } else { run_m * (run_m / large_m) };
    if climb_m >= 0.0 { [large_m, small_m] } else { [small_m, large_m] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ballistics::{Arc, LineOfSight, limits},
        draw::Draw,
    };

    /// Random chains of hops within the speed limits, over any ground: no bound exceeds what the chain takes.
    #[test]
    fn no_chain_of_hops_takes_less_than_its_bounds() {
        let draw = &mut Draw::seeded(1702);
        let (mut chains, mut exact) = (0, 0);
        for _ in 0..4000 {
            let gravity = draw.log_uniform(1e-5, 25.0);
            let (takeoff, landing) = (draw.log_uniform(0.1, 50.0), draw.log_uniform(0.1, 50.0));
            let bounds = PathBounds::new(takeoff, landing, gravity);
            let reach_m = takeoff.min(landing).powi(2) / gravity;
            let [mut east, mut north, mut up] = [0.0; 3];
            let (mut hops, mut speeds, mut energy, mut time) = (0, 0.0, 0.0, 0.0);
            for _ in 0..=draw.below(12) {
                let sight = LineOfSight::along(reach_m * draw.log_uniform(0.2, 2.0), draw.uniform(-1.5, 1.5));
                let lofts = limits::speeds(sight, takeoff, landing, gravity);
                if lofts.is_empty() {
                    continue;
                }
                let arc = Arc::new(sight, lofts.lower + draw.uniform(0.0, 1.0) * (lofts.upper - lofts.lower), gravity);
                // Chains that go straight come near their bounds.
                let heading: f64 = if draw.chance(0.7) { 0.0 } else { draw.uniform(0.0, 6.3) };
                east += sight.run_m() * heading.cos();
                north += sight.run_m() * heading.sin();
                up += sight.rise_m();
                let v = arc.takeoff_speed_m_s();
                (hops, speeds, energy, time) = (hops + 1, speeds + v, energy + 0.5 * v * v, time + arc.flight_time_s());
                let run_m = libm::hypot(east, north);
                let least = bounds.hops(run_m, up).unwrap();
                assert!(least <= hops, "{least} hops at least, {hops} flown");
                exact += u32::from(least == hops && hops > 1);
                for (bound, taken) in [
                    (bounds.takeoff_speeds_m_s(run_m, up), speeds),
                    (bounds.energy_j_kg(run_m, up), energy),
                    (bounds.flight_time_s(run_m, up), time),
                ] {
                    assert!(bound <= taken * (1.0 + 1e-12), "{bound} against {taken}");
                }
            }
            chains += u32::from(hops > 1);
        }
        assert!(chains > 1000 && exact > 50, "{chains} chains, {exact} that take as many hops as their bound");
    }

    /// The bound is that of one hop exactly: its least take-off speed and its least landing speed.
    #[test]
    fn one_hop_at_its_least_speed_meets_its_bound() {
        let draw = &mut Draw::seeded(1703);
        for _ in 0..2000 {
            let gravity = draw.log_uniform(1e-5, 25.0);
            let sight = LineOfSight::along(draw.log_uniform(0.1, 1e4), draw.uniform(-3.0, 3.0));
            let arc = Arc::new(sight, sight.secant(), gravity);
            let (takeoff, landing) = (arc.takeoff_speed_m_s(), arc.landing_speed_m_s());
            let hops = |takeoff, landing| PathBounds::new(takeoff, landing, gravity).hops(sight.run_m(), sight.rise_m());
            assert_eq!(hops(takeoff, landing), Some(1));
            assert_eq!(hops(takeoff * 0.9999, f64::INFINITY), Some(2));
            assert_eq!(hops(f64::INFINITY, landing * 0.9999), Some(2));
            assert_eq!(hops(f64::INFINITY, f64::INFINITY), Some(1));
        }
    }

    #[test]
    fn degenerate_distances_and_speeds_give_no_nonsense() {
        let bounds = PathBounds::new(2.0, 2.0, 1.0);
        assert_eq!(bounds.hops(0.0, 3.0), Some(2), "straight up: g 2 Z / v^2 = 1.5");
        assert_eq!(bounds.hops(0.0, -3.0), Some(2), "and down, by the landing speed");
        for (takeoff, landing) in [(0.0, 2.0), (2.0, 0.0), (f64::NAN, 2.0)] {
            assert_eq!(PathBounds::new(takeoff, landing, 1.0).hops(1.0, 0.0).filter(|hops| *hops == 0), None);
        }
        assert_eq!(PathBounds::new(2.0, 0.0, 1.0).hops(1.0, 0.0), None);
        assert_eq!(PathBounds::new(2.0, f64::INFINITY, 1.0).flight_time_s(9.0, 0.0), 0.0);
    }
}

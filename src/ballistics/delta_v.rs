//! The delta-v of a propulsive hop, and the propellant that it takes.

use super::Arc;
use crate::world::HopperLimits;

/// Standard gravity, which turns a specific impulse in seconds into an exhaust velocity, m/s^2 (CGPM 1901; not the gravity of the body).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// The delta-v of a hop along an arc, m/s: of the take-off, of the brakes if the hopper has some, and its overhead per hop.
///
/// ```text
///     dv = v_t + | v_l - v_d | + overhead,      v_l = v_x (1, l),   v_d = (0, -touchdown speed)
/// ```
///
/// with the arc's horizontal speed `v_x` and landing slope `l`. Take-off and braking are impulses; what their finite duration costs
/// (gravity and steering losses) belongs into the overhead. Without brakes the second term is absent.
///
/// Source: the rocket equation counts changes of velocity; the two changes of a hop are those at its ends.
///
/// # Units
/// m/s.
///
/// # Examples
/// ```
/// use chta::{ballistics::{Arc, LineOfSight, delta_v_m_s}, world::{HopperLimits, LandingMode}};
/// // 45 degrees over flat ground, 10 m at 10 m/s^2: 10 m/s up, and down with (7.071, -7.071) m/s.
/// let arc = Arc::new(LineOfSight::new(10.0, 0.0), 1.0, 10.0);
/// let ballistic = HopperLimits::with_speeds(20.0, 20.0);
/// assert!((delta_v_m_s(&arc, &ballistic) - 10.0).abs() < 1e-12);
/// // Brakes to (0, -1) m/s: sqrt(50 + 6.071^2) = 9.320 m/s more, and 0.5 m/s of overhead.
/// let landing = LandingMode::Braked { touchdown_speed_m_s: 1.0 };
/// let braked = HopperLimits { landing, hop_delta_v_overhead_m_s: Some(0.5), ..ballistic };
/// assert!((delta_v_m_s(&arc, &braked) - (10.5 + (50.0 + (50f64.sqrt() - 1.0).powi(2)).sqrt())).abs() < 1e-12);
/// ```
pub fn delta_v_m_s(arc: &Arc, limits: &HopperLimits) -> f64 {
    let across = arc.horizontal_speed_m_s();
    delta_v_of_m_s(arc.takeoff_speed_m_s(), Some([across, across * arc.landing_slope()]), limits)
}

/// The same from the velocities at its ends, for a hop that is flown otherwise than planned.
///
/// # Arguments
/// `takeoff_speed_m_s`; `landing_velocity_m_s`: horizontal and vertical, `None` for a flight that does not come down, which does not brake.
///
/// # Examples
/// ```
/// use chta::{ballistics::delta_v_of_m_s, world::{HopperLimits, LandingMode}};
/// let landing = LandingMode::Braked { touchdown_speed_m_s: 1.0 };
/// let braked = HopperLimits { landing, ..HopperLimits::with_speeds(20.0, 20.0) };
/// // Brakes from (3, -5) to (0, -1) m/s: 5 m/s more.
/// assert_eq!(delta_v_of_m_s(6.0, Some([3.0, -5.0]), &braked), 11.0);
/// assert_eq!(delta_v_of_m_s(6.0, None, &braked), 6.0);
/// ```
pub fn delta_v_of_m_s(takeoff_speed_m_s: f64, landing_velocity_m_s: Option<[f64; 2]>, limits: &HopperLimits) -> f64 {
    let brakes = limits.landing.touchdown_speed_m_s().zip(landing_velocity_m_s);
    let braking = brakes.map_or(0.0, |(touchdown_m_s, [across, up])| libm::hypot(across, up + touchdown_m_s));
    takeoff_speed_m_s + braking + limits.hop_delta_v_overhead_m_s.unwrap_or(0.0)
}

/// The propellant of a delta-v, kg.
///
/// ```text
///     m_0 - m_1 = m_0 (1 - exp(-dv / (Isp g0)))                                        (Tsiolkovsky 1903)
/// ```
///
/// # Arguments
/// `mass_kg`: the mass before, with all propellant; `delta_v_m_s`; `isp_s`: the specific impulse.
///
/// # Examples
/// ```
/// use chta::ballistics::{STANDARD_GRAVITY_M_S2, propellant_kg};
/// // A delta-v of ln 2 exhaust velocities takes half of the mass.
/// let half = propellant_kg(80.0, 200.0 * STANDARD_GRAVITY_M_S2 * 2f64.ln(), 200.0);
/// assert!((half - 40.0).abs() < 1e-12);
/// ```
pub fn propellant_kg(mass_kg: f64, delta_v_m_s: f64, isp_s: f64) -> f64 {
    // The difference of two nearly equal masses would lose digits.
    -mass_kg * libm::expm1(-delta_v_m_s / (isp_s * STANDARD_GRAVITY_M_S2))
}

/// The delta-v of an amount of propellant, m/s: [`propellant_kg`] the other way round.
///
/// ```text
///     dv = -Isp g0 ln(1 - (m_0 - m_1) / m_0)
/// ```
///
/// # Arguments
/// `mass_kg`: the mass before, with all propellant; `propellant_kg`: less than it; `isp_s`: the specific impulse.
///
/// # Examples
/// ```
/// use chta::ballistics::{delta_v_of_propellant_m_s, propellant_kg};
/// assert!((propellant_kg(80.0, delta_v_of_propellant_m_s(80.0, 12.0, 220.0), 220.0) - 12.0).abs() < 1e-12);
/// ```
pub fn delta_v_of_propellant_m_s(mass_kg: f64, propellant_kg: f64, isp_s: f64) -> f64 {
    -isp_s * STANDARD_GRAVITY_M_S2 * libm::log1p(-propellant_kg / mass_kg)
}

//! Bounces: the velocity after a contact, and how far and how long a body bounces over level ground.

use nalgebra::Vector3;

use crate::world::Restitution;

/// The velocity after a contact with a facet of this outward normal; `None` if the velocity does not point into the facet, so that there is
/// no impact.
///
/// ```text
///            n
///      v  \  |  / v'         c  = v . n / n . n
///          \ | /             v' = e_t (v - c n) - e_n c n
///     ______\|/______
/// ```
///
/// The part of the velocity along the normal is reversed and keeps the share `e_n`; the part along the facet keeps the share `e_t`.
///
/// # Units
/// Velocities in m/s: east, north and up, or along, left and up for a chain. The normal is of any length.
///
/// # Examples
/// ```
/// use chta::{ballistics::bounced, world::Restitution};
/// use nalgebra::Vector3;
/// let half = Restitution::new(0.5, 0.75, None)?;
/// // Level ground: 3 m/s across keep three quarters, 4 m/s down become 2 m/s up.
/// assert_eq!(bounced(Vector3::new(3.0, 0.0, -4.0), Vector3::z(), &half), Some(Vector3::new(2.25, 0.0, 2.0)));
/// // Straight down on a slope of 45 degrees: half of the velocity is along the normal, half along the facet, down the slope.
/// let away = bounced(Vector3::new(0.0, 0.0, -4.0), Vector3::new(-1.0, 0.0, 1.0), &half).unwrap();
/// // (-2, 0, -2) along the facet times 0.75, and (2, 0, -2) along the normal times -0.5.
/// assert_eq!(away, Vector3::new(-2.5, 0.0, -0.5));
/// // A velocity that leaves the facet meets nothing.
/// assert_eq!(bounced(Vector3::new(3.0, 0.0, 4.0), Vector3::z(), &half), None);
/// # Ok::<(), chta::world::InvalidRestitution>(())
/// ```
pub fn bounced(velocity_m_s: Vector3<f64>, normal: Vector3<f64>, restitution: &Restitution) -> Option<Vector3<f64>> {
    let share = velocity_m_s.dot(&normal) / normal.norm_squared();
    let into = normal * share;
    (share < 0.0).then(|| (velocity_m_s - into) * restitution.tangential() - into * restitution.normal())
}

/// The bounces of a hop over level ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelBounces {
    /// How many there are.
    pub count: u32,
    /// From the first contact to the place of rest, m.
    pub distance_m: f64,
    /// From the first contact to rest, s.
    pub time_s: f64,
}

/// The bounces after a hop that takes off and lands on level ground with these velocities, summed in closed form.
///
/// ```text
///     bounce k flies  e_n^k T  long and  (e_n e_t)^k X  far          T = 2 v_z / g,  X = v_x T
///
///     time = T e_n (1 - e_n^N) / (1 - e_n),     distance = X q (1 - q^N) / (1 - q),   q = e_n e_t
/// ```
///
/// `N`, the number of bounces, is the greatest `k` with `sqrt((e_t^k v_x)^2 + (e_n^k v_z)^2) >= settling speed`; it is at most
/// `ln(v / settling speed) / ln(1 / max(e_n, e_t))`. With `e_n` = 0 the body stays where it lands. For small settling speeds the shares of the hop tend to
/// `e_n / (1 - e_n)` of its time and `q / (1 - q)` of its length, at any gravity.
///
/// Source: the geometric series of a bouncing ball, with the second coefficient for the speed along the ground.
///
/// # Arguments
/// `across_m_s`, `up_m_s`: the speed along the ground and the upward speed at the take-off.
///
/// # Examples
/// ```
/// use chta::{ballistics::level_bounces, world::Restitution};
/// // 4 m/s across and up at 2 m/s^2: a hop of 4 s and 16 m. Half of each speed is kept: bounces of 2 s and 4 m, 1 s and 1 m, and so on.
/// let half = Restitution::new(0.5, 0.5, Some(0.8))?;
/// let found = level_bounces(4.0, 4.0, &half, 2.0);
/// // Speeds of 2.83, 1.41 and 0.71 m/s after the contacts: two bounces.
/// assert_eq!((found.count, found.distance_m, found.time_s), (2, 5.0, 3.0));
/// # Ok::<(), chta::world::InvalidRestitution>(())
/// ```
pub fn level_bounces(across_m_s: f64, up_m_s: f64, restitution: &Restitution, gravity_m_s2: f64) -> LevelBounces {
    let (normal, tangential) = (restitution.normal(), restitution.tangential());
    let settled_m_s = restitution.settling_speed_m_s(gravity_m_s2);
    let (mut across, mut up, mut count) = (across_m_s * tangential, up_m_s * normal, 0u32);
    while restitution.bounces() && up > 0.0 && libm::hypot(across, up) >= settled_m_s {
        (across, up, count) = (across * tangential, up * normal, count + 1);
    }
    let bounces = f64::from(count);
    let series = |share: f64| share * (1.0 - libm::pow(share, bounces)) / (1.0 - share);
    let time_s = 2.0 * up_m_s / gravity_m_s2;
    LevelBounces { count, distance_m: across_m_s * time_s * series(normal * tangential), time_s: time_s * series(normal) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares of the hop's length and time that were measured with a settling speed of 8 % of the landing speed, at 45 degrees.
    #[test]
    fn hops_over_level_ground_roll_out_by_the_shares_measured() {
        let cases = [((0.3, 0.5), (0.18, 0.42)), ((0.5, 0.7), (0.54, 0.98)), ((0.6, 0.8), (0.92, 1.48))];
        for ((normal, tangential), (length, time)) in cases {
            for gravity_m_s2 in [1e-5, 1.62, 25.0] {
                let speed_m_s: f64 = 0.2 * f64::sqrt(gravity_m_s2);
                let bounces = Restitution::new(normal, tangential, Some(0.08 * speed_m_s)).unwrap();
                let part_m_s = speed_m_s * std::f64::consts::FRAC_1_SQRT_2;
                let found = level_bounces(part_m_s, part_m_s, &bounces, gravity_m_s2);
                let hop_s = 2.0 * part_m_s / gravity_m_s2;
                assert!((found.distance_m / (hop_s * part_m_s) - length).abs() <= 0.005, "{found:?}");
                assert!((found.time_s / hop_s - time).abs() <= 0.005, "{found:?}");
            }
        }
    }

    #[test]
    fn the_number_of_bounces_has_its_bound() {
        for (normal, tangential) in [(0.3, 0.5), (0.99, 0.0), (0.99, 0.99), (1e-3, 0.99), (0.0, 0.9)] {
            let bounces = Restitution::new(normal, tangential, Some(1e-6)).unwrap();
            let found = level_bounces(3.0, 4.0, &bounces, 1.62);
            let most = (5.0 / 1e-6f64).ln() / (1.0 / f64::max(normal, tangential)).ln();
            assert!(f64::from(found.count) <= most, "{found:?} with at most {most}");
            assert_eq!(found.count == 0, normal == 0.0);
        }
    }

    /// The normal speed is reversed, the other kept, whatever the facet; energy is never gained.
    #[test]
    fn a_bounce_scales_both_parts_of_the_velocity() {
        let mut draw = crate::draw::Draw::seeded(8);
        for _ in 0..1000 {
            let velocity = Vector3::new(draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0), draw.uniform(-9.0, 9.0));
            let bounces = Restitution::new(draw.uniform(0.0, 0.9), draw.uniform(0.0, 0.9), None).unwrap();
            let normal = Vector3::new(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0)).normalize();
            let into = velocity.dot(&normal);
            match bounced(velocity, 2.5 * normal, &bounces) {
                None => assert!(into > -1e-12),
                Some(away) => {
                    assert!((away.dot(&normal) + bounces.normal() * into).abs() < 1e-12);
                    let along = normal.cross(&away) - normal.cross(&velocity) * bounces.tangential();
                    assert!(along.norm() < 1e-11, "{along}");
                    assert!(away.norm() <= velocity.norm());
                }
            }
        }
    }
}

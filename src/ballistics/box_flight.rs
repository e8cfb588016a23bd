//! When a box in ballistic flight touches a triangle.

use nalgebra::{Matrix3, Point3, Vector3};

use super::plane_times_s;

/// The directions along which a box and a triangle are apart, if they are: three axes of the box, one normal, nine products of edges.
const AXES: usize = 13;

/// How much farther two bodies reach towards each other than computed, as a share of the distances that were subtracted. Rounding is a
/// hundredth of it; so a touch counts as contact.
const SLACK: f64 = 1e-13;

/// A box in ballistic flight that keeps its orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxFlight {
    /// The centre of the box at time 0, m.
    pub centre_m: Point3<f64>,
    /// Its velocity at time 0, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Gravity, towards -z, m/s^2; 0 for a motion along a straight line.
    pub gravity_m_s2: f64,
    /// The axes of the box as columns, each of length 1 and at right angles.
    pub axes: Matrix3<f64>,
    /// Half its length along each axis, m, more than 0.
    pub half_extents_m: Vector3<f64>,
}

/// The times at which two bodies touch: those from the first to the last, less the open gaps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactTimes {
    from_s: f64,
    to_s: f64,
    gaps_s: [[f64; 2]; AXES],
    gaps: usize,
}

impl BoxFlight {
    /// The times within a part of the flight at which the box touches a triangle, borders included.
    ///
    /// ```text
    ///     c(t) = c + v t - g t^2/2 z
    ///     in contact at t  iff  min a.q - r <= a.c(t) <= max a.q + r     for each of 13 directions a,  r = sum h_k |a.e_k|
    /// ```
    ///
    /// with q the corners of the triangle, `e_k` the axes of the box and `h_k` its half extents. The directions are the axes of the box, the
    /// normal of the triangle, and the product of each edge with each axis. Two convex bodies without a common point have a plane between them
    /// along one of these. On each direction the box moves as a parabola in t, so the times are those between the roots of two
    /// quadratics, less those between two others.
    ///
    /// Source: the separating axes are those of Gottschalk, Lin and Manocha 1996, *`OBBTree`*, section 5, for a box and a triangle
    /// instead of two boxes.
    ///
    /// # Arguments
    /// `within_s`: the first and last time, s.
    ///
    /// # Returns
    /// A triangle without area is the segment or point that it is. For a box without volume, contact beyond the sides of the triangle may be
    /// reported. Rounding only ever adds contact: distances are taken short by 1e-13 of their size.
    ///
    /// # Examples
    /// ```
    /// use chta::ballistics::BoxFlight;
    /// use nalgebra::{Matrix3, Point3, Vector3};
    /// // A cube of 1 m is thrown up at 4 m/s under 2 m/s^2: its centre is at 4 t - t^2. The ceiling at 3.5 m stops it after 1 s; if it were
    /// // let through, the apex at 4 m would leave it in contact until 3 s.
    /// let flight = BoxFlight {
    ///     centre_m: Point3::origin(),
    ///     velocity_m_s: Vector3::new(0.0, 0.0, 4.0),
    ///     gravity_m_s2: 2.0,
    ///     axes: Matrix3::identity(),
    ///     half_extents_m: Vector3::new(0.5, 0.5, 0.5),
    /// };
    /// let ceiling = [Point3::new(-9.0, -9.0, 3.5), Point3::new(9.0, -9.0, 3.5), Point3::new(0.0, 9.0, 3.5)];
    /// let times = flight.contact_times(&ceiling, [0.0, 4.0]);
    /// assert!((times.first_s().unwrap() - 1.0).abs() < 1e-12 && times.contains(2.9) && !times.contains(3.1));
    /// assert_eq!(flight.contact_times(&ceiling, [0.0, 0.9]).first_s(), None);
    /// ```
    pub fn contact_times(&self, triangle: &[Point3<f64>; 3], within_s: [f64; 2]) -> ContactTimes {
        let corners = triangle.map(|corner| corner - self.centre_m);
        let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
        let mut times = ContactTimes { from_s: within_s[0], to_s: within_s[1], gaps_s: [[0.0; 2]; AXES], gaps: 0 };
        let axes = [self.axes.column(0).into_owned(), self.axes.column(1).into_owned(), self.axes.column(2).into_owned()];
        let products = axes.iter().flat_map(|axis| edges.iter().map(move |edge| axis.cross(edge)));
        let directions = axes.into_iter().chain(std::iter::once(edges[0].cross(&edges[1]))).chain(products);
        for direction in directions {
            self.meet_along(direction, &corners, &axes, &mut times);
            if times.from_s > times.to_s {
                break;
            }
        }
        times
    }

    /// Leaves of the times those at which box and corners overlap along a direction of any length.
    fn meet_along(&self, direction: Vector3<f64>, corners: &[Vector3<f64>; 3], axes: &[Vector3<f64>; 3], times: &mut ContactTimes) {
        let along = corners.map(|corner| corner.dot(&direction));
        let reach: f64 = axes.iter().zip(self.half_extents_m.iter()).map(|(axis, half)| half * axis.dot(&direction).abs()).sum();
        let far = corners.iter().fold(0.0, |far: f64, corner| far.max(corner.norm_squared())).sqrt() * direction.norm();
        let reach = reach + SLACK * (reach + far);
        let (low, high) = (along[0].min(along[1]).min(along[2]) - reach, along[0].max(along[1]).max(along[2]) + reach);
        let (speed, half_pull) = (self.velocity_m_s.dot(&direction), -0.5 * self.gravity_m_s2 * direction.z);
        // speed t + half_pull t^2 - high <= 0, and the same from the other side.
        times.keep_below(-high, speed, half_pull);
        times.keep_below(low, -speed, -half_pull);
    }
}

impl ContactTimes {
    /// The first time of contact, s; `None` without a contact.
    pub fn first_s(&self) -> Option<f64> {
        let mut time_s = self.from_s;
        // A gap that holds the time moves it to the end of the gap, which may lie in another one.
        while time_s <= self.to_s {
            match self.gaps_s[..self.gaps].iter().find(|gap| gap[0] < time_s && time_s < gap[1]) {
                Some(gap) => time_s = gap[1],
                None => return Some(time_s),
            }
        }
        None
    }

    /// Whether the bodies touch at a time, s.
    pub fn contains(&self, time_s: f64) -> bool {
        self.from_s <= time_s
            && time_s <= self.to_s
            && !self.gaps_s[..self.gaps].iter().any(|gap| gap[0] < time_s && time_s < gap[1])
    }

    /// Leaves the times at which `s + c t + p t^2 <= 0`.
    fn keep_below(&mut self, s: f64, c: f64, p: f64) {
        if p == 0.0 {
            if c == 0.0 {
                if s > 0.0 {
                    self.to_s = f64::NEG_INFINITY;
                }
            } else if c > 0.0 {
                self.to_s = self.to_s.min(-s / c);
            } else {
                self.from_s = self.from_s.max(-s / c);
            }
            return;
        }
        let [one, other] = plane_times_s(s, c, p);
        if one.is_nan() {
            // Without a root the sign is that of p.
            if p > 0.0 {
                self.to_s = f64::NEG_INFINITY;
            }
            return;
        }
        // Both roots are 0 where s and c are.
        let other = if other.is_nan() { one } else { other };
        let (first, last) = (one.min(other), one.max(other));
        if p > 0.0 {
            (self.from_s, self.to_s) = (self.from_s.max(first), self.to_s.min(last));
        } else {
            self.gaps_s[self.gaps] = [first, last];
            self.gaps += 1;
        }
    }
}

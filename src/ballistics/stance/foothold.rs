//! Where a foot pushes.

use nalgebra::Vector3;

use super::ContactCone;

/// One contact of a stance as part of a body: its cone and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foothold {
    /// The forces that do not make the foot slide.
    pub cone: ContactCone,
    /// From the centre of mass to the contact, m.
    pub arm_m: Vector3<f64>,
}

/// A number of which two bounds are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// It is at least this.
    pub lower: f64,
    /// It is at most this.
    pub upper: f64,
}

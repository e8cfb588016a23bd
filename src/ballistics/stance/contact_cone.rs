//! The forces that one contact bears.

use nalgebra::Vector3;

use crate::world::FrictionCone;

/// How far the length of a normal may be from 1. A normal that was made unit in double precision is within 1e-15; one that was written
/// with nine digits is within 1e-9. A length that is farther off tells of a normal that was not made unit.
const LENGTH_TOLERANCE: f64 = 1e-6;

/// One contact of a stance: the unit normal, out of the ground, and the cone of forces about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactCone {
    normal: Vector3<f64>,
    friction: FrictionCone,
}

/// A contact without a cone.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidContactCone {
    /// The normal is not of length 1.
    #[error("normal ({x}, {y}, {z}) is not of length 1")]
    Normal {
        /// Its east part.
        x: f64,
        /// Its north part.
        y: f64,
        /// Its upward part.
        z: f64,
    },
    /// Without friction a cone is a single ray, and a stance on such contacts has no directions to choose from.
    #[error("friction coefficient 0 leaves a single direction of force, expected more than 0 (dry rock and regolith: 0.3 to 1.2)")]
    NoFriction,
}

impl ContactCone {
    /// Of a unit normal, out of the ground, and a friction above 0. The normal is kept to the last bit.
    ///
    /// # Errors
    /// [`InvalidContactCone`] if the length of the normal is not 1 to within 1e-6, or the friction is 0.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::stance::{ContactCone, InvalidContactCone}, world::FrictionCone};
    /// use nalgebra::Vector3;
    /// assert!(ContactCone::new(Vector3::z(), FrictionCone::new(0.5)?).is_ok());
    /// assert_eq!(ContactCone::new(Vector3::z(), FrictionCone::new(0.0)?), Err(InvalidContactCone::NoFriction));
    /// assert!(ContactCone::new(Vector3::new(0.0, 0.6, 0.7), FrictionCone::new(0.5)?).is_err());
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    pub fn new(normal: Vector3<f64>, friction: FrictionCone) -> Result<Self, InvalidContactCone> {
        let off = (normal.norm() - 1.0).abs();
        // A length that is not a number is refused too.
        if off.is_nan() || off > LENGTH_TOLERANCE {
            return Err(InvalidContactCone::Normal { x: normal.x, y: normal.y, z: normal.z });
        }
        if friction.coefficient() > 0.0 { Ok(Self { normal, friction }) } else { Err(InvalidContactCone::NoFriction) }
    }

    /// The unit normal, out of the ground.
    pub const fn normal(&self) -> Vector3<f64> {
        self.normal
    }

    /// The friction.
    pub const fn friction(&self) -> FrictionCone {
        self.friction
    }

    /// The unit force of the cone that does most along a vector of any length other than 0.
    ///
    /// The vector itself if it lies in the cone, else the edge of the cone on its side.
    pub(super) fn best(&self, along: Vector3<f64>) -> Vector3<f64> {
        let (normal, mu) = (self.normal, self.friction.coefficient());
        let up = along.dot(&normal);
        let aside = along - normal * up;
        let length = aside.norm();
        if length <= mu * up {
            return along / along.norm();
        }
        // A vector straight into the ground has no side: every edge does as little.
        let side = if length > 0.0 { aside / length } else { Vector3::zeros() };
        (normal + side * mu) / libm::hypot(1.0, mu)
    }
}

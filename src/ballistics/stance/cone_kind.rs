//! Narrower cones that stand for the sum of the friction cones of a stance.

use nalgebra::Vector3;

use super::{ConeSum, ContactCone};
use crate::world::{FrictionCone, PreparedCone};

/// A sum of unit normals that is shorter than this has no direction: it is what rounding left of opposite normals.
const LEAST_SUM: f64 = 1e-9;

/// Which cone stands for the directions in which the contacts of a stance push. Each lies inside the next: `Kc`, `KcPlus`, `Exact`; and
/// so do pyramids with more edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConeKind {
    /// The sum itself.
    #[default]
    Exact,
    /// One cone about the sum of the normals, with the least friction: the centroidal cone of S.
    ///
    /// ```text
    ///     axis n_c / |n_c|,   n_c = n_1 + ... + n_h,   mu_c = min mu_i                                          (S eq. 2)
    /// ```
    ///
    /// It holds nothing where the normals cancel, though the sum is then all of space. S omits the division by `|n_c|`, without which the
    /// cone is not inside the sum.
    Kc,
    /// The widest cone about the same axis that the normals prove to be inside.
    ///
    /// ```text
    ///     half-angle asin(sum s_i / |n_c|),   all of space where the quotient is 1 or more
    /// ```
    ///
    /// For every u of the dual cone, `u.n_c >= sum s_i`. At least as wide as `Kc`, since `|n_c| <= h` and `sum s_i >= h min s_i`.
    KcPlus,
    /// The sum of pyramids inscribed in the cones, exact for them.
    Pyramid(PyramidEdges),
}

/// The number of edges of a pyramid inscribed in a cone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PyramidEdges {
    /// 4 edges.
    Four,
    /// 8 edges.
    Eight,
    /// 16 edges.
    Sixteen,
}

impl PyramidEdges {
    /// The number.
    pub const fn count(self) -> u32 {
        match self {
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// The edges of the pyramid inscribed in a cone, each of length 1. The first is on the side of the coordinate axis that is the
    /// farthest from the normal.
    pub(super) fn of(self, contact: &ContactCone) -> impl Iterator<Item = Vector3<f64>> {
        let normal = contact.normal();
        let cone = PreparedCone::new(contact.friction());
        let farthest = Vector3::ith(normal.iamin(), 1.0);
        let first = (farthest - normal * farthest.dot(&normal)).normalize();
        let second = normal.cross(&first);
        (0..self.count()).map(move |edge| {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * f64::from(edge) / f64::from(self.count()));
            normal * cone.cosine() + (first * cosine + second * sine) * cone.sine()
        })
    }
}

impl ConeKind {
    /// All kinds, the default first.
    pub const ALL: [Self; 6] = [
        Self::Exact,
        Self::Kc,
        Self::KcPlus,
        Self::Pyramid(PyramidEdges::Four),
        Self::Pyramid(PyramidEdges::Eight),
        Self::Pyramid(PyramidEdges::Sixteen),
    ];

    /// The name in scenarios and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Kc => "kc",
            Self::KcPlus => "kc-plus",
            Self::Pyramid(PyramidEdges::Four) => "pyramid-4",
            Self::Pyramid(PyramidEdges::Eight) => "pyramid-8",
            Self::Pyramid(PyramidEdges::Sixteen) => "pyramid-16",
        }
    }

    /// The cone of this kind for the contacts of a stance. For one contact every kind but the pyramids is the cone of that contact.
    ///
    /// # Examples
    /// ```
    /// use chta::{ballistics::stance::{ConeKind, ContactCone}, world::FrictionCone};
    /// use nalgebra::{Vector2, Vector3};
    /// // Floor and wall at a right angle, mu = 3/4: sin phi = 0.6. About the diagonal, Kc opens atan 0.75 = 36.87 degrees,
    /// // Kc+ asin(1.2 / sqrt 2) = 58.05 degrees, and the sum itself, 36.87 degrees beyond the floor and the wall, 81.87 degrees.
    /// let friction = FrictionCone::new(0.75)?;
    /// let stance = [Vector3::z(), Vector3::x()].map(|normal| ContactCone::new(normal, friction).unwrap());
    /// let opening_deg = |kind: ConeKind| kind.cone(&stance).cut(Vector2::x()).opening().unwrap().degrees();
    /// assert!((opening_deg(ConeKind::Kc) - 2.0 * 36.869_897_645_844_02).abs() < 1e-9);
    /// assert!((opening_deg(ConeKind::KcPlus) - 2.0 * 58.051_940_568_669_93).abs() < 1e-9);
    /// assert!((opening_deg(ConeKind::Exact) - 2.0 * 81.869_897_645_844_02).abs() < 1e-9);
    /// # Ok::<(), chta::world::InvalidFriction>(())
    /// ```
    pub fn cone(self, contacts: &[ContactCone]) -> ConeSum {
        match self {
            Self::Pyramid(edges) => ConeSum::of_rays(contacts.iter().flat_map(|contact| edges.of(contact))),
            Self::Kc | Self::KcPlus if contacts.len() > 1 => self.about_the_sum(contacts),
            Self::Exact | Self::Kc | Self::KcPlus => ConeSum::new(contacts),
        }
    }

    /// One cone about the sum of the normals of two contacts or more.
    fn about_the_sum(self, contacts: &[ContactCone]) -> ConeSum {
        let sum: Vector3<f64> = contacts.iter().map(ContactCone::normal).sum();
        let length = sum.norm();
        let coefficients = contacts.iter().map(|contact| contact.friction().coefficient());
        let least = coefficients.fold(f64::INFINITY, f64::min);
        let sines: f64 = contacts.iter().map(|contact| PreparedCone::new(contact.friction()).sine()).sum();
        let mu = match self {
            Self::KcPlus if sines >= length => return ConeSum::everything(),
            // tan asin(p / q). Never below Kc by rounding.
            Self::KcPlus => (sines / ((length - sines) * (length + sines)).sqrt()).max(least),
            _ => least,
        };
        if length < LEAST_SUM {
            return ConeSum::nothing();
        }
        let cone = FrictionCone::new(mu).ok().and_then(|friction| ContactCone::new(sum / length, friction).ok());
        cone.map_or_else(ConeSum::nothing, |cone| ConeSum::new(&[cone]))
    }
}

crate::quantity::by_name!(ConeKind, ConeKind::ALL);

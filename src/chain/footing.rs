//! The footprint of a hopper at a contact: the ground fitted over it, held against the rest slope and the roughness limit.

use std::{fmt, sync::Arc};

use super::{GroundForm, PolygonalChain, SegmentGround, Station, constrained::tilt_slope};
use crate::{
    quantity::{Angle, ChainPoint, MapPoint},
    terrain::{FootprintFit, FootprintGap, Surroundings},
    world::{Direction, FrictionCone, Hopper, Limit, RestSlope, SurfaceProperties},
};

/// Tolerance of a fit: an angle over its limit, rad, and a distance over its limit, as a share of the footprint. The integrals of a
/// fit are exact, but they round: a plane of exactly the rest slope, or without any roughness, has to pass.
const FIT_TOLERANCE: f64 = 1e-9;

/// Rounding error of the heights under a footprint, in units in the last place.
const HEIGHT_ULPS: f64 = 8.0;

/// Why the ground under the footprint of a contact refuses it for every hop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FootprintRefusal {
    /// The fitted plane is too steep to rest on.
    TooSteep {
        /// Its inclination from the horizontal.
        fitted: Angle,
        /// The steepest allowed.
        max: Angle,
        /// The greatest distance of the ground from it, m.
        residual_m: f64,
        /// Diameter of the footprint, m.
        footprint_m: f64,
    },
    /// The ground deviates too much from the fitted plane.
    TooRough {
        /// The greatest distance of the ground from it, m.
        residual_m: f64,
        /// The greatest allowed, m.
        max_m: f64,
        /// Inclination of the plane from the horizontal.
        fitted: Angle,
        /// Diameter of the footprint, m.
        footprint_m: f64,
    },
    /// The ground under the footprint is not known.
    Unknown {
        /// Why.
        gap: FootprintGap,
        /// Diameter of the footprint, m.
        footprint_m: f64,
    },
}

impl FootprintRefusal {
    /// The limit under which this refusal is counted: ground that is not known under the slope.
    pub const fn limit(&self) -> Limit {
        match self {
            Self::TooSteep { .. } | Self::Unknown { .. } => Limit::FootprintSlope,
            Self::TooRough { .. } => Limit::Roughness,
        }
    }

    /// By how many degrees the limit is exceeded, if it is a limit of angles.
    pub fn excess_deg(&self) -> Option<f64> {
        match self {
            Self::TooSteep { fitted, max, .. } => Some(fitted.degrees() - max.degrees()),
            Self::TooRough { .. } | Self::Unknown { .. } => None,
        }
    }
}

impl fmt::Display for FootprintRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooSteep { fitted, max, residual_m, footprint_m } => write!(
                f,
                "the plane fitted over its footprint of {footprint_m} m slopes {:.3} deg, more than the rest slope of {:.3} deg \
                 (greatest residual {residual_m:.3} m)",
                fitted.degrees(),
                max.degrees()
            ),
            Self::TooRough { residual_m, max_m, fitted, footprint_m } => write!(
                f,
                "the ground under its footprint of {footprint_m} m lies up to {residual_m:.3} m off the fitted plane, more than the \
                 roughness of {max_m} m (the plane slopes {:.3} deg)",
                fitted.degrees()
            ),
            Self::Unknown { gap: FootprintGap::Border, footprint_m } => {
                write!(f, "its footprint of {footprint_m} m reaches over the end of the known ground")
            }
            Self::Unknown { gap: FootprintGap::NoData, footprint_m } => {
                write!(f, "an elevation under its footprint of {footprint_m} m is missing")
            }
        }
    }
}

/// The footprint of a hopper and what it asks of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Footprint {
    /// Its diameter, m.
    pub(crate) diameter_m: f64,
    roughness_max_m: Option<f64>,
}

impl Footprint {
    /// The footprint of a hopper; `None` if it has none.
    pub(crate) fn of(hopper: &Hopper) -> Option<Self> {
        let limits = hopper.limits();
        let diameter_m = limits.footprint_m.filter(|diameter_m| *diameter_m > 0.0)?;
        Some(Self { diameter_m, roughness_max_m: limits.roughness_max_m })
    }

    /// Whether a fit allows a contact at a height, where the rest slope has this tangent; why not, if it does not.
    pub(crate) fn judge(
        &self,
        fit: Result<FootprintFit, FootprintGap>,
        rest_slope: Option<f64>,
        height_m: f64,
    ) -> Option<FootprintRefusal> {
        let footprint_m = self.diameter_m;
        let FootprintFit { tilt_slope, residual_m } = match fit {
            Ok(fit) => fit,
            Err(gap) => return Some(FootprintRefusal::Unknown { gap, footprint_m }),
        };
        let fitted = Angle::from_slope(tilt_slope);
        let rounding_m = HEIGHT_ULPS * f64::EPSILON * height_m.abs();
        // Written so that NaN is refused.
        let rests = rest_slope.is_none_or(|max| tilt_slope <= max + (FIT_TOLERANCE + rounding_m / footprint_m) * (1.0 + max * max));
        if !rests {
            let max = Angle::from_slope(rest_slope.unwrap_or(f64::INFINITY));
            return Some(FootprintRefusal::TooSteep { fitted, max, residual_m, footprint_m });
        }
        let max_m = self.roughness_max_m?;
        let even = residual_m <= max_m + FIT_TOLERANCE * footprint_m + rounding_m;
        (!even).then_some(FootprintRefusal::TooRough { residual_m, max_m, fitted, footprint_m })
    }

    /// Whether a fit is so close to a limit that another way of computing it could decide otherwise.
    pub(crate) fn is_close(&self, fit: &FootprintFit, rest_slope: Option<f64>) -> bool {
        /// Much larger than rounding, and so small that few contacts are close.
        const NEAR: f64 = 1e-6;
        let near = |found: f64, max: f64, size: f64| (found - max).abs() <= NEAR * (size + max);
        rest_slope.is_some_and(|max| near(fit.tilt_slope, max, 1.0 + max * max))
            || self.roughness_max_m.is_some_and(|max_m| near(fit.residual_m, max_m, self.diameter_m))
    }
}

/// What a chain knows of the ground under a footprint.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) enum Footing {
    /// Its profile alone.
    #[default]
    Profile,
    /// The DEM that it is a slice of.
    Map(Arc<Surroundings>),
}

impl Footing {
    /// Fits the ground around a station of a chain whose vertices are at these heights, `raised_m` above those of the chain: over a
    /// disc of the DEM, or along the profile.
    pub(crate) fn fit(
        &self,
        chain: &PolygonalChain,
        vertices: &[ChainPoint],
        station: &Station,
        footprint_m: f64,
        raised_m: Option<&dyn Fn(MapPoint) -> f64>,
    ) -> Result<FootprintFit, FootprintGap> {
        match (self, chain.map_point(station)) {
            (Self::Map(surroundings), Some(at)) => surroundings.fit_raised(at, station.point.z_m, footprint_m, raised_m),
            _ => fit_profile(chain, vertices, station.point, footprint_m),
        }
    }
}

/// Fits a line along the profile from half a footprint before a point to half a footprint after it.
///
/// ```text
///     z = a + s x,    a = (1/2r) int z dx,    s = (3/2r^3) int x z dx        from x = -r to x = r
/// ```
///
/// over the polyline, in closed form; the greatest residual is at a vertex or at an end. The inclination of the ground has the line's
/// slope along the profile and, across it, the greatest cross-slope of the segments touched: no plane through the footprint that the
/// profile and these cross-slopes allow is steeper.
fn fit_profile(
    chain: &PolygonalChain,
    vertices: &[ChainPoint],
    at: ChainPoint,
    footprint_m: f64,
) -> Result<FootprintFit, FootprintGap> {
    let half_m = 0.5 * footprint_m;
    let (first_m, last_m) = chain.extent_m();
    let rounding_m = 1e-9 * footprint_m + 4.0 * f64::EPSILON * at.x_m.abs();
    // Written so that NaN is refused.
    let inside = at.x_m - half_m >= first_m - rounding_m && at.x_m + half_m <= last_m + rounding_m;
    if !inside {
        return Err(FootprintGap::Border);
    }
    let (low_m, high_m) = ((at.x_m - half_m).max(first_m), (at.x_m + half_m).min(last_m));
    let first = vertices.partition_point(|vertex| vertex.x_m <= low_m).saturating_sub(1);
    // Each part of a segment: its ends from the middle in halves of the footprint, with the heights over the point.
    let parts = || {
        let touched = vertices.windows(2).enumerate().skip(first).take_while(move |(_, ends)| ends[0].x_m < high_m);
        touched.map(move |(segment, ends)| {
            let height_m = |x_m: f64| {
                let share = (x_m - ends[0].x_m) / (ends[1].x_m - ends[0].x_m);
                (ends[0].z_m - at.z_m) + (ends[1].z_m - ends[0].z_m) * share
            };
            let (from_m, to_m) = (ends[0].x_m.max(low_m), ends[1].x_m.min(high_m));
            (segment, [from_m, to_m].map(|x_m| ((x_m - at.x_m) / half_m, height_m(x_m))))
        })
    };
    let (mut sum, mut first_moment, mut cross_slope) = (0.0, 0.0, 0.0f64);
    for (segment, [(from, from_z), (to, to_z)]) in parts() {
        let length = to - from;
        sum += 0.5 * length * (from_z + to_z);
        first_moment += length / 6.0 * (2.0 * from * from_z + from * to_z + to * from_z + 2.0 * to * to_z);
        if let Some(GroundForm::Surface { cross_slope: across, .. }) = chain.grounds().get(segment).map(|ground| ground.form) {
            cross_slope = cross_slope.max(across.slope().abs());
        }
    }
    let (middle, slope) = (0.5 * sum, 1.5 * first_moment);
    let ends = parts().flat_map(|(_, ends)| ends);
    let residual_m = ends.map(|(x, z)| (z - (middle + slope * x)).abs()).fold(0.0, f64::max);
    Ok(FootprintFit { tilt_slope: tilt_slope(slope / half_m, cross_slope), residual_m })
}

/// The tangent of the steepest slope to rest on, for ground of this kind; `None` if every slope holds.
pub(crate) fn rest_slope(ground: &SegmentGround, surface: &SurfaceProperties) -> Option<f64> {
    match surface.rest {
        RestSlope::AsFrictionHolds => ground.friction_under(surface).map(FrictionCone::coefficient),
        RestSlope::AtMost(angle) => Some(angle.slope()),
        RestSlope::Unlimited => None,
    }
}

/// Whether every contact between two stations of one segment, when hops of equal length follow one another and the last one covers the
/// rest, is allowed by the footprint.
///
/// Along a profile the middle of a long segment is plane, so that only contacts within half a footprint of its ends, and one other, are
/// fitted. Over a DEM all are.
pub(crate) fn contacts_stand(
    refused: impl Fn(f64) -> bool,
    from_m: f64,
    direction: Direction,
    each_m: f64,
    hops: u64,
    plain: Option<(f64, f64)>,
) -> bool {
    /// More contacts than this are not fitted one by one: the hops along the segment are then not counted as possible.
    const MOST: u64 = 100_000;
    #[expect(clippy::cast_precision_loss, reason = "at most 2^53 hops")]
    let x_m = |contact: u64| from_m + direction.sign() * each_m * contact as f64;
    let Some((low_m, high_m)) = plain.filter(|(low_m, high_m)| low_m < high_m) else {
        return hops <= MOST && !(1..hops).any(|contact| refused(x_m(contact)));
    };
    let is_plain = |contact: u64| (low_m..=high_m).contains(&x_m(contact));
    // The contacts in the plane middle follow one another.
    let first = (1..hops).take_while(|contact| !is_plain(*contact)).take(usize::try_from(MOST).unwrap_or(usize::MAX)).last();
    let first_plain = first.map_or(1, |contact| contact + 1);
    let last_plain = (1..hops).rev().find(|contact| is_plain(*contact) || hops - contact > MOST).unwrap_or(0);
    if first_plain > MOST || hops - last_plain > MOST {
        return false;
    }
    let before = 1..first_plain.min(hops);
    let after = (last_plain.max(first_plain.saturating_sub(1)) + 1)..hops;
    let middle = (first_plain..=last_plain).take(1);
    !before.chain(middle).chain(after).any(|contact| refused(x_m(contact)))
}

//! The plane fitted over the footprint of a hopper on a DEM.
//!
//! The footprint is a regular polygon of 16 sides around the disc that the hopper stands on, two of them facing east and west:
//!
//! ```text
//!      .-'''-.
//!     /   |   \        the disc touches every side in its middle, so the polygon reaches exactly half a footprint
//!    |----+----|       to the east, north, west and south, and 2 % farther in its corners
//!     \   |   /
//!      '-...-'
//! ```
//!
//! The ground is the triangulated DEM: plane on every facet. Each facet is clipped by the polygon, and the integrals of the
//! least-squares plane `z = a + b x + c y` over the pieces are exact. With `x` and `y` from the polygon's centre the normal
//! equations are diagonal,
//!
//! ```text
//!      a = (1/A) int z,    b = (1/I) int x z,    c = (1/I) int y z,    A = n t r^2,  I = (A r^2 / 4) (1 + t^2 / 3)
//! ```
//!
//! for `n` sides at a distance `r` and `t = tan(pi / n)`. The ground minus the plane is plane on every piece, so that its greatest
//! value is at a corner of a piece. Nothing is sampled, and pieces that are divided further change nothing.

use nalgebra::Vector2;

use super::PostLattice;
use crate::quantity::MapPoint;

/// Sides of the polygon that stands for the footprint.
const SIDES: usize = 16;

/// Pieces of a smaller share of the footprint come from rounding: a facet that only touches the polygon is not under it.
const TOUCHING: f64 = 1e-12;

/// Tolerance of the border, in post spacings, as for positions on the lattice.
const ON_THE_LINE: f64 = 1e-9;

/// The plane fitted over a footprint, or the line over a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootprintFit {
    /// The tangent of its full inclination.
    pub tilt_slope: f64,
    /// The greatest vertical distance of the ground from it, m.
    pub residual_m: f64,
}

/// Why no plane can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FootprintGap {
    /// The footprint reaches over the end of the terrain.
    Border,
    /// An elevation under the footprint is missing.
    NoData,
}

/// A corner of a piece: position from the centre in halves of the footprint, and height over the base.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    x: f64,
    y: f64,
    z: f64,
}

/// A facet or the part of one under the footprint: a convex polygon.
#[derive(Clone, Copy, Debug)]
struct Piece {
    corners: [Corner; SIDES + 3],
    count: usize,
}

/// The outward normals of the sides, all at distance 1 from the centre.
fn normals() -> impl Iterator<Item = Vector2<f64>> {
    // The cosines of 0, 22.5, 45, 67.5 and 90 degrees.
    const COSINES: [f64; 5] = [1.0, 0.923_879_532_511_286_7, std::f64::consts::FRAC_1_SQRT_2, 0.382_683_432_365_089_8, 0.0];
    (0..SIDES).map(|side| {
        let (quarter, step) = (side / 4, side % 4);
        let (along, across) = (COSINES[step], COSINES[4 - step]);
        match quarter {
            0 => Vector2::new(along, across),
            1 => Vector2::new(-across, along),
            2 => Vector2::new(-along, -across),
            _ => Vector2::new(across, -along),
        }
    })
}

/// The distance of a point from the centre as the polygon measures it: 1 on its border.
fn measure(x: f64, y: f64) -> f64 {
    let (long, short) = (x.abs().max(y.abs()), x.abs().min(y.abs()));
    // The side that faces an octant is one of three.
    long.max(0.923_879_532_511_286_7 * long + 0.382_683_432_365_089_8 * short).max(std::f64::consts::FRAC_1_SQRT_2 * (long + short))
}

impl Piece {
    fn of(facet: [Corner; 3]) -> Self {
        let mut corners = [Corner::default(); SIDES + 3];
        corners[..3].copy_from_slice(&facet);
        Self { corners, count: 3 }
    }

    fn corners(&self) -> &[Corner] {
        &self.corners[..self.count]
    }

    /// The part of it on the inner side of one side of the polygon.
    fn clipped(&self, normal: Vector2<f64>) -> Self {
        let mut kept = Self { count: 0, ..*self };
        let beyond = |corner: &Corner| normal.x * corner.x + normal.y * corner.y - 1.0;
        let mut push = |corner| {
            // A convex polygon gains at most one corner by a cut; rounding must not overrun the array.
            if kept.count < kept.corners.len() {
                kept.corners[kept.count] = corner;
                kept.count += 1;
            }
        };
        for (i, to) in self.corners().iter().enumerate() {
            let from = &self.corners[(i + self.count - 1) % self.count];
            let (before, after) = (beyond(from), beyond(to));
            if (before > 0.0) != (after > 0.0) {
                let share = before / (before - after);
                let between = |a: f64, b: f64| a + (b - a) * share;
                push(Corner { x: between(from.x, to.x), y: between(from.y, to.y), z: between(from.z, to.z) });
            }
            if after <= 0.0 {
                push(*to);
            }
        }
        kept
    }

    /// The part of a facet under the polygon; `None` if that is nothing.
    fn under(self) -> Option<Self> {
        if self.corners().iter().all(|corner| measure(corner.x, corner.y) <= 1.0) {
            return Some(self);
        }
        let mut piece = self;
        for normal in normals() {
            let beyond = |corner: &Corner| normal.x * corner.x + normal.y * corner.y > 1.0;
            match piece.corners().iter().filter(|corner| beyond(corner)).count() {
                0 => continue,
                all if all == piece.count => return None,
                _ => {}
            }
            piece = piece.clipped(normal);
            if piece.count < 3 {
                return None;
            }
        }
        Some(piece)
    }

    /// The integrals of 1, z, x z and y z over it.
    fn integrals(&self) -> [f64; 4] {
        let mut sums = [0.0; 4];
        let first = self.corners[0];
        for pair in self.corners()[1..].windows(2) {
            let (b, c) = (pair[0], pair[1]);
            let area = 0.5 * ((b.x - first.x) * (c.y - first.y) - (c.x - first.x) * (b.y - first.y)).abs();
            let z = first.z + b.z + c.z;
            // Exact for products of linear functions: (area / 12) (sum f sum g + sum f g).
            let with_z = |f: [f64; 3]| area / 12.0 * ((f[0] + f[1] + f[2]) * z + f[0] * first.z + f[1] * b.z + f[2] * c.z);
            sums[0] += area;
            sums[1] += area / 3.0 * z;
            sums[2] += with_z([first.x, b.x, c.x]);
            sums[3] += with_z([first.y, b.y, c.y]);
        }
        sums
    }
}

/// Visits the pieces of the facets under a footprint.
fn pieces(
    lattice: &PostLattice,
    heights: &impl Fn(usize, usize) -> f64,
    (at, base_m, half_m): (MapPoint, f64, f64),
    visit: &mut impl FnMut(&Piece, [f64; 4]),
) -> Result<(), FootprintGap> {
    let map = lattice.georeference();
    let (origin, dx_m, dy_m) = (map.north_west(), map.dx_m(), map.dy_m());
    // Columns east and rows south of the north-west post.
    let (middle_col, middle_row) = ((at.x - origin.x) / dx_m, (origin.y - at.y) / dy_m);
    let cols = squares(middle_col, half_m / dx_m, lattice.cols(), f64::EPSILON * at.x.abs().max(origin.x.abs()) / dx_m)?;
    let rows = squares(middle_row, half_m / dy_m, lattice.rows(), f64::EPSILON * at.y.abs().max(origin.y.abs()) / dy_m)?;
    let (step_x, step_y) = (dx_m / half_m, dy_m / half_m);
    #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
    let corner = |row: usize, col: usize| Corner {
        x: (col as f64 - middle_col) * step_x,
        y: (middle_row - row as f64) * step_y,
        z: heights(row, col) - base_m,
    };
    for row in rows {
        for col in cols.clone() {
            let (north_west, south_east) = (corner(row, col), corner(row + 1, col + 1));
            for third in [corner(row, col + 1), corner(row + 1, col)] {
                let Some(piece) = Piece::of([north_west, third, south_east]).under() else { continue };
                let integrals = piece.integrals();
                if integrals[0] <= TOUCHING {
                    continue;
                }
                if integrals[1].is_nan() {
                    return Err(FootprintGap::NoData);
                }
                visit(&piece, integrals);
            }
        }
    }
    Ok(())
}

/// The squares of posts along one axis that a footprint touches.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the raster first")]
#[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
fn squares(middle: f64, half: f64, posts: usize, rounding: f64) -> Result<std::ops::Range<usize>, FootprintGap> {
    let (low, high, last) = (middle - half, middle + half, (posts - 1) as f64);
    let tolerance = ON_THE_LINE * (1.0 + half) + 4.0 * rounding;
    // Written so that NaN is refused.
    let inside = low >= -tolerance && high <= last + tolerance;
    if !inside {
        return Err(FootprintGap::Border);
    }
    Ok(low.floor().clamp(0.0, last - 1.0) as usize..(high.ceil().clamp(1.0, last) as usize))
}

/// Fits a plane over the footprint of this diameter around a map point, m.
///
/// `heights` gives the elevation of every post by row and column, NaN where it has none; `base_m` is any height near the ground
/// there, from which heights are counted, so that they keep their digits.
///
/// # Returns
/// The gradient of the plane (to the east and north) and the greatest vertical distance of the ground from it, m.
///
/// # Complexity
/// Two passes over the facets under the footprint, `4 (footprint / spacing)^2` of them.
///
/// # Errors
/// [`FootprintGap`] where the ground under the footprint is not known.
pub(super) fn fit_plane(
    lattice: &PostLattice,
    heights: &impl Fn(usize, usize) -> f64,
    at: MapPoint,
    base_m: f64,
    footprint_m: f64,
) -> Result<(Vector2<f64>, f64), FootprintGap> {
    let half_m = 0.5 * footprint_m;
    let mut sums = [0.0; 4];
    pieces(lattice, heights, (at, base_m, half_m), &mut |_, integrals| {
        sums.iter_mut().zip(integrals).for_each(|(sum, integral)| *sum += integral);
    })?;
    // tan(pi / 16)
    let tangent = 0.198_912_367_379_658_02;
    let area = 16.0 * tangent;
    let inertia = 0.25 * area * (1.0 + tangent * tangent / 3.0);
    // The pieces cover the polygon: a hole would be ground that is not known.
    let covered = (sums[0] - area).abs() <= 1e-6 * area;
    if !covered {
        return Err(FootprintGap::NoData);
    }
    let (a, b, c) = (sums[1] / area, sums[2] / inertia, sums[3] / inertia);
    let mut residual_m: f64 = 0.0;
    pieces(lattice, heights, (at, base_m, half_m), &mut |piece, _| {
        for corner in piece.corners() {
            residual_m = residual_m.max((corner.z - (a + b * corner.x + c * corner.y)).abs());
        }
    })?;
    Ok((Vector2::new(b, c) / half_m, residual_m))
}

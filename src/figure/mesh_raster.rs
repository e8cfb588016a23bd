//! A mesh seen from a direction, as a raster with the depth of every pixel: three million facets cost as many bytes as three.
//!
//! ```text
//!            up
//!             |   towards the viewer          across, up: on the sheet;  near: towards the viewer
//!             |  /
//!             | /_______ across
//! ```
//!
//! Facets are seen from their outer side, in a grey by their normal. Those seen from behind are a veil of dots over what they cover: the
//! ceiling and the near wall of a cave do not hide what is in it.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::{
    bitmap::{Form, Pixels},
    mesh_paint::{Paint, Tone},
    sheet::Place,
};
use crate::terrain::{Mesh, MeshBounds};

/// Pixels per mm: those of the finest facets that print.
const PIXELS_PER_MM: f64 = 8.0;
/// Greys of facets, from dark to light.
const SHADES: u8 = 64;
/// The darkest and the lightest grey of a facet.
const GREYS: (f64, f64) = (88.0, 246.0);
/// The entries of the palette before the greys: the page, outlines, contour lines, the veil.
const PAGE: u8 = 0;
const OUTLINE: u8 = 1;
const CONTOUR: u8 = 2;
const VEIL: u8 = 3;
const FIRST_GREY: u8 = 4;
/// The entry after the greys: the colours of places, each with so many shades.
const FIRST_PAINT: u8 = FIRST_GREY + SHADES;
const PAINT_SHADES: u8 = 16;
/// How dark the darkest shade of a colour is.
const DARKEST: f64 = 0.62;
/// Towards the light: from the upper left, in front.
const LIGHT: [f64; 3] = [-0.45, 0.7, 0.55];
/// A step in depth of this share of the view is an outline.
const STEP: f64 = 0.02;
/// A height that many steps below a contour line is on it.
const ON_LINE: f64 = 1e-6;
/// The period of the dots of the veil, pixels.
const PERIOD: usize = 5;

/// A direction from which a mesh is seen, and how its points lie on the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    across: Vector3<f64>,
    up: Vector3<f64>,
    near: Vector3<f64>,
}

impl View {
    /// Seen by someone who stands in this direction from the scene: its azimuth, clockwise from north, and its elevation.
    pub(super) fn from_deg(azimuth_deg: f64, elevation_deg: f64) -> Self {
        let (sin, cos) = libm::sincos(azimuth_deg.to_radians());
        let (rise, level) = libm::sincos(elevation_deg.to_radians());
        let near = Vector3::new(sin * level, cos * level, rise);
        let across = Vector3::new(-cos, sin, 0.0);
        Self { across, up: near.cross(&across), near }
    }

    /// Seen from straight above, with north up.
    pub(super) const fn plan() -> Self {
        Self { across: Vector3::new(1.0, 0.0, 0.0), up: Vector3::new(0.0, 1.0, 0.0), near: Vector3::new(0.0, 0.0, 1.0) }
    }

    /// Across, up and towards the viewer, m.
    pub(super) fn of(&self, point: &Point3<f64>) -> [f64; 3] {
        [self.across, self.up, self.near].map(|axis| axis.dot(&point.coords))
    }
}

/// The part of a view that a panel shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Left and lower end, m across and up.
    pub(super) low: [f64; 2],
    /// Right and upper end.
    pub(super) high: [f64; 2],
    pub(super) mm_per_m: f64,
    /// The upper left corner on the sheet.
    pub(super) corner_mm: Place,
}

impl Window {
    pub(super) fn size_mm(&self) -> Place {
        ((self.high[0] - self.low[0]) * self.mm_per_m, (self.high[1] - self.low[1]) * self.mm_per_m)
    }

    /// Where a point across and up lies on the sheet.
    pub(super) fn place(&self, [across, up, _]: [f64; 3]) -> Place {
        (self.corner_mm.0 + (across - self.low[0]) * self.mm_per_m, self.corner_mm.1 + (self.high[1] - up) * self.mm_per_m)
    }

    pub(super) fn shows(&self, [across, up, _]: [f64; 3]) -> bool {
        self.low[0] <= across && across <= self.high[0] && self.low[1] <= up && up <= self.high[1]
    }
}

/// The facets of a mesh in a window, nearest ones in front.
pub(super) struct Seen {
    window: Window,
    width: usize,
    height: usize,
    /// How near the facet of a pixel is to the viewer, m; minus infinity without one.
    near_m: Vec<f64>,
    /// The facet of a pixel, where there is one that faces the viewer.
    facets: Vec<u32>,
    inks: Vec<u8>,
    /// The colours of places, if they have any.
    colours: Vec<[u8; 3]>,
    per_m: f64,
    /// The depth of the whole view, m.
    deep_m: f64,
}

impl Seen {
    /// Draws the facets of a mesh. `cut_z_m`: what lies higher is left out.
    pub(super) fn of(mesh: &Mesh, view: &View, window: Window, cut_z_m: Option<f64>) -> Self {
        let (wide_mm, high_mm) = window.size_mm();
        let [width, height] = [wide_mm, high_mm].map(|mm| whole(mm * PIXELS_PER_MM));
        let deep_m = depth_m(view, &mesh.bounds());
        let per_m = window.mm_per_m * PIXELS_PER_MM;
        let mut seen = Self {
            window,
            width,
            height,
            near_m: vec![f64::NEG_INFINITY; width * height],
            facets: vec![u32::MAX; width * height],
            colours: Vec::new(),
            inks: vec![PAGE; width * height],
            per_m,
            deep_m,
        };
        let light = Vector3::from(LIGHT).normalize();
        let light = view.across * light.x + view.up * light.y + view.near * light.z;
        let mut behind = Vec::new();
        for (number, corners) in mesh.triangles().enumerate() {
            if cut_z_m.is_some_and(|cut_m| corners.iter().all(|corner| corner.z > cut_m)) {
                continue;
            }
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            let Some(normal) = normal.try_normalize(0.0) else { continue };
            let facing = normal.dot(&view.near);
            if facing <= 0.0 {
                behind.push(number);
                continue;
            }
            let bright = 0.25 * facing + 0.75 * normal.dot(&light).max(0.0);
            let ink = FIRST_GREY + shade(bright);
            let facet = u32::try_from(number).unwrap_or(u32::MAX);
            seen.fill(view, &corners, cut_z_m, |seen, at, near_m| {
                if near_m > seen.near_m[at] {
                    (seen.near_m[at], seen.inks[at], seen.facets[at]) = (near_m, ink, facet);
                }
            });
        }
        seen.outlines();
        let indices = mesh.indices();
        for number in behind {
            let corners = indices[number].map(|corner| mesh.vertices()[corner as usize]);
            seen.fill(view, &corners, cut_z_m, |seen, at, near_m| {
                let (row, column) = (at / seen.width, at % seen.width);
                let is_dot = column.is_multiple_of(PERIOD) && (row + 2 * (column / PERIOD % 2)).is_multiple_of(PERIOD);
                if is_dot && near_m > seen.near_m[at] {
                    seen.inks[at] = VEIL;
                }
            });
        }
        seen
    }

    /// Visits the pixels whose middles lie in a triangle, with how near it is there.
    fn fill(
        &mut self,
        view: &View,
        corners: &[Point3<f64>; 3],
        cut_z_m: Option<f64>,
        mut visit: impl FnMut(&mut Self, usize, f64),
    ) {
        let placed = corners.map(|corner| {
            let [across, up, near] = view.of(&corner);
            ([(across - self.window.low[0]) * self.per_m, (self.window.high[1] - up) * self.per_m], near)
        });
        let [(a, near_a), (b, near_b), (c, near_c)] = placed;
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 {
            return;
        }
        let range = |axis: usize, most: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]) - 0.5;
            let high = a[axis].max(b[axis]).max(c[axis]) - 0.5;
            (upwards(low, most), downwards(high, most))
        };
        let ((left, right), (top, bottom)) = (range(0, self.width), range(1, self.height));
        for row in top..bottom {
            for column in left..right {
                let at = [middle(column), middle(row)];
                let share = |p: [f64; 2], q: [f64; 2]| ((q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0])) / area;
                let (of_a, of_b, of_c) = (share(b, c), share(c, a), share(a, b));
                if of_a < 0.0 || of_b < 0.0 || of_c < 0.0 {
                    continue;
                }
                if cut_z_m.is_some_and(|cut_m| of_a * corners[0].z + of_b * corners[1].z + of_c * corners[2].z > cut_m) {
                    continue;
                }
                visit(self, row * self.width + column, of_a * near_a + of_b * near_b + of_c * near_c);
            }
        }
    }

    /// Dark pixels where a nearer surface ends before one behind it.
    fn outlines(&mut self) {
        let least_m = STEP * self.deep_m;
        let mut dark = Vec::new();
        for row in 0..self.height {
            for column in 0..self.width {
                let at = row * self.width + column;
                let own_m = self.near_m[at];
                let beside = [
                    (column + 1 < self.width, at + 1),
                    (column > 0, at.wrapping_sub(1)),
                    (row + 1 < self.height, at + self.width),
                    (row > 0, at.wrapping_sub(self.width)),
                ];
                let ends = beside.into_iter().any(|(is_one, other)| is_one && own_m - self.near_m[other] > least_m);
                if own_m.is_finite() && ends {
                    dark.push(at);
                }
            }
        }
        for at in dark {
            self.inks[at] = OUTLINE;
        }
    }

    /// Contour lines at whole multiples of a step of how near the surface is: of its height, seen from above.
    pub(super) fn contours(&mut self, step_m: f64) {
        // A level facet at such a height lies on one side of its line, whatever the last digits of its corners.
        let band = |near_m: f64| (near_m / step_m + ON_LINE).floor();
        let mut lines = Vec::new();
        for row in 0..self.height.saturating_sub(1) {
            for column in 0..self.width.saturating_sub(1) {
                let at = row * self.width + column;
                let own_m = self.near_m[at];
                let crosses = [at + 1, at + self.width].into_iter().any(|other| {
                    let other_m = self.near_m[other];
                    other_m.is_finite() && (other_m - own_m).abs() < 3.0 * step_m && band(other_m) != band(own_m)
                });
                if own_m.is_finite() && crosses && self.inks[at] >= FIRST_GREY {
                    lines.push(at);
                }
            }
        }
        for at in lines {
            self.inks[at] = CONTOUR;
        }
    }

    /// Gives the facets that are seen the colours of their places, in the shades of their normals; outlines, contour lines and the veil stay.
    pub(super) fn paint(&mut self, mesh: &Mesh, view: &View, paint: &Paint) {
        let inks: Vec<u8> = (0..self.inks.len()).into_par_iter().map(|at| self.painted(mesh, view, paint, at)).collect();
        self.inks = inks;
        self.colours = paint.colours().to_vec();
    }

    /// The ink of a pixel with its colour.
    fn painted(&self, mesh: &Mesh, view: &View, paint: &Paint, at: usize) -> u8 {
        let ink = self.inks[at];
        let Some(corners) = mesh.indices().get(self.facets[at] as usize).filter(|_| ink >= FIRST_GREY) else { return ink };
        let [a, b, c] = corners.map(|corner| mesh.vertices()[corner as usize]);
        let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else { return ink };
        let (row, column) = (at / self.width, at % self.width);
        let across = self.window.low[0] + middle(column) / self.per_m;
        let up = self.window.high[1] - middle(row) / self.per_m;
        let place = view.across * across + view.up * up + view.near * self.near_m[at];
        match paint.of(&place.into(), &normal, (row, column)) {
            Tone::Colour(colour) => FIRST_PAINT + colour * PAINT_SHADES + (ink - FIRST_GREY) / (SHADES / PAINT_SHADES),
            Tone::Stripe => OUTLINE,
        }
    }

    /// Whether a point is behind a facet that is seen.
    pub(super) fn hides(&self, [across, up, near]: [f64; 3]) -> bool {
        let column = (across - self.window.low[0]) * self.per_m;
        let row = (self.window.high[1] - up) * self.per_m;
        if !(column >= 0.0 && row >= 0.0 && self.window.shows([across, up, near])) {
            return false;
        }
        let at = downwards(row, self.height).saturating_sub(1) * self.width + downwards(column, self.width).saturating_sub(1);
        // Half a pixel of a steep facet, and a point on the surface, are not in front of themselves.
        self.near_m.get(at).is_some_and(|near_m| *near_m > near + 3.0 / self.per_m + 1e-3 * self.deep_m)
    }

    /// The raster.
    pub(super) fn into_pixels(self) -> Pixels {
        let grey = |number: u8| {
            let share = f64::from(number) / f64::from(SHADES - 1);
            [byte(GREYS.0 + share * (GREYS.1 - GREYS.0)); 3]
        };
        let mut colours = vec![[255; 3], [60; 3], [128, 96, 60], [176; 3]];
        colours.extend((0..SHADES).map(grey));
        let shades = 0..PAINT_SHADES;
        let share = |shade: u8| DARKEST + (1.0 - DARKEST) * f64::from(shade) / f64::from(PAINT_SHADES - 1);
        let painted = self
            .colours
            .iter()
            .flat_map(|colour| shades.clone().map(|shade| colour.map(|part| byte(share(shade) * f64::from(part)))));
        colours.extend(painted);
        Pixels { width: self.width, height: self.height, form: Form::Palette(colours), bytes: self.inks }
    }
}

/// How deep the box around a mesh is in a view, m.
fn depth_m(view: &View, bounds: &MeshBounds) -> f64 {
    let size = bounds.map.max - bounds.map.min;
    let size = Vector3::new(size.x, size.y, bounds.high_m - bounds.low_m);
    size.dot(&view.near.abs()).max(size.amax() * 0.1)
}

fn middle(number: usize) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "pixels of a page")]
    let number = number as f64;
    number + 0.5
}

/// The first whole number from a number on, between 0 and a greatest one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates, and is cut to the page")]
fn upwards(from: f64, most: usize) -> usize {
    (from.ceil().max(0.0) as usize).min(most)
}

/// The whole number after a number, between 0 and a greatest one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates, and is cut to the page")]
fn downwards(to: f64, most: usize) -> usize {
    if to < 0.0 { 0 } else { (to.floor() as usize).saturating_add(1).min(most) }
}

fn whole(pixels: f64) -> usize {
    upwards(pixels, 4000).max(1)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
fn byte(value: f64) -> u8 {
    value.round() as u8
}

fn shade(bright: f64) -> u8 {
    byte(bright.clamp(0.0, 1.0) * f64::from(SHADES - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(low: [f64; 2], high: [f64; 2]) -> Window {
        Window { low, high, mm_per_m: 10.0, corner_mm: (0.0, 0.0) }
    }

    /// A floor, a plate over a part of it that faces up, and a ceiling over all that faces down.
    fn room() -> Mesh {
        let square = |half: f64, z: f64| [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]].map(Point3::from);
        let corners = [square(2.0, 0.0), square(0.5, 1.0), square(2.0, 3.0)].concat();
        Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [8, 10, 9], [8, 11, 10]]).unwrap()
    }

    #[test]
    fn directions_of_a_view_are_at_right_angles_and_right_handed() {
        for (azimuth_deg, elevation_deg) in [(0.0, 0.0), (180.0, 90.0), (215.0, 35.0), (30.0, -20.0)] {
            let view = View::from_deg(azimuth_deg, elevation_deg);
            assert!((view.across.cross(&view.up) - view.near).norm() < 1e-12);
        }
        // From the south, east is to the right; from above, so seen, north is up.
        let view = View::from_deg(180.0, 90.0);
        assert!((view.across - Vector3::x()).norm() < 1e-12 && (view.up - Vector3::y()).norm() < 1e-12);
    }

    #[test]
    fn facets_hide_what_is_behind_them_and_a_ceiling_hides_nothing() {
        let mesh = room();
        let view = View::plan();
        let seen = Seen::of(&mesh, &view, window([-2.0, -2.0], [2.0, 2.0]), None);
        let at = |x: f64, y: f64, z: f64| view.of(&Point3::new(x, y, z));
        // Under the plate and beside it, on the floor, and over the plate under the ceiling.
        assert!(seen.hides(at(0.1, 0.2, 0.3)) && !seen.hides(at(1.2, 0.2, 0.3)) && !seen.hides(at(0.1, 0.2, 2.0)));
        assert!(!seen.hides(at(1.2, 0.2, 0.0)) && seen.hides(at(1.2, 0.2, -1.0)) && !seen.hides(at(9.0, 0.0, -1.0)));
        // Without what lies over 0.5 m, the plate hides nothing.
        let cut = Seen::of(&mesh, &view, window([-2.0, -2.0], [2.0, 2.0]), Some(0.5));
        assert!(!cut.hides(at(0.1, 0.2, 0.3)));
        let pixels = seen.into_pixels();
        assert_eq!((pixels.width, pixels.height), (320, 320));
        // The ceiling is a veil: one pixel of 25.
        let veiled: u32 = pixels.bytes.iter().map(|ink| u32::from(*ink == VEIL)).sum();
        assert!((3500..4700).contains(&veiled), "{veiled}");
        assert!(cut.inks.iter().all(|ink| *ink != VEIL));
    }

    #[test]
    fn contours_of_a_slope_are_evenly_spaced() {
        let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [4.0, 4.0, 4.0], [0.0, 4.0, 0.0]].map(Point3::from).to_vec();
        let mesh = Mesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap();
        let mut seen = Seen::of(&mesh, &View::plan(), window([0.0, 0.0], [4.0, 4.0]), None);
        seen.contours(0.5);
        let row = &seen.inks[100 * seen.width..101 * seen.width];
        let lines: Vec<usize> = (0..row.len()).filter(|at| row[*at] == CONTOUR).collect();
        assert_eq!(lines.len(), 7, "{lines:?}");
        assert!(lines.windows(2).all(|pair| pair[1] - pair[0] == 40), "{lines:?}");
    }
}

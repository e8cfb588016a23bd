//! The oblique view of a mesh: its raster, the frame around it, and what both say.

use nalgebra::Point3;

use super::{
    SeenFrom,
    axes::Panel,
    keys,
    map::scale_bar,
    mesh_raster::{Seen, View, Window},
    palette::{AXIS, RIGHT_MM, SMALL_MM, WHITE},
    picture::{MARGIN_MM, paragraph},
    sheet::{Anchor, Hang, Label, Pen, Place, Sheet, SheetImage},
    ticks::short,
};
use crate::terrain::Mesh;

/// The greatest height of the view.
const TALL_MM: f64 = 76.0;
/// Room beside what is shown, as a share of its extent.
const BESIDE: f64 = 0.04;

/// A mesh seen from a direction, on the sheet.
pub(super) struct Oblique {
    seen_from: SeenFrom,
    pub(super) view: View,
    pub(super) window: Window,
    pub(super) seen: Seen,
}

impl Oblique {
    /// The view of a mesh below a height of the sheet, around some points; `size_m` is shown where they have no extent. `cut_z_m`: what lies
    /// higher is left out.
    pub(super) fn around<'p>(
        mesh: &Mesh,
        seen_from: SeenFrom,
        (points, size_m): (impl Iterator<Item = &'p Point3<f64>>, f64),
        cut_z_m: Option<f64>,
        top_mm: f64,
    ) -> Self {
        let view = View::from_deg(seen_from.azimuth_deg, seen_from.elevation_deg);
        let (low, high) =
            points.map(|point| view.of(point)).fold(([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]), |(low, high), at| {
                ([low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])])
            });
        let beside_m = BESIDE * (high[0] - low[0]).max(high[1] - low[1]).max(f64::MIN_POSITIVE);
        // A plate with its corners far away has none around the paths.
        let beside_m = if beside_m > f64::MIN_POSITIVE { beside_m } else { 0.5 * size_m };
        let (low, high) = (low.map(|end| end - beside_m), high.map(|end| end + beside_m));
        let wide_mm = RIGHT_MM - MARGIN_MM;
        let mm_per_m = (wide_mm / (high[0] - low[0])).min(TALL_MM / (high[1] - low[1]));
        let left_mm = MARGIN_MM + 0.5 * (wide_mm - (high[0] - low[0]) * mm_per_m);
        let window = Window { low, high, mm_per_m, corner_mm: (left_mm, top_mm) };
        let seen = Seen::of(mesh, &view, window, cut_z_m);
        Self { seen_from, view, window, seen }
    }

    /// Where a point lies on the sheet.
    pub(super) fn place(&self, point: &Point3<f64>) -> Place {
        self.window.place(self.view.of(point))
    }

    /// Puts the raster below the marks of the sheet, with its frame; returns where it ends. `colours`: what they mean, a sentence, or nothing.
    pub(super) fn finish(self, sheet: &mut Sheet, colours: &str) -> f64 {
        let Self { seen_from: SeenFrom { azimuth_deg, elevation_deg }, view, window, seen } = self;
        let ((left_mm, top_mm), (width_mm, height_mm)) = (window.corner_mm, window.size_mm());
        let panel = Panel { left: left_mm, top: top_mm, right: left_mm + width_mm, bottom: top_mm + height_mm };
        compass(sheet, &view, (panel.left + 9.0, panel.bottom - 8.0));
        scale_bar(sheet, (MARGIN_MM, top_mm - 3.0), window.mm_per_m, 0.3 * (RIGHT_MM - MARGIN_MM));
        sheet.images.push(SheetImage { left_mm, top_mm, width_mm, height_mm, pixels: seen.into_pixels() });
        panel.outline(sheet);
        let text = format!(
            "Oblique view, seen from azimuth {} deg (clockwise from north, +y), {} deg above the horizontal; the scale is that of lengths across the \
             view. Dots: facets seen from behind.{colours}",
            short(azimuth_deg),
            short(elevation_deg)
        );
        paragraph(sheet, &text, SMALL_MM, false, panel.bottom + 1.0)
    }
}

/// A bold name beside a symbol, on white, where there is room for it.
pub(super) fn named(sheet: &mut Sheet, (x, y): Place, name: &str) {
    let beside = [(2.4, 0.0, Anchor::Start), (-2.4, 0.0, Anchor::End), (0.0, -3.4, Anchor::Middle), (0.0, 3.4, Anchor::Middle)];
    let free = beside.into_iter().find_map(|(right, down, anchor)| {
        let label = Label { bold: true, ..Label::new(name, (x + right, y + down), SMALL_MM).hung(anchor, Hang::Through) };
        (!sheet.is_taken(&label)).then_some(label)
    });
    if let Some(label) = free {
        let (left, top, right, bottom) = label.bounds_mm();
        sheet.area(keys::rectangle((left - 0.3, top - 0.2), (right + 0.3, bottom + 0.2)), WHITE, 0.7);
        sheet.label(label);
    }
}

/// Arrows to the east, to the north and up.
fn compass(sheet: &mut Sheet, view: &View, (x, y): Place) {
    const LONG_MM: f64 = 5.5;
    let pen = Pen { colour: AXIS, width_mm: 0.3 };
    for (name, axis) in [("x", Point3::new(1.0, 0.0, 0.0)), ("y", Point3::new(0.0, 1.0, 0.0)), ("z", Point3::new(0.0, 0.0, 1.0))] {
        let [across, up, _] = view.of(&axis);
        // Along the line of sight there is no arrow.
        if libm::hypot(across, up) < 0.15 {
            continue;
        }
        let at = |length: f64| (x + across * length, y - up * length);
        sheet.line(vec![(x, y), at(LONG_MM)], pen);
        sheet.label(Label::new(name, at(LONG_MM + 1.6), SMALL_MM).hung(Anchor::Middle, Hang::Through));
    }
}

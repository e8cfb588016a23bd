//! A path over a mesh from above: what lies below a height, with contour lines.

use super::{
    super::{
        mesh_paint::Paint,
        mesh_raster::{Seen, View, Window},
        palette::{SMALL_MM, WHITE},
        picture::paragraph,
        sheet::{Pen, Sheet},
        ticks::{Ticks, short},
    },
    data::GoalMark,
    panel::{MapPanel, goal_symbol},
};
use crate::{
    quantity::MapPoint,
    terrain::{MapBounds, Mesh},
};

/// The greatest height of the map, which shares its page with the oblique view.
const TALL_MM: f64 = 72.0;
/// About so many contour lines.
const CONTOURS: f64 = 12.0;
/// Above this number of hops only some of the landings have their number.
const MOST_NUMBERED: usize = 12;

/// A path over a mesh from above.
pub(in super::super) struct MeshPlan<'a> {
    pub(in super::super) mesh: &'a Mesh,
    pub(in super::super) bounds: MapBounds,
    /// What lies higher is left out, m.
    pub(in super::super) cut_z_m: f64,
    /// The lowest height shown, m.
    pub(in super::super) low_z_m: f64,
    /// The start and every landing of each path, with its pen.
    pub(in super::super) paths: Vec<(Vec<MapPoint>, Pen)>,
    pub(in super::super) start: MapPoint,
    pub(in super::super) goal: MapPoint,
    /// The hops to the goal; `None`: not reached.
    pub(in super::super) goal_hops: Option<u64>,
    /// The colours of its places.
    pub(in super::super) paint: Option<&'a Paint>,
}

/// Draws it below a height of a sheet; returns where it ends.
pub(in super::super) fn draw_mesh_plan(sheet: &mut Sheet, plan: &MeshPlan<'_>, top_mm: f64) -> f64 {
    let map = MapPanel::over(plan.bounds, top_mm, TALL_MM);
    let (mm_per_m, corner_mm) = map.layout();
    let (low, high) = (plan.bounds.min, plan.bounds.max);
    let window = Window { low: [low.x, low.y], high: [high.x, high.y], mm_per_m, corner_mm };
    let mut seen = Seen::of(plan.mesh, &View::plan(), window, Some(plan.cut_z_m));
    let steps = Ticks::round(plan.low_z_m, plan.cut_z_m, CONTOURS).values;
    let step_m = steps.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(plan.cut_z_m - plan.low_z_m);
    seen.contours(step_m);
    if let Some(paint) = plan.paint {
        seen.paint(plan.mesh, &View::plan(), paint);
    }
    let end_mm = map.draw(sheet, seen.into_pixels());
    for (path, pen) in &plan.paths {
        let points: Vec<_> = path.iter().map(|at| map.place(*at)).collect();
        sheet.line(points.clone(), Pen { colour: WHITE, width_mm: 3.0 * pen.width_mm });
        for at in &points {
            sheet.dot(*at, 0.55, pen.colour);
        }
        sheet.line(points, *pen);
    }
    let landings: Vec<Vec<MapPoint>> = plan.paths.iter().map(|(path, _)| path.clone()).collect();
    let goals = [GoalMark { at: plan.goal, hops: plan.goal_hops }];
    let several = landings.len() > 1;
    let mut taken = map.ends(sheet, &[plan.start], if several { &[] } else { &goals }, &landings);
    if several {
        // Each path has hops of its own.
        goal_symbol(sheet, map.place(plan.goal));
        map.name(sheet, plan.goal, "goal", &mut taken);
    }
    if let [path] = &landings[..] {
        let between = path.get(1..path.len().saturating_sub(1)).unwrap_or_default();
        let every = between.len().div_ceil(MOST_NUMBERED).max(1);
        for (number, at) in (1usize..).zip(between).filter(|(number, _)| number.is_multiple_of(every)) {
            map.name(sheet, *at, &number.to_string(), &mut taken);
        }
    }
    let text = format!(
        "Seen from above, without what lies higher than {} m; contour lines every {} m of height.",
        short(plan.cut_z_m),
        short(step_m)
    );
    paragraph(sheet, &text, SMALL_MM, false, end_mm + 1.0)
}

//! The panel shared by proofs and comparisons: ground and flights at one scale.

use super::{
    super::{
        FigureError, MOST_HOPS_DRAWN,
        axes::{BELOW_MM, Panel},
        palette::RIGHT_MM,
        scale::{DRAWN_MM, Frame},
        sheet::{Label, Place, Sheet, text_width_mm},
        terrain_panel::{self, BESIDE_MM, thinned},
    },
    Flight,
};
use crate::quantity::ChainPoint;

impl Flight {
    /// The loft (take-off slope minus the slope of the chord) times the horizontal distance, m; 0 for a flight of zero length.
    fn lift_m(&self) -> f64 {
        let run_m = (self.to.x_m - self.from.x_m).abs();
        if run_m > 0.0 { (self.takeoff_slope * run_m - (self.to.z_m - self.from.z_m)).max(0.0) } else { 0.0 }
    }

    /// The point at a fraction of the distance.
    pub(super) fn point_at(&self, share: f64) -> ChainPoint {
        let (run_m, rise_m) = (self.to.x_m - self.from.x_m, self.to.z_m - self.from.z_m);
        let lifted_m = self.lift_m() * share * (1.0 - share);
        ChainPoint::new(self.from.x_m + run_m * share, self.from.z_m + rise_m * share + lifted_m)
    }

    /// The highest point, m.
    pub(super) fn apex_z_m(&self) -> f64 {
        let (lift_m, rise_m) = (self.lift_m(), self.to.z_m - self.from.z_m);
        let share = if lift_m > 0.0 { (0.5 * (1.0 + rise_m / lift_m)).clamp(0.0, 1.0) } else { 0.0 };
        self.point_at(share).z_m.max(self.from.z_m).max(self.to.z_m)
    }
}

/// Every n-th flight of a path if there are too many to be distinguished, with n.
pub(super) fn shown(flights: &[Flight]) -> (Vec<Flight>, usize) {
    let every = flights.len().div_ceil(MOST_HOPS_DRAWN).max(1);
    (flights.iter().step_by(every).copied().collect(), every)
}

/// Checks that there is ground to draw.
pub(super) fn check_ground(what: &str, ground: &[ChainPoint]) -> Result<(), FigureError> {
    let points = ground.len();
    if points < 2 { Err(FigureError::NoGround { what: what.to_owned(), points }) } else { Ok(()) }
}

/// The panel: its position on the sheet and its scale.
pub(super) struct Profile {
    pub(super) panel: Panel,
    pub(super) frame: Frame,
}

impl Profile {
    /// Lays out a panel below a height of the sheet that holds points and flights.
    pub(super) fn new(points: impl Iterator<Item = ChainPoint>, flights: impl Iterator<Item = Flight>, top_mm: f64) -> Self {
        Self::within(points, flights, top_mm, DRAWN_MM)
    }

    /// The same with other bounds of the drawn height: the least and the greatest, mm.
    pub(super) fn within(
        points: impl Iterator<Item = ChainPoint>,
        flights: impl Iterator<Item = Flight>,
        top_mm: f64,
        drawn_mm: (f64, f64),
    ) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let wider = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
        let (mut along, mut heights) = points.fold((none, none), |(x, z), point| (wider(x, point.x_m), wider(z, point.z_m)));
        for flight in flights {
            along = [flight.from.x_m, flight.to.x_m].into_iter().fold(along, wider);
            heights = wider(heights, flight.apex_z_m());
        }
        if along.0 == along.1 {
            // Points at the same x still need a scale.
            along = (along.0 - 0.5, along.1 + 0.5);
        }
        let (panel, frame) = terrain_panel::laid_out_within(along, heights, (BESIDE_MM, BESIDE_MM), top_mm, drawn_mm);
        Self { panel, frame }
    }

    /// Axes and frame of the panel.
    pub(super) fn axes(&self, sheet: &mut Sheet, x_name: &str, y_name: &str) {
        terrain_panel::axes(sheet, &self.panel, &self.frame, x_name, y_name);
    }

    /// The lower end of the panel with its axis.
    pub(super) fn end_mm(&self) -> f64 {
        self.panel.bottom + BELOW_MM
    }

    /// A line on the sheet, thinned to the drawing resolution.
    pub(super) fn line(&self, points: &[ChainPoint]) -> Vec<Place> {
        thinned(&points.iter().map(|&point| self.frame.place(point)).collect::<Vec<_>>())
    }

    /// A flight on the sheet.
    pub(super) fn flight(&self, flight: &Flight) -> Vec<Place> {
        terrain_panel::parabola(&self.frame, flight.lift_m(), |share| flight.point_at(share))
    }

    /// Start or goal, with its name if there is room in the drawn ground.
    pub(super) fn pin(&self, sheet: &mut Sheet, ground: &[ChainPoint], at: ChainPoint, name: &str) {
        let inside = |label: &Label| {
            let (left, top, right, _) = label.bounds_mm();
            let under = |x_mm: f64| self.frame.place(at_x(ground, self.frame.x_m(x_mm))).1 <= top;
            left >= self.panel.left && right <= self.panel.right && under(left) && under(right)
        };
        terrain_panel::pin(sheet, &self.panel, self.frame.place(at), name, inside);
    }
}

/// The ground at an x; beyond an end, the ground at that end.
pub(super) fn at_x(ground: &[ChainPoint], x_m: f64) -> ChainPoint {
    let after = ground.partition_point(|point| point.x_m < x_m);
    match (after.checked_sub(1).and_then(|before| ground.get(before)), ground.get(after)) {
        (Some(a), Some(b)) if b.x_m > a.x_m => ChainPoint::new(x_m, a.z_m + (b.z_m - a.z_m) * (x_m - a.x_m) / (b.x_m - a.x_m)),
        (_, Some(end)) | (Some(end), None) => ChainPoint::new(x_m, end.z_m),
        (None, None) => ChainPoint::new(x_m, 0.0),
    }
}

/// The ground between two x: its points there and those at the two ends.
pub(super) fn part(ground: &[ChainPoint], from_x_m: f64, to_x_m: f64) -> Vec<ChainPoint> {
    let first = ground.partition_point(|point| point.x_m <= from_x_m);
    let end = ground.partition_point(|point| point.x_m < to_x_m).max(first);
    let ends = [from_x_m, to_x_m].map(|x_m| at_x(ground, x_m));
    std::iter::once(ends[0]).chain(ground[first..end].iter().copied()).chain([ends[1]]).collect()
}

/// A text truncated to a width, with an ellipsis.
pub(super) fn fitted(text: &str, size_mm: f64, width_mm: f64) -> String {
    if text_width_mm(text, size_mm) <= width_mm {
        return text.to_owned();
    }
    let mut kept = String::new();
    for letter in text.chars() {
        if text_width_mm(&kept, size_mm) + 3.0 * size_mm > width_mm {
            break;
        }
        kept.push(letter);
    }
    kept + "..."
}

/// The width available for a text on the page.
pub(super) const TEXT_WIDTH_MM: f64 = RIGHT_MM - 8.0;

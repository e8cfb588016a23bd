//! A panel's frame, grid and axes.

use super::{
    palette::{AXIS, GRID, SMALL_MM, TEXT_MM},
    sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm},
    ticks::Ticks,
};

/// A rectangle of the sheet, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Panel {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

const GRID_PEN: Pen = Pen { colour: GRID, width_mm: 0.12 };
const AXIS_PEN: Pen = Pen { colour: AXIS, width_mm: 0.2 };
/// Room for the numbers and the name of the axis below a panel.
pub(super) const BELOW_MM: f64 = 9.5;

impl Panel {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Grid and numbers at positions along the lower edge, with the axis name unless it is empty.
    pub(super) fn x_axis(&self, sheet: &mut Sheet, ticks: &[(f64, String)], name: &str, grid: bool) {
        for (x, text) in ticks {
            if grid {
                sheet.line(vec![(*x, self.top), (*x, self.bottom)], GRID_PEN);
            }
            sheet.line(vec![(*x, self.bottom), (*x, self.bottom + 1.0)], AXIS_PEN);
            let label = Label::new(text.as_str(), (*x, self.bottom + 1.5), SMALL_MM).hung(Anchor::Middle, Hang::Below);
            sheet.label(label);
        }
        let middle = 0.5 * (self.left + self.right);
        if name.is_empty() {
            return;
        }
        sheet.label(Label::new(name, (middle, self.bottom + 5.2), TEXT_MM).hung(Anchor::Middle, Hang::Below));
    }

    /// Grid and numbers at positions along the left edge, with the axis name unless it is empty.
    pub(super) fn y_axis(&self, sheet: &mut Sheet, ticks: &[(f64, String)], name: &str, grid: bool) {
        let mut widest: f64 = 0.0;
        for (y, text) in ticks {
            if grid {
                sheet.line(vec![(self.left, *y), (self.right, *y)], GRID_PEN);
            }
            sheet.line(vec![(self.left - 1.0, *y), (self.left, *y)], AXIS_PEN);
            sheet.label(Label::new(text.as_str(), (self.left - 1.5, *y), SMALL_MM).hung(Anchor::End, Hang::Through));
            widest = widest.max(text_width_mm(text, SMALL_MM));
        }
        if name.is_empty() {
            return;
        }
        let at = (self.left - 2.5 - widest - 0.5 * TEXT_MM, 0.5 * (self.top + self.bottom));
        sheet.label(Label::new(name, at, TEXT_MM).hung(Anchor::Middle, Hang::Through).turned());
    }

    /// The outline, drawn over marks that touch it.
    pub(super) fn outline(&self, sheet: &mut Sheet) {
        let corners = [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)];
        sheet.line(corners.into_iter().chain([corners[0]]).collect(), AXIS_PEN);
    }
}

/// Room that an axis with these numbers and its name needs at the left, mm.
pub(super) fn left_room_mm(ticks: &Ticks) -> f64 {
    text_width_mm(&ticks.longest(), SMALL_MM) + TEXT_MM + 4.5
}

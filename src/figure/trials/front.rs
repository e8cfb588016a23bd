//! The front of hops against estimated success, or against the total of an amount.

use super::{
    super::{
        keys::Swatch,
        palette::{BLACK, BLUE, ORANGE, SMALL_MM, VERMILION},
        sheet::{Anchor, Hang, Label, Pen, Place, Sheet, text_width_mm},
        ticks::short,
    },
    boxes::nothing,
    data::{FrontAgainst, FrontFigure, FrontPoint, FrontValue},
    diagram::{Axis, Plot, number},
};

/// Height of the panel.
const HIGH_MM: f64 = 68.0;
/// Room beside the first and the last path.
const BESIDE_MM: f64 = 8.0;
/// The smallest range of success on the axis, percent.
const LEAST: f64 = 5.0;
/// The smallest range of totals on the axis, as a share of the greatest.
const LEAST_SHARE: f64 = 0.02;
/// Half the width of the ends of an interval.
const END_MM: f64 = 1.0;
const INTERVAL_PEN: Pen = Pen { colour: BLACK, width_mm: 0.25 };
const FRONT_PEN: Pen = Pen { colour: BLUE, width_mm: 0.25 };
const WANTED_PEN: Pen = Pen { colour: VERMILION, width_mm: 0.35 };

/// A path as it is drawn: its hops, its value with the interval of an estimate in the unit of the axis, and whether it is planned.
#[derive(Clone, Copy)]
struct Drawn {
    hops: u64,
    value: f64,
    interval: Option<(f64, f64)>,
    planned: bool,
}

impl Drawn {
    /// `None` of a path whose numbers are not finite.
    fn of(point: &FrontPoint) -> Option<Self> {
        let (value, interval) = match point.value {
            FrontValue::Success(success) => (100.0 * success.rate, Some((100.0 * success.low, 100.0 * success.high))),
            FrontValue::Total(total) => (total, None),
        };
        let finite = value.is_finite() && interval.is_none_or(|(low, high)| low.is_finite() && high.is_finite());
        finite.then_some(Self { hops: point.hops, value, interval, planned: point.planned })
    }
}

/// Draws the panel below a height; returns where it ends, and the legend.
pub(super) fn draw(sheet: &mut Sheet, figure: &FrontFigure, top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let points: Vec<Drawn> = figure.points.iter().filter_map(Drawn::of).collect();
    let (wanted, name) = match figure.against {
        FrontAgainst::Success { least } => (least.map(|success| 100.0 * success), "estimated success (%)".to_owned()),
        FrontAgainst::Total { words, unit, most } => (most, format!("{words} ({unit})")),
    };
    let plot = Plot::new(range(&points, wanted, figure.against), top_mm, HIGH_MM);
    let (first, last) = (points.first().map_or(0, |point| point.hops), points.last().map_or(1, |point| point.hops));
    let along = Axis::new((number(first), number(last)), plot.panel.left + BESIDE_MM, plot.panel.right - BESIDE_MM);
    let ticks: Vec<_> = whole_ticks(first, last).map(|hops| (along.place(number(hops)), hops.to_string())).collect();
    plot.axes(sheet, (&ticks, "hops"), &name, true);
    let place = |point: &Drawn| -> Place { (along.place(number(point.hops)), plot.up.place(point.value)) };
    if let Some(wanted) = wanted {
        let y = plot.up.place(wanted);
        sheet.dashed(&[(plot.panel.left, y), (plot.panel.right, y)], 2.2, 1.0, WANTED_PEN);
    }
    if points.len() > 1 {
        sheet.dashed(&points.iter().map(place).collect::<Vec<_>>(), 1.6, 0.8, FRONT_PEN);
    }
    for point in &points {
        let (x, y) = place(point);
        if let Some((low, high)) = point.interval {
            let (low, high) = (plot.up.place(low), plot.up.place(high));
            for end in [low, high] {
                sheet.line(vec![(x - END_MM, end), (x + END_MM, end)], INTERVAL_PEN);
            }
            sheet.line(vec![(x, low), (x, high)], INTERVAL_PEN);
        }
        if point.planned {
            planned_symbol(sheet, (x, y));
        } else {
            path_symbol(sheet, (x, y));
        }
        let text = match figure.against {
            FrontAgainst::Success { .. } => format!("{:.1} %", point.value),
            FrontAgainst::Total { .. } => short(point.value),
        };
        let beyond = x + 3.0 + text_width_mm(&text, SMALL_MM) > plot.panel.right;
        let (side_mm, anchor) = if beyond { (-2.4, Anchor::End) } else { (2.4, Anchor::Start) };
        // Beside the line to the next path, which rises with success and falls with a total.
        let (along_mm, hang) = match figure.against {
            FrontAgainst::Success { .. } => (1.2, Hang::Below),
            FrontAgainst::Total { .. } => (-0.4, Hang::Above),
        };
        // On the other side of the line where another number is there, as beside the last path.
        let other = match hang {
            Hang::Below => (-1.2, Hang::Above),
            Hang::Through | Hang::Above => (1.2, Hang::Below),
        };
        let places = [(along_mm, hang), other];
        let label = |(along_mm, hang)| Label::new(text.as_str(), (x + side_mm, y + along_mm), SMALL_MM).hung(anchor, hang);
        if let Some(label) = places.into_iter().map(label).find(|label| !sheet.is_taken(label)) {
            sheet.label(label);
        }
    }
    if points.is_empty() {
        nothing(sheet, &plot.panel, "no path");
    }
    plot.panel.outline(sheet);
    (plot.end_mm(), entries(&points, figure.against))
}

/// Whole numbers of hops for the axis, at most about a dozen.
fn whole_ticks(first: u64, last: u64) -> impl Iterator<Item = u64> {
    const MOST: u64 = 12;
    let step = last.saturating_sub(first).div_ceil(MOST).max(1);
    (first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX))
}

/// The range of the values, percent of a success.
fn range(points: &[Drawn], wanted: Option<f64>, against: FrontAgainst) -> (f64, f64) {
    let ends = points.iter().flat_map(|point| point.interval.map_or([point.value; 2], |(low, high)| [low, high])).chain(wanted);
    let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| (low.min(end), high.max(end)));
    if low > high {
        return (0.0, 100.0);
    }
    match against {
        FrontAgainst::Success { .. } => {
            let beside = (0.06 * (high - low)).max(0.5 * (LEAST - (high - low)));
            ((low - beside).max(0.0), (high + beside).min(100.0 + 0.5 * beside))
        }
        FrontAgainst::Total { .. } => {
            // Totals that hardly differ are not drawn as far apart.
            let beside = (0.06 * (high - low)).max(0.5 * (LEAST_SHARE * high - (high - low)));
            ((low - beside).max(0.0), high + beside)
        }
    }
}

fn path_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 0.9, BLUE);
}

/// The path of the plan: a ring about its dot, so that it is not told by its colour alone.
fn planned_symbol(sheet: &mut Sheet, at: Place) {
    sheet.dot(at, 1.1, ORANGE);
    sheet.ring(at, 1.9, Pen { colour: BLACK, width_mm: 0.35 });
}

/// The legend.
fn entries(points: &[Drawn], against: FrontAgainst) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    if points.iter().any(|point| point.planned) {
        found.push((Swatch::Symbol(planned_symbol), "path of the plan".to_owned()));
    }
    if points.iter().any(|point| !point.planned) {
        let of_front = match against {
            FrontAgainst::Success { .. } => "most reliable path of so many hops".to_owned(),
            FrontAgainst::Total { words, .. } => format!("path of so many hops with the least {words}"),
        };
        found.push((Swatch::Symbol(path_symbol), of_front));
    }
    if points.iter().any(|point| point.interval.is_some()) {
        found.push((Swatch::Line(INTERVAL_PEN), "95 % interval of the estimate".to_owned()));
    }
    let wanted = match against {
        FrontAgainst::Success { least } => {
            least.map(|success| format!("least success wanted: {}", crate::quantity::format_number(success)))
        }
        FrontAgainst::Total { unit, most, .. } => {
            most.map(|most| format!("budget: {} {unit}", crate::quantity::format_number(most)))
        }
    };
    found.extend(wanted.map(|text| (Swatch::Dashed(WANTED_PEN, 2.2, 1.0), text)));
    found
}

//! The success rate over the number of trials, with its 95 % band.

use super::{
    super::{
        keys::{Swatch, rectangle},
        palette::{BLACK, SMALL_MM},
        sheet::{Pen, Place, Sheet, text_width_mm},
        terrain_panel::thinned,
        ticks::short,
    },
    boxes::nothing,
    data::{ConvergencePoint, OutcomeBars},
    diagram::{Axis, Plot, Style, counted, named, number},
};

/// Height of the panel.
const HIGH_MM: f64 = 42.0;
/// Above this ratio of the most to the fewest trials the axis is logarithmic.
const FAR: f64 = 20.0;
/// The smallest range of rates on the axis, percent.
const LEAST: f64 = 2.0;
/// Margin at both ends of the axis of trials.
const BESIDE_MM: f64 = 3.0;
/// Line widths of the rate and of the ends of its band.
const RATE_MM: f64 = 0.5;
const BAND_MM: f64 = 0.15;

/// Draws the panel below a height; returns where it ends, and the legend.
pub(super) fn draw(sheet: &mut Sheet, bars: &[OutcomeBars], top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let series: Vec<Vec<ConvergencePoint>> = bars.iter().map(|bars| sorted(&bars.convergence)).collect();
    let plot = Plot::new(rates(series.iter().flatten()), top_mm, HIGH_MM);
    let along = Trials::new(series.iter().flatten(), plot.panel.left + BESIDE_MM, plot.panel.right - BESIDE_MM);
    plot.axes(sheet, (&along.ticks(), along.name()), "success rate (%)", true);
    // Every rate lies over every band.
    let mut lines = Vec::new();
    for (s, points) in series.iter().enumerate() {
        let style = Style::of(s);
        let at = |rate: fn(&ConvergencePoint) -> f64| -> Vec<Place> {
            thinned(&points.iter().map(|point| (along.place(point.trials), plot.up.place(100.0 * rate(point)))).collect::<Vec<_>>())
        };
        let (low, rate, high) = (at(|p| p.success.low), at(|p| p.success.rate), at(|p| p.success.high));
        if let ([(x, y)], [bottom], [top]) = (rate.as_slice(), low.as_slice(), high.as_slice()) {
            // The interval of a single point is drawn as a bar.
            let shift_mm = 2.0 * number(s as u64);
            sheet.area(rectangle((x + shift_mm - 0.7, top.1), (x + shift_mm + 0.7, bottom.1)), style.colour, 0.5);
            sheet.dot((x + shift_mm, *y), 0.6, BLACK);
            continue;
        }
        sheet.area(high.iter().chain(low.iter().rev()).copied().collect(), style.colour, 0.3);
        for end in [low, high] {
            style.line(sheet, end, Pen { colour: style.colour, width_mm: BAND_MM });
        }
        lines.push((style, rate));
    }
    for (style, rate) in lines {
        style.line(sheet, rate, Pen { colour: BLACK, width_mm: RATE_MM });
    }
    if series.iter().all(Vec::is_empty) {
        nothing(sheet, &plot.panel, "no trials");
    }
    plot.panel.outline(sheet);
    (plot.end_mm(), entries(bars, &series))
}

/// The points that can be drawn, by number of trials.
fn sorted(points: &[ConvergencePoint]) -> Vec<ConvergencePoint> {
    let is_drawable =
        |p: &&ConvergencePoint| p.trials > 0 && [p.success.rate, p.success.low, p.success.high].iter().all(|r| r.is_finite());
    let mut kept: Vec<_> = points.iter().filter(is_drawable).copied().collect();
    kept.sort_by_key(|point| point.trials);
    kept
}

/// The range of rates, percent.
fn rates<'a>(points: impl Iterator<Item = &'a ConvergencePoint>) -> (f64, f64) {
    let ends = points.fold(None, |ends: Option<(f64, f64)>, p| {
        let (low, high) = ends.unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
        Some((low.min(100.0 * p.success.low), high.max(100.0 * p.success.high)))
    });
    let Some((low, high)) = ends else { return (0.0, 100.0) };
    let beside = (0.08 * (high - low)).max(0.5 * (LEAST - (high - low)));
    ((low - beside).max(0.0), (high + beside).min(100.0))
}

/// The axis of the number of trials.
struct Trials {
    least: u64,
    most: u64,
    axis: Axis,
    is_logarithmic: bool,
    span_mm: f64,
}

impl Trials {
    fn new<'a>(points: impl Iterator<Item = &'a ConvergencePoint>, from_mm: f64, to_mm: f64) -> Self {
        let (least, most) = points.fold((u64::MAX, 1), |(least, most), p| (least.min(p.trials), most.max(p.trials)));
        let ends = (least.min(most), most);
        let (least, most) = (number(ends.0), number(ends.1));
        let is_logarithmic = most > FAR * least;
        let range = if is_logarithmic { (libm::log10(least), libm::log10(most)) } else { (least, most) };
        Self { least: ends.0, most: ends.1, axis: Axis::new(range, from_mm, to_mm), is_logarithmic, span_mm: to_mm - from_mm }
    }

    fn place(&self, trials: u64) -> f64 {
        let trials = number(trials);
        self.axis.place(if self.is_logarithmic { libm::log10(trials) } else { trials })
    }

    const fn name(&self) -> &'static str {
        if self.is_logarithmic { "trials (logarithmic)" } else { "trials" }
    }

    /// Whole numbers of trials: 1, 2, 5, 10, ... on a logarithmic axis.
    fn ticks(&self) -> Vec<(f64, String)> {
        if self.least == self.most {
            return vec![(self.place(self.most), short(number(self.most)))];
        }
        if !self.is_logarithmic {
            let widest_mm = text_width_mm(&short(self.axis.to), SMALL_MM) + 5.0;
            let is_whole = |(_, text): &(f64, String)| !text.contains('.') || text.contains('e');
            return self.axis.ticks(self.span_mm / widest_mm.max(14.0)).into_iter().filter(is_whole).collect();
        }
        let mut found: Vec<(f64, String)> = Vec::new();
        let steps = if self.axis.to - self.axis.from > 5.0 { &[1.0][..] } else { &[1.0, 2.0, 5.0] };
        let mut power = self.axis.from.floor();
        while power <= self.axis.to {
            for step in steps {
                let exponent = power + libm::log10(*step);
                if exponent >= self.axis.from - 1e-9 && exponent <= self.axis.to + 1e-9 {
                    let (x, text) = (self.axis.place(exponent), short((step * libm::pow(10.0, power)).round()));
                    let room_mm = text_width_mm(&text, SMALL_MM) + 1.5;
                    if found.last().is_none_or(|(before, _)| x - before > room_mm) {
                        found.push((x, text));
                    }
                }
            }
            power += 1.0;
        }
        found
    }
}

/// The legend: each policy with its final rate.
fn entries(bars: &[OutcomeBars], series: &[Vec<ConvergencePoint>]) -> Vec<(Swatch, String)> {
    let mut found = Vec::new();
    for (s, (bars, points)) in bars.iter().zip(series).enumerate() {
        let Some(last) = points.last() else { continue };
        let style = Style::of(s);
        let pen = Pen { colour: BLACK, width_mm: RATE_MM };
        let line = style.dashes().map_or(Swatch::Line(pen), |(dash_mm, gap_mm)| Swatch::Dashed(pen, dash_mm, gap_mm));
        found.push((
            line,
            format!("{} after {}: {}", named(&bars.policy, s), counted(last.trials, "trial"), super::percent(&last.success)),
        ));
        found.push((Swatch::Fill(style.colour), "its 95 % band".to_owned()));
    }
    found
}

//! The outcomes of trials: a bar for each outcome and policy, and the success rate with its interval.

use super::{
    super::{
        axes::{BELOW_MM, Panel},
        keys::{Swatch, rectangle},
        palette::{BLACK, RIGHT_MM, SMALL_MM},
        picture::paragraph,
        sheet::{Anchor, Hang, Label, Pen, Sheet, text_width_mm},
    },
    boxes::nothing,
    data::OutcomeBars,
    diagram::{Axis, OUTLINE_PEN, Style, counted, named, number},
};

/// Thickness of a bar.
const BAR_MM: f64 = 3.0;
/// Spacing of the bars of one outcome.
const NEXT_MM: f64 = 3.6;
/// Space between outcomes.
const BETWEEN_MM: f64 = 2.0;

/// Draws the panel below a height; returns where it ends, and the legend.
pub(super) fn draw(sheet: &mut Sheet, bars: &[OutcomeBars], top_mm: f64) -> (f64, Vec<(Swatch, String)>) {
    let (seen, unseen) = outcomes(bars);
    let names_mm = seen.iter().map(|name| text_width_mm(&words(name), SMALL_MM)).fold(text_width_mm(SUCCESS, SMALL_MM), f64::max);
    let texts: Vec<Vec<String>> = seen.iter().map(|name| bars.iter().map(|bars| count_text(bars, name)).collect()).collect();
    let success: Vec<String> = bars.iter().map(|bars| super::percent(&bars.success)).collect();
    let numbers_mm = texts.iter().flatten().chain(&success).map(|text| text_width_mm(text, SMALL_MM)).fold(0.0, f64::max);
    let group_mm = number(bars.len().max(1) as u64) * NEXT_MM + BETWEEN_MM;
    let panel = Panel {
        left: (7.5 + names_mm).min(90.0),
        top: top_mm,
        right: RIGHT_MM - numbers_mm - 2.5,
        bottom: top_mm + group_mm * number(seen.len() as u64 + 1) + 0.5,
    };
    let axis = Axis::new((0.0, 100.0), panel.left, panel.right);
    panel.x_axis(sheet, &axis.ticks(panel.width() / 12.0), "share of trials (%)", true);
    let group = |g: usize| panel.top + 0.5 * BETWEEN_MM + number(g as u64) * group_mm;
    for (g, name) in std::iter::once(SUCCESS).chain(seen.iter().copied()).enumerate() {
        let middle = group(g) + 0.5 * (group_mm - BETWEEN_MM);
        let text = if g == 0 { SUCCESS.to_owned() } else { words(name) };
        sheet.label(Label::new(text, (panel.left - 1.8, middle), SMALL_MM).hung(Anchor::End, Hang::Through));
        for (b, bars) in bars.iter().enumerate() {
            let y = group(g) + (number(b as u64) + 0.5) * NEXT_MM;
            let text = if g == 0 {
                interval(sheet, &axis, bars, Style::of(b), y);
                &success[b]
            } else {
                bar(sheet, &axis, share(bars, name), Style::of(b), y);
                &texts[g - 1][b]
            };
            sheet.label(Label::new(text.as_str(), (RIGHT_MM, y), SMALL_MM).hung(Anchor::End, Hang::Through));
        }
    }
    if bars.is_empty() {
        nothing(sheet, &panel, "no trials");
    }
    panel.outline(sheet);
    let mut end_mm = panel.bottom + BELOW_MM;
    if !unseen.is_empty() {
        let unseen: Vec<_> = unseen.into_iter().map(words).collect();
        end_mm = paragraph(sheet, &format!("Did not occur: {}.", unseen.join(", ")), SMALL_MM, false, end_mm - 0.5) + 1.0;
    }
    (end_mm, entries(bars))
}

/// The name of the first row.
const SUCCESS: &str = "success rate, 95 % interval";

/// An outcome's name as words.
fn words(name: &str) -> String {
    name.replace('_', " ").replace("takeoff", "take-off")
}

/// The names of outcomes in order of first appearance, those that occurred and the others.
fn outcomes(bars: &[OutcomeBars]) -> (Vec<&str>, Vec<&str>) {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in bars.iter().flat_map(|bars| &bars.counts) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names.into_iter().partition(|name| bars.iter().any(|bars| count(bars, name) > 0))
}

fn count(bars: &OutcomeBars, outcome: &str) -> u64 {
    bars.counts.iter().find(|(name, _)| name == outcome).map_or(0, |&(_, count)| count)
}

fn total(bars: &OutcomeBars) -> u64 {
    bars.counts.iter().map(|(_, count)| count).fold(0, |sum, count| sum.saturating_add(*count))
}

/// 0 to 1.
fn share(bars: &OutcomeBars, outcome: &str) -> f64 {
    number(count(bars, outcome)) / number(total(bars).max(1))
}

/// Count and share; a share that rounds to 0 or 100 % without being it is written as less or more.
fn count_text(bars: &OutcomeBars, outcome: &str) -> String {
    let (count, total) = (count(bars, outcome), total(bars));
    let percent = 100.0 * share(bars, outcome);
    let percent = if count > 0 && percent < 0.05 {
        "< 0.1".to_owned()
    } else if count < total && percent >= 99.95 {
        "> 99.9".to_owned()
    } else {
        format!("{percent:.1}")
    };
    format!("{count} ({percent} %)")
}

/// One bar.
fn bar(sheet: &mut Sheet, axis: &Axis, share: f64, style: Style, y: f64) {
    if share > 0.0 {
        let (from, to) = ((axis.place(0.0), y - 0.5 * BAR_MM), (axis.place(100.0 * share), y + 0.5 * BAR_MM));
        style.fill(sheet, from, to);
        sheet.line(rectangle(from, to).into_iter().chain([from]).collect(), OUTLINE_PEN);
    }
}

/// The success rate as a dot on its interval.
fn interval(sheet: &mut Sheet, axis: &Axis, bars: &OutcomeBars, style: Style, y: f64) {
    let success = bars.success;
    if ![success.rate, success.low, success.high].iter().all(|rate| rate.is_finite()) {
        return;
    }
    let x = |rate: f64| axis.place(100.0 * rate);
    let (low, high) = (x(success.low), x(success.high));
    sheet.area(rectangle((low, y - 0.9), (high, y + 0.9)), style.colour, 0.6);
    let pen = Pen { colour: BLACK, width_mm: 0.25 };
    sheet.line(vec![(low, y - 1.1), (low, y + 1.1), (low, y), (high, y), (high, y - 1.1), (high, y + 1.1)], pen);
    sheet.dot((x(success.rate), y), 0.7, BLACK);
}

/// The legend: each policy with its number of trials.
fn entries(bars: &[OutcomeBars]) -> Vec<(Swatch, String)> {
    let of = |(b, bars): (usize, &OutcomeBars)| {
        (Style::of(b).swatch(), format!("{}: {}", named(&bars.policy, b), counted(total(bars), "trial")))
    };
    bars.iter().enumerate().map(of).collect()
}

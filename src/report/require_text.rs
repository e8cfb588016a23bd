//! The text of a requirement.

use super::{
    ObjectiveRecord, RequireAnswer, RequireBudgetsRecord, RequireSuccessRecord, SuccessTry,
    text::{Sheet, gap_lines, place, plural},
};
use crate::{
    quantity::{format_number, unit_of},
    uncertainty::ESTIMATE_TRIALS,
};

/// The text of `chta require`.
pub fn require_text(answer: &RequireAnswer) -> String {
    let mut sheet = Sheet::default();
    let RequireAnswer { vary, .. } = answer;
    let unit = unit_of(vary);
    let with_unit = |value: f64| format!("{} {unit}", format_number(value)).trim_end().to_owned();
    let (from, to) = (format_number(answer.from), with_unit(answer.to));
    sheet.line(format_args!("{vary}: from x = {} m to x = {} m", place(answer.start_x_m), place(answer.goal_x_m)));
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    if let Some(route) = &answer.route {
        sheet.line(format_args!("{}", route.sentence()));
    }
    if let Some(success) = &answer.success {
        success_lines(&mut sheet, success, answer, &with_unit);
        return sheet.into_text();
    }
    if let Some(within) = &answer.within_budgets {
        budgets_lines(&mut sheet, within, answer, &with_unit);
        return sheet.into_text();
    }
    if answer.route.is_some() {
        free_route_lines(&mut sheet, answer, &with_unit);
        return sheet.into_text();
    }
    match answer.reachable_at {
        Some(value) if answer.never_binds => {
            let hops = answer.hops.unwrap_or(0);
            sheet.line(format_args!(
                "does not bind at any value: reachable in {hops} hop{}, each too short for its taper to reach {}, so that a greater value \
                 changes nothing",
                plural(hops),
                with_unit(value)
            ));
        }
        Some(value) => {
            let hops = answer.hops.unwrap_or(0);
            sheet.line(format_args!("reachable at {}, in {hops} hop{}", with_unit(value), plural(hops)));
        }
        None => sheet.line(format_args!("no path found at any value from {from} to {to}")),
    }
    match answer.unreachable_at {
        Some(value) if answer.derating.is_some() => {
            sheet.line(format_args!("proved unreachable at {}, for the derated limits", with_unit(value)));
        }
        Some(value) => sheet.line(format_args!("proved unreachable at {}", with_unit(value))),
        None if answer.never_binds => {}
        None => sheet.line(format_args!("proved unreachable at no value from {from} to {to}")),
    }
    if !answer.resolution_met {
        let between = match (answer.unreachable_at, answer.reachable_at) {
            (Some(a), Some(b)) => format!("the values between {} and {} stayed open", format_number(a.min(b)), with_unit(a.max(b))),
            (Some(value), None) | (None, Some(value)) => format!("the values on one side of {} stayed open", with_unit(value)),
            (None, None) => "all values stayed open".to_owned(),
        };
        sheet.line(format_args!(
            "the resolution of {} is not met: {between} with this budget of cells; a larger one may tell more",
            format_number(answer.resolution)
        ));
    }
    if let Some(gap) = &answer.gap {
        gap_lines(&mut sheet, gap);
    }
    sheet.line(format_args!("{} values tried, from {from} to {to}", answer.tries.len()));
    sheet.into_text()
}

/// The least value whose free routes reach the goal, and the hops that it takes.
fn free_route_lines(sheet: &mut Sheet, answer: &RequireAnswer, with_unit: &dyn Fn(f64) -> String) {
    let (from, to) = (format_number(answer.from), with_unit(answer.to));
    match answer.reachable_at {
        Some(value) => {
            let hops = answer.hops.unwrap_or(0);
            sheet.line(format_args!(
                "reached at {}, in at most {hops} hop{}: without a budget of hops the least value counts, however many hops it takes",
                with_unit(value),
                plural(hops)
            ));
        }
        None => sheet.line(format_args!("not reached over these nodes at any value from {from} to {to}")),
    }
    if let Some(value) = answer.not_reached_at {
        sheet.line(format_args!(
            "not reached over these nodes at {}: more nodes may find a path, and nothing is proved",
            with_unit(value)
        ));
    }
    sheet.line(format_args!("{} values tried, from {from} to {to}", answer.tries.len()));
}

/// The least value with a path within the budgets, and what was tried where that does not hold from there on.
fn budgets_lines(sheet: &mut Sheet, within: &RequireBudgetsRecord, answer: &RequireAnswer, with_unit: &dyn Fn(f64) -> String) {
    let (from, to) = (format_number(answer.from), with_unit(answer.to));
    match answer.reachable_at {
        Some(value) => {
            let hops = answer.hops.unwrap_or(0);
            sheet.line(format_args!("a path within the budgets at {}, in {hops} hop{}", with_unit(value), plural(hops)));
        }
        None => sheet.line(format_args!("a path within the budgets at no value tried from {from} to {to}")),
    }
    for sentence in within.at.iter().flat_map(ObjectiveRecord::sentences) {
        sheet.line(format_args!("{sentence}"));
    }
    if !answer.resolution_met {
        sheet.line(format_args!("the resolution of {} is not met", format_number(answer.resolution)));
    }
    if !within.within_from_there_on || answer.reachable_at.is_none() {
        if !within.within_from_there_on {
            sheet.line(format_args!(
                "not every more capable value has a path within the budgets: its best path may take more, and the commands of its hops are others"
            ));
        }
        sheet.line(format_args!("values tried, from the least capable to the most capable:"));
        for tried in &within.tries {
            let hops = tried.hops.map_or_else(|| "no path".to_owned(), |hops| format!("{hops} hop{}", plural(hops)));
            let said =
                if tried.exceeds.is_empty() { String::new() } else { format!(", too much for {}", tried.exceeds.join(", ")) };
            sheet.line(format_args!("  {}: {hops}{said}", with_unit(tried.value)));
        }
    }
    sheet.line(format_args!(
        "{} values tried, from {from} to {to}: nothing is proved, and between them it may be otherwise",
        within.tries.len()
    ));
}

/// The least value with enough success, how sure it is, and what was tried where success does not grow with the key.
fn success_lines(sheet: &mut Sheet, success: &RequireSuccessRecord, answer: &RequireAnswer, with_unit: &dyn Fn(f64) -> String) {
    let least = format_number(success.success_min);
    let (from, to) = (format_number(answer.from), with_unit(answer.to));
    let best = success.tries.iter().max_by(|a, b| a.success_estimated.total_cmp(&b.success_estimated));
    match (success.at, best) {
        (Some(SuccessTry { value, hops, success_estimated, success_estimated_ci95: [low, high] }), _) => {
            let hops = hops.unwrap_or(0);
            sheet.line(format_args!(
                "estimated success of at least {least} at {}, in {hops} hop{}: {success_estimated:.4} (95 % interval {low:.4} to {high:.4} of \
                 {ESTIMATE_TRIALS} fixed trials, with the same draws at every value)",
                with_unit(value),
                plural(hops)
            ));
            let end = |value: Option<f64>| value.map_or_else(|| "the end of the range".to_owned(), with_unit);
            if success.uncertain_from != success.uncertain_to {
                let [from, to] = [success.uncertain_from, success.uncertain_to].map(end);
                sheet.line(format_args!("the 95 % interval of the estimate contains {least} between {from} and {to}"));
            }
        }
        (None, Some(best)) => sheet.line(format_args!(
            "estimated success of at least {least} at no value tried from {from} to {to}; the best is {:.4} at {}",
            best.success_estimated,
            with_unit(best.value)
        )),
        (None, None) => {}
    }
    if success.monotone {
        sheet.line(format_args!("success grows with the key over the values tried; it need not between them"));
    } else {
        let beyond = if success.enough_from_there_on { "" } else { ", and more capable values are not always enough" };
        sheet.line(format_args!(
            "success does not always grow with the key{beyond}:\n{:>14}{:>8}{:>12}",
            "value", "hops", "success"
        ));
        for tried in &success.tries {
            let hops = tried.hops.map_or_else(|| "-".to_owned(), |hops| hops.to_string());
            sheet.line(format_args!("{:>14}{hops:>8}{:>12.4}", format_number(tried.value), tried.success_estimated));
        }
    }
    sheet.line(format_args!("{} values tried, from {from} to {to}", success.tries.len()));
}

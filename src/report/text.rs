//! The answers as text for a terminal.

use std::fmt::Write;

use super::{
    BestRecord, BindingRecord, CheckAnswer, GapRecord, HopAnswer, HopRecord, MapRecord, ObjectiveRecord, ProofRecord,
    RequireAnswer, RequireBudgetsRecord, RequireSuccessRecord, SuccessTry, TotalsRecord, WindowRecord,
    limit_counts::LimitCounts,
    propellant_record::{delta_v_field, stores_lines},
};
use crate::{
    quantity::{format_number, unit_of},
    uncertainty::ESTIMATE_TRIALS,
    world::Limit,
};

/// A sheet of text; writing to it does not fail.
#[derive(Default)]
pub(super) struct Sheet(String);

impl Sheet {
    pub(super) fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = self.0.write_fmt(line);
        self.0.push('\n');
    }

    /// The whole text.
    pub(super) fn into_text(self) -> String {
        self.0
    }
}

/// An x along the chain to the millimetre, without trailing zeros.
pub(super) fn place(x_m: f64) -> String {
    let text = format!("{x_m:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The text of `chta hop`.
pub fn hop_text(answer: &HopAnswer) -> String {
    let mut sheet = Sheet::default();
    sheet.line(format_args!(
        "{} from x = {} m to x = {} m: {:.3} m of line of sight at {:.3} deg",
        answer.direction,
        place(answer.from_x_m),
        place(answer.to_x_m),
        answer.line_of_sight_m,
        answer.line_of_sight_angle_deg
    ));
    if let (Some(takeoff), Some(landing), Some(heading_deg)) = (answer.takeoff_m, answer.landing_m, answer.heading_deg) {
        let point = |[x_m, y_m, z_m]: [f64; 3]| format!("({}, {}, {}) m", place(x_m), place(y_m), place(z_m));
        sheet.line(format_args!("on the map from {} to {}, heading {heading_deg:.3} deg", point(takeoff), point(landing)));
    }
    match (answer.takeoff_angle_min_deg, answer.takeoff_angle_max_deg) {
        (Some(min), Some(max)) if answer.windows.len() <= 1 => {
            sheet.line(format_args!("feasible: take-off angles {min:.6} to {max:.6} deg"));
        }
        (Some(_), Some(_)) => sheet.line(format_args!("feasible: take-off angles in {} windows", answer.windows.len())),
        _ => sheet.line(format_args!("not feasible in one hop")),
    }
    if answer.windows.len() > 1 {
        for window in &answer.windows {
            sheet.line(format_args!("  {}", window_line(window)));
        }
    } else {
        sheet.line(format_args!("{}", binding_line(&answer.binding)));
    }
    let lines = answer.limits.iter().map(|limit| {
        let vertex = limit.vertex.map(|v| format!("  vertex {} at x = {} m", v.number, place(v.x_m)));
        let clearance = limit.clearance_x_m.map(|x_m| format!("  clearance at x = {} m", place(x_m)));
        let vertex = vertex.or(clearance).unwrap_or_default();
        let refusal = limit.refusal.as_ref().map(|r| format!("  {r}")).unwrap_or_default();
        LimitLine {
            name: limit.name,
            ends_deg: [limit.min_deg, limit.max_deg],
            refused_deg: limit.refused_deg,
            remark: vertex + &refusal,
        }
    });
    limit_table(&mut sheet, &lines.collect::<Vec<_>>());
    choice_lines(&mut sheet, answer.best, &answer.choices);
    if let Some(margins) = answer.margins {
        sheet.line(format_args!("\nmargins of the chosen hop"));
        for line in margins.lines() {
            sheet.line(format_args!("{line}"));
        }
    }
    if answer.greatest_reach.is_some() {
        sheet.line(format_args!("\ngreatest reach of one hop along this line of sight"));
    }
    for (by, reach) in [("speeds alone", answer.greatest_reach), ("speeds and cones", answer.greatest_reach_within_cones)] {
        let Some(reach) = reach else { continue };
        sheet.line(format_args!(
            "by {by:<18}{:>12.3} m ({:.3} m horizontally) at {:.3} deg, {} ends it: {:.3} m by take-off speed, {}",
            reach.reach_line_of_sight_m,
            reach.reach_horizontal_m,
            reach.takeoff_angle_deg,
            reach.limit,
            reach.by_takeoff_speed_m,
            reach.by_landing_speed_m.map_or_else(
                || "no limit by landing speed, since it brakes".to_owned(),
                |reach_m| format!("{reach_m:.3} m by landing speed")
            )
        ));
    }
    if let Some(along) = answer.segment_hops {
        sheet.line(format_args!(
            "\nalong this segment: {} hop{}; one hop carries {:.3} m along the slope ({:.3} m horizontally), taking off {:.3} deg over \
             the slope ({:.3} deg over the horizontal); {} ends it",
            along.hops,
            if along.hops == 1 { "" } else { "s" },
            along.reach_line_of_sight_m,
            along.reach_horizontal_m,
            along.takeoff_over_slope_deg,
            along.takeoff_angle_deg,
            along.limit
        ));
    }
    sheet.0
}

/// A line of the table of limits.
pub(super) struct LimitLine {
    pub(super) name: Limit,
    /// The least and the greatest take-off angle; `None` if every arc is refused.
    pub(super) ends_deg: [Option<f64>; 2],
    /// Between these two, the angles that are refused.
    pub(super) refused_deg: Option<[f64; 2]>,
    /// What is said behind the angles.
    pub(super) remark: String,
}

/// The take-off angles that each limit allows; returns the width of the column of names.
pub(super) fn limit_table(sheet: &mut Sheet, lines: &[LimitLine]) -> usize {
    // The longest name of a limit on the machine's speeds is longer than the column of the others.
    let wide = lines.iter().map(|line| line.name.name().len() + 1).fold(18, usize::max);
    sheet.line(format_args!("\n{:<wide$}{:>14}{:>14}", "limit", "min (deg)", "max (deg)"));
    for LimitLine { name, ends_deg, refused_deg, remark } in lines {
        let ends = match ends_deg {
            [Some(min), Some(max)] => format!("{min:>14.6}{max:>14.6}"),
            _ => format!("{:>14}{:>14}", "-", "-"),
        };
        let gap = refused_deg.map(|[from, to]| format!("  but not between {from:.6} and {to:.6} deg")).unwrap_or_default();
        sheet.line(format_args!("{name:<wide$}{ends}{gap}{remark}"));
    }
    wide
}

/// The hops of all choices, with the chosen one marked.
pub(super) fn choice_lines(sheet: &mut Sheet, best: Option<BestRecord>, choices: &[BestRecord]) {
    let Some(best) = best else { return };
    sheet.line(format_args!(
        "\n{:<18}{:>10}{:>10}{:>11}{:>10}{:>10}{:>13}",
        "to fly", "up (deg)", "m/s", "down (deg)", "m/s", "s", "highest (m)"
    ));
    for choice in choices {
        let chosen = if choice.choice == best.choice { "  <- chosen" } else { "" };
        sheet.line(format_args!(
            "{:<18}{:>10.4}{:>10.4}{:>11.4}{:>10.4}{:>10.3}{:>13.3}{chosen}",
            choice.choice,
            choice.takeoff_angle_deg,
            choice.takeoff_speed_m_s,
            choice.landing_angle_deg,
            choice.landing_speed_m_s,
            choice.flight_time_s,
            choice.apex_height_m
        ));
    }
}

/// One of several windows in one line.
fn window_line(window: &WindowRecord) -> String {
    let WindowRecord { takeoff_angle_min_deg: min, takeoff_angle_max_deg: max, lower, upper } = window;
    if min == max {
        return format!("{min:.6} deg by {}", lower.limit);
    }
    let at = lower.vertex.map(|v| format!(" (vertex {} at x = {} m)", v.number, place(v.x_m))).unwrap_or_default();
    format!("{min:.6} to {max:.6} deg, from {}{at} to {}", lower.limit, upper.limit)
}

/// The limits that set the ends, or that conflict, in one line.
fn binding_line(binding: &BindingRecord) -> String {
    match binding {
        BindingRecord::Ends { lower, upper, vertex, clearance_x_m } => {
            let clearance = clearance_x_m.map(|x_m| format!(" (the clearance at x = {} m)", place(x_m)));
            let at = vertex.map(|v| format!(" (vertex {} at x = {} m)", v.number, place(v.x_m))).or(clearance).unwrap_or_default();
            format!("the least angle is set by {lower}{at}, the greatest by {upper}")
        }
        BindingRecord::Conflict { sentence, .. } => format!("why: {sentence}"),
    }
}

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
        return sheet.0;
    }
    if let Some(within) = &answer.within_budgets {
        budgets_lines(&mut sheet, within, answer, &with_unit);
        return sheet.0;
    }
    if answer.route.is_some() {
        free_route_lines(&mut sheet, answer, &with_unit);
        return sheet.0;
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
    sheet.0
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
            let to = success.uncertain_to.map_or_else(|| "the end of the range".to_owned(), with_unit);
            let from = success.uncertain_from.map_or_else(|| "the end of the range".to_owned(), with_unit);
            sheet.line(format_args!("the 95 % interval of the estimate contains {least} between {from} and {to}"));
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

/// How far one gets, and which limits refuse to go on.
fn gap_lines(sheet: &mut Sheet, gap: &GapRecord) {
    sheet.line(format_args!(
        "no path comes nearer to the goal than x = {} m; no place nearer to the start than x = {} m leads to it",
        place(gap.reached_x_m),
        place(gap.leads_to_goal_from_x_m)
    ));
    if !gap.refusals.is_empty() {
        sheet.line(format_args!("what refuses all hops on from there, by pairs of cells: {}", ranked(&gap.refusals)));
    }
}

/// What a proof under derating is worth.
const FOR_DERATED_LIMITS: &str =
    "the proof is for the derated limits: under the whole limits there may be paths of fewer hops, or a path";

/// The result of a proof, in a few lines.
fn proof_lines(sheet: &mut Sheet, proof: &ProofRecord, means: FurtherMeans<'_>) {
    match (proof.lower_bound, proof.upper_bound) {
        (None, _) => sheet.line(format_args!("proved: no path exists, at any resolution")),
        (Some(lower), Some(_)) if proof.proved => {
            sheet.line(format_args!("proved: no path has fewer than {lower} hop{}, at any resolution", plural(lower)));
        }
        (Some(lower), upper) => sheet.line(format_args!(
            "open: no path has fewer than {lower} hop{}, {}; a larger {} may tell more",
            plural(lower),
            upper.map_or_else(|| "and none was found".to_owned(), |upper| format!("the best one found has {upper}")),
            means.budget
        )),
    }
    if proof.proof.footprint_at_vertices_alone {
        sheet.line(format_args!("the proof uses the footprint at vertices alone: it holds, and may be weaker than it could be"));
    }
    let summary = proof.proof;
    sheet.line(format_args!(
        "proof: {} cells, {} split, {} rounds, {} pairs of cells tested",
        summary.cells, summary.splits, summary.rounds, summary.pairs_tested
    ));
    if let Some(gap) = &proof.gap {
        gap_lines(sheet, gap);
    }
}

/// The ending of a counted noun.
const fn plural(count: u64) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// The names of the means to get a stronger answer, in the reader's interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FurtherMeans<'a> {
    /// The budget of cells of a proof.
    pub budget: &'a str,
    /// The search for a proof that there is no path.
    pub proof: &'a str,
    /// The search for the least value of a key, which follows it.
    pub requirement: &'a str,
}

impl Default for FurtherMeans<'_> {
    /// The library's names.
    fn default() -> Self {
        Self { budget: "budget of cells", proof: "a proof by bounds", requirement: "a search for the least value of" }
    }
}

/// The text of `chta check` for one pair.
pub fn check_text(answer: &CheckAnswer, means: FurtherMeans<'_>) -> String {
    let mut sheet = Sheet::default();
    let hops = answer.hops.map_or(String::new(), |hops| format!(", {hops} hop{}", if hops == 1 { "" } else { "s" }));
    sheet.line(format_args!(
        "{}{hops}: from x = {} m to x = {} m",
        answer.verdict,
        place(answer.start_x_m),
        place(answer.goal_x_m)
    ));
    if let Some(lower) = answer.hops_lower_bound {
        sheet.line(format_args!("{}", hops_bound(answer.hops, lower)));
    }
    if let Some(shortage) = &answer.propellant_shortage {
        sheet.line(format_args!("not with its propellant: {}", shortage.sentence()));
    }
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    if let Some(budget) = &answer.success_budget {
        sheet.line(format_args!("{}", budget.sentence()));
    }
    for sentence in answer.objective.iter().flat_map(ObjectiveRecord::sentences) {
        sheet.line(format_args!("{sentence}"));
    }
    if let Some(refusal) = &answer.commands_refusal {
        sheet.line(format_args!("not with commands in steps: {refusal}"));
    }
    if let Some(miss_m) = answer.landing_miss_max_m {
        sheet.line(format_args!("commands in steps: every landing is within {miss_m:.3} m of its aim"));
    }
    if let Some(effort) = answer.effort {
        sheet.line(format_args!("{}: {:.4} {}", effort.name.total(), effort.value, effort.unit));
    }
    if let (Some(lower), true) =
        (answer.proof.as_ref().and_then(|proof| proof.lower_bound), answer.hops.is_some() && !answer.is_traversable())
    {
        sheet.line(format_args!("no path has fewer than {lower} hop{}, whatever it takes from the machine", plural(lower)));
    } else if let Some(proof) = &answer.proof {
        proof_lines(&mut sheet, proof, means);
        if answer.derating.is_some() {
            sheet.line(format_args!("{FOR_DERATED_LIMITS}"));
        }
        if answer.beside_line {
            sheet.line(format_args!("the proof is about hops on the line, and this path flies beside it"));
        }
    }
    match &answer.route {
        Some(route) => {
            sheet.line(format_args!("{}", route.nodes(answer.nodes, answer.pairs_tested)));
            if answer.hops.is_none() {
                route.nearest(means).iter().for_each(|sentence| sheet.line(format_args!("{sentence}")));
            }
        }
        None => sheet.line(format_args!(
            "{} nodes (up to {} inside a segment) on a chain of {} vertices, pairs of them tested: {}",
            answer.nodes, answer.points_per_segment, answer.vertices, answer.pairs_tested
        )),
    }
    if !answer.refusals.is_empty() {
        sheet.line(format_args!("refused by {}", ranked(&answer.refusals)));
    }
    for end in &answer.endpoint_refusals {
        let nearest = end
            .nearest_usable_x_m
            .map_or("no point of the chain would do".to_owned(), |x| format!("the nearest usable point is x = {} m", place(x)));
        sheet.line(format_args!(
            "the {} at x = {} m refuses ({}): {}; {nearest}",
            end.endpoint,
            place(end.x_m),
            end.limit,
            end.reason
        ));
    }
    if let Some(frontier) = &answer.frontier {
        sheet.line(format_args!(
            "from the start one gets to x = {} m ({} nodes); the goal can be reached from x = {} m ({} nodes)",
            place(frontier.reached_x_m),
            frontier.reached_nodes,
            place(frontier.leads_to_goal_from_x_m),
            frontier.leads_to_goal_nodes
        ));
        if !frontier.refusals.is_empty() {
            sheet.line(format_args!("what refuses the hops out of there: {}", ranked(&frontier.refusals)));
        }
        if let Some(miss) = &frontier.nearest_miss {
            sheet.line(format_args!(
                "nearest miss, x = {} to {} m: {}",
                place(miss.from_x_m),
                place(miss.to_x_m),
                binding_line(&miss.binding)
            ));
        }
        if answer.proof.is_none() {
            sheet.line(format_args!(
                "more points per segment may find a path: this is no proof that there is none; {} looks for one",
                means.proof
            ));
        }
    }
    sheet.0
}

/// What a count of hops over nodes is worth: it is at most that many, and no path takes fewer than the bound.
pub(super) fn hops_bound(hops: Option<u64>, lower: u64) -> String {
    match hops {
        Some(hops) => format!("at most {hops} hop{} over these nodes; no path takes fewer than {lower}", plural(hops)),
        None => format!("not reached over these nodes; no path takes fewer than {lower} hop{}", plural(lower)),
    }
}

/// Counts by name, in descending order.
fn ranked(counts: &LimitCounts) -> String {
    counts.ranked().iter().map(|(name, count)| format!("{name} {count}")).collect::<Vec<_>>().join(", ")
}

/// The two headings of a hop on a map of a known projection.
fn headings(map: MapRecord) -> Option<String> {
    let from_true_north = map.heading_true_deg?.map_or("-".to_owned(), |heading| format!("{heading:.3}"));
    Some(format!("{:>11.3}{from_true_north:>11}", map.heading_deg))
}

/// The hops of a path as a table, with their totals; on a map of a known projection with headings from grid north and true north.
pub fn path_text(rows: &[HopRecord], totals: &TotalsRecord) -> String {
    let mut sheet = Sheet::default();
    // Headings from both norths where they differ: on a map of a known projection.
    let has_north = rows.iter().any(|row| row.map.is_some_and(|map| map.heading_true_deg.is_some()));
    let columns = if has_north { format!("{:>11}{:>11}", "grid (deg)", "true (deg)") } else { String::new() };
    sheet.line(format_args!(
        "{:>4} {:<8}{:>12}{:>12}{:>10}{:>10}{:>10}{:>10}{:>9}{columns}{}  {}",
        "hop",
        "",
        "from x (m)",
        "to x (m)",
        "up (deg)",
        "m/s",
        "down(deg)",
        "m/s",
        "s",
        delta_v_field(None, totals),
        "binding (lower/upper)"
    ));
    for row in rows {
        sheet.line(format_args!(
            "{:>4} {:<8}{:>12.3}{:>12.3}{:>10.3}{:>10.4}{:>10.3}{:>10.4}{:>9.3}{}{}  {}",
            row.hop,
            row.direction,
            row.takeoff_x_m,
            row.landing_x_m,
            row.takeoff_angle_deg,
            row.takeoff_speed_m_s,
            row.landing_angle_deg,
            row.landing_speed_m_s,
            row.flight_time_s,
            row.map.and_then(headings).unwrap_or_default(),
            delta_v_field(Some(row), totals),
            row.binding
        ));
    }
    if let Some(aim) = rows.last().and_then(|row| row.aim) {
        /// Less than half of the last digit shown.
        const UNSEEN_M: f64 = 5e-4;
        let side = if aim.landing_miss_m < 0.0 { "short of" } else { "beyond" };
        match aim.beside.map(|beside| beside.landing_miss_across_m) {
            Some(across_m) => {
                let across = if across_m < 0.0 { "right" } else { "left" };
                sheet.line(format_args!(
                    "the last landing lies {:.3} m {side} the goal along the line and {:.3} m to its {across}",
                    aim.landing_miss_m.abs(),
                    across_m.abs()
                ));
                sheet.line(format_args!(
                    "the hops fly beside the line, in the headings that the machine has: take-off and landing above are projections on it"
                ));
            }
            None if aim.landing_miss_m.abs() >= UNSEEN_M => {
                sheet.line(format_args!("the last landing lies {:.3} m {side} the goal", aim.landing_miss_m.abs()));
            }
            None => {}
        }
    }
    sheet.line(format_args!(
        "in all: {:.3} m over ground, {:.3} s in flight, {:.4} J/kg, {:.4} m/s at most",
        totals.ground_distance_m, totals.flight_time_s, totals.energy_j_kg, totals.peak_takeoff_speed_m_s
    ));
    if let Some(energy_j) = totals.energy_j {
        sheet.line(format_args!("energy {energy_j:.4} J"));
    }
    if let Some(bounce_time_s) = totals.bounce_time_s {
        sheet.line(format_args!("bounces {bounce_time_s:.3} s after the landings"));
    }
    if let Some(mission_time_s) = totals.mission_time_s {
        sheet.line(format_args!("mission time {mission_time_s:.3} s"));
    }
    for line in stores_lines(totals) {
        sheet.line(format_args!("{line}"));
    }
    sheet.0
}

//! The answers as text for a terminal.

use std::fmt::Write;

use super::{
    AmountRecord, BestRecord, BindingRecord, CheckAnswer, GapRecord, HopAnswer, HopRecord, MapRecord, ObjectiveRecord,
    OutageRecord, ProofRecord, TotalsRecord, WindowRecord,
    limit_counts::LimitCounts,
    propellant_record::{delta_v_field, stores_lines},
};
use crate::world::Limit;

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
            "{:<18}{:>10.4} {:>9.4} {:>10.4} {:>9.4} {:>9.3} {:>12.3}{chosen}",
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

/// How far one gets, and which limits refuse to go on.
pub(super) fn gap_lines(sheet: &mut Sheet, gap: &GapRecord) {
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
pub(super) const fn plural(count: u64) -> &'static str {
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
    let of_objective = answer.objective.iter().flat_map(ObjectiveRecord::sentences);
    for sentence in of_objective
        .chain(answer.outages.iter().map(OutageRecord::sentence))
        .chain(AmountRecord::layers_sentence(&answer.layer_costs))
    {
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
    frontier_lines(&mut sheet, answer, means);
    sheet.0
}

/// The lines of the frontier, where the search stopped.
fn frontier_lines(sheet: &mut Sheet, answer: &CheckAnswer, means: FurtherMeans<'_>) {
    let Some(frontier) = &answer.frontier else { return };
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
            "more points per segment may find a path, and not finding one over these nodes proves nothing; {} looks for a proof",
            means.proof
        ));
    }
}

/// What a count of hops over nodes is worth: it is at most that many, and no path takes fewer than the bound.
pub(super) fn hops_bound(hops: Option<u64>, lower: u64) -> String {
    match hops {
        Some(hops) => format!("at most {hops} hop{} over these nodes; no path takes fewer than {lower}", plural(hops)),
        None => format!("not reached over these nodes; no path takes fewer than {lower} hop{}", plural(lower)),
    }
}

/// Counts by name, in descending order.
pub(super) fn ranked(counts: &LimitCounts) -> String {
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
            "{:>4} {:<8}{:>12.3} {:>11.3} {:>9.3} {:>9.4} {:>9.3} {:>9.4} {:>8.3}{}{}  {}",
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

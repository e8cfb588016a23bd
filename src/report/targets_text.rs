//! The answers about several targets, as text.

use super::{
    AmountRecord, FurtherMeans, LeftOutRecord, OverBudgetRecord, TargetsAnswer, TargetsSimulateAnswer, TripRecord, VisitRecord,
    WhyRecord,
    mesh_plan_answer::point,
    objective_record::with_unit,
    simulate_answer::{records_text, requirement_text},
    text::{Sheet, hops_bound},
};
use crate::{planner::VisitOrder, quantity::format_number};

/// The text of `chta plan` for a scenario with `[mission]`.
pub fn targets_text(answer: &TargetsAnswer, means: FurtherMeans<'_>) -> String {
    let mut sheet = Sheet::default();
    let count = answer.targets.len();
    let home = if answer.return_to_start { " and back to the start" } else { "" };
    let bound = answer.hops_lower_bound.filter(|_| answer.targets_visited == count);
    let hops = answer.hops.map_or(String::new(), |hops| match bound {
        Some(lower) => format!(", {}", hops_bound(Some(hops), lower)),
        None => format!(", {hops} hops"),
    });
    sheet.line(format_args!("{}: {} of {count} targets visited{home}{hops}", answer.verdict, answer.targets_visited));
    sheet.line(format_args!(
        "{}, from {}",
        match answer.order {
            VisitOrder::Best => "in the best order by the objective",
            VisitOrder::Given => "in the order given",
        },
        point(answer.start_m)
    ));
    if let Some(shortage) = &answer.propellant_shortage {
        sheet.line(format_args!("not with its propellant: {}", shortage.sentence()));
    }
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    for sentence in answer.objective.sentences() {
        sheet.line(format_args!("{sentence}"));
    }
    for outage in &answer.outages {
        sheet.line(format_args!("{}", outage.sentence()));
    }
    if let Some(costs) = AmountRecord::layers_sentence(&answer.layer_costs) {
        sheet.line(format_args!("{costs}"));
    }
    let search = &answer.search;
    sheet.line(format_args!(
        "over {} nodes at most {} m apart; {} legs between stops, pairs of nodes tested: {}",
        search.nodes,
        format_number(search.node_spacing_m),
        search.legs,
        search.pairs_tested
    ));
    sheet.line(format_args!(
        "{}",
        if answer.best_over_nodes {
            "no mission over these nodes and commands visits more targets, or as many with less; other nodes may give a better one"
        } else {
            "the search left out labels: this mission is not proved to be the best over these nodes"
        }
    ));
    for target in &answer.targets {
        if let Some(why) = &target.left_out {
            left_out_lines(&mut sheet, target.target, why, means);
        }
    }
    if !answer.visits.is_empty() {
        visits_table(&mut sheet, answer);
        sheet.line(format_args!("verified: the whole path was flown again by the independent checker and breaks no limit"));
    }
    sheet.into_text()
}

fn left_out_lines(sheet: &mut Sheet, target: usize, why: &LeftOutRecord, means: FurtherMeans<'_>) {
    let said = match why.why {
        WhyRecord::NotReached => "it is not reached over these nodes".to_owned(),
        WhyRecord::NoWayBack => "from it the start is not reached over these nodes".to_owned(),
        WhyRecord::NotTogether => {
            "it is reached, but no order of legs over these nodes visits it together with those that are visited".to_owned()
        }
        WhyRecord::Outages => {
            "every mission over these nodes that visits it beside those visited is outside the condition of a layer for too long"
                .to_owned()
        }
        WhyRecord::Budgets => {
            let over = |row: &OverBudgetRecord| {
                let [total, max] = [row.total, row.max].map(|value| with_unit(row.amount, value));
                format!("{} {total}, at most {max}", row.amount.words())
            };
            let over = why.over.iter().map(over).collect::<Vec<_>>().join("; ");
            format!("with it the best mission over those visited is beyond the budgets: {over}")
        }
    };
    sheet.line(format_args!("target {target} is left out: {said}"));
    if let Some(gap) = &why.gap {
        if let Some(nearest_m) = why.nearest_m {
            sheet.line(format_args!("  the reached place nearest to it is {}", point(nearest_m)));
        }
        for sentence in gap.sentences(means) {
            sheet.line(format_args!("  {sentence}"));
        }
    }
}

/// A stop in words.
fn stop(target: Option<usize>) -> String {
    target.map_or_else(|| "start".to_owned(), |target| format!("target {target}"))
}

fn visits_table(sheet: &mut Sheet, answer: &TargetsAnswer) {
    sheet.line(format_args!(
        "\n{:>5}  {:<22}{:>13}{:>6}{:>7}{:>13}{:>15}{:>15}{:>18}",
        "visit", "leg", "straight (m)", "hops", "least", "distance (m)", "energy (J/kg)", "delta-v (m/s)", "mission time (s)"
    ));
    for visit in &answer.visits {
        let VisitRecord { straight_line_m, leg, hops_lower_bound, .. } = visit;
        let name = format!("{} to {}", stop(visit.from_target), stop(visit.target));
        let least = hops_lower_bound.map_or_else(|| "-".to_owned(), |least| least.to_string());
        sheet.line(format_args!(
            "{:>5}  {name:<22}{straight_line_m:>13.3}{:>6}{least:>7}{:>13.3}{:>15.4}{:>15.4}{:>18.3}",
            visit.visit, leg.hops, leg.distance_m, leg.energy_j_kg, leg.delta_v_m_s, leg.mission_time_s
        ));
    }
    if let Some(VisitRecord { arrival, .. }) = answer.visits.last() {
        let TripRecord { hops, distance_m, energy_j_kg, delta_v_m_s, mission_time_s, .. } = arrival;
        let straight_m: f64 = answer.visits.iter().map(|visit| visit.straight_line_m).sum();
        sheet.line(format_args!(
            "{:>5}  {:<22}{straight_m:>13.3}{hops:>6}{:>7}{distance_m:>13.3}{energy_j_kg:>15.4}{delta_v_m_s:>15.4}{mission_time_s:>18.3}",
            "all", "", ""
        ));
    }
}

/// The text of `chta simulate` for a scenario with `[mission]`.
pub fn targets_simulate_text(answer: &TargetsSimulateAnswer, means: FurtherMeans<'_>) -> String {
    let mut text = targets_text(&answer.plan, means);
    let mut sheet = Sheet::default();
    if !answer.visited.is_empty() {
        sheet.line(format_args!("\n{:>5}  {:<12}{:>10}{:>12}  95 % interval", "visit", "stop", "trials", "reached (%)"));
    }
    for (number, row) in (1..).zip(&answer.visited) {
        let [low, high] = row.reached_share_ci95.map(|share| 100.0 * share);
        sheet.line(format_args!(
            "{number:>5}  {:<12}{:>10}{:>12.2}  {low:.2} to {high:.2}",
            stop(row.target),
            row.trials,
            100.0 * row.reached_share
        ));
    }
    text.push_str(&sheet.into_text());
    text.push_str(&records_text(answer.simulation.as_ref(), &answer.compare));
    text.push_str(&requirement_text(answer.requirement, answer.simulation.as_ref()));
    text
}

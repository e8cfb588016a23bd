//! The answer of a plan that may drive, as text.

use super::{
    DriveLegRecord, DriveMarginsRecord, HopLegRecord, TravelAlternativeRecord, TravelAnswer, TravelLegRecord, TravelSumsRecord,
    TravelTotalsRecord, mesh_plan_answer::point, text::Sheet, travel_answer::neighbours_in_words,
};
use crate::{planner::Amount, quantity::format_number};

/// The text of `chta plan` for a scenario with `[drive]`.
pub fn travel_text(answer: &TravelAnswer) -> String {
    let mut sheet = Sheet::default();
    let moves = answer.totals.map_or(String::new(), |totals| format!(", {}", moves(&totals)));
    sheet.line(format_args!("{}{moves}: from {} to {}", answer.verdict, point(answer.start_m), point(answer.goal_m)));
    sheet.line(format_args!("it may {}; the straight line is {:.3} m long", means(answer), answer.straight_line_m));
    if let Some(shortage) = &answer.propellant_shortage {
        sheet.line(format_args!("not with its propellant: {}", shortage.sentence()));
    }
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    for sentence in answer.objective.sentences() {
        sheet.line(format_args!("{sentence}"));
    }
    let search = &answer.search;
    sheet.line(format_args!(
        "over {} nodes {} m apart, {} reached; {} hops and {} drive legs tested: other nodes may give a better path",
        search.nodes,
        format_number(search.node_spacing_m),
        search.reached_nodes,
        search.hops_tested,
        search.drives_tested
    ));
    if answer.travel.drives() {
        sheet.line(format_args!("{}", neighbours_in_words(search.neighbours, search.elongation_max)));
    }
    stopped_lines(&mut sheet, answer);
    if !answer.path.is_empty() {
        legs_table(&mut sheet, &answer.path);
    }
    if let Some(totals) = &answer.totals {
        totals_lines(&mut sheet, totals);
        sheet.line(format_args!("verified: every leg was driven or flown again by the independent checker and breaks no limit"));
    }
    if let Some(alternatives) = &answer.alternatives {
        alternatives_table(&mut sheet, alternatives);
    }
    if let Some(front) = &answer.front {
        sheet.line(format_args!("\nhops against {} over these nodes", front.amount.words()));
        sums_header(&mut sheet, "path");
        for (number, row) in front.paths.iter().enumerate() {
            sums_line(&mut sheet, &(number + 1).to_string(), row);
        }
        if front.labels_capped {
            sheet.line(format_args!("the search left out labels because there were too many: better paths may be missing"));
        }
    }
    sheet.into_text()
}

/// The table of legs and the lines of their sums alone.
pub(super) fn legs_and_totals(legs: &[TravelLegRecord], totals: Option<&TravelTotalsRecord>) -> String {
    let mut sheet = Sheet::default();
    if !legs.is_empty() {
        legs_table(&mut sheet, legs);
    }
    if let Some(totals) = totals {
        totals_lines(&mut sheet, totals);
    }
    sheet.into_text()
}

/// By what it travels, in words.
fn means(answer: &TravelAnswer) -> &'static str {
    match (answer.travel.drives(), answer.travel.hops()) {
        (true, true) => "drive and hop",
        (true, false) => "only drive",
        _ => "only hop",
    }
}

fn plural(count: u64, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

fn moves(totals: &TravelTotalsRecord) -> String {
    format!("{} and {}", plural(totals.drive_legs, "drive leg"), plural(totals.hops, "hop"))
}

fn stopped_lines(sheet: &mut Sheet, answer: &TravelAnswer) {
    let Some(stopped) = &answer.stopped else { return };
    sheet.line(format_args!(
        "the reached node nearest to the goal is {}; other nodes may give a path: this does not prove that no path exists",
        point(stopped.nearest_m)
    ));
    if !stopped.drive_refusals.is_empty() {
        let rows = stopped.drive_refusals.iter().map(|row| format!("{} {}", row.limit, row.legs)).collect::<Vec<_>>();
        sheet.line(format_args!("drive legs out of the reached nodes are refused by {}", rows.join(", ")));
    }
}

fn legs_table(sheet: &mut Sheet, legs: &[TravelLegRecord]) {
    sheet.line(format_args!(
        "\n{:>4} {:<6}{:>12}{:>12}{:>12}{:>14}  from, to; closest limit",
        "leg", "kind", "length (m)", "climb (m)", "time (s)", "energy (J/kg)"
    ));
    for leg in legs {
        match leg {
            TravelLegRecord::Drive(leg) => drive_line(sheet, leg),
            TravelLegRecord::Hop(leg) => hop_line(sheet, leg),
        }
    }
}

fn drive_line(sheet: &mut Sheet, leg: &DriveLegRecord) {
    sheet.line(format_args!(
        "{:>4} {:<6}{:>12.3}{:>12.3}{:>12.3}{:>14.4}  {} to {}, steepest {:.2} deg; {}",
        leg.leg,
        "drive",
        leg.length_m,
        leg.climb_m - leg.descent_m,
        leg.time_s,
        leg.energy_j_kg,
        point(leg.takeoff_m),
        point(leg.landing_m),
        leg.steepest_deg,
        closest(&leg.margins)
    ));
}

fn hop_line(sheet: &mut Sheet, leg: &HopLegRecord) {
    let hop = &leg.hop;
    sheet.line(format_args!(
        "{:>4} {:<6}{:>12.3}{:>12.3}{:>12.3}{:>14.4}  {} to {}, {:.3} m/s at {:.3} deg; {}",
        leg.leg,
        "hop",
        hop.landing_x_m - hop.takeoff_x_m,
        leg.landing_m[2] - leg.takeoff_m[2],
        leg.time_s,
        leg.energy_j_kg,
        point(leg.takeoff_m),
        point(leg.landing_m),
        hop.takeoff_speed_m_s,
        hop.takeoff_angle_deg,
        hop.binding
    ));
}

/// The limit of a drive leg that leaves least, of slopes in degrees.
fn closest(margins: &DriveMarginsRecord) -> String {
    let slopes = [("up", margins.slope_up_deg), ("down", margins.slope_down_deg), ("across", margins.cross_slope_deg)];
    let slopes = slopes.into_iter().filter_map(|(name, margin)| Some((name, margin?)));
    slopes
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or_else(|| "no limit of slope".to_owned(), |(name, margin)| format!("slope {name} leaves {margin:.2} deg"))
}

fn totals_lines(sheet: &mut Sheet, totals: &TravelTotalsRecord) {
    let energy = totals.energy_j.map_or(String::new(), |energy_j| format!(" ({energy_j:.3} J)"));
    sheet.line(format_args!(
        "\ntotals: {}, mission time {:.3} s (driving {:.3} s, in flight {:.3} s), energy {:.4} J/kg{energy}",
        moves(totals),
        totals.mission_time_s,
        totals.drive_time_s,
        totals.flight_time_s,
        totals.energy_j_kg
    ));
    sheet.line(format_args!(
        "driven {:.3} m with {:.3} m of climb and {:.3} m of descent; {:.3} m over the map in all",
        totals.drive_length_m, totals.climb_m, totals.descent_m, totals.distance_m
    ));
    if let Some(success) = totals.drive_success {
        sheet.line(format_args!("probability that no failure ends the driving: {success:.6}, hops apart"));
    }
}

fn sums_header(sheet: &mut Sheet, first: &str) {
    sheet.line(format_args!("{first:<24}{:>6}{:>18}{:>16}{:>14}", "hops", "mission time (s)", "energy (J/kg)", "distance (m)"));
}

fn sums_line(sheet: &mut Sheet, name: &str, sums: &TravelSumsRecord) {
    sheet.line(format_args!(
        "{name:<24}{:>6}{:>18.3}{:>16.4}{:>14.3}",
        sums.hops, sums.mission_time_s, sums.energy_j_kg, sums.distance_m
    ));
}

fn alternatives_table(sheet: &mut Sheet, alternatives: &[TravelAlternativeRecord]) {
    sheet.line(format_args!("\nwhat hopping buys, over the same nodes"));
    sums_header(sheet, "travel, least of");
    for row in alternatives {
        let least = row.objective.first().map_or("", |amount: &Amount| amount.name());
        let name = format!("{}, {least}", row.travel);
        match &row.totals {
            Some(sums) => sums_line(sheet, &name, sums),
            None => sheet.line(format_args!("{name:<24}{:>6}  no path over these nodes", "-")),
        }
        if row.totals.is_some() && row.verdict != crate::graph::proof::ProofVerdict::Traversable {
            sheet.line(format_args!("{:<24}  not within the budgets", ""));
        }
    }
}

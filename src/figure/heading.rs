//! The sentences above and below the panels.

use super::{
    FigureInput, angle_panel,
    data::{FigureData, HopFigure, StoppedFigure, Subject, Thinned},
    limits::{obstacle, remedy},
    palette::{TEXT_MM, TITLE_MM},
    picture::paragraph,
    sheet::Sheet,
    ticks::short,
    touchdown,
};
use crate::{
    graph::{Answer, EndpointRefusal},
    path::Totals,
    world::{ClearanceRule, Contact, Hopper, Limit},
};

/// Title, question, limits and verdict; returns where they end.
pub(super) fn above(sheet: &mut Sheet, input: &FigureInput<'_>, data: &FigureData) -> f64 {
    let (test, title) = (input.test, &input.title);
    let words = conditions(&title.body, test.gravity_m_s2(), test.hopper(), test.chain().speed_bounds_m_s(), &title.ground);
    let mut y = 3.0;
    if !input.title.name.is_empty() {
        y = paragraph(sheet, &input.title.name, TITLE_MM, true, y);
    }
    y = paragraph(sheet, &words, TEXT_MM, false, y);
    let journey = format!("From x = {} m to x = {} m: ", place(data.start.x_m), place(data.goal.x_m));
    paragraph(sheet, &(journey + &verdict(input.answer, data)), TEXT_MM, true, y) + 1.5
}

/// The text below the panels; returns where it ends.
pub(super) fn below(sheet: &mut Sheet, data: &FigureData, top_mm: f64) -> f64 {
    let mut y = top_mm;
    for text in remarks(data) {
        y = paragraph(sheet, &text, TEXT_MM, false, y);
    }
    y
}

/// The assumptions of an analysis, as stated in its pictures: body, gravity, the hopper's limits and the ground's grip.
///
/// `speed_bounds_m_s` are the greatest speeds of take-off and landing that the ground itself allows. They are stated if the hopper
/// has no limit.
///
/// # Examples
/// ```
/// use chta::{figure::conditions, world::Hopper};
/// let words = conditions("Mars", 3.711, &Hopper::with_speeds(6.0, 6.0).unwrap(), (6.0, 6.0), "friction coefficient 0.6");
/// assert_eq!(words, "Mars, g = 3.711 m/s²; take-off speed ≤ 6 m/s; landing speed ≤ 6 m/s; clearance 0 m; friction coefficient 0.6");
/// ```
pub fn conditions(body: &str, gravity_m_s2: f64, hopper: &Hopper, speed_bounds_m_s: (f64, f64), ground: &str) -> String {
    const LANDING: &str = "landing speed";
    let mut parts = Vec::new();
    let gravity = format!("g = {} m/s²", short(gravity_m_s2));
    parts.push(if body.is_empty() { gravity } else { format!("{body}, {gravity}") });
    for (name, limit, bound) in [
        ("take-off speed", hopper.limits().takeoff_speed_max_m_s, speed_bounds_m_s.0),
        (LANDING, hopper.limits().landing_speed_max_m_s, speed_bounds_m_s.1),
    ] {
        // If the hopper has no limit of its own, the chain's explicit limits apply.
        let most = if limit.is_finite() { limit } else { bound };
        if let Some(touchdown_m_s) = hopper.limits().landing.touchdown_speed_m_s().filter(|_| name == LANDING) {
            parts.push(touchdown::conditions(touchdown_m_s, most));
            continue;
        }
        parts.push(format!("{name} ≤ {} m/s", short(most)));
    }
    parts.push(clearance(hopper));
    for (name, angle) in
        [("take-off angle ≥", hopper.limits().takeoff_angle_min), ("take-off angle ≤", hopper.limits().takeoff_angle_max)]
    {
        parts.extend(angle.map(|angle| format!("{name} {} deg", short(angle.degrees()))));
    }
    parts.extend(hopper.limits().apex_height_max_m.map(|height| format!("apex ≤ {} m", short(height))));
    parts.extend(hopper.limits().flight_time_max_s.map(|time| format!("flight ≤ {} s", short(time))));
    let steps = hopper.limits().steps;
    parts.extend(steps.takeoff_angle.map(|step| format!("take-off angle in steps of {} deg", short(step.degrees()))));
    parts.extend(steps.takeoff_speed_m_s.map(|step| format!("take-off speed in steps of {} m/s", short(step))));
    parts.extend(steps.heading.map(|step| format!("heading in steps of {} deg", short(step.degrees()))));
    parts.extend(
        hopper
            .limits()
            .footprint_m
            .filter(|footprint| *footprint > 0.0)
            .map(|footprint| format!("footprint {} m", short(footprint))),
    );
    parts.extend(hopper.limits().roughness_max_m.map(|roughness| format!("roughness ≤ {} m", short(roughness))));
    parts.extend(hopper.limits().takeoff_speed_min_m_s.map(|speed| format!("take-off speed ≥ {} m/s", short(speed))));
    parts.extend(hopper.limits().takeoff_speed_levels.map(|levels| {
        let all: Vec<_> = levels.as_slice().iter().map(|level| short(*level)).collect();
        format!("take-off speeds {} m/s", all.join(", "))
    }));
    if !ground.is_empty() {
        parts.push(ground.to_owned());
    }
    parts.join("; ")
}

/// The clearance and, if there is one, where it is kept.
fn clearance(hopper: &Hopper) -> String {
    let limits = hopper.limits();
    let height = format!("clearance {} m", short(limits.clearance_m));
    match limits.clearance_rule {
        _ if limits.clearance_m == 0.0 => height,
        ClearanceRule::Tapered(taper) => format!("{height}, tapered at both contacts ({} m/m)", short(taper)),
        ClearanceRule::Vertex => format!("{height} over vertices"),
    }
}

/// The answer in a few words.
fn verdict(answer: &Answer, data: &FigureData) -> String {
    match &data.subject {
        Subject::Path { hops, totals } if totals.propellant_short_kg().is_some() => {
            format!("a path of {} hops takes more propellant than the hopper has", hops.of)
        }
        Subject::Path { hops, .. } => match hops.of {
            0 => "no hop needed".to_owned(),
            1 => "1 hop, traversable".to_owned(),
            many => format!("{many} hops, traversable"),
        },
        Subject::Stopped(_) => {
            format!("no path found over {} nodes, at most {} inside a segment", answer.nodes, answer.points_per_segment)
        }
        Subject::NoCommands(hops, _) => {
            let plural = if *hops == 1 { "" } else { "s" };
            format!("no commands in steps found for the path of {hops} hop{plural}")
        }
        Subject::RouteNotFound => format!("not reached over {} nodes", answer.nodes),
        Subject::EndpointsRefuse(refusals) => {
            let refusing: Vec<_> = refusals.iter().map(|refusal| end_name(refusal.contact)).collect();
            let verb = if refusing.len() == 1 { "refuses" } else { "refuse" };
            format!("not traversable, {} {verb} whatever the hop", refusing.join(" and "))
        }
    }
}

const fn end_name(contact: Contact) -> &'static str {
    match contact {
        Contact::Takeoff => "start",
        Contact::Landing => "goal",
    }
}

/// Totals, or the obstacle of the journey.
fn remarks(data: &FigureData) -> Vec<String> {
    match &data.subject {
        Subject::Path { hops, totals } => {
            let mut all = vec![total(totals, data.prepares)];
            all.extend(beside_line(hops));
            if !hops.shown.is_empty() {
                all.extend(angle_panel::caption(hops));
            }
            all
        }
        Subject::Stopped(stop) => {
            let (gap_m, said) = gap_words(data, stop);
            let mut lines = vec![said];
            lines.extend(stops_words(stop, gap_m > 0.0));
            let miss = stop
                .nearest_miss
                .as_ref()
                .map(|(from, to, why)| format!("Nearest miss, from x = {} m to x = {} m: {why}.", place(from.x_m), place(to.x_m)));
            lines.extend(miss);
            lines.push("Denser nodes may still hold a path.".to_owned());
            lines
        }
        Subject::NoCommands(_, refusal) => {
            let refusal = refusal.as_ref().map(|refusal| format!("Refused: {refusal}."));
            refusal.into_iter().chain(std::iter::once("Smaller steps, or another path, may have commands.".to_owned())).collect()
        }
        Subject::RouteNotFound => {
            vec!["Profile: the straight line from start to goal. Denser nodes may still hold a route.".to_owned()]
        }
        Subject::EndpointsRefuse(refusals) => refusals.iter().map(endpoint).collect(),
    }
}

/// The gap that stops a journey: its length along the journey, m, and in a sentence.
fn gap_words(data: &FigureData, stop: &StoppedFigure) -> (f64, String) {
    let (reached, leads) = stop.gap;
    let gap_m = (leads.x_m - reached.x_m) * (data.goal.x_m - data.start.x_m).signum();
    let ends = format!(
        "The hopper gets from the start to x = {} m, and from x = {} m on to the goal",
        place(reached.x_m),
        place(leads.x_m)
    );
    let said = if gap_m > 0.0 {
        format!("{ends}: it does not cross the gap of {} m between them.", short(gap_m))
    } else {
        format!("{ends}, but no hop leads from the one to the other ground.")
    };
    (gap_m, said)
}

/// What stops the hopper there, and what would do, from the limits that refuse most.
fn stops_words(stop: &StoppedFigure, is_gap: bool) -> Vec<String> {
    /// The limits that are named; the panel has all of them.
    const MOST_NAMED: usize = 3;
    let all: u64 = stop.refusals.iter().map(|(_, count)| count).sum();
    let named = &stop.refusals[..stop.refusals.len().min(MOST_NAMED)];
    let Some((first, _)) = named.first() else { return Vec::new() };
    let of = |(at, (limit, count)): (usize, &(Limit, u64))| {
        let count = if at == 0 { format!("{count} of the {all} hops tried") } else { count.to_string() };
        format!("{} ({count})", obstacle(*limit))
    };
    let obstacles: Vec<_> = named.iter().enumerate().map(of).collect();
    let place = if is_gap { "What stops it at the gap" } else { "What stops it" };
    vec![
        format!("{place}: {}.", obstacles.join("; ")),
        format!("What would do, judged by the limit that refuses most: {}.", remedy(*first)),
    ]
}

/// Where hops fly beside the line of the picture: how they are drawn.
fn beside_line(hops: &Thinned<HopFigure>) -> Option<String> {
    let across_m = hops.shown.iter().filter_map(|hop| hop.hop.aim?.across_m).map(f64::abs).reduce(f64::max)?;
    Some(format!(
        "The hops fly in the headings that the machine has, up to {} m beside the line, and are drawn projected on its plane: each takes off \
         and lands on the ground under it, not on the ground drawn.",
        short(across_m)
    ))
}

/// The totals of the hops. `prepares`: whether the mission time has preparations in it.
fn total(totals: &Totals, prepares: bool) -> String {
    let mut parts = vec![
        format!("distance {} m", short(totals.ground_distance_m)),
        format!("flight time {} s", short(totals.flight_time_s)),
        format!("fastest take-off {} m/s", short(totals.peak_takeoff_speed_m_s)),
        format!("energy {} J/kg", short(totals.energy_j_kg)),
    ];
    parts.extend(totals.energy_j.map(|energy| format!("{} J in all", short(energy))));
    let waits = match (totals.bounce_time_s.is_some(), prepares) {
        (true, true) => "bounces, preparations and rests",
        (true, false) => "bounces and rests",
        (false, true) => "preparations and rests",
        (false, false) => "rests",
    };
    parts.extend(totals.mission_time_s.map(|time| format!("{} s with {waits}", short(time))));
    if totals.propulsive {
        parts.push(format!("delta-v {} m/s", short(totals.delta_v_m_s)));
    }
    parts.extend(totals.propellant.map(|p| format!("propellant {} kg, {} kg left", short(p.used_kg), short(p.mass_end_kg))));
    format!("Totals: {}.", parts.join(", "))
}

/// Why no hop can take off or land at start or goal, and the nearest usable point.
fn endpoint(refusal: &EndpointRefusal) -> String {
    let contact = match refusal.contact {
        Contact::Takeoff => "take-off",
        Contact::Landing => "landing",
    };
    let at = format!(
        "The {} at x = {} m refuses every {contact}: {}",
        end_name(refusal.contact),
        place(refusal.station.point.x_m),
        refusal.refusal
    );
    match refusal.nearest {
        Some(nearest) => format!("{at}; the nearest usable point is x = {} m.", place(nearest.point.x_m)),
        None => format!("{at}; no point of the chain is usable."),
    }
}

/// An x along the chain, with more digits than other quantities, so that the point can be found in the data.
fn place(x_m: f64) -> String {
    let rounded = format!("{x_m:.3}");
    if x_m != 0.0 && x_m.abs() < 1.0 { short(x_m) } else { rounded.trim_end_matches('0').trim_end_matches('.').to_owned() }
}

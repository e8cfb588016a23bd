//! The answer of a plan over a mesh, as plain data, and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    DeratingRecord, FrontRecord, FrontSearchRecord, HopRecord, MeshContactRecord, ObjectiveRecord, TotalsRecord, amount_front_text,
    limit_counts::LimitCounts,
    objective_record::AmountRecord,
    propellant_record::PropellantShortage,
    route_record::isolated_ends,
    text::{Sheet, hops_bound, path_text, place},
};
use crate::{
    graph::proof::ProofVerdict,
    planner::roadmap::{DrawnContacts, GrownRoadmap, JoinCounts, RoadmapEnd, RoadmapGap, RoadmapPlanner, RoadmapRound},
    planner::{Amount, Amounts, Objective},
    quantity::format_number,
};

/// The answer of `chta plan` over a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshPlanAnswer {
    /// Metres per unit of the mesh's file.
    pub mesh_scale: f64,
    /// Where the path begins, on the surface.
    pub start: MeshContactRecord,
    /// Where it ends, on the surface.
    pub goal: MeshContactRecord,
    /// `traversable` or `no-path-found`; more contacts may find a path where these have none.
    pub verdict: ProofVerdict,
    /// The hops of the best path over these contacts.
    pub hops: Option<u64>,
    /// The fewest hops of any path, over whatever contacts, by the greatest speeds alone; null if none hops.
    pub hops_lower_bound: Option<u64>,
    /// The straight line from start to goal: no path has shorter arcs.
    pub straight_line_m: f64,
    /// What the path was planned for, and what it takes of its budgets.
    #[serde(flatten)]
    pub objective: ObjectiveRecord,
    /// The shares of the limits that this answer and all margins are for; absent if they are for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
    /// If the path takes more propellant than the machine has; the verdict is then `no-path-found`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub propellant_shortage: Option<PropellantShortage>,
    /// How it was searched.
    pub roadmap: RoadmapRecord,
    /// Without a path: what lies between the contacts reached and those that lead to the goal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gap: Option<RoadmapGapRecord>,
    /// Whether the path was flown again and passed; null if it was not.
    pub verified: Option<bool>,
    /// The hops; empty without a path.
    pub path: Vec<HopRecord>,
    /// The sums over the path; null without one.
    pub totals: Option<TotalsRecord>,
    /// The front of hops against an amount over these contacts, in ascending order of hops; empty without a path, absent if not requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<Vec<FrontRecord>>,
    /// What the front was searched for.
    #[serde(flatten)]
    pub front_search: Option<FrontSearchRecord>,
}

/// The roadmap of a plan over a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoadmapRecord {
    /// `exact`: all pairs of contacts by exact windows; `prm`: that of Campana and Laumond, by sampled angles.
    pub planner: RoadmapPlanner,
    /// Contacts, start and goal included.
    pub contacts: usize,
    /// Of these, drawn by area.
    pub by_area: usize,
    /// Of these, the middles of facets; of `prm`, points of facets each of which has the same probability.
    pub on_facets: usize,
    /// Of these, drawn about the best path.
    pub about_path: usize,
    /// Points left out inside closed bodies, or for their stand-off.
    pub left_out_buried: usize,
    /// Points left out beyond `search.bounds_m`.
    pub left_out_outside: usize,
    /// Points left out since no better path leads through them, by lower bounds along straight lines.
    pub left_out_useless: usize,
    /// Facets that meet the bounds.
    pub facets: usize,
    /// Facets whose middle was a contact or was left out.
    pub facets_tried: usize,
    /// Windows of hops between two contacts; of `prm`, the arcs that were found free, of which those of a hop both ways are two.
    pub windows: usize,
    /// Ordered pairs of contacts tested.
    pub pairs_tested: u64,
    /// Of `prm`: the hops that it sampled; absent otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampled_hops: Option<SampledHopsRecord>,
    /// Why it stopped growing: `contacts`, `time`, `gain` (less than 1 % in two rounds), `exhausted` (no more contacts of use), `joined` (of
    /// `prm`: start and goal are joined), or `given` where it was read from a file and start and goal alone were added; how its other contacts
    /// were drawn is then not known, and counts 0.
    pub ended_by: RoadmapEnd,
    /// Its rounds.
    pub history: Vec<RoadmapRoundRecord>,
}

/// The hops that a search by sampled angles tested, each once where its beam is the same both ways.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SampledHopsRecord {
    /// Hops whose limits leave a beam of arcs.
    pub tried: u64,
    /// Of these, hops whose first arc met the mesh or rose over the bounds: the collisions of the paper's Table I.
    pub first_arcs_refused: u64,
    /// Of these, hops all of whose sampled arcs did.
    pub refused: u64,
    /// Of these, hops of which even the flattest arc rises over the bounds.
    pub too_high: u64,
    /// Hops that were not tried, since the plane of the hop cuts a friction cone narrowly.
    pub narrow: u64,
    /// Hops of a path that the sampled test let pass through the mesh, and that were taken out when the path was checked.
    pub grazes: u64,
}

impl From<&JoinCounts> for SampledHopsRecord {
    fn from(counts: &JoinCounts) -> Self {
        let JoinCounts { narrow, tried, first_arcs_refused, refused, too_high, grazes } = *counts;
        Self { tried, first_arcs_refused, refused, too_high, narrow, grazes }
    }
}

/// One round of a roadmap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoadmapRoundRecord {
    /// Contacts so far.
    pub contacts: usize,
    /// Windows so far.
    pub windows: usize,
    /// Hops of the best path so far; null before a path is found.
    pub hops: Option<u64>,
    /// Its totals in all amounts of the objective; empty before a path is found.
    pub totals: Vec<AmountRecord>,
}

/// What lies between the contacts that the start reaches and those from which the goal can be reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoadmapGapRecord {
    /// The reached contact nearest to the goal, [x, y, z], m.
    pub nearest_m: [f64; 3],
    /// Contacts reached from the start, itself included.
    pub reached_contacts: usize,
    /// The contact nearest to the start from which the goal can be reached, [x, y, z], m.
    pub leads_to_goal_from_m: [f64; 3],
    /// Contacts from which the goal can be reached, itself included.
    pub leads_to_goal_contacts: usize,
    /// The least straight distance from a reached contact to one that leads to the goal, m; null if none are as near as one hop by its speeds.
    pub width_m: Option<f64>,
    /// Pairs of a reached contact and one that leads to the goal, as near as one hop by its speeds.
    pub pairs: u64,
    /// How many of these pairs were judged, evenly of all.
    pub judged_pairs: u64,
    /// The number of judged pairs whose hop is refused by each limit.
    pub refusals: LimitCounts,
    /// The number of judged pairs over one another: a hop straight up has no plane.
    pub vertical: u64,
    /// The number of judged pairs whose hop has a window that a search by sampled angles missed; absent if none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missed_by_sampling: Option<u64>,
}

impl RoadmapRecord {
    /// From a roadmap, for an objective; of so many facets, so many had their turn.
    pub fn new<N: Clone + Send + Sync>(grown: &GrownRoadmap<N>, objective: &Objective, [facets, facets_tried]: [usize; 2]) -> Self {
        let DrawnContacts { by_area, on_facets, about_path, buried, outside, useless } = grown.drawn;
        Self {
            planner: RoadmapPlanner::Exact,
            contacts: grown.roadmap.contact_count(),
            by_area,
            on_facets,
            about_path,
            left_out_buried: buried,
            left_out_outside: outside,
            left_out_useless: useless,
            facets,
            facets_tried,
            windows: grown.roadmap.window_count(),
            pairs_tested: grown.roadmap.pairs_tested(),
            sampled_hops: None,
            ended_by: grown.end,
            history: grown.history.iter().map(|round| RoadmapRoundRecord::new(round, objective)).collect(),
        }
    }
}

impl RoadmapRoundRecord {
    fn new(round: &RoadmapRound, objective: &Objective) -> Self {
        let total = |totals: &Amounts, amount: Amount| AmountRecord { amount, total: totals.of(amount) };
        let totals = round.totals.iter().flat_map(|totals| objective.amounts().iter().map(|amount| total(totals, *amount)));
        Self {
            contacts: round.contacts,
            windows: round.windows,
            hops: round.totals.as_ref().map(hops_of),
            totals: totals.collect(),
        }
    }
}

/// The number of hops of totals.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of hops")]
pub(crate) fn hops_of(totals: &Amounts) -> u64 {
    totals.of(Amount::Hops) as u64
}

impl From<&RoadmapGap> for RoadmapGapRecord {
    fn from(gap: &RoadmapGap) -> Self {
        Self {
            nearest_m: gap.nearest_m.coords.into(),
            reached_contacts: gap.reached,
            leads_to_goal_from_m: gap.leads_from_m.coords.into(),
            leads_to_goal_contacts: gap.leading,
            width_m: gap.width_m,
            pairs: gap.pairs,
            judged_pairs: gap.judged,
            refusals: (&gap.refusals).into(),
            vertical: gap.vertical,
            missed_by_sampling: (gap.free > 0).then_some(gap.free),
        }
    }
}

impl MeshPlanAnswer {
    /// Whether there is a path that the machine can fly.
    pub fn is_traversable(&self) -> bool {
        self.verdict == ProofVerdict::Traversable
    }
}

/// A point in words.
pub(super) fn point([x_m, y_m, z_m]: [f64; 3]) -> String {
    format!("({}, {}, {}) m", place(x_m), place(y_m), place(z_m))
}

/// The text of `chta plan` over a mesh.
pub fn mesh_plan_text(answer: &MeshPlanAnswer) -> String {
    let mut sheet = Sheet::default();
    let hops = answer.hops.map_or(String::new(), |hops| format!(", {hops} hop{}", if hops == 1 { "" } else { "s" }));
    sheet.line(format_args!("{}{hops}: from {} to {}", answer.verdict, point(answer.start.point_m), point(answer.goal.point_m)));
    for (name, contact) in [("start", &answer.start), ("goal", &answer.goal)] {
        sheet.line(format_args!("{name} moved {:.6} m to the nearest point of the surface", contact.moved_m));
    }
    if let Some(lower) = answer.hops_lower_bound {
        sheet.line(format_args!("{}", hops_bound(answer.hops, lower).replace("these nodes", "these contacts")));
    }
    sheet.line(format_args!("no path has arcs shorter than the straight line, {:.3} m", answer.straight_line_m));
    if let Some(shortage) = &answer.propellant_shortage {
        sheet.line(format_args!("not with its propellant: {}", shortage.sentence()));
    }
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    for sentence in answer.objective.sentences() {
        sheet.line(format_args!("{sentence}"));
    }
    roadmap_lines(&mut sheet, &answer.roadmap);
    if let Some(gap) = &answer.gap {
        gap_lines(&mut sheet, gap);
    }
    let mut text = sheet.into_text();
    if let Some(totals) = &answer.totals {
        text.push('\n');
        text.push_str(&path_text(&answer.path, totals));
        text.push_str(&places_text(&answer.path));
        text.push_str(match answer.verified {
            Some(true) => "verified: every hop was flown again by direct simulation and breaks no limit\n",
            _ => "not verified: the path was not flown again by direct simulation\n",
        });
    }
    if let (Some(front), Some(of)) = (&answer.front, &answer.front_search) {
        text.push_str(&amount_front_text(front, of));
    }
    text
}

fn roadmap_lines(sheet: &mut Sheet, roadmap: &RoadmapRecord) {
    let RoadmapRecord { contacts, by_area, on_facets, about_path, windows, pairs_tested, facets, facets_tried, .. } = roadmap;
    if roadmap.ended_by == RoadmapEnd::Given {
        sheet.line(format_args!("roadmap: {contacts} contacts, start and goal added to those read, {windows} windows"));
        return;
    }
    if let Some(hops) = &roadmap.sampled_hops {
        return sampled_lines(sheet, roadmap, hops);
    }
    sheet.line(format_args!(
        "roadmap: {contacts} contacts ({by_area} by area, {on_facets} in the middle of facets, {about_path} about the path), {windows} windows, \
         pairs tested: {pairs_tested}"
    ));
    sheet.line(format_args!(
        "{facets_tried} of {facets} facets had a turn; points left out: {} buried, {} outside the bounds, {} of no use",
        roadmap.left_out_buried, roadmap.left_out_outside, roadmap.left_out_useless
    ));
    let best = |round: &RoadmapRoundRecord| {
        let totals = round.totals.iter().map(|row| format!("{} {}", row.amount, format_number(rounded(row.total))));
        round.hops.map_or("no path".to_owned(), |_| totals.collect::<Vec<_>>().join(", "))
    };
    let rounds: Vec<String> = roadmap.history.iter().map(|round| format!("{}: {}", round.contacts, best(round))).collect();
    sheet.line(format_args!("contacts and best path: {}", rounds.join("; ")));
    end_line(sheet, roadmap);
}

/// The roadmap of Campana and Laumond's method.
fn sampled_lines(sheet: &mut Sheet, roadmap: &RoadmapRecord, hops: &SampledHopsRecord) {
    let RoadmapRecord { contacts, by_area, on_facets, windows, pairs_tested, .. } = roadmap;
    sheet.line(format_args!(
        "planner: prm, the method of Campana and Laumond: up to seven take-off angles of a hop, checked by a ball along the arc"
    ));
    sheet.line(format_args!(
        "roadmap: {contacts} contacts ({by_area} by area, {on_facets} by facet), {windows} arcs, pairs tested: {pairs_tested}"
    ));
    sheet.line(format_args!(
        "{} hops tried: {} refused by collision, of which {} rise over the bounds; of {} the first arc was refused; {} not tried for a narrow cone",
        hops.tried, hops.refused, hops.too_high, hops.first_arcs_refused, hops.narrow
    ));
    if hops.grazes > 0 {
        sheet.line(format_args!("{} hops of paths were taken out: the ball let them pass through the mesh", hops.grazes));
    }
    sheet
        .line(format_args!("points left out: {} buried, {} outside the bounds", roadmap.left_out_buried, roadmap.left_out_outside));
    end_line(sheet, roadmap);
}

/// Why it stopped growing.
fn end_line(sheet: &mut Sheet, roadmap: &RoadmapRecord) {
    sheet.line(format_args!(
        "{}",
        match roadmap.ended_by {
            RoadmapEnd::Contacts => "it ended with the most contacts (search.contacts_max)",
            RoadmapEnd::Time => "it ended by its time (search.time_max_s): a faster machine may find a better path",
            RoadmapEnd::Gain => "it ended when the best path gained less than 1 % in two rounds",
            RoadmapEnd::Exhausted | RoadmapEnd::Given => "it ended when no more contacts of use were found",
            RoadmapEnd::Joined =>
                "it ended when start and goal were joined, as the method has it: more contacts may give a shorter path",
        }
    ));
}

/// A number for reading, to four digits after the point.
fn rounded(number: f64) -> f64 {
    (number * 1e4).round() / 1e4
}

fn gap_lines(sheet: &mut Sheet, gap: &RoadmapGapRecord) {
    sheet.line(format_args!(
        "the reached contact nearest to the goal is {} ({} reached); more contacts may find a path: this does not prove that no path exists",
        point(gap.nearest_m),
        gap.reached_contacts
    ));
    sheet.line(format_args!(
        "the goal can be reached from {} of these contacts, of which {} is nearest to the start",
        gap.leads_to_goal_contacts,
        point(gap.leads_to_goal_from_m)
    ));
    if let Some(isolated) = isolated_ends([gap.reached_contacts, gap.leads_to_goal_contacts], "contacts") {
        sheet.line(format_args!("{isolated}"));
    }
    match gap.width_m {
        None => sheet.line(format_args!(
            "none of these is as near to a reached contact as one hop by its speeds: the gap is wider than a hop"
        )),
        Some(width_m) => {
            let upright = (gap.vertical > 0).then(|| format!("straight up {}", gap.vertical));
            let by_limit = gap.refusals.ranked().into_iter().map(|(limit, count)| format!("{limit} {count}"));
            let missed = gap.missed_by_sampling.map(|count| format!("missed by the sampled angles {count}"));
            let refused: Vec<String> = by_limit.chain(upright).chain(missed).collect();
            sheet.line(format_args!(
                "the gap is {width_m:.3} m wide; of {} hops across it {} were judged, refused by {}",
                gap.pairs,
                gap.judged_pairs,
                refused.join(", ")
            ));
        }
    }
}

/// Where each hop begins and ends, and its heading.
fn places_text(path: &[HopRecord]) -> String {
    let mut sheet = Sheet::default();
    for row in path {
        let Some(map) = row.map else { continue };
        sheet.line(format_args!(
            "{:>4} from {} to {}, heading {:.3} deg",
            row.hop,
            point([map.takeoff_map_x_m, map.takeoff_map_y_m, row.takeoff_z_m]),
            point([map.landing_map_x_m, map.landing_map_y_m, row.landing_z_m]),
            map.heading_deg
        ));
    }
    sheet.into_text()
}

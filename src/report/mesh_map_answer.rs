//! The answer of a hop map of a mesh, as plain data, table and text.

use std::io::{self, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    DeratingRecord, MeshContactRecord,
    mesh_plan_answer::point,
    stated::stated,
    text::{Sheet, hops_bound},
};
use crate::planner::roadmap::RoadmapEnd;

/// The answer of `chta map` over a mesh: what is reached over contacts all over it. A contact that is reached can be reached; one that is not
/// may be reached over other contacts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshMapAnswer {
    /// Metres per unit of the mesh's file.
    pub mesh_scale: f64,
    /// The start, on the surface.
    pub start: MeshContactRecord,
    /// The contacts.
    pub contacts: MapContactsRecord,
    /// Contacts reached from the start, itself included.
    pub reached_contacts: usize,
    /// Their share of all contacts.
    pub reached_share: f64,
    /// The area that they stand for: each facet with contacts is divided evenly among these.
    pub reached_area_m2: f64,
    /// Its share of the area of all facets with contacts.
    pub reached_area_share: f64,
    /// The hops after which the search ended, if it was bounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hops_max: Option<u32>,
    /// If the search was bounded: contacts that may need more hops, or may not be reached at all, which was not looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_searched_contacts: Option<usize>,
    /// Hops to the farthest contact that is reached.
    pub farthest_hops: u32,
    /// What is reached in how many hops, from 0 on.
    pub by_hops: Vec<ReachedRecord>,
    /// The hops back to the start, if requested.
    #[serde(rename = "return", default, skip_serializing_if = "Option::is_none")]
    pub back: Option<MeshReturnRecord>,
    /// The goal.
    pub goal: MeshGoalRecord,
    /// The shares of the limits that this answer is for; absent if it is for the whole limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derating: Option<DeratingRecord>,
}

/// The contacts of a map of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapContactsRecord {
    /// How many there are, start and goal included.
    pub count: usize,
    /// Of these, drawn by area.
    pub by_area: usize,
    /// Of these, the middles of facets.
    pub on_facets: usize,
    /// Contacts that hold no landing, whatever the hop: facets too steep to rest on, or kept out.
    pub no_landing: usize,
    /// Points left out inside closed bodies, or for their stand-off.
    pub left_out_buried: usize,
    /// Points left out beyond `search.bounds_m`.
    pub left_out_outside: usize,
    /// Facets that meet the bounds.
    pub facets: usize,
    /// Of these, facets with contacts.
    pub facets_with_contacts: usize,
    /// The area of the facets that meet the bounds.
    pub area_m2: f64,
    /// Of this, the area of the facets with contacts.
    pub area_with_contacts_m2: f64,
    /// Ordered pairs of contacts tested in the last round.
    pub pairs_tested: u64,
    /// Why there are no more: `contacts`, `time` or `exhausted` (no more were found).
    pub ended_by: RoadmapEnd,
    /// The rounds, of twice as many contacts each: what one adds shows what further contacts may.
    pub history: Vec<MapRoundRecord>,
}

/// One round of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapRoundRecord {
    /// Contacts so far.
    pub contacts: usize,
    /// How many of them were reached.
    pub reached_contacts: usize,
    /// Their share.
    pub reached_share: f64,
    /// Hops to the farthest of them.
    pub farthest_hops: u32,
}

/// What is reached in a number of hops and in no fewer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReachedRecord {
    /// The hops.
    pub hops: u32,
    /// Contacts that take so many.
    pub contacts: usize,
    /// The share of all contacts that take so many or fewer.
    pub share_within: f64,
    /// The area that the contacts stand for which take so many.
    pub area_m2: f64,
    /// The share of the area of all facets with contacts that takes so many or fewer.
    pub area_share_within: f64,
}

/// Hops back to the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct MeshReturnRecord {
    /// Contacts from which the start is reached, itself included.
    pub return_contacts: usize,
    /// Of these, contacts that are also reached from the start.
    pub round_trip_contacts: usize,
    /// The most hops back.
    pub farthest_hops: u32,
}

/// The goal of a map of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshGoalRecord {
    /// The place, on the surface.
    #[serde(flatten)]
    pub contact: MeshContactRecord,
    /// Fewest hops over these contacts; null: not reached over them.
    pub hops: Option<u32>,
    /// The fewest hops of any path, over whatever contacts, by the greatest speeds alone; null if none hops.
    pub hops_lower_bound: Option<u64>,
    /// False if the search ended at its bound of hops before the goal, so that it is not known whether it can be reached.
    pub searched: bool,
    /// Fewest hops back; absent if not requested, null: not found over these contacts.
    #[serde(default, deserialize_with = "stated", skip_serializing_if = "Option::is_none")]
    pub return_hops: Option<Option<u32>>,
}

/// A contact of a map of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapContactRow {
    /// Its number, from 1: the start has 1.
    pub number: usize,
    /// The point of the surface, [x, y, z], m.
    pub point_m: [f64; 3],
    /// The facet it lies on, by its number from 1; on an edge one of them.
    pub facet: usize,
    /// The area it stands for.
    pub area_m2: f64,
    /// Fewest hops from the start; `None`: not reached over these contacts, or not within the most hops.
    pub hops: Option<u32>,
    /// The contact that the last hop comes from.
    pub from: Option<usize>,
    /// Fewest hops back to the start, and the contact that the first of them goes to.
    pub back: Option<(u32, Option<usize>)>,
}

/// The columns of a contact.
const COLUMNS: [&str; 8] = ["contact", "x_m", "y_m", "z_m", "facet", "area_m2", "hops", "from_contact"];

/// Those of the hops back.
const RETURN_COLUMNS: [&str; 2] = ["return_hops", "return_to_contact"];

/// Writes the contacts as CSV; cells without a value are empty.
///
/// # Errors
/// An error of the writer.
pub fn write_map_contacts_csv(rows: &[MapContactRow], returns: bool, out: impl Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let more = if returns { &RETURN_COLUMNS[..] } else { &[] };
    writer.write_record(COLUMNS.iter().chain(more))?;
    let cell = |value: Option<String>| value.unwrap_or_default();
    for row in rows {
        let [x, y, z] = row.point_m.map(|coordinate| coordinate.to_string());
        let mut fields = vec![row.number.to_string(), x, y, z, row.facet.to_string(), row.area_m2.to_string()];
        fields.push(cell(row.hops.map(|hops| hops.to_string())));
        fields.push(cell(row.from.map(|from| from.to_string())));
        if returns {
            fields.push(cell(row.back.map(|(hops, _)| hops.to_string())));
            fields.push(cell(row.back.and_then(|(_, to)| to).map(|to| to.to_string())));
        }
        writer.write_record(fields)?;
    }
    writer.flush()
}

impl MeshMapAnswer {
    /// Whether the goal is reached over these contacts.
    pub const fn reaches_the_goal(&self) -> bool {
        self.goal.hops.is_some()
    }
}

/// The text of `chta map` over a mesh.
pub fn mesh_map_text(answer: &MeshMapAnswer) -> String {
    let mut sheet = Sheet::default();
    let MapContactsRecord { count, .. } = answer.contacts;
    sheet.line(format_args!(
        "{} of {count} contacts reached from {} ({:.1} %), in at most {}",
        answer.reached_contacts,
        point(answer.start.point_m),
        100.0 * answer.reached_share,
        hops_text(answer.farthest_hops)
    ));
    sheet.line(format_args!(
        "they stand for {:.3} m2 of {:.3} m2, the area of the facets with contacts ({:.1} %)",
        answer.reached_area_m2,
        answer.contacts.area_with_contacts_m2,
        100.0 * answer.reached_area_share
    ));
    if answer.contacts.no_landing > 0 {
        let none = answer.contacts.no_landing;
        sheet.line(format_args!("{none} of {count} contacts hold no landing: their facets are too steep to rest on, or kept out"));
    }
    bound_lines(&mut sheet, answer);
    if let Some(derating) = &answer.derating {
        sheet.line(format_args!("{}", derating.sentence()));
    }
    if let Some(MeshReturnRecord { return_contacts, round_trip_contacts, farthest_hops }) = answer.back {
        sheet.line(format_args!(
            "return: the start is reached from {return_contacts} contacts, {round_trip_contacts} of them reached, in at most {}",
            hops_text(farthest_hops)
        ));
    }
    sheet.line(format_args!("start moved {:.6} m to the nearest point of the surface", answer.start.moved_m));
    goal_lines(&mut sheet, answer);
    contacts_lines(&mut sheet, &answer.contacts);
    sheet.line(format_args!("\n{:>6}{:>12}{:>12}{:>14}{:>12}", "hops", "contacts", "within (%)", "area (m2)", "within (%)"));
    for row in &answer.by_hops {
        let within = [row.share_within, row.area_share_within].map(|share| 100.0 * share);
        sheet.line(format_args!("{:>6}{:>12}{:>12.1}{:>14.3}{:>12.1}", row.hops, row.contacts, within[0], row.area_m2, within[1]));
    }
    sheet.into_text()
}

/// What is not known of the contacts that were not reached.
fn bound_lines(sheet: &mut Sheet, answer: &MeshMapAnswer) {
    if let (Some(most), Some(left)) = (answer.hops_max.map(hops_text), answer.not_searched_contacts) {
        if left > 0 {
            sheet.line(format_args!(
                "searched up to {most}: {left} other contacts may be farther, or may not be reached at all, and were not searched"
            ));
        } else {
            sheet.line(format_args!("searched up to {most}; no contact is farther over these contacts"));
        }
    }
    if answer.reached_contacts < answer.contacts.count && answer.not_searched_contacts.is_none_or(|left| left == 0) {
        sheet.line(format_args!("not reached over these contacts is not unreachable: other contacts may lead on"));
    }
}

fn goal_lines(sheet: &mut Sheet, answer: &MeshMapAnswer) {
    let goal = &answer.goal;
    let hops = match (goal.hops, answer.hops_max.filter(|_| !goal.searched)) {
        (Some(hops), _) => hops_text(hops),
        (None, Some(most)) => format!("not within {}, and not searched beyond", hops_text(most)),
        (None, None) => "not reached over these contacts".to_owned(),
    };
    let back = match goal.return_hops {
        Some(Some(hops)) => format!(", {} back", hops_text(hops)),
        Some(None) => ", no way back found over these contacts".to_owned(),
        None => String::new(),
    };
    let moved_m = goal.contact.moved_m;
    sheet.line(format_args!("goal {}, moved {moved_m:.6} m to the surface: {hops}{back}", point(goal.contact.point_m)));
    match goal.hops_lower_bound {
        Some(lower) if goal.hops.is_some() || goal.searched => {
            let bound = hops_bound(goal.hops.map(u64::from), lower).replace("these nodes", "these contacts");
            sheet.line(format_args!("  {bound}"));
        }
        Some(_) => {}
        None => sheet.line(format_args!("  no path by the greatest speeds, over whatever contacts")),
    }
}

fn contacts_lines(sheet: &mut Sheet, contacts: &MapContactsRecord) {
    let MapContactsRecord { count, by_area, on_facets, left_out_buried, left_out_outside, .. } = contacts;
    sheet.line(format_args!(
        "contacts: {count} ({by_area} by area, {on_facets} in the middle of facets); points left out: {left_out_buried} buried, \
         {left_out_outside} outside the bounds; pairs tested: {}",
        contacts.pairs_tested
    ));
    sheet.line(format_args!(
        "{} of {} facets have contacts, {:.3} m2 of {:.3} m2",
        contacts.facets_with_contacts, contacts.facets, contacts.area_with_contacts_m2, contacts.area_m2
    ));
    let round = |round: &MapRoundRecord| format!("{}: {:.1} %", round.contacts, 100.0 * round.reached_share);
    let rounds: Vec<String> = contacts.history.iter().map(round).collect();
    sheet.line(format_args!("contacts and share reached: {}", rounds.join("; ")));
    let why = match contacts.ended_by {
        RoadmapEnd::Time => "it stopped since another round would have taken too long (search.time_max_s)",
        RoadmapEnd::Exhausted => "it stopped since no more contacts were found",
        RoadmapEnd::Contacts | RoadmapEnd::Gain | RoadmapEnd::Joined | RoadmapEnd::Given => return,
    };
    sheet.line(format_args!("{why}"));
}

/// A count of hops.
fn hops_text(hops: u32) -> String {
    format!("{hops} hop{}", if hops == 1 { "" } else { "s" })
}

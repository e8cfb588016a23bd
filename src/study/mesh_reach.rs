//! What is reached over a mesh in how few hops, and from where the start is reached again.

use std::{io, path::Path};

use super::{
    MeshRouteError,
    mesh_ends::{MeshEnds, mesh_ends},
};
#[cfg(feature = "plot")]
use super::{captions::title, conditions};
#[cfg(feature = "plot")]
use crate::figure::{Caption, FigureError, MeshReachFigure, Picture, ReachedContact, SeenFrom, draw_mesh_reach};
use crate::{
    ground::{MeshContact, MeshGround},
    planner::roadmap::{ContactSampler, DrawnContacts, RoadmapEnd},
    progress::Progress,
    reach::contacts::{Spread, SpreadQuestion, SpreadRound, spread},
    report::{
        DeratingRecord, MapContactRow, MapContactsRecord, MapRoundRecord, MeshContactRecord, MeshGoalRecord, MeshMapAnswer,
        MeshReturnRecord, ReachedRecord, write_map_contacts_csv,
    },
    scenario::Scenario,
    world::Contact,
};

/// What is asked.
#[derive(Clone, Debug)]
pub struct MeshReachQuestion<'a> {
    /// The scenario, with [`TerrainSource::MeshInSpace`](crate::scenario::TerrainSource::MeshInSpace).
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
    /// The most hops; 1 for what a single hop reaches.
    pub hops_max: Option<u32>,
    /// Whether the hops back to the start are wanted as well.
    pub returns: bool,
}

/// What is reached over a mesh, with everything that its views need.
#[derive(Clone, Debug)]
pub struct MeshReached {
    /// The ground under the limits that planning may use.
    pub ground: MeshGround,
    /// The contacts, and the hops to each.
    pub spread: Spread,
    /// The number of the goal among the contacts: 0 where it is the start.
    pub goal: usize,
    /// The area that each contact stands for, m^2.
    pub areas_m2: Vec<f64>,
    /// The answer as plain data.
    pub answer: MeshMapAnswer,
    /// Warnings about the mesh and its contacts.
    pub warnings: Vec<String>,
}

/// Finds which of the contacts all over a mesh are reached from the start of a scenario, in how few hops, for exact commands.
///
/// The contacts are those of a search over the mesh before it has a path: the same keys, the same seed. Every hop between two of them is
/// found, so that a contact without hops is not reached over these contacts; it may be over others.
///
/// # Errors
/// [`MeshRouteError`].
pub fn mesh_reach(question: &MeshReachQuestion<'_>, progress: &dyn Progress) -> Result<MeshReached, MeshRouteError> {
    let scenario = question.scenario;
    let mut ends = mesh_ends(scenario, question.base, scenario.mesh_search.stand_off_m.unwrap_or(0.0))?;
    let search = &scenario.mesh_search;
    let [start, goal] = ends.stood.clone();
    let is_there = ends.ground.are_one_place([&start, &goal]);
    let given = if is_there { vec![start] } else { vec![start, goal] };
    let asked = SpreadQuestion { hops_max: question.hops_max, returns: question.returns };
    let ground = ends.ground.clone();
    let mut sampler = ContactSampler::new(&ground, search.bounds, ends.stand_off_m, search.seed.unwrap_or(0))?;
    let spread = spread(&ground, given, &mut sampler, asked, search.limits(), progress)?;
    let areas = ContactAreas::of(&ground, &spread.contacts);
    let facets = (sampler.facet_count(), sampler.area_m2());
    let goal = usize::from(!is_there);
    let answer = answer((scenario, &ends), (&spread, goal), (&areas, facets), question.hops_max);
    let mut warnings = std::mem::take(&mut ends.warnings);
    warnings.extend(few_facets(&answer));
    Ok(MeshReached { spread, goal, areas_m2: areas.each_m2, answer, warnings, ground })
}

/// The area that each contact stands for: its facet's, divided evenly among the contacts on it.
struct ContactAreas {
    each_m2: Vec<f64>,
    /// How many facets have contacts, and their area.
    facets: usize,
    sum_m2: f64,
}

impl ContactAreas {
    fn of(ground: &MeshGround, contacts: &[MeshContact]) -> Self {
        let tree = ground.tree();
        let mut on = vec![0_u32; tree.mesh().triangle_count()];
        let facets: Vec<usize> = contacts.iter().map(first_facet).collect();
        for facet in &facets {
            on[*facet] += 1;
        }
        let area_m2 = |facet: usize| {
            let [a, b, c] = tree.corners(crate::quantity::FacetId(facet));
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        let with = (0..on.len()).filter(|facet| on[*facet] > 0);
        let (count, sum_m2) = with.fold((0, 0.0), |(count, sum_m2), facet| (count + 1, sum_m2 + area_m2(facet)));
        let each_m2 = facets.iter().map(|facet| area_m2(*facet) / f64::from(on[*facet])).collect();
        Self { each_m2, facets: count, sum_m2 }
    }
}

/// The facet of a contact; on an edge one of them.
fn first_facet(contact: &MeshContact) -> usize {
    contact.facets().first().map_or(0, |facet| facet.id.index())
}

#[expect(clippy::cast_precision_loss, reason = "counts of contacts stay far below 2^53")]
fn share(part: usize, of: usize) -> f64 {
    part as f64 / of.max(1) as f64
}

fn answer(
    (scenario, ends): (&Scenario, &MeshEnds),
    (spread, goal): (&Spread, usize),
    (areas, (facets, area_m2)): (&ContactAreas, (usize, f64)),
    hops_max: Option<u32>,
) -> MeshMapAnswer {
    let (out, count) = (&spread.out, spread.contacts.len());
    let by_hops = by_hops(&out.hops, areas);
    let reached_area_m2 = by_hops.iter().map(|row| row.area_m2).sum();
    let [start, end] = [0, 1].map(|i| MeshContactRecord::new(&ends.ground, &ends.surface[i], ends.given_m[i].coords.into()));
    let between = spread.contacts[goal].point_m() - spread.contacts[0].point_m();
    let lower = ends.ground.speed_bounds().hops(libm::hypot(between.x, between.y), between.z);
    MeshMapAnswer {
        mesh_scale: ends.scale,
        start,
        contacts: contacts_record(spread, areas, (facets, area_m2)),
        reached_contacts: out.count(),
        reached_share: share(out.count(), count),
        reached_area_m2,
        reached_area_share: if areas.sum_m2 > 0.0 { reached_area_m2 / areas.sum_m2 } else { 0.0 },
        hops_max,
        not_searched_contacts: hops_max.map(|_| if out.is_complete { 0 } else { count - out.count() }),
        farthest_hops: out.farthest(),
        by_hops,
        back: spread.back.as_ref().map(|back| MeshReturnRecord {
            return_contacts: back.count(),
            round_trip_contacts: out.hops.iter().zip(&back.hops).filter(|(there, back)| there.is_some() && back.is_some()).count(),
            farthest_hops: back.farthest(),
        }),
        goal: MeshGoalRecord {
            contact: end,
            hops: out.hops[goal],
            hops_lower_bound: lower,
            searched: out.is_complete || out.hops[goal].is_some(),
            return_hops: spread.back.as_ref().map(|back| back.hops[goal]),
        },
        derating: DeratingRecord::of(&scenario.derating),
    }
}

/// What is reached in how many hops, from 0 on.
fn by_hops(hops: &[Option<u32>], areas: &ContactAreas) -> Vec<ReachedRecord> {
    let farthest = hops.iter().flatten().copied().max().unwrap_or(0);
    let mut rows: Vec<ReachedRecord> = Vec::new();
    let (mut contacts_within, mut area_within_m2) = (0, 0.0);
    for count in 0..=farthest {
        let those = hops.iter().zip(&areas.each_m2).filter(|(hops, _)| **hops == Some(count));
        let (contacts, area_m2) = those.fold((0, 0.0), |(contacts, sum_m2), (_, area_m2)| (contacts + 1, sum_m2 + area_m2));
        contacts_within += contacts;
        area_within_m2 += area_m2;
        rows.push(ReachedRecord {
            hops: count,
            contacts,
            share_within: share(contacts_within, hops.len()),
            area_m2,
            area_share_within: if areas.sum_m2 > 0.0 { area_within_m2 / areas.sum_m2 } else { 0.0 },
        });
    }
    rows
}

fn contacts_record(spread: &Spread, areas: &ContactAreas, (facets, area_m2): (usize, f64)) -> MapContactsRecord {
    let DrawnContacts { by_area, on_facets, buried, outside, .. } = spread.drawn;
    let round = |&SpreadRound { contacts, reached, farthest_hops }: &SpreadRound| MapRoundRecord {
        contacts,
        reached_contacts: reached,
        reached_share: share(reached, contacts),
        farthest_hops,
    };
    MapContactsRecord {
        count: spread.contacts.len(),
        by_area,
        on_facets,
        no_landing: spread.contacts.iter().filter(|contact| contact.refuses(Contact::Landing)).count(),
        left_out_buried: buried,
        left_out_outside: outside,
        facets,
        facets_with_contacts: areas.facets,
        area_m2,
        area_with_contacts_m2: areas.sum_m2,
        pairs_tested: spread.out.pairs_tested + spread.back.as_ref().map_or(0, |back| back.pairs_tested),
        ended_by: spread.end,
        history: spread.history.iter().map(round).collect(),
    }
}

/// A warning where few facets have contacts.
fn few_facets(answer: &MeshMapAnswer) -> Option<String> {
    let contacts = &answer.contacts;
    (contacts.facets_with_contacts < contacts.facets && contacts.ended_by != RoadmapEnd::Exhausted).then(|| {
        format!(
            "{} of {} facets of the mesh within the bounds have a contact: small facets without one may be the only way on; more contacts \
             (search.contacts_max) or narrower search.bounds_m reach more of them",
            contacts.facets_with_contacts, contacts.facets
        )
    })
}

impl MeshReached {
    /// The contacts as CSV, with the fewest hops to each and the contact that the last of them comes from.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write_csv(&self, out: impl io::Write) -> io::Result<()> {
        let Spread { contacts, out: hops, back, .. } = &self.spread;
        let number = |contact: Option<usize>| contact.map(|contact| contact + 1);
        let row = |(i, contact): (usize, &MeshContact)| MapContactRow {
            number: i + 1,
            point_m: contact.surface_m().coords.into(),
            facet: first_facet(contact) + 1,
            area_m2: self.areas_m2[i],
            hops: hops.hops[i],
            from: number(hops.next_to[i]),
            back: back.as_ref().and_then(|back| Some((back.hops[i]?, number(back.next_to[i])))),
        };
        let rows: Vec<MapContactRow> = contacts.iter().enumerate().map(row).collect();
        write_map_contacts_csv(&rows, back.is_some(), out)
    }

    /// The picture of the hops to every place: an oblique view and a plan view.
    ///
    /// # Errors
    /// As [`draw_mesh_reach`].
    #[cfg(feature = "plot")]
    pub fn picture(&self, scenario: &Scenario, seen_from: SeenFrom) -> Result<Picture, FigureError> {
        let Spread { contacts, out, back, .. } = &self.spread;
        let reached = |(i, contact): (usize, &MeshContact)| ReachedContact {
            point: contact.surface_m(),
            normal: contact.facets().first().map_or_else(nalgebra::Vector3::z, |facet| facet.normal),
            hops: out.hops[i].map(u64::from),
            returns: back.as_ref().map(|back| back.hops[i].is_some()),
        };
        let drawn: Vec<ReachedContact> = contacts.iter().enumerate().map(reached).collect();
        let answer = &self.answer;
        let result = format!(
            "{} of {} contacts reached ({:.1} %), {:.1} % of the area of the facets with contacts, in at most {} hop{} over these contacts",
            answer.reached_contacts,
            answer.contacts.count,
            100.0 * answer.reached_share,
            100.0 * answer.reached_area_share,
            answer.farthest_hops,
            if answer.farthest_hops == 1 { "" } else { "s" }
        );
        #[expect(clippy::cast_precision_loss, reason = "a count of contacts")]
        let spacing_m = (answer.contacts.area_m2 / contacts.len() as f64).sqrt();
        draw_mesh_reach(&MeshReachFigure {
            caption: Caption {
                title: title("Where in how few hops, over a mesh", scenario),
                lines: vec![conditions(scenario), result],
            },
            mesh: self.ground.tree().mesh(),
            seen_from,
            cut_z_m: None,
            start: contacts[0].surface_m(),
            goal: (contacts[self.goal].surface_m(), out.hops[self.goal].map(u64::from)),
            contacts: &drawn,
            spacing_m,
            searched_to: answer.hops_max.filter(|_| !out.is_complete).map(u64::from),
        })
    }
}

//! The answer for one hop over a mesh, as plain data, and as text.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    BestRecord, BindingRecord,
    path_record::unsigned_zero,
    text::{LimitLine, Sheet, choice_lines, limit_table, place},
};
use crate::{
    ballistics::{TakeoffChoice, limits::BALL_BOUND},
    ground::{BALL_STAND_OFF, MeshConflict, MeshContact, MeshGround, MeshTakeoffSet, MeshWindow, MeshWindowEnd},
    hop::LimitInterval,
    path::heading_deg,
    quantity::{FacetId, SlopeInterval, format_number},
    world::{Contact, Limit},
};

/// The answer of `chta hop` over a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshHopAnswer {
    /// Metres per unit of the mesh's file.
    pub mesh_scale: f64,
    /// The take-off, on the surface.
    pub takeoff: MeshContactRecord,
    /// The landing, on the surface.
    pub landing: MeshContactRecord,
    /// The ball that the hopper is in flight; absent for a point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ball: Option<MeshBallRecord>,
    /// The heading, clockwise from +y.
    pub heading_deg: f64,
    /// Whether a single hop is feasible.
    pub feasible: bool,
    /// The least take-off angle of the window with the hop to fly.
    pub takeoff_angle_min_deg: Option<f64>,
    /// The greatest take-off angle of the window with the hop to fly.
    pub takeoff_angle_max_deg: Option<f64>,
    /// Straight-line distance.
    pub line_of_sight_m: f64,
    /// Elevation angle of the straight line.
    pub line_of_sight_angle_deg: f64,
    /// All windows of feasible take-off angles, ascending; empty if no hop is feasible.
    pub windows: Vec<MeshWindowRecord>,
    /// Each limit separately; the terrain between the contacts is in `blocked`.
    pub limits: Vec<MeshLimitRecord>,
    /// The take-off angles that facets between the contacts block, ascending, whatever the other limits allow.
    pub blocked: Vec<MeshBlockedRecord>,
    /// The limits that set the ends of the window with the hop to fly, or the limits that conflict.
    pub binding: MeshBindingRecord,
    /// The hop to fly, by the scenario's choice of take-off angle.
    pub best: Option<BestRecord>,
    /// The hops of all choices; empty if no hop is feasible.
    pub choices: Vec<BestRecord>,
}

/// The ball that a hopper is in flight. The windows are those of its centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshBallRecord {
    /// Its radius: on no arc of the windows does the centre come nearer to the mesh.
    pub radius_m: f64,
    /// An arc may be left out of the windows where the centre comes nearer to the mesh than this.
    pub refused_within_m: f64,
    /// How far off the contacts the centre begins and ends.
    pub stand_off_m: f64,
    /// The centre at take-off, [x, y, z], m.
    pub takeoff_centre_m: [f64; 3],
    /// The centre at landing, [x, y, z], m.
    pub landing_centre_m: [f64; 3],
}

/// A contact on a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshContactRecord {
    /// The point as given, [x, y, z], m.
    pub given_m: [f64; 3],
    /// The nearest point of the surface, [x, y, z], m: where the hop begins or ends.
    pub point_m: [f64; 3],
    /// How far apart these two are.
    pub moved_m: f64,
    /// The facets that meet at the point; the strictest rules.
    pub facets: Vec<MeshFacetRecord>,
    /// The names of the groups, objects and materials of these facets; absent where they have none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<String>,
}

/// A facet of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshFacetRecord {
    /// Its number, from 1, among the triangles of the mesh as read.
    pub number: usize,
    /// Its corners, each [x, y, z], m.
    pub corners_m: [[f64; 3]; 3],
}

/// One window of feasible take-off angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshWindowRecord {
    /// Its least take-off angle.
    pub takeoff_angle_min_deg: f64,
    /// Its greatest take-off angle.
    pub takeoff_angle_max_deg: f64,
    /// What sets the least angle.
    pub lower: MeshWindowEndRecord,
    /// What sets the greatest angle.
    pub upper: MeshWindowEndRecord,
}

/// What sets one end of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshWindowEndRecord {
    /// The limit.
    pub limit: Limit,
    /// For the terrain: the facet that the arc of this end grazes, or from which it keeps just the clearance.
    pub facet: Option<MeshFacetRecord>,
}

/// The take-off angles that one limit allows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshLimitRecord {
    /// Its name.
    pub name: Limit,
    /// The least take-off angle it allows; null if it refuses every arc.
    pub min_deg: Option<f64>,
    /// The greatest take-off angle it allows; null if it refuses every arc.
    pub max_deg: Option<f64>,
    /// Between these two, the angles that it refuses: those of arcs slower than the least take-off speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused_deg: Option<[f64; 2]>,
    /// The reason, if it refuses every arc.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refusal: Option<String>,
    /// The facet at a contact that refuses, if one does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facet: Option<MeshFacetRecord>,
}

/// Take-off angles that facets block.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeshBlockedRecord {
    /// From this angle.
    pub min_deg: f64,
    /// To this angle.
    pub max_deg: f64,
    /// The facet that bounds them below.
    pub lower: MeshFacetRecord,
    /// The facet that bounds them above.
    pub upper: MeshFacetRecord,
}

/// What sets the ends of the feasible set, or the reason why it is empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MeshBindingRecord {
    /// Feasible: the limit at either end.
    Ends {
        /// What sets the least take-off angle.
        lower: MeshWindowEndRecord,
        /// What sets the greatest take-off angle.
        upper: MeshWindowEndRecord,
    },
    /// Empty: one limit that refuses every arc, or limits that conflict.
    Conflict {
        /// Their names.
        conflict: Vec<Limit>,
        /// By how many degrees, if the limits are on angles.
        gap_deg: Option<f64>,
        /// By how many m/s a speed falls short, if the limit is on a speed.
        #[serde(skip_serializing_if = "Option::is_none")]
        gap_m_s: Option<f64>,
        /// The conflict in one sentence.
        sentence: String,
    },
}

impl MeshHopAnswer {
    /// The answer for the set of one hop between two contacts, given at two points of a mesh of some metres per unit of its file.
    pub fn new(
        ground: &MeshGround,
        set: &MeshTakeoffSet,
        contacts: [&MeshContact; 2],
        (given_m, mesh_scale): ([[f64; 3]; 2], f64),
        choice: TakeoffChoice,
    ) -> Self {
        let (sight, gravity) = (set.course().sight, ground.envelope().gravity_m_s2());
        let limits = ground.envelope().hopper().limits();
        let best = |choice| set.arc(choice, gravity).map(|(_, arc)| BestRecord::new(&arc, choice, limits));
        let window = set.arc(choice, gravity).map(|(window, _)| window);
        let angles = window.and_then(|window| set.angles_of(window.lofts));
        let [takeoff, landing] = [0, 1].map(|i| MeshContactRecord::new(ground, contacts[i], given_m[i]));
        let end = |end| MeshWindowEndRecord::new(ground, end);
        Self {
            mesh_scale,
            takeoff,
            landing,
            ball: MeshBallRecord::new(ground, contacts),
            heading_deg: heading_deg(contacts[0].point_m().xy(), contacts[1].point_m().xy()),
            feasible: angles.is_some(),
            takeoff_angle_min_deg: angles.map(|angles| angles.min.degrees()),
            takeoff_angle_max_deg: angles.map(|angles| angles.max.degrees()),
            line_of_sight_m: sight.length_m(),
            line_of_sight_angle_deg: unsigned_zero(sight.angle().degrees()),
            windows: set.windows().iter().filter_map(|window| MeshWindowRecord::new(ground, set, window)).collect(),
            limits: set.limits().iter().map(|limit| MeshLimitRecord::new(ground, set, limit)).collect(),
            blocked: set
                .blocked()
                .iter()
                .filter_map(|span| {
                    // Arcs have positive lofts.
                    let lofts = SlopeInterval { lower: span.lofts.lower.max(0.0), upper: span.lofts.upper };
                    let angles = set.angles_of(lofts)?;
                    let [lower, upper] = [span.lower, span.upper].map(|facet| MeshFacetRecord::new(ground, facet));
                    Some(MeshBlockedRecord { min_deg: angles.min.degrees(), max_deg: angles.max.degrees(), lower, upper })
                })
                .collect(),
            binding: match (window, set.conflict()) {
                (Some(window), _) => MeshBindingRecord::Ends { lower: end(window.lower), upper: end(window.upper) },
                (None, conflict) => MeshBindingRecord::of_conflict(conflict),
            },
            best: best(choice),
            choices: TakeoffChoice::ALL.into_iter().filter_map(best).collect(),
        }
    }
}

impl MeshBallRecord {
    fn new(ground: &MeshGround, contacts: [&MeshContact; 2]) -> Option<Self> {
        let radius_m = Some(ground.radius_m()).filter(|radius_m| *radius_m > 0.0)?;
        let [takeoff_centre_m, landing_centre_m] = contacts.map(|contact| contact.point_m().coords.into());
        Some(Self {
            radius_m,
            refused_within_m: BALL_BOUND * radius_m,
            stand_off_m: BALL_STAND_OFF * radius_m,
            takeoff_centre_m,
            landing_centre_m,
        })
    }
}

impl MeshContactRecord {
    /// From a contact that was asked for at a point.
    pub fn new(ground: &MeshGround, contact: &MeshContact, given_m: [f64; 3]) -> Self {
        Self {
            given_m,
            point_m: contact.surface_m().coords.into(),
            moved_m: contact.moved_m(),
            facets: contact.facets().iter().map(|facet| MeshFacetRecord::new(ground, facet.id)).collect(),
            groups: {
                let names = contact.facets().iter().flat_map(|facet| ground.names_of(facet.id));
                names.cloned().collect::<std::collections::BTreeSet<_>>().into_iter().collect()
            },
        }
    }
}

impl MeshFacetRecord {
    fn new(ground: &MeshGround, facet: FacetId) -> Self {
        Self { number: facet.index() + 1, corners_m: ground.tree().corners(facet).map(|corner| corner.coords.into()) }
    }
}

impl MeshWindowRecord {
    fn new(ground: &MeshGround, set: &MeshTakeoffSet, window: &MeshWindow) -> Option<Self> {
        let angles = set.angles_of(window.lofts)?;
        let [lower, upper] = [window.lower, window.upper].map(|end| MeshWindowEndRecord::new(ground, end));
        Some(Self { takeoff_angle_min_deg: angles.min.degrees(), takeoff_angle_max_deg: angles.max.degrees(), lower, upper })
    }
}

impl MeshWindowEndRecord {
    fn new(ground: &MeshGround, end: MeshWindowEnd) -> Self {
        Self { limit: end.limit, facet: end.facet.map(|facet| MeshFacetRecord::new(ground, facet)) }
    }
}

impl MeshLimitRecord {
    fn new(ground: &MeshGround, set: &MeshTakeoffSet, limit: &LimitInterval) -> Self {
        let angles = set.angles_of(limit.lofts);
        let facet = match limit.shortfall {
            Some(crate::hop::Shortfall::Ground { contact: Contact::Takeoff, .. }) => set.refused_by()[0],
            Some(crate::hop::Shortfall::Ground { contact: Contact::Landing, .. }) => set.refused_by()[1],
            _ => None,
        };
        Self {
            name: limit.limit,
            min_deg: angles.map(|angles| angles.min.degrees()),
            max_deg: angles.map(|angles| angles.max.degrees()),
            refused_deg: limit.gap.and_then(|gap| set.angles_of(gap)).map(|gap| [gap.min.degrees(), gap.max.degrees()]),
            refusal: limit.shortfall.map(|shortfall| shortfall.to_string()),
            facet: facet.map(|facet| MeshFacetRecord::new(ground, facet)),
        }
    }
}

impl MeshBindingRecord {
    fn of_conflict(conflict: Option<MeshConflict>) -> Self {
        let sentence = conflict.map(|conflict| conflict.to_string()).unwrap_or_default();
        let (conflict, gap_deg, gap_m_s) = match conflict {
            Some(MeshConflict::Terrain { gap_deg, .. }) => (vec![Limit::Terrain], gap_deg, None),
            // Only a limit of a chain has a vertex.
            Some(MeshConflict::Limits(conflict)) => match BindingRecord::of_conflict_at(&conflict, |_| None) {
                BindingRecord::Conflict { conflict, gap_deg, gap_m_s, .. } => (conflict, gap_deg, gap_m_s),
                BindingRecord::Ends { lower, upper, .. } => (vec![lower, upper], None, None),
            },
            None => (Vec::new(), None, None),
        };
        Self::Conflict { conflict, gap_deg, gap_m_s, sentence }
    }
}

/// The text of `chta hop` over a mesh.
pub fn mesh_hop_text(answer: &MeshHopAnswer) -> String {
    let mut sheet = Sheet::default();
    let point = |[x_m, y_m, z_m]: [f64; 3]| format!("({}, {}, {}) m", place(x_m), place(y_m), place(z_m));
    sheet.line(format_args!(
        "from {} to {}, heading {:.3} deg: {:.3} m of line of sight at {:.3} deg",
        point(answer.takeoff.point_m),
        point(answer.landing.point_m),
        answer.heading_deg,
        answer.line_of_sight_m,
        answer.line_of_sight_angle_deg
    ));
    for (name, contact) in [("take-off", &answer.takeoff), ("landing", &answer.landing)] {
        let (s, numbers) = match contact.facets.as_slice() {
            [one] => ("", one.number.to_string()),
            all => ("s", all.iter().map(|facet| facet.number.to_string()).collect::<Vec<_>>().join(", ")),
        };
        let groups = match contact.groups.as_slice() {
            [] => String::new(),
            names => format!(" ({})", names.join(", ")),
        };
        sheet.line(format_args!(
            "{name} moved {:.6} m to the nearest point of the surface, on facet{s} {numbers}{groups}",
            contact.moved_m
        ));
    }
    if let Some(ball) = &answer.ball {
        sheet.line(format_args!(
            "a ball of radius {} m whose centre begins and ends {} m off the surface: no arc of the windows comes nearer to a facet than its \
             radius; arcs that come nearer than {:.6} m may be left out",
            format_number(ball.radius_m),
            format_number(ball.stand_off_m),
            ball.refused_within_m
        ));
    }
    match answer.windows.as_slice() {
        [] => sheet.line(format_args!("not feasible in one hop")),
        [one] => sheet.line(format_args!("feasible: take-off angles {}", window_line(one))),
        several => {
            sheet.line(format_args!("feasible: take-off angles in {} windows", several.len()));
            for window in several {
                sheet.line(format_args!("  {}", window_line(window)));
            }
        }
    }
    if let MeshBindingRecord::Conflict { sentence, .. } = &answer.binding {
        sheet.line(format_args!("why: {sentence}"));
    }
    let lines = answer.limits.iter().map(|limit| {
        let facet = limit.facet.map(|facet| format!("  (facet {})", facet.number)).unwrap_or_default();
        let refusal = limit.refusal.as_ref().map(|refusal| format!("  {refusal}")).unwrap_or_default();
        LimitLine {
            name: limit.name,
            ends_deg: [limit.min_deg, limit.max_deg],
            refused_deg: limit.refused_deg,
            remark: refusal + &facet,
        }
    });
    let wide = limit_table(&mut sheet, &lines.collect::<Vec<_>>());
    if answer.blocked.is_empty() {
        sheet.line(format_args!("\nno facet between the contacts blocks an arc"));
    } else {
        sheet.line(format_args!("\n{:<wide$}{:>14}{:>14}", "blocked by facets", "min (deg)", "max (deg)"));
    }
    for span in &answer.blocked {
        let numbers = format!("{} to {}", span.lower.number, span.upper.number);
        sheet.line(format_args!("{numbers:<wide$}{:>14.6}{:>14.6}", span.min_deg, span.max_deg));
    }
    choice_lines(&mut sheet, answer.best, &answer.choices);
    sheet.into_text()
}

/// One window in one line.
fn window_line(window: &MeshWindowRecord) -> String {
    let MeshWindowRecord { takeoff_angle_min_deg: min, takeoff_angle_max_deg: max, lower, upper } = window;
    let by = |end: &MeshWindowEndRecord| match end.facet {
        Some(facet) => format!("{} (facet {})", end.limit, facet.number),
        None => end.limit.to_string(),
    };
    if min == max {
        return format!("{min:.6} deg by {}", by(lower));
    }
    format!("{min:.6} to {max:.6} deg, from {} to {}", by(lower), by(upper))
}

//! One hop over a mesh, limit by limit: between any two points of its surface, under overhangs and through caves.

#[cfg(feature = "plot")]
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use nalgebra::Point3;

use super::{
    Extent, Extremes, TooLarge, constant_gravity_warnings, mesh_flaws::flaw_warnings, nodes::level_hop_of_m, physics::check_extent,
};
#[cfg(feature = "plot")]
use super::{captions::title, conditions};
use crate::{
    chain::ConstraintProblem,
    ground::{MeshContact, MeshGround, MeshTakeoffSet, NoMeshContact, UnknownGroup},
    quantity::format_number,
    report::{DeratingRecord, MeshHopAnswer},
    scenario::Scenario,
    terrain::{MeshTree, TerrainError, read_mesh_with},
};
#[cfg(feature = "plot")]
use crate::{
    figure::{Caption, FigureError, MeshHopFigure, Picture, draw_mesh_hop},
    quantity::{ChainPoint, FacetId, SlopeInterval},
};

/// What is asked.
#[derive(Clone, Debug)]
pub struct MeshHopQuestion<'a> {
    /// The scenario; its terrain does not matter.
    pub scenario: &'a Scenario,
    /// The file of the mesh.
    pub mesh: &'a Path,
    /// Metres per unit of the file.
    pub scale: f64,
    /// The points from which take-off and landing are moved to the surface, m.
    pub ends_m: [Point3<f64>; 2],
}

/// Why there is no answer. That the hop is not feasible is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshHopError {
    /// The file.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A mesh larger than its body.
    #[error("{}: {problem}", file.display())]
    TooLarge {
        /// The file.
        file: PathBuf,
        /// Its size.
        problem: TooLarge,
    },
    /// A key that has no meaning on a mesh, and that an answer would have to obey.
    #[error("found {key}, which is {what}, expected a scenario without it for hops over a mesh: remove it")]
    NotOnAMesh {
        /// The key.
        key: &'static str,
        /// What it is for.
        what: &'static str,
    },
    /// A group of faces that the mesh does not have.
    #[error(transparent)]
    Group(#[from] UnknownGroup),
    /// The surface states no grip, or the hopper no speeds.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblem),
    /// A point that gives no contact.
    #[error("the {end}: {problem}")]
    NoContact {
        /// Take-off or landing.
        end: &'static str,
        /// Why.
        problem: NoMeshContact,
    },
    /// Two contacts over one another.
    #[error(
        "take-off and landing are both at x, y = {}, {} m of the surface, expected two different places: a hop straight up has no plane",
        format_number(*.x_m), format_number(*.y_m)
    )]
    SamePlace {
        /// Where, m.
        x_m: f64,
        /// Where, m.
        y_m: f64,
    },
}

/// One hop over a mesh, with everything that its views need.
#[derive(Clone, Debug)]
pub struct MeshHopped {
    /// The ground.
    pub ground: MeshGround,
    /// Take-off and landing.
    pub contacts: [MeshContact; 2],
    /// The set of feasible arcs.
    pub set: MeshTakeoffSet,
    /// The answer as plain data.
    pub answer: MeshHopAnswer,
    /// Warnings about the mesh and the hop.
    pub warnings: Vec<String>,
}

/// Tests the one hop between the points of a mesh that are nearest to two given ones, for exact commands.
///
/// # Errors
/// [`MeshHopError`].
pub fn mesh_hop(question: &MeshHopQuestion<'_>) -> Result<MeshHopped, MeshHopError> {
    let MeshHopQuestion { scenario, mesh, scale, ends_m } = question;
    check_keys(scenario)?;
    let (ground, mut warnings) = mesh_ground(scenario, mesh, *scale)?;
    let contacts =
        [on_mesh(&ground, ends_m[0], "take-off", &mut warnings)?, on_mesh(&ground, ends_m[1], "landing", &mut warnings)?];
    let [takeoff, landing] = &contacts;
    let at = takeoff.point_m();
    let same = MeshHopError::SamePlace { x_m: at.x, y_m: at.y };
    let set = ground.takeoff_set(takeoff, landing).ok_or(same)?;
    let given_m = ends_m.map(|end| end.coords.into());
    let answer = MeshHopAnswer::new(&ground, &set, [takeoff, landing], (given_m, *scale), scenario.search.takeoff);
    let extremes = answer.best.map_or_else(Extremes::default, |best| Extremes {
        range_m: set.course().sight.run_m(),
        height_m: best.apex_height_m,
        speed_m_s: best.takeoff_speed_m_s.max(best.landing_speed_m_s),
    });
    warnings.extend(constant_gravity_warnings(&scenario.body, extremes));
    warnings.extend(DeratingRecord::of(&scenario.derating).map(|derating| derating.sentence()));
    Ok(MeshHopped { ground, contacts, set, answer, warnings })
}

/// The contact nearest to a given point; a point far from the mesh is warned of.
pub(super) fn on_mesh(
    ground: &MeshGround,
    at: Point3<f64>,
    end: &'static str,
    warnings: &mut Vec<String>,
) -> Result<MeshContact, MeshHopError> {
    let contact = ground.contact(at).map_err(|problem| MeshHopError::NoContact { end, problem })?;
    let (size_m, envelope) = (ground.tree().mesh().bounds().size_m(), ground.envelope());
    let hop_m = level_hop_of_m(envelope.hopper(), envelope.gravity_m_s2());
    if contact.moved_m() > FAR * size_m.min(hop_m) {
        warnings.push(format!(
            "the {end} was moved {} m to the surface of a mesh that measures {} m and over which one level hop spans {} m: the answer is for the \
             place on the mesh; check the point, its unit and terrain.mesh_scale",
            format_number(contact.moved_m()),
            format_number(size_m),
            format_number(hop_m)
        ));
    }
    Ok(contact)
}

/// A point farther from the surface than this share of the size of the mesh, or of a level hop, was hardly meant to be moved there.
const FAR: f64 = 0.5;

#[cfg(feature = "plot")]
impl MeshHopped {
    /// The picture of the cut, of the feasible arcs and of those that facets block.
    ///
    /// # Errors
    /// As [`draw_mesh_hop`](crate::figure::draw_mesh_hop).
    pub fn picture(&self, scenario: &Scenario) -> Result<Picture, FigureError> {
        let course = self.set.course();
        let (plane, sight) = (&course.plane, course.sight);
        // Somewhat more than the picture shows.
        let view_m = [-sight.run_m(), 2.0 * sight.run_m()];
        let mut cut: Vec<(FacetId, [ChainPoint; 2])> = Vec::new();
        let _ = self.ground.tree().cut(
            plane,
            |[low, high]| low.x_m <= view_m[1] && view_m[0] <= high.x_m,
            |facet, segment| {
                cut.push((facet, segment.map(|point| ChainPoint::new(point.x_m, plane.origin.z + point.z_m))));
                ControlFlow::Continue(())
            },
        );
        let ends = self.set.windows().iter().flat_map(|window| [window.lower.facet, window.upper.facet]);
        let bounding: Vec<FacetId> = ends.flatten().collect();
        let bounds = cut.iter().filter(|(facet, _)| bounding.contains(facet)).map(|(_, segment)| *segment).collect();
        let limits = self.set.limits().iter().map(|limit| limit.lofts);
        let allowed = limits.fold(SlopeInterval::ALL, SlopeInterval::intersect);
        let choice = scenario.search.takeoff;
        let verdict = match self.answer.windows.len() {
            0 => "not feasible in one hop".to_owned(),
            1 => "feasible in one window of take-off angles".to_owned(),
            count => format!("feasible in {count} windows of take-off angles"),
        };
        let [from, to] = [&self.answer.takeoff, &self.answer.landing].map(|contact| {
            let [x_m, y_m, z_m] = contact.point_m;
            format!("({x_m:.3}, {y_m:.3}, {z_m:.3})")
        });
        let ball = self.answer.ball.map(|ball| {
            let [radius_m, off_m] = [ball.radius_m, ball.stand_off_m].map(format_number);
            format!("; arcs of the centre of a ball of radius {radius_m} m, from {off_m} m off the surface")
        });
        let question =
            format!("from {from} to {to} m, heading {:.2} deg: {verdict}{}", self.answer.heading_deg, ball.unwrap_or_default());
        draw_mesh_hop(&MeshHopFigure {
            caption: Caption { title: title("Hop over a mesh", scenario), lines: vec![conditions(scenario), question] },
            cut: cut.into_iter().map(|(_, segment)| segment).collect(),
            bounds,
            takeoff_z_m: plane.origin.z,
            sight,
            allowed: (!allowed.is_empty()).then_some(allowed),
            blocked: self.set.blocked().iter().map(|span| span.lofts).collect(),
            windows: self.set.windows().iter().map(|window| window.lofts).collect(),
            best: self.set.arc(choice, self.ground.envelope().gravity_m_s2()).map(|(_, arc)| arc.loft()),
        })
    }
}

/// The ground of a mesh under the limits that planning may use, for exact commands, and warnings about the mesh.
pub(super) fn mesh_ground(scenario: &Scenario, file: &Path, scale: f64) -> Result<(MeshGround, Vec<String>), MeshHopError> {
    let read = read_mesh_with(file, scale, scenario.no_data)?;
    let mut warnings = read.warnings;
    let too_large = |problem| MeshHopError::TooLarge { file: file.to_path_buf(), problem };
    warnings.extend(check_extent(&scenario.body, &Extent::of_mesh(&read.mesh.bounds())).map_err(too_large)?);
    let tree = MeshTree::new(read.mesh);
    warnings.extend(flaw_warnings(&tree));
    let planned = scenario.derated();
    let planned = planned.as_ref().unwrap_or(scenario);
    let hopper = planned.hopper.with_any_command();
    let ground = MeshGround::new(tree, &hopper, scenario.body.gravity, &planned.surface)?;
    Ok((ground.with_groups(&scenario.groups, &scenario.derating)?, warnings))
}

/// Refuses the keys that restrict contacts by a map.
pub(super) fn check_keys(scenario: &Scenario) -> Result<(), MeshHopError> {
    let refused = [
        ("surface.keep_out", "laid over a map", scenario.keep_out.is_some()),
        ("surface.keep_in", "laid over a map", scenario.keep_in.is_some()),
        ("surface.friction_raster", "laid over a map", scenario.friction_raster.is_some()),
        ("layer", "laid over a map", !scenario.layers.is_empty()),
        ("hopper.footprint_m", "fitted over a DEM or a profile", scenario.hopper.limits().footprint_m.is_some_and(|m| m > 0.0)),
    ];
    match refused.into_iter().find(|(.., given)| *given) {
        Some((key, what, _)) => Err(MeshHopError::NotOnAMesh { key, what }),
        None => Ok(()),
    }
}

//! Where a robot with legs can stand, and which way it may jump from there.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use nalgebra::{Point3, Vector3};

use super::{
    Extent, Overlays, TooLarge,
    mesh_flaws::flaw_warnings,
    mesh_hop::{check_keys, on_mesh},
    physics::check_extent,
};
use crate::{
    ballistics::stance::{ConeKind, ContactCone},
    chain::ConstraintProblem,
    ground::{MeshContact, MeshGround, NoFriction, NoStance, Stance, StanceGround, StanceMap, StandsUp},
    quantity::MapPoint,
    report::{StanceAnswer, TriedPoses, heading_of},
    robot_model::LimbChain,
    scenario::Scenario,
    terrain::{Dem, MapBounds, MeshTree, TerrainError, mesh_of_dem, read_mesh_with},
    world::{Hopper, HopperLimits, LandingMode, Robot},
};

use super::MeshHopError;

/// The terrain that a robot stands on.
#[derive(Clone, Debug)]
pub enum StanceTerrain {
    /// A mesh, by its file and metres per unit.
    Mesh(PathBuf, f64),
    /// An elevation raster.
    Dem(Arc<Dem>),
}

/// What is asked.
#[derive(Clone, Debug)]
pub struct StanceQuestion<'a> {
    /// The scenario: gravity, friction and, where it has them, the limits of the machine and what lies over the map of a DEM.
    pub scenario: &'a Scenario,
    /// The folder that its paths start from.
    pub base: &'a Path,
    /// The terrain.
    pub terrain: &'a StanceTerrain,
    /// The robot.
    pub robot: Robot,
    /// The joints of its limbs, in the order of the limbs; `None` or absent where they are not known.
    pub chains: &'a [Option<LimbChain>],
    /// The place, moved to the nearest point of the surface, m; of a DEM the height is left out.
    pub at_m: (MapPoint, Option<f64>),
    /// Which way its forward axis points, degrees clockwise from +y; `None`: all around is tried.
    pub heading_deg: Option<f64>,
    /// How far its root is over the place, along its up axis, m; `None`: from the trunk on the ground to the legs at full length is tried.
    pub height_m: Option<f64>,
    /// Which way is up for it.
    pub up: StandsUp,
    /// How many headings the rose has.
    pub headings: u32,
}

/// Why there is no answer. That the robot cannot stand is one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StanceError {
    /// The file.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// A terrain larger than its body.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The place gives no contact, or the surface no grip.
    #[error(transparent)]
    Mesh(#[from] MeshHopError),
    /// The surface states no grip.
    #[error(transparent)]
    Constraints(#[from] ConstraintProblem),
    /// The surface states no friction.
    #[error(transparent)]
    NoFriction(#[from] NoFriction),
    /// A mesh whose place has no height.
    #[error("found a place of two numbers, expected X,Y,Z on a mesh, which may have several floors one over another")]
    NoHeight,
    /// A place off the map.
    #[error("the place ({x_m}, {y_m}) m is off the map, which spans x {} to {} m and y {} to {} m", map.min.x, map.max.x, map.min.y, map.max.y)]
    OffTheMap {
        /// Where, m.
        x_m: f64,
        /// Where, m.
        y_m: f64,
        /// The map.
        map: MapBounds,
    },
}

/// A stance, with everything that its views need.
#[derive(Clone, Debug)]
pub struct Stood {
    /// The ground with the robot.
    pub ground: StanceGround,
    /// The stance; `None` if the robot cannot stand there.
    pub stance: Option<Stance>,
    /// The place on the surface.
    pub at: MeshContact,
    /// The answer as plain data.
    pub answer: StanceAnswer,
    /// Warnings about the terrain and the stance.
    pub warnings: Vec<String>,
}

/// Headings tried where none is given.
const HEADINGS: u32 = 36;

/// A foothold whose facets are this far from its mean normal is on a ridge or in a notch, degrees.
const WIDE_SPREAD_DEG: f64 = 10.0;

/// Looks for a stance of a robot at a place: the one with the most feet on the ground, and of those the one with the widest beam of take-off
/// angles.
///
/// # Errors
/// [`StanceError`].
pub fn stand(question: &StanceQuestion<'_>) -> Result<Stood, StanceError> {
    let StanceQuestion { scenario, robot, headings, .. } = question;
    let hopper = with_robot(&scenario.hopper, robot);
    let (mesh, mut warnings) = mesh_of(question)?;
    warnings.extend(flaw_warnings(&mesh));
    let ground = MeshGround::new(mesh, &hopper, scenario.body.gravity, &scenario.surface)?;
    let ground = ground.with_groups(&scenario.groups, &scenario.derating).map_err(MeshHopError::from)?;
    let at = match (question.terrain, question.at_m) {
        (StanceTerrain::Mesh(..), (map, Some(z_m))) => Point3::new(map.x, map.y, z_m),
        (StanceTerrain::Mesh(..), (_, None)) => return Err(StanceError::NoHeight),
        (StanceTerrain::Dem(_), (map, _)) => {
            let top_m = ground.tree().mesh().bounds().high_m;
            let ground = StanceGround::new(ground.clone(), robot.clone(), ConeKind::Exact, question.up)?;
            let z_m = ground.ground_below_m(Point3::new(map.x, map.y, top_m));
            Point3::new(map.x, map.y, z_m.unwrap_or(top_m))
        }
    };
    let at = on_mesh(&ground, at, "place", &mut warnings)?;
    let ground = StanceGround::new(ground, robot.clone(), ConeKind::Exact, question.up)?.with_chains(question.chains);
    let ground = match question.terrain {
        StanceTerrain::Mesh(..) => ground,
        StanceTerrain::Dem(dem) => {
            let overlays = Overlays::read(scenario, question.base, Some(&dem.georeference().coordinate_system), dem.bounds())?;
            warnings.extend(overlays.without_effect_on_dem(dem.bounds()));
            ground.with_map(StanceMap::new(overlays.laid_over(Arc::clone(dem))))
        }
    };
    let found = best_stance(&ground, &at, (question.heading_deg, question.height_m));
    let (best, refusal, tried) = (found.best, found.refusal, found.tried);
    let answer = match (&best, &refusal) {
        (Some((stance, height_m)), _) => StanceAnswer::of_stance(&ground, stance, (tried, Some(*height_m)), *headings),
        (None, Some(refusal)) => StanceAnswer::of_refusal(ground.robot().name(), refusal, tried),
        (None, None) => StanceAnswer::of_contacts(&[], *headings),
    };
    warnings.extend(faces_down(&at, "place"));
    let spread = answer.contacts.iter().filter_map(|foot| Some((foot.limb.clone()?, foot.spread_deg?)));
    warnings.extend(spread.filter(|(_, deg)| *deg > WIDE_SPREAD_DEG).map(|(limb, deg)| {
        format!("{limb} stands on facets that differ by up to {deg:.1} deg from the normal that stands for them: a ridge or a notch within its reach")
    }));
    Ok(Stood { ground, stance: best.map(|(stance, _)| stance), at, answer, warnings })
}

/// The stance with the most feet on the ground over a place, and of those the one with the widest beam.
pub(super) struct BestStance {
    /// The stance, and how far its root is over the place, m.
    pub(super) best: Option<(Stance, f64)>,
    /// The refusal that was the nearest to a stance.
    pub(super) refusal: Option<NoStance>,
    /// What became of the poses.
    pub(super) tried: TriedPoses,
}

/// Looks for a stance over a place, all around and from the trunk on the ground to the legs at full length where heading and height are not
/// given.
pub(super) fn best_stance(
    ground: &StanceGround,
    at: &MeshContact,
    (heading_deg, height_m): (Option<f64>, Option<f64>),
) -> BestStance {
    let normal: Vector3<f64> = at.facets().iter().map(|facet| facet.normal).sum();
    let up = ground.up_over(normal);
    let all = || ground.standing_heights_m().to_vec();
    let heights: Vec<f64> = height_m.map_or_else(all, |height_m| vec![height_m]);
    let all_around = || (0..HEADINGS).map(|turn| 360.0 * f64::from(turn) / f64::from(HEADINGS)).collect();
    let facing: Vec<f64> = heading_deg.map_or_else(all_around, |deg| vec![deg]);
    let mut tried = TriedPoses::default();
    let (mut best, mut refusal): (Option<(Ranking, Stance, f64)>, Option<NoStance>) = (None, None);
    for height_m in heights {
        for heading_deg in &facing {
            let outcome = ground.stand_over(at, up, heading_of(*heading_deg), height_m);
            tried.count(&outcome);
            match outcome {
                Ok(stance) => {
                    let ranking = Ranking::of(&stance);
                    if best.as_ref().is_none_or(|(known, ..)| ranking.is_better_than(known)) {
                        best = Some((ranking, stance, height_m));
                    }
                }
                Err(other) => {
                    refusal = Some(match refusal {
                        Some(known) => nearer(known, other),
                        None => other,
                    });
                }
            }
        }
    }
    BestStance { best: best.map(|(_, stance, height_m)| (stance, height_m)), refusal, tried }
}

/// A warning where a robot would hang under a place: its facets face down.
pub(super) fn faces_down(at: &MeshContact, place: &str) -> Option<String> {
    let normal: Vector3<f64> = at.facets().iter().map(|facet| facet.normal).sum();
    (normal.z < 0.0).then(|| {
        format!(
            "the facets at the {place} face down, by the order of their corners: the robot is under them; of a mesh that is inverted reverse the \
             order"
        )
    })
}

/// Contacts without a robot, from a table: `normal_x,normal_y,normal_z,friction_coefficient`, one row a contact.
///
/// # Errors
/// [`ContactsError`], with the line.
pub fn contacts_of(file: &Path) -> Result<Vec<ContactCone>, ContactsError> {
    let problem = |line: u64, problem: String| ContactsError { file: file.to_path_buf(), line, problem };
    let text =
        fs::read_to_string(file).map_err(|error| problem(0, format!("cannot be read ({error}), expected a readable CSV file")))?;
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| problem(1, format!("{error}, expected the header {CONTACT_COLUMNS}")))?.clone();
    if header.iter().collect::<Vec<_>>().join(",") != CONTACT_COLUMNS {
        return Err(problem(
            1,
            format!("found the header {}, expected {CONTACT_COLUMNS}", header.iter().collect::<Vec<_>>().join(",")),
        ));
    }
    let mut found = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            problem(line, format!("{error}, expected the four numbers {CONTACT_COLUMNS}"))
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut numbers = [0.0; 4];
        for (number, (field, name)) in numbers.iter_mut().zip(record.iter().zip(CONTACT_COLUMNS.split(','))) {
            *number = field
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite())
                .ok_or_else(|| problem(line, format!("{name} is \"{field}\", expected a finite number")))?;
        }
        let [x, y, z, mu] = numbers;
        let normal = Vector3::new(x, y, z).try_normalize(1e-9);
        let normal =
            normal.ok_or_else(|| problem(line, "the normal is (0, 0, 0), expected a direction out of the ground".to_owned()))?;
        let friction = crate::world::FrictionCone::new(mu).map_err(|error| problem(line, error.to_string()))?;
        found.push(ContactCone::new(normal, friction).map_err(|error| problem(line, error.to_string()))?);
    }
    if found.is_empty() {
        return Err(problem(1, "found no contact, expected at least one row".to_owned()));
    }
    Ok(found)
}

/// The header of a table of contacts.
const CONTACT_COLUMNS: &str = "normal_x,normal_y,normal_z,friction_coefficient";

/// A table of contacts that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}:{line}: {problem}", file.display())]
pub struct ContactsError {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1; 0 for the whole file.
    pub line: u64,
    /// What was found and expected.
    pub problem: String,
}

/// Which of two stances is better.
struct Ranking {
    feet: usize,
    beam: f64,
}

impl Ranking {
    fn of(stance: &Stance) -> Self {
        let opening = |cone: &crate::ballistics::stance::ConeSum| {
            let cuts = (0..HEADINGS).map(|turn| cone.cut(heading_of(360.0 * f64::from(turn) / f64::from(HEADINGS))));
            cuts.filter_map(|cut| cut.opening()).map(crate::quantity::Angle::degrees).sum::<f64>()
        };
        Self { feet: stance.footholds().len(), beam: stance.cone().map_or(0.0, opening) }
    }

    /// Beams that differ by rounding are equal, so that of poses turned into one another the first is kept.
    fn is_better_than(&self, other: &Self) -> bool {
        self.feet > other.feet || (self.feet == other.feet && self.beam > other.beam * (1.0 + 1e-9))
    }
}

/// Of two refusals the one that was nearer to a stance: the cone, then the feet by their number, then the trunk.
fn nearer(known: NoStance, other: NoStance) -> NoStance {
    let rank = |refusal: &NoStance| match refusal {
        NoStance::Slips => usize::MAX,
        NoStance::NoDirection => usize::MAX - 1,
        NoStance::TooFewContacts { found, .. } => 2 + found,
        NoStance::Trunk(_) | NoStance::NoContact(_) => 1,
        NoStance::InsideRock => 0,
    };
    if rank(&other) > rank(&known) { other } else { known }
}

/// The stances of a way without walking, two and two: one hop from each to the next.
pub(super) fn pairs_of<'a>(stances: &[&'a Stance]) -> Vec<[&'a Stance; 2]> {
    stances.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The limits of a hopper, with those that a robot states in their place where the hopper states none, and the lesser of both.
pub(super) fn with_robot(hopper: &Hopper, robot: &Robot) -> Hopper {
    let limits = *hopper.limits();
    let least = |own: f64, stated: Option<f64>| stated.map_or(own, |stated| own.min(stated));
    let takeoff_speed_max_m_s = least(limits.takeoff_speed_max_m_s, robot.takeoff_speed_max_m_s());
    let landing_speed_max_m_s = least(limits.landing_speed_max_m_s, robot.landing_speed_max_m_s());
    let mass_kg = limits.mass_kg.or(robot.mass_kg());
    // The trunk has the size of the robot, and its feet take the landing: no ball is about its root, and no brakes slow it.
    Hopper::new(HopperLimits {
        takeoff_speed_max_m_s,
        landing_speed_max_m_s,
        mass_kg,
        radius_m: None,
        landing: LandingMode::Ballistic,
        ..limits
    })
    .unwrap_or(*hopper)
}

/// The mesh under a place.
fn mesh_of(question: &StanceQuestion<'_>) -> Result<(MeshTree, Vec<String>), StanceError> {
    let StanceQuestion { scenario, terrain, robot, at_m: (at, _), .. } = question;
    match terrain {
        StanceTerrain::Mesh(file, scale) => {
            check_keys(scenario)?;
            let read = read_mesh_with(file, *scale, scenario.no_data)?;
            let mut warnings = read.warnings;
            warnings.extend(check_extent(&scenario.body, &Extent::of_mesh(&read.mesh.bounds()))?);
            Ok((MeshTree::new(read.mesh), warnings))
        }
        StanceTerrain::Dem(dem) => {
            let map = dem.bounds();
            if !map.contains(*at) {
                return Err(StanceError::OffTheMap { x_m: at.x, y_m: at.y, map });
            }
            // The root is at most a leg away from the place, and its feet at most their reach from the root.
            let reach_m = robot.reach_m() + robot.leg_length_m() + robot.trunk_radius_m();
            let away = nalgebra::Vector2::repeat(reach_m);
            let mesh = mesh_of_dem(dem, MapBounds { min: *at - away, max: *at + away })?;
            Ok((MeshTree::new(mesh), Vec::new()))
        }
    }
}

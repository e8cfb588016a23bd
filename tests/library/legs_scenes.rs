//! The scenes of Table 1 of Campana and others 2016, *Ballistic motion planning for jumping superheroes*: a frog in a pond, and a skeleton
//! without arms in a desert.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot prepare its scene stops, and one without its meshes says so"
)]

use std::{path::Path, time::Instant};

use chta::{
    ballistics::{TakeoffChoice, stance::ConeKind},
    ground::{MeshGround, Pose, Stance, StanceGround, StandsUp},
    planner::{
        Amount, Budgets, LabelCap, Objective, SearchedCommands, StanceSampler,
        roadmap::{ContactSampler, GrownRoadmap, RoadmapLimits, RoadmapQuestion, SpaceBounds, grow_until_joined},
    },
    terrain::{MeshTree, read_mesh},
    world::{
        ConvexWorkspace, FrictionCone, Gravity, Grip, Hopper, Limb, RestSlope, Robot, RobotDescription, SurfaceProperties,
        TrunkBox, Workspace,
    },
};
use nalgebra::{Point3, Vector2, Vector3};

const LIMBS: &str = "../shared/limbs";

fn triangles(file: &str) -> Vec<[Point3<f64>; 3]> {
    read_mesh(&Path::new(LIMBS).join(file), 1.0).unwrap().mesh.triangles().collect()
}

/// Boxes along the axes, each of twelve triangles of a file.
fn boxes(file: &str, moved: [f64; 3]) -> Vec<TrunkBox> {
    let of = |part: &[[Point3<f64>; 3]]| {
        let corners: Vec<Point3<f64>> = part.iter().flatten().copied().collect();
        let [low, high] = corners.iter().fold([corners[0]; 2], |[low, high], corner| [low.inf(corner), high.sup(corner)]);
        TrunkBox::upright(nalgebra::center(&low, &high) + Vector3::from(moved), 0.5 * (high - low))
    };
    triangles(file).chunks(12).map(of).collect()
}

fn limb(name: &str, file: &str, hip: [f64; 3]) -> Limb {
    let points: Vec<Point3<f64>> = triangles(file).into_iter().flatten().collect();
    Limb::new(name, Point3::from(hip), Workspace::Convex(ConvexWorkspace::hull_of(&points).unwrap()))
}

fn frog() -> Robot {
    let folder = |name: &str| format!("characters/frog/{name}.stl");
    let trunk = [boxes(&folder("Torso_box"), [0.0; 3]), boxes(&folder("Head_box"), [0.0296, 0.0, 0.0205])].concat();
    let limbs = vec![
        limb("left foot", &folder("lfoot_rom"), [-0.0802, 0.0196, -0.0173]),
        limb("right foot", &folder("rfoot_rom"), [-0.0806, -0.0223, -0.0182]),
        limb("left hand", &folder("lhand_rom"), [0.03, 0.035, 0.0]),
        limb("right hand", &folder("rhand_rom"), [0.03, -0.035, 0.0]),
    ];
    Robot::new(RobotDescription { trunk, contacts_min: 4, ..RobotDescription::new("frog", limbs) }).unwrap()
}

fn skeleton() -> Robot {
    let folder = |name: &str| format!("characters/armless_skeleton/{name}.stl");
    let parts = [("pelvis_box", [0.0; 3]), ("thorax_box", [0.0208, 0.0, 0.3334]), ("skull_box", [-0.0113, 0.0, 0.6139])];
    let trunk = parts.iter().flat_map(|(name, moved)| boxes(&folder(name), *moved)).collect();
    let limbs = vec![
        limb("left foot", &folder("lfoot_rom"), [-0.0076, 0.0756, -0.0472]),
        limb("right foot", &folder("rfoot_rom"), [-0.0076, -0.0756, -0.0472]),
    ];
    Robot::new(RobotDescription { trunk, contacts_min: 2, ..RobotDescription::new("skeleton without arms", limbs) }).unwrap()
}

/// A scene of Table 1.
struct Scene {
    name: &'static str,
    file: &'static str,
    robot: fn() -> Robot,
    bounds: [[f64; 3]; 2],
    /// Root and up at start and goal.
    ends: [[[f64; 3]; 2]; 2],
    friction: f64,
    speeds_m_s: [f64; 2],
    /// Nodes and hops of the paper.
    paper: [f64; 2],
}

const POND: Scene = Scene {
    name: "frog in the pond",
    file: "scenes/pond_6994.stl",
    robot: frog,
    bounds: [[-4.5, -6.3, -0.15], [3.6, 4.9, 2.7]],
    ends: [[[-1.44, 2.78, -0.11], [0.0, 0.0, 1.0]], [[-0.35, -3.45, 0.035], [0.0, 0.0, 1.0]]],
    friction: 1.2,
    speeds_m_s: [5.0, 9.0],
    paper: [46.6, 5.3],
};

const DESERT: Scene = Scene {
    name: "skeleton in the desert",
    file: "scenes/desert_47733.stl",
    robot: skeleton,
    bounds: [[-9.0, -7.0, -1.7], [7.0, 7.0, 2.5]],
    ends: [[[4.42, -0.08, 0.09], [0.128, 0.202, 0.971]], [[-6.4, -5.1, -1.7], [-0.216, -0.358, 0.908]]],
    friction: 0.5,
    speeds_m_s: [8.0, 12.0],
    paper: [22.4, 9.2],
};

fn ground(scene: &Scene, cone: ConeKind) -> StanceGround {
    let mesh = read_mesh(&Path::new(LIMBS).join(scene.file), 1.0).unwrap().mesh;
    let surface =
        SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(scene.friction).unwrap())), rest: RestSlope::Unlimited };
    let hopper = Hopper::with_speeds(scene.speeds_m_s[0], scene.speeds_m_s[1]).unwrap();
    let mesh = MeshGround::new(MeshTree::new(mesh), &hopper, Gravity::new(9.81).unwrap(), &surface).unwrap();
    StanceGround::new(mesh, (scene.robot)(), cone, StandsUp::Normal).unwrap()
}

/// Start and goal: the heading is not stated, and the first of 24 that stands.
fn ends(scene: &Scene, ground: &StanceGround) -> [Stance; 2] {
    scene.ends.map(|[root, up]| {
        let up = Vector3::from(up).normalize();
        let headings = (0..24).map(|turn| (f64::from(turn) * std::f64::consts::PI / 12.0).sin_cos());
        let mut refusals = Vec::new();
        for (sine, cosine) in headings {
            match ground.stand(Pose::facing(Point3::from(root), up, Vector2::new(cosine, sine))) {
                Ok(stance) => return stance,
                Err(refusal) => refusals.push(refusal.to_string()),
            }
        }
        panic!("{}: {refusals:?}", scene.name);
    })
}

fn planned(scene: &Scene, ground: &StanceGround, ends: &[Stance; 2], seed: u64) -> GrownRoadmap<Stance> {
    // Of the root: the ground under it may be a leg lower.
    let [low, max] = scene.bounds.map(Point3::from);
    let min = low - Vector3::z() * ground.heights_m()[1];
    let contacts = ContactSampler::new(ground.mesh(), Some(SpaceBounds { min, max }), 0.0, seed).unwrap();
    let mut sampler = StanceSampler::new(ground, contacts, seed);
    let objective = Objective::new(vec![Amount::Hops, Amount::ArcLength]).unwrap();
    let question = RoadmapQuestion {
        objective: &objective,
        budgets: &Budgets::NONE,
        commands: SearchedCommands::Chosen,
        takeoff: TakeoffChoice::LeastSpeed,
        cap: LabelCap::default(),
    };
    let limits = RoadmapLimits { contacts_max: 2_000, time_max: None };
    grow_until_joined(ground, ends.clone(), &mut sampler, &question, limits, &()).unwrap()
}

/// The runs of each row: 50 as in the paper, unless `CHTA_RUNS` says otherwise.
fn runs() -> u64 {
    std::env::var("CHTA_RUNS").ok().and_then(|runs| runs.parse().ok()).unwrap_or(50)
}

#[test]
#[ignore = "fifty runs of each scene; the times are printed, not judged"]
fn table_one_in_fifty_runs() {
    for scene in [&POND, &DESERT] {
        if !Path::new(LIMBS).join(scene.file).exists() {
            eprintln!("skipped: {LIMBS}/{} is absent", scene.file);
            continue;
        }
        for cone in [ConeKind::Kc, ConeKind::Exact] {
            let ground = ground(scene, cone);
            let ends = ends(scene, &ground);
            let count = f64::from(u32::try_from(runs()).unwrap());
            let (mut nodes, mut hops, mut time_s) = (0.0, 0.0, 0.0);
            for seed in 0..runs() {
                let began = Instant::now();
                let grown = planned(scene, &ground, &ends, seed);
                time_s += began.elapsed().as_secs_f64();
                eprintln!(
                    "seed {seed}: {:.3} s, {} nodes, {} windows, {:?}",
                    began.elapsed().as_secs_f64(),
                    grown.roadmap.contact_count(),
                    grown.roadmap.window_count(),
                    grown.end
                );
                nodes += f64::from(u32::try_from(grown.roadmap.contact_count()).unwrap());
                hops += grown.route.path.unwrap().totals.of(Amount::Hops);
            }
            eprintln!(
                "{}, {cone:?}: {:.1} ms, {:.1} nodes, {:.2} hops; paper {:?}",
                scene.name,
                time_s * 1e3 / count,
                nodes / count,
                hops / count,
                scene.paper
            );
            assert!(hops / count <= scene.paper[1] + 0.5, "{}", scene.name);
        }
    }
}

/// The note of Table 1 gives the skeleton 18 and 25 m/s, with which first paths over the desert have one to three hops; the script of the month of
/// its 9.2 hops, which is what the table above has, says 8 and 12.
#[test]
fn erratum_with_the_speeds_of_the_note_the_desert_needs_far_fewer_hops() {
    let scene = Scene { speeds_m_s: [18.0, 25.0], ..DESERT };
    if !Path::new(LIMBS).join(scene.file).exists() {
        eprintln!("skipped: {LIMBS}/{} is absent", scene.file);
        return;
    }
    let ground = ground(&scene, ConeKind::Exact);
    let ends = ends(&scene, &ground);
    for seed in 0..5 {
        let grown = planned(&scene, &ground, &ends, seed);
        let hops = grown.route.path.unwrap().totals.of(Amount::Hops);
        assert!((1.0..=0.5 * scene.paper[1]).contains(&hops), "seed {seed}: {hops} hops");
    }
}

//! The JSON of every kind of answer reads back as its type, and is written again as it was.

#![allow(clippy::unwrap_used, reason = "a test that cannot run the program should stop")]

use std::{collections::BTreeSet, path::Path, sync::OnceLock};

use chta::arena::ArenaKeys;
use chta::report::{
    ArenaAnswer, CheckAnswer, CompareAnswer, Document, DocumentKind, DocumentProblem, DriftAnswer, ExperimentAnswer, FanAnswer,
    HopAnswer, LegsMapAnswer, LegsPlanAnswer, LegsSimulateAnswer, LegsTradeAnswer, MapAnswer, MeshCheckAnswer, MeshHopAnswer,
    MeshMapAnswer, MeshPlanAnswer, MeshSimulateAnswer, PairsAnswer, PlanAnswer, RequireAnswer, SimulateAnswer, SitesAnswer,
    SizeAnswer, StanceAnswer, TargetsAnswer, TargetsSimulateAnswer, TradeAnswer, TravelAnswer, TravelMapAnswer,
    TravelSimulateAnswer,
};
use chta::scenario::{Scenario, scenario_document};
use rayon::prelude::*;
use serde::{Serialize, de::DeserializeOwned};

use crate::desk::chta;

/// Commands whose answers have every part that an answer may have: found and refused, with proof, with trials, on maps with and without
/// a projection, with propellant, with commands in steps, with risk.
const COMMANDS: [&str; 70] = [
    "plan data/drive/mars_rover.toml --alternatives",
    "plan data/drive/mars_rover.toml --set budget.mission_time_max_s=100",
    "plan data/drive/mars_rover.toml --set drive.travel=drive --set drive.slope_up_max_deg=1",
    "map data/drive/mars_rover.toml --set drive.travel=drive --return",
    "simulate data/drive/mars_rover.toml --trials 50 --compare --success-min 0.1",
    "plan data/missions/lunar_rille_targets.toml",
    "simulate data/missions/lunar_rille_targets.toml --trials 5",
    "simulate data/missions/small_body_drift.toml --trials 50 --success-min 0.5 --density DENSITY",
    "sites data/terrain/mars_crater_field.tif --every 90 --scenario data/scenarios/mars_crater_field.toml",
    "stance data/mesh/rubble.obj --robot data/robots/three_legs.toml --at=0,0,0.5 --body moon --set surface.friction_coefficient=0.8",
    "stance data/mesh/rubble.obj --robot data/robots/four_legs.toml --at=0,0,0.5 --height-m 1 --body moon --set surface.friction_coefficient=0.8",
    "plan data/mesh_scenarios/three_legs.toml --set search.contacts_max=60",
    "plan data/mesh_scenarios/three_legs.toml --set search.contacts_max=30 --set search.seed=5 --set robot.cone=kc",
    "simulate data/mesh_scenarios/three_legs.toml --set search.contacts_max=60 --trials 20 --compare --success-min 0.1",
    "plan data/mesh_scenarios/mars_four_legs.toml --set search.contacts_max=20",
    "plan data/mesh_scenarios/mars_four_legs.toml --set search.contacts_max=12 --set drive.speed_m_s=0.3 --set drive.slope_up_max_deg=12",
    "map data/mesh_scenarios/mars_four_legs.toml --stride 16 --set robot.headings=2 --hops-max 2",
    "trade data/mesh_scenarios/three_legs.toml --set search.contacts_max=20 --vary robot.cone=kc,exact",
    "hop data/scenarios/paper_76m.toml --from 0 --to 20",
    "hop data/scenarios/paper_76m.toml --from 0 --to 25",
    "hop data/scenarios/simple.toml",
    "hop data/scenarios/wall.toml",
    "hop data/scenarios/lunar_rille.toml --from 0 --to 12",
    "hop data/scenarios/lunar_hopper.toml --from 0 --to 5",
    "hop data/chains/rolling_100.csv --from 3 --to 9.5 --scenario data/scenarios/rolling_surely.toml --set hopper.clearance_m=0.3",
    "hop data/chains/rolling_100.csv --from 3 --to 9.5 --scenario data/scenarios/rolling_surely.toml --set hopper.takeoff_speed_min_m_s=3",
    "hop data/mesh/simple.obj --from 2,0,2 --to 10,0,2 --scenario data/scenarios/simple_mesh.toml",
    "hop data/mesh/simple.obj --from 2,0,2 --to 10,0,2 --scenario data/scenarios/simple_mesh.toml --set hopper.takeoff_speed_max_m_s=1",
    "check data/scenarios/paper_76m.toml",
    "check data/scenarios/paper_76m.toml --prove",
    "check data/scenarios/wall.toml --prove",
    "check data/scenarios/cliff.toml",
    "check data/scenarios/cliff.toml --prove",
    "check data/scenarios/vertices.toml",
    "check data/scenarios/lunar_rille_too_steep.toml --prove",
    "check data/scenarios/lunar_rille.toml --prove",
    "check data/scenarios/simple.toml --set hopper.footprint_m=0.5 --prove",
    "check data/scenarios/paper_76m.toml --pairs PAIRS",
    "plan data/scenarios/simple_reduced.toml --verify",
    "plan data/scenarios/mars_crater_field.toml --prove",
    "plan data/scenarios/mars_crater_field_surely.toml",
    "plan data/scenarios/rolling_surely.toml",
    "plan data/scenarios/simple_mesh.toml",
    "plan data/scenarios/lunar_hopper.toml",
    "plan data/scenarios/lunar_hopper.toml --set hopper.propellant_max_kg=0.001",
    "plan data/scenarios/mars_frogbot.toml",
    "plan data/scenarios/ryugu_hopper.toml",
    "plan data/scenarios/simple_reduced.toml --set hopper.takeoff_speed_step_m_s=0.01 --set hopper.takeoff_angle_step_deg=0.5",
    "plan data/scenarios/wall.toml",
    "simulate data/scenarios/rolling_surely.toml --trials 300 --compare",
    "simulate data/scenarios/mars_crater_field_surely.toml --trials 2500",
    "simulate data/scenarios/wall.toml",
    "simulate data/scenarios/paper_76m.toml --experiment worst-drift",
    "simulate data/scenarios/paper_76m.toml --experiment cone-width",
    "simulate data/scenarios/rolling_surely.toml --experiment sensitivity --trials 200",
    "simulate data/scenarios/rolling_surely.toml --trials 100 --first-trial 50 --success-min 0.9 --set uncertainty.goal_tolerance_m=0.5",
    "plan data/scenarios/rolling_surely.toml --front hops,risk",
    "require data/scenarios/paper_76m.toml --vary hopper.takeoff_speed_max_m_s --from 2 --to 20",
    "require data/scenarios/wall.toml --vary hopper.takeoff_speed_max_m_s --from 1 --to 2",
    "trade data/scenarios/paper_76m.toml --vary hopper.takeoff_speed_max_m_s=4:8:3 --vary hopper.landing_speed_max_m_s=4:8:2 --prove",
    "fan data/terrain/mars_crater_field.tif --from 96,84 --headings 5 --length 40 --scenario data/scenarios/mars_crater_field.toml",
    "map data/terrain/mars_crater_field.tif --start 96,84 --goal 30,30 --goal 12,84 --scenario data/scenarios/mars_crater_field_surely.toml \
     --return --mobility MOBILITY --effort energy --stride 2 --simulate",
    "map data/terrain/mars_crater_field.tif --start 96,84 --start 30,30 --start 170,12 --goal 12,84 --hops-max 3 \
     --scenario data/scenarios/mars_crater_field.toml",
    "map data/terrain/mars_crater_field.tif --start 96,84 --scenario data/scenarios/mars_crater_field.toml --dry-run",
    "fan data/terrain/mars_crater_field.tif --from 96,84 --headings 5 --length 40 --scenario data/scenarios/mars_crater_field.toml --dry-run",
    "arena data/arenas/sumo_2.toml --planner grid --set jumper.jump_j=1.4 --set jumper.wheelbase_m=0.2 --set arena.start_heading_deg=0",
    "arena data/arenas/sumo_3.toml --no-jump",
    "arena data/arenas/sumo_2.toml --planner grid --set flight.takeoff_speed_m_s=4 --set flight.takeoff_angle_deg=76",
    "arena data/arenas/sumo_4.toml --planner rrt-star --nodes 300",
    "arena data/arenas/sumo_2.toml --set jumper.drive_j_per_m=1 --set jumper.battery_j=20",
];

/// The JSON of the commands above, of a comparison, of a run with its trials, and of maps of a known projection.
pub(crate) fn documents() -> &'static [(String, String)] {
    static DOCUMENTS: OnceLock<Vec<(String, String)>> = OnceLock::new();
    DOCUMENTS.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        std::fs::write(file("pairs.csv"), "start_x_m,goal_x_m\n0,20\n0,76\n20,5\n").unwrap();
        let mut commands: Vec<String> = COMMANDS
            .iter()
            .map(|command| command.replace("PAIRS", &file("pairs.csv")).replace("MOBILITY", &file("mobility.tif")).replace("DENSITY", &file("density.tif")))
            .collect();
        commands.push(
            "compare data/scenarios/paper_76m.toml data/scenarios/wall.toml data/scenarios/lunar_hopper.toml --prove".to_owned(),
        );
        commands.push("compare data/scenarios/simple.toml data/scenarios/simple_reduced.toml".to_owned());
        commands.push(format!("run data/scenarios/rolling_surely.toml -o {}", file("rolling")));
        commands.push(format!("run data/scenarios/cliff.toml -o {}", file("cliff")));
        let space = format!(
            "[body]\ngravity_m_s2 = 9.81\n[hopper]\ntakeoff_speed_max_m_s = 6\nlanding_speed_max_m_s = 6\n[surface]\nfriction_coefficient = 1\n\
             [terrain]\nmesh = '{}'\nroute = \"free\"\nstart_m = [2, 0, 1]\ngoal_m = [10, 0, 1]\n[search]\ncontacts_max = 60\n",
            root.join("data/mesh/simple.obj").display()
        );
        std::fs::write(file("space.toml"), space).unwrap();
        commands.push(format!("plan {} --front hops,arc-length", file("space.toml")));
        commands.push(format!("map {} --return --hops-max 2", file("space.toml")));
        commands.push(format!("run {} -o {}", file("space.toml"), file("space")));
        let errors = "--set uncertainty.takeoff_speed_sigma_fraction=0.02 --set uncertainty.goal_tolerance_m=1 --trials 20 --compare";
        commands.push(format!("simulate {} {errors} --success-min 0.5", file("space.toml")));
        let pole = root.join("../shared/dem/lola_dem_north.tif");
        if pole.is_file() {
            let by_hops = "--scenario data/scenarios/lunar_rille.toml --accept-map-scale --set hopper.takeoff_speed_max_m_s=100 \
                 --set hopper.landing_speed_max_m_s=100 --set hopper.apex_height_max_m=5000";
            commands
                .push(format!("fan ../shared/dem/lola_dem_north.tif --from-lonlat 10,85 --headings 6 --length 30000 {by_hops}"));
            // The scenario's spacing of nodes is for posts of 2 m, not of 1 600 m.
            commands.push(format!(
                "map ../shared/dem/lola_dem_north.tif --start-lonlat 10,85 --goal-lonlat 20,84 --return --node-spacing-max-m 1600 {by_hops}"
            ));
        }
        let written = |command: String| {
            let arguments: Vec<&str> = command.split_whitespace().chain(["--format", "json", "--quiet"]).collect();
            let (status, stdout, stderr) = chta(root, &arguments);
            assert!(status < 2 && !stdout.is_empty(), "{command}: {stderr}");
            (command, stdout)
        };
        let mut documents: Vec<_> = commands.into_par_iter().map(written).collect();
        // The result of a run is there once it was written; under another gravity its path breaks limits.
        documents.push(written(format!("check {}", file("space/result.json"))));
        documents.push(written(format!("check {} --set body.gravity_m_s2=9", file("space/result.json"))));
        let trials = std::fs::read_to_string(folder.path().join("rolling/simulation.json")).unwrap();
        documents.push(("simulation.json of a run".to_owned(), trials));
        documents
    })
}

/// Reads a document of a kind, and writes it again.
fn rewritten(kind: DocumentKind, text: &str) -> Result<String, DocumentProblem> {
    fn of<T: Serialize + DeserializeOwned>(text: &str) -> Result<String, DocumentProblem> {
        Ok(Document::<T>::from_json(text)?.to_json()?)
    }
    match kind {
        DocumentKind::Hop => of::<HopAnswer>(text),
        DocumentKind::HopMesh => of::<MeshHopAnswer>(text),
        DocumentKind::Check => of::<CheckAnswer>(text),
        DocumentKind::CheckPairs => of::<PairsAnswer>(text),
        DocumentKind::Plan | DocumentKind::Run => of::<PlanAnswer>(text),
        DocumentKind::MapMesh => of::<MeshMapAnswer>(text),
        DocumentKind::CheckMesh => of::<MeshCheckAnswer>(text),
        DocumentKind::PlanMesh | DocumentKind::RunMesh => of::<MeshPlanAnswer>(text),
        DocumentKind::PlanTravel => of::<TravelAnswer>(text),
        DocumentKind::PlanTargets => of::<TargetsAnswer>(text),
        DocumentKind::SimulateTargets => of::<TargetsSimulateAnswer>(text),
        DocumentKind::MapLegs => of::<LegsMapAnswer>(text),
        DocumentKind::MapTravel => of::<TravelMapAnswer>(text),
        DocumentKind::SimulateTravel => of::<TravelSimulateAnswer>(text),
        DocumentKind::Simulate => of::<SimulateAnswer>(text),
        DocumentKind::SimulateMesh => of::<MeshSimulateAnswer>(text),
        DocumentKind::SimulateDrift => of::<DriftAnswer>(text),
        DocumentKind::SimulateExperiment => of::<ExperimentAnswer>(text),
        DocumentKind::Require => of::<RequireAnswer>(text),
        DocumentKind::Trade => of::<TradeAnswer>(text),
        DocumentKind::TradeLegs => of::<LegsTradeAnswer>(text),
        DocumentKind::Compare => of::<CompareAnswer>(text),
        DocumentKind::Fan => of::<FanAnswer>(text),
        DocumentKind::Map => of::<MapAnswer>(text),
        DocumentKind::Sites => of::<SitesAnswer>(text),
        DocumentKind::Size => of::<SizeAnswer>(text),
        DocumentKind::Stance => of::<StanceAnswer>(text),
        DocumentKind::PlanLegs => of::<LegsPlanAnswer>(text),
        DocumentKind::SimulateLegs => of::<LegsSimulateAnswer>(text),
        DocumentKind::Arena => of::<ArenaAnswer>(text),
    }
}

/// The kind that a document states.
pub(crate) fn kind_of(text: &str) -> DocumentKind {
    let value: serde_json::Value = serde_json::from_str(text).unwrap();
    DocumentKind::of_schema(value["schema"].as_str().unwrap()).unwrap()
}

#[test]
fn every_answer_reads_back_and_is_written_as_it_was() {
    let mut kinds = BTreeSet::new();
    for (command, text) in documents() {
        let kind = kind_of(text);
        kinds.insert(kind.name());
        let again = rewritten(kind, text).unwrap_or_else(|problem| panic!("{command}: {problem}"));
        assert!(again == *text, "{command}: written again it differs:\n{again}\nfrom\n{text}");
    }
    for kind in DocumentKind::ALL {
        assert!(kinds.contains(kind.name()), "no command writes a document of kind {}", kind.name());
    }
}

/// What is planted into a document, and the sentence about it.
#[test]
fn what_is_no_answer_is_refused_with_its_key() {
    let of = |kind: DocumentKind| documents().iter().find(|(_, text)| kind_of(text) == kind).unwrap().1.clone();
    for (kind, found, planted, sentence) in [
        (DocumentKind::Check, "\"traversable\"", "\"passable\"", "found \"passable\", expected one of traversable, untraversable"),
        (DocumentKind::Check, "\"nodes\":", "\"nodules\":", "missing field `nodes`"),
        (DocumentKind::Plan, "\"verdict\":", "\"extra\": 1, \"verdict\":", "/extra is not as documents"),
        (
            DocumentKind::Plan,
            "\"direction\": \"forward\"",
            "\"direction\": \"up\"",
            "found \"up\", expected one of forward, reverse",
        ),
        (DocumentKind::Plan, "\"binding\": \"", "\"binding\": \"x", "expected the names of two limits"),
        (DocumentKind::Plan, "\"takeoff_cone_min_deg\"", "\"takeoff_cone_deg\"", "\"takeoff_cone_deg\" is no margin of a hop"),
        (
            DocumentKind::Simulate,
            "\"policy\": \"replan\",\n  \"success_rate\"",
            "\"policy\": \"no-loop\",\n  \"success_rate\"",
            "is not as documents",
        ),
        (DocumentKind::Hop, "\"limits\": [", "\"limits\": [7, ", "invalid type"),
    ] {
        let text = of(kind).replacen(found, planted, 1);
        assert_ne!(text, of(kind), "{found} is not in the document");
        let problem = rewritten(kind, &text).map(|_| ()).expect_err(planted).to_string();
        assert!(problem.contains(sentence), "{planted}: {problem}");
    }
}

#[test]
fn the_scenario_inside_an_answer_reads_back_as_it_was() {
    for (command, text) in documents() {
        let document: serde_json::Value = serde_json::from_str(text).unwrap();
        if kind_of(text) == DocumentKind::Arena {
            let keys: ArenaKeys = serde_json::from_value(document["scenario"].clone()).unwrap();
            assert_eq!(serde_json::to_value(keys).unwrap(), document["scenario"], "{command}");
            continue;
        }
        let alone = std::slice::from_ref(&document["scenario"]);
        for written in document["scenario"].as_array().map_or(alone, Vec::as_slice) {
            let scenario = Scenario::from_document(written).unwrap_or_else(|problems| panic!("{command}: {problems:?}"));
            let again = scenario_document(&scenario, &|path| path.to_str().unwrap().to_owned());
            assert_eq!(again, *written, "{command}");
            assert_eq!(Scenario::from_document(&again), Ok(scenario), "{command}");
        }
    }
}

//! Plans that touch their limits, on the shipped and on real terrains: without errors they hold to the last digit.

use std::path::{Path, PathBuf};

use chta::{
    ballistics::TakeoffChoice,
    graph::{PointSpacing, SearchOptions},
    terrain::read_dem,
    uncertainty::{Policy, TrialOptions, TrialOutcome, Uncertainty},
    world::{Body, Hopper, HopperLimits},
};

use super::{
    plans::exactly_planned,
    scene::{Scene, friction},
};

fn hopper() -> Hopper {
    Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(10.0, 10.0) }).unwrap()
}

fn scene(file: &Path, body: &str, ends: [(f64, f64); 2], spacing_m: f64, takeoff: TakeoffChoice) -> Scene {
    let gravity_m_s2 = Body::named(body).unwrap().gravity.m_s2();
    let mut scene = Scene::of_dem(read_dem(file).unwrap(), ends, hopper(), friction(0.6), gravity_m_s2);
    scene.options = SearchOptions { spacing: Some(PointSpacing::AtMostM(spacing_m)), takeoff, ..SearchOptions::default() };
    scene
}

/// Every choice of angle: the least speed lies on the border of a cone that forbids 45 degrees, the least time on a vertex.
fn holds(file: &Path, body: &str, ends: [(f64, f64); 2], spacing_m: f64) {
    for takeoff in TakeoffChoice::ALL {
        let scene = scene(file, body, ends, spacing_m, takeoff);
        let planned = scene.planned();
        for policy in Policy::ALL {
            exactly_planned(&planned, policy);
        }
        let chain_alone = planned.chain_mission();
        let options = TrialOptions { trials: 1, goal_tolerance_m: 0.0, ..TrialOptions::default() };
        let summary =
            chta::uncertainty::Simulation::new(&chain_alone, Uncertainty::NONE).unwrap().run(&options, &mut (), &()).unwrap();
        assert_eq!(summary.outcomes.of(TrialOutcome::Reached), 1, "{takeoff:?} along the chain: {:?}", summary.outcomes);
    }
}

#[test]
fn plans_on_shipped_terrains_hold_without_errors() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/terrain");
    holds(&data.join("mars_crater_field.tif"), "mars", [(12.0, 84.0), (176.0, 30.0)], 1.0);
    // Along a row, a column and a diagonal of posts.
    holds(&data.join("mars_crater_field.tif"), "mars", [(12.0, 84.0), (60.0, 84.0)], 2.0);
    holds(&data.join("mars_crater_field.tif"), "mars", [(12.0, 84.0), (12.0, 40.0)], 2.0);
    holds(&data.join("mars_crater_field.tif"), "mars", [(12.0, 84.0), (50.0, 46.0)], 2.0);
    holds(&data.join("lunar_rille.tif"), "moon", [(380.0, 90.0), (340.0, 260.0)], 4.0);
}

/// A file of ../shared/dem; `None` with a printed reason if it is absent.
fn real(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
    if path.exists() {
        return Some(path);
    }
    #[expect(clippy::print_stderr, reason = "a skipped test says why")]
    {
        eprintln!("skipped: {} is absent", path.display());
    }
    None
}

#[test]
fn plans_on_real_terrains_hold_without_errors() {
    if let Some(mars) = real("hirise_DTEEC_010228_1490_crop_120x70.tif") {
        holds(&mars, "mars", [(5.0, 20.0), (60.0, 100.0)], 1.0);
    }
    if let Some(moon) = real("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif") {
        holds(&moon, "moon", [(75_700.0, 39_000.0), (76_000.0, 39_100.0)], 5.0);
        holds(&moon, "moon", [(76_600.0, 38_400.0), (76_000.0, 39_000.0)], 10.0);
    }
}

//! Bounds on slices of both real DEMs: how many are equal within the budget; each open one is printed with its seed and gap.
//!
//! The files are read from ../shared/dem; a test without its file prints why it is skipped.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(clippy::print_stdout, reason = "skipped DEMs and open slices are printed")]

use std::{path::PathBuf, time::Instant};

use crate::support::Draw;
use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, PolygonalChain, Station},
    graph::{
        Outcome, is_usable,
        proof::{BoundsOptions, DEFAULT_BUDGET_CELLS, ProofVerdict, bounds},
    },
    hop::{HopTest, Split},
    path::{execute, generate},
    quantity::MapPoint,
    terrain::{Dem, read_dem, slice},
    world::{Body, Contact, FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// The real DEMs with their bodies.
const DEMS: [(&str, &str); 2] =
    [("hirise_DTEEC_010228_1490_crop_120x70.tif", "mars"), ("lola5m_Shoemaker_final_adj_5mpp_surf_1k.tif", "moon")];

/// A real DEM; `None` with a printed reason if it is absent.
fn real(name: &str) -> Option<Dem> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/dem").join(name);
    if !path.exists() {
        println!("skipped: {} is absent", path.display());
        return None;
    }
    Some(read_dem(&path).unwrap())
}

/// A slice with a bounded number of segments between two positions drawn from a seed, and a hopper to cross it.
fn drawn_chain(dem: &Dem, gravity: Gravity, seed: u64, most_segments: usize) -> ConstrainedChain {
    let draw = &mut Draw::seeded(seed);
    let area = dem.georeference().bounds(dem.rows(), dem.cols());
    let mut point = || MapPoint::new(draw.uniform(area.min.x, area.max.x), draw.uniform(area.min.y, area.max.y));
    let (from, mut to) = (point(), point());
    let mut profile = slice(dem, from, to).unwrap();
    while profile.facets.len() > most_segments {
        to = from + (to - from) * 0.9;
        profile = slice(dem, from, to).unwrap();
    }
    let speed_m_s = draw.uniform(4.0, 12.0);
    let hopper = Hopper::new(HopperLimits { clearance_m: 0.1, ..HopperLimits::with_speeds(speed_m_s, speed_m_s) }).unwrap();
    let friction = FrictionCone::new(draw.uniform(0.5, 1.0)).unwrap();
    let surface = SurfaceProperties { grip: Some(Grip::Friction(friction)), rest: RestSlope::AsFrictionHolds };
    let chain = PolygonalChain::from_profile(&profile, Some(friction)).unwrap();
    ConstrainedChain::new(chain, &hopper, gravity, &surface).unwrap()
}

/// The first and the last of a chain's segment midpoints at which a contact is allowed: the journey should be long and not refused
/// at its ends.
fn usable_ends(chain: &ConstrainedChain) -> Option<(Station, Station)> {
    let middles = chain.geometry().vertices().windows(2).map(|v| 0.5 * (v[0].x_m + v[1].x_m));
    let stations: Vec<_> = middles.map(|x_m| chain.geometry().station(x_m).unwrap()).collect();
    let start = stations.iter().find(|station| is_usable(chain, station, Contact::Takeoff))?;
    let goal = stations.iter().rev().find(|station| is_usable(chain, station, Contact::Landing))?;
    Some((*start, *goal))
}

/// Bounds on a number of slices of each DEM; prints the open ones and returns how many there are.
fn left_open(slices: u64) -> usize {
    let mut open = 0;
    for (name, body) in DEMS {
        let Some(dem) = real(name) else { continue };
        let (mut found_none, mut slowest) = (0, 0.0f64);
        for seed in 0..slices {
            let chain = drawn_chain(&dem, Body::named(body).unwrap().gravity, seed, 200);
            let test = HopTest::new(chain.clone());
            let Some((start, goal)) = usable_ends(&chain) else { continue };
            let began = Instant::now();
            let found = bounds(&test, start, goal, &BoundsOptions::default(), &()).unwrap();
            let took_s = began.elapsed().as_secs_f64();
            slowest = slowest.max(took_s);
            assert!(found.summary.cells <= DEFAULT_BUDGET_CELLS, "{name} seed {seed}: {:?}", found.summary);
            if let Outcome::Path { legs, .. } = &found.answer.outcome {
                let path = generate(&test, legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
                let execution = execute(&chain, &path, Some((start, goal)));
                assert!(execution.passes(), "{name} seed {seed}: {:?}", execution.violations);
            }
            if found.verdict() == ProofVerdict::Untraversable {
                found_none += 1;
            }
            let is_open = !found.is_proved();
            open += usize::from(is_open);
            if is_open || took_s > 2.0 {
                println!(
                    "{name} seed {seed}: {}, {} segments, lower {:?}, upper {:?}, {:?}, {took_s:.2} s",
                    if is_open { "open" } else { "slow" },
                    chain.segments().len(),
                    found.lower,
                    found.upper(),
                    found.summary
                );
            }
        }
        println!("{name}: {slices} slices, {found_none} untraversable, slowest {slowest:.2} s");
    }
    open
}

#[test]
fn bounds_meet_on_slices_of_both_real_dems() {
    let open = left_open(12);
    assert!(open <= 1, "{open} of 24 left open");
}

/// The complete count: `cargo test --release --test library proof_terrain -- --ignored --nocapture`.
#[test]
#[ignore = "the long run: 400 slices"]
fn bounds_meet_on_four_hundred_slices_of_both_real_dems() {
    let open = left_open(200);
    assert!(open <= 10, "{open} of 400 left open");
}

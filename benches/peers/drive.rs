//! One drive map over a raster of 32-bit elevations, timed: the part of chta in `drive_run.py`.
//!
//! ```text
//! peers_drive ELEVATIONS SIDE SPACING NEIGHBOURS SLOPE_MAX_DEG COSTS
//! ```
//!
//! Prints the least of five times of legs and of the map, s, and how many posts are reached. Writes the time to every post, 64-bit floats.

#![allow(clippy::print_stdout, reason = "its result")]

use std::{env, error::Error, fs, time::Instant};

use chta::{
    drive::{DriveAmount, DriveEdges, DriveGround, DriveMap, DriveSense},
    ground::{DemGround, NodeLattice},
    quantity::{Angle, MapPoint},
    terrain::{Dem, GeoReference, OverlaidDem, Overlays},
    world::{Gravity, Hopper, Neighbours, RestSlope, Rover, RoverLimits, SurfaceProperties},
};

const USAGE: &str = "expected: peers_drive ELEVATIONS SIDE SPACING NEIGHBOURS SLOPE_MAX_DEG COSTS";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [elevations, side, spacing, neighbours, slope, out] = arguments.as_slice() else { return Err(USAGE.into()) };
    let (side, spacing_m, slope_deg): (usize, f64, f64) = (side.parse()?, spacing.parse()?, slope.parse()?);
    let bytes = fs::read(elevations)?;
    let heights = bytes.chunks_exact(4).map(|value| f32::from_le_bytes([value[0], value[1], value[2], value[3]])).collect();
    let dem = Dem::from_single(side, side, heights, GeoReference::local(MapPoint::new(0.0, 0.0), spacing_m, spacing_m)?)?;
    let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    let terrain = OverlaidDem::new(dem, Overlays::default());
    let ground = DemGround::new(terrain, &Hopper::with_speeds(1.0, 1.0)?, Gravity::new(1.62)?, &surface);
    let limits = RoverLimits {
        neighbours: Neighbours::of_count(neighbours.parse()?).ok_or(USAGE)?,
        ..RoverLimits::new(1.0, Angle::from_degrees(slope_deg))
    };
    let rover = Rover::new(limits, None)?;
    let drive = DriveGround::new(&ground, &rover);
    let lattice = NodeLattice::new(ground.terrain().dem(), 1);
    let middle = side / 2 * side + side / 2;
    let (mut legs_s, mut map_s, mut found) = (f64::INFINITY, f64::INFINITY, None);
    for _ in 0..5 {
        let began = Instant::now();
        let edges = DriveEdges::new(&drive, lattice, DriveAmount::Time, &())?;
        let judged = Instant::now();
        let map = DriveMap::new(&edges, &[middle], DriveSense::From, &())?;
        legs_s = legs_s.min((judged - began).as_secs_f64());
        map_s = map_s.min(judged.elapsed().as_secs_f64());
        found = Some(map);
    }
    let map = found.ok_or(USAGE)?;
    fs::write(out, map.costs().iter().flat_map(|cost| cost.to_le_bytes()).collect::<Vec<u8>>())?;
    println!("{legs_s} {map_s} {}", map.reached());
    Ok(())
}

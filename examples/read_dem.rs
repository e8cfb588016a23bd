//! Reads a whole DEM and prints its size, elevations and bounds: `cargo run --release --example read_dem -- crater.tif`.
#![expect(clippy::print_stdout, reason = "a program that prints")]

use std::error::Error;
use std::time::Instant;

use chta::terrain::read_dem;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("expected the path of a DEM: read_dem FILE")?;
    let begin = Instant::now();
    let dem = read_dem(path.as_ref())?;
    let took = begin.elapsed();
    let (low_m, high_m) = dem.elevation_range_m();
    println!("{} rows, {} columns, {low_m} to {high_m} m, {}", dem.rows(), dem.cols(), dem.bounds());
    println!("read in {:.3} s", took.as_secs_f64());
    Ok(())
}

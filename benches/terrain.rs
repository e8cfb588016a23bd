//! How long it takes to read a DEM, to cut it, and to make one up.
#![expect(clippy::unwrap_used, reason = "a bench may panic")]

use chta::quantity::MapPoint;
use chta::terrain::{
    Dem, SyntheticTerrain, geotiff_bytes, read_ascii_grid_bytes, read_geotiff_bytes, slice, synthesise, write_ascii_grid,
};
use divan::{Bencher, black_box};

fn main() {
    divan::main();
}

fn square(side: usize) -> Dem {
    synthesise(&SyntheticTerrain { rows: side, cols: side, ..SyntheticTerrain::default() }).unwrap()
}

#[divan::bench(args = [256, 1024])]
fn read_geotiff(bencher: Bencher<'_, '_>, side: usize) {
    let bytes = geotiff_bytes(&square(side)).unwrap();
    bencher.with_inputs(|| bytes.clone()).bench_values(|bytes| read_geotiff_bytes(bytes).unwrap());
}

#[divan::bench(args = [256, 1024])]
fn read_ascii_grid(bencher: Bencher<'_, '_>, side: usize) {
    let mut text = Vec::new();
    write_ascii_grid(&square(side), &mut text).unwrap();
    bencher.bench(|| read_ascii_grid_bytes(black_box(&text)).unwrap());
}

#[divan::bench(args = [256, 1024])]
fn write_geotiff(bencher: Bencher<'_, '_>, side: usize) {
    let dem = square(side);
    bencher.bench(|| geotiff_bytes(black_box(&dem)).unwrap());
}

#[divan::bench(args = [30, 300, 1000])]
fn slice_across(bencher: Bencher<'_, '_>, length_m: u32) {
    let dem = square(1024);
    let (from, length_m) = (MapPoint::new(5.3, 4.9), f64::from(length_m));
    let to = MapPoint::new(from.x + 0.8 * length_m, from.y + 0.6 * length_m);
    bencher.bench(|| slice(black_box(&dem), from, to).unwrap());
}

#[divan::bench(args = [128, 512], sample_count = 10)]
fn make_up(side: usize) -> Dem {
    square(side)
}

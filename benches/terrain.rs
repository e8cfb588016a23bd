//! The time to read, slice and synthesise a DEM.
#![expect(clippy::unwrap_used, reason = "a bench may panic")]

use chta::quantity::MapPoint;
use chta::terrain::{
    Dem, Mesh, SyntheticTerrain, geotiff_bytes, read_ascii_grid_bytes, read_geotiff_bytes, read_mesh_bytes, slice, slice_mesh,
    synthesise, write_ascii_grid,
};
use divan::{Bencher, black_box};
use nalgebra::Point3;

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

/// The posts of a square DEM as a mesh of 2 (side - 1)^2 triangles.
fn triangulated(side: usize) -> Mesh {
    let dem = square(side);
    let vertex = |index: usize| {
        let (row, col) = (index / side, index % side);
        let map = dem.georeference().post(row, col);
        Point3::new(map.x, map.y, dem.elevation(row, col).unwrap())
    };
    let side_u32 = u32::try_from(side).unwrap();
    let squares = (0..(side_u32 - 1).pow(2)).map(|i| i % (side_u32 - 1) + side_u32 * (i / (side_u32 - 1)));
    let triangles = squares.flat_map(|a| [[a, a + 1, a + side_u32 + 1], [a, a + side_u32, a + side_u32 + 1]]);
    Mesh::new((0..side * side).map(vertex).collect(), triangles.collect()).unwrap()
}

/// 50 and 500 thousand triangles.
#[divan::bench(args = [160, 500])]
fn slice_mesh_across(bencher: Bencher<'_, '_>, side: u32) {
    let mesh = triangulated(side as usize);
    let (from, to) = (MapPoint::new(5.3, 4.9), MapPoint::new(f64::from(side) - 8.1, f64::from(side) - 17.7));
    bencher.bench(|| slice_mesh(black_box(&mesh), from, to).unwrap());
}

/// A binary STL of 50 thousand triangles.
#[divan::bench]
fn read_stl(bencher: Bencher<'_, '_>) {
    let mesh = triangulated(160);
    let mut bytes = vec![0; 80];
    bytes.extend(u32::try_from(mesh.triangle_count()).unwrap().to_le_bytes());
    for corners in mesh.triangles() {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flat_map(|corner| corner.iter()).flat_map(|&value| single(value).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bencher.bench(|| read_mesh_bytes(black_box(&bytes), 1.0).unwrap());
}

#[expect(clippy::cast_possible_truncation, reason = "an STL stores 32-bit numbers")]
fn single(value: f64) -> f32 {
    value as f32
}

#[divan::bench(args = [128, 512], sample_count = 10)]
fn make_up(side: usize) -> Dem {
    square(side)
}

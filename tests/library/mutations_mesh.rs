//! The readers of meshes with seeded mutations: no panic, no endless run, and what is still read can be sliced.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and prints its counts")]

use std::fmt::Write;

use crate::mutations::rounds;
use chta::quantity::MapPoint;
use chta::terrain::{read_mesh_bytes, slice_mesh};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// A grid of 5 x 4 vertices and its triangles.
fn grid() -> (Vec<[f32; 3]>, Vec<[u8; 3]>) {
    let vertices = (0..20_u8).map(|i| [f32::from(i % 5), f32::from(i / 5), f32::from(u16::from(i).pow(2) % 7) * 0.25]).collect();
    let squares = (0..12_u8).map(|i| i % 4 + 5 * (i / 4));
    (vertices, squares.flat_map(|a| [[a, a + 1, a + 6], [a, a + 6, a + 5]]).collect())
}

pub(crate) fn obj() -> Vec<u8> {
    let (vertices, triangles) = grid();
    let mut text = "# grid\no grid\n".to_owned();
    for [x, y, z] in vertices {
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner + 1);
        writeln!(text, "f {a} {b}/1 {c}//2").unwrap();
    }
    text.into_bytes()
}

pub(crate) fn binary_stl() -> Vec<u8> {
    let (vertices, triangles) = grid();
    let mut bytes = vec![b'-'; 80];
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        bytes.extend(corners.iter().flat_map(|corner| vertices[usize::from(*corner)]).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

pub(crate) fn ascii_stl() -> Vec<u8> {
    let (vertices, triangles) = grid();
    let mut text = "solid grid\n".to_owned();
    for corners in triangles {
        text.push_str("facet normal 0 0 1\nouter loop\n");
        for corner in corners {
            let [x, y, z] = vertices[usize::from(corner)];
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text.push_str("endloop\nendfacet\n");
    }
    (text + "endsolid grid\n").into_bytes()
}

pub(crate) fn ply(binary: bool) -> Vec<u8> {
    let (vertices, triangles) = grid();
    let format = if binary { "binary_little_endian" } else { "ascii" };
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    for [x, y, z] in vertices {
        if binary {
            bytes.extend([x, y, z].iter().flat_map(|value| value.to_le_bytes()));
        } else {
            bytes.extend(format!("{x} {y} {z}\n").bytes());
        }
    }
    for [a, b, c] in triangles {
        if binary {
            bytes.push(3);
            bytes.extend([a, b, c].iter().flat_map(|corner| i32::from(*corner).to_le_bytes()));
        } else {
            bytes.extend(format!("3 {a} {b} {c}\n").bytes());
        }
    }
    bytes
}

/// One to six changes: bits, bytes, special numbers, cuts, copies.
fn mutate(whole: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let alphabet = b"0123456789.,-+eE nNaA\n\r\t/\\#vf\x00\x01\xff";
    let mut bytes = whole.to_vec();
    for _ in 0..random.random_range(1..=6) {
        if bytes.is_empty() {
            break;
        }
        let at = random.random_range(0..bytes.len());
        let length = random.random_range(0..=(bytes.len() - at).min(16));
        match random.random_range(0..7) {
            0 => bytes[at] ^= 1 << random.random_range(0..8),
            1 => bytes[at] = random.random(),
            2 | 3 => bytes[at] = alphabet[random.random_range(0..alphabet.len())],
            4 => {
                let value: u32 = [0, 1, 3, 0xffff, 0x7f80_0000, 0x7fff_ffff, 0xffff_ffff][random.random_range(0..7)];
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&value.to_le_bytes()[..end - at]);
            }
            5 => {
                let copy = bytes[at..at + length].to_vec();
                let to = random.random_range(0..bytes.len());
                bytes.splice(to..to, copy);
            }
            _ if random.random_range(0..4) == 0 => bytes.truncate(at),
            _ => drop(bytes.drain(at..at + length)),
        }
    }
    bytes
}

fn check(name: &str, whole: &[u8]) {
    let mesh = read_mesh_bytes(whole, 1.0).unwrap().mesh;
    assert_eq!(mesh.triangle_count(), 24, "{name}");
    let (from, to) = (MapPoint::new(0.25, 0.5), MapPoint::new(3.75, 2.5));
    let profile = slice_mesh(&mesh, from, to).unwrap().profile;
    assert!(profile.points.len() > 8);
    let mut random = ChaCha8Rng::seed_from_u64(20_261_122);
    let rounds = rounds();
    let (mut read_well, mut sliced) = (0, 0);
    for number in 0..rounds {
        let bytes = mutate(whole, &mut random);
        match read_mesh_bytes(&bytes, 1.0) {
            Ok(file) => {
                read_well += 1;
                match slice_mesh(&file.mesh, from, to) {
                    Ok(slice) => {
                        sliced += 1;
                        assert!(slice.profile.points.windows(2).all(|pair| pair[0].x_m < pair[1].x_m));
                        assert!(slice.profile.points.iter().all(|point| point.z_m.is_finite() && point.z_m.abs() < 1e9));
                    }
                    Err(error) => assert!(!error.to_string().is_empty()),
                }
            }
            Err(error) => {
                let message = error.to_string();
                assert!(!message.is_empty() && message.len() < 2_000, "mutation {number}: {message}");
            }
        }
    }
    assert!(read_well > 0 && read_well < rounds && sliced > 0, "{read_well} {sliced}");
    eprintln!("{name}: {read_well} of {rounds} mutations still read, {sliced} sliced");
}

#[test]
fn mutated_objs_never_panic() {
    check("OBJ", &obj());
}

/// The squares of the grid joined to faces of eight corners, some of which are not convex where their heights differ.
#[test]
fn mutated_objs_with_concave_faces_never_panic() {
    let text = String::from_utf8(obj()).unwrap();
    let (vertices, _) = text.split_at(text.find("f ").unwrap());
    let mut faces = String::new();
    for row in 0..3 {
        let at = |col: u32, line: u32| 1 + col + 5 * line;
        // Two squares in a row form a face of six corners, an L of three squares one of eight.
        writeln!(faces, "f {} {} {} {} {} {}", at(0, row), at(1, row), at(2, row), at(2, row + 1), at(1, row + 1), at(0, row + 1))
            .unwrap();
        writeln!(faces, "f {} {} {} {} {}", at(2, row), at(4, row), at(4, row + 1), at(3, row), at(2, row + 1)).unwrap();
    }
    let whole = format!("{vertices}{faces}").into_bytes();
    let mut random = ChaCha8Rng::seed_from_u64(20_261_123);
    let (rounds, mut read_well) = (rounds(), 0);
    for _ in 0..rounds {
        match read_mesh_bytes(&mutate(&whole, &mut random), 1.0) {
            Ok(_) => read_well += 1,
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    eprintln!("concave OBJ: {read_well} of {rounds} mutations still read");
}

#[test]
fn mutated_stls_never_panic() {
    check("binary STL", &binary_stl());
    check("ASCII STL", &ascii_stl());
}

#[test]
fn mutated_plys_never_panic() {
    check("ASCII PLY", &ply(false));
    check("binary PLY", &ply(true));
}

#[test]
fn all_formats_of_one_mesh_give_the_same_slice() {
    let slice = |bytes: &[u8]| {
        let mesh = read_mesh_bytes(bytes, 2.5).unwrap().mesh;
        slice_mesh(&mesh, MapPoint::new(0.3, 7.0), MapPoint::new(9.1, 0.4)).unwrap()
    };
    let expected = slice(&obj());
    for other in [binary_stl(), ascii_stl(), ply(false), ply(true)] {
        assert_eq!(slice(&other), expected);
    }
}

use super::*;

const HEADER: &str = "ply\nformat ascii 1.0\ncomment ours\nelement vertex 4\nproperty float x\nproperty double y\nproperty uchar red\n\
    property float z\nelement other 1\nproperty list uchar int what\nelement face 1\nproperty list uchar int vertex_indices\n\
    property float quality\nend_header\n";
const BODY: &str = "0 0 255 0.5\n1 0 255 1.5\n1 1 0 0.5\n0 1 0 0.5\n2 7 8\n4 0 1 2 3 0.25\n";

/// Vertices and triangles.
type Parts = (Vec<nalgebra::Point3<f64>>, Vec<[u32; 3]>);

fn mesh(bytes: &[u8]) -> Result<Parts, String> {
    let mut builder = MeshBuilder::new(1.0);
    read(bytes, &mut builder).map_err(|error| error.to_string())?;
    builder.finish().map(|(mesh, _)| (mesh.vertices().to_vec(), mesh.indices().to_vec())).map_err(|error| error.to_string())
}

/// The same in binary.
fn binary(big: bool) -> Vec<u8> {
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = HEADER.replace("ascii", name).into_bytes();
    let push = |bytes: &mut Vec<u8>, little: &[u8]| {
        let mut little = little.to_vec();
        if big {
            little.reverse();
        }
        bytes.extend(little);
    };
    for (x, y, z) in [(0.0_f32, 0.0_f64, 0.5_f32), (1.0, 0.0, 1.5), (1.0, 1.0, 0.5), (0.0, 1.0, 0.5)] {
        push(&mut bytes, &x.to_le_bytes());
        push(&mut bytes, &y.to_le_bytes());
        bytes.push(255);
        push(&mut bytes, &z.to_le_bytes());
    }
    for list in [&[7_i32, 8][..], &[0, 1, 2, 3]] {
        bytes.push(u8::try_from(list.len()).unwrap());
        for value in list {
            push(&mut bytes, &value.to_le_bytes());
        }
    }
    push(&mut bytes, &0.25_f32.to_le_bytes());
    bytes
}

#[test]
fn text_and_both_byte_orders_give_the_same_mesh() {
    let text = mesh(format!("{HEADER}{BODY}").as_bytes()).unwrap();
    assert_eq!(text.0[1], nalgebra::Point3::new(1.0, 0.0, 1.5));
    assert_eq!(text.1, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh(&binary(false)).unwrap(), text);
    assert_eq!(mesh(&binary(true)).unwrap(), text);
    for end in ["\r\n", "\r"] {
        assert_eq!(mesh(format!("{HEADER}{BODY}").replace('\n', end).as_bytes()).unwrap(), text);
        for big in [false, true] {
            let header = HEADER.replace("ascii", if big { "binary_big_endian" } else { "binary_little_endian" });
            let body = binary(big)[header.len()..].to_vec();
            let bytes = [header.replace('\n', end).into_bytes(), body].concat();
            assert!(recognises(&bytes));
            assert_eq!(mesh(&bytes).unwrap(), text, "{end:?} {big}");
        }
    }
}

#[test]
fn counts_that_the_file_cannot_hold_are_refused_at_once() {
    for (from, to, expected) in [
        ("vertex 4", "vertex 4000000000", "promises 4000000000 of element 'vertex'"),
        ("vertex 4", "vertex 18446744073709551615", "promises"),
        ("face 1", "face 99", "promises 99 of element 'face'"),
        ("vertex 4", "vertex 5", "row 1: found a list of 1 values"),
        ("element other 1\nproperty list uchar int what", "element other 4000000000", "no properties"),
    ] {
        let text = format!("{HEADER}{BODY}").replace(from, to);
        let message = mesh(text.as_bytes()).unwrap_err();
        assert!(message.contains(expected) || from == "vertex 4", "{to}: {message}");
        assert!(mesh(&String::from_utf8_lossy(&binary(false)[..HEADER.len() + 40]).replace(from, to).into_bytes()).is_err());
    }
    let list = format!("{HEADER}{}", BODY.replace("4 0 1 2 3", "4000000000 0 1 2 3"));
    assert!(mesh(list.as_bytes()).unwrap_err().contains("list of 4000000000 values"));
    let whole = binary(true);
    for end in (0..whole.len()).step_by(3) {
        assert!(mesh(&whole[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn faults_are_named() {
    for (from, to, expected) in [
        ("ascii 1.0", "ascii 2.0", "line 2"),
        ("ascii 1.0", "binary 1.0", "found the format 'binary'"),
        ("format ascii 1.0\n", "", "without a line 'format'"),
        ("property float z", "property float w", "no property z"),
        ("property float z", "property quad z", "the type 'quad'"),
        ("property float z", "property list uchar float z", "no property z"),
        ("vertex_indices", "corners", "no list vertex_indices"),
        ("int vertex_indices", "float vertex_indices", "holds fractions"),
        ("uchar int vertex_indices", "float int vertex_indices", "count is a fraction"),
        ("element face", "element tristrips", "triangle strips"),
        ("1 0 255 1.5", "1 0 255 nan", "vertex 2 of the PLY"),
        ("1 0 255 1.5", "1 0 255 high", "found 'high', expected a number"),
        ("4 0 1 2 3", "4 0 1 2 4", "face 1 of the PLY: found a face with vertex 5"),
        ("4 0 1 2 3", "4 0 1 2 -1", "face 1 of the PLY: found the vertex -1"),
        ("4 0 1 2 3", "2 0 1", "face 1 of the PLY: found a face of 2 corners"),
        ("4 0 1 2 3", "-4 0 1 2 3", "list of -4 values"),
        ("end_header\n", "", "expected a line of a header"),
    ] {
        let text = format!("{HEADER}{BODY}").replace(from, to);
        let message = mesh(text.as_bytes()).unwrap_err();
        assert!(message.contains("PLY") && message.contains(expected), "{to}: {message}");
    }
}

//! Sound files that are not read as they stand: each is named, with a command that makes a readable one, and never called
//! damaged. Where GDAL is installed, the command is run and the result compared with the elevations that were written.
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "a test may panic, and says why it skips")]

use std::path::Path;
use std::process::Command;

use crate::tiff::int16_tiff;
use chta::terrain::{read_dem, read_geotiff_bytes, read_mesh_bytes};

use crate::installed::has_gdal;

/// Tags and their values in TIFF 6.0 and libtiff; what is named.
#[test]
fn tiffs_in_encodings_that_are_not_decoded_are_named() {
    const COMPRESSION: u16 = 259;
    const BITS: u16 = 258;
    const FORMAT: u16 = 339;
    const PREDICTOR: u16 = 317;
    const PHOTOMETRIC: u16 = 262;
    type Changed = &'static [(u16, u16, u16)];
    let table: [(Changed, &str); 26] = [
        (&[(COMPRESSION, 3, 2)], "CCITT run-length"),
        (&[(COMPRESSION, 3, 3)], "CCITT fax 3"),
        (&[(COMPRESSION, 3, 4)], "CCITT fax 4"),
        (&[(COMPRESSION, 3, 6)], "old JPEG"),
        (&[(COMPRESSION, 3, 7)], "JPEG compression (TIFF code 7)"),
        (&[(COMPRESSION, 3, 34712)], "JPEG 2000"),
        (&[(COMPRESSION, 3, 34925)], "LZMA"),
        (&[(COMPRESSION, 3, 50001)], "WebP"),
        (&[(COMPRESSION, 3, 50002)], "JPEG XL"),
        (&[(COMPRESSION, 3, 4711)], "not known here (TIFF code 4711)"),
        (&[(FORMAT, 3, 3), (BITS, 3, 16)], "floats of 16 bits"),
        (&[(FORMAT, 3, 3), (BITS, 3, 24)], "floats of 24 bits"),
        (&[(FORMAT, 3, 1), (BITS, 3, 24)], "unsigned integers of 24 bits"),
        (&[(FORMAT, 3, 1), (BITS, 3, 20)], "unsigned integers of 20 bits"),
        (&[(FORMAT, 3, 2), (BITS, 3, 12)], "signed integers of 12 bits"),
        (&[(FORMAT, 3, 2), (BITS, 3, 4)], "signed integers of 4 bits"),
        (&[(FORMAT, 3, 5), (BITS, 3, 32)], "complex numbers of 32 bits"),
        (&[(FORMAT, 3, 6), (BITS, 3, 64)], "complex numbers of 64 bits"),
        (&[(FORMAT, 3, 3), (BITS, 3, 128)], "samples of 128 bits"),
        (&[(FORMAT, 3, 9)], "sample format 9"),
        (&[(PREDICTOR, 3, 3)], "the predictor of floats (predictor 3)"),
        (&[(PREDICTOR, 3, 7)], "not known here (predictor 7)"),
        (&[(PREDICTOR, 3, 2), (FORMAT, 3, 1), (BITS, 3, 12)], "samples of 12 bits stored with horizontal differences"),
        (&[(PHOTOMETRIC, 3, 32803)], "photometric interpretation 32803"),
        (&[(PHOTOMETRIC, 3, 4)], "transparency mask"),
        (&[(284, 3, 3)], "planar configuration 3"),
    ];
    for (changed, expected) in table {
        let message = read_geotiff_bytes(int16_tiff(changed)).unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("mend it with:"), "{changed:?}: {message}");
        assert!(!message.contains("damaged"), "{changed:?}: {message}");
    }
}

fn run(program: &str, arguments: &[&str]) -> bool {
    match Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", "NO").output() {
        Ok(output) => output.status.success(),
        Err(_) => false,
    }
}

/// The mending line of every message, run by the shell on the file that it is about.
#[test]
fn the_commands_for_sound_tiffs_give_the_elevations_that_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let name = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let row = |row: u32| (0..8).map(|col| ((row * 3 + col * 5) % 17).to_string()).collect::<Vec<_>>().join(" ");
    let rows: Vec<String> = (0..9).map(row).collect();
    let text = format!("ncols 8\nnrows 9\nxllcorner 1000\nyllcorner 2000\ncellsize 1\n{}\n", rows.join("\n"));
    std::fs::write(name("grid.asc"), &text).unwrap();
    if !has_gdal() {
        return;
    }
    let truth: Vec<Option<f64>> = read_dem(Path::new(&name("grid.asc"))).unwrap().elevations().collect();
    for (options, expected) in [
        ("-ot Float32 -co NBITS=16", "floats of 16 bits"),
        ("-ot Float32 -co COMPRESS=LZMA", "LZMA"),
        ("-ot Int16 -co COMPRESS=LZMA -co PREDICTOR=2", "LZMA"),
        ("-ot UInt32 -co NBITS=24", "24 bits"),
        ("-ot UInt32 -co NBITS=20", "20 bits"),
        ("-ot CFloat32", "complex"),
        ("-ot CInt16", "complex"),
        ("-ot Float64 -co COMPRESS=LERC", ""),
        ("-ot Float32 -co COMPRESS=LERC_ZSTD", ""),
        ("-ot Int16 -co COMPRESS=LERC_DEFLATE", ""),
    ] {
        let (made, mended) = (name("in.tif"), name("out.tif"));
        let mut arguments = vec!["-q"];
        arguments.extend(options.split(' '));
        let source = name("grid.asc");
        arguments.extend([source.as_str(), made.as_str()]);
        if !run("gdal_translate", &arguments) {
            eprintln!("skipped: this GDAL does not write {options}");
            continue;
        }
        let read = read_dem(Path::new(&made));
        let dem = if expected.is_empty() {
            read.unwrap_or_else(|error| panic!("{options}: {error}"))
        } else {
            let message = read.unwrap_err().to_string();
            assert!(message.contains(expected) && !message.contains("damaged"), "{options}: {message}");
            let command = message.split("mend it with: ").nth(1).unwrap().split(',').next().unwrap();
            let words: Vec<String> =
                command.split(' ').map(|word| word.replace("in.tif", &made).replace("out.tif", &mended)).collect();
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            assert!(run(words[0], &words[1..]), "{command}");
            read_dem(Path::new(&mended)).unwrap_or_else(|error| panic!("{options}: {error}"))
        };
        assert!(dem.elevations().eq(truth.iter().copied()), "{options}");
        let _ = std::fs::remove_file(&mended);
        std::fs::remove_file(&made).unwrap();
    }
}

/// Meshes as modelling programs write them; the truth is the number of triangles and, for concave faces, their area.
#[test]
fn meshes_that_other_programs_read_are_read() {
    let mut titled = crate::mutations_mesh::binary_stl();
    titled[..21].copy_from_slice(b"solid by a CAD system");
    let more = |tail: &[u8]| [titled.clone(), tail.to_vec()].concat();
    let dart = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 1 0\n";
    let ply_dart = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                    property list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n4 4 0\n3 1 0\n4 0 1 2 3\n";
    for (name, bytes, triangles, warning) in [
        ("titled solid", titled.clone(), 24, ""),
        ("a line feed after the last triangle", more(b"\n"), 24, "1 byte left out"),
        ("a block of zeros after the last triangle", more(&[0; 512]), 24, "512 bytes left out"),
        ("concave OBJ", format!("{dart}f 1 2 3 4\n").into_bytes(), 2, "1 of these faces are not convex"),
        ("concave OBJ from behind", format!("{dart}f -2 -3 -4 -1\n").into_bytes(), 2, "not convex"),
        ("concave PLY", ply_dart.as_bytes().to_vec(), 2, "not convex"),
        ("PLY with returns", ply_dart.replace('\n', "\r").into_bytes(), 2, "not convex"),
        ("PLY with a mark", format!("\u{feff}{ply_dart}").into_bytes(), 2, "not convex"),
        ("OBJ with returns", format!("{dart}f 1 2 3 4\n").replace('\n', "\r").into_bytes(), 2, "not convex"),
    ] {
        let file = read_mesh_bytes(&bytes, 1.0).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(file.mesh.triangle_count(), triangles, "{name}");
        let said = file.warnings.join("; ");
        assert!(said.contains(warning) && said.is_empty() == warning.is_empty(), "{name}: {said}");
        if name.contains("concave") {
            // (0, 0), (4, 0), (4, 4), (3, 1): 4 by the shoelace formula.
            let area: f64 = file.mesh.triangles().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum();
            assert!((area - 4.0).abs() < 1e-12, "{name}: {area}");
        }
    }
    let cut = read_mesh_bytes(&titled[..1000], 1.0).unwrap_err().to_string();
    assert!(cut.contains("binary STL is damaged") && cut.contains("24 triangles in 1284 bytes, but the file has 1000"), "{cut}");
}

/// A TIFF of 3 rows and 4 columns of 16-bit integers 10 row + column, in two strips of `PackBits`, of which the last holds some rows:
/// classic or `BigTIFF`, in either byte order.
fn two_strips(big: bool, little: bool, last_rows: usize) -> Vec<u8> {
    let two = |value: u16| if little { value.to_le_bytes() } else { value.to_be_bytes() }.to_vec();
    let four = |value: u32| if little { value.to_le_bytes() } else { value.to_be_bytes() }.to_vec();
    let eight = |value: u64| if little { value.to_le_bytes() } else { value.to_be_bytes() }.to_vec();
    let strip = |rows: std::ops::Range<usize>| -> Vec<u8> {
        let samples: Vec<u8> =
            rows.flat_map(|row| (0..4).map(move |col| 10 * row + col)).flat_map(|z| two(u16::try_from(z).unwrap())).collect();
        [vec![u8::try_from(samples.len() - 1).unwrap()], samples].concat()
    };
    let parts = [strip(0..2), strip(2..2 + last_rows)];
    let head = if big { 16 } else { 8 };
    let doubles: Vec<u8> =
        [5.0_f64, 5.0, 0.0, 0.0, 0.0, 0.0, 100.0, 200.0, 0.0].into_iter().flat_map(|value| eight(value.to_bits())).collect();
    let (first, second) = (head, head + parts[0].len());
    let (places, lengths) = (second + parts[1].len(), second + parts[1].len() + 8);
    let numbers = lengths + 8;
    let directory = numbers + doubles.len();
    let at = |place: usize| u32::try_from(place).unwrap();
    // Offsets and lengths of the two strips stand beside the directory, or in it, where the value of an entry has eight bytes.
    let pair = |one: usize, other: usize| [four(at(one)), four(at(other))].concat();
    let outside = |place: usize, own: Vec<u8>| if big { own } else { four(at(place)) };
    let short = |value: u16| [two(value), vec![0; 2]].concat();
    let place = |place: usize| if big { eight(place as u64) } else { four(at(place)) };
    let entries: Vec<(u16, u16, u64, Vec<u8>)> = vec![
        (256, 3, 1, short(4)),
        (257, 3, 1, short(3)),
        (258, 3, 1, short(16)),
        (259, 3, 1, short(32773)),
        (262, 3, 1, short(1)),
        (273, 4, 2, outside(places, pair(first, second))),
        (277, 3, 1, short(1)),
        (278, 3, 1, short(2)),
        (279, 4, 2, outside(lengths, pair(parts[0].len(), parts[1].len()))),
        (339, 3, 1, short(2)),
        (33550, 12, 3, place(numbers)),
        (33922, 12, 6, place(numbers + 24)),
    ];
    let mut bytes = if little { b"II".to_vec() } else { b"MM".to_vec() };
    bytes.extend(if big {
        [two(43), two(8), two(0), eight(directory as u64)].concat()
    } else {
        [two(42), four(at(directory))].concat()
    });
    bytes.extend([parts.concat(), pair(first, second), pair(parts[0].len(), parts[1].len()), doubles].concat());
    bytes.extend(if big { eight(entries.len() as u64) } else { two(u16::try_from(entries.len()).unwrap()) });
    for (tag, kind, count, mut value) in entries {
        bytes.extend([two(tag), two(kind), if big { eight(count) } else { four(u32::try_from(count).unwrap()) }].concat());
        value.resize(if big { 8 } else { 4 }, 0);
        bytes.extend(value);
    }
    bytes.extend([0; 8]);
    bytes
}

/// The rows of the image are those of tag 257, whatever the last strip holds beyond them; a strip with fewer, or with more than a full
/// one, is damaged.
#[test]
fn a_last_strip_of_full_height_is_read() {
    for big in [false, true] {
        for little in [false, true] {
            for (last_rows, sound) in [(1, true), (2, true), (0, false), (3, false)] {
                let bytes = if last_rows == 0 { two_strips(big, little, 1) } else { two_strips(big, little, last_rows) };
                let context = format!("BigTIFF {big}, little-endian {little}, {last_rows} rows");
                let bytes = if last_rows == 0 {
                    // The run of the last strip says eight bytes and has two.
                    let mut bytes = bytes;
                    let last = (if big { 16 } else { 8 }) + 17;
                    bytes[last] = 1;
                    bytes
                } else {
                    bytes
                };
                match read_geotiff_bytes(bytes) {
                    Ok(dem) => {
                        assert!(sound, "{context}");
                        let posts: Vec<Option<f64>> = dem.elevations().collect();
                        let expected: Vec<Option<f64>> =
                            (0..3).flat_map(|row| (0..4).map(move |col| Some(f64::from(10 * row + col)))).collect();
                        assert_eq!(posts, expected, "{context}");
                    }
                    Err(error) => assert!(!sound && error.to_string().contains("damaged"), "{context}: {error}"),
                }
            }
        }
    }
}

/// Rows that GDAL only filled are stored in a last strip of full height: the elevations are those that it was told to fill in.
#[test]
fn rasters_that_gdal_only_filled_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("filled.tif");
    let path = file.to_str().unwrap();
    for (kind, compression) in [("Float64", "DEFLATE"), ("Float32", "LZW"), ("Int16", "ZSTD"), ("Float32", "NONE")] {
        let size = ["-outsize", "40", "1003", "-a_ullr", "0", "2006", "80", "0", "-burn", "7"];
        let made = [&["-q", "-of", "GTiff", "-bands", "1", "-ot", kind], &size[..]].concat();
        let compression_option = format!("COMPRESS={compression}");
        let made = [&made[..], &["-co", &compression_option, path]].concat();
        if !run("gdal_create", &made) {
            eprintln!("skipped: no gdal_create, or not with {compression}");
            continue;
        }
        let dem = read_dem(Path::new(path)).unwrap();
        assert_eq!((dem.rows(), dem.cols()), (1003, 40));
        assert!(dem.elevations().all(|z| z == Some(7.0)), "{kind} {compression}");
    }
}

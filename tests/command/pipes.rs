//! Inputs through a pipe: read once, with the same answer as the file; endless ones are refused, unknown ones at once.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{
    fs::{self, File},
    io::{Read, Write},
    process::{Command, Stdio},
    time::{Duration, Instant},
};

use sha2::{Digest, Sha256};

use crate::desk::{Desk, Ran};
use crate::installed::installed;

const BINARY: &str = env!("CARGO_BIN_EXE_chta");

/// Runs a command with these bytes, and then `again` and again, on its standard input. The folder of temporary files is the desk's own,
/// and is empty at the end.
fn piped(desk: &Desk, args: &[&str], bytes: &[u8], again: &[u8]) -> Ran {
    let temporary = tempfile::tempdir().unwrap();
    let mut command = Command::new(BINARY);
    command.current_dir(desk.path()).args(args).env("TMPDIR", temporary.path());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let (bytes, again) = (bytes.to_vec(), again.repeat(65_536 / again.len().max(1)));
    let writer = std::thread::spawn(move || {
        // The command may end before it has read everything.
        let mut written = input.write_all(&bytes);
        while !again.is_empty() && written.is_ok() {
            written = input.write_all(&again);
        }
    });
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    let left: Vec<_> = fs::read_dir(temporary.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(left.is_empty(), "{args:?} left {left:?}");
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran { status: output.status.code().unwrap(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

fn sha256(bytes: &[u8]) -> String {
    use std::fmt::Write as _;
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").unwrap();
        text
    })
}

/// A binary STL of one tilted plate.
fn plate_stl() -> Vec<u8> {
    let triangles = [[[0.0_f32, 0.0, 1.0], [9.0, 0.0, 2.0], [9.0, 9.0, 2.0]], [[0.0, 0.0, 1.0], [9.0, 9.0, 2.0], [0.0, 9.0, 1.0]]];
    let mut bytes = vec![b' '; 80];
    bytes.extend(2_u32.to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("ground.asc", "ncols 4\nnrows 3\nxllcorner -2.5\nyllcorner -2.5\ncellsize 5\n1 2 1 2\n1 1 1 1\n2 1 2 1\n");
    desk.write("ground.xyz", "0 0 1\n5 0 1\n0 5 1\n5 5 2\n");
    desk.write("plate.stl", plate_stl());
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,40\n10,30\n");
    desk.write("zones.geojson", r#"{"type": "Polygon", "coordinates": [[[3, 0], [4, 0], [4, 9], [3, 9], [3, 0]]]}"#);
    let pds3 = "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 512\r\n^IMAGE = \"GROUND.IMG\"\r\nEND\r\n";
    desk.write("ground.lbl", pds3);
    desk.write(
        "on_map.toml",
        crate::desk::ON_MAP.replace("friction_coefficient = 0.8", "friction_coefficient = 0.8\nkeep_out = \"zones.geojson\""),
    );
    desk
}

#[test]
fn a_pipe_gives_the_answer_of_the_file() {
    let desk = desk();
    let cases: [(&str, &[&str]); 18] = [
        ("ground.asc", &["slice", "FILE", "--from", "1,1", "--to", "5,3"]),
        ("ground.xyz", &["slice", "FILE", "--from", "1,1", "--to", "5,3"]),
        ("ground.tif", &["slice", "FILE", "--from", "1,1", "--to", "5,3"]),
        ("plate.obj", &["slice", "FILE", "--from", "1,1", "--to", "5,3"]),
        ("plate.stl", &["slice", "FILE", "--from", "1,1", "--to", "5,3"]),
        ("scenario.toml", &["slice", "ground.tif", "--from", "1,1", "--to", "5,3", "--scenario", "FILE"]),
        ("ground.tif", &["map", "FILE", "--start", "5,5", "--goal", "12,12", "--scenario", "map.toml"]),
        ("map.toml", &["map", "ground.tif", "--start", "5,5", "--goal", "12,12", "--scenario", "FILE"]),
        ("ground.tif", &["fan", "FILE", "--from", "5,5", "--length", "4", "--scenario", "map.toml", "--headings", "4"]),
        ("chain.csv", &["plan", "FILE", "--scenario", "scenario.toml"]),
        ("chain.csv", &["hop", "FILE", "--scenario", "scenario.toml", "--from", "0", "--to", "10"]),
        ("chain.csv", &["require", "FILE", "--scenario", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s"]),
        ("chain.csv", &["trade", "FILE", "--scenario", "scenario.toml", "--vary", "hopper.takeoff_speed_max_m_s=4:10:3"]),
        ("scenario.toml", &["check", "FILE"]),
        ("scenario.toml", &["check", "chain.csv", "--scenario", "FILE"]),
        ("map.toml", &["plan", "FILE", "--verify"]),
        ("pairs.csv", &["check", "scenario.toml", "--pairs", "FILE"]),
        ("scenario.toml", &["compare", "FILE", "map.toml"]),
    ];
    for (file, line) in cases {
        let bytes = fs::read(desk.path().join(file)).unwrap();
        let with = |name: &str| {
            line.iter().map(|word| if *word == "FILE" { name.to_owned() } else { (*word).to_owned() }).collect::<Vec<_>>()
        };
        let run = |name: &str, format: &str| {
            let mut args = with(name);
            if line[0] != "slice" {
                args.extend(["--format", format].map(str::to_owned));
            }
            args
        };
        let of_file = desk.run(&run(file, "text").iter().map(String::as_str).collect::<Vec<_>>());
        assert!(of_file.status < 2, "{line:?}: {}", of_file.stderr);
        // A name is all that may differ: in the comments of a chain, and where a scenario has no title.
        let plain = |text: &str| -> Vec<String> {
            text.lines()
                .map(|line| line.replace("(1) scenario.toml: scenario", "(1) -: -"))
                .filter(|line| !line.starts_with('#'))
                .collect()
        };
        for name in ["-", "/dev/stdin"] {
            let args = run(name, "text");
            let ran = piped(&desk, &args.iter().map(String::as_str).collect::<Vec<_>>(), &bytes, b"");
            assert_eq!(ran.status, of_file.status, "{args:?}: {}", ran.stderr);
            if line[0] != "compare" {
                assert_eq!(plain(&ran.stdout), plain(&of_file.stdout), "{args:?}");
            }
            assert_eq!(ran.stderr, of_file.stderr, "{args:?}");
        }
        // The digest is that of the bytes that came through.
        let args = run("-", "json");
        let ran = piped(&desk, &args.iter().map(String::as_str).collect::<Vec<_>>(), &bytes, b"");
        if line[0] == "slice" {
            assert!(
                file == "scenario.toml" || ran.stdout.contains(&format!("slice of -, sha256 {}", sha256(&bytes))),
                "{}",
                ran.stdout
            );
        } else if ["chain.csv", "ground.tif"].contains(&file) {
            let document: serde_json::Value = serde_json::from_str(&ran.stdout).unwrap();
            let input = document["inputs"].as_array().unwrap().iter().find(|input| input["name"] == "-").unwrap();
            assert_eq!(input["sha256"], sha256(&bytes).as_str(), "{args:?}");
        }
        assert!(!ran.stdout.contains(".chta-") && !ran.stderr.contains(".chta-"), "{args:?} names a temporary file");
    }
}

#[test]
fn keys_of_a_scenario_and_named_pipes_are_read_as_well() {
    let desk = desk();
    let plan = |scenario: &str| desk.run(&["plan", scenario]).stdout;
    for (scenario, key, file) in [
        ("map.toml", "dem = \"ground.tif\"", "ground.tif"),
        ("scenario.toml", "chain = \"chain.csv\"", "chain.csv"),
        ("on_map.toml", "keep_out = \"zones.geojson\"", "zones.geojson"),
    ] {
        let name = key.split(" = ").next().unwrap();
        let bytes = fs::read(desk.path().join(file)).unwrap();
        desk.write("piped.toml", desk.read(scenario).replace(key, &format!("{name} = \"-\"")));
        let ran = piped(&desk, &["plan", "piped.toml"], &bytes, b"");
        assert_eq!((ran.stdout, ran.status < 2), (plan(scenario), true), "{key}: {}", ran.stderr);
        let set = piped(
            &desk,
            &["plan", scenario, "--set", &format!("{}.{name}=-", if name == "keep_out" { "surface" } else { "terrain" })],
            &bytes,
            b"",
        );
        assert_eq!((set.stdout, set.status < 2), (plan(scenario), true), "{key}: {}", set.stderr);
    }
    // A named pipe, and a process substitution of the shell.
    assert!(Command::new("mkfifo").arg(desk.path().join("pipe.asc")).status().unwrap().success());
    let (to, bytes) = (desk.path().join("pipe.asc"), fs::read(desk.path().join("ground.asc")).unwrap());
    let writer = std::thread::spawn(move || fs::write(to, bytes).unwrap());
    let mut command = Command::new(BINARY);
    let ran = command.current_dir(desk.path()).args(["slice", "pipe.asc", "--from", "1,1", "--to", "5,3"]).output().unwrap();
    writer.join().unwrap();
    let rows = |text: &str| text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>();
    let of_file = rows(&desk.run(&["slice", "ground.asc", "--from", "1,1", "--to", "5,3"]).stdout);
    assert_eq!(rows(&String::from_utf8(ran.stdout).unwrap()), of_file, "{}", String::from_utf8_lossy(&ran.stderr));
    if installed("bash") {
        let line = format!("{BINARY} slice <(cat ground.asc) --from 1,1 --to 5,3");
        let ran = Command::new("bash").current_dir(desk.path()).args(["-c", &line]).output().unwrap();
        assert_eq!(rows(&String::from_utf8(ran.stdout).unwrap()), of_file, "{}", String::from_utf8_lossy(&ran.stderr));
    }
    fs::remove_file(desk.path().join("pipe.asc")).unwrap();
    // Standard input from a file is read as well.
    let mut command = Command::new(BINARY);
    command.current_dir(desk.path()).args(["slice", "-", "--from", "1,1", "--to", "5,3"]);
    let ran = command.stdin(File::open(desk.path().join("ground.asc")).unwrap()).output().unwrap();
    assert_eq!(rows(&String::from_utf8(ran.stdout).unwrap()), of_file);
}

#[test]
fn what_a_pipe_cannot_give_is_said() {
    let desk = desk();
    let chain = desk.read("chain.csv").into_bytes();
    let label = desk.read("ground.lbl");
    let twice = "what comes through a pipe is read only once: give one of the two as a file";
    let cases: [(&[&str], &[u8], &[&str]); 9] = [
        (&["check", "-", "--scenario", "-"], &chain, &["-: found for both CHAIN and --scenario", twice]),
        (&["check", "-", "--scenario", "/dev/stdin"], &chain, &["found for both CHAIN and --scenario", twice]),
        (&["check", "-", "--scenario", "scenario.toml", "--pairs", "-"], &chain, &["found for both CHAIN and --pairs", twice]),
        (&["compare", "-", "-"], &chain, &["-: found twice as SCENARIO", twice]),
        (&["slice", "-", "--from", "1,1", "--to", "2,2"], b"", &["-: the file is empty", "piped to its end?"]),
        (&["check", "-"], b"", &["-: line 1: found an empty file"]),
        (
            &["slice", "-", "--from", "1,1", "--to", "2,2"],
            label.as_bytes(),
            &["-: this PDS3 label names its image, GROUND.IMG", "give the label as a file"],
        ),
        (&["plan", "-"], &fs::read(desk.path().join("ground.tif")).unwrap(), &["-: this is a GeoTIFF; expected a chain CSV"]),
        (&["check", "-", "--scenario", "scenario.toml"], b"x_m,z_m\n0,0\n5,1\n3,2\n", &["-: line 4, column 1 (x_m): found `3`"]),
    ];
    for (args, bytes, parts) in cases {
        let ran = piped(&desk, args, bytes, b"");
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{args:?}: {}", ran.stderr);
        for part in parts {
            assert!(ran.stderr.contains(part), "{args:?}: {part:?} is not in {}", ran.stderr);
        }
        assert!(!ran.stderr.contains(".chta-"), "{args:?}: {}", ran.stderr);
    }
}

/// A command line, what comes first through its pipe, what then comes again and again, and words of its refusal.
type Endless<'a> = (Vec<&'a str>, &'a [u8], &'a [u8], &'a str);

#[test]
fn endless_inputs_are_refused_and_unknown_ones_at_once() {
    let desk = desk();
    let zeros = [0_u8];
    let grid = desk.read("ground.asc");
    let tif = fs::read(desk.path().join("ground.tif")).unwrap();
    let unknown = "(it begins with '";
    let (line, most) =
        ("a line of more than", "comes through the pipe, expected at most that: is it endless? For more give --input-max-gib");
    let slice: &[&str] = &["slice", "-", "--from", "1,1", "--to", "5,3"];
    let small = |args: &[&'static str]| [args, &["--input-max-gib", "0.05"]].concat();
    let began = Instant::now();
    let cases: [Endless<'_>; 14] = [
        (slice.to_vec(), b"", &zeros, unknown),
        (slice.to_vec(), b"", b"y\n", unknown),
        (slice.to_vec(), b"", b"x", unknown),
        (vec!["check", "-"], b"", &zeros, unknown),
        (vec!["check", "-"], b"", b"y\n", unknown),
        (vec!["run", "-", "-o", "out"], b"", b"y\n", unknown),
        (vec!["check", "chain.csv", "--pairs", "-"], b"", b"y\n", unknown),
        (vec!["map", "-", "--start", "1,1"], b"", b"junk ", unknown),
        (vec!["check", "-"], b"x_m,z_m\n0,0\n", b"1", line),
        (slice.to_vec(), grid.as_bytes(), b"1 ", line),
        (slice.to_vec(), b"v 0 0 0\nv 1", &zeros, line),
        (vec!["run", "-", "-o", "out"], b"[body]\nname = \"mars\"\n", b"# and on\n", "a scenario has some kilobytes"),
        (small(&["check", "-"]), b"x_m,z_m\n", b"0,0\n", most),
        (small(&["slice", "-", "--from", "1,1", "--to", "5,3"]), &tif, &zeros, most),
    ];
    for (args, bytes, again, part) in cases {
        let ran = piped(&desk, &args, bytes, again);
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{args:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(part), "{args:?}: {part:?} is not in {}", ran.stderr);
    }
    // Devices that never end.
    for args in [
        &["slice", "/dev/zero", "--from", "1,1", "--to", "2,2"][..],
        &["run", "/dev/zero", "-o", "out"],
        &["check", "/dev/urandom"],
        &["map", "/dev/urandom", "--start", "1,1"],
    ] {
        desk.refused(args, &[unknown]);
    }
    desk.write("zero.toml", "[body]\nname = \"mars\"\n[terrain]\ndem = \"/dev/zero\"\nstart_m = [1, 1]\ngoal_m = [2, 2]\n");
    desk.refused(&["check", "zero.toml"], &["/dev/zero: ", unknown, "as terrain.dem"]);
    // A large margin for a busy machine.
    assert!(began.elapsed() < Duration::from_secs(60), "took {:?}", began.elapsed());
    // More is read where the option says so.
    let long: Vec<u8> = [b"x_m,z_m\n0,0\n".to_vec(), b"# a comment\n".repeat(5_000_000), b"4,1\n".to_vec()].concat();
    let args = ["check", "-", "--scenario", "scenario.toml", "--set", "terrain.goal_x_m=4", "--input-max-gib"];
    let refused = piped(&desk, &[&args[..], &["0.05"]].concat(), &long, b"");
    let (_, more) = refused.stderr.trim().split_once("--input-max-gib ").unwrap();
    let ran = piped(&desk, &[&args[..], &[more]].concat(), &long, b"");
    assert_eq!(ran.status, 0, "{more}: {}", ran.stderr);
    // A text on disk is read whole, so it is bounded as well.
    desk.write("long.csv", &long);
    desk.refused(
        &["check", "long.csv", "--scenario", "scenario.toml", "--input-max-gib", "0.05"],
        &["long.csv: found 0.1 GiB", "--input-max-gib"],
    );
    for wrong in ["0", "-1", "nan", "much"] {
        desk.refused(&["check", "chain.csv", "--input-max-gib", wrong], &["a number of GiB above 0"]);
    }
}

#[test]
fn an_interrupt_leaves_nothing_of_a_pipe() {
    let desk = desk();
    let temporary = tempfile::tempdir().unwrap();
    let mut command = Command::new(BINARY);
    command.current_dir(desk.path()).args(["check", "-"]).env("TMPDIR", temporary.path());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    // More than is looked at to recognise it, and no end.
    input.write_all(&[b"x_m,z_m\n".to_vec(), b"# on\n".repeat(100_000)].concat()).unwrap();
    let began = Instant::now();
    while fs::read_dir(temporary.path()).unwrap().next().is_none() && began.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    drop(input);
    let mut said = String::new();
    child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
    assert_eq!(fs::read_dir(temporary.path()).unwrap().count(), 0, "{said}");
}

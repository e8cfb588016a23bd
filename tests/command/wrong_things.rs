//! Every kind of file in every position that takes one: it is taken, or named, with what belongs there and how to mend it. Every
//! mending sentence is tested by doing what it says.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::{fs, io::Write, path::Path, process::Command};

use crate::desk::Desk;
use crate::installed::installed;

const GEOJSON: &str = r#"{"type": "Polygon", "coordinates": [[[3, 0], [4, 0], [4, 9], [3, 9], [3, 0]]]}"#;

const KML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>pit</name><Polygon><outerBoundaryIs><LinearRing><coordinates>
LON0,LAT0,0 LON1,LAT0,0 LON1,LAT1,0 LON0,LAT1,0 LON0,LAT0,0
</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>
"#;

/// A desk with one file of each kind.
fn desk() -> Desk {
    let desk = Desk::with_dem();
    desk.write("ground.asc", "ncols 4\nnrows 3\nxllcorner -2.5\nyllcorner -2.5\ncellsize 5\n1 2 1 2\n1 1 1 1\n2 1 2 1\n");
    desk.write("ground.xyz", "0 0 1\n5 0 1\n0 5 1\n5 5 2\n");
    desk.write("label.lbl", "PDS_VERSION_ID = PDS3\r\n^IMAGE = \"X.IMG\"\r\nEND\r\n");
    desk.write("plate.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n9 0 0\n0 9 0\n3 0 1 2\n");
    desk.write(
        "plate.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid\n",
    );
    desk.write("pairs.csv", "start_x_m,goal_x_m\n0,40\n");
    desk.write("zones.geojson", GEOJSON);
    desk.write("zones.kml", KML.replace("LON0", "10").replace("LON1", "11").replace("LAT0", "0").replace("LAT1", "1"));
    desk.write("zones.shp", b"\x00\x00\x27\x0a0000");
    desk.write("zones.gpkg", [&b"SQLite format 3\0"[..], &[0; 52], b"GP10"].concat());
    desk.write("empty.tif", "");
    desk.write("page.html", "<!DOCTYPE html><html><body>not found</body></html>\n");
    fs::create_dir(desk.path().join("folder")).unwrap();
    for made in [&["plan", "scenario.toml", "-o", "path.csv", "--plot", "picture.png"][..], &["run", "scenario.toml", "-o", "out"]]
    {
        assert_eq!(desk.run(made).status, 0);
    }
    fs::rename(desk.path().join("out/result.json"), desk.path().join("result.json")).unwrap();
    fs::remove_dir_all(desk.path().join("out")).unwrap();
    desk.write("ground.tif.gz", gzip(&fs::read(desk.path().join("ground.tif")).unwrap()));
    desk
}

/// A gzip file of stored blocks.
fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(bytes).unwrap();
    packer.finish().unwrap()
}

/// A file of the desk, and what it is called.
const THINGS: [(&str, &str); 20] = [
    ("ground.tif", "a GeoTIFF"),
    ("ground.asc", "an ESRI ASCII grid"),
    ("ground.xyz", "an XYZ grid"),
    ("label.lbl", "a PDS3 label or image"),
    ("plate.obj", "an OBJ mesh"),
    ("plate.ply", "a PLY mesh"),
    ("plate.stl", "an STL mesh"),
    ("chain.csv", "a chain CSV"),
    ("pairs.csv", "a CSV of pairs of start and goal"),
    ("path.csv", "a CSV of the hops of a path"),
    ("scenario.toml", "a scenario (TOML)"),
    ("result.json", "a result (JSON)"),
    ("zones.geojson", "a GeoJSON"),
    ("zones.kml", "a KML file"),
    ("zones.shp", "an ESRI Shapefile"),
    ("zones.gpkg", "a GeoPackage"),
    ("picture.png", "a PNG picture"),
    ("ground.tif.gz", "a file packed with gzip"),
    ("page.html", "a web page"),
    ("empty.tif", ""),
];

/// A position: its name, a command line with `THING` in it, and the things that it takes or whose reader says best what is wrong.
/// Nothing else is given, no gravity and no start: the file comes first.
const POSITIONS: [(&str, &[&str], &[&str]); 14] = [
    ("TERRAIN", &["hop", "THING"], HOP_TERRAINS),
    ("CHAIN", &["check", "THING"], CHAINS),
    ("CHAIN", &["plan", "THING"], CHAINS),
    ("CHAIN", &["simulate", "THING"], CHAINS),
    ("CHAIN", &["require", "THING", "--vary", "no.key"], CHAINS),
    ("CHAIN", &["trade", "THING", "--vary", "no.key"], CHAINS),
    ("SCENARIO", &["run", "THING", "-o", "out"], SCENARIOS),
    ("SCENARIO", &["compare", "scenario.toml", "THING"], SCENARIOS),
    ("--scenario", &["check", "chain.csv", "--scenario", "THING"], SCENARIOS),
    ("DEM|SCENARIO", &["map", "THING", "--start", "1,1", "--stride", "0"], MAPS),
    ("--starts", &["map", "ground.tif", "--starts", "THING"], &[]),
    ("DEM", &["fan", "THING", "--from", "1,1", "--length", "3"], RASTERS),
    ("DEM|MESH", &["slice", "THING", "--from", "1,1", "--to", "2,2"], TERRAINS),
    ("--pairs", &["check", "chain.csv", "--pairs", "THING"], &["pairs.csv", "empty.tif"]),
];

const CHAINS: &[&str] = &["chain.csv", "scenario.toml", "result.json", "empty.tif"];
const HOP_TERRAINS: &[&str] = &[
    "chain.csv",
    "scenario.toml",
    "result.json",
    "empty.tif",
    "ground.tif",
    "ground.asc",
    "ground.xyz",
    "label.lbl",
    "plate.obj",
    "plate.ply",
    "plate.stl",
];
const SCENARIOS: &[&str] = &["scenario.toml", "result.json"];
const RASTERS: &[&str] = &["ground.tif", "ground.asc", "ground.xyz", "label.lbl"];
const MAPS: &[&str] = &["ground.tif", "ground.asc", "ground.xyz", "label.lbl", "scenario.toml", "result.json"];
const TERRAINS: &[&str] = &["ground.tif", "ground.asc", "ground.xyz", "label.lbl", "plate.obj", "plate.ply", "plate.stl"];

/// A key of a scenario that names a file, its lines with `THING` in them, and the things that it takes.
const KEYS: [(&str, &str, &[&str]); 6] = [
    ("terrain.dem", "[terrain]\ndem = \"THING\"\n", RASTERS),
    ("terrain.mesh", "[terrain]\nmesh = \"THING\"\n", &["plate.obj", "plate.ply", "plate.stl"]),
    ("terrain.chain", "[terrain]\nchain = \"THING\"\n", &["chain.csv", "empty.tif"]),
    (
        "surface.keep_out",
        "[terrain]\ndem = \"ground.tif\"\n[surface]\nkeep_out = \"THING\"\n",
        &["ground.tif", "ground.asc", "ground.xyz", "label.lbl", "zones.geojson", "zones.kml", "zones.shp", "zones.gpkg"],
    ),
    ("surface.friction_raster", "[terrain]\ndem = \"ground.tif\"\n[surface]\nfriction_raster = \"THING\"\n", RASTERS),
    ("uncertainty.errors", "[terrain]\ndem = \"ground.tif\"\n[uncertainty]\nerrors = \"THING\"\n", &["empty.tif"]),
];

/// Checks the sentence for a thing in a position.
fn check(desk: &Desk, args: &[&str], (thing, called): (&str, &str), position: &str, takes: &[&str]) {
    let ran = desk.run(args);
    if takes.contains(&thing) {
        assert!(!ran.stderr.contains("this is a"), "{args:?}: {}", ran.stderr);
        return;
    }
    let said = if called.is_empty() { "the file is empty; expected ".to_owned() } else { format!("this is {called}; expected ") };
    desk.refused(args, &[&format!("{thing}: {said}"), &format!(" as {position}")]);
    assert_eq!(ran.stderr.matches("error: ").count(), 1, "{args:?}: {}", ran.stderr);
    assert!(!ran.stderr.contains("UTF-8") && !ran.stderr.contains("gravity"), "{args:?}: {}", ran.stderr);
}

#[test]
fn every_thing_in_every_position_is_taken_or_named() {
    let desk = desk();
    for thing in THINGS {
        for (position, line, takes) in POSITIONS {
            let args: Vec<&str> = line.iter().map(|word| if *word == "THING" { thing.0 } else { word }).collect();
            check(&desk, &args, thing, position, takes);
        }
        for (position, lines, takes) in KEYS {
            desk.write("key.toml", lines.replace("THING", thing.0));
            for command in [&["check", "key.toml"][..], &["run", "key.toml", "-o", "out"], &["compare", "key.toml", "key.toml"]] {
                check(&desk, command, thing, position, takes);
            }
            if position.starts_with("surface") {
                check(&desk, &["map", "ground.tif", "--start", "1,1", "--scenario", "key.toml"], thing, position, takes);
                check(
                    &desk,
                    &["slice", "ground.tif", "--from", "1,1", "--to", "2,2", "--scenario", "key.toml"],
                    thing,
                    position,
                    takes,
                );
            }
        }
    }
}

#[test]
fn a_file_that_cannot_be_read_is_reported_before_any_other_fault() {
    let desk = desk();
    let elsewhere = tempfile::tempdir().unwrap();
    let link = elsewhere.path().join("link");
    #[cfg(unix)]
    std::os::unix::fs::symlink("gone.tif", &link).unwrap();
    let mut things = vec![("none", "No such file or directory"), ("folder", "Is a directory"), ("none/deeper", "No such file")];
    if cfg!(unix) {
        things.push((link.to_str().unwrap(), "it is a link to gone.tif, which does not exist"));
    }
    for (thing, reason) in things {
        for (_, line, _) in POSITIONS {
            let args: Vec<&str> = line.iter().map(|word| if *word == "THING" { thing } else { word }).collect();
            let said = format!("error: {thing}: cannot be read ({reason}");
            desk.refused(&args, &[&said, "check the path"]);
            let message = desk.run(&args).stderr;
            assert!(message.starts_with(&said) && message.matches("error: ").count() == 1, "{args:?}: {message}");
        }
        for (key, lines, _) in KEYS {
            desk.write("key.toml", lines.replace("THING", thing));
            for command in ["check", "plan", "hop"] {
                let message = desk.run(&[command, "key.toml"]).stderr;
                let said = format!("{key} is {thing}, which cannot be read ({reason}");
                assert!(message.lines().next().unwrap().contains(&said), "{command} {key}: {message}");
            }
            // What else is wrong with the scenario is listed after it.
            let message = desk.run(&["check", "key.toml"]).stderr;
            assert!(message.find("cannot be read") < message.find("found no gravity"), "{message}");
        }
    }
    // A wrong thing does not hide that another file is missing.
    desk.refused(&["plan", "ground.tif", "--scenario", "none.toml"], &["error: none.toml: cannot be read"]);
    desk.refused(&["slice", "chain.csv", "--from", "1,1", "--to", "2,2", "--scenario", "none.toml"], &["error: none.toml: cannot"]);
    desk.refused(&["compare", "chain.csv", "none.toml"], &["error: none.toml: cannot be read"]);
    // Backslashes stand between folders only on Windows; the mended path is read.
    #[cfg(unix)]
    {
        fs::write(desk.path().join("folder/a.csv"), fs::read(desk.path().join("chain.csv")).unwrap()).unwrap();
        let message = desk.run(&["check", r"folder\a.csv", "--scenario", "scenario.toml"]).stderr;
        let mended = message.trim().rsplit("between folders: ").next().unwrap().to_owned();
        assert_eq!(desk.run(&["check", &mended, "--scenario", "scenario.toml"]).status, 0, "{message}");
    }
}

/// The commands in backticks that a message gives, and its texts of TOML after `[table] `.
fn advised(message: &str) -> Vec<String> {
    message.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Does what a message says in a shell, with places filled in.
fn done(desk: &Desk, command: &str) -> i32 {
    let command = command
        .replace("chta ", &format!("{} ", env!("CARGO_BIN_EXE_chta")))
        .replace("--from X,Y --to X,Y", "--from 1,1 --to 4,1")
        .replace("--start X --goal X", "--start 0 --goal 40")
        .replace("SCENARIO", "scenario.toml")
        .replace("PAIRS.csv", "pairs.csv");
    let ran = Command::new("sh").current_dir(desk.path()).args(["-c", &command]).output().unwrap();
    ran.status.code().unwrap()
}

#[test]
fn commands_in_the_messages_do_what_they_say() {
    let desk = desk();
    let cases: [(&[&str], usize); 14] = [
        (&["plan", "ground.tif"], 1),
        (&["require", "ground.asc", "--vary", "x"], 1),
        (&["check", "ground.xyz"], 1),
        (&["check", "plate.obj"], 1),
        (&["run", "plate.stl", "-o", "out"], 1),
        (&["run", "ground.tif", "-o", "out"], 1),
        (&["check", "chain.csv", "--scenario", "ground.tif"], 1),
        (&["run", "chain.csv", "-o", "out"], 1),
        (&["slice", "chain.csv", "--from", "1,1", "--to", "2,2"], 1),
        (&["map", "plate.ply", "--start", "1,1"], 1),
        (&["fan", "chain.csv", "--from", "1,1", "--length", "2"], 1),
        (&["check", "chain.csv", "--pairs", "ground.tif"], 1),
        (&["map", "ground.tif.gz", "--start", "1,1"], 1),
        (&["slice", "ground.tif.gz", "--from", "1,1", "--to", "2,2"], 1),
    ];
    for (args, count) in cases {
        let message = desk.run(args).stderr;
        let commands = advised(&message);
        assert_eq!(commands.len(), count, "{message}");
        for command in commands {
            if command.starts_with("gunzip") {
                fs::remove_file(desk.path().join("ground.tif")).unwrap();
            }
            assert_eq!(done(&desk, &command), 0, "{command}: {message}");
            // The chain that was cut is one, and the unpacked raster is one.
            if command.starts_with("chta slice") {
                let ran = desk.run(&["check", "chain.csv", "--scenario", "scenario.toml", "--start", "0", "--goal", "3"]);
                assert!(ran.status < 2, "{}", ran.stderr);
                desk.write("chain.csv", crate::desk::CHAIN);
            }
            assert!(desk.run(&["slice", "ground.tif", "--from", "1,1", "--to", "2,2"]).status == 0, "{command}");
        }
    }
    // A scenario in place of the DEM goes to the option that the message names.
    let message = desk.run(&["map", "scenario.toml", "--start", "1,1"]).stderr;
    assert!(message.contains("with --scenario scenario.toml"), "{message}");
    assert!(desk.run(&["map", "ground.tif", "--start", "1,1", "--scenario", "scenario.toml"]).status < 2);
}

#[test]
fn keys_written_as_the_messages_say_are_accepted() {
    let desk = desk();
    let head = "[body]\nname = \"mars\"\n[hopper]\ntakeoff_speed_max_m_s = 6\nlanding_speed_max_m_s = 6\n[surface]\nfriction_coefficient = 0.8\n[terrain]\n";
    let (on_map, along) = ("start_m = [1, 1]\ngoal_m = [4, 1]\n", "start_x_m = 0\ngoal_x_m = 40\n");
    let cases = [
        ("dem", "plate.obj", on_map),
        ("dem", "chain.csv", on_map),
        ("mesh", "ground.tif", on_map),
        ("mesh", "chain.csv", on_map),
        ("chain", "ground.asc", along),
        ("chain", "plate.obj", along),
    ];
    for (key, thing, ends) in cases {
        desk.write("key.toml", format!("{head}{key} = \"{thing}\"\n{ends}"));
        let message = desk.run(&["check", "key.toml"]).stderr;
        let (_, advice) = message.split_once("write ").unwrap_or_else(|| panic!("{message}"));
        let (line, rest) = advice.split_once(&format!(" in place of {key}")).unwrap();
        let mended_ends = match () {
            () if rest.contains("start_x_m and goal_x_m in place of start_m") => along,
            () if rest.contains("start_m and goal_m, each [x, y], in place of start_x_m") => on_map,
            () => ends,
        };
        desk.write("key.toml", format!("{head}{line}\n{mended_ends}"));
        let ran = desk.run(&["check", "key.toml"]);
        assert!(ran.status < 2, "{key} {thing}: {message}{}", ran.stderr);
    }
    // Shapes in a wrong position are named as zones, where the command that converts them is given.
    let message = desk.run(&["plan", "zones.gpkg"]).stderr;
    assert!(message.contains("[surface] keep_out = \"zones.gpkg\""), "{message}");
    desk.write("named.toml", head.replace("[terrain]\n", "keep_out = \"zones.gpkg\"\n[terrain]\ndem = \"ground.tif\"\n") + on_map);
    desk.refused(&["check", "named.toml"], &["convert it with: ogrmerge.py -single -f GeoJSON"]);
    // Zones and terrain named where a message says.
    for (args, key) in [
        (&["map", "zones.geojson", "--start", "1,1"][..], "keep_out"),
        (&["plan", "ground.tif"], "dem"),
        (&["plan", "plate.obj"], "mesh"),
        (&["run", "chain.csv", "-o", "out"], "chain"),
    ] {
        let message = desk.run(args).stderr;
        let at = message.find(&format!("{key} = ")).unwrap_or_else(|| panic!("{message}"));
        let line: String =
            message[at..].chars().take_while(|letter| !"; \n".contains(*letter) || message[at..].starts_with(' ')).collect();
        let value = message[at..].split('"').nth(1).unwrap();
        assert!(line.starts_with(key));
        let ends = if key == "chain" { along } else { on_map };
        let text = match key {
            "keep_out" => {
                head.replace("[terrain]\n", &format!("keep_out = \"{value}\"\n[terrain]\ndem = \"ground.tif\"\n")) + on_map
            }
            _ => format!("{head}{key} = \"{value}\"\n{ends}"),
        };
        desk.write("named.toml", text);
        let ran = desk.run(&["check", "named.toml"]);
        assert!(ran.status < 2, "{message}{}", ran.stderr);
    }
}

#[test]
fn packed_files_are_unpacked_by_the_command_of_the_message() {
    let packers: [(&str, &str, &[&str]); 5] = [
        ("gzip", "ground.tif.gz", &["ground.tif"]),
        ("bzip2", "ground.tif.bz2", &["ground.tif"]),
        ("xz", "ground.tif.xz", &["ground.tif"]),
        ("zstd", "ground.tif.zst", &["-q", "--rm", "ground.tif"]),
        ("tar", "ground.tar", &["-cf", "ground.tar", "ground.tif"]),
    ];
    for (packer, packed, args) in packers.into_iter().filter(|(packer, ..)| installed(packer)) {
        let desk = Desk::with_dem();
        assert!(Command::new(packer).current_dir(desk.path()).args(args).status().unwrap().success());
        fs::remove_file(desk.path().join("ground.tif")).ok();
        let message = desk.run(&["slice", packed, "--from", "1,1", "--to", "2,2"]).stderr;
        let [command] = &advised(&message)[..] else { panic!("{message}") };
        assert_eq!(done(&desk, command), 0, "{message}");
        assert_eq!(desk.run(&["slice", "ground.tif", "--from", "1,1", "--to", "2,2"]).status, 0, "{message}");
    }
}

/// Rasters of formats that are not read: GDAL makes a GeoTIFF of them, which is cut or named as the message says.
#[test]
fn foreign_rasters_are_converted_by_the_command_of_the_message() {
    if !installed("gdal_translate") || cfg!(feature = "gdal") {
        return;
    }
    let formats =
        [("HFA", "ground.img"), ("VRT", "ground.vrt"), ("ISIS3", "ground.cub"), ("VICAR", "ground.vic"), ("PDS4", "ground.xml")];
    let desk = Desk::with_dem();
    let chain = crate::desk::CHAIN;
    // PDS4 and VICAR keep no place on a map without a projection.
    let moon = "+proj=eqc +lat_ts=0 +lat_0=0 +lon_0=10 +R=1737400 +units=m +no_defs";
    let placed = ["-q", "-a_srs", moon, "ground.tif", "source.tiff"];
    assert!(Command::new("gdal_translate").current_dir(desk.path()).args(placed).status().unwrap().success());
    fs::remove_file(desk.path().join("ground.tif")).unwrap();
    for (format, name) in formats {
        let made = Command::new("gdal_translate")
            .current_dir(desk.path())
            .args(["-q", "-of", format, "source.tiff", name])
            .output()
            .unwrap();
        if !made.status.success() {
            eprintln!("skipped: gdal_translate does not write {format}");
            continue;
        }
        let message = desk.run(&["plan", name]).stderr;
        let [convert, cut] = &advised(&message)[..] else { panic!("{message}") };
        assert_eq!((done(&desk, convert), done(&desk, cut)), (0, 0), "{format}: {message}");
        assert!(desk.read("chain.csv") != chain && desk.read("chain.csv").starts_with("# chta"), "{message}");
        desk.write("chain.csv", chain);
        desk.write("key.toml", crate::desk::SCENARIO.replace("chain.csv", name));
        let message = desk.run(&["check", "key.toml"]).stderr;
        assert!(message.contains("write dem = \"ground.tif\" in place of chain"), "{message}");
        fs::remove_file(desk.path().join("ground.tif")).unwrap();
    }
}

/// A path with backslashes, written with / as the message says, is read.
#[test]
fn a_windows_path_written_as_the_message_says_is_read() {
    let desk = Desk::with_dem();
    fs::create_dir(desk.path().join("new")).unwrap();
    for name in ["ground.tif", "names.tif", "u00.tif", "x.tif"] {
        fs::copy(desk.path().join("ground.tif"), desk.path().join("new").join(name)).unwrap();
        // An unknown escape, a line break, two that lack their digits.
        desk.write("windows.toml", crate::desk::ON_MAP.replace("ground.tif", &format!("new\\{name}")));
        desk.refused(
            &["check", "windows.toml"],
            &["windows.toml:12:7: terrain.dem ", "write / instead of each", &format!("dem = 'new\\{name}'")],
        );
        let message = desk.run(&["check", "windows.toml"]).stderr;
        assert_eq!(message.matches("error: ").count(), 1, "{message}");
        desk.write("windows.toml", crate::desk::ON_MAP.replace("ground.tif", &format!("new/{name}")));
        assert!(desk.run(&["check", "windows.toml"]).status < 2, "{name}");
        // In single quotes the path is read as it stands; on this system it has no folders.
        if cfg!(unix) {
            desk.write("windows.toml", crate::desk::ON_MAP.replace("\"ground.tif\"", &format!("'new\\{name}'")));
            let said = format!("on this system / stands between folders: new/{name}");
            desk.refused(&["check", "windows.toml"], &["which cannot be read (No such file", &said]);
        }
    }
}

/// Zones in other formats: the command of the message is run, and its result keeps the robot out where the zone was drawn.
#[test]
fn zones_in_other_formats_are_converted_by_the_command_of_the_message() {
    // ogrmerge.py needs the Python of the system's GDAL.
    if !installed("ogr2ogr") || !installed("gdal_translate") || !Path::new("/usr/bin/ogrmerge.py").is_file() {
        return;
    }
    let desk = Desk::with_dem();
    let tool = |program: &str, args: &[&str]| {
        let ran = Command::new(program).current_dir(desk.path()).args(args).output().unwrap();
        assert!(ran.status.success(), "{program} {args:?}: {}", String::from_utf8_lossy(&ran.stderr));
    };
    // Maps of three bodies about 10 degrees east on the equator, and one without a projection; 20 m by 20 m.
    let maps = [
        ("moon", Some("+proj=eqc +lat_ts=0 +lat_0=0 +lon_0=10 +R=1737400 +units=m +no_defs"), 1_737_400.0),
        ("mars", Some("+proj=stere +lat_0=0 +lon_0=10 +R=3396190 +units=m +no_defs"), 3_396_190.0),
        ("earth", Some("+proj=tmerc +lat_0=0 +lon_0=10 +ellps=WGS84 +units=m +no_defs"), 6_378_137.0),
        ("local", None, 1.0),
    ];
    let zone = r#"{"type": "Polygon", "coordinates": [[[4, 4], [8, 4], [8, 12], [4, 12], [4, 4]]]}"#;
    let kept = |chain: &str| -> Vec<(f64, f64)> {
        let rows: Vec<Vec<&str>> =
            chain.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(',').collect()).collect();
        let column = rows[0].iter().position(|name| *name == "keep_out").unwrap_or_else(|| panic!("{chain}"));
        let x = |row: &[&str]| row[0].parse::<f64>().unwrap();
        rows[1..].windows(2).filter(|pair| pair[0][column] == "1").map(|pair| (x(&pair[0]), x(&pair[1]))).collect()
    };
    for (body, projection, radius_m) in maps {
        match projection {
            Some(projection) => tool("gdal_translate", &["-q", "-a_srs", projection, "ground.tif", "map.tif"]),
            None => fs::copy(desk.path().join("ground.tif"), desk.path().join("map.tif")).map(drop).unwrap(),
        }
        desk.write("zone.json", zone);
        // GeoJSON without a reference system means degrees on the Earth unless told otherwise.
        tool("ogr2ogr", &["-f", "ESRI Shapefile", "-a_srs", projection.unwrap_or("None"), "zones.shp", "zone.json"]);
        // The zone is in the second layer; the first has one beside the slice.
        desk.write("far.json", zone.replace("4, 4", "4, 14").replace("8, 4", "8, 14").replace("12]", "16]"));
        let srs = projection.unwrap_or("None");
        tool("ogr2ogr", &["-f", "GPKG", "-a_srs", srs, "-nln", "far", "zones.gpkg", "far.json"]);
        tool("ogr2ogr", &["-f", "GPKG", "-update", "-a_srs", srs, "-nln", "near", "zones.gpkg", "zone.json"]);
        // One degree on the ellipsoid's equator; along the meridian the WGS 84 ellipsoid has 110 574 m.
        let per_metre = 180.0 / (std::f64::consts::PI * radius_m);
        let north = if body == "earth" { 1.0 / 110_574.275_8 } else { per_metre };
        let place = |x: f64| format!("{:.12}", 10.0 + x * per_metre);
        let up = |y: f64| format!("{:.12}", y * north);
        let drawn =
            KML.replace("LON0", &place(4.0)).replace("LON1", &place(8.0)).replace("LAT0", &up(4.0)).replace("LAT1", &up(12.0));
        // A folder with a zone beside the slice comes before that of the zone.
        let far =
            KML.replace("LON0", &place(4.0)).replace("LON1", &place(8.0)).replace("LAT0", &up(14.0)).replace("LAT1", &up(16.0));
        let placemark = |kml: &str| {
            let (from, to) = (kml.find("<Placemark>").unwrap(), kml.rfind("</Placemark>").unwrap() + "</Placemark>".len());
            kml[from..to].to_owned()
        };
        let (near, far) = (placemark(&drawn), placemark(&far));
        let folders = format!("<Folder><name>far</name>{far}</Folder><Folder><name>near</name>{near}</Folder>");
        desk.write("zones.kml", drawn.replace(&near, &folders));
        for name in ["zones.kml", "zones.shp", "zones.gpkg", "zones.shx", "zones.dbf"] {
            let scenario =
                |file: &str| format!("[body]\ngravity_m_s2 = 1.62\n[surface]\nfriction_coefficient = 0.6\nkeep_out = \"{file}\"\n");
            desk.write("zone.toml", scenario(name));
            let slice = ["slice", "map.tif", "--from", "1,6", "--to", "15,6", "--scenario", "zone.toml"];
            let message = desk.run(&slice).stderr;
            if projection.is_none() && name == "zones.kml" {
                desk.refused(&slice, &["this is a KML file", "state the projection", "gdal_translate -a_srs"]);
                continue;
            }
            desk.refused(
                &slice,
                &["keep-out zones", "expected polygons as GeoJSON in the terrain's map coordinates", "convert it with: ogr"],
            );
            let (_, advice) = message.split_once("convert it with: ").unwrap();
            let (command, file) = advice.split_once("; then give ").unwrap();
            let file = file.split(" as keep_out").next().unwrap();
            fs::remove_file(desk.path().join(file)).ok();
            let ran = Command::new("sh")
                .current_dir(desk.path())
                .args(["-c", &format!("PATH=/usr/bin:$PATH; {command}")])
                .output()
                .unwrap();
            assert!(ran.status.success(), "{body} {name}: {command}: {}", String::from_utf8_lossy(&ran.stderr));
            desk.write("zone.toml", scenario(file));
            let ran = desk.run(&slice);
            assert_eq!(ran.status, 0, "{body} {name}: {}", ran.stderr);
            let parts = kept(&ran.stdout);
            let (from, to) = (parts.first().unwrap().0, parts.last().unwrap().1);
            // The zone from x = 4 to 8 m on the map, 3 to 7 m along the slice; degrees of 12 decimals are sub-millimetre.
            assert!((from - 3.0).abs() < 1e-3 && (to - 7.0).abs() < 1e-3, "{body} {name}: {from} to {to}; {command}");
        }
        for name in ["zones.shp", "zones.gpkg", "zones.geojson", "zones.shx", "zones.dbf", "zones.prj", "zones.cpg"] {
            fs::remove_file(desk.path().join(name)).ok();
        }
    }
}

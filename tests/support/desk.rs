//! A workspace for tests of the command: a temporary folder with some files, and the results of runs in it.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{collections::BTreeMap, fs, path::Path, process::Command};

use chta::terrain::{Dem, read_geotiff_bytes};
use tempfile::TempDir;

/// A mesh of one tilted face with four corners.
const PLATE: &str = "v 0 0 1\nv 9 0 2\nv 9 9 2\nv 0 9 1\nf 1 2 3 4\n";

/// Two bumps, 40 m.
pub(crate) const CHAIN: &str = "x_m,z_m\n0,0\n10,2\n20,0\n30,1\n40,0\n";

/// Hops over [`CHAIN`] on Mars.
pub(crate) const SCENARIO: &str = "[body]\nname = \"mars\"\n\n[hopper]\ntakeoff_speed_max_m_s = 10.0\nlanding_speed_max_m_s = 10.0\n\n\
    [surface]\nfriction_coefficient = 0.6\n\n[terrain]\nchain = \"chain.csv\"\nstart_x_m = 0\ngoal_x_m = 40\n";

/// Hops over the raster of [`Desk::with_dem`].
pub(crate) const ON_MAP: &str = "[body]\nname = \"mars\"\n\n[hopper]\ntakeoff_speed_max_m_s = 6.0\nlanding_speed_max_m_s = 6.0\n\n\
    [surface]\nfriction_coefficient = 0.8\n\n[terrain]\ndem = \"ground.tif\"\nstart_m = [1, 2]\ngoal_m = [15, 12]\n\n\
    [search]\nnode_spacing_max_m = 1.0\n";

/// Explicit constraints in forward direction only.
pub(crate) const FORWARD_ONLY: &str = "x_m,z_m,takeoff_min_deg,takeoff_max_deg,takeoff_speed_max_m_s,landing_min_deg,landing_max_deg,\
    landing_speed_max_m_s\n0,0,5,80,30,-80,-5,60\n10,0,,,,,,\n";

/// A robot with four legs.
pub(crate) const FOUR_LEGS: &str = include_str!("../../data/robots/four_legs.toml");
const FOUR_LEGS_URDF: &str = include_str!("../../data/robots/four_legs.urdf");

/// A floor with a box across it, which only a jump crosses.
pub(crate) const ACROSS: &str = "[arena]\nsize_m = [9, 6]\nstart_m = [1, 3]\ngoal_m = [8, 4]\n\n[jumper]\nspeed_m_s = 1.5\nwheelbase_m = 0.2\n\
    jump_time_s = 0.5\nrise_max_m = 0.6\n\n[[box]]\ncentre_m = [4, 3]\nsize_m = [2, 6]\nheight_m = 0.5\n";

/// A folder with `chain.csv` and `scenario.toml`.
pub(crate) struct Desk {
    folder: TempDir,
}

/// The result of a run.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Ran {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs the command in a folder; returns status, standard output and standard error.
pub(crate) fn chta(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_chta"));
    let output = command.current_dir(folder).args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    assert!(!stderr.contains("panicked"), "{args:?} panicked: {stderr}");
    (output.status.code().unwrap_or(-1), stdout, stderr)
}

/// A raster of results. Its unit is taken away first: the reader of DEMs refuses every unit that is no length.
pub(crate) fn raster(file: &Path) -> Dem {
    let mut bytes = fs::read(file).unwrap();
    for at in 0..bytes.len().saturating_sub(8) {
        if bytes[at..at + 8].eq_ignore_ascii_case(b"unittype") {
            bytes[at..at + 8].copy_from_slice(b"no__unit");
        }
    }
    read_geotiff_bytes(bytes).unwrap()
}

/// Runs a line of the shell in a folder, which must succeed; returns its standard output.
pub(crate) fn shell(folder: &Path, line: &str) -> String {
    let output = Command::new("sh").current_dir(folder).args(["-c", line]).output().unwrap();
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

impl Desk {
    pub(crate) fn new() -> Self {
        let desk = Self { folder: tempfile::tempdir().unwrap() };
        desk.write("chain.csv", CHAIN);
        desk.write("scenario.toml", SCENARIO);
        desk
    }

    /// The same folder with `ground.tif`, `map.toml` and `plate.obj`.
    pub(crate) fn with_dem() -> Self {
        let desk = Self::new();
        desk.write("map.toml", ON_MAP);
        desk.write("plate.obj", PLATE);
        let made = desk.run(&["synth", "--rows", "20", "--cols", "20", "-o", "ground.tif"]);
        assert_eq!((made.status, made.stderr.as_str()), (0, ""));
        desk
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a robot that names the joints of the one with four legs, and these.
    pub(crate) fn write_legs(&self, name: &str, robot: &str) {
        self.write(name, robot);
        self.write("four_legs.urdf", FOUR_LEGS_URDF);
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path().join(name), content).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Runs the command in this folder.
    pub(crate) fn run(&self, args: &[&str]) -> Ran {
        let (status, stdout, stderr) = chta(self.path(), args);
        Ran { status, stdout, stderr }
    }

    /// Runs the command, which must succeed (status 0 or 1), and returns its document.
    pub(crate) fn json(&self, args: &[&str]) -> serde_json::Value {
        let args = [args, &["--format", "json"]].concat();
        let ran = self.run(&args);
        assert!(ran.status < 2, "{args:?}: {}", ran.stderr);
        serde_json::from_str(&ran.stdout).unwrap_or_else(|error| panic!("{args:?}: {error} in {}", ran.stdout))
    }

    /// All files below the folder: name, size and bytes (of huge files only the size).
    pub(crate) fn files(&self) -> BTreeMap<String, (u64, Vec<u8>)> {
        fn add(folder: &Path, prefix: &str, files: &mut BTreeMap<String, (u64, Vec<u8>)>) {
            for entry in fs::read_dir(folder).unwrap() {
                let entry = entry.unwrap();
                let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
                let size = entry.metadata().unwrap().len();
                if entry.file_type().unwrap().is_dir() {
                    files.insert(format!("{name}/"), (0, Vec::new()));
                    add(&entry.path(), &format!("{name}/"), files);
                } else {
                    let bytes = if size > 10_000_000 { Vec::new() } else { fs::read(entry.path()).unwrap() };
                    files.insert(name, (size, bytes));
                }
            }
        }
        let mut files = BTreeMap::new();
        add(self.path(), "", &mut files);
        files
    }

    /// Runs a command that must be refused: status 2, nothing on standard output, all `parts` on standard error, and no file
    /// changed.
    pub(crate) fn refused(&self, args: &[&str], parts: &[&str]) {
        let before = self.files();
        let ran = self.run(args);
        assert_eq!(ran.status, 2, "{args:?}: {ran:?}");
        assert_eq!(ran.stdout, "", "{args:?} wrote to standard output");
        for part in parts {
            assert!(ran.stderr.contains(part), "{args:?} does not say `{part}` in:\n{}", ran.stderr);
        }
        assert!(ran.stderr.starts_with("error: "), "{args:?}: {}", ran.stderr);
        assert!(self.files() == before, "{args:?} left or changed a file: {:?}", self.files().keys());
    }
}

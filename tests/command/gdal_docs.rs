//! The commands of the documents that begin with a tool of GDAL.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its folder should stop")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::{fs, path::Path, process::Command};

/// What a block says, after its commands.
const ANSWERS: [&[&str]; 4] = [
    &["traversable, 25 hops"],
    &["at most 65 hops", "longest outage of layer sun 458"],
    &["hops against layer:slope", "65.2488"],
    &[
        "at most 35 hops",
        "longest outage of layer link 425",
        "longest outage of layer sun 245",
        "hops    -   36   35",
        "polar_thruster.toml",
    ],
];

#[test]
fn commands_behind_a_tool_of_gdal_run_and_answer_as_the_document_says() {
    if Command::new("gdal_viewshed").arg("--version").output().is_err() {
        eprintln!("skipped: gdal_viewshed is not installed");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = assert_cmd::cargo::cargo_bin("chta");
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let document = fs::read_to_string(root.join("docs/missions.md")).unwrap();
    let blocks: Vec<&str> = document.split("```sh\n").skip(1).filter_map(|block| block.split("```").next()).collect();
    let of_gdal: Vec<&str> = blocks.into_iter().filter(|block| block.starts_with("gdal")).collect();
    assert_eq!(of_gdal.len(), ANSWERS.len());
    for (block, answers) in of_gdal.into_iter().zip(ANSWERS) {
        let folder = tempfile::tempdir().unwrap();
        // Layers are named from the scenario's folder.
        copy(&root.join("data"), &folder.path().join("data"));
        let ran = Command::new("sh").args(["-ec", block]).env("PATH", &path).current_dir(folder.path()).output().unwrap();
        let [out, err] = [&ran.stdout, &ran.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
        assert!(ran.status.success(), "{block}: {err}");
        for answer in answers {
            assert!(out.contains(answer), "{block}: {answer:?} is missing in {out}");
        }
    }
}

/// The rasters and scenarios of a folder.
fn copy(from: &Path, to: &Path) {
    for folder in ["terrain", "missions", "scenarios"] {
        fs::create_dir_all(to.join(folder)).unwrap();
        for entry in fs::read_dir(from.join(folder)).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), to.join(folder).join(entry.file_name())).unwrap();
        }
    }
}

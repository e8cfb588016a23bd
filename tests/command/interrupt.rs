//! Ctrl-C: what was there stays as it was, and nothing half-written lies beside it.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{
    collections::BTreeSet,
    fs,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::desk::Desk;

fn names(desk: &Desk) -> BTreeSet<String> {
    fs::read_dir(desk.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Interrupts a map of many seconds as soon as its files are begun.
fn interrupted_by(signal: &str) {
    let desk = Desk::new();
    assert_eq!(desk.run(&["synth", "--rows", "700", "--cols", "700", "-o", "ground.tif"]).status, 0);
    desk.write("mobility.tif", "of yesterday");
    let before = names(&desk);
    let mut map = Command::new(env!("CARGO_BIN_EXE_chta"))
        .current_dir(desk.path())
        .args(["map", "ground.tif", "--start", "350,350", "--body", "moon", "-o", "hops.tif", "--mobility", "mobility.tif"])
        .args(["--set", "hopper.takeoff_speed_max_m_s=8", "--set", "hopper.landing_speed_max_m_s=8"])
        .args(["--set", "surface.friction_coefficient=0.6"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // Files are begun before the work: the interrupt falls into it.
    while names(&desk).iter().filter(|name| name.starts_with(".chta-")).count() < 2 {
        assert_eq!(map.try_wait().unwrap(), None, "ended before it could be interrupted");
        thread::sleep(Duration::from_millis(5));
    }
    // The shell's own kill: not every machine has a program of that name.
    assert!(Command::new("sh").args(["-c", &format!("kill {signal} {}", map.id())]).status().unwrap().success());
    assert_eq!(map.wait().unwrap().code(), Some(130));
    assert_eq!(names(&desk), before, "nothing new, nothing half");
    assert_eq!(desk.read("mobility.tif"), "of yesterday");
}

#[test]
fn an_interrupt_leaves_no_file_behind() {
    interrupted_by("-INT");
}

#[test]
fn a_request_to_end_leaves_no_file_behind() {
    interrupted_by("-TERM");
}

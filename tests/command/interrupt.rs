//! Ctrl-C: existing files are unchanged, and no incomplete file is left.

#![allow(clippy::unwrap_used, reason = "a test that cannot prepare its files should stop")]

use std::{
    collections::BTreeSet,
    fs,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::desk::Desk;

fn names(desk: &Desk) -> BTreeSet<String> {
    fs::read_dir(desk.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Interrupts a map of many seconds as soon as its files have been created.
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
    // Files are created before the computation, so the interrupt comes during it.
    while names(&desk).iter().filter(|name| name.starts_with(".chta-")).count() < 2 {
        assert_eq!(map.try_wait().unwrap(), None, "ended before it could be interrupted");
        thread::sleep(Duration::from_millis(5));
    }
    send(signal, &map);
    assert_eq!(map.wait().unwrap().code(), Some(130));
    assert_eq!(names(&desk), before, "nothing new, nothing half");
    assert_eq!(desk.read("mobility.tif"), "of yesterday");
}

fn send(signal: &str, process: &Child) {
    // The shell's builtin `kill`: not every machine has the program.
    assert!(Command::new("sh").args(["-c", &format!("kill {signal} {}", process.id())]).status().unwrap().success());
}

/// A command that waits for a reader of the pipe that it writes to, so it reports no progress.
fn waiting_for_a_reader(desk: &Desk) -> Child {
    assert!(Command::new("mkfifo").arg("pipe.asc").current_dir(desk.path()).status().unwrap().success());
    let waiting = Command::new(env!("CARGO_BIN_EXE_chta"))
        .current_dir(desk.path())
        .args(["synth", "--rows", "9", "--cols", "9", "-o", "pipe.asc"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    thread::sleep(Duration::from_millis(200));
    waiting
}

#[test]
fn an_interrupt_ends_work_that_reports_nothing() {
    let desk = Desk::new();
    let mut waiting = waiting_for_a_reader(&desk);
    assert_eq!(waiting.try_wait().unwrap(), None, "nothing to wait for");
    send("-INT", &waiting);
    let begun = Instant::now();
    assert_eq!(waiting.wait().unwrap().code(), Some(130));
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?} after the interrupt", begun.elapsed());
}

#[test]
fn a_second_interrupt_ends_the_program_at_once() {
    let desk = Desk::new();
    let mut waiting = waiting_for_a_reader(&desk);
    send("-INT", &waiting);
    thread::sleep(Duration::from_millis(50));
    // On a busy machine the first one may already have ended it.
    if waiting.try_wait().unwrap().is_none() {
        send("-INT", &waiting);
    }
    assert_eq!(waiting.wait().unwrap().code(), Some(130));
}

/// Every command with a long stage: an interrupt ends it with status 130 and without a result.
#[test]
fn an_interrupted_command_prints_no_answer() {
    let desk = Desk::new();
    desk.write(
        "long.toml",
        "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 8.0\nlanding_speed_max_m_s = 8.0\n[surface]\n\
         friction_coefficient = 0.6\n[terrain]\nchain = \"chain.csv\"\nstart_x_m = 1.0\ngoal_x_m = 3990.0\n[uncertainty]\n\
         takeoff_speed_sigma_fraction = 0.001\ntrials = 100000000\ngoal_tolerance_m = 5.0\n",
    );
    let rows: Vec<_> = (0..=4000).map(|i| format!("{i},{}", f64::from(i * i % 7) * 0.05)).collect();
    desk.write("chain.csv", format!("x_m,z_m\n{}\n", rows.join("\n")));
    let commands: [&[&str]; 3] = [
        &["simulate", "long.toml", "--format", "json"],
        &["check", "long.toml", "--set", "search.points_per_segment=31", "--set", "hopper.takeoff_speed_max_m_s=60"],
        &["trade", "long.toml", "--vary", "hopper.takeoff_speed_max_m_s=4:8:400", "--set", "search.points_per_segment=7"],
    ];
    for words in commands {
        let command = Command::new(env!("CARGO_BIN_EXE_chta"))
            .current_dir(desk.path())
            .args(words)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        thread::sleep(Duration::from_millis(400));
        send("-INT", &command);
        let ended = command.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(130), "{words:?}: {message}");
        assert_eq!((ended.stdout.len(), message.as_ref()), (0, ""), "{words:?}");
    }
}

#[test]
fn an_interrupt_leaves_no_file_behind() {
    interrupted_by("-INT");
}

#[test]
fn a_request_to_end_leaves_no_file_behind() {
    interrupted_by("-TERM");
}

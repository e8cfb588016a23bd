//! `--no-data` and `terrain.no_data` of every command that reads terrain, and the sentence that names them.

use crate::desk::Desk;

/// A plain at 100 to 105 m whose middle third is a number, 13 x 9 posts 2 m apart, as ASCII grid with this no-data value.
fn grid(block: &str, stated: &str) -> String {
    let row = |y: usize| -> String {
        (0..13)
            .map(|x| if (5..8).contains(&x) && y > 2 { block.to_owned() } else { format!("{}.25 ", 100 + (x * y) % 6) } + " ")
            .collect()
    };
    let rows: Vec<String> = (0..9).map(row).collect();
    format!("ncols 13\nnrows 9\nxllcenter 1000\nyllcenter 2000\ncellsize 2\n{stated}{}\n", rows.join("\n"))
}

const HOPPER: &str = "[body]\nname = \"moon\"\n[hopper]\ntakeoff_speed_max_m_s = 4\nlanding_speed_max_m_s = 4\n[surface]\nfriction_coefficient = \
                      0.8\nrest_slope_max_deg = 60\n";

fn desk() -> Desk {
    let desk = Desk::new();
    // -32767 is a usual mark; -9999 would be the format's own.
    desk.write("ground.asc", grid("-32767", "NODATA_value -1\n"));
    desk.write("hopper.toml", HOPPER);
    let on_dem = format!("{HOPPER}[terrain]\ndem = \"ground.asc\"\nstart_m = [1001, 2005]\ngoal_m = [1023, 2005]\n");
    desk.write("dem.toml", format!("{on_dem}[uncertainty]\ntrials = 10\ntakeoff_speed_sigma_m_s = 0.01\n"));
    desk.write("chain.csv", "x_m,z_m\n0,100\n4,101\n8,-32767\n12,102\n16,103\n");
    desk
}

/// Every command over a raster refuses an unstated mark with both ways out, obeys the stated value (a gap is met, or unreachable), and
/// takes `none` at the user's word.
#[test]
fn every_command_over_a_raster_refuses_a_mark_until_it_is_stated() {
    let desk = desk();
    let (slice, map, fan) =
        (["--from", "1001,2005", "--to", "1023,2005"], ["--start", "1001,2005", "--goal", "1023,2005"], ["--from", "1001,2005"]);
    let vary = ["--vary", "hopper.takeoff_speed_max_m_s=2:4:2"];
    let commands: Vec<Vec<&str>> = vec![
        [&["slice", "ground.asc"][..], &slice].concat(),
        [&["map", "ground.asc", "--scenario", "hopper.toml"][..], &map].concat(),
        [&["fan", "ground.asc", "--scenario", "hopper.toml", "--length", "20", "--headings", "4"][..], &fan].concat(),
        vec!["hop", "dem.toml"],
        vec!["check", "dem.toml"],
        vec!["plan", "dem.toml"],
        vec!["simulate", "dem.toml"],
        vec!["require", "dem.toml", "--vary", "hopper.takeoff_speed_max_m_s"],
        [&["trade", "dem.toml"][..], &vary].concat(),
    ];
    for command in commands {
        let with = |rule: &'static str| [&command[..], &[rule]].concat();
        desk.refused(
            &command,
            &["ground.asc", "-32767", "usual mark", "terrain.no_data = \"none\"", "--no-data=-32767", "--no-data none"],
        );
        let stated = desk.run(&with("--no-data=-32767"));
        match command[0] {
            "map" | "fan" => assert!(stated.status < 2, "{command:?}: {stated:?}"),
            _ => assert!(stated.status == 2 && stated.stderr.contains("no-data"), "{command:?}: {stated:?}"),
        }
        let elevation = desk.run(&with("--no-data=none"));
        assert!(elevation.status < 2, "{command:?}: {elevation:?}");
        assert_ne!(elevation.stdout, stated.stdout, "{command:?}");
        if command[0] != "slice" {
            let by_key = desk.run(&[&command[..], &["--set", "terrain.no_data=none"]].concat());
            assert_eq!((by_key.status, by_key.stdout), (elevation.status, elevation.stdout), "{command:?}");
        }
    }
}

#[test]
fn a_chain_with_a_mark_is_refused_by_its_line_until_it_is_stated_to_be_ground() {
    let desk = desk();
    let ends = ["--start", "0", "--goal", "16", "--scenario", "hopper.toml"];
    for command in ["check", "plan", "simulate"] {
        let base = [&[command, "chain.csv"][..], &ends].concat();
        desk.refused(&base, &["chain.csv", "line 4", "`-32767`", "usual mark", "no gaps"]);
        desk.refused(&[&base[..], &["--no-data=-32767"]].concat(), &["line 4", "states as missing"]);
        let ran = desk.run(&[&base[..], &["--no-data", "none"]].concat());
        assert!(ran.status < 2, "{command}: {ran:?}");
    }
    desk.refused(
        &["check", "chain.csv", "--start", "0", "--goal", "4", "--no-data", "x"],
        &["--no-data", "\"x\"", "a number, or \"none\""],
    );
}

/// The rule is part of the scenario of a result, which repeats it; the files beside a raster are among its inputs.
#[test]
fn a_result_repeats_the_rule_and_lists_the_files_beside_the_raster() {
    let desk = desk();
    desk.write("ground.asc", grid("7", ""));
    desk.write(
        "ground.asc.aux.xml",
        "<PAMDataset><PAMRasterBand band=\"1\"><NoDataValue>-1</NoDataValue></PAMRasterBand></PAMDataset>",
    );
    let map = ["map", "ground.asc", "--start", "1001,2005"];
    let first = desk.json(&[&map[..], &["--scenario", "hopper.toml", "--no-data", "7"]].concat());
    assert_eq!(first["scenario"]["terrain"]["no_data"], 7.0);
    let names: Vec<&str> = first["inputs"].as_array().unwrap().iter().map(|input| input["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"ground.asc") && names.contains(&"ground.asc.aux.xml"), "{names:?}");
    desk.write("first.json", first.to_string());
    assert_eq!(desk.json(&[&map[..], &["--scenario", "first.json"]].concat()), first);
}

//! Every scenario that the program writes reads back equal.

use std::fmt::Write;

use chta::planner::Amount;
use chta::scenario::{CATALOGUE, Entries, Key, Kind, Scenario, scenario_document};
use proptest::{prelude::*, strategy::ValueTree};

/// A number in TOML: whole, short, long, at either bound.
fn number(min: f64, max: f64) -> BoxedStrategy<String> {
    let within = move |number: f64| number.clamp(min, max);
    prop_oneof![
        Just(format!("{min:?}")),
        Just(format!("{max:?}")),
        (0..=100_i32).prop_map(move |whole| format!("{:?}", within(f64::from(whole)))),
        (0.0..1.0_f64).prop_map(move |share| format!("{:?}", within(min + share * (max - min)))),
        (-9.0..9.0_f64).prop_map(move |power| format!("{:?}", within(10_f64.powf(power)))),
        (-9000..9000_i32).prop_map(move |hundredths| format!("{:?}", within(f64::from(hundredths) / 100.0))),
    ]
    .boxed()
}

/// A number above 0 for one of at most 0.
fn over(text: &str) -> String {
    format!("{:?}", 1.5 - text.parse::<f64>().unwrap_or(0.0))
}

/// Whether a key has no meaning for a free route over a mesh.
fn is_off_a_mesh(key: &Key) -> bool {
    matches!(
        (key.table, key.name),
        ("surface", "keep_out" | "keep_in" | "friction_raster")
            | ("hopper", "footprint_m" | "roughness_max_m")
            | ("contact" | "layer", _)
            | ("terrain", "start_x_m" | "goal_x_m" | "accept_map_scale" | "via_m" | "via_lonlat_deg")
            | ("search", "points_per_segment" | "node_spacing_max_m" | "split" | "risk" | "risk_extra_hops_max")
            | ("budget", "estimated_success_min")
    )
}

/// A valid value for a key, in TOML.
fn value(key: &Key) -> BoxedStrategy<String> {
    let two = |min: f64, max: f64| (number(min, max), number(min, max));
    match key.kind {
        Kind::Number { min, max } => number(min, max),
        Kind::AngleOrUnlimited => prop_oneof![number(0.0, 90.0), Just("inf".to_owned()), Just("\"inf\"".to_owned())].boxed(),
        Kind::AngleRange => two(-360.0, 360.0)
            .prop_map(|(a, b)| {
                let order = a.parse::<f64>().unwrap_or(0.0) <= b.parse::<f64>().unwrap_or(0.0);
                if order { format!("[{a}, {b}]") } else { format!("[{b}, {a}]") }
            })
            .boxed(),
        Kind::MapPoint => two(-1e12, 1e12).prop_map(|(x, y)| format!("[{x}, {y}]")).boxed(),
        // A third number is added where the scenario has a mesh as it stands.
        Kind::MapOrSpacePoint => two(-1e12, 1e12).prop_map(|(x, y)| format!("[{x}, {y}]")).boxed(),
        Kind::SpaceBounds => {
            let three = || (number(-9.0, 0.0), number(-9.0, 0.0), number(-1e9, 0.0));
            (three(), three())
                .prop_map(|((a, b, c), (d, e, f))| format!("[[{a}, {b}, {c}], [{}, {}, {}]]", &over(&d), &over(&e), &over(&f)))
                .boxed()
        }
        Kind::LonLat => (number(-180.0, 360.0), number(-90.0, 90.0)).prop_map(|(lon, lat)| format!("[{lon}, {lat}]")).boxed(),
        Kind::LonLats => {
            let place = (number(-180.0, 360.0), number(-90.0, 90.0)).prop_map(|(lon, lat)| format!("[{lon}, {lat}]"));
            proptest::collection::vec(place, 1..4).prop_map(|places| format!("[{}]", places.join(", "))).boxed()
        }
        Kind::Flag => any::<bool>().prop_map(|flag| flag.to_string()).boxed(),
        Kind::MapPoints => proptest::collection::vec(two(-1e12, 1e12).prop_map(|(x, y)| format!("[{x}, {y}]")), 1..4)
            .prop_map(|points| format!("[{}]", points.join(", ")))
            .boxed(),
        Kind::CountOrAuto => prop_oneof![Just("\"auto\"".to_owned()), (0..=100_000_u32).prop_map(|k| k.to_string())].boxed(),
        Kind::Count { .. } if key.name == "neighbours" => proptest::sample::select(vec!["8", "16", "32"]).prop_map(str::to_owned).boxed(),
        Kind::Count { min, max } => prop_oneof![
            Just(min.to_string()),
            Just(max.to_string()),
            (min..=max).prop_map(|count| count.to_string()),
            (min..=max.min(50)).prop_map(|count| count.to_string()),
        ]
        .boxed(),
        Kind::Speeds => proptest::collection::btree_set(1..1000_u32, 1..4)
            .prop_map(|tenths| {
                let speeds: Vec<_> = tenths.into_iter().map(|tenth| format!("{:?}", f64::from(tenth) / 10.0)).collect();
                format!("[{}]", speeds.join(", "))
            })
            .boxed(),
        Kind::FaceGroups => proptest::collection::btree_map("[a-z_]{1,6}", (0.0..2.0_f64, 0.0..90.0_f64, any::<bool>()), 1..4)
            .prop_map(|groups| {
                let group = |(name, (friction, rest_deg, keep_out)): (&String, &(f64, f64, bool))| {
                    format!("{name} = {{ friction_coefficient = {friction:?}, rest_slope_max_deg = {rest_deg:?}, keep_out = {keep_out} }}")
                };
                format!("{{ {} }}", groups.iter().map(group).collect::<Vec<_>>().join(", "))
            })
            .boxed(),
        Kind::Layer => (-1000..1000_i32, any::<bool>(), 0..3_usize)
            .prop_map(|(hundredths, both, applied)| {
                let min = f64::from(hundredths) / 100.0;
                let max = if both { format!(", max = {:?}", min + 0.5) } else { String::new() };
                let applies_to = ["\"contact\"", "\"flight\"", "[\"flight\", \"contact\"]"][applied];
                format!("{{ raster = \"a.tif\", min = {min:?}{max}, applies_to = {applies_to} }}")
            })
            .boxed(),
        Kind::SlipCurve => proptest::collection::btree_map(-89..89_i32, 0.0..0.9_f64, 0..4)
            .prop_map(|points| {
                let points: Vec<_> = points.iter().map(|(slope, share)| format!("[{slope}.0, {share:?}]")).collect();
                format!("[{}]", points.join(", "))
            })
            .boxed(),
        Kind::Amounts => proptest::sample::subsequence(Amount::ALL[..9].to_vec(), 1..4)
            .prop_shuffle()
            .prop_map(|amounts| format!("{:?}", amounts.iter().map(|amount| amount.name()).collect::<Vec<_>>()))
            .boxed(),
        Kind::NumberOrNone => {
            prop_oneof![Just("\"none\"".to_owned()), Just("\"-3.40282e+38\"".to_owned()), number(-1e6, 1e6)].boxed()
        }
        Kind::Word(words) => proptest::sample::select(words).prop_map(|word| format!("\"{word}\"")).boxed(),
        Kind::Text if key.name == "name" => Just("\"Mars\"".to_owned()).boxed(),
        Kind::Text => {
            "[a-zäöü/ .\\-]{1,12}".prop_filter("not empty", |text| !text.trim().is_empty()).prop_map(|t| format!("{t:?}")).boxed()
        }
    }
}

/// Random keys with valid values: often a valid scenario, often one whose keys exclude each other.
fn toml() -> impl Strategy<Value = String> {
    let keys: Vec<_> = CATALOGUE.iter().map(|key| proptest::option::of(value(key)).prop_map(move |value| (key, value))).collect();
    // Which of the mutually exclusive keys may stay.
    let choices = (0..4_u8, any::<bool>(), any::<bool>(), any::<bool>());
    (keys, choices).prop_map(|(keys, (ground, friction, points, degrees))| {
        // A mesh as it stands, with a free route over it.
        let in_space = ground == 3 && degrees;
        // Wheels, with what they need.
        let on_wheels = ground == 0 && points && degrees;
        // Targets, in one of their two forms.
        let on_targets = ground == 0 && points && !degrees;
        let kept = |key: &Key| match (key.table, key.name) {
            _ if in_space && is_off_a_mesh(key) => false,
            ("mission", "targets_m") => on_targets && friction,
            ("mission", "targets_lonlat_deg") => on_targets && !friction,
            ("mission", _) => on_targets,
            ("robot", _) => in_space && friction,
            ("drive", name) => on_wheels && name != "idle_power_w",
            ("search", "risk") | ("contact", _) if on_wheels => false,
            ("search", "planner" | "contacts_max" | "stand_off_m" | "bounds_m" | "seed" | "time_max_s") => in_space,
            ("terrain", "dem") => ground == 1,
            ("terrain", "mesh" | "mesh_scale") => ground == 3,
            ("terrain", "start_m" | "goal_m" | "via_m") => (ground == 1 && !degrees) || ground == 3,
            ("terrain", "start_lonlat_deg" | "goal_lonlat_deg" | "via_lonlat_deg") => ground == 1 && degrees,
            ("surface", "keep_out" | "keep_in") | ("layer", _) => ground != 2,
            // Random speeds exclude each other more often than not.
            ("hopper", "takeoff_speed_min_m_s") => !points && degrees,
            ("hopper", "takeoff_speed_levels_m_s") => !points && !degrees,
            ("surface", "friction_raster") => friction && ground != 2,
            ("terrain", "chain") => ground == 2,
            ("terrain", _) => ground > 0,
            ("surface", "friction_coefficient") | ("derating", "friction") => friction,
            ("surface", "takeoff_from_slope_deg" | "landing_from_slope_deg") => !friction,
            // Both or neither; a heading error only on a raster. An objective or a budget of totals excludes an effort, a weighing of risk,
            // a budget of success, and bounces beside a mission time.
            ("uncertainty", "height_sigma_m" | "height_correlation_m") | ("search", "risk") | ("contact", _) => degrees,
            ("uncertainty", "heading_sigma_deg" | "heading_bias_sigma_deg") => ground < 2,
            // A budget of success without errors, an energy without a mass, and shares that leave too little for other keys, are refused.
            ("budget", "estimated_success_min") => degrees && !points,
            ("search", "objective") => points && !degrees && friction,
            ("search", "effort") => !(points && !degrees && friction),
            // A heading that is not controlled goes with few other keys: a test of its own.
            ("budget", "energy_max_j")
            | ("search", "risk_extra_hops_max")
            | ("uncertainty", "heading" | "takeoff_speed_m_s" | "takeoff_angle_deg") => false,
            ("budget", _) => !degrees,
            ("derating", "landing_speed") => points && degrees,
            ("search", "points_per_segment")
            | ("derating", "takeoff_speed")
            | ("hopper", "roughness_max_m" | "takeoff_speed_max_m_s") => points,
            ("search", "node_spacing_max_m") => !points,
            _ => true,
        };
        let mut text = String::new();
        for (key, value) in sensible_hopper(&keys) {
            let value = match (key.table, key.name) {
                ("terrain", "mesh") if in_space => Some("\"cave.stl\"".to_owned()),
                ("mission", "targets_m" | "targets_lonlat_deg") if on_targets => Some("[[1.5, 2.0], [-7.25, 3.0]]".to_owned()),
                ("robot", "file") if in_space && friction => Some("\"legs.toml\"".to_owned()),
                ("drive", "speed_m_s") if on_wheels => Some("0.5".to_owned()),
                ("drive", "slope_up_max_deg") if on_wheels => Some("20.0".to_owned()),
                ("drive", "wheelbase_m") if on_wheels => Some("1.5".to_owned()),
                ("terrain", "route") if in_space => Some("\"free\"".to_owned()),
                ("terrain", "start_m" | "goal_m") if in_space => {
                    Some(value.map_or("[1.5, -2.0, 3.0]".to_owned(), |pair| pair.replace(']', ", -7.25]")))
                }
                _ => value,
            };
            if let Some(value) = value.filter(|_| kept(key)) {
                // Dotted keys, so that no table header is needed.
                let _ = writeln!(text, "{}.{} = {value}", key.table, key.name);
            }
        }
        text
    })
}

/// The keys of the hopper that fit each other: brakes with a touchdown speed that the landing speed limit allows, propellant below the
/// mass, and so on. The other choices are left to chance.
fn sensible_hopper<'a>(keys: &[(&'a Key, Option<String>)]) -> Vec<(&'a Key, Option<String>)> {
    let of = |name: &str| {
        let found = keys.iter().find(|(key, _)| key.table == "hopper" && key.name == name);
        found.and_then(|(_, value)| value.as_ref()).map(|value| value.parse::<f64>().unwrap_or(f64::NAN))
    };
    let (mass, isp) = (of("mass_kg"), of("isp_s"));
    let brakes = of("touchdown_speed_m_s").is_some_and(|speed| of("landing_speed_max_m_s").is_none_or(|most| speed <= most));
    let newer = of("preparation_time_s").is_some() || of("settling_time_s").is_some();
    let fits = |name: &str| match name {
        "landing" | "touchdown_speed_m_s" => brakes,
        "isp_s" | "preparation_energy_j" => mass.is_some(),
        "roughness_max_m" => of("footprint_m").is_some_and(|footprint_m| footprint_m > 0.0),
        "takeoff_speed_step_m_s" => {
            of("takeoff_speed_levels_m_s").is_none()
                && of("takeoff_speed_step_m_s").zip(of("takeoff_speed_max_m_s")).is_none_or(|(step, most)| step <= most)
        }
        "propellant_max_kg" => isp.is_some() && mass.zip(of("propellant_max_kg")).is_some_and(|(mass, most)| most < mass),
        "rest_time_s" => !newer,
        _ => true,
    };
    // Both coefficients or none.
    let is_given = |name: &str| keys.iter().any(|(key, value)| (key.table, key.name) == ("contact", name) && value.is_some());
    let bounces = is_given("restitution_normal") && is_given("restitution_tangential");
    let fitting = keys.iter().map(|(key, value)| match (key.table, key.name) {
        ("contact", _) if !bounces => (*key, None),
        ("hopper", "landing") if brakes => (*key, Some("\"braked\"".to_owned())),
        ("hopper", name) if !fits(name) => (*key, None),
        _ => (*key, value.clone()),
    });
    fitting.collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_reads_back_as_it_was(text in toml()) {
        if let Ok(scenario) = Scenario::new(Entries::from_toml(&text)) {
            let document = scenario_document(&scenario, &|path| path.to_string_lossy().into_owned());
            let written = serde_json::to_string_pretty(&document).map_err(|error| TestCaseError::fail(error.to_string()))?;
            let read: serde_json::Value = serde_json::from_str(&written).map_err(|error| TestCaseError::fail(error.to_string()))?;
            let again = Scenario::from_document(&read);
            prop_assert_eq!(again.as_ref(), Ok(&scenario), "{}\n{}", text, written);
            // Writing it again gives the same bytes.
            let second = again.map(|again| scenario_document(&again, &|path| path.to_string_lossy().into_owned()));
            prop_assert_eq!(second, Ok(document));
        }
    }
}

/// Enough scenarios of the generator above must be valid for its test to be useful.
#[test]
fn many_generated_scenarios_are_valid() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let valid = (0..500).filter(|_| {
        let tree = toml().new_tree(&mut runner);
        tree.is_ok_and(|tree| Scenario::new(Entries::from_toml(&tree.current())).is_ok())
    });
    let valid = valid.count();
    assert!(valid > 40, "only {valid} of 500");
}

/// Every key given is in the document with its value: none is lost.
#[test]
#[allow(clippy::too_many_lines, reason = "one table of the keys that others need")]
fn every_key_reaches_the_document() {
    let alone = |key: &Key| match key.kind {
        Kind::Number { max, .. } if max < 12.5 => "0.5",
        Kind::Number { .. } => "12.5",
        Kind::AngleOrUnlimited => "31.5",
        Kind::AngleRange => "[12.5, 60.25]",
        Kind::MapPoint | Kind::MapOrSpacePoint | Kind::LonLat => "[12.5, -3.0]",
        Kind::SpaceBounds => "[[-1.5, -2.0, -3.0], [1.0, 2.0, 3.5]]",
        Kind::Flag => "true",
        Kind::NumberOrNone => "-9999.5",
        Kind::Speeds => "[2.0, 4.5]",
        Kind::Amounts => "[\"energy\", \"hops\"]",
        Kind::FaceGroups => "{ ice = { friction_coefficient = 0.125, keep_out = true, rest_slope_max_deg = \"inf\" } }",
        Kind::Layer => "{ raster = 'a.tif', equals = 255.0, applies_to = 'flight' }",
        Kind::MapPoints | Kind::LonLats => "[[12.5, -3.0], [1.0, 2.0]]",
        Kind::SlipCurve => "[[-5.0, 0.0], [20.0, 0.25]]",
        Kind::Count { .. } if key.name == "neighbours" => "32",
        Kind::CountOrAuto | Kind::Count { .. } => "7",
        Kind::Word(words) => words[words.len() - 1],
        Kind::Text if key.name == "name" => "vesta",
        Kind::Text => "some text",
    };
    for key in &CATALOGUE {
        let mut entries = Entries::from_toml("body.gravity_m_s2 = 1\n");
        let mut with = |table: &str, name: &str, value: &str| entries.set("test", &format!("{table}.{name}={value}"));
        match (key.table, key.name) {
            ("budget", "estimated_success_min") => with("uncertainty", "goal_tolerance_m", "1"),
            ("surface", "takeoff_from_slope_deg") => with("surface", "landing_from_slope_deg", "[1, 2]"),
            ("surface", "landing_from_slope_deg") => with("surface", "takeoff_from_slope_deg", "[1, 2]"),
            ("terrain", "dem" | "start_m" | "goal_m" | "via_m" | "via_lonlat_deg") => {
                with("terrain", "dem", "x.tif");
                with("terrain", "start_m", "[0, 0]");
                with("terrain", "goal_m", "[0, 0]");
            }
            ("mission", name) => {
                with("terrain", "dem", "x.tif");
                with("terrain", "route", "free");
                with("terrain", "start_m", "[0, 0]");
                if !name.starts_with("targets") {
                    with("mission", "targets_m", "[[4, 5]]");
                }
            }
            ("drive", _) => {
                with("terrain", "dem", "x.tif");
                with("terrain", "route", "free");
                with("terrain", "start_m", "[0, 0]");
                with("terrain", "goal_m", "[0, 0]");
                with("hopper", "mass_kg", "50");
                with("drive", "speed_m_s", "0.5");
                with("drive", "slope_up_max_deg", "20");
                with("drive", "wheelbase_m", "2");
            }
            ("terrain", "start_lonlat_deg" | "goal_lonlat_deg") => {
                with("terrain", "dem", "x.tif");
                with("terrain", "start_lonlat_deg", "[0, 0]");
                with("terrain", "goal_lonlat_deg", "[0, 0]");
            }
            ("search", "planner" | "contacts_max" | "stand_off_m" | "bounds_m" | "seed" | "time_max_s") => {
                with("terrain", "mesh", "x.obj");
                with("terrain", "route", "free");
                with("terrain", "start_m", "[0, 0, 0]");
                with("terrain", "goal_m", "[0, 0, 1]");
            }
            ("terrain", "mesh" | "mesh_scale") => {
                with("terrain", "mesh", "x.obj");
                with("terrain", "start_m", "[0, 0]");
                with("terrain", "goal_m", "[0, 0]");
            }
            ("terrain", "start_x_m" | "goal_x_m") => with("terrain", "chain", "x.csv"),
            ("hopper", "landing") => with("hopper", "touchdown_speed_m_s", "1"),
            ("hopper", "touchdown_speed_m_s") => with("hopper", "landing", "braked"),
            ("hopper", "isp_s" | "preparation_energy_j") | ("budget", "energy_max_j") => with("hopper", "mass_kg", "50"),
            ("hopper", "propellant_max_kg") => {
                with("hopper", "mass_kg", "50");
                with("hopper", "isp_s", "200");
            }
            ("uncertainty", "heading" | "takeoff_speed_m_s" | "takeoff_angle_deg") => {
                with("terrain", "dem", "x.tif");
                with("terrain", "start_m", "[0, 0]");
                for (name, value) in [("heading", "uncontrolled"), ("takeoff_speed_m_s", "1"), ("takeoff_angle_deg", "45")] {
                    with("uncertainty", name, value);
                }
                with("uncertainty", "hop_limit", "3");
            }
            ("uncertainty", "height_sigma_m") => with("uncertainty", "height_correlation_m", "3"),
            ("uncertainty", "height_correlation_m") => with("uncertainty", "height_sigma_m", "3"),
            ("hopper", "roughness_max_m") => with("hopper", "footprint_m", "3"),
            ("contact", _) => {
                with("contact", "restitution_normal", "0.25");
                with("contact", "restitution_tangential", "0.25");
            }
            ("robot", "cone" | "up" | "headings") => with("robot", "file", "robot.toml"),
            ("search", "risk_extra_hops_max") => with("search", "risk", "traded"),
            _ => {}
        }
        with(key.table, key.name, alone(key));
        let scenario = Scenario::new(entries);
        assert!(scenario.is_ok(), "{}: {scenario:?}", key.path());
        let document = scenario.map(|scenario| scenario_document(&scenario, &|path| path.to_string_lossy().into_owned()));
        let written = document.map(|document| document[key.table][key.name].clone());
        // A table of tables is written in another notation there.
        let given = match key.kind {
            Kind::FaceGroups => r#"{"ice": {"friction_coefficient": 0.125, "keep_out": true, "rest_slope_max_deg": "inf"}}"#,
            Kind::Layer => r#"{"raster": "a.tif", "equals": 255.0, "applies_to": "flight"}"#,
            _ => alone(key),
        };
        let expected = given.parse().unwrap_or_else(|_| serde_json::Value::from(given));
        let same = written
            .as_ref()
            .is_ok_and(|written| *written == expected || (written.as_f64().is_some() && written.as_f64() == expected.as_f64()));
        assert!(same, "{} is {written:?}, given {expected}", key.path());
    }
}

/// The shipped scenarios, as files.
fn shipped() -> Vec<std::path::PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenarios");
    let mut files: Vec<_> = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files
}

#[test]
fn every_shipped_scenario_reads_back_from_its_document() {
    let files = shipped();
    assert!(files.len() >= 15, "{files:?}");
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        let scenario = Scenario::new(Entries::from_toml(&text));
        let scenario = scenario.unwrap_or_else(|problems| panic!("{}: {problems:?}", file.display()));
        let document = scenario_document(&scenario, &|path| path.to_string_lossy().into_owned());
        assert_eq!(Scenario::from_document(&document), Ok(scenario), "{}", file.display());
    }
}

/// Without a goal, and with the errors that have a meaning where the heading is not controlled.
#[test]
fn scenarios_without_a_plan_read_back_from_their_documents() {
    let always = "body.name = \"moon\"\nterrain.dem = \"x.tif\"\nterrain.start_m = [1.5, -2.0]\nuncertainty.heading = \"uncontrolled\"\n\
                  uncertainty.takeoff_speed_m_s = 0.25\nuncertainty.takeoff_angle_deg = 62.5\nuncertainty.hop_limit = 7\n";
    for more in [
        "",
        "uncertainty.trials = 12\nuncertainty.seed = 3\nuncertainty.takeoff_speed_sigma_fraction = 0.02\n",
        "uncertainty.friction_sigma = 0.1\nuncertainty.drift_along_sigma_m = 0.5\nuncertainty.takeoff_angle_bias_sigma_deg = 1.5\n",
        "uncertainty.height_sigma_m = 0.2\nuncertainty.height_correlation_m = 4.0\nuncertainty.distribution = \"uniform\"\n",
    ] {
        let scenario = Scenario::new(Entries::from_toml(&format!("{always}{more}")));
        let scenario = scenario.unwrap_or_else(|problems| panic!("{more}: {problems:?}"));
        let document = scenario_document(&scenario, &|path| path.to_string_lossy().into_owned());
        assert_eq!(Scenario::from_document(&document), Ok(scenario), "{document}");
        assert!(document["terrain"].get("goal_m").is_none(), "{document}");
    }
}

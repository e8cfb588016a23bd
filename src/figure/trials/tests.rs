//! Pictures of trials: contents, texts and legibility for any numbers.

use super::{
    super::{
        Flight, Picture,
        palette::{BLUE, ORANGE, SKY, VERMILION},
        samples::{check_picture, labels, texts},
        sheet::Mark,
    },
    *,
};
use crate::quantity::ChainPoint;

/// Pseudo-random numbers between 0 and 1, the same on every platform.
fn chance(i: usize, k: usize) -> f64 {
    (libm::sin(i as f64 * 12.9898 + k as f64 * 78.233) * 43_758.545_3).rem_euclid(1.0)
}

fn caption() -> Caption {
    Caption::new("Crater rim <B> & \"valley\"", "standard deviations: speed 0.02 m/s, drift 0.1 m; seed 7")
}

fn errors(count: u64, scale_m: f64) -> ErrorQuantiles {
    let at = |share: f64| scale_m * share;
    ErrorQuantiles {
        count,
        mean_m: at(0.9),
        q05_m: at(0.1),
        q25_m: at(0.4),
        q50_m: at(0.8),
        q75_m: at(1.2),
        q95_m: at(2.0),
        max_m: at(3.1),
    }
}

fn boxes(name: &str, landings: u32, trials: u64) -> LandingBoxes {
    let landing = |i: u32| errors(trials - trials / 20 * u64::from(i.min(15)), 0.3 + 0.2 * f64::from(i));
    LandingBoxes { name: name.to_owned(), landings: (0..landings).map(landing).collect() }
}

fn success(rate: f64, trials: u64) -> Success {
    let half = 1.96 * (rate * (1.0 - rate) / trials as f64).sqrt() + 1.0 / trials as f64;
    Success { rate, low: (rate - half).max(0.0), high: (rate + half).min(1.0) }
}

fn bars(policy: &str, reached: u64, trials: u64) -> OutcomeBars {
    let failed = trials - reached;
    let counts =
        [("reached", reached), ("missed", failed - failed / 3), ("slid_at_takeoff", failed / 3), ("damaged", 0), ("lost", 0)];
    let rate = reached as f64 / trials as f64;
    let ends = (1..=40).map(|i| (trials * i / 40).max(1));
    let point = |(i, n): (usize, u64)| ConvergencePoint {
        trials: n,
        success: success((rate + 0.1 * (chance(i, 1) - 0.5) / (i + 1) as f64).clamp(0.0, 1.0), n),
    };
    OutcomeBars {
        policy: policy.to_owned(),
        counts: counts.map(|(name, count)| (name.to_owned(), count)).to_vec(),
        success: success(rate, trials),
        convergence: ends.enumerate().map(point).collect(),
    }
}

fn flight(from: (f64, f64), to: (f64, f64), takeoff_slope: f64) -> Flight {
    Flight { from: ChainPoint::new(from.0, from.1), to: ChainPoint::new(to.0, to.1), takeoff_slope }
}

fn height(x_m: f64) -> f64 {
    3.0 * libm::sin(0.06 * x_m) + 0.8 * libm::sin(0.31 * x_m)
}

/// Hops of 14 m over waves; every fifth trial stops short.
fn flown(vertices: u32, hops: u32, trials: usize) -> FlownFigure {
    let length_m = 14.0 * f64::from(hops) + 30.0;
    let ground = (0..=vertices).map(|i| length_m * f64::from(i) / f64::from(vertices));
    let at = |x_m: f64| (x_m, height(x_m));
    let planned = (0..hops).map(|i| flight(at(10.0 + 14.0 * f64::from(i)), at(24.0 + 14.0 * f64::from(i)), 1.6));
    let trial = |i: usize| {
        let reached = !i.is_multiple_of(5);
        let mut x_m = 10.0;
        let flights = (0..if reached { hops } else { hops.div_ceil(2) }).map(|k| {
            let from = at(x_m);
            x_m = 24.0 + 14.0 * f64::from(k) + (chance(i, k as usize) - 0.5) * (1.0 + 0.5 * f64::from(k.min(6)));
            flight(from, at(x_m), 1.6 + 0.2 * (chance(i, k as usize + 50) - 0.5))
        });
        FlownTrial { flights: flights.collect(), reached }
    };
    FlownFigure {
        ground: ground.map(|x_m| ChainPoint::new(x_m, height(x_m))).collect(),
        planned: planned.collect(),
        trials: (0..trials).map(trial).collect(),
        trials_in_all: trials as u64 * 10,
    }
}

fn simulation(policies: &[&str], hops: u32, trials: usize) -> SimulationFigure {
    let reached = |i: usize| 8120 + 900 * i as u64;
    SimulationFigure {
        caption: caption(),
        flown: Some(flown(400, hops, trials)),
        errors: policies.iter().map(|policy| boxes(policy, hops, 10_000)).collect(),
        outcomes: policies.iter().enumerate().map(|(i, policy)| bars(policy, reached(i), 10_000)).collect(),
    }
}

fn lines_of(picture: &Picture, colour: plotters::style::RGBColor) -> Vec<&[(f64, f64)]> {
    let line =
        |mark| if let &Mark::Line { ref points, pen } = mark { (pen.colour == colour).then_some(points.as_slice()) } else { None };
    picture.sheet.marks.iter().filter_map(line).collect()
}

#[test]
fn a_simulation_is_a_page_for_each_figure() {
    for (name, policies) in [("simulation_one", &["open-loop"][..]), ("simulation_two", &["open-loop", "replan"])] {
        let figure = simulation(policies, 6, 60);
        let picture = check_picture(name, || draw_simulation(&figure).unwrap());
        let texts = texts(&picture);
        for words in [
            "x (m)",
            "height, z (m)",
            "distance error (m)",
            "share of trials (%)",
            "success rate (%)",
            "Did not occur: damaged, lost.",
        ] {
            assert!(texts.contains(words), "{name} lacks {words:?}: {texts}");
        }
        for policy in policies {
            assert!(texts.contains(&format!("{policy}: 10000 trials")), "{texts}");
        }
        let pages = picture.pages();
        let headings = ["Trajectories and landings", "Distance error, landing by landing", "How the trials ended"];
        assert_eq!(pages.len(), headings.len());
        // Of several policies the first one's flights are drawn, which the heading says.
        let named = format!("Trajectories and landings, {}", policies[0]);
        assert_eq!(texts.contains(&named), policies.len() > 1, "{texts}");
        for (page, heading) in pages.iter().zip(headings) {
            let texts = super::super::samples::texts(page);
            assert!(headings.iter().all(|one| texts.contains(one) == (*one == heading)), "{name}: {heading} and {texts}");
            assert!(texts.starts_with(&figure.caption.title) && page.pages().len() == 1, "{texts}");
        }
    }
}

#[test]
fn absent_data_is_omitted_from_the_sheet() {
    let whole = simulation(&["open-loop"], 4, 20);
    let no_flights = SimulationFigure { flown: None, ..whole.clone() };
    let picture = check_picture("simulation_without_flights", || draw_simulation(&no_flights).unwrap());
    assert!(!texts(&picture).contains("Trajectories"), "{}", texts(&picture));
    let mut no_landings = no_flights.clone();
    no_landings.errors[0].landings.iter_mut().for_each(|landing| landing.count = 0);
    let picture = check_picture("simulation_without_landings", || draw_simulation(&no_landings).unwrap());
    assert!(!texts(&picture).contains("Distance error") && picture.pages().len() == 1, "an empty panel: {}", texts(&picture));
    let empty = SimulationFigure { caption: caption(), ..SimulationFigure::default() };
    let mut few = bars("open-loop", 3, 4);
    few.convergence.drain(..39);
    let one_point = SimulationFigure { outcomes: vec![few.clone()], ..no_flights.clone() };
    let lettering = texts(&check_picture("simulation_one_point", || draw_simulation(&one_point).unwrap()));
    assert!(lettering.contains("is not drawn: it is noted after 10 trials") && !lettering.contains("95 % band"), "{lettering}");
    let alone = check_picture("convergence_one_point", || draw_convergence(&caption(), std::slice::from_ref(&few)).unwrap());
    assert!(texts(&alone).lines().any(|line| line == "4"), "the number of trials on the axis");
    let picture = check_picture("simulation_empty", || draw_simulation(&empty).unwrap());
    assert_eq!(labels(&picture).len(), 2, "only the caption: {}", texts(&picture));
}

#[test]
fn a_sheet_of_many_trials_hops_and_vertices_stays_small() {
    for (name, hops, trials) in [("simulation_many", 12, 3000), ("simulation_long", 400, 40)] {
        let mut figure = simulation(&["open-loop", "replan"], hops, trials);
        figure.flown = Some(flown(40_000, hops, trials));
        check_picture(name, || draw_simulation(&figure).unwrap());
    }
}

#[test]
fn thinned_trials_are_stated() {
    let all = flown(100, 4, 50);
    let picture = check_picture("flown", || draw_flown(&caption(), &FlownFigure { trials_in_all: 50, ..all.clone() }).unwrap());
    assert!(texts(&picture).contains("50 trials drawn"), "{}", texts(&picture));
    assert_eq!(lines_of(&picture, SKY).len(), 40 + 1, "the successful trials, and the legend");
    assert_eq!(lines_of(&picture, ORANGE).len(), 10 + 1);
    let dots = picture.sheet.marks.iter().filter(|mark| matches!(mark, Mark::Dot { pen, .. } if pen.colour == BLUE)).count();
    assert_eq!(dots, 40 * 4 + 10 + 1, "each landing but the last of failed trials, and the legend");
    // Crosses of two strokes: over the ground, among the landings, in the legend.
    assert_eq!(lines_of(&picture, VERMILION).len(), 2 * (10 + 10 + 1));
    let many = flown(100, 4, 1000);
    let picture = check_picture("flown_many", || draw_flown(&caption(), &many).unwrap());
    // 3 600 flights: every ninth trial for 400 of them; 600 landings from every sixth.
    assert!(texts(&picture).contains("112 of 10000 trials drawn, landings of 167"), "{}", texts(&picture));
}

#[test]
fn drawn_flights_keep_their_parabola_and_their_ends() {
    // Level, 10 m, 45 deg: the apex is a quarter of the range up.
    let figure = FlownFigure {
        ground: vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(10.0, 0.0)],
        trials: vec![FlownTrial { flights: vec![flight((0.0, 0.0), (10.0, 0.0), 1.0)], reached: true }],
        ..FlownFigure::default()
    };
    let picture = check_picture("flown_one", || draw_flown(&caption(), &figure).unwrap());
    let lines = lines_of(&picture, SKY);
    let line = lines.iter().find(|line| line.len() > 2).unwrap();
    let (first, last) = (line[0], line[line.len() - 1]);
    let top = line.iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
    assert_eq!(first.1, last.1);
    let share = (first.1 - top) / (last.0 - first.0);
    assert!((share - 0.25).abs() < 2e-3, "{share}: {}", texts(&picture));
    assert!(texts(&picture).contains("1 trial drawn") && texts(&picture).contains("true scale"));
}

#[test]
fn degenerate_trials_are_drawn_and_missing_ground_is_refused() {
    let ground = vec![ChainPoint::new(0.0, 5.0), ChainPoint::new(40.0, 5.0)];
    let nan = flight((1.0, 5.0), (f64::NAN, 5.0), 1.0);
    let standing = flight((3.0, 5.0), (3.0, 5.0), f64::INFINITY);
    let reverse = flight((30.0, 5.0), (12.0, 5.0), 0.9);
    let falling = flight((30.0, 9.0), (36.0, 5.0), -0.2);
    let trial = |flights: &[Flight], reached| FlownTrial { flights: flights.to_vec(), reached };
    let cases = [
        ("flown_nothing", vec![], vec![]),
        ("flown_no_trials", vec![reverse], vec![]),
        (
            "flown_odd",
            vec![reverse, nan],
            vec![trial(&[nan, standing], false), trial(&[], true), trial(&[reverse, falling], false)],
        ),
        ("flown_same", vec![], vec![trial(&[flight((3.0, 5.0), (3.0, 5.0), 2.0)], true)]),
    ];
    for (name, planned, trials) in cases {
        let figure = FlownFigure { ground: ground.clone(), planned, trials, trials_in_all: 3 };
        check_picture(name, || draw_flown(&caption(), &figure).unwrap());
    }
    for points in [0, 1] {
        let figure = FlownFigure { ground: ground[..points].to_vec(), ..flown(10, 2, 3) };
        let refused = draw_flown(&caption(), &figure).unwrap_err();
        assert_eq!(refused, FigureError::NoGround { what: "the trials".to_owned(), points });
        let simulation = SimulationFigure { flown: Some(figure), ..SimulationFigure::default() };
        assert_eq!(draw_simulation(&simulation).unwrap_err(), refused);
    }
}

#[test]
fn boxes_are_at_their_quantiles() {
    let figure = LandingErrorFigure { caption: caption(), series: vec![boxes("", 7, 4000)] };
    let picture = check_picture("errors", || draw_landing_errors(&figure).unwrap());
    // The axis maps heights linearly: compare the filled boxes with each other.
    let areas: Vec<(f64, f64)> = picture
        .sheet
        .marks
        .iter()
        .filter_map(|mark| match mark {
            Mark::Area { points, colour, .. } if *colour == SKY => Some((points[0].1, points[2].1)),
            _ => None,
        })
        .collect();
    assert_eq!(areas.len(), 7 + 1, "seven boxes and the legend's");
    let heights = areas.iter().zip(&figure.series[0].landings).map(|((top, bottom), e)| (bottom - top) / (e.q75_m - e.q25_m));
    let heights: Vec<f64> = heights.collect();
    assert!(heights.iter().all(|mm_per_m| (mm_per_m / heights[0] - 1.0).abs() < 1e-9), "{heights:?}");
    for landing in &figure.series[0].landings {
        assert!(texts(&picture).lines().any(|line| line == landing.count.to_string()), "the count {} is missing", landing.count);
    }
    assert!(!texts(&picture).contains("beyond"), "every error is on the axis");
}

#[test]
fn far_errors_are_written_as_numbers_beyond_the_axis() {
    let mut series = vec![boxes("open-loop", 5, 1000), boxes("replan", 5, 1000)];
    series[1].landings[3].max_m = 12_345.0;
    series[1].landings[2] = ErrorQuantiles::default();
    series[0].landings[1].mean_m = f64::NAN;
    let picture = check_picture("errors_far", || {
        draw_landing_errors(&LandingErrorFigure { caption: caption(), series: series.clone() }).unwrap()
    });
    assert!(texts(&picture).contains("12345") && texts(&picture).contains("beyond the axis"), "{}", texts(&picture));
}

#[test]
fn box_plots_accept_any_numbers() {
    let all_equal =
        ErrorQuantiles { count: 1, mean_m: 2.0, q05_m: 2.0, q25_m: 2.0, q50_m: 2.0, q75_m: 2.0, q95_m: 2.0, max_m: 2.0 };
    let of = |landings: Vec<ErrorQuantiles>| vec![LandingBoxes { name: "one & <only>".to_owned(), landings }];
    let cases = [
        ("errors_none", vec![]),
        ("errors_no_landings", of(vec![])),
        ("errors_empty_places", of(vec![ErrorQuantiles::default(); 3])),
        ("errors_equal", of(vec![all_equal; 4])),
        ("errors_zero", of(vec![ErrorQuantiles { count: 9, ..ErrorQuantiles::default() }; 2])),
        ("errors_tiny", of(vec![errors(9, 1e-13); 3])),
        ("errors_huge", of(vec![errors(u64::MAX, 1e12); 30])),
        ("errors_many", (0..4).map(|i| boxes(["a", "b", "c", "d"][i], 300, 100_000)).collect()),
        ("errors_three", (0..3).map(|i| boxes(["a", "b", "c"][i], 12, 100_000)).collect()),
    ];
    for (name, series) in cases {
        check_picture(name, || draw_landing_errors(&LandingErrorFigure { caption: caption(), series: series.clone() }).unwrap());
    }
}

#[test]
fn outcome_bars_state_counts_shares_and_the_interval() {
    let two = [bars("open-loop", 8120, 10_000), bars("replan", 9999, 10_000)];
    let picture = check_picture("outcomes", || draw_outcomes(&caption(), &two).unwrap());
    let texts = texts(&picture);
    // 1880 failed: 1254 missed, 626 slid.
    for words in [
        "8120 (81.2 %)",
        "1254 (12.5 %)",
        "626 (6.3 %)",
        "9999 (> 99.9 %)",
        "1 (< 0.1 %)",
        "slid at take-off",
        "81.2 % (80.4 to 82.0 %)",
    ] {
        assert!(texts.contains(words), "{words:?} is missing: {texts}");
    }
}

#[test]
fn outcome_bars_accept_any_counts() {
    let none = OutcomeBars { policy: "open-loop".to_owned(), ..OutcomeBars::default() };
    let unknown = OutcomeBars { success: Success { rate: f64::NAN, ..Success::default() }, ..none.clone() };
    let cases = [
        ("outcomes_none", vec![]),
        ("outcomes_no_trials", vec![none]),
        ("outcomes_unknown", vec![unknown]),
        ("outcomes_one_trial", vec![bars("<open & loop>", 1, 1)]),
        ("outcomes_all", vec![bars("open-loop", 500, 500), bars("replan", 0, 500)]),
        ("outcomes_huge", vec![bars("open-loop", u64::MAX / 90, u64::MAX / 60); 2]),
    ];
    for (name, bars) in cases {
        check_picture(name, || draw_outcomes(&caption(), &bars).unwrap());
        check_picture(&name.replace("outcomes", "convergence"), || draw_convergence(&caption(), &bars).unwrap());
    }
}

#[test]
fn the_rate_converges_within_its_band() {
    let two = [bars("open-loop", 8120, 10_000), bars("replan", 9400, 10_000)];
    let picture = check_picture("convergence", || draw_convergence(&caption(), &two).unwrap());
    assert!(texts(&picture).contains("trials (logarithmic)") && texts(&picture).contains("95 % band"), "{}", texts(&picture));
    // The band narrows around the rate: equally many points on its lower and upper edge, narrower at the end than at the beginning.
    let band =
        picture.sheet.marks.iter().find_map(|mark| if let Mark::Area { points, .. } = mark { Some(points.clone()) } else { None });
    let band = band.unwrap();
    let half = band.len() / 2;
    let width = |i: usize| band[band.len() - 1 - i].1 - band[i].1;
    assert!(half >= 10 && width(0) > 2.0 * width(half - 1) && width(half - 1) > 0.0, "{band:?}");
    let short = OutcomeBars { convergence: two[0].convergence[20..].to_vec(), ..two[0].clone() };
    let picture = check_picture("convergence_short", || draw_convergence(&caption(), std::slice::from_ref(&short)).unwrap());
    assert!(!texts(&picture).contains("logarithmic"), "{}", texts(&picture));
}

#[test]
fn costs_of_errors_are_bars_from_zero() {
    let bar = |name: &str, rate: f64, half: f64| SensitivityBar {
        name: name.to_owned(),
        cost: Success { rate, low: rate - half, high: rate + half },
    };
    let bars = vec![
        bar("takeoff_angle_sigma_deg = 0.5", 0.31, 0.02),
        bar("takeoff_speed_sigma_fraction = 0.02", 0.12, 0.015),
        bar("position_sigma_m = 0.05", 0.0, 0.002),
        bar("friction_sigma = 0.02", -0.01, 0.008),
    ];
    let figure = SensitivityFigure { caption: caption(), bars };
    let picture = check_picture("sensitivity", || draw_sensitivity(&figure).unwrap());
    let labels = labels(&picture);
    for text in ["takeoff_angle_sigma_deg = 0.5", "31.00 (29.00 to 33.00)", "-1.00 (-1.80 to -0.20)", "percentage points"] {
        assert!(labels.iter().any(|label| label.text.contains(text)), "{text}");
    }
    for (name, bars) in [
        ("sensitivity_none", vec![]),
        ("sensitivity_zero", vec![bar("drift_along_sigma_m = 0.1", 0.0, 0.0)]),
        ("sensitivity_unknown", vec![bar("a", f64::NAN, 0.1), bar("b", 0.5, f64::INFINITY)]),
        ("sensitivity_negative", vec![bar("heading_sigma_deg = 1", -0.2, 0.05)]),
        ("sensitivity_many", (0..20).map(|i| bar(&format!("error {i}"), 0.9 - 0.04 * f64::from(i), 0.01)).collect()),
    ] {
        check_picture(name, || draw_sensitivity(&SensitivityFigure { caption: caption(), bars: bars.clone() }).unwrap());
    }
}

#[test]
fn cone_widths_show_hops_and_errors() {
    let point =
        |width_deg: f64, hops| ConeWidthPoint { width_deg, hops, errors: errors(hops.unwrap_or(0) * 1000, 0.02 * width_deg) };
    let points = vec![point(30.0, Some(9)), point(60.0, Some(4)), point(45.0, Some(1)), point(15.0, None), point(22.5, Some(17))];
    let figure = ConeWidthFigure { caption: caption(), points };
    let picture = check_picture("cone_width", || draw_cone_width(&figure).unwrap());
    let texts = texts(&picture);
    for words in ["(deg)", "(m)", "9 hops", "4 hops", "17 hops", "1 hop\n", "no path", "17000"] {
        assert!(texts.contains(words), "{words:?} is missing: {texts}");
    }
    let cases = [
        ("cone_width_none", vec![]),
        ("cone_width_one", vec![point(30.0, Some(3))]),
        ("cone_width_equal", vec![point(30.0, Some(3)); 3]),
        ("cone_width_no_path", vec![point(30.0, None), point(f64::NAN, Some(1)), point(40.0, None)]),
        ("cone_width_many", (1..90_u32).map(|i| point(f64::from(i), Some(u64::from(i) * 1_000_000))).collect()),
    ];
    for (name, points) in cases {
        check_picture(name, || draw_cone_width(&ConeWidthFigure { caption: caption(), points: points.clone() }).unwrap());
    }
}

//! Proofs, trades and comparisons: contents, texts and legibility.

use plotters::style::RGBColor;

use super::{
    super::{
        Caption, Picture,
        palette::{BLUE, ORANGE, VERMILION},
        samples::{check_picture, check_well_formed, labels, texts},
        sheet::Mark,
    },
    *,
};
use crate::{
    ballistics::limits::ClearanceProfile,
    chain::PolygonalChain,
    figure::FigureError,
    ground::{ContactPoint, Frame},
    path::Hop,
    quantity::{Angle, AngleInterval, ChainPoint},
    world::{ClearanceRule, Direction, Limit},
};

/// Waves between two x, a point every metre.
fn waves(from_x_m: f64, points: usize, height_m: f64) -> Vec<ChainPoint> {
    let point = |i: usize| {
        let x_m = i as f64;
        ChainPoint::new(from_x_m + x_m, height_m * (libm::sin(0.13 * x_m) + 0.4 * libm::cos(0.37 * x_m)))
    };
    (0..points).map(point).collect()
}

/// Flights of one length over a ground, left to right, each with a slope of take-off of 1.2.
fn flights(ground: &[ChainPoint], from_x_m: f64, hop_m: f64, hops: usize) -> Vec<Flight> {
    let at = |i: usize| profile::at_x(ground, from_x_m + i as f64 * hop_m);
    (0..hops).map(|i| Flight { from: at(i), to: at(i + 1), takeoff_slope: 1.2 }).collect()
}

fn stretch(from_x_m: f64, to_x_m: f64, class: ProofClass) -> ProofStretch {
    ProofStretch { from_x_m, to_x_m, class }
}

/// A pit that stops the journey.
fn stopped_proof() -> ProofFigure {
    use ProofClass::{Open, Reachable, Unreachable};
    let ground = waves(0.0, 101, 4.0);
    let at = |x_m| profile::at_x(&ground, x_m);
    ProofFigure {
        caption: Caption::new("A pit & <walls>", "from x = 5 m to x = 95 m; Moon, g = 1.624 m/s²; take-off speed ≤ 8 m/s"),
        start: at(5.0),
        goal: at(95.0),
        stretches: vec![
            stretch(0.0, 20.0, Reachable),
            stretch(20.0, 20.0, Unreachable),
            stretch(20.0, 38.0, Reachable),
            stretch(38.0, 44.0, Open),
            stretch(44.0, 44.0, Unreachable),
            stretch(44.0, 100.0, Unreachable),
        ],
        cell_boundaries_x_m: (0..=100).map(f64::from).collect(),
        path: Vec::new(),
        lower_bound: None,
        upper_bound: None,
        cells: 200,
        gap: Some(ProofGap {
            reached_x_m: 44.0,
            leads_to_goal_x_m: 61.25,
            refusals: vec![("take-off speed".to_owned(), 1234), ("landing cone".to_owned(), 87), ("clearance".to_owned(), 3)],
        }),
        ground,
    }
}

/// How often a colour is drawn as a line or an area.
fn marks_of(picture: &Picture, wanted: RGBColor) -> usize {
    let is_wanted = |mark: &&Mark| match mark {
        Mark::Line { pen, .. } | Mark::Dot { pen, .. } => pen.colour == wanted,
        Mark::Area { colour, .. } => *colour == wanted,
        Mark::Label(_) => false,
    };
    picture.sheet.marks.iter().filter(is_wanted).count()
}

fn assert_says(picture: &Picture, words: &[&str]) {
    let texts = texts(picture).replace('\n', " ");
    for words in words {
        assert!(texts.contains(words), "{words:?} is missing in {texts}");
    }
}

#[test]
fn a_proof_of_no_path_states_classes_gap_and_limits() {
    let figure = stopped_proof();
    let picture = check_picture("proof-stopped", || draw_proof(&figure).unwrap());
    assert_says(
        &picture,
        &[
            "proved: no path, at any resolution (200 cells)",
            "reachable: 38 m",
            "proved unreachable: 56 m",
            "open: 6 m",
            "gap 17.25 m",
            "x = 44 m",
            "x = 61.25 m",
            "take-off speed",
            "1234",
            "clearance",
            "ends of cells",
            "distance along the chain, x (m)",
            "height, z (m)",
            "start",
            "goal",
        ],
    );
    let (solid, hatched, dotted) = (marks_of(&picture, BLUE), marks_of(&picture, VERMILION), marks_of(&picture, ORANGE));
    assert_eq!(solid, 3, "two stretches and the legend's sample");
    assert!(hatched > 60 && dotted > 20, "strokes into the ground: {hatched}, dots: {dotted}");
    let svg = picture.to_svg().unwrap();
    assert!(svg.contains("A pit &amp; &lt;walls&gt;"), "escaped");
}

#[test]
fn a_proof_with_a_path_states_both_bounds() {
    let mut figure = stopped_proof();
    figure.gap = None;
    figure.path = flights(&figure.ground, 5.0, 9.0, 10);
    figure.stretches = vec![stretch(0.0, 100.0, ProofClass::Reachable)];
    (figure.lower_bound, figure.upper_bound) = (Some(10), Some(10));
    let picture = check_picture("proof-path", || draw_proof(&figure).unwrap());
    assert_says(&picture, &["proved: 10 hops and no fewer", "best path known", "reachable: 100 m"]);
    for (lower, upper, words) in [
        (Some(7), Some(10), "at least 7, at most 10"),
        (Some(1), None, "at least 1 hop"),
        (None, Some(1), "a path of 1 hop is known"),
    ] {
        let picture = draw_proof(&ProofFigure { lower_bound: lower, upper_bound: upper, ..figure.clone() }).unwrap();
        assert_says(&picture, &[words]);
    }
}

#[test]
fn long_proofs_with_many_stretches_and_hops_stay_small() {
    let classes = [ProofClass::Reachable, ProofClass::Unreachable, ProofClass::Open];
    let mut figure = stopped_proof();
    figure.ground = waves(0.0, 30_001, 20.0);
    (figure.start, figure.goal) = (figure.ground[0], figure.ground[30_000]);
    figure.stretches = (0..30_000).map(|i| stretch(f64::from(i), f64::from(i + 1), classes[(i % 7 / 3) as usize])).collect();
    figure.cell_boundaries_x_m = (0..30_000).map(f64::from).collect();
    figure.path = flights(&figure.ground, 0.0, 10.0, 3_000);
    (figure.cells, figure.upper_bound, figure.lower_bound) = (u64::MAX, Some(3_000), Some(u64::MAX));
    let refusals = (0..40).map(|i| (format!("limit number {i} with a long name ").repeat(4), u64::MAX - i)).collect();
    figure.gap = Some(ProofGap { reached_x_m: 3.0, leads_to_goal_x_m: 29_000.0, refusals });
    let picture = check_picture("proof-long", || draw_proof(&figure).unwrap());
    assert_says(&picture, &["1 hop in 10 of 3000 shown", "all others"]);
    assert!(!texts(&picture).contains("ends of cells"), "too close to be distinguished");
}

#[test]
fn columns_take_the_class_of_their_longest_part_and_leave_bare_ground_bare() {
    use ProofClass::{Open, Reachable, Unreachable};
    let fine =
        [stretch(0.0, 0.9, Reachable), stretch(0.9, 1.0, Open), stretch(1.0, 1.4, Reachable), stretch(4.0, 5.0, Unreachable)];
    let found = proof::in_columns(&fine, 1.0);
    assert_eq!(found, [stretch(0.0, 2.0, Reachable), stretch(4.0, 5.0, Unreachable)]);
    assert!(proof::in_columns(&[], 1.0).is_empty());
}

#[test]
fn proofs_of_degenerate_grounds_are_drawn() {
    let point = ChainPoint::new(3.0, 2.0);
    let empty = ProofFigure {
        ground: Vec::new(),
        stretches: Vec::new(),
        gap: None,
        start: point,
        goal: point,
        cell_boundaries_x_m: Vec::new(),
        cells: 0,
        ..stopped_proof()
    };
    for ground in [vec![], vec![point]] {
        let points = ground.len();
        let error = draw_proof(&ProofFigure { ground, ..empty.clone() }).unwrap_err();
        assert_eq!(error, FigureError::NoGround { what: "the proof".to_owned(), points });
    }
    let flat = vec![ChainPoint::new(0.0, 2.0), ChainPoint::new(6.0, 2.0)];
    let cliff =
        vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(1.0, 0.0), ChainPoint::new(1.001, 900.0), ChainPoint::new(2.0, 900.0)];
    for (name, ground) in [("proof-flat", flat), ("proof-cliff", cliff), ("proof-one-place", vec![point, point])] {
        let (start, goal) = (ground[0], ground[ground.len() - 1]);
        let stretches = vec![stretch(start.x_m, start.x_m, ProofClass::Reachable), stretch(start.x_m, goal.x_m, ProofClass::Open)];
        let path =
            vec![Flight { from: start, to: start, takeoff_slope: 1.0 }, Flight { from: goal, to: start, takeoff_slope: 2.0 }];
        let gap = Some(ProofGap { reached_x_m: goal.x_m, leads_to_goal_x_m: start.x_m, refusals: Vec::new() });
        let figure = ProofFigure { ground, stretches, start, goal, path, gap, ..empty.clone() };
        let picture = check_picture(name, || draw_proof(&figure).unwrap());
        assert_says(&picture, &["No other cell was within reach", "start"]);
    }
}

/// A grid of two capabilities; hops fall with both.
fn trade(cols: usize, rows: usize, most: u64) -> TradeFigure {
    let axis = |name: &str, count: usize, from: f64, step: f64| TradeAxis {
        name: name.to_owned(),
        values: (0..count).map(|i| from + step * i as f64).collect(),
    };
    let cell = |i: usize| {
        let (row, col) = ((i / cols) as u64, (i % cols) as u64);
        match row + col {
            0 => TradeCell::Untraversable,
            1 => TradeCell::Open,
            sum => TradeCell::Hops(most / sum + 1),
        }
    };
    TradeFigure {
        caption: Caption::new("Fewest hops", "Moon, g = 1.624 m/s²; friction coefficient 0.6"),
        x: axis("hopper.takeoff_speed_max_m_s (m/s)", cols, 4.0, 0.5),
        y: (rows > 0).then(|| axis("hopper.landing_speed_max_m_s (m/s)", rows, 5.0, 1.0)),
        cells: (0..cols * rows.max(1)).map(cell).collect(),
    }
}

#[test]
fn a_trade_has_its_number_in_every_cell() {
    for (name, cols, rows, most) in
        [("trade", 10, 7, 60), ("trade-row", 8, 0, 9), ("trade-two", 2, 2, 5), ("trade-many", 40, 30, 900)]
    {
        let figure = trade(cols, rows, most);
        let picture = check_picture(name, || draw_trade(&figure).unwrap());
        let said = texts(&picture);
        for cell in &figure.cells {
            if let TradeCell::Hops(hops) = cell {
                let count = |hops: u64| figure.cells.iter().filter(|cell| **cell == TradeCell::Hops(hops)).count();
                let words = hops.to_string();
                assert!(said.lines().filter(|line| *line == words).count() >= count(*hops), "{name}: {hops}");
            }
        }
        assert_says(&picture, &["hopper.takeoff_speed_max_m_s (m/s)", "proved: no path (1)", "?"]);
        assert_eq!(said.contains("hopper.landing_speed_max_m_s (m/s)"), rows > 0);
    }
}

#[test]
fn trades_too_fine_for_numbers_say_so_and_stay_small() {
    let figure = trade(100, 90, 4000);
    let picture = check_picture("trade-fine", || draw_trade(&figure).unwrap());
    assert_says(&picture, &["90 x 100 cells: too small for a number each"]);
}

#[test]
fn degenerate_trades_are_drawn() {
    let mut huge = trade(6, 3, u64::MAX - 1);
    huge.x.name = "an & axis <of words> ".repeat(20);
    huge.x.values = (0..6).map(|i| 1.0e4 + 1.0e-3 * f64::from(i)).collect();
    let picture = check_picture("trade-huge", || draw_trade(&huge).unwrap());
    assert_says(&picture, &["10000.001", "10000.005"]);
    assert!(picture.to_svg().unwrap().contains("&amp;"));
    let mut one = trade(1, 1, 3);
    check_picture("trade-one", || draw_trade(&one).unwrap());
    one.cells = vec![TradeCell::Hops(0)];
    assert_says(&check_picture("trade-zero", || draw_trade(&one).unwrap()), &["0 hops"]);
    one.cells.clear();
    let wrong = draw_trade(&one).unwrap_err();
    assert_eq!(wrong, FigureError::RasterSize { what: "trade", found: 0, rows: 1, cols: 1 });
    assert_says(&check_picture("trade-empty", || draw_trade(&TradeFigure::default()).unwrap()), &["There are no cells."]);
}

fn scenario(name: &str, ground: Vec<ChainPoint>, hop_m: f64, hops: usize) -> ComparedScenario {
    let from_x_m = ground[0].x_m + 4.0;
    let flights = flights(&ground, from_x_m, hop_m, hops);
    ComparedScenario {
        name: name.to_owned(),
        verdict: if hops > 0 { "traversable" } else { "untraversable" }.to_owned(),
        hops: (hops > 0).then_some(hops as u64),
        start: profile::at_x(&ground, from_x_m),
        goal: profile::at_x(&ground, from_x_m + 90.0),
        ground,
        flights,
    }
}

#[test]
fn comparisons_name_every_scenario_with_verdict_and_hops() {
    let ground = waves(0.0, 101, 3.0);
    let same = vec![
        scenario("Slow <hopper>", ground.clone(), 6.0, 15),
        scenario("Fast hopper", ground.clone(), 15.0, 6),
        scenario("Weak hopper", ground.clone(), 1.0, 0),
    ];
    let figure = CompareFigure { caption: Caption::new("Hoppers", "on one ground"), scenarios: same };
    let picture = check_picture("compare-same", || draw_compare(&figure).unwrap());
    let said =
        ["1. Slow <hopper>: traversable, 15 hops", "3. Weak hopper: untraversable", "distance along the chain", "start", "goal"];
    assert_says(&picture, &said);
    let other = vec![scenario("Here", waves(500.0, 101, 5.0), 9.0, 10), scenario("There", waves(-40.0, 131, 2.0), 18.0, 5)];
    let figure = CompareFigure { scenarios: other, ..figure };
    let picture = check_picture("compare-grounds", || draw_compare(&figure).unwrap());
    assert_says(&picture, &["1. Here: traversable, 10 hops", "2. There: traversable, 5 hops", "goal", "start"]);
    assert_eq!(texts(&picture).matches("distance along the chain, x (m)").count(), 2, "a panel each");
    // More than fit on a page.
    let many: Vec<_> = (0..9).map(|i| scenario(&format!("Ground {i}"), waves(0.0, 101 + i, 5.0), 9.0, 10)).collect();
    let picture =
        check_picture("compare-pages", || draw_compare(&CompareFigure { scenarios: many.clone(), ..figure.clone() }).unwrap());
    assert!(picture.pages().len() > 1 && picture.pages().iter().all(|page| texts(page).starts_with("Hoppers")));
}

#[test]
fn degenerate_comparisons_are_drawn() {
    let empty = draw_compare(&CompareFigure::default()).unwrap_err();
    assert!(empty.to_string().contains("no scenario"), "{empty}");
    let mut one = scenario("One", waves(0.0, 101, 3.0), 6.0, 15);
    one.ground.truncate(1);
    let bare = draw_compare(&CompareFigure { scenarios: vec![one], ..CompareFigure::default() }).unwrap_err();
    assert_eq!(bare, FigureError::NoGround { what: "One".to_owned(), points: 1 });
    let long = "a name that does not end ".repeat(12);
    let many = (0..16).map(|i| {
        let mut one = scenario(&long, waves(0.0, 101, 3.0), 3.0 + f64::from(i), 5);
        one.goal = profile::at_x(&one.ground, 20.0 + 5.0 * f64::from(i));
        one.hops = Some(u64::MAX);
        one
    });
    let mut scenarios: Vec<_> = many.collect();
    scenarios.push(scenario("very many hops", waves(0.0, 101, 3.0), 0.01, 9_000));
    let figure = CompareFigure { caption: Caption::default(), scenarios };
    let picture = check_picture("compare-many", || draw_compare(&figure).unwrap());
    assert_says(&picture, &["1 hop in 30 of 9000 shown", &u64::MAX.to_string()]);
}

/// Hops of 45 degrees over rolling ground, up and down.
fn hop_profile(i: usize, hops: usize) -> HopProfile {
    let (run_m, rise_m) = (4.0 + (i % 7) as f64, (i % 5) as f64 - 2.0);
    let end = ChainPoint::new(run_m, 1700.0 + rise_m);
    let ground = vec![ChainPoint::new(0.0, 1700.0), ChainPoint::new(0.4 * run_m, 1699.0), end];
    let geometry = PolygonalChain::bare(ground.clone()).unwrap();
    let angles = AngleInterval { min: Angle::from_degrees(60.0), max: Angle::from_degrees(71.25) };
    let at = |station: crate::chain::Station, (x, y): (f64, f64)| ContactPoint {
        along_m: station.point.x_m,
        point_m: nalgebra::Point3::new(x, y, station.point.z_m),
        frame: if i == 1 { Frame::Chain } else { Frame::Map },
        station: Some(station),
    };
    let hop = Hop {
        direction: Direction::Forward,
        takeoff: at(geometry.station(0.0).unwrap(), (75897.5, 38702.5)),
        landing: at(geometry.station(run_m).unwrap(), (75900.0, 38710.0)),
        heading_deg: 18.4,
        takeoff_angle: Angle::from_degrees(60.0),
        takeoff_speed_m_s: 5.0,
        landing_angle: Angle::from_degrees(-55.5),
        landing_speed_m_s: 4.5,
        flight_time_s: 2.5,
        apex_z_m: 1703.0,
        delta_v_m_s: 5.0,
        propellant: None,
        takeoff_angles: angles,
        speed_margin_m_s: 0.5,
        lower_limit: Limit::TakeoffCone,
        lower_vertex: None,
        upper_limit: Limit::TakeoffSpeed,
        aim: None,
        margins: crate::hop::HopMargins::UNLIMITED,
        roll_out: None,
    };
    HopProfile {
        heading_true_deg: Some(80.6),
        name: format!("goal 1, hop {} of {hops}", i + 1),
        ground,
        hop,
        least_clearance_m: Some((0.4 * run_m, 2.25)),
    }
}

#[test]
fn profiles_of_many_hops_are_on_pages_of_a4() {
    for (hops, pages, clearance_m) in [(0, 1, 0.0), (1, 1, 0.5), (8, 1, 0.0), (9, 2, 0.0), (36, 5, 0.5), (215, 27, 0.0)] {
        let caption = Caption::new("Hop by hop", "Moon, g = 1.624 m/s²");
        let figure = HopProfilesFigure {
            caption,
            clearance: ClearanceProfile::new(clearance_m, ClearanceRule::TAPERED),
            hops: (0..hops).map(|i| hop_profile(i, hops)).collect(),
        };
        let picture = draw_hop_profiles(&figure).unwrap();
        let drawn = picture.pages();
        assert_eq!(drawn.len(), pages, "{hops} hops");
        let mut next = 1;
        for (i, page) in drawn.iter().enumerate() {
            check_well_formed(&page.to_svg().unwrap());
            assert!(page.width_mm == 170.0 && page.height_mm <= 257.0, "{} x {}", page.width_mm, page.height_mm);
            let lettering = texts(page);
            assert_eq!(lettering.contains(&format!("(page {} of {pages})", i + 1)), i > 0, "{lettering}");
            // Every hop once, in order.
            for line in lettering.lines().filter(|line| line.contains(&format!(" of {hops}")) && line.starts_with("goal")) {
                assert_eq!(line, format!("goal 1, hop {next} of {hops}"));
                next += 1;
            }
            for label in labels(page) {
                let (left, top, right, bottom) = label.bounds_mm();
                let is_inside = left > 0.3 && right < page.width_mm - 0.3 && top > 0.3 && bottom < page.height_mm;
                assert!(is_inside, "{hops} hops, page {}: {:?} leaves the page", i + 1, label.text);
            }
        }
        assert_eq!(next, hops + 1);
        assert_eq!(texts(&picture).contains("clearance asked for: 0.5 m"), clearance_m > 0.0);
    }
    let figure = HopProfilesFigure {
        caption: Caption::default(),
        clearance: ClearanceProfile::new(0.5, ClearanceRule::TAPERED),
        hops: (0..4).map(|i| hop_profile(i, 4)).collect(),
    };
    let lettering = texts(&check_picture("hop-profiles", || draw_hop_profiles(&figure).unwrap()));
    for words in [
        "(75897.5, 38702.5) m to (75900.0, 38710.0) m",
        "run 4 m in 2.5 s, heading 18.4° grid, 80.6° true",
        "run 5 m; flight 2.5 s",
        "take-off 5 m/s at 60.0 deg (60.0 to 71.2 feasible)",
        "landing 4.5 m/s at -55.5 deg; least clearance 2.25 m",
        "distance (m); heights at true scale",
        "height (m)",
    ] {
        assert!(lettering.lines().any(|line| line == words), "{words:?} is missing in {lettering}");
    }
    let mut bare = figure.clone();
    bare.hops[2].ground.truncate(1);
    assert!(matches!(draw_hop_profiles(&bare), Err(FigureError::NoGround { points: 1, .. })));
}

//! The figures of many journeys: contents, texts and legibility.

use super::{
    samples::{self, check_picture, check_well_formed},
    sheet::{Label, Mark},
    *,
};
use crate::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, GroundForm, PolygonalChain, SegmentGround},
    graph::{Outcome, PointSpacing, SearchOptions, is_usable, search},
    hop::Split,
    path::generate,
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint, VertexId},
    terrain::{Dem, GeoReference},
    world::{CommandSteps, Contact, Direction, FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

/// One journey, analysed.
struct Case {
    name: &'static str,
    ground: &'static str,
    chain: ConstrainedChain,
    ends_m: (f64, f64),
    options: SearchOptions,
}

impl Case {
    fn new(name: &'static str, chain: PolygonalChain, hopper: Hopper, gravity_m_s2: f64, ends_m: (f64, f64)) -> Self {
        Self {
            name,
            ground: "friction coefficient 0.6",
            chain: ConstrainedChain::new(chain, &hopper, Gravity::new(gravity_m_s2).unwrap(), &friction(0.6)).unwrap(),
            ends_m,
            options: SearchOptions::default(),
        }
    }

    fn with<T>(&self, look: impl FnOnce(&FigureInput<'_>) -> T) -> T {
        let test = HopTest::new(self.chain.clone());
        let at = |x_m| self.chain.geometry().station(x_m).unwrap();
        let (start, goal) = (at(self.ends_m.0), at(self.ends_m.1));
        let answer = search(&test, start, goal, &self.options, &()).unwrap();
        let path = match &answer.outcome {
            Outcome::Path { legs, .. } => Some(generate(&test, legs, self.options.takeoff, Split::FullReach).unwrap()),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        };
        let (name, body, ground) = (self.name.to_owned(), "Mars".to_owned(), self.ground.to_owned());
        let title = FigureTitle { name, body, ground, ..FigureTitle::default() };
        look(&FigureInput { test: &test, answer: &answer, path: path.as_ref(), start, goal, plan_view: None, title })
    }
}

fn friction(mu: f64) -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(mu).unwrap())), rest: RestSlope::AsFrictionHolds }
}

fn bare(points: impl IntoIterator<Item = (f64, f64)>) -> PolygonalChain {
    PolygonalChain::bare(points.into_iter().map(|(x, z)| ChainPoint::new(x, z)).collect()).unwrap()
}

/// Rough ground: a few sines of unrelated lengths, the same on every platform.
fn rough(segments: u32, length_m: f64, relief_m: f64, base_m: f64) -> PolygonalChain {
    bare((0..=segments).map(|i| {
        let s = f64::from(i) / f64::from(segments);
        let waves = [(3.1, 0.5, 0.3), (7.7, 0.28, 1.1), (17.3, 0.14, 2.0), (31.9, 0.08, 0.7)];
        let z: f64 = waves.iter().map(|(k, a, p)| a * libm::sin(std::f64::consts::TAU * k * s + p)).sum();
        (s * length_m, base_m + relief_m * z)
    }))
}

fn paper() -> Case {
    let surface = SurfaceProperties {
        grip: Some(Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(60.0, 90.0),
            landing: AngleInterval::from_degrees(-90.0, -60.0),
        }),
        rest: RestSlope::AsFrictionHolds,
    };
    let hopper = Hopper::with_speeds(10.0, 10.0).unwrap();
    let chain =
        ConstrainedChain::new(bare([(0.0, 54.61), (76.0, 59.24)]), &hopper, Gravity::new(3.711).unwrap(), &surface).unwrap();
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    Case { name: "The paper's 76 m case", ground: "cones 60 to 90 deg over the slope", chain, ends_m: (0.0, 76.0), options }
}

/// Walls, a keep-out zone, a cross-slope, a stretch with a speed limit of 0, one without stated limits, one for landing only.
fn closed() -> Case {
    let points = [
        (0.0, 0.0),
        (12.0, 0.5),
        (16.0, 5.0),
        (30.0, 5.5),
        (40.0, 5.0),
        (52.0, 4.5),
        (60.0, 4.0),
        (66.0, 1.0),
        (78.0, 0.5),
        (90.0, 0.8),
        (100.0, 0.0),
        (110.0, 0.4),
    ];
    let free = SegmentGround::BARE;
    let tilted =
        SegmentGround { form: GroundForm::Surface { friction: None, cross_slope: Angle::from_degrees(35.0) }, keep_out: false };
    let kept = SegmentGround { keep_out: true, ..SegmentGround::BARE };
    let line = |takeoff, landing| {
        let c = crate::chain::LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), takeoff, landing);
        SegmentGround { form: GroundForm::Explicit { forward: Some(c), reverse: Some(c) }, keep_out: false }
    };
    let silent = SegmentGround { form: GroundForm::Explicit { forward: None, reverse: None }, keep_out: false };
    let grounds = vec![free, free, free, kept, free, tilted, free, line(0.0, 0.0), silent, line(0.0, 9.0), free];
    let vertices = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
    let chain = PolygonalChain::new(vertices, grounds, None).unwrap();
    let hopper = Hopper::with_speeds(14.0, 16.0).unwrap();
    let surface = SurfaceProperties { rest: RestSlope::AtMost(Angle::from_degrees(40.0)), ..friction(0.6) };
    Case {
        chain: ConstrainedChain::new(chain.clone(), &hopper, Gravity::new(3.711).unwrap(), &surface).unwrap(),
        ..Case::new("Closed stretches of every kind", chain, hopper, 3.711, (0.0, 110.0))
    }
}

fn impossible() -> Case {
    let points = [(0.0, 0.0), (15.0, 0.4), (30.0, 0.0), (36.0, -9.0), (64.0, -9.5), (70.0, 0.5), (85.0, 1.0), (100.0, 0.5)];
    Case::new("A rille too wide", bare(points), Hopper::with_speeds(7.0, 8.0).unwrap(), 3.711, (2.0, 98.0))
}

/// The cones require steep hops, whose range is a metre too short.
fn nearly() -> Case {
    let points = [(0.0, 0.0), (15.0, 0.4), (30.0, 0.0), (42.0, -22.0), (55.0, 0.1), (85.0, 1.0), (100.0, 0.5)];
    Case::new("A rille a metre too wide", bare(points), Hopper::with_speeds(10.0, 10.0).unwrap(), 3.711, (90.0, 10.0))
}

fn refused() -> Case {
    let points = [(0.0, 0.0), (10.0, 0.0), (20.0, 20.0), (21.0, 40.0), (45.0, 40.0), (60.0, 40.0)];
    Case::new("A start on a wall", bare(points), Hopper::with_speeds(10.0, 10.0).unwrap(), 3.711, (15.0, 50.0))
}

fn cases() -> Vec<Case> {
    let ten = Hopper::with_speeds(10.0, 10.0).unwrap();
    let spaced = |case: Case, k| Case {
        options: SearchOptions { spacing: Some(PointSpacing::PerSegment(k)), ..SearchOptions::default() },
        ..case
    };
    let mut flat = Case::new("Sixty hops on a plain", bare([(0.0, 2.0), (1500.0, 5.0)]), ten, 3.711, (0.0, 1480.0));
    flat.options.takeoff = TakeoffChoice::MidRange;
    let tall = Hopper::new(HopperLimits {
        clearance_m: 0.2,
        flight_time_max_s: Some(60.0),
        steps: CommandSteps {
            takeoff_angle: Some(Angle::from_degrees(0.25)),
            // The speed makes up for the angle, so that no landing misses its vertex.
            takeoff_speed_m_s: None,
            heading: Some(Angle::from_degrees(15.0)),
        },
        takeoff_speed_min_m_s: Some(0.5),
        mass_kg: Some(20.0),
        rest_time_s: Some(120.0),
        ..*ten.limits()
    })
    .unwrap();
    vec![
        paper(),
        spaced(
            Case::new(
                "Rough ground",
                rough(80, 200.0, 7.0, 0.0),
                Hopper::new(HopperLimits { clearance_m: 0.3, ..*ten.limits() }).unwrap(),
                3.711,
                (3.0, 190.0),
            ),
            2,
        ),
        spaced(Case::new("Rough ground in reverse", rough(80, 200.0, 7.0, 0.0), tall, 3.711, (190.0, 3.0)), 1),
        closed(),
        impossible(),
        nearly(),
        refused(),
        Case::new("One hop", bare([(0.0, 0.0), (5.0, 0.5), (11.0, 0.0)]), ten, 3.711, (1.0, 10.0)),
        flat,
        spaced(Case::new("Chain at 1 m posts", rough(300, 300.0, 4.0, -2531.0), ten, 3.711, (20.0, 60.0)), 0),
        spaced(
            Case::new(
                "Kilometres with metres of relief",
                rough(400, 4000.0, 6.0, 800.0),
                Hopper::with_speeds(30.0, 30.0).unwrap(),
                1.624,
                (0.0, 4000.0),
            ),
            1,
        ),
        Case::new("One centimetre", rough(12, 0.01, 0.0006, 0.0), Hopper::with_speeds(0.05, 0.05).unwrap(), 3.711, (0.0, 0.01)),
        Case::new("No hop at all", bare([(0.0, 812.0), (40.0, 812.3)]), ten, 3.711, (5.0, 5.0)),
        Case::new(
            "Up a cliff",
            bare([(0.0, 0.0), (4.0, 0.0), (4.5, 60.0), (9.0, 60.0)]),
            Hopper::with_speeds(25.0, 25.0).unwrap(),
            3.711,
            (1.0, 8.0),
        ),
        spaced(Case::new("Two thousand vertices, a hundred hops", rough(2000, 2400.0, 9.0, 100.0), ten, 3.711, (0.0, 2400.0)), 0),
    ]
}

fn labels(case: &Case) -> Vec<Label> {
    case.with(|input| {
        let (sheet, _) = laid_out(input, &FigureData::new(input).unwrap());
        let label = |mark| if let Mark::Label(label) = mark { Some(label) } else { None };
        sheet.marks.into_iter().filter_map(label).collect()
    })
}

fn texts(case: &Case) -> String {
    labels(case).iter().map(|label| label.text.as_str()).collect::<Vec<_>>().join("\n")
}

fn hops(data: &FigureData) -> &[HopFigure] {
    if let Subject::Path { hops, .. } = &data.subject { &hops.shown } else { &[] }
}

#[test]
fn flights_follow_the_commanded_speed_and_angle_from_point_to_point() {
    let mut flown = 0;
    for case in cases() {
        let data = case.with(|input| FigureData::new(input).unwrap());
        for hop in hops(&data) {
            let (from, to) = (hop.hop.takeoff.in_profile(), hop.hop.landing.in_profile());
            let run_m = (to.x_m - from.x_m).abs();
            let tolerance_m = 1e-9 * (run_m + hop.hop.apex_z_m - from.z_m);
            // The parabola from the commands alone, by Newton's equations.
            let (v, angle) = (hop.hop.takeoff_speed_m_s, hop.hop.takeoff_angle.radians());
            for share in [0.0, 0.1, 0.5, 0.77, 1.0] {
                let point = hop.point_at(share);
                let time_s = run_m * share / (v * angle.cos());
                let height_m = from.z_m + v * angle.sin() * time_s - 0.5 * case.chain.gravity().m_s2() * time_s * time_s;
                assert!((point.z_m - height_m).abs() <= tolerance_m + 1e-12 * from.z_m.abs(), "{} hop {}", case.name, hop.number);
                assert!((point.x_m - from.x_m - (to.x_m - from.x_m) * share).abs() <= tolerance_m + 1e-12 * from.x_m.abs());
            }
            flown += 1;
        }
    }
    assert!(flown > 200, "only {flown} hops were checked");
}

#[test]
fn cones_contain_the_flights_at_their_ends() {
    for case in cases() {
        let data = case.with(|input| FigureData::new(input).unwrap());
        for hop in hops(&data) {
            let [Some(takeoff), Some(landing)] = hop.cones else { panic!("{} hop {} has no cones", case.name, hop.number) };
            let slack = |slope: f64| 1e-9 * (1.0 + slope * slope);
            for (cone, slope) in [(takeoff, hop.arc.takeoff_slope()), (landing, hop.arc.landing_slope())] {
                let (low, high) = (cone.slopes.lower - slack(slope), cone.slopes.upper + slack(slope));
                assert!(low <= slope && slope <= high, "{} hop {}: {slope} outside {:?}", case.name, hop.number, cone.slopes);
            }
            // The ray of the flight's own slope points along the drawn flight.
            let (start, next) = (hop.point_at(0.0), hop.point_at(1e-4));
            let (x, z) = takeoff.ray(hop.arc.takeoff_slope());
            let (dx, dz) = (next.x_m - start.x_m, next.z_m - start.z_m);
            let sine = (x * dz - z * dx) / dx.hypot(dz);
            assert!(x * dx + z * dz > 0.0 && sine.abs() < 1e-3, "{} hop {}: {sine}", case.name, hop.number);
            assert_eq!(x > 0.0, hop.hop.direction == Direction::Forward);
            let (x, _) = landing.ray(hop.arc.landing_slope());
            assert_eq!(x < 0.0, hop.hop.direction == Direction::Forward, "the landing cone opens towards the incoming flight");
        }
    }
}

#[test]
fn spans_state_the_use_of_every_point() {
    for case in cases() {
        let data = case.with(|input| FigureData::new(input).unwrap());
        assert_eq!((data.spans[0].from_x_m, data.spans[data.spans.len() - 1].to_x_m), data.view_x_m, "{}", case.name);
        assert!(data.spans.windows(2).all(|pair| pair[0].to_x_m == pair[1].from_x_m && pair[0].allows != pair[1].allows));
        for i in 0..997 {
            let x_m = data.view_x_m.0 + (data.view_x_m.1 - data.view_x_m.0) * (f64::from(i) + 0.4321) / 997.0;
            let station = case.chain.geometry().station(x_m).unwrap();
            let span = data.spans.iter().find(|span| span.from_x_m < x_m && x_m < span.to_x_m).unwrap();
            let usable = [Contact::Takeoff, Contact::Landing].map(|contact| is_usable(&case.chain, &station, contact));
            let stated = match span.allows {
                GroundUse::Both => [true, true],
                GroundUse::TakeoffOnly => [true, false],
                GroundUse::LandingOnly => [false, true],
                GroundUse::Closed(_) => [false, false],
            };
            assert_eq!(stated, usable, "{} at {x_m} m", case.name);
        }
    }
}

#[test]
fn each_kind_of_closed_ground_is_found_and_in_the_legend() {
    let case = closed();
    let data = case.with(|input| FigureData::new(input).unwrap());
    let at = |x_m: f64| data.spans.iter().find(|s| s.from_x_m < x_m && x_m < s.to_x_m).unwrap().allows;
    let found = [14.0, 35.0, 56.0, 70.0, 85.0, 95.0].map(at);
    let closed = [Closure::RestSlope, Closure::KeepOut, Closure::Cones, Closure::SpeedZero, Closure::NoLimits];
    assert_eq!(found[..5], closed.map(GroundUse::Closed));
    assert_eq!(found[5], GroundUse::LandingOnly);
    let texts = texts(&case);
    for words in closed.map(Closure::text).into_iter().chain(["landing only"]) {
        assert!(texts.contains(words), "the legend lacks {words:?}");
    }
}

#[test]
fn the_scale_is_always_stated() {
    for (case, words) in [
        (paper(), "heights at true scale"),
        (cases().remove(8), "heights exaggerated 20 times"),
        (cases().remove(13), "heights drawn at 1/5 of the horizontal scale"),
        (cases().remove(9), "part of a chain from 0 to 300 m"),
    ] {
        assert!(texts(&case).contains(words), "{}: {}", case.name, texts(&case));
    }
}

#[test]
fn texts_stay_on_the_page_and_off_each_other() {
    for case in cases() {
        let labels = labels(&case);
        for (i, label) in labels.iter().enumerate() {
            let (left, top, right, bottom) = label.bounds_mm();
            assert!(left >= 0.5 && right <= 169.5 && top >= 0.5, "{}: {:?} leaves the page", case.name, label.text);
            for other in &labels[i + 1..] {
                let (l, t, r, b) = other.bounds_mm();
                let apart = right <= l || r <= left || bottom <= t || b <= top;
                assert!(apart, "{}: {:?} over {:?}", case.name, label.text, other.text);
            }
        }
    }
}

#[test]
fn a_path_shows_every_hop_number_limit_and_unit() {
    let case = paper();
    let svg = case.with(|input| draw(input).unwrap().to_svg().unwrap());
    for words in ["1\n", "2\n", "3\n", "4\n"] {
        let count = svg.matches(&format!(">\n{words}</text>")).count();
        assert_eq!(count, 2, "hop {words} is numbered over its flight and below its bar");
    }
    // Once for each hop; and the cone in the legend, the speed among the conditions.
    assert_eq!(svg.matches("take-off cone").count(), 4 + 1);
    assert_eq!(svg.matches("take-off speed").count(), 4 + 1);
    for words in ["x (m)", "z (m)", "(deg)", "3.711 m/s²", "10 m/s", "76 m", "4 hops, traversable", "J/kg", "60 to 90 deg"] {
        assert!(svg.contains(words), "{words:?} is missing");
    }
}

/// Limits are named in words that read level, and the axis of take-off angles ends at 90 degrees.
#[test]
fn limits_are_named_in_words_and_no_axis_is_longer_for_them() {
    for case in cases() {
        let labels = labels(&case);
        for label in &labels {
            assert!(!label.text.contains("takeoff-") && !label.text.contains("landing-"), "{}: {:?}", case.name, label.text);
            assert!(
                !label.turned || label.text.ends_with("(m)") || label.text.ends_with("(deg)"),
                "{}: {:?}",
                case.name,
                label.text
            );
        }
        let Some(name) = labels.iter().find(|label| label.text == "take-off angle (deg)") else { continue };
        let (top, bottom) = (name.at.1 - 20.0, name.at.1 + 20.0);
        let on_axis = |label: &&Label| label.anchor == sheet::Anchor::End && label.at.1 >= top && label.at.1 <= bottom;
        let ticks: Vec<(f64, f64)> =
            labels.iter().filter(on_axis).filter_map(|label| Some((label.at.1, label.text.parse().ok()?))).collect();
        let [first, .., last] = ticks[..] else { panic!("{}: {ticks:?}", case.name) };
        let at_top = first.1 + (last.1 - first.1) * (top - first.0) / (last.0 - first.0);
        assert!(at_top <= 90.0 + 1e-6, "{}: the axis ends at {at_top}", case.name);
    }
    // Three of the limits of a hundred hops have a letter each, and the list below says which.
    let many = cases().pop().unwrap();
    assert!(texts(&many).contains("Limits: A "), "{}", texts(&many));
}

/// The legend has no mark that the panel has not.
#[test]
fn hops_too_narrow_for_cones_have_none_in_the_legend() {
    for (case, has) in [(paper(), true), (cases().pop().unwrap(), false)] {
        let texts = texts(&case);
        for words in ["take-off cone\nlanding cone", "\nlanding\n"] {
            assert_eq!(texts.contains(words), has, "{}: {words:?} in {texts}", case.name);
        }
        let flat = case.with(|input| draw(input).unwrap());
        let wedges = flat
            .sheet
            .marks
            .iter()
            .filter(|mark| matches!(mark, Mark::Area { colour, opacity, .. } if *colour == palette::ORANGE && *opacity < 1.0));
        assert_eq!(wedges.count() > 0, has, "{}", case.name);
    }
}

/// A transect that turns has a line and a name at each of its bends.
#[test]
fn bends_are_marked_on_the_profile() {
    let points: Vec<_> = (0..=12).map(|i| ChainPoint::new(5.0 * f64::from(i), 0.1 * f64::from(i % 3))).collect();
    let at = |x: f64, y: f64| MapPoint::new(x, y);
    let along = (0..=12).map(|i| match i {
        0..=4 => at(5.0 * f64::from(i), 0.0),
        5..=8 => at(20.0, 5.0 * f64::from(i - 4)),
        _ => at(20.0 + 5.0 * f64::from(i - 8), 20.0),
    });
    let grounds = vec![SegmentGround::BARE; 12];
    let turns = vec![VertexId(4), VertexId(8)];
    let chain = PolygonalChain::new(points, grounds, Some(along.collect())).unwrap().with_bends(turns).unwrap();
    assert_eq!(chain.bends().len(), 2, "two right angles");
    let case = Case::new("Round two corners", chain, Hopper::with_speeds(10.0, 10.0).unwrap(), 3.711, (0.0, 60.0));
    let texts = texts(&case);
    assert!(texts.contains("bend 1") && texts.contains("bend 2") && !texts.contains("bend 3"), "{texts}");
    assert!(!self::texts(&paper()).contains("bend"));
}

#[test]
fn a_journey_without_a_path_shows_how_far_one_gets_and_which_limits_refuse() {
    let case = nearly();
    let (data, frontier) = case.with(|input| {
        let Outcome::NoPath(frontier) = &input.answer.outcome else { panic!("a path over the rille") };
        (FigureData::new(input).unwrap(), frontier.clone())
    });
    let Subject::Stopped(stop) = &data.subject else { panic!("{:?}", data.subject) };
    assert_eq!((stop.reached_x_m.as_slice(), stop.leads_to_goal_x_m.as_slice()), (&[(55.0, 100.0)][..], &[(0.0, 30.0)][..]));
    assert_eq!((stop.gap.0.x_m, stop.gap.1.x_m), (55.0, 30.0));
    let texts = texts(&case);
    for (limit, count) in frontier.refusals.ranked() {
        assert!(texts.contains(&limits::words(limit)) && texts.contains(&count.to_string()), "{limit} {count}");
    }
    let miss = frontier.nearest_miss.unwrap().conflict.said(limits::words);
    assert!(texts.replace('\n', " ").contains(&miss), "{miss}\n{texts}");
    assert!(texts.contains("gap 25 m") && texts.contains("no path found over"));
    // For a manager: how far, what stops it, what would do.
    let text = texts.replace('\n', " ");
    for words in [
        "gets from the start to x = 55 m, and from x = 30 m on to the goal",
        "does not cross the gap of 25 m",
        "What stops it at the gap: ",
        "of the ",
        "What would do, judged by the limit that refuses most: ",
    ] {
        assert!(text.contains(words), "{words:?} is missing in {text}");
    }
    let texts = self::texts(&refused());
    for words in ["start refuses", "rest slope of", "x = 10 m"] {
        assert!(texts.contains(words), "{words:?} is missing in {texts}");
    }
}

/// With `CHTA_FIGURES_TO=folder` it also writes the pictures there, for viewing.
#[test]
fn every_svg_is_well_formed_small_and_reproducible() {
    let folder = std::env::var_os("CHTA_FIGURES_TO").map(std::path::PathBuf::from);
    for case in cases() {
        let svg = case.with(|input| draw(input).unwrap().to_svg().unwrap());
        if let Some(folder) = &folder {
            std::fs::write(folder.join(case.name.replace(' ', "-")).with_extension("svg"), &svg).unwrap();
        }
        check_well_formed(&svg);
        assert!(svg.len() < 1_000_000, "{}: {} bytes", case.name, svg.len());
        assert_eq!(svg, case.with(|input| draw(input).unwrap().to_svg().unwrap()), "{}", case.name);
        for token in svg.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')) {
            assert!(token.len() <= 10, "{}: the number {token} is long", case.name);
        }
    }
}

#[test]
fn names_with_special_characters_are_escaped() {
    let svg = paper().with(|input| {
        let title = FigureTitle { name: "a < b & \"c\" font-size=\"7.5\"".to_owned(), ..FigureTitle::default() };
        draw(&FigureInput { title, ..input.clone() }).unwrap().to_svg().unwrap()
    });
    check_well_formed(&svg);
    assert!(svg.contains("a &lt; b &amp; &quot;c&quot; font-size=&quot;7.5&quot;"));
}

#[test]
fn curves_are_finer_than_pixels() {
    let svg = paper().with(|input| draw(input).unwrap().to_svg().unwrap());
    assert!(svg.starts_with("<svg width=\"170mm\" height=\""), "{}", &svg[..120]);
    let width: f64 = svg.split("viewBox=\"0 0 ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let units_per_pixel = width / (170.0 / 25.4 * 96.0);
    assert!(units_per_pixel > 4.0, "{units_per_pixel} units a pixel");
    // On the straight ground of the paper's case the four flights are the lines with the most points; their steps change smoothly.
    let lines = svg.split("points=\"").skip(1).map(|part| part.split('"').next().unwrap());
    let longest = lines.max_by_key(|line| line.len()).unwrap();
    let points: Vec<(f64, f64)> = longest
        .split_whitespace()
        .map(|pair| pair.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap())).unwrap())
        .collect();
    assert!(points.len() > 40, "{} points", points.len());
    let bend = |w: &[(f64, f64)]| (w[2].1 - 2.0 * w[1].1 + w[0].1).abs();
    assert!(points.windows(3).map(bend).fold(0.0, f64::max) < units_per_pixel, "a step of more than a pixel");
}

#[test]
fn long_paths_are_thinned_and_say_so() {
    let hopper = Hopper::with_speeds(10.0, 10.0).unwrap();
    let case = Case::new("Far", bare([(0.0, 0.0), (100_000.0, 0.0)]), hopper, 3.711, (0.0, 100_000.0));
    let data = case.with(|input| FigureData::new(input).unwrap());
    let Subject::Path { hops, .. } = &data.subject else { panic!("no path") };
    assert!(hops.of > 4000 && hops.shown.len() <= MOST_HOPS_DRAWN && hops.shown.len() > MOST_HOPS_DRAWN / 2);
    assert!(texts(&case).contains(&format!("hop, forward (1 in {} of {} shown)", hops.every, hops.of)));
    assert!(case.with(|input| draw(input).unwrap().to_svg().unwrap()).len() < 1_000_000);
}

#[test]
fn a_path_without_its_hops_is_refused() {
    let error = paper().with(|input| draw(&FigureInput { path: None, ..input.clone() })).unwrap_err();
    assert_eq!(error, FigureError::NoHops);
}

/// A path over level ground, and none: seen from above as well, below the profile.
#[test]
fn a_route_is_drawn_from_above_below_its_profile() {
    let map = GeoReference::local(MapPoint::new(0.0, 60.0), 2.0, 2.0).unwrap();
    let heights = (0..31 * 41).map(|i| if i == 700 { f64::NAN } else { 0.2 * libm::sin(f64::from(i)) }).collect();
    let dem = Dem::new(31, 41, heights, map).unwrap();
    let at = |x, y| MapPoint::new(x, y);
    let cases = [paper(), nearly()];
    for (case, found) in cases.iter().zip([true, false]) {
        case.with(|input| {
            let places: Vec<_> = input
                .path
                .map(|path| {
                    (0u8..).zip(0..=path.hops.len()).map(|(hop, _)| at(5.0 + 5.0 * f64::from(hop), 10.0 + f64::from(hop))).collect()
                })
                .unwrap_or_default();
            let goal = places.last().copied().unwrap_or(at(70.0, 50.0));
            let nearest = (!found).then_some(at(31.0, 22.0));
            let view = PlanView {
                dem: &dem,
                start: at(5.0, 10.0),
                goal,
                path: places.clone(),
                nearest,
                leads_to_goal: nearest.map(|_| at(60.0, 44.0)),
            };
            let input = FigureInput { plan_view: Some(view), ..input.clone() };
            let plain = draw(&FigureInput { plan_view: None, ..input.clone() }).unwrap();
            let picture = check_picture(&format!("route {found}"), || draw(&input).unwrap());
            assert!(picture.height_mm > plain.height_mm + 40.0, "{} {}", picture.height_mm, plain.height_mm);
            let texts = samples::texts(&picture);
            let words = if found {
                ["take-off cone", "path and its landings", "goal, reached", "map y, north (m)", "distance along the route"]
            } else {
                [
                    "reached place nearest to the goal",
                    "place nearest to the start that leads to the goal",
                    "goal, not reached",
                    "not reached over",
                    "distance along the straight line",
                ]
            };
            for words in words {
                assert!(texts.contains(words), "{words:?} is missing in {texts}");
            }
            assert!(!texts.contains("refuse"), "{texts}");
            assert!(found || texts.contains("no data"), "{texts}");
        });
    }
}

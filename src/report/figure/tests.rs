//! The figure of many journeys: what it shows, what it says, and that it can be read.

use super::{sheet::Mark, *};
use crate::{
    ballistics::{Split, TakeoffChoice},
    chain::{ConstrainedChain, Contact, Direction, Ground, GroundForm, PolygonalChain},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    path::generate,
    quantity::{Angle, AngleInterval, ChainPoint},
    world::{FrictionCone, Grip, Hopper, RestSlope, Surface},
};

/// One journey, analysed.
struct Case {
    name: &'static str,
    chain: ConstrainedChain,
    hopper: Hopper,
    gravity_m_s2: f64,
    ends_m: (f64, f64),
    options: SearchOptions,
}

impl Case {
    fn new(name: &'static str, chain: PolygonalChain, hopper: Hopper, gravity_m_s2: f64, ends_m: (f64, f64)) -> Self {
        Self {
            name,
            chain: ConstrainedChain::new(chain, &hopper, &friction(0.6)).unwrap(),
            hopper,
            gravity_m_s2,
            ends_m,
            options: SearchOptions::default(),
        }
    }

    fn with<T>(&self, look: impl FnOnce(&FigureInput<'_>) -> T) -> T {
        let test = HopTest::new(&self.chain, &self.hopper, self.gravity_m_s2);
        let at = |x_m| self.chain.geometry().station(x_m).unwrap();
        let (start, goal) = (at(self.ends_m.0), at(self.ends_m.1));
        let answer = search(&test, start, goal, &self.options, &mut |_| {}).unwrap();
        let path = match &answer.outcome {
            Outcome::Path { legs, .. } => Some(generate(&test, legs, self.options.takeoff, Split::FullReach).unwrap()),
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) => None,
        };
        let title =
            FigureTitle { name: self.name.to_owned(), body: "Mars".to_owned(), ground: "friction coefficient 0.6".to_owned() };
        look(&FigureInput { test: &test, answer: &answer, path: path.as_ref(), start, goal, title })
    }
}

fn friction(mu: f64) -> Surface {
    Surface { grip: Some(Grip::Friction(FrictionCone::new(mu).unwrap())), rest: RestSlope::AsFrictionHolds }
}

fn bare(points: impl IntoIterator<Item = (f64, f64)>) -> PolygonalChain {
    PolygonalChain::bare(points.into_iter().map(|(x, z)| ChainPoint::new(x, z)).collect()).unwrap()
}

/// Rough ground: a few sines of unrelated lengths, the same on every platform.
fn rough(segments: u32, length_m: f64, relief_m: f64, base_m: f64) -> PolygonalChain {
    bare((0..=segments).map(|i| {
        let s = f64::from(i) / f64::from(segments);
        let waves = [(3.1, 0.5, 0.3), (7.7, 0.28, 1.1), (17.3, 0.14, 2.0), (31.9, 0.08, 0.7)];
        let z: f64 = waves.iter().map(|(k, a, p)| a * libm::sin(6.283 * k * s + p)).sum();
        (s * length_m, base_m + relief_m * z)
    }))
}

fn paper() -> Case {
    let surface = Surface {
        grip: Some(Grip::FromSlope {
            takeoff: AngleInterval::from_degrees(60.0, 90.0),
            landing: AngleInterval::from_degrees(-90.0, -60.0),
        }),
        rest: RestSlope::AsFrictionHolds,
    };
    let hopper = Hopper::with_speeds(10.0, 10.0);
    let chain = ConstrainedChain::new(bare([(0.0, 54.61), (76.0, 59.24)]), &hopper, &surface).unwrap();
    let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(0)), ..SearchOptions::default() };
    Case { name: "The paper's 76 m case", chain, hopper, gravity_m_s2: 3.711, ends_m: (0.0, 76.0), options }
}

/// Walls, a keep-out zone, a side-slope, a stretch without speed, a stretch without limits, one for landing only.
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
    let free = Ground::BARE;
    let tilted = Ground { form: GroundForm::Surface { friction: None, cross_slope: Angle::from_degrees(35.0) }, keep_out: false };
    let kept = Ground { keep_out: true, ..Ground::BARE };
    let line = |takeoff, landing| {
        let c = crate::chain::LineConstraints::from_cone(0.0, Angle::from_degrees(30.0), takeoff, landing);
        Ground { form: GroundForm::Explicit { forward: Some(c), reverse: Some(c) }, keep_out: false }
    };
    let silent = Ground { form: GroundForm::Explicit { forward: None, reverse: None }, keep_out: false };
    let grounds = vec![free, free, free, kept, free, tilted, free, line(0.0, 0.0), silent, line(0.0, 9.0), free];
    let vertices = points.iter().map(|&(x, z)| ChainPoint::new(x, z)).collect();
    let chain = PolygonalChain::new(vertices, grounds, None).unwrap();
    Case::new("Closed stretches of every kind", chain, Hopper::with_speeds(14.0, 16.0), 3.711, (0.0, 110.0))
}

fn impossible() -> Case {
    let points = [(0.0, 0.0), (15.0, 0.4), (30.0, 0.0), (36.0, -9.0), (64.0, -9.5), (70.0, 0.5), (85.0, 1.0), (100.0, 0.5)];
    Case::new("A rille too wide", bare(points), Hopper::with_speeds(7.0, 8.0), 3.711, (2.0, 98.0))
}

fn refused() -> Case {
    let points = [(0.0, 0.0), (10.0, 0.0), (20.0, 20.0), (21.0, 40.0), (45.0, 40.0), (60.0, 40.0)];
    Case::new("A start on a wall", bare(points), Hopper::with_speeds(10.0, 10.0), 3.711, (15.0, 50.0))
}

fn cases() -> Vec<Case> {
    let ten = Hopper::with_speeds(10.0, 10.0);
    let spaced = |case: Case, k| Case {
        options: SearchOptions { spacing: Some(PointSpacing::PerSegment(k)), ..SearchOptions::default() },
        ..case
    };
    let mut flat = Case::new("Sixty hops on a plain", bare([(0.0, 2.0), (1500.0, 5.0)]), ten, 3.711, (0.0, 1480.0));
    flat.options.takeoff = TakeoffChoice::MidRange;
    let tall = Hopper { clearance_m: 0.2, flight_time_max_s: Some(60.0), mass_kg: Some(20.0), rest_time_s: Some(120.0), ..ten };
    vec![
        paper(),
        spaced(Case::new("Rough ground", rough(80, 200.0, 7.0, 0.0), Hopper { clearance_m: 0.3, ..ten }, 3.711, (3.0, 190.0)), 2),
        spaced(Case::new("Rough ground in reverse", rough(80, 200.0, 7.0, 0.0), tall, 3.711, (190.0, 3.0)), 1),
        closed(),
        impossible(),
        refused(),
        Case::new("One hop", bare([(0.0, 0.0), (5.0, 0.5), (11.0, 0.0)]), ten, 3.711, (1.0, 10.0)),
        flat,
        spaced(Case::new("Chain at 1 m posts", rough(300, 300.0, 4.0, -2531.0), ten, 3.711, (20.0, 60.0)), 0),
        spaced(
            Case::new(
                "Kilometres with metres of relief",
                rough(400, 4000.0, 6.0, 800.0),
                Hopper::with_speeds(30.0, 30.0),
                1.624,
                (0.0, 4000.0),
            ),
            1,
        ),
        Case::new("One centimetre", rough(12, 0.01, 0.0006, 0.0), Hopper::with_speeds(0.05, 0.05), 3.711, (0.0, 0.01)),
        Case::new("No way at all", bare([(0.0, 812.0), (40.0, 812.3)]), ten, 3.711, (5.0, 5.0)),
        Case::new(
            "Up a cliff",
            bare([(0.0, 0.0), (4.0, 0.0), (4.5, 60.0), (9.0, 60.0)]),
            Hopper::with_speeds(25.0, 25.0),
            3.711,
            (1.0, 8.0),
        ),
        spaced(Case::new("Two thousand vertices, a hundred hops", rough(2000, 2400.0, 20.0, 100.0), ten, 3.711, (0.0, 2400.0)), 0),
    ]
}

#[test]
fn gallery() {
    let folder = std::path::Path::new("/tmp/figs");
    std::fs::create_dir_all(folder).unwrap();
    for (i, case) in cases().iter().enumerate() {
        let clock = std::time::Instant::now();
        let svg = case.with(|input| draw(input).unwrap());
        eprintln!("{i} {} {} kB {:?}", case.name, svg.len() / 1000, clock.elapsed());
        std::fs::write(folder.join(format!("{i:02}.svg")), svg).unwrap();
    }
}

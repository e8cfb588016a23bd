//! Random worlds, biased to extremes: walls, needles, sawtooth, micrometres next to metres, remote coordinates, gravity from 1e-5
//! to 25.

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround, Station},
    graph::{Effort, Outcome, PointSpacing, SearchOptions, search},
    hop::{HopTest, Split},
    path::{HopPath, generate},
    quantity::{Angle, AngleInterval, ChainPoint, MapPoint},
    world::{FrictionCone, Gravity, Grip, Hopper, HopperLimits, RestSlope, SurfaceProperties},
};

use crate::support::Draw;

/// The shared generator, with the draws of worlds.
pub(crate) struct Dice(Draw);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Draw::seeded(seed))
    }

    /// Uniform in [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0.uniform(low, high)
    }

    /// Ten to a power uniform in [low, high).
    pub(crate) fn decades(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    pub(crate) fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.0.below(choices.len())]
    }
}

/// All inputs of a plan, kept so that one of them can be changed.
#[derive(Clone, Debug)]
pub(crate) struct World {
    pub(crate) vertices: Vec<ChainPoint>,
    pub(crate) grounds: Vec<SegmentGround>,
    pub(crate) map: Option<Vec<MapPoint>>,
    pub(crate) hopper: Hopper,
    pub(crate) surface: SurfaceProperties,
    pub(crate) gravity_m_s2: f64,
    pub(crate) start_x_m: f64,
    pub(crate) goal_x_m: f64,
    pub(crate) options: SearchOptions,
}

impl World {
    /// A random world.
    pub(crate) fn random(dice: &mut Dice) -> Self {
        let gravity_m_s2 = dice.decades(-5.0, 25f64.log10());
        let size_m = dice.decades(-3.0, 4.5);
        let vertices = vertices(dice, size_m);
        let segments = vertices.len() - 1;
        // The range on flat ground is v^2 / g: from a fifth of a segment to many, sometimes extremely far.
        let hop_m = size_m * if dice.chance(0.1) { dice.decades(1.0, 6.0) } else { dice.decades(-0.7, 1.3) };
        let speed_m_s = (gravity_m_s2 * hop_m).sqrt();
        let hopper = hopper(dice, size_m, speed_m_s, gravity_m_s2);
        let surface = surface(dice);
        let all_explicit = dice.chance(0.15);
        let grounds = (0..segments).map(|_| ground(dice, all_explicit, speed_m_s)).collect();
        let (first, last) = (vertices[0].x_m, vertices[segments].x_m);
        let mut station = |end: f64| if dice.chance(0.5) { end } else { dice.between(first, last) };
        let (mut start_x_m, mut goal_x_m) = (station(first), station(last));
        if dice.chance(0.4) {
            std::mem::swap(&mut start_x_m, &mut goal_x_m);
        }
        let map = dice.chance(0.2).then(|| on_a_map(dice, &vertices));
        let options = SearchOptions {
            spacing: Some(PointSpacing::PerSegment(dice.one_of(&[0, 1, 2, 3]))),
            effort: dice.one_of(&Effort::ALL),
            takeoff: dice.one_of(&TakeoffChoice::ALL),
            split: dice.one_of(&Split::ALL),
        };
        Self { vertices, grounds, map, hopper, surface, gravity_m_s2, start_x_m, goal_x_m, options }
    }

    /// The chain with its constraints; `None` if this world gives no valid chain.
    pub(crate) fn chain(&self) -> Option<ConstrainedChain> {
        let geometry = PolygonalChain::new(self.vertices.clone(), self.grounds.clone(), self.map.clone()).ok()?;
        ConstrainedChain::new(geometry, &self.hopper, Gravity::new(self.gravity_m_s2).unwrap(), &self.surface).ok()
    }

    /// Start and goal.
    pub(crate) fn ends(&self, chain: &ConstrainedChain) -> (Station, Station) {
        (chain.geometry().station(self.start_x_m).unwrap(), chain.geometry().station(self.goal_x_m).unwrap())
    }

    /// The planned path; `None` if no path was found, or if it has too many hops for a test.
    pub(crate) fn plan(&self, test: &HopTest) -> Option<HopPath> {
        let (start, goal) = self.ends(test.chain());
        match search(test, start, goal, &self.options, &()).unwrap().outcome {
            Outcome::Path { legs, cost } if cost.hops() <= 60 => {
                Some(generate(test, &legs, self.options.takeoff, self.options.split).unwrap())
            }
            _ => None,
        }
    }
}

fn vertices(dice: &mut Dice, size_m: f64) -> Vec<ChainPoint> {
    let segments = dice.one_of(&[1, 2, 3, 4, 6, 8, 10]);
    let roughness = dice.one_of(&[0.0, 0.1, 0.5, 1.0]);
    let sawtooth = dice.chance(0.2);
    let mut x_m = dice.one_of(&[0.0, 0.0, -3e4, 2e5]);
    let mut z_m = dice.one_of(&[0.0, 0.0, -2500.0, 1e6]);
    let mut vertices = vec![ChainPoint::new(x_m, z_m)];
    let mut needle_m: Option<f64> = None;
    for i in 0..segments {
        let (run_m, rise_m) = if let Some(height_m) = needle_m.take() {
            // The far side of a needle.
            (size_m * dice.decades(-4.0, -2.0), -height_m)
        } else if i + 1 < segments && dice.chance(0.15) {
            let height_m = size_m * dice.decades(-1.5, 0.0);
            needle_m = Some(height_m);
            (size_m * dice.decades(-4.0, -2.0), height_m)
        } else {
            match dice.between(0.0, 1.0) {
                // A wall.
                kind if kind < 0.12 => (size_m * dice.decades(-4.0, -1.0), size_m * dice.between(-0.5, 0.5)),
                // Very short.
                kind if kind < 0.24 => {
                    let run_m = size_m * dice.decades(-6.0, -3.0);
                    (run_m, run_m * dice.between(-1.0, 1.0))
                }
                _ => {
                    let run_m = size_m * dice.decades(-0.7, 0.5);
                    let tooth = if i % 2 == 0 { 1.0 } else { -1.0 };
                    (run_m, roughness * run_m * if sawtooth { tooth } else { dice.between(-1.0, 1.0) })
                }
            }
        };
        // At remote coordinates a short run may be lost in rounding.
        let next_m = x_m + run_m;
        if next_m > x_m + 1e-9 * x_m.abs() {
            x_m = next_m;
            z_m += rise_m;
            vertices.push(ChainPoint::new(x_m, z_m));
        }
    }
    if vertices.len() == 1 {
        vertices.push(ChainPoint::new(x_m + size_m.max(1.0), z_m));
    }
    vertices
}

fn hopper(dice: &mut Dice, size_m: f64, speed_m_s: f64, gravity_m_s2: f64) -> Hopper {
    let some = |dice: &mut Dice, low: f64, high: f64| dice.chance(0.25).then(|| dice.between(low, high));
    let angle = |degrees: Option<f64>| degrees.map(Angle::from_degrees);
    let scale_m = speed_m_s * speed_m_s / gravity_m_s2;
    let mut limits = HopperLimits {
        takeoff_speed_max_m_s: speed_m_s * dice.between(0.7, 1.5),
        landing_speed_max_m_s: speed_m_s * dice.between(0.7, 1.5),
        clearance_m: if dice.chance(0.5) { 0.0 } else { size_m * dice.decades(-5.0, -1.5) },
        clearance_rule: dice.0.clearance_rule(),
        takeoff_angle_min: angle(some(dice, -20.0, 60.0)),
        takeoff_angle_max: angle(some(dice, 40.0, 89.0)),
        apex_height_max_m: some(dice, 0.05, 0.6).map(|share| share * scale_m),
        flight_time_max_s: some(dice, 0.3, 1.8).map(|share| share * speed_m_s / gravity_m_s2),
        ..HopperLimits::UNLIMITED
    };
    let fastest_m_s = limits.takeoff_speed_max_m_s;
    dice.0.commands(&mut limits, fastest_m_s);
    if limits.takeoff_angle_min > limits.takeoff_angle_max && limits.takeoff_angle_max.is_some() {
        std::mem::swap(&mut limits.takeoff_angle_min, &mut limits.takeoff_angle_max);
    }
    Hopper::new(limits).unwrap()
}

fn offsets(dice: &mut Dice) -> (AngleInterval, AngleInterval) {
    let (takeoff, landing) = (dice.between(5.0, 60.0), dice.between(-60.0, -5.0));
    let (high, low) = (takeoff + dice.between(15.0, 90.0), landing - dice.between(15.0, 90.0));
    (AngleInterval::from_degrees(takeoff, high), AngleInterval::from_degrees(low, landing))
}

fn surface(dice: &mut Dice) -> SurfaceProperties {
    let grip = if dice.chance(0.6) {
        Grip::Friction(FrictionCone::new(dice.one_of(&[0.3, 0.6, 0.9, 1.5, 5.0])).unwrap())
    } else {
        let (takeoff, landing) = offsets(dice);
        Grip::FromSlope { takeoff, landing }
    };
    let rest = dice.one_of(&[
        RestSlope::Unlimited,
        RestSlope::Unlimited,
        RestSlope::AsFrictionHolds,
        RestSlope::AtMost(Angle::from_degrees(50.0)),
    ]);
    SurfaceProperties { grip: Some(grip), rest }
}

fn ground(dice: &mut Dice, explicit: bool, speed_m_s: f64) -> SegmentGround {
    if explicit {
        let mut line = || {
            dice.chance(0.95).then(|| {
                let (takeoff, landing) = offsets(dice);
                let mut speed = || speed_m_s * dice.between(0.7, 1.5);
                LineConstraints { takeoff: ContactRule::new(takeoff, speed()), landing: ContactRule::new(landing, speed()) }
            })
        };
        let form = GroundForm::Explicit { forward: line(), reverse: line() };
        return SegmentGround { form, keep_out: false };
    }
    let friction = dice.chance(0.3).then(|| FrictionCone::new(dice.between(0.4, 1.5)).unwrap());
    let cross_slope = Angle::from_degrees(if dice.chance(0.3) { dice.between(0.0, 18.0) } else { 0.0 });
    SegmentGround { form: GroundForm::Surface { friction, cross_slope }, keep_out: dice.chance(0.03) }
}

fn on_a_map(dice: &mut Dice, vertices: &[ChainPoint]) -> Vec<MapPoint> {
    let heading = dice.between(0.0, std::f64::consts::TAU);
    let at = |v: &ChainPoint| v.x_m - vertices[0].x_m;
    vertices.iter().map(|v| MapPoint::new(923.0 + at(v) * heading.sin(), 369.0 + at(v) * heading.cos())).collect()
}

//! What a machine that takes its commands in steps asks of a ground: the ground of a chain, and that of a DEM.

use nalgebra::Vector2;

use super::MISS_MAX;
use crate::{
    chain::Station,
    ground::{ChainGround, ChainPosition, ContactPoint, DemGround, FirstContact, MapPosition, Surface, heading_of},
    hop::HopTest,
    path::Hop,
    quantity::{MapPoint, VertexId},
    world::{CommandSteps, Direction, Limit, headings_near},
};

/// How far to aim over a DEM, as shares of the distance to the point of a heading that is nearest to the aim: where the ground or a limit
/// refuses that point, the next ones are tried.
const SHARES: [f64; 9] = [1.0, 0.98, 1.02, 0.95, 1.05, 0.9, 1.1, 0.8, 1.2];

/// A direction of flight that the machine has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Heading {
    /// Its unit vector: (east, north) on a map, (1, 0) or (-1, 0) along a chain.
    pub(super) along: Vector2<f64>,
    /// The command, clockwise from grid north, 0 to 360 degrees; `None` without a step of the heading.
    pub(super) degrees: Option<f64>,
}

/// A point that commands are aimed at: the aim itself, or the nearest to it that a heading of the machine leads to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<C> {
    pub(super) at: C,
    pub(super) heading: Heading,
}

/// Two contacts with the hop test between them.
pub(crate) struct Pair {
    pub(super) test: HopTest,
    pub(super) takeoff: Station,
    pub(super) landing: Station,
}

/// The line of a planned hop, which the positions of hops beside it are projected on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Its take-off on the map, and the distance along the journey there, m.
    from: (MapPoint, f64),
    /// Its direction on the map, and the sign of the journey's direction.
    along: Vector2<f64>,
    sign: f64,
}

impl Line {
    /// That of a planned hop; for a hop on no map, that of its x.
    pub(super) fn of(planned: &Hop) -> Self {
        let [from, to] = [planned.takeoff.point_m.xy(), planned.landing.point_m.xy()];
        let along = (to - from).try_normalize(0.0).unwrap_or_default();
        Self { from: (from, planned.takeoff.along_m), along, sign: planned.direction.sign() }
    }

    /// The distance along the journey of the projection of a point, m.
    fn along_m(&self, at: MapPoint) -> f64 {
        self.from.1 + self.sign * (at - self.from.0).dot(&self.along)
    }

    /// How far a landing lies beyond its aim along the line, and to the left of it, m.
    pub(super) fn off(&self, landing: &ContactPoint, aim: &ContactPoint) -> (f64, f64) {
        let away = (landing.point_m - aim.point_m).xy();
        (self.sign * (landing.along_m - aim.along_m), self.along.perp(&away))
    }
}

/// A ground that a machine flies over with commands in steps.
pub(crate) trait SteppedGround: FirstContact {
    /// Whether hops may leave the line of the planned path.
    const LEAVES_THE_LINE: bool;

    /// How many commands are flown at most for one hop of a replanned trial.
    const TRIED_ANEW: usize;

    /// The hop test from one contact to another.
    ///
    /// # Errors
    /// [`Limit::Direction`] where no hop can join them: both have the same horizontal position, or ground between them is missing.
    fn pair(&self, takeoff: &Self::Contact, landing: &Self::Contact) -> Result<Pair, Limit>;

    /// The contact of a planned position; `None` where this ground has none.
    fn planned(&self, point: &ContactPoint) -> Option<Self::Contact>;

    /// A position of the path: on its station, or projected on a line. A position at `on_line_m` along the line keeps this number.
    fn stated(&self, at: &Self::Contact, line: &Line, on_line_m: f64) -> ContactPoint;

    /// The contact of a landing, at the height that this ground has there.
    fn landed(&self, end: Self::Contact) -> Option<Self::Contact>;

    /// What to aim at, the nearest to the aim first: the aim, or points of the machine's headings near it.
    fn targets(&self, takeoff: &Self::Contact, aim: &Self::Contact, steps: CommandSteps) -> Vec<Target<Self::Contact>>;
}

impl SteppedGround for ChainGround {
    const LEAVES_THE_LINE: bool = false;
    const TRIED_ANEW: usize = usize::MAX;

    fn pair(&self, takeoff: &ChainPosition, landing: &ChainPosition) -> Result<Pair, Limit> {
        Ok(Pair { test: self.test().clone(), takeoff: takeoff.station, landing: landing.station })
    }

    fn planned(&self, point: &ContactPoint) -> Option<ChainPosition> {
        point.station.map(ChainPosition::on_chain)
    }

    fn stated(&self, at: &ChainPosition, _: &Line, _: f64) -> ContactPoint {
        self.test().chain().contact_point(&at.station)
    }

    fn landed(&self, end: ChainPosition) -> Option<ChainPosition> {
        Some(end)
    }

    fn targets(&self, takeoff: &ChainPosition, aim: &ChainPosition, _: CommandSteps) -> Vec<Target<ChainPosition>> {
        let direction = Direction::between(takeoff.station.point.x_m, aim.station.point.x_m);
        let target =
            direction.map(|direction| Target { at: *aim, heading: Heading { along: heading_of(direction), degrees: None } });
        target.into_iter().collect()
    }
}

impl SteppedGround for DemGround {
    const LEAVES_THE_LINE: bool = true;
    /// Each of them cuts a slice, and a hopper without commands asks for those to every node within its reach.
    const TRIED_ANEW: usize = 24;

    /// The hop test of the slice between the two positions.
    fn pair(&self, takeoff: &MapPosition, landing: &MapPosition) -> Result<Pair, Limit> {
        let test = HopTest::new(self.chain(takeoff.at, landing.at).map_err(|_| Limit::Direction)?);
        let geometry = test.chain().geometry();
        let [takeoff, landing] = [0, geometry.segment_count()].map(|end| geometry.vertex_station(VertexId(end)));
        Ok(Pair { test, takeoff, landing })
    }

    fn planned(&self, point: &ContactPoint) -> Option<MapPosition> {
        self.contact_at(point)
    }

    fn stated(&self, at: &MapPosition, line: &Line, on_line_m: f64) -> ContactPoint {
        let along_m = line.along_m(at.at);
        // The projection of a point of the line has rounding.
        let is_on_line = (along_m - on_line_m).abs() <= self.position_rounding_m();
        ContactPoint::on_map(if is_on_line { on_line_m } else { along_m }, at.at, at.z_m)
    }

    fn landed(&self, end: MapPosition) -> Option<MapPosition> {
        self.position(end.at)
    }

    fn targets(&self, takeoff: &MapPosition, aim: &MapPosition, steps: CommandSteps) -> Vec<Target<MapPosition>> {
        let Some((run_m, exact)) = self.course(takeoff, aim) else { return Vec::new() };
        let Some(step) = steps.heading else {
            return vec![Target { at: *aim, heading: Heading { along: exact, degrees: None } }];
        };
        let exact_deg = libm::atan2(exact.x, exact.y).to_degrees();
        let mut found: Vec<(f64, Target<MapPosition>)> = Vec::new();
        for degrees in headings_near(exact_deg, step.degrees()) {
            let (east, north) = libm::sincos(degrees.to_radians());
            let along = Vector2::new(east, north);
            let heading = Heading { along, degrees: Some(degrees) };
            // The point of the heading nearest to the aim. A heading that leads away from the aim has no such point.
            let foot_m = run_m * along.dot(&exact);
            if foot_m <= 0.0 {
                continue;
            }
            for share in SHARES {
                let at = takeoff.at + along * (foot_m * share);
                let miss_m = (at - aim.at).norm();
                let at = if miss_m <= self.position_rounding_m() { Some(*aim) } else { self.position(at) };
                found.extend(at.filter(|_| miss_m <= MISS_MAX * run_m).map(|at| (miss_m, Target { at, heading })));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.into_iter().map(|(_, target)| target).collect()
    }
}

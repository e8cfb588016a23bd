//! The data of the picture, in metres; drawing adds no information.

use super::{
    FigureError, FigureInput,
    limits::words,
    spans::{GroundSpan, spans},
};
use crate::{
    ballistics::{Arc, limits::ClearanceProfile},
    chain::Station,
    graph::{EndpointRefusal, Frontier, NodeSet, Outcome},
    hop::HopTest,
    path::{Hop, HopPath, Totals},
    quantity::{AngleInterval, ChainPoint, SlopeInterval, VertexId},
    world::{Contact, Direction, Limit},
};

/// The greatest number of hops drawn; longer paths are thinned to every n-th hop, and the picture says so.
pub const MOST_HOPS_DRAWN: usize = 300;
/// The greatest number of nodes drawn.
const MOST_NODES_DRAWN: usize = 150;
/// Margin beside the journey, as a fraction of its length.
const MARGIN: f64 = 0.06;
/// A journey over at least this fraction of the chain shows the whole chain.
const WHOLE_CHAIN: f64 = 0.6;

/// The data of one analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureData {
    /// The range of x shown, m.
    pub view_x_m: (f64, f64),
    /// The range of the chain, m.
    pub chain_x_m: (f64, f64),
    /// The stretches of ground by allowed contacts, over the range shown.
    pub spans: Vec<GroundSpan>,
    /// Nodes of the search within the range shown.
    pub nodes: Thinned<ChainPoint>,
    /// The height that the hops keep over the ground.
    pub clearance: ClearanceProfile,
    /// Where the journey begins.
    pub start: ChainPoint,
    /// Where it should end.
    pub goal: ChainPoint,
    /// The result.
    pub subject: Subject,
    /// Whether the hopper prepares its hops, so that times of missions have preparations in them.
    pub prepares: bool,
    /// Where the line turns within the range shown; empty for a route that turns at every landing.
    pub bends: Vec<ChainPoint>,
    /// What x is measured along.
    pub along: &'static str,
}

/// A sequence thinned to every n-th item.
#[derive(Clone, Debug, PartialEq)]
pub struct Thinned<T> {
    /// The items shown.
    pub shown: Vec<T>,
    /// Every n-th item is shown.
    pub every: usize,
    /// The number of all items.
    pub of: usize,
}

/// The result of the search.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// A path.
    Path {
        /// Its hops.
        hops: Thinned<HopFigure>,
        /// Its totals.
        totals: Box<Totals>,
    },
    /// No path over these nodes.
    Stopped(Box<StoppedFigure>),
    /// A path of so many hops with exact commands, which no commands in the machine's steps fly, and why not.
    NoCommands(u64, Option<String>),
    /// No hop at all can take off or land at start, goal or both.
    EndpointsRefuse(Vec<EndpointRefusal>),
    /// No route over the nodes of a DEM.
    RouteNotFound,
}

/// One hop as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct HopFigure {
    /// Its number in the path, from 1.
    pub number: usize,
    /// Its record.
    pub hop: Hop,
    /// Its feasible take-off angles.
    pub windows: HopWindows,
    /// Its flight.
    pub arc: Arc,
    /// The take-off cone at its take-off and the landing cone at its landing; `None` if the ground allows no contact.
    pub cones: [Option<Cone>; 2],
    /// With brakes: the speed of the touchdown straight down, m/s, instead of a landing cone.
    pub touchdown_m_s: Option<f64>,
}

/// The feasible take-off angles of a hop, as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct HopWindows {
    /// The windows, ascending; at least one.
    pub angles: Vec<AngleInterval>,
    /// The names of the limits at the lower end of the first and at the upper end of the last.
    pub ends: [String; 2],
    /// The limit that refuses the angles between two windows.
    pub between: Option<Limit>,
}

/// The allowed directions at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Where.
    pub apex: ChainPoint,
    /// Take-off or landing.
    pub contact: Contact,
    /// Direction of travel.
    pub direction: Direction,
    /// Slopes of flight in the direction of travel, limited to forward directions.
    pub slopes: SlopeInterval,
}

/// The obstacle of a journey, as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct StoppedFigure {
    /// Runs of neighbouring nodes reachable from the start, as ranges of x, m.
    pub reached_x_m: Vec<(f64, f64)>,
    /// Runs of neighbouring nodes from which the goal can be reached.
    pub leads_to_goal_x_m: Vec<(f64, f64)>,
    /// The reached node nearest to the goal, and the node nearest to the start from which the goal can be reached.
    pub gap: (ChainPoint, ChainPoint),
    /// The refusals by limit, in descending order.
    pub refusals: Vec<(Limit, u64)>,
    /// The refused hop with the smallest violation: take-off, landing, reason.
    pub nearest_miss: Option<(ChainPoint, ChainPoint, String)>,
}

impl HopFigure {
    /// The point of the flight at a fraction of its horizontal distance, 0 to 1.
    pub fn point_at(&self, share: f64) -> ChainPoint {
        let distance_m = self.arc.line_of_sight().run_m() * share;
        let from = self.hop.takeoff.in_profile();
        let z_m = from.z_m + self.arc.height_at_m(distance_m);
        if self.hop.is_beside_line() {
            // Projected on the plane of the picture.
            return ChainPoint::new(from.x_m + (self.hop.landing.along_m - from.x_m) * share, z_m);
        }
        ChainPoint::new(from.x_m + self.hop.direction.sign() * distance_m, z_m)
    }
}

impl Cone {
    /// The unit vector (x, z) from the cone's apex in which the hopper departs, or from which it arrives, at a slope of flight.
    pub fn ray(&self, slope: f64) -> (f64, f64) {
        let sign = self.direction.sign();
        let (along, up) = if slope.is_infinite() {
            (0.0, slope.signum())
        } else {
            (1.0 / libm::hypot(1.0, slope), slope / libm::hypot(1.0, slope))
        };
        match self.contact {
            Contact::Takeoff => (sign * along, up),
            Contact::Landing => (-sign * along, -up),
        }
    }
}

impl<T> Thinned<T> {
    /// Thins a sequence of known length to at most `most` items.
    fn of(all: impl ExactSizeIterator<Item = T>, most: usize) -> Self {
        let of = all.len();
        let every = of.div_ceil(most).max(1);
        Self { shown: all.step_by(every).collect(), every, of }
    }
}

impl FigureData {
    /// Collects the data of the picture.
    ///
    /// # Errors
    /// [`FigureError::NoHops`] if the answer is a path whose hops were not given; [`FigureError::Nodes`].
    pub fn new(input: &FigureInput<'_>) -> Result<Self, FigureError> {
        let chain = input.test.chain();
        let nodes = NodeSet::new(chain, input.start, input.goal, input.answer.spacing)?;
        let subject = match &input.answer.outcome {
            Outcome::EndpointsRefuse(_) | Outcome::NoPath(_) if input.plan_view.is_some() => Subject::RouteNotFound,
            Outcome::Path { .. } => match input.path {
                Some(path) => path_subject(input, path),
                None if input.test.hopper().limits().steps.is_continuous() => return Err(FigureError::NoHops),
                None => Subject::NoCommands(input.answer.hops().unwrap_or(0), input.title.refusal.clone()),
            },
            Outcome::EndpointsRefuse(refusals) => Subject::EndpointsRefuse(refusals.clone()),
            Outcome::NoPath(frontier) => Subject::Stopped(Box::new(stopped(frontier, &nodes))),
        };
        let chain_x_m = chain.geometry().extent_m();
        let view_x_m = view(input, chain_x_m);
        let towards = Direction::between(input.start.point.x_m, input.goal.point.x_m).unwrap_or(Direction::Forward);
        let inside = |x_m: f64| nodes.stations().partition_point(|station| station.point.x_m < x_m);
        let visible = if input.plan_view.is_some() { 0..0 } else { inside(view_x_m.0)..inside(view_x_m.1.next_up()) };
        let visible = &nodes.stations()[visible];
        Ok(Self {
            view_x_m,
            chain_x_m,
            spans: spans(chain, view_x_m, towards),
            nodes: Thinned::of(visible.iter().map(|station| station.point), MOST_NODES_DRAWN),
            clearance: input.test.clearance(),
            start: input.start.point,
            goal: input.goal.point,
            subject,
            bends: bends(input, view_x_m),
            prepares: input.test.hopper().limits().preparation_time_s.is_some(),
            along: match (&input.plan_view, input.path) {
                (None, _) => "chain",
                (Some(_), Some(_)) => "route",
                (Some(_), None) => "straight line",
            },
        })
    }

    /// Whether the chain continues beyond the range shown.
    pub fn is_cut(&self) -> bool {
        self.view_x_m != self.chain_x_m
    }
}

/// The bends of a chain within a range of x.
fn bends(input: &FigureInput<'_>, (from_x_m, to_x_m): (f64, f64)) -> Vec<ChainPoint> {
    if input.plan_view.is_some() {
        return Vec::new();
    }
    let geometry = input.test.chain().geometry();
    let at = |vertex: &VertexId| geometry.vertices().get(vertex.index()).copied();
    geometry.bends().iter().filter_map(at).filter(|point| (from_x_m..=to_x_m).contains(&point.x_m)).collect()
}

/// The hops of a path.
fn path_subject(input: &FigureInput<'_>, path: &HopPath) -> Subject {
    let all = path.hops.iter().enumerate().map(|(i, hop)| hop_figure(input, i + 1, hop));
    Subject::Path { hops: Thinned::of(all, MOST_HOPS_DRAWN), totals: Box::new(path.totals) }
}

/// One hop with its flight and its two cones.
fn hop_figure(input: &FigureInput<'_>, number: usize, hop: &Hop) -> HopFigure {
    let test = input.test;
    let stations = hop.takeoff.station.zip(hop.landing.station);
    let sight =
        stations.and_then(|(takeoff, landing)| test.line_of_sight(&takeoff, &landing)).unwrap_or_else(|| hop.line_of_sight());
    let windows = windows(test, hop, stations);
    let gravity_m_s2 = test.gravity_m_s2();
    let cone = |station: Option<Station>, contact| {
        let station = station?;
        let rule = test.chain().check_contact(&station, contact, hop.direction).ok()?;
        Some(Cone { apex: station.point, contact, direction: hop.direction, slopes: rule.slopes() })
    };
    let touchdown_m_s = test.hopper().limits().landing.touchdown_speed_m_s();
    let landing_cone = if touchdown_m_s.is_some() { None } else { cone(hop.landing.station, Contact::Landing) };
    HopFigure {
        number,
        hop: *hop,
        windows,
        // The loft from the flight time, n = g T^2 / (2 X), since tangents of steep angles lose digits.
        arc: Arc::new(sight, 0.5 * gravity_m_s2 * hop.flight_time_s * (hop.flight_time_s / sight.run_m()), gravity_m_s2),
        cones: [cone(hop.takeoff.station, Contact::Takeoff), landing_cone],
        touchdown_m_s,
    }
}

/// The windows of a hop, with all of them where the machine cannot be commanded every take-off speed.
fn windows(test: &HopTest, hop: &Hop, stations: Option<(Station, Station)>) -> HopWindows {
    let lower = |limit: Limit, vertex: Option<VertexId>| match vertex {
        Some(vertex) => format!("{} v{}", words(limit), vertex.index() + 1),
        None => words(limit),
    };
    let flown = HopWindows {
        angles: vec![hop.takeoff_angles],
        ends: [lower(hop.lower_limit, hop.lower_vertex), words(hop.upper_limit)],
        between: None,
    };
    let Some(between) = test.takeoff_speeds().limit() else { return flown };
    let Some(set) = stations.and_then(|(takeoff, landing)| test.takeoff_set(&takeoff, &landing)) else { return flown };
    let (Some(first), Some(last)) = (set.windows().first(), set.windows().last()) else { return flown };
    let ends = [lower(first.binding.lower.limit, first.binding.lower.vertex), words(last.binding.upper.limit)];
    let angles: Vec<_> = set.windows().iter().filter_map(|window| set.angles_of(window.lofts)).collect();
    HopWindows { between: (angles.len() > 1).then_some(between), angles, ends }
}

/// How far one gets, and which limits refuse to go on.
fn stopped(frontier: &Frontier, nodes: &NodeSet) -> StoppedFigure {
    StoppedFigure {
        reached_x_m: runs(&frontier.reached, nodes.stations()),
        leads_to_goal_x_m: runs(&frontier.leads_to_goal, nodes.stations()),
        gap: (frontier.nearest_to_goal.point, frontier.nearest_to_start.point),
        refusals: frontier.refusals.ranked(),
        nearest_miss: frontier.nearest_miss.map(|miss| (miss.takeoff.point, miss.landing.point, miss.conflict.said(words))),
    }
}

/// Runs of consecutive nodes that belong to a set, as ranges of x; nodes and set are sorted by x.
fn runs(set: &[Station], nodes: &[Station]) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    let mut members = set.iter().map(|station| station.point.x_m).peekable();
    let mut goes_on = false;
    for x_m in nodes.iter().map(|station| station.point.x_m) {
        let is_member = members.next_if_eq(&x_m).is_some();
        match found.last_mut() {
            Some(run) if is_member && goes_on => run.1 = x_m,
            _ if is_member => found.push((x_m, x_m)),
            _ => {}
        }
        goes_on = is_member;
    }
    found
}

/// The range of x to show: the journey with a margin, or the whole chain if the journey covers most of it.
fn view(input: &FigureInput<'_>, chain_x_m: (f64, f64)) -> (f64, f64) {
    let mut seen = vec![input.start.point.x_m, input.goal.point.x_m];
    match &input.answer.outcome {
        Outcome::Path { .. } => seen.extend(input.path.iter().flat_map(|path| &path.hops).map(|hop| hop.landing.along_m)),
        Outcome::NoPath(frontier) => {
            let both = [&frontier.reached, &frontier.leads_to_goal];
            seen.extend(both.into_iter().flatten().map(|station| station.point.x_m));
        }
        Outcome::EndpointsRefuse(refusals) => {
            seen.extend(refusals.iter().filter_map(|refusal| refusal.nearest).map(|station| station.point.x_m));
        }
    }
    let (low, high) = seen.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)));
    let whole = chain_x_m.1 - chain_x_m.0;
    if high == low || high - low >= WHOLE_CHAIN * whole {
        return chain_x_m;
    }
    let room = MARGIN * (high - low);
    ((low - room).max(chain_x_m.0), (high + room).min(chain_x_m.1))
}

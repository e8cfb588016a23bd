//! The next command from the estimated position of the hopper, for [`Policy::Replan`](super::Policy::Replan).

use std::sync::Arc;

use nalgebra::Vector2;

use crate::{
    ballistics::{self, LineOfSight},
    flight::Command,
    graph::{Cost, CostToGo, Edge},
    ground::{ChainPosition, DemGround, LiftoffVelocity, MapPosition, Surface, heading_of},
    hop::HopTest,
    path::nearest_command,
    quantity::{Angle, NodeId, SlopeInterval},
    world::{CommandSteps, Direction, SPEED_TOLERANCE, nearest_multiple, tolerant_speed_m_s},
};

/// Chooses the next hop from a position of the nominal ground.
pub(super) trait Replan<C>: Send + Sync + std::fmt::Debug {
    /// The best next hop; `None` if no hop leads to the goal.
    fn next(&self, believed: &C) -> Option<Command<C>>;
}

/// The velocity of a take-off at an angle and a speed.
fn at_angle(angle: Angle, speed_m_s: f64, heading: Vector2<f64>) -> LiftoffVelocity {
    let (up, across) = libm::sincos(angle.radians());
    LiftoffVelocity { heading, horizontal_m_s: speed_m_s * across, vertical_m_s: speed_m_s * up }
}

/// The nearest heading of a machine that takes headings in steps; on a map, (east, north).
fn nearest_heading(heading: Vector2<f64>, steps: CommandSteps) -> Vector2<f64> {
    let Some(step) = steps.heading else { return heading };
    let (east, north) = libm::sincos(nearest_multiple(libm::atan2(heading.x, heading.y), step.radians()));
    Vector2::new(east, north)
}

/// Replanning along a chain, by the costs-to-go of its nodes.
#[derive(Debug)]
pub(super) struct ChainReplan {
    pub(super) test: HopTest,
    pub(super) to_go: Arc<CostToGo>,
}

impl Replan<ChainPosition> for ChainReplan {
    fn next(&self, believed: &ChainPosition) -> Option<Command<ChainPosition>> {
        let Self { test, to_go } = self;
        let leg = to_go.best_leg(test, &believed.station)?;
        let direction = Direction::between(leg.takeoff.point.x_m, leg.landing.point.x_m)?;
        let (arc, landing) = match leg.edge {
            Edge::Hop(lofts) => {
                let sight = test.line_of_sight(&leg.takeoff, &leg.landing)?;
                let loft = leg.loft.unwrap_or_else(|| test.loft(to_go.options().takeoff, sight, lofts));
                (ballistics::Arc::new(sight, loft, test.gravity_m_s2()), leg.landing)
            }
            Edge::Along(along) => {
                let (each_m, last_m) = along.lengths_m(to_go.options().split);
                let length_m = if along.hops() > 1 { each_m } else { last_m };
                let x_m = leg.takeoff.point.x_m + direction.sign() * length_m;
                let landing = test.chain().geometry().station(x_m).unwrap_or(leg.landing);
                (along.arc(test, length_m, to_go.options().takeoff), landing)
            }
        };
        if !test.hopper().limits().steps.is_continuous() {
            let hop = nearest_command(test, &leg.takeoff, &landing, to_go.options().takeoff)?;
            let liftoff = at_angle(hop.takeoff_angle, hop.takeoff_speed_m_s, heading_of(direction));
            return Some(Command::new(liftoff, ChainPosition::on_chain(hop.landing.station?)));
        }
        Some(Command::of_arc(&arc, heading_of(direction), ChainPosition::on_chain(landing)))
    }
}

/// Replanning over a DEM, by hops to the nodes of a transect.
#[derive(Debug)]
pub(super) struct MapReplan {
    pub(super) ground: DemGround,
    pub(super) to_go: Arc<CostToGo>,
    /// The map positions of the nodes of the costs-to-go.
    pub(super) nodes: Vec<MapPosition>,
}

impl MapReplan {
    /// The best hop to a node and the cost of the journey over it, if that may be lower than `best`.
    fn hop_to(&self, from: &MapPosition, node: usize, best: Option<Cost>) -> Option<(Command<MapPosition>, Cost)> {
        let Self { ground, to_go, nodes } = self;
        let target = nodes[node];
        let rest = to_go.of_node(NodeId(node))?;
        let away = target.at - from.at;
        let run_m = away.norm();
        let (limits, g) = (ground.hopper().limits(), ground.gravity_m_s2());
        if run_m <= ground.position_rounding_m() {
            return None;
        }
        let sight = LineOfSight::new(run_m, target.z_m - from.z_m);
        let squared = |speed_m_s: f64| tolerant_speed_m_s(speed_m_s) * tolerant_speed_m_s(speed_m_s) * (1.0 + SPEED_TOLERANCE);
        let too_far = g * run_m * sight.min_speed_ratio() > squared(limits.takeoff_speed_max_m_s)
            || g * run_m * sight.min_speed_ratio_reversed() > squared(limits.arc_landing_speed_max_m_s());
        if too_far || best.is_some_and(|best| to_go.least_cost(sight, g) + rest >= best) {
            return None;
        }
        let heading = away / run_m;
        let lofts = ground.lofts_by_walk(from, &target, sight, heading)?;
        let arc = ballistics::Arc::new(sight, ground.envelope().loft(to_go.options().takeoff, sight, lofts), g);
        let cost = to_go.options().effort.cost(&arc, 1) + rest;
        if best.is_some_and(|best| cost >= best) {
            return None;
        }
        if limits.steps.is_continuous() {
            let chosen = to_go.loft_on_map((from, &target), heading, (sight, lofts));
            let arc = chosen.map_or(arc, |loft| ballistics::Arc::new(sight, loft, g));
            return Some((Command::of_arc(&arc, heading, target), cost));
        }
        let (angle, speed_m_s) = self.nearest(&arc, sight, lofts)?;
        let liftoff = at_angle(angle, speed_m_s, nearest_heading(heading, limits.steps));
        Some((Command::new(liftoff, target), cost))
    }

    /// The command in steps that is nearest to an arc: an angle within the feasible ones, and the nearest speed for it.
    fn nearest(&self, arc: &ballistics::Arc, sight: LineOfSight, lofts: SlopeInterval) -> Option<(Angle, f64)> {
        let limits = self.ground.hopper().limits();
        let angle_of = |loft: f64| Angle::from_slope(sight.slope() + loft).degrees();
        let (low_deg, high_deg) = (angle_of(lofts.lower), angle_of(lofts.upper));
        let exact_deg = arc.takeoff_angle().degrees();
        let angle_deg = limits.steps.takeoff_angle.map_or(Some(exact_deg), |step| {
            let step_deg = step.degrees();
            let inside = [0.0, 1.0, -1.0].map(|away| nearest_multiple(exact_deg, step_deg) + away * step_deg);
            let feasible = inside.into_iter().filter(|angle_deg| (low_deg..=high_deg).contains(angle_deg));
            feasible.min_by(|a, b| (a - exact_deg).abs().total_cmp(&(b - exact_deg).abs()))
        })?;
        let angle = Angle::from_degrees(angle_deg);
        let exact_m_s = ballistics::Arc::new(sight, angle.slope() - sight.slope(), self.ground.gravity_m_s2()).takeoff_speed_m_s();
        let speed_m_s = limits.steps.takeoff_speed_m_s.map_or(exact_m_s, |step| nearest_multiple(exact_m_s, step));
        let allowed = limits.takeoff_speed_min_m_s.unwrap_or(0.0)..=tolerant_speed_m_s(limits.takeoff_speed_max_m_s);
        (speed_m_s > 0.0 && allowed.contains(&speed_m_s)).then_some((angle, speed_m_s))
    }

    /// If reliability counts: of the successors of the nearest node, the most reliable that one hop from a position reaches.
    fn reliable_successor(&self, from: &MapPosition) -> Option<Command<MapPosition>> {
        if !self.to_go.weighs_reliability() {
            return None;
        }
        let away2 = |node: &MapPosition| (node.at - from.at).norm_squared();
        let nearest = (0..self.nodes.len()).min_by(|&a, &b| away2(&self.nodes[a]).total_cmp(&away2(&self.nodes[b])))?;
        let mut successors = self.to_go.reliable_successors(NodeId(nearest)).iter();
        successors.find_map(|node| self.hop_to(from, node.index(), None)).map(|(command, _)| command)
    }
}

impl Replan<MapPosition> for MapReplan {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        if let Some(reliable) = self.reliable_successor(believed) {
            return Some(reliable);
        }
        let mut best: Option<(Command<MapPosition>, Cost)> = None;
        for node in self.to_go.in_order() {
            let known = best.as_ref().map(|(_, cost)| *cost);
            let rest = self.to_go.of_node(*node)?;
            if known.is_some_and(|known| Cost::of_hops(1) + rest >= known) {
                // The nodes are sorted by cost-to-go, so no later node is better.
                break;
            }
            if let Some(better) = self.hop_to(believed, node.index(), known) {
                best = Some(better);
            }
        }
        best.map(|(command, _)| command)
    }
}

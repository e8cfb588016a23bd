//! The next command from the estimated position of the hopper, for [`Policy::Replan`](super::Policy::Replan).

use std::sync::Arc;

use crate::{
    ballistics::{self, TakeoffChoice},
    flight::Command,
    graph::{Corridor, Cost, CostToGo, Edge},
    ground::{ChainGround, ChainPosition, DemGround, HopReach, MapPosition, Surface, heading_of},
    hop::HopTest,
    path::{SteppedGround, nearest_command},
    quantity::NodeId,
    world::Direction,
};

/// Chooses the next hop from a position of the nominal ground.
pub(super) trait Replan<C>: Send + Sync + std::fmt::Debug {
    /// The best next hop; `None` if no hop leads to the goal.
    fn next(&self, believed: &C) -> Option<Command<C>>;

    /// Whether the planned hop is the best one at a planned position.
    fn follows_plan(&self) -> bool {
        true
    }
}

/// The command of a machine in steps that is nearest to an exact one, aimed at where it lands.
pub(super) fn in_steps<G: SteppedGround>(
    ground: &G,
    takeoff: &G::Contact,
    aim: &G::Contact,
    choice: TakeoffChoice,
) -> Option<Command<G::Contact>> {
    let nearest = nearest_command(ground, takeoff, aim, choice)?;
    Some(Command { liftoff: nearest.liftoff, speed_m_s: nearest.speed_m_s, aim: nearest.landing, rest: nearest.landing })
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
        let choice = to_go.options().takeoff;
        let along = match leg.edge {
            Edge::Hop(_) => None,
            Edge::Along(along) => {
                let (each_m, last_m) = along.lengths_m(to_go.options().split);
                Some((along, if along.hops() > 1 { each_m } else { last_m }))
            }
        };
        let landing = along.as_ref().map_or(leg.landing, |(_, length_m)| {
            let x_m = leg.takeoff.point.x_m + direction.sign() * length_m;
            test.chain().geometry().station(x_m).unwrap_or(leg.landing)
        });
        if !test.hopper().limits().steps.is_continuous() {
            let [takeoff, aim] = [leg.takeoff, landing].map(ChainPosition::on_chain);
            return in_steps(&ChainGround::new(test.clone()), &takeoff, &aim, choice);
        }
        let arc = match (leg.edge, along) {
            (Edge::Hop(lofts), _) => {
                let sight = test.line_of_sight(&leg.takeoff, &leg.landing)?;
                let loft = leg.loft.unwrap_or_else(|| test.loft(choice, sight, lofts));
                ballistics::Arc::new(sight, loft, test.gravity_m_s2())
            }
            (Edge::Along(along), length) => along.arc(test, length?.1, choice),
        };
        Some(Command::of_arc(&arc, heading_of(direction), ChainPosition::on_chain(landing)))
    }
}

/// What kind of command of a hop is wanted.
#[derive(Clone, Copy)]
enum CommandKind {
    /// Those that lead to the node exactly.
    Exact,
    /// Those that the machine has.
    InSteps,
}

/// Replanning over a DEM, by hops to the nodes of a transect.
#[derive(Debug)]
pub(super) struct MapReplan {
    ground: DemGround,
    reach: HopReach,
    to_go: Arc<CostToGo>,
    /// The map positions of the nodes of the costs-to-go.
    nodes: Vec<MapPosition>,
}

impl MapReplan {
    /// `nodes`: the map positions of the nodes of the costs-to-go.
    pub(super) fn new(ground: DemGround, to_go: Arc<CostToGo>, nodes: Vec<MapPosition>) -> Self {
        Self { reach: HopReach::of(&ground), ground, to_go, nodes }
    }

    /// The best hop to any node.
    fn best(&self, from: &MapPosition, commands: CommandKind) -> Option<Command<MapPosition>> {
        let mut best: Option<(Command<MapPosition>, Cost)> = None;
        for node in self.to_go.in_order() {
            let known = best.as_ref().map(|(_, cost)| *cost);
            let rest = self.to_go.of_node(*node)?;
            if known.is_some_and(|known| Cost::of_hops(1) + rest >= known) {
                // The nodes are sorted by cost-to-go, so no later node is better.
                break;
            }
            if let Some(better) = self.hop_to(from, node.index(), known, commands) {
                best = Some(better);
            }
        }
        best.map(|(command, _)| command)
    }

    /// The best hop to a node and the cost of the journey over it, if that may be lower than `best`.
    fn hop_to(
        &self,
        from: &MapPosition,
        node: usize,
        best: Option<Cost>,
        commands: CommandKind,
    ) -> Option<(Command<MapPosition>, Cost)> {
        let Self { ground, reach, to_go, nodes } = self;
        let target = nodes[node];
        let rest = to_go.of_node(NodeId(node))?;
        let g = ground.gravity_m_s2();
        let (sight, heading) = reach.sight(ground, from, &target)?;
        if best.is_some_and(|best| to_go.least_cost(sight, g) + rest >= best) {
            return None;
        }
        let lofts = ground.lofts_by_walk(from, &target, sight, heading)?;
        let arc = ballistics::Arc::new(sight, ground.envelope().loft(to_go.options().takeoff, sight, lofts), g);
        let cost = to_go.options().effort.cost(&arc, 1) + rest;
        if best.is_some_and(|best| cost >= best) {
            return None;
        }
        let command = match commands {
            CommandKind::Exact => {
                let chosen = to_go.loft_on_map((from, &target), heading, (sight, lofts));
                let arc = chosen.map_or(arc, |loft| ballistics::Arc::new(sight, loft, g));
                Command::of_arc(&arc, heading, target)
            }
            CommandKind::InSteps => in_steps(ground, from, &target, to_go.options().takeoff)?,
        };
        Some((command, cost))
    }

    /// If reliability counts: of the successors of the nearest node, the most reliable that one hop from a position reaches.
    fn reliable_successor(&self, from: &MapPosition) -> Option<Command<MapPosition>> {
        if !self.to_go.weighs_reliability() {
            return None;
        }
        let away2 = |node: &MapPosition| (node.at - from.at).norm_squared();
        let leads = (0..self.nodes.len()).filter(|&node| self.to_go.leads_over(NodeId(node)));
        let nearest = leads.min_by(|&a, &b| away2(&self.nodes[a]).total_cmp(&away2(&self.nodes[b])))?;
        let mut successors = self.to_go.reliable_successors(NodeId(nearest)).iter();
        let commands = if self.ground.hopper().limits().steps.is_continuous() { CommandKind::Exact } else { CommandKind::InSteps };
        successors.find_map(|node| self.hop_to(from, node.index(), None, commands)).map(|(command, _)| command)
    }
}

impl Replan<MapPosition> for MapReplan {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        if let Some(reliable) = self.reliable_successor(believed) {
            return Some(reliable);
        }
        let exact = self.best(believed, CommandKind::Exact)?;
        if self.ground.hopper().limits().steps.is_continuous() {
            return Some(exact);
        }
        // The best hop mostly has a command in steps; to look for one of every hop on the way to it would take many times as long.
        let nearest = in_steps(&self.ground, believed, &exact.aim, self.to_go.options().takeoff);
        nearest.or_else(|| self.best(believed, CommandKind::InSteps))
    }
}

/// Replanning over a DEM, by hops to the nodes of a transect and the posts beside it.
#[derive(Debug)]
pub(super) struct CorridorReplan {
    pub(super) corridor: Arc<Corridor>,
}

impl Replan<MapPosition> for CorridorReplan {
    fn next(&self, believed: &MapPosition) -> Option<Command<MapPosition>> {
        let ground = self.corridor.ground();
        let is_continuous = ground.hopper().limits().steps.is_continuous();
        self.corridor.next_command(believed, |judge, target, heading, hop| {
            if is_continuous {
                Some(judge.command((believed, target), heading, hop))
            } else {
                in_steps(ground, believed, target, judge.takeoff())
            }
        })
    }
}

//! The hops of a roadmap, each with its distinct commands.

use super::{Roadmap, RoadmapGround};
use crate::{
    ballistics::{Arc, TakeoffChoice},
    planner::{Amount, Amounts, LeastAmounts, LegGraph, LegVisitor, PathStep, SearchedCommands, Successor},
    progress::Cancelled,
};

/// The command of a straight line that is walked.
const WALKED: u32 = u32::MAX;

/// The graph of a roadmap from a start to a goal.
#[derive(Debug)]
pub struct RoadmapLegs<'a, G: RoadmapGround> {
    roadmap: &'a Roadmap<G::Node>,
    ground: &'a G,
    ends: (usize, usize),
    commands: Vec<TakeoffChoice>,
    least: LeastAmounts,
    /// The fewest hops to the goal: no path of the roadmap takes fewer. Walking takes none.
    hops_left: Vec<Option<u32>>,
}

impl<'a, G: RoadmapGround> RoadmapLegs<'a, G> {
    /// The graph. `offered`: the commands of a hop, with the `takeoff` that is chosen.
    pub fn new(
        roadmap: &'a Roadmap<G::Node>,
        ground: &'a G,
        ends: (usize, usize),
        (offered, takeoff): (SearchedCommands, TakeoffChoice),
    ) -> Self {
        Self {
            roadmap,
            ground,
            ends,
            commands: offered.choices(takeoff, false),
            least: ground.least_amounts(),
            hops_left: roadmap.hops_to(ends.1),
        }
    }

    /// Start and goal.
    pub const fn ends(&self) -> (usize, usize) {
        self.ends
    }

    /// Whether the machine also walks: what a hop takes at least then bounds no path.
    const fn walks(&self) -> bool {
        self.roadmap.walks().are_looked_for()
    }

    /// What a hop along an arc takes. Where hops alone follow each other the machine settles before every hop but the first; where it also walks,
    /// after every landing but one at the goal.
    fn amounts(&self, arc: &Arc, [from, to]: [usize; 2]) -> Amounts {
        let limits = self.ground.envelope().hopper().limits();
        Amounts::of_arc(arc, limits, if self.walks() { to == self.ends.1 } else { from == self.ends.0 })
    }

    /// The fewest hops from every contact to the goal; `None` from where it is not reached.
    pub fn hops_left(&self) -> &[Option<u32>] {
        &self.hops_left
    }

    /// The arc of a step of a path; `None` where it is walked.
    pub fn arc(&self, step: &PathStep) -> Option<Arc> {
        let sight = self.roadmap.sight(self.ground, step.from, step.to)?;
        let choice = *self.commands.get(step.command as usize)?;
        let (_, loft) = choice.among(sight, self.roadmap.windows_between(step.from, step.to))?;
        Some(Arc::new(sight, loft, self.ground.envelope().gravity_m_s2()))
    }
}

impl<G: RoadmapGround> LegGraph for RoadmapLegs<'_, G> {
    fn nodes(&self) -> usize {
        self.roadmap.contact_count()
    }

    fn successors(&self, node: usize, visitor: &mut dyn LegVisitor) -> Result<(), Cancelled> {
        let (roadmap, envelope) = (self.roadmap, self.ground.envelope());
        for hop in roadmap.hops_from(node) {
            if self.hops_left[hop.landing].is_none() || !visitor.may_improve(hop.landing, &Amounts::ONE_HOP) {
                continue;
            }
            let Some(sight) = roadmap.sight(self.ground, node, hop.landing) else { continue };
            if !visitor.wants(hop.landing, &self.least.of_hop(sight)) {
                continue;
            }
            let mut known = [f64::NAN; TakeoffChoice::ALL.len()];
            for ((command, choice), number) in self.commands.iter().enumerate().zip(0..) {
                let Some((_, loft)) = choice.among(sight, roadmap.windows(hop)) else { continue };
                if !known[..command].contains(&loft) {
                    let arc = Arc::new(sight, loft, envelope.gravity_m_s2());
                    let amounts = self.amounts(&arc, [node, hop.landing]);
                    visitor.visit(&Successor { node: hop.landing, command: number, amounts });
                }
                known[command] = loft;
            }
        }
        for (to, amounts) in roadmap.walks().of(node) {
            if self.hops_left[*to].is_some() && visitor.wants(*to, amounts) {
                visitor.visit(&Successor { node: *to, command: WALKED, amounts: *amounts });
            }
        }
        Ok(())
    }

    fn least_to_goal(&self, node: usize) -> Amounts {
        let [here, goal] = [node, self.ends.1].map(|node| self.ground.point_m(self.roadmap.contact(node)));
        let away = goal - here;
        if self.walks() {
            return Amounts::NONE.with(Amount::Hops, self.hops_left[node].map_or(0.0, f64::from));
        }
        self.least.over_in(libm::hypot(away.x, away.y), away.z, self.hops_left[node].map_or(0, u64::from))
    }
}

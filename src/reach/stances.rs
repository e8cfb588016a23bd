//! Stances all over a DEM: where a robot with legs can stand, and the fewest hops from stance to stance.
//!
//! ```text
//!     o   o   o   nodes: posts, each with some headings of the trunk; at each the height of the root is looked for at which most feet stand
//!       \   /
//!     o  `o   o   hops: from stance to stance, layer by layer; each stance that is not reached yet looks for one of the last layer
//! ```

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector2, Vector3};
use rayon::prelude::*;

use super::map::{NO_GROUND, NOT_SEARCHED, NodeLattice, Post, UNREACHED};
use crate::{
    ballistics::stance::{ConeSum, ContactCone},
    ground::{Foothold, LimbOutcome, NoStance, Pose, Stance, StanceBuffers, StanceGround},
    progress::{Cancelled, Detail, Meter, Progress, Stage},
    quantity::SlopeInterval,
    terrain::Dem,
};

/// Directions in which the beam of a stance is looked at.
pub const DIRECTIONS: u32 = 36;

/// The predecessor of a start, and of what is not reached.
const NONE: u32 = u32::MAX;

/// What a robot finds at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeStance {
    /// The most feet that find ground, whether it stands on them or not; 0 where its trunk meets the ground in every pose.
    pub legs: usize,
    /// Which limbs find ground in some pose, a bit for each of the first 64.
    pub limbs: u64,
    /// The share of the headings of its trunk in which it stands.
    pub headings: f64,
    /// The widest interval of take-off angles of its stances, of any direction, degrees; `None` where it does not stand.
    pub beam_deg: Option<f64>,
    /// The share of the directions in which the feet of some stance push.
    pub directions: f64,
}

/// Stances at the nodes of a DEM.
#[derive(Clone, Debug)]
pub struct StanceNodes {
    lattice: NodeLattice,
    headings: u32,
    found: Vec<Option<NodeStance>>,
    stances: Vec<Option<Stance>>,
}

/// What a robot finds at a node, `None` without an elevation, and its stances there, heading by heading, if they are kept.
type AtNode = (Option<NodeStance>, Vec<Option<Stance>>);

/// The fewest hops from some starts to every node.
#[derive(Clone, Debug)]
pub struct StanceHops {
    /// Of each node, to any of its stances; [`UNREACHED`], [`NOT_SEARCHED`] or [`NO_GROUND`].
    pub hops: Vec<i16>,
    /// Ordered pairs of stances whose hop was tested.
    pub pairs_tested: u64,
    of_stance: Vec<i16>,
    from: Vec<u32>,
    headings: usize,
}

impl StanceNodes {
    /// Looks for stances at every node, each heading by itself. They are kept only if hops between them are to be found.
    ///
    /// The result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// A stance for each node and heading where all feet find ground at the first height, at most eleven.
    pub fn of(
        ground: &StanceGround,
        (dem, lattice): (&Dem, NodeLattice),
        headings: u32,
        keeps: bool,
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let meter = Meter::with_total(progress, Stage::Search, lattice.count() as u64);
        meter.report(Detail::None)?;
        let row = |row: usize| -> Result<Vec<AtNode>, Cancelled> {
            meter.check()?;
            let nodes = (0..lattice.cols).map(|col| at_node(ground, (dem, lattice), Post { row, col }, headings, keeps));
            Ok(nodes.collect())
        };
        let rows: Vec<_> = (0..lattice.rows).into_par_iter().map(row).collect::<Result<_, _>>()?;
        let mut nodes = Self {
            lattice,
            headings,
            found: Vec::with_capacity(lattice.count()),
            stances: Vec::with_capacity(if keeps { lattice.count() } else { 0 }),
        };
        for (found, stances) in rows.into_iter().flatten() {
            nodes.found.push(found);
            nodes.stances.extend(stances);
        }
        Ok(nodes)
    }

    /// An upper bound on the memory of a node with its stances, bytes.
    pub const fn bytes_per_node(limbs: usize, headings: usize, keeps: bool) -> usize {
        let stance = size_of::<Option<Stance>>()
            + limbs * (size_of::<Foothold>() + size_of::<LimbOutcome>())
            // The cone: its contacts, and two rays for each of two planes that touch two of them.
            + limbs * size_of::<ContactCone>()
            + limbs * limbs * 2 * size_of::<[Vector3<f64>; 2]>();
        let of_hops = size_of::<i16>() + size_of::<u32>();
        size_of::<Option<NodeStance>>() + if keeps { headings * (stance + of_hops) } else { 0 }
    }

    /// What was found at a node, by its number; `None` without an elevation.
    pub fn found(&self, node: usize) -> Option<&NodeStance> {
        self.found.get(node)?.as_ref()
    }

    /// How many stances there are, where they were kept.
    pub fn stance_count(&self) -> usize {
        self.stances.iter().flatten().count()
    }

    /// A stance by its number.
    pub fn stance(&self, number: usize) -> Option<&Stance> {
        self.stances.get(number)?.as_ref()
    }

    /// The stances of a node, by their numbers.
    fn of_node(&self, node: usize) -> std::ops::Range<usize> {
        let headings = self.headings as usize;
        node * headings..(node + 1) * headings
    }

    /// The fewest hops from any stance of some nodes to every other node, over these stances.
    ///
    /// The result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`Cancelled`].
    ///
    /// # Complexity
    /// The windows of at most every ordered pair of stances as near as one hop by the greatest speeds, each once.
    pub fn hops(
        &self,
        ground: &StanceGround,
        starts: &[Post],
        hops_max: Option<i16>,
        progress: &dyn Progress,
    ) -> Result<StanceHops, Cancelled> {
        let meter = Meter::new(progress, Stage::Search);
        let count = self.stances.len();
        let (mut of_stance, mut from) = (vec![UNREACHED; count], vec![NONE; count]);
        let mut layer: Vec<usize> = Vec::new();
        for start in starts {
            for number in self.of_node(self.lattice.index(*start)) {
                if self.stances[number].is_some() && of_stance[number] == UNREACHED {
                    of_stance[number] = 0;
                    layer.push(number);
                }
            }
        }
        let near = self.nodes_in_reach(ground);
        let mut waiting: Vec<usize> =
            (0..count).filter(|number| self.stances[*number].is_some() && of_stance[*number] == UNREACHED).collect();
        let (mut hops, mut pairs_tested) = (0_i16, 0_u64);
        while !layer.is_empty() && !waiting.is_empty() && hops_max.is_none_or(|most| hops < most) && hops < i16::MAX {
            hops += 1;
            meter.report(Detail::None)?;
            let mut in_layer = vec![false; self.lattice.count()];
            for number in &layer {
                in_layer[number / self.headings as usize] = true;
            }
            let is_last = |number: usize| of_stance[number] == hops - 1;
            let joined = |buffers: &mut StanceBuffers, number: usize| -> Result<(Option<usize>, u64), Cancelled> {
                let mut counter = meter.counter();
                let Some(to) = &self.stances[number] else { return Ok((None, 0)) };
                let mut tested = 0;
                for node in near.about(self.lattice, number / self.headings as usize).filter(|node| in_layer[*node]) {
                    for other in self.of_node(node).filter(|other| is_last(*other)) {
                        let Some(takeoff) = &self.stances[other] else { continue };
                        counter.pair()?;
                        tested += 1;
                        if ground.windows(takeoff, to, buffers).is_some_and(|(_, windows)| !windows.is_empty()) {
                            return Ok((Some(other), tested));
                        }
                    }
                }
                Ok((None, tested))
            };
            let found: Vec<(Option<usize>, u64)> = waiting
                .par_iter()
                .map_init(StanceBuffers::default, |buffers, number| joined(buffers, *number))
                .collect::<Result<_, _>>()?;
            meter.check()?;
            layer.clear();
            for (number, (by, tested)) in waiting.iter().zip(&found) {
                pairs_tested += tested;
                if let Some(by) = by {
                    of_stance[*number] = hops;
                    from[*number] = u32::try_from(*by).unwrap_or(NONE);
                    layer.push(*number);
                }
            }
            waiting.retain(|number| of_stance[*number] == UNREACHED);
        }
        let beyond = if layer.is_empty() { UNREACHED } else { NOT_SEARCHED };
        let of_node = |node: usize| {
            if self.found[node].is_none() {
                return NO_GROUND;
            }
            let stances = self.of_node(node);
            let stands = stances.clone().any(|number| self.stances[number].is_some());
            let fewest = stances.map(|number| of_stance[number]).filter(|hops| *hops >= 0).min();
            fewest.unwrap_or(if stands { beyond } else { UNREACHED })
        };
        let hops = (0..self.lattice.count()).map(of_node).collect();
        Ok(StanceHops { hops, pairs_tested, of_stance, from, headings: self.headings as usize })
    }

    /// The nodes around one that a hop may join to it by the greatest speeds.
    fn nodes_in_reach(&self, ground: &StanceGround) -> InReach {
        let roots = || self.stances.iter().flatten().map(|stance| stance.pose().root_m.z);
        let drop_m = roots().fold(f64::NEG_INFINITY, f64::max) - roots().fold(f64::INFINITY, f64::min);
        let envelope = ground.mesh().envelope();
        let (speed_m_s, g) = (envelope.hopper().limits().takeoff_speed_max_m_s, envelope.gravity_m_s2());
        // The farthest that a projectile gets while it falls by so much; the roots are at most a leg beside their nodes.
        let run_m = speed_m_s / g * (speed_m_s * speed_m_s + 2.0 * g * drop_m.max(0.0)).sqrt() + 2.0 * ground.heights_m()[1].abs();
        InReach { run_m, spacing_m: self.spacing_m(ground) }
    }

    fn spacing_m(&self, ground: &StanceGround) -> [f64; 2] {
        let map = ground.map().map(|map| self.lattice.map(map.terrain().dem().georeference()));
        map.map_or([f64::MIN_POSITIVE; 2], |map| [map.dy_m(), map.dx_m()])
    }
}

/// Nodes within a distance.
#[derive(Clone, Copy, Debug)]
struct InReach {
    run_m: f64,
    /// Of rows and columns.
    spacing_m: [f64; 2],
}

impl InReach {
    /// The nodes within the distance of one, the nearest rows first.
    fn about(self, lattice: NodeLattice, node: usize) -> impl Iterator<Item = usize> {
        let Post { row, col } = lattice.node(node);
        let steps = |spacing_m: f64, last: usize| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the lattice")]
            let steps = (self.run_m / spacing_m).floor().min(u32::MAX.into()) as usize;
            steps.min(last)
        };
        let (rows, cols) = (steps(self.spacing_m[0], lattice.rows), steps(self.spacing_m[1], lattice.cols));
        let by_distance = |at: usize, steps: usize, count: usize| {
            let apart = (0..=steps).flat_map(move |step| [at.checked_sub(step), (step > 0).then_some(at + step)]);
            apart.flatten().filter(move |place| *place < count)
        };
        let inside = move |other: Post| {
            #[expect(clippy::cast_precision_loss, reason = "rows and columns stay far below 2^53")]
            let [down, across] =
                [other.row.abs_diff(row) as f64 * self.spacing_m[0], other.col.abs_diff(col) as f64 * self.spacing_m[1]];
            down * down + across * across <= self.run_m * self.run_m
        };
        by_distance(row, rows, lattice.rows)
            .flat_map(move |row| by_distance(col, cols, lattice.cols).map(move |col| Post { row, col }))
            .filter(move |other| inside(*other))
            .map(move |other| lattice.index(other))
    }
}

impl StanceHops {
    /// The stances of a path of fewest hops to a node, by their numbers, from a start on; `None` where none was found.
    pub fn path(&self, node: usize) -> Option<Vec<usize>> {
        let stances = node * self.headings..(node + 1) * self.headings;
        let mut number = stances.filter(|number| self.of_stance[*number] >= 0).min_by_key(|number| self.of_stance[*number])?;
        let mut path = vec![number];
        while self.from[number] != NONE {
            number = self.from[number] as usize;
            path.push(number);
        }
        path.reverse();
        Some(path)
    }
}

/// A direction among so many evenly all around, of length 1, clockwise from north.
pub fn direction(turn: u32, of: u32) -> Vector2<f64> {
    let (sine, cosine) = libm::sincos(TAU * f64::from(turn) / f64::from(of));
    Vector2::new(sine, cosine)
}

/// What a robot finds at a node, and its stances there, heading by heading.
fn at_node(ground: &StanceGround, (dem, lattice): (&Dem, NodeLattice), node: Post, headings: u32, keeps: bool) -> AtNode {
    let mut stances = vec![None; if keeps { headings as usize } else { 0 }];
    let Some(position) = lattice.position(dem, node) else { return (None, stances) };
    let mut found = NodeStance::default();
    let at = Point3::new(position.at.x, position.at.y, position.z_m);
    let Ok(contact) = ground.mesh().contact(at) else { return (Some(found), stances) };
    let up = ground.up_over(contact.facets().iter().map(|facet| facet.normal).sum());
    let mut usable = [false; DIRECTIONS as usize];
    let mut standing = 0_u32;
    for turn in 0..headings {
        let facing = direction(turn, headings);
        let pose = |height_m: f64| Pose::facing(contact.point_m() + up * height_m, up, facing);
        let (stance, legs, limbs) = best(ground, pose, |height_m| ground.stand_over(&contact, up, facing, height_m));
        found.legs = found.legs.max(legs);
        found.limbs |= limbs;
        let Some(stance) = stance else { continue };
        standing += 1;
        for (number, usable) in (0..).zip(&mut usable) {
            let beam_deg = stance.cone().map_or(0.0, |cone| beam_deg(cone, direction(number, DIRECTIONS)));
            *usable |= beam_deg > 0.0;
            found.beam_deg = Some(found.beam_deg.unwrap_or(0.0).max(beam_deg));
        }
        if keeps {
            stances[turn as usize] = Some(stance);
        }
    }
    found.headings = f64::from(standing) / f64::from(headings);
    found.directions = usable.iter().map(|usable| f64::from(u8::from(*usable))).sum::<f64>() / f64::from(DIRECTIONS);
    (Some(found), stances)
}

/// The stance with most feet of all heights, the first of equal ones, the most feet that found ground, and which limbs did.
fn best(
    ground: &StanceGround,
    pose: impl Fn(f64) -> Pose,
    stand: impl Fn(f64) -> Result<Stance, NoStance>,
) -> (Option<Stance>, usize, u64) {
    let limbs = ground.robot().limbs().len();
    let (mut best, mut most, mut by): (Option<Stance>, usize, u64) = (None, 0, 0);
    for height_m in ground.standing_heights_m() {
        match stand(height_m) {
            Ok(stance) => {
                let feet = stance.footholds().len();
                most = most.max(feet);
                by |= standing(stance.outcomes().iter().copied());
                if best.as_ref().is_none_or(|known| feet > known.footholds().len()) {
                    best = Some(stance);
                }
                if feet == limbs {
                    break;
                }
            }
            Err(NoStance::TooFewContacts { found, limbs, .. }) => {
                most = most.max(found);
                by |= standing(limbs.iter().map(|(_, outcome)| *outcome));
            }
            // Its feet stand, and slip.
            Err(NoStance::Slips | NoStance::NoDirection) => {
                let (feet, outcomes) = ground.footholds(&pose(height_m));
                most = most.max(feet.len());
                by |= standing(outcomes.into_iter());
            }
            Err(NoStance::InsideRock | NoStance::Trunk(_) | NoStance::NoContact(_)) => {}
        }
    }
    (best, most, by)
}

/// A bit for each limb that stands, of the first 64.
fn standing(outcomes: impl Iterator<Item = LimbOutcome>) -> u64 {
    outcomes.take(64).enumerate().fold(0, |bits, (limb, outcome)| bits | u64::from(outcome == LimbOutcome::Stands) << limb)
}

/// The width of the interval of take-off angles of a cone along a heading, degrees; 0 without one.
pub fn beam_deg(cone: &ConeSum, heading: Vector2<f64>) -> f64 {
    let slopes: SlopeInterval = cone.takeoff_slopes(heading);
    slopes.angles().map_or(0.0, |angles| angles.max.degrees() - angles.min.degrees())
}

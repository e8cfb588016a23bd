//! Where a rover drives from some nodes, or from where it drives to them, and at what least cost.

use super::{
    DriveAmount, DriveEdges, DriveError,
    search::{Labels, NO_MARK, NodeArcs, TurnArcs},
};
use crate::progress::{Meter, Progress, Stage};

/// Which way a drive map is read. Up, down and across differ, so that the two are not the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DriveSense {
    /// From the given nodes to every node.
    From,
    /// From every node to the nearest of the given ones.
    To,
}

impl DriveSense {
    const fn sign(self) -> isize {
        match self {
            Self::From => 1,
            Self::To => -1,
        }
    }
}

/// The least cost of driving between some nodes and every other one, over the legs of a [`DriveEdges`], with the ways.
///
/// The first heading is free, and so is the last. Where turns have a price, the leg before is a part of the state of the search. Of equal ways
/// the one over nodes of lower numbers counts, looked at from its far end. Results do not depend on the number of threads.
///
/// # Memory
/// [`DriveMap::bytes`]: while it is made, 33 bytes a node where turns take nothing, and 17 for every direction of every node and 32 a node
/// otherwise; 9, or 9 and one for every direction, once it is made.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveMap {
    sense: DriveSense,
    amount: DriveAmount,
    /// Of every node; infinite where there is no way.
    costs: Vec<f64>,
    /// Of every state, how it was reached.
    marks: Vec<u8>,
    /// The heading of the best state of every node, where headings are a part of the state.
    headings: Vec<u8>,
    steps: Vec<isize>,
}

impl DriveMap {
    /// The map from or to some nodes.
    ///
    /// # Errors
    /// [`DriveError`].
    ///
    /// # Examples
    /// ```
    /// use chta::{drive::{DriveAmount, DriveEdges, DriveGround, DriveMap, DriveSense}, ground::{DemGround, NodeLattice}, quantity::{Angle, MapPoint}, terrain::{Dem, GeoReference, OverlaidDem, Overlays}, world::{Gravity, Hopper, RestSlope, Rover, RoverLimits, SurfaceProperties}};
    /// // A step of 1 m between the second and the third column, with a ramp in the last row.
    /// let posts = vec![0.0, 0.0, 1.0, 1.0,  0.0, 0.0, 1.0, 1.0,  0.0, 0.2, 0.4, 0.6];
    /// let dem = Dem::new(3, 4, posts, GeoReference::local(MapPoint::new(0.0, 2.0), 1.0, 1.0)?)?;
    /// let surface = SurfaceProperties { grip: None, rest: RestSlope::Unlimited };
    /// let ground = DemGround::new(OverlaidDem::new(dem, Overlays::default()), &Hopper::with_speeds(1.0, 1.0)?, Gravity::new(1.62)?, &surface);
    /// let rover = Rover::new(RoverLimits { cross_slope_max: Some(Angle::from_degrees(90.0)), ..RoverLimits::new(0.5, Angle::from_degrees(31.0)) }, None)?;
    /// let drive = DriveGround::new(&ground, &rover);
    /// let edges = DriveEdges::new(&drive, NodeLattice::new(ground.terrain().dem(), 1), DriveAmount::Time, &())?;
    /// let map = DriveMap::new(&edges, &[0], DriveSense::From, &())?;
    /// // The plateau is reached over the ramp alone.
    /// assert!(map.way(3).unwrap().contains(&10) && map.cost(3).unwrap() > 2.0 * (3.0 + 2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(edges: &DriveEdges<'_>, ends: &[usize], sense: DriveSense, progress: &dyn Progress) -> Result<Self, DriveError> {
        let nodes = edges.lattice().count();
        let turns = turns(edges);
        let states_per_node = if turns.is_empty() { 1 } else { edges.offsets().len() };
        let states = nodes.saturating_mul(states_per_node);
        if u32::try_from(states).is_err() {
            let bytes = Self::bytes(nodes, states_per_node);
            return Err(DriveError::TooLarge { nodes, states_per_node, bytes });
        }
        let meter = Meter::with_total(progress, Stage::DriveMap, nodes as u64);
        let against;
        let masks = match sense {
            DriveSense::From => edges.masks(),
            DriveSense::To => {
                against = edges.masks_into();
                &against
            }
        };
        let width = bucket_width(edges);
        let mut labels =
            if turns.is_empty() { Labels::of_nodes(masks, width) } else { Labels::of_headings(masks, states_per_node, width) };
        for end in ends {
            labels.start(*end, 0.0);
        }
        if turns.is_empty() {
            labels.run(&NodeArcs::new(edges, sense.sign(), |_| 0.0), None, &meter)?;
        } else {
            labels.run(&TurnArcs::new(edges, sense.sign(), &turns), None, &meter)?;
        }
        let (costs, marks, headings) = labels.into_parts();
        Ok(Self { sense, amount: edges.amount(), costs, marks, headings, steps: edges.steps().to_vec() })
    }

    /// The bytes that a map of so many nodes takes while it is made, at most: `headings` is the number of directions where turns have a price, and
    /// 1 otherwise.
    pub const fn bytes(nodes: usize, headings: usize) -> u64 {
        // A label and a mark of every state, or those and the costs that the map keeps; the legs into nodes and the queue; the best heading.
        let of_node = 17 * headings as u64 + 16 + if headings > 1 { 16 } else { 0 };
        (nodes as u64).saturating_mul(of_node)
    }

    /// Which way it is read.
    pub const fn sense(&self) -> DriveSense {
        self.sense
    }

    /// What its costs are.
    pub const fn amount(&self) -> DriveAmount {
        self.amount
    }

    /// The least cost of a node; `None` where no way is found over these nodes and legs.
    pub fn cost(&self, node: usize) -> Option<f64> {
        self.costs.get(node).copied().filter(|cost| cost.is_finite())
    }

    /// The least costs of all nodes, infinite where no leg leads.
    pub fn costs(&self) -> &[f64] {
        &self.costs
    }

    /// How many nodes have a way, the given ones included.
    pub fn reached(&self) -> usize {
        self.costs.iter().filter(|cost| cost.is_finite()).count()
    }

    /// The nodes of the way of a node, in the order in which they are driven; `None` where no leg leads.
    pub fn way(&self, node: usize) -> Option<Vec<usize>> {
        self.cost(node)?;
        let sign = self.sense.sign();
        let mut way = vec![node];
        if self.headings.is_empty() {
            let mut at = node;
            while let Some(step) = self.steps.get(usize::from(self.marks[at])) {
                at = at.wrapping_add_signed(-sign * step);
                way.push(at);
            }
        } else {
            let count = self.steps.len();
            let (mut at, mut heading) = (node, usize::from(self.headings[node]));
            while self.marks[at * count + heading] != NO_MARK {
                let next = usize::from(self.marks[at * count + heading]);
                at = at.wrapping_add_signed(-sign * self.steps[heading]);
                heading = next;
                way.push(at);
            }
        }
        if self.sense == DriveSense::From {
            way.reverse();
        }
        Some(way)
    }
}

/// A way from one node to another.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveWay {
    /// Its nodes, both ends included.
    pub nodes: Vec<usize>,
    /// What it takes.
    pub cost: f64,
}

/// The way of least cost from one node to another, by A* search: the bound on what is left is the straight distance on the map at the least cost
/// of a metre ([`DriveMap`] gives the same cost). `None` where no way exists over these nodes and legs. Where turns have a price, the map is
/// searched instead.
///
/// # Errors
/// [`DriveError`].
pub fn drive_path(edges: &DriveEdges<'_>, from: usize, to: usize, progress: &dyn Progress) -> Result<Option<DriveWay>, DriveError> {
    if !turns(edges).is_empty() {
        let map = DriveMap::new(edges, &[from], DriveSense::From, progress)?;
        return Ok(map.way(to).zip(map.cost(to)).map(|(nodes, cost)| DriveWay { nodes, cost }));
    }
    let nodes = edges.lattice().count();
    if u32::try_from(nodes).is_err() {
        return Err(DriveError::TooLarge { nodes, states_per_node: 1, bytes: DriveMap::bytes(nodes, 1) });
    }
    let meter = Meter::with_total(progress, Stage::DriveMap, nodes as u64);
    let lattice = *edges.lattice();
    let map = lattice.map(edges.drive().ground().terrain().dem().georeference());
    let goal = map.post(lattice.node(to).row, lattice.node(to).col);
    let per_m = edges.amount().least_per_m(edges.drive().rover());
    let bound = |node: usize| {
        let post = lattice.node(node);
        per_m * (map.post(post.row, post.col) - goal).norm()
    };
    let mut labels = Labels::of_nodes(edges.masks(), bucket_width(edges));
    labels.start(from, bound(from));
    labels.run(&NodeArcs::new(edges, 1, bound), Some(to), &meter)?;
    let (costs, marks, headings) = labels.into_parts();
    let found = DriveMap { sense: DriveSense::From, amount: edges.amount(), costs, marks, headings, steps: edges.steps().to_vec() };
    Ok(found.way(to).zip(found.cost(to)).map(|(nodes, cost)| DriveWay { nodes, cost }))
}

/// What turning from every direction to every other one takes, row after row; empty where that is nothing.
fn turns(edges: &DriveEdges<'_>) -> Vec<f64> {
    let drive = edges.drive();
    let per_deg = edges.amount().per_turned_deg(drive.rover());
    if per_deg <= 0.0 {
        return Vec::new();
    }
    let map = drive.ground().terrain().dem().georeference();
    let away = |(east, north): (i32, i32)| (f64::from(east) * map.dx_m(), f64::from(north) * map.dy_m());
    let pairs = edges.offsets().iter().flat_map(|a| edges.offsets().iter().map(move |b| (away(*a), away(*b))));
    // The angle between two directions.
    let angle_deg =
        |((ax, ay), (bx, by)): ((f64, f64), (f64, f64))| libm::atan2((ax * by - ay * bx).abs(), ax * bx + ay * by).to_degrees();
    pairs.map(|pair| per_deg * angle_deg(pair)).collect()
}

/// The width of the queue's buckets: the least cost of a leg, so that labels are set once. Where legs may cost nothing, a share of what level
/// ground takes.
fn bucket_width(edges: &DriveEdges<'_>) -> f64 {
    let least = (0..edges.offsets().len()).map(|direction| edges.least(direction)).fold(f64::INFINITY, f64::min);
    if least > 0.0 {
        return least;
    }
    let drive = edges.drive();
    let step_m = drive.ground().terrain().dem().georeference().step_m();
    let level = edges.amount().of_piece(drive.rover(), drive.gravity_m_s2(), step_m, 0.0);
    // Without rolling resistance, what a slope of 1 in 10 takes.
    if level > 0.0 { level } else { edges.amount().of_piece(drive.rover(), drive.gravity_m_s2(), step_m, 0.1) }
}

//! The steps from a node of a lattice to those about it, the nearest first.

use super::SurfaceLattice;

/// Columns aside and rows down, neither negative: it stands for the steps with either sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Step {
    aside: u32,
    down: u32,
    /// How many numbers [`NearestSteps::numbers`] has for it and all shorter ones.
    numbers: u32,
}

/// All steps of a lattice up to a distance, in ascending order of their lengths.
#[derive(Clone, Debug)]
pub(super) struct NearestSteps {
    steps: Vec<Step>,
    /// What each step, with each of its signs, adds to the number of a node.
    numbers: Vec<i32>,
    lattice: SurfaceLattice,
    /// The most columns and rows of a step.
    most: (usize, usize),
}

impl NearestSteps {
    /// The steps up to a distance, m.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "at most as many nodes as 28 bits number, and four numbers for each of them"
    )]
    pub(super) fn within(lattice: &SurfaceLattice, distance_m: f64) -> Self {
        let (aside, down) = most_steps(lattice, distance_m);
        let all = (0..=down as u32).flat_map(|down| (0..=aside as u32).map(move |aside| Step { aside, down, numbers: 0 }));
        let within = |step: &Step| squared_m2(lattice, *step) <= distance_m * distance_m;
        let mut steps: Vec<Step> = all.skip(1).filter(within).collect();
        steps.sort_unstable_by(|a, b| squared_m2(lattice, *a).total_cmp(&squared_m2(lattice, *b)).then(a.cmp(b)));
        let mut numbers = Vec::new();
        let cols = lattice.size().1 as i32;
        for step in &mut steps {
            let (aside, down) = (step.aside as i32, step.down as i32 * cols);
            numbers.extend([down + aside, -down - aside]);
            if aside > 0 && down > 0 {
                numbers.extend([down - aside, aside - down]);
            }
            step.numbers = numbers.len() as u32;
        }
        Self { steps, numbers, lattice: lattice.clone(), most: (aside, down) }
    }

    /// The bytes that they take at most, in vectors that double their sizes.
    pub(super) fn bytes(lattice: &SurfaceLattice, distance_m: f64) -> u64 {
        let (aside, down) = most_steps(lattice, distance_m);
        2 * ((aside + 1) * (down + 1) * (size_of::<Step>() + 4 * size_of::<i32>())) as u64
    }

    /// The numbers of the nodes at most so far from a node, m, the nearest first, without itself.
    pub(super) fn about(&self, (i, j): (usize, usize), distance_m: f64) -> impl Iterator<Item = usize> + '_ {
        let (rows, cols) = self.lattice.size();
        let count = self.steps.partition_point(|step| squared_m2(&self.lattice, *step) <= distance_m * distance_m);
        let is_inside = i >= self.most.0 && j >= self.most.1 && i + self.most.0 < cols && j + self.most.1 < rows;
        let (by_number, one_by_one) = if is_inside { (count, 0) } else { (0, count) };
        let numbers = by_number.checked_sub(1).map_or(0, |last| self.steps[last].numbers as usize);
        let here = self.lattice.index(i, j);
        let inside = self.numbers[..numbers].iter().map(move |number| here.wrapping_add_signed(*number as isize));
        let beside = self.steps[..one_by_one].iter().flat_map(move |step| {
            let (aside, down) = (step.aside as usize, step.down as usize);
            let east = Some(i + aside).filter(|i| *i < cols);
            let west = i.checked_sub(aside).filter(|_| aside > 0);
            let south = Some(j + down).filter(|j| *j < rows);
            let north = j.checked_sub(down).filter(|_| down > 0);
            [(east, south), (west, south), (east, north), (west, north)].into_iter().filter_map(|(i, j)| i.zip(j))
        });
        inside.chain(beside.map(|(i, j)| self.lattice.index(i, j)))
    }
}

/// The most columns and rows of steps up to a distance, m.
fn most_steps(lattice: &SurfaceLattice, distance_m: f64) -> (usize, usize) {
    let ((rows, cols), (down, aside)) = (lattice.size(), lattice.cells_within(distance_m));
    (aside.min(cols - 1), down.min(rows - 1))
}

/// The length of a step, squared, m^2.
fn squared_m2(lattice: &SurfaceLattice, step: Step) -> f64 {
    let (aside_m, down_m) = lattice.spacings_m();
    let (x, y) = (f64::from(step.aside) * aside_m, f64::from(step.down) * down_m);
    x * x + y * y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        draw::Draw,
        planner::NodesPerPost,
        quantity::MapPoint,
        terrain::{Dem, GeoReference},
    };

    #[test]
    fn every_node_within_the_distance_comes_once_and_the_nearest_first() {
        let draw = &mut Draw::seeded(2101);
        let mut found = 0;
        for _ in 0..100 {
            let (rows, cols) = (2 + draw.below(9), 2 + draw.below(12));
            let map = GeoReference::local(MapPoint::new(0.0, 50.0), draw.uniform(0.3, 2.0), draw.uniform(0.3, 2.0)).unwrap();
            let dem = Dem::new(rows, cols, vec![0.0; rows * cols], map).unwrap();
            let lattice = SurfaceLattice::new(&dem, NodesPerPost::at_most_m(1.0 / (1.0 + draw.uniform(0.0, 2.9)), 1.0));
            let longest_m = draw.log_uniform(0.2, 20.0);
            let steps = NearestSteps::within(&lattice, longest_m);
            let taken = (steps.steps.len() * size_of::<Step>() + steps.numbers.len() * size_of::<i32>()) as u64;
            assert!(taken <= NearestSteps::bytes(&lattice, longest_m));
            let distance_m = draw.uniform(0.0, 9.0);
            let most_m = steps.steps.last().map_or(0.0, |step| squared_m2(&lattice, *step).sqrt()).min(distance_m);
            for index in 0..lattice.count() {
                let node = lattice.node(index);
                let away_m = |other: &(usize, usize)| (lattice.at(*other) - lattice.at(node)).norm();
                let near: Vec<_> = steps.about(node, distance_m).map(|other| lattice.node(other)).collect();
                assert!(near.windows(2).all(|pair| away_m(&pair[0]) <= away_m(&pair[1]) + 1e-9), "{near:?}");
                let expected = (0..lattice.count()).map(|other| lattice.node(other));
                let mut expected: Vec<_> = expected.filter(|other| *other != node && away_m(other) <= most_m + 1e-9).collect();
                let mut sorted = near.clone();
                sorted.sort_unstable();
                expected.sort_unstable();
                assert_eq!(sorted, expected, "{node:?} within {most_m} m");
                found += near.len();
            }
        }
        assert!(found > 10_000, "{found}");
    }
}

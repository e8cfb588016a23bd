//! Inverse kinematics by damped least squares.

use nalgebra::{Matrix3, Point3, Vector3};

use super::LimbChain;

/// Lengths below are shares of the limb's length. The damping at the beginning: a bent leg's Jacobian is of the size of its length, so that steps are hardly
/// shortened there, and stay small near a stretched leg, where the inverse without damping has no bound.
const DAMPING: f64 = 1.0e-2;
/// Damping falls by halves down to this where steps succeed, which makes the last ones fast; below it nothing is gained.
const DAMPING_LEAST: f64 = 1.0e-4;
/// A descent whose damping exceeds this is stuck: no step brings the foot nearer.
const DAMPING_MOST: f64 = 1.0e3;
/// A descent that is nearer than this is done.
const CLOSE: f64 = 1.0e-9;
/// The foot reaches a point if it comes as near as this: a millimetre of a leg of a metre, below what ground is known to.
const REACHED: f64 = 1.0e-3;
/// Steps of one descent.
const STEPS: usize = 50;
/// Descents from different joints at most: one may end where joints are at their limits. More take more time for points that are out of reach.
const SEEDS: usize = 16;
/// The bases of the low-discrepancy sequence that spreads them; a limb with more joints repeats them.
const BASES: [usize; 6] = [2, 3, 5, 7, 11, 13];

/// Whether joints exist that put the foot at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct IkVerdict {
    /// Whether the foot comes to a thousandth of the limb's length of the point, within the limits of the joints.
    ///
    /// `true` is certain: the joints are below. `false` is what no descent found.
    pub reached: bool,
    /// How far from the point these joints leave the foot, m. Where the point is out of reach, other joints may bring it nearer.
    pub error_m: f64,
    /// The joints that bring it nearest of those found, rad or m.
    pub positions: Vec<f64>,
    /// The greatest share of a joint's travel, 1 at a limit; see [`ChainJoint::travel_share`](super::ChainJoint::travel_share).
    pub travel_share: f64,
}

impl LimbChain {
    /// Joints that bring the foot to a point of the trunk frame, or near: damped least squares
    ///
    /// ```text
    ///     dq = J^T (J J^T + damping^2)^-1 (target - foot)
    /// ```
    ///
    /// with joints at a limit held where the step would lead beyond it, from several joints spread over their ranges. A step that does not bring the foot
    /// nearer is taken again with more damping (Levenberg 1944, Marquardt 1963; for robots Wampler 1986).
    pub fn reach(&self, target: &Point3<f64>) -> IkVerdict {
        let mut best = (f64::INFINITY, Vec::new());
        for seed in 0..SEEDS {
            let found = self.descend(self.seed(seed), target);
            if found.0 < best.0 {
                best = found;
            }
            if best.0 <= REACHED * self.length_m() {
                break;
            }
        }
        let (error_m, positions) = best;
        let travel_share = self.joints().iter().zip(&positions).map(|(joint, at)| joint.travel_share(*at)).fold(0.0, f64::max);
        IkVerdict { reached: error_m <= REACHED * self.length_m(), error_m, positions, travel_share }
    }

    /// Joints to begin with: the first in the middle of their ranges.
    fn seed(&self, number: usize) -> Vec<f64> {
        let of_joint = |(index, joint): (usize, &super::ChainJoint)| {
            let turn = if joint.slides {
                joint.range
            } else {
                [joint.range[0].max(-std::f64::consts::PI), joint.range[1].min(std::f64::consts::PI)]
            };
            // A range wholly beyond half a turn stays as it is.
            let [low, high] = if turn[0] <= turn[1] { turn } else { joint.range };
            let share = if number == 0 { 0.5 } else { radical_inverse(number, BASES[index % BASES.len()]) };
            low + share * (high - low)
        };
        self.joints().iter().enumerate().map(of_joint).collect()
    }

    /// The nearest distance to the target that a descent from these joints finds, and its joints.
    fn descend(&self, mut positions: Vec<f64>, target: &Point3<f64>) -> (f64, Vec<f64>) {
        let length = self.length_m();
        let mut damping = DAMPING;
        let (mut foot, mut columns) = self.jacobian(&positions);
        for _ in 0..STEPS {
            let error = target - foot;
            if error.norm() <= CLOSE * length || damping > DAMPING_MOST {
                break;
            }
            let next = self.stepped(&positions, &columns, &error, damping * length);
            let (next_foot, next_columns) = self.jacobian(&next);
            if (target - next_foot).norm() < error.norm() {
                (positions, foot, columns) = (next, next_foot, next_columns);
                damping = (0.5 * damping).max(DAMPING_LEAST);
            } else {
                damping *= 4.0;
            }
        }
        ((target - foot).norm(), positions)
    }

    /// The joints after one step.
    fn stepped(&self, positions: &[f64], columns: &[Vector3<f64>], error: &Vector3<f64>, damping_m: f64) -> Vec<f64> {
        let mut held = vec![false; positions.len()];
        let mut steps = vec![0.0; positions.len()];
        // Every round holds one joint more, or is the last.
        for _ in 0..=positions.len() {
            let free = columns.iter().zip(&held).filter(|(_, held)| !**held);
            let square = free.map(|(column, _)| column * column.transpose()).sum::<Matrix3<f64>>();
            let Some(inverse) = (square + Matrix3::identity() * damping_m * damping_m).try_inverse() else { break };
            let solved = inverse * error;
            let mut pushes = false;
            for (index, joint) in self.joints().iter().enumerate() {
                steps[index] = if held[index] { 0.0 } else { columns[index].dot(&solved) };
                let [low, high] = joint.range;
                if !held[index] && (positions[index] <= low && steps[index] < 0.0 || positions[index] >= high && steps[index] > 0.0)
                {
                    held[index] = true;
                    pushes = true;
                }
            }
            if !pushes {
                break;
            }
        }
        let of_joint = |(index, joint): (usize, &super::ChainJoint)| {
            let step = if held[index] { 0.0 } else { steps[index] };
            (positions[index] + step).clamp(joint.range[0], joint.range[1])
        };
        self.joints().iter().enumerate().map(of_joint).collect()
    }
}

/// The digits of a number to a base, mirrored at the point: spread over 0 to 1 (van der Corput 1935; Halton 1960).
fn radical_inverse(mut number: usize, base: usize) -> f64 {
    let (mut share, mut inverse) = (1.0, 0.0);
    while number > 0 {
        #[expect(clippy::cast_precision_loss, reason = "small numbers")]
        let (digit, whole) = ((number % base) as f64, base as f64);
        share /= whole;
        inverse += digit * share;
        number /= base;
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_are_spread() {
        assert_eq!([1, 2, 3, 4, 5].map(|number| radical_inverse(number, 2)), [0.5, 0.25, 0.75, 0.125, 0.625]);
        assert_eq!([0, 1, 3].map(|number| radical_inverse(number, 3)), [0.0, 1.0 / 3.0, 1.0 / 9.0]);
    }
}

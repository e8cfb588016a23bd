//! The forces and moments that the contacts of a stance produce, and the nearest of them to one that is asked for.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use super::Foothold;

/// How much a unit force may do towards what is missing and be left out, as a share of the wrench that is asked for. Rounding alone leaves up to
/// 1e-12, half of the time less than this.
const GAIN_TOLERANCE: f64 = 1e-15;

/// Rounds without a smaller gain after which rounding is all that is left.
const IDLE_ROUNDS_MAX: usize = 12;

/// Forces to try at most. In the tests half of the searches took 29, the longest 96.
const ROUNDS_MAX: usize = 400;

/// The wrenches of a stance: a cone in six dimensions, force times `weight` and moment over the longest arm.
pub(super) struct WrenchCone<'a> {
    footholds: &'a [Foothold],
    /// The longest arm, m; 1 where all are 0.
    pub(super) arm_m: f64,
    weight: f64,
}

/// The wrench of a cone that is nearest to one that was asked for.
#[derive(Debug)]
pub(super) struct Nearest {
    /// What is missing to the wrench asked for. It makes an angle of at least 90 degrees with every wrench of the cone.
    pub(super) missing: Vector6<f64>,
    /// The nearest wrench.
    pub(super) wrench: Vector6<f64>,
    /// By how much a wrench of a unit force exceeds those 90 degrees: its greatest product with what is missing, 0 but for rounding.
    pub(super) gain: f64,
    /// The force of each contact, in their order, that add up to the nearest wrench but for rounding.
    pub(super) forces: Vec<Vector3<f64>>,
}

/// A unit force of one contact, as a wrench, and how much of it is used.
struct Column {
    foot: usize,
    force: Vector3<f64>,
    wrench: Vector6<f64>,
    amount: f64,
}

impl<'a> WrenchCone<'a> {
    pub(super) fn new(footholds: &'a [Foothold], weight: f64) -> Self {
        let longest = footholds.iter().map(|foot| foot.arm_m.norm()).fold(0.0, f64::max);
        Self { footholds, arm_m: if longest > 0.0 { longest } else { 1.0 }, weight }
    }

    /// The wrench of a force at a contact.
    fn wrench(&self, foot: &Foothold, force: Vector3<f64>) -> Vector6<f64> {
        let (force_part, moment) = (force * self.weight, foot.arm_m.cross(&force) / self.arm_m);
        Vector6::new(force_part.x, force_part.y, force_part.z, moment.x, moment.y, moment.z)
    }

    /// The force at a contact whose wrench has the greatest product with a wrench, for each unit of force, and that product.
    fn best(&self, missing: &Vector6<f64>) -> Option<(f64, Column)> {
        let (force, moment) = (missing.fixed_rows::<3>(0).into_owned(), missing.fixed_rows::<3>(3).into_owned());
        let tried = self.footholds.iter().enumerate().filter_map(|(number, foot)| {
            let along = force * self.weight + moment.cross(&foot.arm_m) / self.arm_m;
            let force = (along.norm_squared() > 0.0).then(|| foot.cone.best(along))?;
            let wrench = self.wrench(foot, force);
            Some((wrench.dot(missing), Column { foot: number, force, wrench, amount: 0.0 }))
        });
        tried.max_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// The wrench of the cone that is nearest to a wrench.
    ///
    /// Non-negative least squares over the forces of round cones: the force that does most towards what is missing joins a set of at most
    /// six, whose best amounts are solved for exactly; a force whose amount would be negative leaves it.
    ///
    /// Source: Lawson and Hanson 1974, *Solving least squares problems*, chapter 23, with the columns found as they are needed.
    pub(super) fn nearest(&self, asked: Vector6<f64>) -> Nearest {
        let mut columns: Vec<Column> = Vec::new();
        let mut missing = asked;
        let mut nearest = Nearest { missing, wrench: Vector6::zeros(), gain: f64::INFINITY, forces: Vec::new() };
        let mut idle = 0;
        for _ in 0..ROUNDS_MAX {
            let found = self.best(&missing);
            let gain = found.as_ref().map_or(0.0, |(gain, _)| *gain);
            if gain < nearest.gain {
                (nearest.missing, nearest.wrench, nearest.gain) = (missing, asked - missing, gain.max(0.0));
                idle = 0;
            } else {
                idle += 1;
            }
            let Some((_, column)) = found.filter(|_| gain > GAIN_TOLERANCE * asked.norm() && idle <= IDLE_ROUNDS_MAX) else {
                break;
            };
            columns.push(column);
            if !settle(&mut columns, &asked) {
                break;
            }
            missing = columns.iter().fold(asked, |rest, column| rest - column.wrench * column.amount);
        }
        nearest.forces = vec![Vector3::zeros(); self.footholds.len()];
        for column in &columns {
            nearest.forces[column.foot] += column.force * column.amount;
        }
        nearest
    }
}

/// The best amounts of the forces of a set, none negative; forces that are not used leave it. False if they are too much alike.
fn settle(columns: &mut Vec<Column>, asked: &Vector6<f64>) -> bool {
    while !columns.is_empty() {
        let Some(best) = amounts(columns, asked) else {
            columns.pop();
            return false;
        };
        // The first amount to reach 0 on the way from the present ones to the best.
        let mut share = 1.0f64;
        for (column, best) in columns.iter().zip(best.iter()) {
            if *best <= 0.0 {
                share = share.min(column.amount / (column.amount - best));
            }
        }
        let whole = best.iter().all(|amount| *amount > 0.0);
        for (column, best) in columns.iter_mut().zip(best.iter()) {
            let next = column.amount + share * (best - column.amount);
            // The one that limits the step is left out even where rounding leaves a little of it.
            let leaves = *best <= 0.0 && column.amount <= share * (column.amount - best) * (1.0 + 1e-12);
            column.amount = if leaves { 0.0 } else { next };
        }
        if whole {
            return true;
        }
        columns.retain(|column| column.amount > 0.0);
    }
    true
}

/// The amounts that bring a sum of wrenches nearest to one that is asked for; `None` if the wrenches are not independent.
fn amounts(columns: &[Column], asked: &Vector6<f64>) -> Option<DVector<f64>> {
    if columns.len() > 6 {
        return None;
    }
    let matrix = DMatrix::from_fn(6, columns.len(), |row, column| columns[column].wrench[row]);
    let qr = matrix.qr();
    let mut right = DVector::from_column_slice(asked.as_slice());
    qr.q_tr_mul(&mut right);
    let solved = qr.r().solve_upper_triangular(&right.rows(0, columns.len()).into_owned())?;
    solved.iter().all(|amount| amount.is_finite()).then_some(solved)
}

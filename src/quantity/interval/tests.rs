//! Checks every operation against exact rational arithmetic, and checks that wrong rounding is detected.

use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed};

use super::*;
use crate::draw::Draw;

/// A planted fault: rounds inwards.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Inwards;

impl Rounding for Inwards {
    fn down(rounded: f64) -> f64 {
        rounded.next_up()
    }

    fn up(rounded: f64) -> f64 {
        rounded.next_down()
    }
}

/// A planted fault: does not round at all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Unrounded;

impl Rounding for Unrounded {
    fn down(rounded: f64) -> f64 {
        rounded
    }

    fn up(rounded: f64) -> f64 {
        rounded
    }
}

fn exact(number: f64) -> BigRational {
    BigRational::from_f64(number).unwrap()
}

/// Whether the interval contains this exact number.
fn holds<R: Rounding>(interval: Interval<R>, number: &BigRational) -> bool {
    (interval.lower == f64::NEG_INFINITY || exact(interval.lower) <= *number)
        && (interval.upper == f64::INFINITY || *number <= exact(interval.upper))
}

/// Numbers of either sign over forty powers of two.
fn numbers(count: usize) -> impl Iterator<Item = f64> {
    let mut draw = Draw::seeded(0);
    std::iter::repeat_with(move || {
        let bits = draw.bits();
        let exponent = 1003 + (bits >> 58) % 40;
        f64::from_bits((bits & 0x800F_FFFF_FFFF_FFFF) | (exponent << 52))
    })
    .take(count)
}

/// Counts the results of all operations that lie outside their interval.
fn misses<R: Rounding>() -> usize {
    let drawn: Vec<_> = numbers(4000).collect();
    let mut missed = 0;
    for four in drawn.chunks_exact(4) {
        let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
        let (first, second) = (Interval::<R>::new(a.min(b), a.max(b)), Interval::<R>::new(c.min(d), c.max(d)));
        let away_from_zero = c.signum() == d.signum();
        for x in [a, b] {
            for y in [c, d] {
                let (p, q) = (exact(x), exact(y));
                missed += usize::from(!holds(first + second, &(&p + &q)));
                missed += usize::from(!holds(first - second, &(&p - &q)));
                missed += usize::from(!holds(first * second, &(&p * &q)));
                missed += usize::from(!holds(first / second, &(&p / &q)));
                missed += usize::from(!holds(first.squared(), &(&p * &p)));
                assert!(away_from_zero || first / second == Interval::ALL, "a divisor that contains zero sets no bound");
            }
            // A root interval contains the root if the squares of its ends enclose the number.
            let root = Interval::<R>::point(x.abs()).sqrt();
            let square = |end: f64| exact(end) * exact(end);
            missed += usize::from(!(square(root.lower) <= exact(x).abs() && exact(x).abs() <= square(root.upper)));
        }
    }
    missed
}

#[test]
fn every_operation_encloses_the_exact_result() {
    assert_eq!(misses::<Outwards>(), 0);
}

#[test]
fn rounding_inwards_and_not_rounding_are_both_detected() {
    assert!(misses::<Inwards>() > 1000, "inward rounding must fail the test above");
    assert!(misses::<Unrounded>() > 1000, "no rounding must fail the test above");
}

#[test]
fn a_nan_end_becomes_infinite() {
    let all = Interval::<Outwards>::ALL;
    assert_eq!(all - all, all);
    assert_eq!(Interval::point(0.0) * all, all);
    assert_eq!(all / all, all);
    let ray = Interval::<Outwards>::new(1.0, f64::INFINITY);
    assert!((ray - ray).contains(0.0) && (ray + ray).lower >= 1.0);
    assert!(Interval::<Outwards>::new(-2.0, -1.0).sqrt().is_empty());
    assert_eq!(Interval::<Outwards>::new(-1.0, 4.0).sqrt().lower, 0.0);
    assert_eq!(Interval::<Outwards>::new(-3.0, 2.0).squared().lower, 0.0);
    assert!(Interval::<Outwards>::new(-3.0, 2.0).squared().contains(9.0));
}

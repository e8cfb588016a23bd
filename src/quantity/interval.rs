//! Intervals of numbers, rounded outwards: what is computed with them holds for every number inside.

use std::{
    marker::PhantomData,
    ops::{Add, Div, Mul, Neg, Sub},
};

/// Which way the ends of an interval are rounded.
///
/// IEEE arithmetic and its square root are correctly rounded, so the neighbour of a result bounds the true value.
pub trait Rounding: Copy + std::fmt::Debug + PartialEq + Default + Send + Sync + 'static {
    /// A number not above the one whose rounding this is.
    fn down(rounded: f64) -> f64;
    /// A number not below the one whose rounding this is.
    fn up(rounded: f64) -> f64;
}

/// Outwards: the lower end down, the upper end up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outwards;

impl Rounding for Outwards {
    #[inline]
    fn down(rounded: f64) -> f64 {
        rounded.next_down()
    }

    #[inline]
    fn up(rounded: f64) -> f64 {
        rounded.next_up()
    }
}

/// A closed interval of real numbers, ends possibly infinite; empty where `lower > upper`.
///
/// Every operation encloses all results of that operation on numbers of its arguments. An end that is no number (the sum of two
/// opposite infinities) becomes the infinity on its side, which bounds nothing.
///
/// ```
/// use chta::quantity::Interval;
/// let third = Interval::<chta::quantity::Outwards>::point(1.0) / Interval::point(3.0);
/// assert!(third.lower < third.upper, "no double is a third");
/// assert!((third * Interval::point(3.0)).contains(1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<R = Outwards> {
    /// The lower end.
    pub lower: f64,
    /// The upper end.
    pub upper: f64,
    rounding: PhantomData<R>,
}

impl<R: Rounding> Interval<R> {
    /// Every number.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// No number.
    pub const EMPTY: Self = Self::new(f64::INFINITY, f64::NEG_INFINITY);

    /// From its two ends, as they are.
    #[inline]
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper, rounding: PhantomData }
    }

    /// One number.
    #[inline]
    pub const fn point(number: f64) -> Self {
        Self::new(number, number)
    }

    /// Ends that are roundings of true ones, moved by the rounding; what is no number bounds nothing.
    #[inline]
    fn rounded(lower: f64, upper: f64) -> Self {
        let lower = if lower.is_nan() { f64::NEG_INFINITY } else { R::down(lower) };
        let upper = if upper.is_nan() { f64::INFINITY } else { R::up(upper) };
        Self::new(lower, upper)
    }

    /// Whether no number is inside.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.lower > self.upper
    }

    /// Whether a number is inside.
    #[inline]
    pub fn contains(self, number: f64) -> bool {
        self.lower <= number && number <= self.upper
    }

    /// The numbers in both.
    #[inline]
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        Self::new(self.lower.max(other.lower), self.upper.min(other.upper))
    }

    /// The least interval around both.
    #[inline]
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.lower.min(other.lower), self.upper.max(other.upper))
    }

    /// Half of it: exact but for the least numbers there are.
    #[inline]
    #[must_use]
    pub fn halved(self) -> Self {
        Self::rounded(0.5 * self.lower, 0.5 * self.upper)
    }

    /// The squares of its numbers.
    #[inline]
    #[must_use]
    pub fn squared(self) -> Self {
        let (a, b) = (self.lower.abs(), self.upper.abs());
        let (near, far) = if a <= b { (a, b) } else { (b, a) };
        let near = if self.lower <= 0.0 && self.upper >= 0.0 { 0.0 } else { near };
        let square = Self::rounded(near * near, far * far);
        // A square is never negative, however it is rounded.
        Self::new(if near == 0.0 { 0.0 } else { square.lower }, square.upper)
    }

    /// The square roots of its numbers that have one; empty where none has.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.upper < 0.0 {
            return Self::EMPTY;
        }
        let root = Self::rounded(self.lower.max(0.0).sqrt(), self.upper.sqrt());
        Self::new(if self.lower <= 0.0 { 0.0 } else { root.lower }, root.upper)
    }
}

/// A quotient with numbers on both sides of zero below bounds nothing; none is asked for here.
#[inline]
fn least_greatest(products: [f64; 4]) -> (f64, f64) {
    // One product that is no number (zero times infinity) makes both ends none.
    if products.iter().any(|product| product.is_nan()) {
        return (f64::NAN, f64::NAN);
    }
    let [a, b, c, d] = products;
    (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
}

impl<R: Rounding> Add for Interval<R> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self::rounded(self.lower + other.lower, self.upper + other.upper)
    }
}

impl<R: Rounding> Sub for Interval<R> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::rounded(self.lower - other.upper, self.upper - other.lower)
    }
}

impl<R: Rounding> Mul for Interval<R> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (lower, upper) = least_greatest([
            self.lower * other.lower,
            self.lower * other.upper,
            self.upper * other.lower,
            self.upper * other.upper,
        ]);
        Self::rounded(lower, upper)
    }
}

impl<R: Rounding> Div for Interval<R> {
    type Output = Self;

    /// The quotients; everything where the divisor may be zero.
    #[inline]
    fn div(self, other: Self) -> Self {
        if other.lower <= 0.0 && other.upper >= 0.0 {
            return Self::ALL;
        }
        let (lower, upper) = least_greatest([
            self.lower / other.lower,
            self.lower / other.upper,
            self.upper / other.lower,
            self.upper / other.upper,
        ]);
        Self::rounded(lower, upper)
    }
}

impl<R: Rounding> Neg for Interval<R> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.upper, -self.lower)
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) use tests::Inwards;

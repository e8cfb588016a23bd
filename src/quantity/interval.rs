//! Interval arithmetic with outward rounding: a result encloses the true value for all arguments inside the operands.

use std::{
    marker::PhantomData,
    ops::{Add, Div, Mul, Neg, Sub},
};

/// How the ends of an interval are rounded.
///
/// IEEE arithmetic and its square root are correctly rounded, so the next double below or above a result bounds the true
/// value.
pub trait Rounding: Copy + std::fmt::Debug + PartialEq + Default + Send + Sync + 'static {
    /// A bound not above the exact value that `rounded` approximates.
    fn down(rounded: f64) -> f64;
    /// A bound not below the exact value that `rounded` approximates.
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
/// Every operation encloses all results of that operation on members of its operands. An end that is NaN (the sum of two
/// opposite infinities) becomes the infinity on its side, so it bounds nothing.
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
    /// All real numbers.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// The empty interval.
    pub const EMPTY: Self = Self::new(f64::INFINITY, f64::NEG_INFINITY);

    /// An interval from its two ends, without rounding.
    #[inline]
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper, rounding: PhantomData }
    }

    /// The interval of a single number.
    #[inline]
    pub const fn point(number: f64) -> Self {
        Self::new(number, number)
    }

    /// Moves two computed ends outwards by the rounding; a NaN end becomes infinite.
    #[inline]
    fn rounded(lower: f64, upper: f64) -> Self {
        let lower = if lower.is_nan() { f64::NEG_INFINITY } else { R::down(lower) };
        let upper = if upper.is_nan() { f64::INFINITY } else { R::up(upper) };
        Self::new(lower, upper)
    }

    /// Whether the interval is empty.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.lower > self.upper
    }

    /// Whether `number` lies inside, ends included.
    #[inline]
    pub fn contains(self, number: f64) -> bool {
        self.lower <= number && number <= self.upper
    }

    /// The intersection of both.
    #[inline]
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        Self::new(self.lower.max(other.lower), self.upper.min(other.upper))
    }

    /// The smallest interval that contains both.
    #[inline]
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.lower.min(other.lower), self.upper.max(other.upper))
    }

    /// Half the interval: exact except for subnormal numbers.
    #[inline]
    #[must_use]
    pub fn halved(self) -> Self {
        Self::rounded(0.5 * self.lower, 0.5 * self.upper)
    }

    /// The squares of all numbers inside.
    #[inline]
    #[must_use]
    pub fn squared(self) -> Self {
        let (a, b) = (self.lower.abs(), self.upper.abs());
        let (near, far) = if a <= b { (a, b) } else { (b, a) };
        let near = if self.lower <= 0.0 && self.upper >= 0.0 { 0.0 } else { near };
        let square = Self::rounded(near * near, far * far);
        // A square is never negative, whatever the rounding.
        Self::new(if near == 0.0 { 0.0 } else { square.lower }, square.upper)
    }

    /// The square roots of all non-negative numbers inside; empty if all are negative.
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

/// The least and the greatest of the four products (or quotients) of two intervals' ends. The caller of a quotient excludes
/// divisors that contain zero.
#[inline]
fn least_greatest(products: [f64; 4]) -> (f64, f64) {
    // One NaN product (zero times infinity) makes both ends NaN.
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

    /// The quotients; [`Interval::ALL`] if the divisor may be zero.
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

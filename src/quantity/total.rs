//! Sums that are printed.

/// The sum of numbers, 0 of none: [`Iterator::sum`] of none is -0, which a table would show as such.
pub(crate) fn total(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |sum, number| sum + number)
}

#[cfg(test)]
mod tests {
    use super::total;

    #[test]
    fn of_no_numbers_it_is_a_positive_zero_and_else_that_of_the_iterator() {
        assert!(total(std::iter::empty()).is_sign_positive());
        let numbers = [0.1, -7.5, 1e-9, 3e8, 0.2];
        assert_eq!(total(numbers.into_iter()).to_bits(), numbers.iter().sum::<f64>().to_bits());
    }
}

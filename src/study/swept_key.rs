//! A key of the scenario that is swept over evenly spaced values.

use super::TradeError;
use crate::scenario::{Key, Kind, fits, nearest_key};

/// A swept key of the scenario, and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptKey {
    key: &'static Key,
    values: Vec<f64>,
}

impl SweptKey {
    /// The most values of one key.
    pub const MOST: usize = 1000;

    /// Reads `TABLE.KEY=FROM:TO:STEPS`: STEPS values, evenly spaced from FROM to TO, both included.
    ///
    /// # Errors
    /// [`TradeError`], in one sentence that begins with the key.
    ///
    /// # Examples
    /// ```
    /// use chta::study::SweptKey;
    /// let speeds = SweptKey::parse("hopper.takeoff_speed_max_m_s=4:10:7").unwrap();
    /// assert_eq!(speeds.values(), [4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
    /// assert!(SweptKey::parse("hopper.takeof_speed_max_m_s=4:10:7").unwrap_err().to_string().contains("hopper.takeoff_speed_max_m_s"));
    /// ```
    pub fn parse(text: &str) -> Result<Self, TradeError> {
        let (path, range) = text.split_once('=').unwrap_or((text, ""));
        let path = path.trim().to_owned();
        let (table, name) = path.split_once('.').unwrap_or(("", &path));
        let Some(key) = Key::find(table, name) else {
            return Err(TradeError::UnknownKey { nearest: nearest_key(table, name), path });
        };
        if !matches!(key.kind, Kind::Number { .. } | Kind::AngleOrUnlimited | Kind::CountOrAuto) {
            return Err(TradeError::NotANumber { path, expected: key.kind.expected() });
        }
        let malformed = || TradeError::Malformed { path: path.clone(), found: range.to_owned() };
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, steps] = parts.as_slice() else { return Err(malformed()) };
        let number = |text: &str| text.parse::<f64>().map_err(|_| malformed());
        let (from, to) = (number(from)?, number(to)?);
        if number(steps)?.is_nan() {
            return Err(malformed());
        }
        let Some(steps) = steps.parse().ok().filter(|steps| (2..=Self::MOST).contains(steps)) else {
            return Err(TradeError::Steps { path, found: (*steps).to_owned() });
        };
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(TradeError::Range { path, from, to });
        }
        let values = spread(from, to, steps);
        if let Some(&value) = values.iter().find(|&&value| !fits(&typed(key, value), key.kind)) {
            return Err(TradeError::Value { path, value, expected: key.kind.expected() });
        }
        Ok(Self { key, values })
    }

    /// The key.
    pub const fn key(&self) -> &'static Key {
        self.key
    }

    /// The values, in ascending order.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// The given number of evenly spaced values from one to another. Those between are rounded to the twelfth digit of the greater end,
/// so that steps of a tenth are written as tenths.
#[expect(clippy::cast_precision_loss, reason = "at most a thousand values")]
fn spread(from: f64, to: f64, steps: usize) -> Vec<f64> {
    let last = (steps - 1) as f64;
    let scale = from.abs().max(to.abs());
    let decimals = (12.0 - libm::ceil(libm::log10(scale))).clamp(0.0, 17.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 17")]
    let decimals = decimals as usize;
    let between = |i: usize| {
        let value = from + (to - from) * (i as f64 / last);
        format!("{value:.decimals$}").parse().unwrap_or(value).clamp(from, to)
    };
    (0..steps)
        .map(|i| {
            if i == 0 {
                from
            } else if i + 1 == steps {
                to
            } else {
                between(i)
            }
        })
        .collect()
}

/// A value in the type that the scenario's key takes.
pub(super) fn typed(key: &Key, value: f64) -> toml::Value {
    match key.kind {
        #[expect(clippy::cast_possible_truncation, reason = "whole and within the range of counts, or refused as it is")]
        Kind::CountOrAuto if value.fract() == 0.0 && value.abs() < 1e9 => toml::Value::Integer(value as i64),
        _ => toml::Value::Float(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::CATALOGUE;

    #[test]
    fn intermediate_values_are_rounded_to_the_usual_notation() {
        assert_eq!(spread(0.1, 0.7, 7), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
        assert_eq!(spread(-1.0, 1.0, 3), [-1.0, 0.0, 1.0]);
        assert_eq!(spread(0.000_02, 0.000_08, 4), [0.000_02, 0.000_04, 0.000_06, 0.000_08]);
        let thirds = spread(0.0, 1.0, 4);
        assert!((thirds[1] - 1.0 / 3.0).abs() < 1e-11, "{thirds:?}");
        assert!(spread(1e9, 1e9 + 1e-3, 5).windows(2).all(|pair| pair[0] <= pair[1]));
    }

    #[test]
    fn every_key_that_takes_a_number_can_be_varied_and_no_other() {
        for key in &CATALOGUE {
            // A share is at most 1.
            let range = if matches!(key.kind, Kind::Number { max, .. } if max < 3.0) { "0.25:0.75:3" } else { "1:3:3" };
            let text = format!("{}={range}", key.path());
            let parsed = SweptKey::parse(&text);
            let number = matches!(key.kind, Kind::Number { .. } | Kind::AngleOrUnlimited | Kind::CountOrAuto);
            assert_eq!(parsed.is_ok(), number, "{text}: {parsed:?}");
        }
    }
}

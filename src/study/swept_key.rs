//! A key of the scenario that is swept over evenly spaced values.

use super::TradeError;
use crate::scenario::{Key, Kind, fits, kind_of_layer_key, layer_keys, nearest_key};

/// A swept key of the scenario, and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptKey {
    table: String,
    /// Of a layer, `NAME.KEY`.
    name: String,
    kind: Kind,
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
        let kind = match (key.kind, name.split_once('.')) {
            (Kind::Layer, Some((_, own))) => match kind_of_layer_key(own) {
                Some(kind) => kind,
                None => return Err(TradeError::UnknownKey { nearest: format!("the keys of a layer are {}", layer_keys()), path }),
            },
            (kind, _) => kind,
        };
        if !matches!(kind, Kind::Number { .. } | Kind::AngleOrUnlimited | Kind::CountOrAuto | Kind::Count { .. }) {
            return Err(TradeError::NotANumber { path, expected: kind.expected() });
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
        if let Some(&value) = values.iter().find(|&&value| !fits(&typed(kind, value), kind)) {
            return Err(TradeError::Value { path, value, expected: kind.expected() });
        }
        let (table, name) = (table.to_owned(), name.to_owned());
        Ok(Self { table, name, kind, values })
    }

    /// The key, `TABLE.KEY`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.table, self.name)
    }

    /// Table and name of the key; of a layer, the name is `NAME.KEY`.
    pub fn key(&self) -> (&str, &str) {
        (&self.table, &self.name)
    }

    /// A value in the type that the key takes.
    pub(super) fn typed(&self, value: f64) -> toml::Value {
        typed(self.kind, value)
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

/// A value in the type that a kind of key takes.
fn typed(kind: Kind, value: f64) -> toml::Value {
    match kind {
        #[expect(clippy::cast_possible_truncation, reason = "whole and within the range of counts, or refused as it is")]
        Kind::CountOrAuto | Kind::Count { .. } if value.fract() == 0.0 && value.abs() < 1e9 => toml::Value::Integer(value as i64),
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
            let range = match key.kind {
                Kind::Number { max, .. } if max < 3.0 => "0.25:0.75:3".to_owned(),
                Kind::Count { min, .. } => format!("{}:{}:3", min.max(1), min.max(1) + 2),
                _ => "1:3:3".to_owned(),
            };
            let text = format!("{}={range}", key.path());
            let parsed = SweptKey::parse(&text);
            let number = matches!(key.kind, Kind::Number { .. } | Kind::AngleOrUnlimited | Kind::CountOrAuto | Kind::Count { .. });
            assert_eq!(parsed.is_ok(), number, "{text}: {parsed:?}");
        }
    }

    #[test]
    fn numbers_of_a_layer_can_be_varied_and_its_words_cannot() {
        let hops = SweptKey::parse("layer.sun.outage_hops_max=1:3:3").unwrap();
        assert_eq!((hops.path().as_str(), hops.key()), ("layer.sun.outage_hops_max", ("layer", "sun.outage_hops_max")));
        assert_eq!(hops.typed(2.0), toml::Value::Integer(2));
        assert_eq!(SweptKey::parse("layer.sun.min=-1:1:3").unwrap().values(), [-1.0, 0.0, 1.0]);
        for (refused, said) in [
            ("layer.sun.raster=0:1:2", "cannot be varied"),
            ("layer.sun.applies_to=0:1:2", "cannot be varied"),
            ("layer.sun=0:1:2", "cannot be varied"),
            ("layer.sun.mn=0:1:2", "the keys of a layer are raster, min, max"),
            ("layer.sun.outage_max_s=-1:1:3", "a value is -1"),
            ("layer.sun.outage_hops_max=1:2:3", "a value is 1.5"),
        ] {
            let error = SweptKey::parse(refused).unwrap_err().to_string();
            assert!(error.contains(said), "{refused}: {error}");
        }
    }
}

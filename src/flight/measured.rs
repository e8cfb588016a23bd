//! Errors as a test stand measured them.

use std::{fmt, sync::Arc};

use sha2::{Digest, Sha256};

use super::ErrorKey;
use crate::{
    chain::csv::{MEASURED_COLUMNS, MeasuredFile},
    quantity::Angle,
};

/// The errors of single hops as a test stand measured them, resampled: every hop flies one of the rows, all equally likely.
///
/// The errors of a row belong together, so that what depends on one another stays so. Rows are ordered by their values: the order of the
/// file makes no difference. Cheap to clone.
///
/// ```
/// use chta::{chain::csv::read_measured_csv, uncertainty::{ErrorKey, MeasuredErrors}};
/// let file = read_measured_csv(b"takeoff_speed_error_fraction,takeoff_angle_error_deg\n0.01,-0.5\n-0.02,0.1\n")?;
/// let measured = MeasuredErrors::of(&file);
/// assert_eq!(measured.row_count(), 2);
/// assert!(measured.replaces(ErrorKey::TakeoffAngle).is_some() && measured.replaces(ErrorKey::Heading).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct MeasuredErrors {
    has: [bool; MEASURED_COLUMNS.len()],
    rows: Arc<[MeasuredRow]>,
}

/// The errors of one hop, measured together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MeasuredRow {
    /// As a fraction of the commanded speed.
    pub(crate) speed_fraction: f64,
    pub(crate) speed_m_s: f64,
    pub(crate) angle_rad: f64,
    pub(crate) heading_rad: f64,
    /// Bounce and roll, along and across.
    pub(crate) drift_m: [f64; 2],
}

/// The errors that each column replaces.
const REPLACED: [&[ErrorKey]; MEASURED_COLUMNS.len()] = [
    &[ErrorKey::TakeoffSpeed, ErrorKey::TakeoffSpeedFraction],
    &[ErrorKey::TakeoffSpeed, ErrorKey::TakeoffSpeedFraction],
    &[ErrorKey::TakeoffAngle],
    &[ErrorKey::Heading],
    &[ErrorKey::DriftAlong],
    &[ErrorKey::DriftAcross],
];

/// The place of the heading among the columns.
const HEADING: usize = 3;

impl MeasuredErrors {
    /// The rows of a file.
    pub fn of(file: &MeasuredFile) -> Self {
        let mut rows: Vec<MeasuredRow> = file.rows.iter().map(MeasuredRow::of).collect();
        // So that the fixed draws of an estimate, which are spread evenly over the rows, are spread evenly over the errors of speed.
        rows.sort_by(|a, b| {
            a.values().iter().zip(b.values()).map(|(a, b)| a.total_cmp(&b)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
        });
        Self { has: file.has, rows: rows.into() }
    }

    /// Those of a file that is named and not read yet. They are no valid errors: nothing can be flown with them.
    pub fn unread() -> Self {
        Self { has: [false; MEASURED_COLUMNS.len()], rows: Arc::default() }
    }

    /// The number of rows; 0 if the file is not read yet.
    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// The column that stands for an error, if there is one.
    pub fn replaces(&self, key: ErrorKey) -> Option<&'static str> {
        let found = self.has.iter().zip(REPLACED).position(|(has, replaced)| *has && replaced.contains(&key))?;
        Some(MEASURED_COLUMNS[found].name)
    }

    /// The greatest error of each column by size, in the unit of the column.
    pub fn greatest(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        let sizes = self.rows.iter().fold([0.0_f64; MEASURED_COLUMNS.len()], |mut most, row| {
            for (most, value) in most.iter_mut().zip(row.values()) {
                *most = most.max(value.abs());
            }
            most
        });
        let in_degrees = |name: &str, size: f64| if name.ends_with("_deg") { Angle::from_radians(size).degrees() } else { size };
        let columns = MEASURED_COLUMNS.iter().zip(self.has).zip(sizes);
        columns.filter(|((_, has), _)| *has).map(move |((column, _), size)| (column.name, in_degrees(column.name, size)))
    }

    /// Whether the heading was measured.
    pub const fn has_heading(&self) -> bool {
        self.has[HEADING]
    }

    /// The same without the errors of heading, as along a chain, which has one plane of travel.
    #[must_use]
    pub fn without_heading(&self) -> Self {
        let mut has = self.has;
        has[HEADING] = false;
        Self { has, rows: self.rows.iter().map(|row| MeasuredRow { heading_rad: 0.0, ..*row }).collect() }
    }

    /// Every error multiplied by a factor.
    #[must_use]
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        let scaled = |row: &MeasuredRow| MeasuredRow {
            speed_fraction: factor * row.speed_fraction,
            speed_m_s: factor * row.speed_m_s,
            angle_rad: factor * row.angle_rad,
            heading_rad: factor * row.heading_rad,
            drift_m: row.drift_m.map(|drift_m| factor * drift_m),
        };
        Self { has: self.has, rows: self.rows.iter().map(scaled).collect() }
    }

    /// The mean over all rows; 0 without rows.
    #[expect(clippy::cast_precision_loss, reason = "below 2^53 rows")]
    pub(crate) fn mean(&self, of: impl Fn(&MeasuredRow) -> f64) -> f64 {
        self.rows.iter().map(of).sum::<f64>() / self.rows.len().max(1) as f64
    }

    /// Whether any row is so.
    pub(crate) fn any(&self, is_so: impl Fn(&MeasuredRow) -> bool) -> bool {
        self.rows.iter().any(is_so)
    }

    /// The row of a share of the rows, in [0, 1); without rows no error.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2^53 rows")]
    pub(crate) fn row(&self, share: f64) -> MeasuredRow {
        let number = (share * self.rows.len() as f64) as usize;
        self.rows.get(number.min(self.rows.len().saturating_sub(1))).copied().unwrap_or_default()
    }
}

/// Short, and different for different rows: what is computed under these errors is recognised by this text.
impl fmt::Debug for MeasuredErrors {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut digest = Sha256::new();
        for value in self.rows.iter().flat_map(MeasuredRow::values) {
            digest.update(value.to_bits().to_le_bytes());
        }
        let names: Vec<&str> =
            MEASURED_COLUMNS.iter().zip(self.has).filter(|(_, has)| *has).map(|(column, _)| column.name).collect();
        write!(formatter, "MeasuredErrors({names:?}, {} rows, {:x?})", self.rows.len(), digest.finalize().as_slice())
    }
}

impl MeasuredRow {
    /// The values of a row of a file, angles in radians.
    const fn of(values: &[f64; MEASURED_COLUMNS.len()]) -> Self {
        let [speed_fraction, speed_m_s, angle_rad, heading_rad, along_m, across_m] = *values;
        Self { speed_fraction, speed_m_s, angle_rad, heading_rad, drift_m: [along_m, across_m] }
    }

    /// The values in the order of the columns.
    const fn values(&self) -> [f64; MEASURED_COLUMNS.len()] {
        let [along_m, across_m] = self.drift_m;
        [self.speed_fraction, self.speed_m_s, self.angle_rad, self.heading_rad, along_m, across_m]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::csv::read_measured_csv;

    #[test]
    fn shares_choose_every_row_equally_whatever_the_order_of_the_file() {
        let of = |text: &str| MeasuredErrors::of(&read_measured_csv(text.as_bytes()).expect("a valid file"));
        let measured = of("drift_along_m,takeoff_speed_error_m_s\n3,0.1\n1,-0.1\n2,0\n");
        assert_eq!(measured, of("takeoff_speed_error_m_s,drift_along_m\n-0.1,1\n0,2\n0.1,3\n"));
        let mut counts = [0; 3];
        for i in 0..300 {
            let row = measured.row(f64::from(i) / 300.0);
            let number = (0..3).find(|n| row.drift_m[0] == f64::from(*n) + 1.0).expect("a row of the file");
            counts[usize::try_from(number).expect("small")] += 1;
            assert_eq!(row.speed_m_s, 0.1 * f64::from(number - 1));
        }
        assert_eq!(counts, [100; 3]);
        assert_eq!(measured.row(1.0), measured.row(0.999));
        assert_eq!(MeasuredErrors::unread().row(0.5), MeasuredRow::default());
        assert_ne!(format!("{measured:?}"), format!("{:?}", measured.scaled(2.0)));
        assert_eq!(measured.scaled(2.0).row(0.9).drift_m, [6.0, 0.0]);
    }

    #[test]
    fn columns_have_their_place_and_unit() {
        let text = b"takeoff_speed_error_m_s,takeoff_angle_error_deg,heading_error_deg,drift_along_m,drift_across_m\n1,2,-3,4,-5\n";
        let measured = MeasuredErrors::of(&read_measured_csv(text).expect("a valid file"));
        let greatest: Vec<(&str, String)> = measured.greatest().map(|(name, size)| (name, format!("{size:.9}"))).collect();
        let expected =
            ["takeoff_speed_error_m_s", "takeoff_angle_error_deg", "heading_error_deg", "drift_along_m", "drift_across_m"];
        for (i, ((name, size), known)) in greatest.iter().zip(expected).enumerate() {
            assert_eq!((*name, size), (known, &format!("{}.000000000", i + 1)));
        }
        assert!(measured.has_heading() && !measured.without_heading().has_heading());
        assert_eq!(measured.without_heading().row(0.0).heading_rad, 0.0);
        assert!((measured.row(0.0).heading_rad + 3.0_f64.to_radians()).abs() < 1e-15);
    }
}

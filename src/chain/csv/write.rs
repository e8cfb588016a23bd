//! Writes a chain to CSV.

use std::io::{self, Write};

use super::{
    CHAIN_COLUMNS,
    columns::{BEND, CROSS_SLOPE, FORWARD, FRICTION, KEEP_OUT, MAP_X, MAP_Y, REVERSE, SIX, X, Z},
    degrees::degrees_text,
};
use crate::{
    chain::{ContactRule, GroundForm, LineConstraints, PolygonalChain, SegmentGround},
    quantity::{Angle, AngleInterval, SegmentId, VertexId},
};

/// Why a chain cannot be written as CSV.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ChainWriteError {
    /// The output cannot be written to.
    #[error("the chain cannot be written: {0}")]
    Io(#[from] io::Error),
    /// Some segments state their surface, others explicit limits.
    #[error("segment {} is in another form than segment 1, expected one form for the whole chain: state every segment in one form", .0.index() + 1)]
    MixedForms(SegmentId),
    /// Some segments state their friction, others leave it to the scenario.
    #[error("segment {} differs from segment 1 in whether it states a friction coefficient, expected all or none: give every segment one", .0.index() + 1)]
    MixedFriction(SegmentId),
    /// A value that the reader would refuse.
    #[error("segment {} has the {column} {value}, expected {expected}: correct the chain before writing it", segment.index() + 1)]
    Unwritable {
        /// The segment.
        segment: SegmentId,
        /// The column.
        column: &'static str,
        /// The value; angles in degrees.
        value: f64,
        /// The values that the column accepts.
        expected: &'static str,
    },
}

/// Writes a chain in the form of its grounds, so that it reads back as the same chain.
///
/// Columns without information (no friction, cross-slopes all 0, no keep-out, no limits in a direction, no map) are left out.
/// If only some segments state limits for a direction, the others are written with speed 0, which means the same. So are
/// limits whose least angle is above their greatest, which a file cannot state. Everything else reads back bit by bit.
///
/// # Arguments
/// `comments`: lines written before the header, each after `# `.
///
/// # Errors
/// [`ChainWriteError`]; a chain that cannot be written leaves the output untouched.
///
/// # Examples
/// ```
/// use chta::{chain::{PolygonalChain, csv::write_chain_csv}, quantity::ChainPoint};
/// let chain = PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.5), ChainPoint::new(2.0, 1e-9)]).unwrap();
/// let mut text = Vec::new();
/// write_chain_csv(&chain, &mut text, &["a ramp".to_owned()]).unwrap();
/// assert_eq!(text, b"# a ramp\nx_m,z_m\n0,0.5\n2,1e-9\n");
/// ```
pub fn write_chain_csv(chain: &PolygonalChain, mut out: impl Write, comments: &[String]) -> Result<(), ChainWriteError> {
    let layout = Layout::of(chain)?;
    let mut head = String::new();
    for line in comments.iter().flat_map(|comment| comment.split(['\n', '\r'])) {
        head.push_str(if line.is_empty() { "#" } else { "# " });
        head.push_str(line);
        head.push('\n');
    }
    let mut writer = csv::WriterBuilder::new().from_writer(head.into_bytes());
    writer.write_record(layout.columns().iter().map(|&column| CHAIN_COLUMNS[column].name)).map_err(io::Error::from)?;
    let map = chain.map_points();
    for (row, vertex) in chain.vertices().iter().enumerate() {
        let mut fields = vec![number_text(vertex.x_m), number_text(vertex.z_m)];
        match chain.grounds().get(row) {
            Some(ground) => layout.write_ground(SegmentId(row), ground, &mut fields)?,
            None => fields.resize(fields.len() + layout.segment_columns().len(), String::new()),
        }
        if let Some(point) = map.and_then(|points| points.get(row)) {
            fields.extend([number_text(point.x), number_text(point.y)]);
        }
        if layout.bends {
            fields.push(if chain.bends().binary_search(&VertexId(row)).is_ok() { "1" } else { "0" }.to_owned());
        }
        writer.write_record(fields).map_err(io::Error::from)?;
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    out.write_all(&bytes)?;
    out.flush()?;
    Ok(())
}

/// The shortest text that reads back as the same double, with an exponent instead of many zeros.
pub(super) fn number_text(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-5..1e16).contains(&size) { format!("{value}") } else { format!("{value:e}") }
}

/// The groups of columns that a chain fills.
#[derive(Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is the presence of a column, free of the others")]
struct Layout {
    friction: bool,
    cross_slope: bool,
    keep_out: bool,
    forward: bool,
    reverse: bool,
    map: bool,
    bends: bool,
}

impl Layout {
    fn of(chain: &PolygonalChain) -> Result<Self, ChainWriteError> {
        let mut layout = Self { map: chain.map_points().is_some(), bends: !chain.bends().is_empty(), ..Self::default() };
        let Some(first) = chain.grounds().first() else { return Ok(layout) };
        for (i, ground) in chain.grounds().iter().enumerate() {
            layout.keep_out |= ground.keep_out;
            match (first.form, ground.form) {
                (GroundForm::Surface { friction: of_first, .. }, GroundForm::Surface { friction, cross_slope }) => {
                    if of_first.is_some() != friction.is_some() {
                        return Err(ChainWriteError::MixedFriction(SegmentId(i)));
                    }
                    layout.friction |= friction.is_some();
                    layout.cross_slope |= cross_slope != Angle::default();
                }
                (GroundForm::Explicit { .. }, GroundForm::Explicit { forward, reverse }) => {
                    layout.forward |= forward.is_some();
                    layout.reverse |= reverse.is_some();
                }
                _ => return Err(ChainWriteError::MixedForms(SegmentId(i))),
            }
        }
        // A chain that allows no contact anywhere: without any of the twelve columns it would leave the limits to the
        // scenario.
        if matches!(first.form, GroundForm::Explicit { .. }) && !layout.reverse {
            layout.forward = true;
        }
        Ok(layout)
    }

    /// The columns of segments, in the order of [`CHAIN_COLUMNS`].
    fn segment_columns(&self) -> Vec<usize> {
        let single = [(self.friction, FRICTION), (self.cross_slope, CROSS_SLOPE), (self.keep_out, KEEP_OUT)];
        let single = single.into_iter().filter(|&(given, _)| given).map(|(_, column)| column);
        let six = [(self.forward, FORWARD), (self.reverse, REVERSE)];
        let six = six.into_iter().filter(|&(given, _)| given).flat_map(|(_, first)| first..first + SIX);
        single.chain(six).collect()
    }

    /// All columns.
    fn columns(&self) -> Vec<usize> {
        let mut columns = vec![X, Z];
        columns.extend(self.segment_columns());
        if self.map {
            columns.extend([MAP_X, MAP_Y]);
        }
        if self.bends {
            columns.push(BEND);
        }
        columns
    }

    /// The fields of one segment, in the order of [`Self::segment_columns`].
    fn write_ground(&self, segment: SegmentId, ground: &SegmentGround, fields: &mut Vec<String>) -> Result<(), ChainWriteError> {
        let keep_out = self.keep_out.then(|| if ground.keep_out { "1" } else { "0" }.to_owned());
        match ground.form {
            GroundForm::Surface { friction, cross_slope } => {
                fields.extend(friction.map(|cone| number_text(cone.coefficient())));
                if self.cross_slope {
                    fields.push(angle_field(segment, CROSS_SLOPE, cross_slope)?);
                }
                fields.extend(keep_out);
            }
            GroundForm::Explicit { forward, reverse } => {
                fields.extend(keep_out);
                for (given, first, limits) in [(self.forward, FORWARD, forward), (self.reverse, REVERSE, reverse)] {
                    if given {
                        write_limits(segment, first, limits.unwrap_or_else(nothing_allowed), fields)?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Limits with speed 0, which mean the same as no limits stated: no contact is allowed.
fn nothing_allowed() -> LineConstraints {
    let rule = ContactRule::new(AngleInterval { min: Angle::default(), max: Angle::default() }, 0.0);
    LineConstraints { takeoff: rule, landing: rule }
}

/// Writes the six fields of a direction.
fn write_limits(
    segment: SegmentId,
    first: usize,
    limits: LineConstraints,
    fields: &mut Vec<String>,
) -> Result<(), ChainWriteError> {
    for (first, rule) in [(first, limits.takeoff), (first + SIX / 2, limits.landing)] {
        let AngleInterval { min, max } = rule.angles();
        let crossed = min > max;
        let (least, greatest) = if crossed { (max, min) } else { (min, max) };
        fields.push(angle_field(segment, first, least)?);
        fields.push(angle_field(segment, first + 1, greatest)?);
        fields.push(checked(segment, first + 2, if crossed { 0.0 } else { rule.speed_max_m_s() }, number_text)?);
    }
    Ok(())
}

/// The text of an angle if the reader accepts it.
fn angle_field(segment: SegmentId, column: usize, angle: Angle) -> Result<String, ChainWriteError> {
    let text = degrees_text(angle);
    checked(segment, column, angle.degrees(), |degrees| text.unwrap_or_else(|| number_text(degrees)))
}

/// The text of a value if the reader accepts it.
fn checked(segment: SegmentId, column: usize, value: f64, text: impl FnOnce(f64) -> String) -> Result<String, ChainWriteError> {
    let known = &CHAIN_COLUMNS[column];
    let text = text(value);
    match known.parse(&text) {
        Ok(_) => Ok(text),
        Err(_) => Err(ChainWriteError::Unwritable { segment, column: known.name, value, expected: known.expected() }),
    }
}

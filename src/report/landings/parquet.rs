//! Landings as Parquet, without Arrow.

use std::{io, sync::Arc};

use parquet::{
    basic::{Compression, ConvertedType, LogicalType, Repetition, Type as PhysicalType},
    data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type},
    file::{
        metadata::KeyValue,
        properties::WriterProperties,
        writer::{SerializedFileWriter, SerializedRowGroupWriter},
    },
    schema::types::Type,
};

use super::{DRAWN_COLUMNS, FIRST_COLUMNS, LandingColumns, LandingRow, LandingWriter, NUMBERS, TRUE_HEADING, number_columns};
use crate::report::MapKnowledge;

/// Rows of one row group: some 10 MB in memory before they are written.
const ROWS_PER_GROUP: usize = 1 << 16;

/// Landings as Parquet: the columns of the CSV, `outcome` null if the trial continues.
pub struct ParquetLandings<W: io::Write + Send> {
    writer: SerializedFileWriter<W>,
    waiting: Vec<LandingRow>,
    columns: LandingColumns,
}

impl<W: io::Write + Send> std::fmt::Debug for ParquetLandings<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParquetLandings").field("waiting", &self.waiting.len()).finish_non_exhaustive()
    }
}

impl<W: io::Write + Send> ParquetLandings<W> {
    /// Begins a file with the given key-value metadata.
    ///
    /// # Errors
    /// An error of the file system.
    pub fn begin(out: W, columns: LandingColumns, words: &[(&str, String)]) -> io::Result<Self> {
        let words = words.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone())).collect();
        let properties = WriterProperties::builder()
            .set_key_value_metadata(Some(words))
            .set_compression(Compression::SNAPPY)
            .set_created_by(format!("chta {}", env!("CARGO_PKG_VERSION")))
            .build();
        let writer =
            SerializedFileWriter::new(out, Arc::new(schema(columns).map_err(other)?), Arc::new(properties)).map_err(other)?;
        Ok(Self { writer, waiting: Vec::new(), columns })
    }

    /// Writes the buffered rows as one row group.
    fn write_group(&mut self) -> io::Result<()> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        let rows = std::mem::take(&mut self.waiting);
        let mut group = self.writer.next_row_group().map_err(other)?;
        #[expect(clippy::cast_possible_wrap, reason = "fewer trials than 2^63 and hops than 2^31")]
        let (trials, hops): (Vec<i64>, Vec<i32>) = rows.iter().map(|row| (row.trial as i64, row.hop as i32)).unzip();
        column::<_, Int64Type>(&mut group, &trials, None)?;
        column::<_, Int32Type>(&mut group, &hops, None)?;
        let policies: Vec<_> = rows.iter().map(|row| ByteArray::from(row.policy)).collect();
        column::<_, ByteArrayType>(&mut group, &policies, None)?;
        let outcomes: Vec<_> = rows.iter().filter(|row| !row.outcome.is_empty()).map(|row| ByteArray::from(row.outcome)).collect();
        let present: Vec<i16> = rows.iter().map(|row| i16::from(!row.outcome.is_empty())).collect();
        column::<_, ByteArrayType>(&mut group, &outcomes, Some(&present))?;
        for number in 0..NUMBERS {
            let numbers: Vec<_> = rows.iter().map(|row| row.numbers[number]).collect();
            column::<_, DoubleType>(&mut group, &numbers, None)?;
        }
        if self.columns.known == MapKnowledge::Projection {
            let headings: Vec<_> = rows.iter().filter_map(|row| row.heading_true_deg).collect();
            let present: Vec<i16> = rows.iter().map(|row| i16::from(row.heading_true_deg.is_some())).collect();
            column::<_, DoubleType>(&mut group, &headings, Some(&present))?;
        }
        for number in (0..DRAWN_COLUMNS.len()).filter(|_| self.columns.drawn) {
            let numbers: Vec<_> = rows.iter().map(|row| row.drawn[number]).collect();
            column::<_, DoubleType>(&mut group, &numbers, None)?;
        }
        group.close().map(drop).map_err(other)
    }
}

impl<W: io::Write + Send> LandingWriter for ParquetLandings<W> {
    fn write(&mut self, row: &LandingRow) -> io::Result<()> {
        self.waiting.push(row.clone());
        if self.waiting.len() < ROWS_PER_GROUP { Ok(()) } else { self.write_group() }
    }

    fn finish(&mut self) -> io::Result<()> {
        self.write_group()?;
        self.writer.finish().map(drop).map_err(other)
    }
}

/// Writes the next column of a row group.
fn column<W: io::Write + Send, T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
    present: Option<&[i16]>,
) -> io::Result<()> {
    let Some(mut column) = group.next_column().map_err(other)? else { return Ok(()) };
    column.typed::<T>().write_batch(values, present, None).map_err(other)?;
    column.close().map_err(other)
}

/// The columns.
fn schema(LandingColumns { known, drawn }: LandingColumns) -> Result<Type, parquet::errors::ParquetError> {
    let [trial, hop, policy, outcome] = FIRST_COLUMNS;
    let plain = |name, physical| Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED).build();
    let text = |name, repetition| {
        Type::primitive_type_builder(name, PhysicalType::BYTE_ARRAY)
            .with_converted_type(ConvertedType::UTF8)
            .with_logical_type(Some(LogicalType::String))
            .with_repetition(repetition)
            .build()
    };
    let mut fields = vec![
        Arc::new(plain(trial, PhysicalType::INT64)?),
        Arc::new(plain(hop, PhysicalType::INT32)?),
        Arc::new(text(policy, Repetition::REQUIRED)?),
        Arc::new(text(outcome, Repetition::OPTIONAL)?),
    ];
    for name in number_columns(known) {
        fields.push(Arc::new(plain(name, PhysicalType::DOUBLE)?));
    }
    if known == MapKnowledge::Projection {
        let heading = Type::primitive_type_builder(TRUE_HEADING, PhysicalType::DOUBLE);
        fields.push(Arc::new(heading.with_repetition(Repetition::OPTIONAL).build()?));
    }
    for name in DRAWN_COLUMNS.iter().filter(|_| drawn) {
        fields.push(Arc::new(plain(name, PhysicalType::DOUBLE)?));
    }
    Type::group_type_builder("landing").with_fields(fields).build()
}

fn other(error: parquet::errors::ParquetError) -> io::Error {
    io::Error::other(error)
}

#[cfg(test)]
mod tests {
    use parquet::{
        file::reader::{FileReader, SerializedFileReader},
        record::RowAccessor,
    };

    use super::*;

    #[test]
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "small counts")]
    fn rows_and_metadata_are_read_back() {
        let file = tempfile::tempfile().unwrap();
        let words = [("seed", "7".to_owned()), ("scenario", "{}".to_owned())];
        let columns = LandingColumns { known: MapKnowledge::Projection, drawn: true };
        let mut writer = ParquetLandings::begin(file.try_clone().unwrap(), columns, &words).unwrap();
        let row = |trial: u64| LandingRow {
            trial,
            hop: 2,
            policy: "replan",
            outcome: if trial.is_multiple_of(2) { "reached" } else { "" },
            numbers: std::array::from_fn(|i| i as f64 + trial as f64),
            drawn: std::array::from_fn(|i| i as f64 - trial as f64),
            heading_true_deg: (!trial.is_multiple_of(3)).then_some(trial as f64),
        };
        let count = ROWS_PER_GROUP as u64 + 10;
        for trial in 0..count {
            writer.write(&row(trial)).unwrap();
        }
        writer.finish().unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let metadata = reader.metadata();
        assert_eq!((metadata.num_row_groups(), metadata.file_metadata().num_rows()), (2, count as i64));
        let words = metadata.file_metadata().key_value_metadata().unwrap();
        assert!(words.iter().any(|word| word.key == "seed" && word.value.as_deref() == Some("7")), "{words:?}");
        for (trial, read) in reader.get_row_iter(None).unwrap().enumerate() {
            let (read, row) = (read.unwrap(), row(trial as u64));
            assert_eq!((read.get_long(0).unwrap(), read.get_int(1).unwrap()), (trial as i64, 2));
            assert_eq!(read.get_string(2).unwrap(), "replan");
            assert_eq!(read.get_string(3).ok().map_or("", |text| text.as_str()), row.outcome);
            assert_eq!(read.get_double(19).unwrap(), row.numbers[15]);
            assert_eq!(read.get_double(20).ok(), row.heading_true_deg);
            assert_eq!(read.get_double(28).unwrap(), row.drawn[7]);
        }
    }
}

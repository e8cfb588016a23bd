//! Tables of text cells as Parquet, without Arrow.

use std::{fs::File, io, sync::Arc};

use parquet::{
    basic::{Compression, ConvertedType, LogicalType, Repetition, Type as PhysicalType},
    data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type},
    file::{
        metadata::KeyValue,
        properties::WriterProperties,
        reader::{FileReader, SerializedFileReader},
        writer::{SerializedFileWriter, SerializedRowGroupWriter},
    },
    record::Field,
    schema::types::Type,
};

/// Rows of one row group.
const ROWS_PER_GROUP: usize = 1 << 16;

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// A whole number: 64 bits with a sign.
    Count,
    /// A number: 64 bits.
    Number,
    /// A text in UTF-8.
    Text,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableColumn {
    /// Its name.
    pub name: String,
    /// What its cells are.
    pub kind: CellKind,
}

/// Writes a table of cells in text, of which empty ones become null, with key-value metadata.
///
/// # Errors
/// An error of the file system, or a cell that is not of the kind of its column.
pub fn write_parquet<W: io::Write + Send>(
    out: W,
    columns: &[TableColumn],
    words: &[(String, String)],
    rows: &[Vec<String>],
) -> io::Result<()> {
    let words = words.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
    let properties = WriterProperties::builder()
        .set_key_value_metadata(Some(words))
        .set_compression(Compression::SNAPPY)
        .set_created_by(format!("chta {}", env!("CARGO_PKG_VERSION")))
        .build();
    let schema = Arc::new(schema(columns).map_err(other)?);
    let mut writer = SerializedFileWriter::new(out, schema, Arc::new(properties)).map_err(other)?;
    for some in rows.chunks(ROWS_PER_GROUP) {
        let mut group = writer.next_row_group().map_err(other)?;
        for (number, TableColumn { name, kind }) in columns.iter().enumerate() {
            let cells = some.iter().map(|row| row.get(number).map_or("", String::as_str));
            let misfit = |cell: &str| io::Error::other(format!("found \"{cell}\" in the column {name}, expected a number"));
            match kind {
                CellKind::Count => {
                    column::<_, Int64Type>(&mut group, cells, |cell| cell.parse().map_err(|_| misfit(cell)))?;
                }
                CellKind::Number => {
                    column::<_, DoubleType>(&mut group, cells, |cell| cell.parse().map_err(|_| misfit(cell)))?;
                }
                CellKind::Text => column::<_, ByteArrayType>(&mut group, cells, |cell| Ok(ByteArray::from(cell)))?,
            }
        }
        group.close().map_err(other)?;
    }
    writer.close().map(drop).map_err(other)
}

/// Writes the next column of a row group.
fn column<'a, W: io::Write + Send, T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    cells: impl Iterator<Item = &'a str> + Clone,
    parse: impl Fn(&str) -> io::Result<T::T>,
) -> io::Result<()> {
    let Some(mut column) = group.next_column().map_err(other)? else { return Ok(()) };
    let present: Vec<i16> = cells.clone().map(|cell| i16::from(!cell.is_empty())).collect();
    let values: Vec<T::T> = cells.filter(|cell| !cell.is_empty()).map(parse).collect::<io::Result<_>>()?;
    column.typed::<T>().write_batch(&values, Some(&present), None).map_err(other)?;
    column.close().map_err(other)
}

fn schema(columns: &[TableColumn]) -> Result<Type, parquet::errors::ParquetError> {
    let field = |TableColumn { name, kind }: &TableColumn| {
        let of = |physical| Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
        let built = match kind {
            CellKind::Count => of(PhysicalType::INT64),
            CellKind::Number => of(PhysicalType::DOUBLE),
            CellKind::Text => {
                of(PhysicalType::BYTE_ARRAY).with_converted_type(ConvertedType::UTF8).with_logical_type(Some(LogicalType::String))
            }
        };
        built.build().map(Arc::new)
    };
    Type::group_type_builder("row").with_fields(columns.iter().map(field).collect::<Result<_, _>>()?).build()
}

/// The names of the columns of a table, and its rows as text: nulls are empty.
pub type TextTable = (Vec<String>, Vec<Vec<String>>);

/// Reads a table. Numbers are written as in JSON, so that what [`write_parquet`] wrote is read back as it was.
///
/// # Errors
/// An error of the file system, or of the format; a column of lists, maps or times.
pub fn read_parquet(file: File) -> io::Result<TextTable> {
    let reader = SerializedFileReader::new(file).map_err(other)?;
    let schema = reader.metadata().file_metadata().schema();
    let columns: Vec<String> = schema.get_fields().iter().map(|field| field.name().to_owned()).collect();
    let mut rows = Vec::new();
    for row in reader.get_row_iter(None).map_err(other)? {
        let row = row.map_err(other)?;
        rows.push(row.get_column_iter().map(|(name, field)| text(name, field)).collect::<io::Result<_>>()?);
    }
    Ok((columns, rows))
}

/// A cell as text.
fn text(name: &str, field: &Field) -> io::Result<String> {
    let number = |value: f64| serde_json::Number::from_f64(value).map_or_else(|| value.to_string(), |number| number.to_string());
    Ok(match field {
        Field::Null => String::new(),
        Field::Bool(value) => value.to_string(),
        Field::Byte(value) => value.to_string(),
        Field::Short(value) => value.to_string(),
        Field::Int(value) => value.to_string(),
        Field::Long(value) => value.to_string(),
        Field::UByte(value) => value.to_string(),
        Field::UShort(value) => value.to_string(),
        Field::UInt(value) => value.to_string(),
        Field::ULong(value) => value.to_string(),
        Field::Float(value) => value.to_string(),
        Field::Double(value) => number(*value),
        Field::Str(value) => value.clone(),
        other => {
            return Err(io::Error::other(format!("found {other} in the column {name}, expected numbers, texts, true or false")));
        }
    })
}

fn other(error: parquet::errors::ParquetError) -> io::Error {
    io::Error::other(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_and_metadata_are_read_back() {
        let columns = [("case", CellKind::Count), ("speed_m_s", CellKind::Number), ("error", CellKind::Text)];
        let columns = columns.map(|(name, kind)| TableColumn { name: name.to_owned(), kind });
        let rows: Vec<Vec<String>> = (0..ROWS_PER_GROUP + 3)
            .map(|i| match i % 4 {
                0 => vec![i.to_string(), "6.0".to_owned(), String::new()],
                1 => vec![i.to_string(), "0.1".to_owned(), "line 5: no, \u{3b1}\n\"".to_owned()],
                2 => vec![i.to_string(), "1e-300".to_owned(), String::new()],
                _ => vec![String::new(), String::new(), "x".to_owned()],
            })
            .collect();
        let file = tempfile::tempfile().unwrap();
        let words = [("chta_version".to_owned(), "1".to_owned())];
        write_parquet(file.try_clone().unwrap(), &columns, &words, &rows).unwrap();
        let stated = SerializedFileReader::new(file.try_clone().unwrap()).unwrap();
        let stated = stated.metadata().file_metadata().key_value_metadata().unwrap().clone();
        assert!(stated.iter().any(|word| word.key == "chta_version" && word.value.as_deref() == Some("1")));
        let (names, read) = read_parquet(file).unwrap();
        assert_eq!(names, columns.clone().map(|column| column.name));
        assert!(read == rows);
        let wrong = [vec!["1.5".to_owned(), String::new(), String::new()]];
        let refused = write_parquet(Vec::new(), &columns, &words, &wrong).unwrap_err().to_string();
        assert!(refused.contains("1.5") && refused.contains("case"), "{refused}");
    }
}

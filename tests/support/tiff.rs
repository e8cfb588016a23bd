//! An uncompressed TIFF of one strip, tag by tag: files with samples and tags that the library's own writer would not write.
#![allow(clippy::unwrap_used, reason = "test helpers: a file that cannot be built fails its test")]

/// Samples of one type, row after row from the north.
pub(crate) enum Samples {
    Float32(Vec<f32>),
    Float64(Vec<f64>),
    Int16(Vec<i16>),
    Uint16(Vec<u16>),
    Int32(Vec<i32>),
    Byte(Vec<u8>),
}

impl Samples {
    /// Samples of a type by its name, from numbers cast as a writer would.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast is what a writer does")]
    pub(crate) fn of(kind: &str, values: &[f64]) -> Self {
        match kind {
            "float32" => Self::Float32(values.iter().map(|z| *z as f32).collect()),
            "float64" => Self::Float64(values.to_vec()),
            "int16" => Self::Int16(values.iter().map(|z| *z as i16).collect()),
            "uint16" => Self::Uint16(values.iter().map(|z| *z as u16).collect()),
            "int32" => Self::Int32(values.iter().map(|z| *z as i32).collect()),
            "byte" => Self::Byte(values.iter().map(|z| *z as u8).collect()),
            other => panic!("no samples of the type {other}"),
        }
    }

    /// Bits, sample format and bytes.
    fn encoded(&self) -> (u16, u16, Vec<u8>) {
        match self {
            Self::Float32(values) => (32, 3, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::Float64(values) => (64, 3, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::Int16(values) => (16, 2, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::Uint16(values) => (16, 1, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::Int32(values) => (32, 2, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::Byte(values) => (8, 1, values.clone()),
        }
    }
}

/// A further tag.
pub(crate) enum Tag {
    Doubles(u16, Vec<f64>),
    Shorts(u16, Vec<u16>),
    Text(u16, String),
}

/// The tags of a transform: the corner of the first pixel, and the size of pixels.
pub(crate) fn placed(x: f64, y: f64, size: f64) -> [Tag; 2] {
    [Tag::Doubles(33550, vec![size, size, 0.0]), Tag::Doubles(33922, vec![0.0, 0.0, 0.0, x, y, 0.0])]
}

/// A 3 x 4 file of 16-bit integers with scale, tie point, keys and no-data. Tags with a short, given as number, kind (3) and value,
/// are changed or added.
pub(crate) fn int16_tiff(changed: &[(u16, u16, u16)]) -> Vec<u8> {
    let samples = Samples::Int16(vec![1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, i16::MIN]);
    let metadata = "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item></GDALMetadata>";
    let further = [
        Tag::Shorts(34735, vec![1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3076, 0, 1, 9001]),
        Tag::Text(42112, metadata.to_owned()),
        Tag::Text(42113, "-32768".to_owned()),
    ];
    let changed = changed.iter().map(|&(tag, _, value)| Tag::Shorts(tag, vec![value]));
    plain_tiff((3, 4), &samples, placed(1000.0, 2000.0, 2.0).into_iter().chain(further).chain(changed))
}

/// The file. A further tag replaces an earlier one of its number.
pub(crate) fn plain_tiff((rows, cols): (u16, u16), samples: &Samples, further: impl IntoIterator<Item = Tag>) -> Vec<u8> {
    let shorts = |values: &[u16]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let short = |value: u16| shorts(&[value]);
    let (bits, format, data) = samples.encoded();
    let length = u32::try_from(data.len()).unwrap();
    let mut entries: Vec<(u16, u16, Vec<u8>)> = vec![
        (256, 3, short(cols)),
        (257, 3, short(rows)),
        (258, 3, short(bits)),
        (259, 3, short(1)),
        (262, 3, short(1)),
        (273, 4, 8_u32.to_le_bytes().to_vec()),
        (277, 3, short(1)),
        (278, 3, short(rows)),
        (279, 4, length.to_le_bytes().to_vec()),
        (339, 3, short(format)),
    ];
    entries.extend(further.into_iter().map(|tag| match tag {
        Tag::Doubles(code, values) => (code, 12, values.iter().flat_map(|value| value.to_le_bytes()).collect()),
        Tag::Shorts(code, values) => (code, 3, shorts(&values)),
        Tag::Text(code, text) => (code, 2, [text.as_bytes(), &[0]].concat()),
    }));
    let mut seen = std::collections::HashSet::new();
    entries.reverse();
    entries.retain(|entry| seen.insert(entry.0));
    entries.sort_by_key(|entry| entry.0);
    let directory = 8 + data.len();
    let mut values = directory + 2 + 12 * entries.len() + 4;
    let mut file = b"II*\0".to_vec();
    file.extend(u32::try_from(directory).unwrap().to_le_bytes());
    file.extend(data);
    file.extend(u16::try_from(entries.len()).unwrap().to_le_bytes());
    let mut tail = Vec::new();
    for (tag, kind, value) in entries {
        let size = [1, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8][usize::from(kind)];
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(u32::try_from(value.len() / size).unwrap().to_le_bytes());
        if value.len() <= 4 {
            let mut padded = value;
            padded.resize(4, 0);
            file.extend(padded);
        } else {
            file.extend(u32::try_from(values).unwrap().to_le_bytes());
            values += value.len();
            tail.extend(value);
        }
    }
    file.extend([0; 4]);
    file.extend(tail);
    file
}

//! A GeoTIFF written tag by tag.
#![allow(clippy::unwrap_used, reason = "test helpers: a file that cannot be built fails its test")]

/// A 3 x 4 int16 strip without compression, tag by tag, with scale, tie point, keys and no-data. Tags with a short, given as
/// number, kind (3) and value, are changed or added.
pub(crate) fn plain_tiff(changed: &[(u16, u16, u16)]) -> Vec<u8> {
    let doubles = |values: &[f64]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let shorts = |values: &[u16]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let samples = shorts(&[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 0x8000]);
    let scale = doubles(&[2.0, 2.0, 0.0]);
    let tie = doubles(&[0.0, 0.0, 0.0, 1000.0, 2000.0, 0.0]);
    let keys = shorts(&[1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3076, 0, 1, 9001]);
    let metadata = b"<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item></GDALMetadata>\0".to_vec();
    let no_data = b"-32768\0".to_vec();
    let short = |value: u16| shorts(&[value]);
    let mut entries: Vec<(u16, u16, Vec<u8>)> = vec![
        (256, 3, short(4)),
        (257, 3, short(3)),
        (258, 3, short(16)),
        (259, 3, short(1)),
        (262, 3, short(1)),
        (273, 4, 8_u32.to_le_bytes().to_vec()),
        (277, 3, short(1)),
        (278, 3, short(3)),
        (279, 4, 24_u32.to_le_bytes().to_vec()),
        (339, 3, short(2)),
        (33550, 12, scale),
        (33922, 12, tie),
        (34735, 3, keys),
        (42112, 2, metadata),
        (42113, 2, no_data),
    ];
    for (tag, kind, value) in changed {
        entries.retain(|(known, ..)| known != tag);
        entries.push((*tag, *kind, short(*value)));
    }
    entries.sort_by_key(|(tag, ..)| *tag);
    let directory = 8 + samples.len();
    let mut values = directory + 2 + 12 * entries.len() + 4;
    let mut file = b"II*\0".to_vec();
    file.extend(u32::try_from(directory).unwrap().to_le_bytes());
    file.extend(samples);
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

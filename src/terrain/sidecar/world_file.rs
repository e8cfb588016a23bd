//! World files: six numbers, the transform of a raster.

use std::path::{Path, PathBuf};

use super::{Transform, number, refused, text_of, with_extension};
use crate::terrain::TerrainError;

/// The world files beside a raster: for `dem.tif` the files `dem.tfw`, `dem.tifw` and `dem.wld`.
pub(super) fn beside(path: &Path) -> Vec<PathBuf> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned()).unwrap_or_default();
    let mut letters = extension.chars();
    let short: Option<String> = match (letters.next(), letters.next_back()) {
        (Some(first), Some(last)) => Some([first, last, 'w'].into_iter().collect()),
        _ => None,
    };
    let long = (!extension.is_empty()).then(|| format!("{extension}w"));
    [short, long, Some("wld".to_owned())].into_iter().flatten().filter_map(|extension| with_extension(path, &extension)).collect()
}

/// The lines of a world file are a, d, b, e, c, f: x = a i + b j + c and y = d i + e j + f, at the centres of the posts.
///
/// # Errors
/// [`TerrainError::Sidecar`] if the text has not six numbers.
pub(super) fn read(path: &Path) -> Result<Transform, TerrainError> {
    let text = text_of(path)?;
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let &[a, d, b, e, c, f] = &words[..] else {
        return Err(refused(
            path,
            format!(
                "{} numbers, expected the six lines of a world file; correct it, or move it away if it is not a world file",
                words.len()
            ),
        ));
    };
    let mut transform = [0.0; 6];
    for (value, word) in transform.iter_mut().zip([a, b, c, d, e, f]) {
        *value = number("line", word).map_err(|problem| refused(path, problem))?;
    }
    Ok(transform)
}

//! The names of files in results.

use std::path::Path;

use chta::study::open;

use crate::cli::inputs;

/// A file's path relative to the working folder. What came through a pipe keeps the name it was given under, such as `-`.
pub(crate) fn relative_name(path: &Path) -> String {
    match inputs::given_name(path) {
        Some(given) => given.to_string_lossy().into_owned(),
        None => open::relative_name(path),
    }
}

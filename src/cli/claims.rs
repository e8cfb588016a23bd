//! Which files a command reads and which it writes: never the same one, and no two answers into one file.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use same_file::Handle;

use super::Failure;

/// What this run reads. Handles, so that a link or another name for the same file is known too.
static READ: Mutex<Vec<Handle>> = Mutex::new(Vec::new());

/// What this run writes, by folder and name.
static WRITTEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Notes a file that is read. One that cannot be opened is told of by whoever reads it.
pub(crate) fn reads(path: &Path) {
    if let Ok(handle) = Handle::from_path(path) {
        READ.lock().unwrap_or_else(PoisonError::into_inner).push(handle);
    }
}

/// Lets a file that was read be written after all: a result that is repeated into its own place.
pub(crate) fn repeats(path: &Path) {
    if let Ok(handle) = Handle::from_path(path) {
        READ.lock().unwrap_or_else(PoisonError::into_inner).retain(|read| *read != handle);
    }
}

/// Notes a file that will be written.
///
/// # Errors
/// Where this run reads it, or writes it already. A device or a pipe takes whatever is written to it.
pub(crate) fn writes(path: &Path) -> Result<(), Failure> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file()) {
        return Ok(());
    }
    let name = path.display();
    let handle = Handle::from_path(path).ok();
    if handle.is_some_and(|handle| READ.lock().unwrap_or_else(PoisonError::into_inner).contains(&handle)) {
        return Err(Failure::message(format!(
            "{name}: is read by this command and would be overwritten by it: choose another file to write"
        )));
    }
    let place = place_of(path);
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if written.contains(&place) {
        return Err(Failure::message(format!("{name}: found as the file of two answers: give each a file of its own")));
    }
    written.push(place);
    Ok(())
}

/// A path by its real folder, or by the real file where it is a link.
fn place_of(path: &Path) -> PathBuf {
    if let Ok(file) = fs::canonicalize(path) {
        return file;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::canonicalize(folder).ok().zip(path.file_name()).map_or_else(|| path.to_path_buf(), |(folder, name)| folder.join(name))
}

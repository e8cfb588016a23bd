//! The files that a command reads and writes. It never writes a file that it reads, nor two answers into one file.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use same_file::Handle;

use super::Failure;

/// The files that this run reads, as handles, so that links and other names of the same file are recognised.
static READ: Mutex<Vec<Handle>> = Mutex::new(Vec::new());

/// The files that this run writes, by folder and name.
static WRITTEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Records a file that is read. Errors on opening it are reported by its reader.
pub(crate) fn reads(path: &Path) {
    if let Ok(handle) = Handle::from_path(path) {
        READ.lock().unwrap_or_else(PoisonError::into_inner).push(handle);
    }
}

/// Permits writing a file that was read: a result that is repeated into its own folder.
pub(crate) fn repeats(path: &Path) {
    if let Ok(handle) = Handle::from_path(path) {
        READ.lock().unwrap_or_else(PoisonError::into_inner).retain(|read| *read != handle);
    }
}

/// Records a file that will be written.
///
/// # Errors
/// If this run reads the file or already writes it. Devices and pipes are exempt.
pub(crate) fn writes(path: &Path) -> Result<(), Failure> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file()) {
        return Ok(());
    }
    let name = path.display();
    let handle = Handle::from_path(path).ok();
    if handle.is_some_and(|handle| READ.lock().unwrap_or_else(PoisonError::into_inner).contains(&handle)) {
        return Err(Failure::message(format!(
            "{name}: this command reads the file and would overwrite it: choose another file to write"
        )));
    }
    let place = place_of(path);
    let mut written = WRITTEN.lock().unwrap_or_else(PoisonError::into_inner);
    if written.contains(&place) {
        return Err(Failure::message(format!("{name}: two answers would be written to this file: give each its own file")));
    }
    written.push(place);
    Ok(())
}

/// A path with its folder resolved, or the target where the path is a link.
fn place_of(path: &Path) -> PathBuf {
    if let Ok(file) = fs::canonicalize(path) {
        return file;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::canonicalize(folder).ok().zip(path.file_name()).map_or_else(|| path.to_path_buf(), |(folder, name)| folder.join(name))
}

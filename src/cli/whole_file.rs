//! Atomic file writes: a file is written completely or not at all.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The temporary files not yet renamed to their final paths.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A file being written, which appears completely or not at all: it is written to a temporary file in the same folder and then
/// renamed.
///
/// An existing target that is not a regular file (a device, a pipe) is written to directly, since renaming would replace it; a
/// symbolic link is followed. If it is dropped before [`keep`](Self::keep), nothing is left behind.
#[derive(Debug)]
pub(crate) struct WholeFile(Place);

#[derive(Debug)]
enum Place {
    Direct(fs::File),
    Beside { temporary: tempfile::NamedTempFile, target: PathBuf, listed: Listed },
}

/// A temporary file's entry in the list of unfinished files, for as long as it exists.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A panic in another thread cannot leave the set of names inconsistent.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files of all unfinished writes, for a program that exits without returning, such as on an interrupt.
///
/// No file can be opened or finished after that: any thread that tries waits for the end of the program.
pub(crate) fn abandon_unfinished() {
    let names = unfinished();
    for name in names.iter() {
        // Already renamed or removed: nothing is left behind either way.
        let _ = fs::remove_file(name);
    }
    std::mem::forget(names);
}

impl WholeFile {
    /// Opens it, so that a path that cannot be written is reported before the computation begins.
    ///
    /// # Errors
    /// An error of the file system.
    pub(crate) fn begin(path: &Path) -> io::Result<Self> {
        if fs::metadata(path).is_ok_and(|meta| !meta.is_file()) {
            return Ok(Self(Place::Direct(fs::OpenOptions::new().write(true).open(path)?)));
        }
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        // It is listed before any other step can fail; an interrupt waits for this lock.
        let mut names = unfinished();
        let temporary = temporary_in(folder)?;
        names.insert(temporary.path().to_path_buf());
        let listed = Listed(temporary.path().to_path_buf());
        Ok(Self(Place::Beside { temporary, target, listed }))
    }

    /// Writes its bytes.
    ///
    /// # Errors
    /// An error of the file system.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.0 {
            Place::Direct(file) => file.write_all(bytes),
            Place::Beside { temporary, .. } => {
                // Errors of the file itself do not contain the temporary name, which means nothing to the user and changes every
                // time.
                let file = temporary.as_file_mut();
                file.write_all(bytes)?;
                file.sync_all()
            }
        }
    }

    /// A second handle on it, for a streaming writer; call [`keep`](Self::keep) when that writer is done.
    ///
    /// # Errors
    /// An error of the file system.
    pub(crate) fn handle(&self) -> io::Result<fs::File> {
        match &self.0 {
            Place::Direct(file) => file.try_clone(),
            Place::Beside { temporary, .. } => temporary.as_file().try_clone(),
        }
    }

    /// Renames it to its final path.
    ///
    /// # Errors
    /// An error of the file system; an existing file is left unchanged.
    pub(crate) fn keep(self) -> io::Result<()> {
        match self.0 {
            Place::Direct(_) => Ok(()),
            Place::Beside { temporary, target, listed } => {
                let names = unfinished();
                let kept = temporary.persist(target).map(|_| ()).map_err(|error| error.error);
                drop(names);
                drop(listed);
                kept
            }
        }
    }
}

/// A temporary file with the default permissions of a new file; on failure the system's error, without the temporary name.
fn temporary_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut of_the_system = None;
    let open = |path: &Path| {
        let opened = fs::OpenOptions::new().read(true).write(true).create_new(true).open(path);
        of_the_system = opened.as_ref().err().and_then(io::Error::raw_os_error);
        opened
    };
    let made = tempfile::Builder::new().prefix(".chta-").make_in(folder, open);
    made.map_err(|error| of_the_system.map_or_else(|| io::Error::from(error.kind()), io::Error::from_raw_os_error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = WholeFile::begin(path)?;
        file.write(bytes)?;
        file.keep()
    }

    #[test]
    fn an_old_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.json");
        write_whole(&path, b"old").unwrap();
        write_whole(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file was left behind");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_an_abandoned_file_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, b"old").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        let mut given_up = WholeFile::begin(&link).unwrap();
        given_up.write(b"half").unwrap();
        drop(given_up);
        assert_eq!(fs::read(&target).unwrap(), b"old");
        write_whole(&link, b"new").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink(), "the link was replaced by a file");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_whole(&folder.path().join("no/such/file"), b"x").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
        assert!(!error.to_string().contains(".chta-"), "{error} names a temporary file");
    }
}

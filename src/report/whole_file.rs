//! Files are written whole or not at all.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The temporary files that have not taken their places.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A file being written, which takes its place whole or not at all: it is written beside its place first, then renamed into it.
///
/// A place that exists and is no regular file (a device, a pipe) is written to directly, since renaming would replace it; a symbolic
/// link is followed. Dropped before [`keep`](Self::keep), nothing is left behind.
#[derive(Debug)]
pub struct WholeFile(Place);

#[derive(Debug)]
enum Place {
    Direct(fs::File),
    Beside { temporary: tempfile::NamedTempFile, target: PathBuf, listed: Listed },
}

/// A temporary file's entry among the unfinished, for as long as it lives.
#[derive(Debug)]
struct Listed(PathBuf);

impl Drop for Listed {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of names is whole whoever panicked beside it.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what is left of every file under way, for a program that ends without returning (on an interrupt, say).
///
/// No file can be begun or put in its place after that: whoever tries waits for the end of the program.
pub fn abandon_unfinished() {
    let names = unfinished();
    for name in names.iter() {
        // Already in its place, or gone: nothing is left of it either way.
        let _ = fs::remove_file(name);
    }
    std::mem::forget(names);
}

impl WholeFile {
    /// Opens it, so that a place that cannot be written to is known before the work begins.
    ///
    /// # Errors
    /// What the file system says.
    pub fn begin(path: &Path) -> io::Result<Self> {
        if fs::metadata(path).is_ok_and(|meta| !meta.is_file()) {
            return Ok(Self(Place::Direct(fs::OpenOptions::new().write(true).open(path)?)));
        }
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        // Listed before anything else can happen to it: an interrupt waits here.
        let mut names = unfinished();
        let temporary = temporary_in(folder)?;
        names.insert(temporary.path().to_path_buf());
        let listed = Listed(temporary.path().to_path_buf());
        Ok(Self(Place::Beside { temporary, target, listed }))
    }

    /// Writes its bytes.
    ///
    /// # Errors
    /// What the file system says.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.0 {
            Place::Direct(file) => file.write_all(bytes),
            Place::Beside { temporary, .. } => {
                // The file itself: its errors do not name it, which would tell the user nothing and differ every time.
                let file = temporary.as_file_mut();
                file.write_all(bytes)?;
                file.sync_all()
            }
        }
    }

    /// A second handle on it, for a writer that streams; [`keep`](Self::keep) follows when that writer is done.
    ///
    /// # Errors
    /// What the file system says.
    pub fn handle(&self) -> io::Result<fs::File> {
        match &self.0 {
            Place::Direct(file) => file.try_clone(),
            Place::Beside { temporary, .. } => temporary.as_file().try_clone(),
        }
    }

    /// Puts it in its place.
    ///
    /// # Errors
    /// What the file system says; a file that was there before stays as it was.
    pub fn keep(self) -> io::Result<()> {
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

/// Writes a file whole or not at all, in one go.
///
/// # Errors
/// What the file system says; then no part of the file is left behind, and one that was there before stays as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = WholeFile::begin(path)?;
    file.write(bytes)?;
    file.keep()
}

/// A temporary file with the permissions that any new file would get. Where there is none, the system's own error, without its name.
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
    fn a_link_is_followed_and_a_file_given_up_leaves_nothing() {
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

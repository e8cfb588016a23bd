//! Files are written whole or not at all.

use std::{
    fs,
    io::{self, Write},
    path::Path,
};

/// Writes a file whole or not at all: beside its place first, then renamed into it.
///
/// A place that exists and is no regular file (a device, a pipe) is written to directly, since renaming would replace it.
///
/// # Errors
/// What the file system says; then no part of the file is left behind, and one that was there before stays as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if fs::metadata(path).is_ok_and(|meta| !meta.is_file()) {
        return fs::OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = builder().tempfile_in(folder).map_err(|error| without_temporary_name(&error))?;
    file.write_all(bytes).map_err(|error| without_temporary_name(&error))?;
    file.as_file().sync_all()?;
    file.persist(path).map(|_| ()).map_err(|error| error.error)
}

/// The system's own error, without the name of a temporary file, which tells the user nothing and differs every time.
fn without_temporary_name(error: &io::Error) -> io::Error {
    let text = error.to_string();
    let system = text.split_once(" at path ").map_or(text.as_str(), |(system, _)| system);
    io::Error::new(error.kind(), system)
}

/// Temporary files with the permissions that any new file would get.
#[cfg(unix)]
fn builder() -> tempfile::Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;

    let mut builder = tempfile::Builder::new();
    builder.prefix(".chta-").permissions(fs::Permissions::from_mode(0o666));
    builder
}

/// Temporary files as the platform makes them.
#[cfg(not(unix))]
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".chta-");
    builder
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

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_whole(&folder.path().join("no/such/file"), b"x").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
        assert!(!error.to_string().contains(".chta-"), "{error} names a temporary file");
    }
}

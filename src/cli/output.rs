//! Data to standard output or to files, talk to standard error.

use std::{
    io::{self, ErrorKind, Write},
    path::Path,
};

use chta::{report::write_whole, terrain::MapProjection};

use super::Failure;

/// Writes data to standard output. A reader who closed the pipe is no error.
pub(crate) fn to_stdout(data: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(data).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::message(format!(
            "standard output: cannot be written ({error}): free some space or choose -o FILE elsewhere"
        ))),
        _ => Ok(()),
    }
}

/// Writes a file whole or not at all.
pub(crate) fn to_file(path: &Path, data: &[u8]) -> Result<(), Failure> {
    write_whole(path, data).map_err(|error| {
        let help = "choose a folder that exists, may be written to and has space left";
        Failure::message(format!("{}: cannot be written ({error}): {help}", path.display()))
    })
}

/// Writes to a file, or to standard output where that is `-` or absent.
pub(crate) fn to_file_or_stdout(path: Option<&Path>, data: &[u8]) -> Result<(), Failure> {
    match path {
        Some(path) if path != Path::new("-") => to_file(path, data),
        _ => to_stdout(data),
    }
}

/// Writes a GeoJSON file and, where no code of an authority says its reference system, that as well-known text in a `.prj` beside it.
pub(crate) fn to_geojson_file(path: &Path, geojson: &str, projection: Option<&MapProjection>) -> Result<(), Failure> {
    to_file(path, geojson.as_bytes())?;
    match projection.filter(|projection| projection.code().is_none()) {
        Some(projection) => to_file(&path.with_extension("prj"), (projection.wkt() + "\n").as_bytes()),
        None => Ok(()),
    }
}

/// Says a warning on standard error.
pub(crate) fn warn(quiet: bool, warning: &str) {
    if !quiet {
        // Nobody to tell where standard error is closed.
        let _ = writeln!(io::stderr(), "warning: {warning}");
    }
}

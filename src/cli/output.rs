//! Data goes to standard output or to files, messages to standard error.

use std::{
    borrow::Cow,
    fs::File,
    io::{self, ErrorKind, Write},
    path::Path,
    time::Duration,
};

use chta::{
    figure::{FigureError, Picture, PictureFormat},
    report::{Document, SizeAnswer},
    terrain::MapProjection,
};

use super::{Answer, Failure, args::Format, claims, inputs, interrupt, pictures, verbose, whole_file::WholeFile};

/// Writes data to standard output. A closed pipe is not an error.
pub(crate) fn to_stdout(data: &[u8]) -> Result<(), Failure> {
    interrupt::check()?;
    let mut out = io::stdout().lock();
    match out.write_all(data).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::message(format!(
            "standard output: cannot be written ({error}): free some space or choose -o FILE elsewhere"
        ))),
        _ => Ok(()),
    }
}

/// A file to be written at the end, opened before the computation begins.
#[derive(Debug)]
pub(crate) struct Pending<'a> {
    path: Cow<'a, Path>,
    file: WholeFile,
}

impl<'a> Pending<'a> {
    /// Opens it.
    pub(crate) fn begin(path: impl Into<Cow<'a, Path>>) -> Result<Self, Failure> {
        let path = path.into();
        let file = WholeFile::begin(&path).map_err(|error| unwritable(&path, &error))?;
        claims::writes(&path)?;
        Ok(Self { path, file })
    }

    /// Its final path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A handle for a streaming writer.
    pub(crate) fn handle(&self) -> Result<File, Failure> {
        self.file.handle().map_err(|error| unwritable(&self.path, &error))
    }

    /// Renames the streamed file to its final path.
    pub(crate) fn keep(self) -> Result<(), Failure> {
        interrupt::check()?;
        self.file.keep().map_err(|error| unwritable(&self.path, &error))?;
        verbose::say(|| format!("wrote {}", self.path.display()));
        Ok(())
    }
}

/// Opens the picture file of an option, if it is given, before the computation begins, after checking its extension.
pub(crate) fn begin_picture<'a>(option: &str, path: Option<&'a Path>) -> Result<Option<Pending<'a>>, Failure> {
    let Some(path) = path else { return Ok(None) };
    check_picture(option, path)?;
    Pending::begin(path).map(Some)
}

/// Checks that a picture file has the extension of a format; a device or pipe needs none and gets SVG.
pub(crate) fn check_picture(option: &str, path: &Path) -> Result<(), Failure> {
    picture_format(path).map(drop).map_err(|error| Failure::message(format!("{option}: {error}")))
}

/// The format of a picture file.
pub(super) fn picture_format(path: &Path) -> Result<PictureFormat, FigureError> {
    let special = path.extension().is_none() && path.exists() && !path.is_file() && !path.is_dir();
    if special { Ok(PictureFormat::Svg) } else { PictureFormat::of(path) }
}

/// A picture of one page as the bytes of its file, in the format of the file's extension.
pub(crate) fn encoded(drawn: Result<Picture, FigureError>, file: &Path) -> Result<Vec<u8>, Failure> {
    drawn
        .and_then(pictures::in_width)
        .and_then(|picture| picture.encoded(picture_format(file)?))
        .map_err(|error| Failure::message(error.to_string()))
}

/// The format of a table, by its file's extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TableFormat {
    /// Comma-separated values; also the format on standard output in place of the answer.
    Csv,
    /// One JSON document.
    Json,
}

impl TableFormat {
    /// By the extension, `.csv` or `.json`; `-`: CSV.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("csv") => Ok(Self::Csv),
            Some("json") => Ok(Self::Json),
            _ if path == Path::new("-") => Ok(Self::Csv),
            _ => Err(Failure::message(format!("-o {}: expected a file that ends in .csv or .json, or -", path.display()))),
        }
    }
}

/// Writes all files or none: first all as temporary files, then it renames them to their final paths.
pub(crate) fn finish(mut files: Vec<(Pending<'_>, Vec<u8>)>) -> Result<(), Failure> {
    interrupt::check()?;
    for (pending, bytes) in &mut files {
        pending.file.write(bytes).map_err(|error| unwritable(&pending.path, &error))?;
    }
    for (Pending { path, file }, _) in files {
        file.keep().map_err(|error| unwritable(&path, &error))?;
        verbose::say(|| format!("wrote {}", path.display()));
    }
    Ok(())
}

/// Writes a file whole or not at all.
pub(crate) fn to_file(path: &Path, data: &[u8]) -> Result<(), Failure> {
    finish(vec![(Pending::begin(path)?, data.to_vec())])
}

/// Checks before a long computation that files can be created in a folder, or in its nearest existing ancestor.
pub(crate) fn check_folder(folder: &Path) -> Result<(), Failure> {
    let existing = folder.ancestors().find(|ancestor| ancestor.exists()).unwrap_or(Path::new("."));
    // A file at that path is reported when the folder is created.
    if existing.is_file() {
        return Ok(());
    }
    let existing = if existing.as_os_str().is_empty() { Path::new(".") } else { existing };
    WholeFile::begin(&existing.join(".chta-probe")).map(drop).map_err(|error| unwritable(folder, &error))
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let help = "choose a folder that exists, may be written to and has space left";
    Failure::message(format!("{}: cannot be written ({error}): {help}", path.display()))
}

/// Writes to a file, or to standard output where that is `-` or absent.
pub(crate) fn to_file_or_stdout(path: Option<&Path>, data: &[u8]) -> Result<(), Failure> {
    match path {
        Some(path) if path != Path::new("-") => to_file(path, data),
        _ => to_stdout(data),
    }
}

/// The content of a `.prj` beside a GeoJSON: the reference system as well-known text, where it has no authority code.
pub(crate) fn prj(projection: Option<&MapProjection>) -> Option<Vec<u8>> {
    projection.filter(|known| known.code().is_none()).map(|known| (known.wkt() + "\n").into_bytes())
}

/// Writes a GeoJSON file, with its `.prj` where it needs one.
pub(crate) fn to_geojson_file(path: &Path, geojson: &str, projection: Option<&MapProjection>) -> Result<(), Failure> {
    let beside = path.with_extension("prj");
    let mut files = vec![(Pending::begin(path)?, geojson.as_bytes().to_vec())];
    if let Some(text) = prj(projection) {
        files.push((Pending::begin(beside)?, text));
    }
    finish(files)
}

/// Prints the answer to a question of size.
pub(crate) fn sized(document: &Document<SizeAnswer>, format: Format) -> Result<Answer, Failure> {
    let text = match format {
        Format::Text => document.answer.text(),
        Format::Json => document.to_json()?,
    };
    to_stdout(text.as_bytes())?;
    Ok(Answer::Yes)
}

/// Prints warnings on standard error.
pub(crate) fn warn_all(quiet: bool, warnings: &[String]) {
    for warning in warnings {
        warn(quiet, warning);
    }
}

/// Prints the warnings of all parts on standard error, and returns them.
pub(crate) fn warned(quiet: bool, parts: &[&[String]]) -> Vec<String> {
    let warnings = parts.concat();
    warn_all(quiet, &warnings);
    warnings
}

/// Prints how long a computation took on standard error.
pub(crate) fn say_run_time(quiet: bool, time: Duration) {
    if !quiet {
        // An error on writing to standard error cannot be reported.
        let _ = writeln!(io::stderr(), "process_s: {:.6}", time.as_secs_f64());
    }
}

/// Prints a warning on standard error.
pub(crate) fn warn(quiet: bool, warning: &str) {
    if !quiet {
        // An error on writing to standard error cannot be reported.
        let _ = writeln!(io::stderr(), "warning: {}", inputs::shown(warning));
    }
}

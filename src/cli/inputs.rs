//! The files that a command reads: each is looked at before anything else, so that a missing file, or one that is something else, is
//! reported first. A pipe is read once, into a temporary file that stands in for it.

use std::{
    fs::{self, File},
    io::{self, Read, Write},
    path::{Path, PathBuf},
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};

use chta::scenario::FileKind;
use tempfile::TempDir;

use super::{
    Failure,
    args::CommonArgs,
    interrupt, verbose,
    wrong_thing::{Role, refusal},
};

/// Why the file of a key cannot be used.
#[derive(Debug)]
pub(crate) struct KeyProblem {
    /// What was found and expected.
    pub(crate) found: String,
    /// How to mend it.
    pub(crate) help: String,
    /// Whether it cannot be read at all; else it is something else than asked for.
    pub(crate) is_unreadable: bool,
}

/// Bytes in a GiB.
const GIB: f64 = 1_073_741_824.0;

/// How many GiB of an input are read unless an option says otherwise: more than any DEM of the planets that comes through a pipe.
pub(crate) const DEFAULT_MAX_GIB: f64 = 8.0;

/// The most bytes read from a pipe, and from a file that is read whole.
static MAX_BYTES: AtomicU64 = AtomicU64::new(8 << 30);

/// The longest line of a table or a mesh: a full row takes some 500 bytes.
const LONGEST_LINE: u64 = 1 << 20;

/// The longest line of an ASCII grid, which may have all its values in one.
const LONGEST_GRID_LINE: u64 = 1 << 26;

/// The most bytes of a scenario or result, and of a GeoJSON, as their readers take them.
const LARGEST_SCENARIO: u64 = 1 << 24;
const LARGEST_GEOJSON: u64 = 1 << 30;

/// The most bytes of content of no known format whose reader is still asked what is wrong with it: it reads all of them.
const LARGEST_UNKNOWN: u64 = 1 << 30;

/// A file that was looked at.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// Its name as given.
    pub(crate) given: PathBuf,
    /// The file to read: the same, or what stands in for a pipe.
    pub(crate) file: PathBuf,
    /// What it is.
    pub(crate) kind: FileKind,
}

impl Input {
    /// Whether it came through a pipe.
    pub(crate) fn is_stream(&self) -> bool {
        self.given != self.file
    }

    /// Whether it is to be read as a scenario or result: by content, else by its extension.
    pub(crate) fn is_scenario(&self) -> bool {
        match self.kind {
            FileKind::Scenario | FileKind::Result | FileKind::Json => true,
            FileKind::ChainCsv => false,
            _ => ["toml", "json"].iter().any(|known| self.has_extension(known)),
        }
    }

    /// Whether it is an elevation raster.
    pub(crate) const fn is_raster(&self) -> bool {
        matches!(self.kind, FileKind::Raster(_) | FileKind::ForeignRaster(_) | FileKind::Points(_) | FileKind::Picture(_))
    }

    /// Whether it is a result, in JSON.
    pub(crate) fn is_result(&self) -> bool {
        matches!(self.kind, FileKind::Result | FileKind::Json) || (self.kind != FileKind::Scenario && self.has_extension("json"))
    }

    fn has_extension(&self, known: &str) -> bool {
        self.given.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(known))
    }
}

/// A pipe that was read, and where.
#[derive(Debug)]
struct Stream {
    input: Input,
    role: Role,
}

/// The pipes that this run has read.
static STREAMS: Mutex<Vec<Stream>> = Mutex::new(Vec::new());

/// The folders of what stands in for them; they are removed at the end.
static FOLDERS: Mutex<Vec<TempDir>> = Mutex::new(Vec::new());

fn lock<T>(list: &Mutex<T>) -> MutexGuard<'_, T> {
    // A panic in another thread cannot leave a list inconsistent.
    list.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what stands in for pipes.
pub(crate) fn forget() {
    lock(&FOLDERS).clear();
}

/// Looks at the files of a command line before everything else: first whether all can be read, then what they are.
///
/// `max_gib` is the most that is read from a pipe.
pub(crate) fn look_at(max_gib: f64, files: &[(Option<&Path>, Role)]) -> Result<(), Failure> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the option is checked; the cast saturates beyond"
    )]
    MAX_BYTES.store((max_gib * GIB) as u64, Ordering::Relaxed);
    let given = || files.iter().filter_map(|(path, role)| Some((((*path)?), *role)));
    for (path, role) in given() {
        check_readable(path).map_err(|reason| unreadable(path, &reason, role))?;
    }
    given().try_for_each(|(path, role)| open(path, role).map(drop))
}

/// Looks at the files of a command that analyses a chain, with the scenario of the options beside it.
pub(crate) fn look_at_chain(chain: &Path, common: &CommonArgs) -> Result<(), Failure> {
    look_at(common.input_max_gib, &[(Some(chain), Role::Chain), (common.scenario.as_deref(), Role::ScenarioOption)])
}

/// The same for the terrain of one hop.
pub(crate) fn look_at_hop(terrain: &Path, common: &CommonArgs) -> Result<(), Failure> {
    look_at(common.input_max_gib, &[(Some(terrain), Role::HopTerrain), (common.scenario.as_deref(), Role::ScenarioOption)])
}

/// The same with a file of pairs.
pub(crate) fn look_at_pairs(chain: &Path, common: &CommonArgs, pairs: Option<&Path>) -> Result<(), Failure> {
    let files = [(Some(chain), Role::Chain), (common.scenario.as_deref(), Role::ScenarioOption), (pairs, Role::Pairs)];
    look_at(common.input_max_gib, &files)
}

/// Looks at several scenarios, of which no two may be the same pipe: the second reading would find nothing.
pub(crate) fn look_at_scenarios(max_gib: f64, scenarios: &[PathBuf]) -> Result<(), Failure> {
    look_at_all(max_gib, scenarios, Role::Scenario)
}

/// The same for several results.
pub(crate) fn look_at_results(max_gib: f64, results: &[PathBuf]) -> Result<(), Failure> {
    look_at_all(max_gib, results, Role::Result)
}

fn look_at_all(max_gib: f64, scenarios: &[PathBuf], role: Role) -> Result<(), Failure> {
    for (i, file) in scenarios.iter().enumerate() {
        if is_stream(file) && scenarios[..i].iter().any(|other| same_stream(other, file)) {
            return Err(Failure::message(format!(
                "{}: found twice as {}, but what comes through a pipe is read only once: give one of the two as a file",
                file.display(),
                role.name()
            )));
        }
    }
    let files: Vec<_> = scenarios.iter().map(|file| (Some(file.as_path()), role)).collect();
    look_at(max_gib, &files)
}

/// Looks at a file for a position: what it is, and whether the position takes that.
pub(crate) fn open(path: &Path, role: Role) -> Result<Input, Failure> {
    check_readable(path).map_err(|reason| unreadable(path, &reason, role))?;
    if is_stream(path) {
        return of_stream(path, role);
    }
    let read = |error: io::Error| unreadable(path, &error.to_string(), role);
    let kind = FileKind::of(path).map_err(read)?;
    check_kind(&kind, role, path)?;
    let length = fs::metadata(path).map_err(read)?.len();
    let is_read_blindly =
        matches!(role, Role::Chain | Role::HopTerrain | Role::ChainKey | Role::Pairs | Role::Starts | Role::MeshKey);
    if matches!(kind, FileKind::Text | FileKind::Binary) && is_read_blindly && length > LARGEST_UNKNOWN {
        let mut beginning = Vec::new();
        File::open(path).and_then(|file| file.take(24).read_to_end(&mut beginning)).map_err(read)?;
        return Err(unknown(path, &kind, role, &beginning));
    }
    if is_read_whole(&kind) && length > max_bytes() {
        return Err(too_large(path, &format!("{:.1} GiB", gib(length))));
    }
    verbose::read(path);
    Ok(Input { given: path.to_path_buf(), file: path.to_path_buf(), kind })
}

/// The name that a file was given under: that of the pipe it stands in for.
pub(crate) fn given_name(file: &Path) -> Option<PathBuf> {
    lock(&STREAMS).iter().find(|stream| stream.input.file == file).map(|stream| stream.input.given.clone())
}

/// A text for the user with the names of pipes in place of what stands in for them.
pub(crate) fn shown(text: &str) -> String {
    let mut shown = text.to_owned();
    for Stream { input, .. } in lock(&STREAMS).iter() {
        shown = shown.replace(&input.file.display().to_string(), &input.given.display().to_string());
    }
    shown
}

/// Whether a path is standard input, a pipe or a device, which can be read only once.
pub(crate) fn is_stream(path: &Path) -> bool {
    path == Path::new("-") || fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir())
}

/// Why a file cannot be read; a pipe is not opened for that.
fn check_readable(path: &Path) -> Result<(), String> {
    if is_stream(path) {
        return Ok(());
    }
    let reason = |error: io::Error| match fs::read_link(path) {
        Ok(target) if error.kind() == io::ErrorKind::NotFound => {
            format!("it is a link to {}, which does not exist", target.display())
        }
        _ => error.to_string(),
    };
    let mut file = File::open(path).map_err(reason)?;
    // A folder can be opened, but not read.
    file.read(&mut [0]).map(drop).map_err(|error| error.to_string())
}

/// The sentence for a file that cannot be read.
pub(crate) fn unreadable(path: &Path, reason: &str, role: Role) -> Failure {
    let (name, expected) = (path.display(), role.expected());
    Failure::message(format!("{name}: cannot be read ({reason}), expected {expected}: {}", readable_help(path)))
}

/// How to mend a path that cannot be read.
fn readable_help(path: &Path) -> String {
    let text = path.display().to_string();
    if path.is_dir() {
        "check the path: give a file in that folder".to_owned()
    } else if cfg!(not(windows)) && text.contains('\\') {
        format!("check the path: on this system / stands between folders: {}", text.replace('\\', "/"))
    } else {
        "check the path and its permissions".to_owned()
    }
}

/// Refuses a file that is something else than its position asks for.
fn check_kind(kind: &FileKind, role: Role, path: &Path) -> Result<(), Failure> {
    match wrong_kind(kind, role, path) {
        None => Ok(()),
        Some((found, mend)) => Err(Failure::message(format!("{}: {found}: {mend}", path.display()))),
    }
}

/// What is wrong with a file of this kind in this position, and how to mend it.
fn wrong_kind(kind: &FileKind, role: Role, path: &Path) -> Option<(String, String)> {
    if *kind == FileKind::Empty && !matches!(role, Role::Chain | Role::HopTerrain | Role::ChainKey | Role::Pairs) {
        let found = format!("the file is empty; expected {} as {}", role.expected(), role.name());
        return Some((found, "was it written, copied or piped to its end?".to_owned()));
    }
    (!role.takes(kind)).then(|| refusal(kind, role, path))
}

/// What a file that a key of a scenario names is, or its problem.
///
/// # Errors
/// The failure of a pipe.
pub(crate) fn of_key(path: &Path, role: Role) -> Result<Result<Input, KeyProblem>, Failure> {
    if let Err(reason) = check_readable(path) {
        let found = format!("{} is {}, which cannot be read ({reason}); expected {}", role.name(), path.display(), role.expected());
        return Ok(Err(KeyProblem { found, help: readable_help(path), is_unreadable: true }));
    }
    if !is_stream(path) {
        let kind = FileKind::of(path).unwrap_or(FileKind::Binary);
        if let Some((found, help)) = wrong_kind(&kind, role, path) {
            let found = format!("{}: {found}", path.display());
            return Ok(Err(KeyProblem { found, help, is_unreadable: false }));
        }
    }
    open(path, role).map(Ok)
}

/// Reads a pipe into a temporary file, once.
fn of_stream(path: &Path, role: Role) -> Result<Input, Failure> {
    let name = path.display();
    let known =
        lock(&STREAMS).iter().find(|stream| same_stream(&stream.input.given, path)).map(|known| (known.input.clone(), known.role));
    match known {
        Some((input, first)) if first == role => return Ok(input),
        Some((_, first)) => {
            return Err(Failure::message(format!(
                "{name}: found for both {} and {}, but what comes through a pipe is read only once: give one of the two as a file",
                first.name(),
                role.name()
            )));
        }
        None => {}
    }
    let failed = |error: io::Error| unreadable(path, &error.to_string(), role);
    let folder = tempfile::Builder::new().prefix(".chta-").tempdir().map_err(|error| not_kept(path, &error))?;
    let file = folder.path().join(path.file_name().unwrap_or(path.as_os_str()));
    // Listed before it is filled, so that an interrupt removes it.
    lock(&FOLDERS).push(folder);
    let mut source: Box<dyn Read> =
        if path == Path::new("-") { Box::new(io::stdin().lock()) } else { Box::new(File::open(path).map_err(failed)?) };
    let mut beginning = Vec::new();
    (&mut source).take(FileKind::PROBE_BYTES as u64).read_to_end(&mut beginning).map_err(failed)?;
    let ended = beginning.len() < FileKind::PROBE_BYTES;
    let kind = FileKind::of_beginning(&beginning, ended.then_some(beginning.len() as u64), path);
    check_kind(&kind, role, path)?;
    if !ended && matches!(kind, FileKind::Text | FileKind::Binary) {
        return Err(unknown(path, &kind, role, &beginning));
    }
    if let Some(image) = detached_image(&kind, &beginning) {
        return Err(Failure::message(format!(
            "{name}: this PDS3 label names its image, {image}, in its own folder, which a pipe does not have: give the label as a file \
             beside its image"
        )));
    }
    let mut copy = File::create(&file).map_err(|error| not_kept(path, &error))?;
    copy_bounded(beginning, &mut source, &mut copy, path, &Bounds::of(&kind, role))?;
    let input = Input { given: path.to_path_buf(), file, kind };
    lock(&STREAMS).push(Stream { input: input.clone(), role });
    verbose::read(&input.file);
    Ok(input)
}

/// Refuses content of no known format with its first bytes.
fn unknown(path: &Path, kind: &FileKind, role: Role, beginning: &[u8]) -> Failure {
    let shown: String = beginning.iter().take(24).flat_map(|&byte| std::ascii::escape_default(byte)).map(char::from).collect();
    Failure::message(format!(
        "{}: this is {} (it begins with '{shown}'); expected {} as {}: check what it holds",
        path.display(),
        kind.name(),
        role.expected(),
        role.name()
    ))
}

/// Whether two names mean the same pipe.
pub(crate) fn same_stream(a: &Path, b: &Path) -> bool {
    let is_standard_input =
        |path: &Path| ["-", "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"].iter().any(|name| path == Path::new(name));
    a == b || (is_standard_input(a) && is_standard_input(b))
}

/// How much of a pipe is read.
struct Bounds {
    most: u64,
    /// Why that is the bound.
    reason: String,
    longest_line: Option<u64>,
}

impl Bounds {
    /// By the kind of content. The bound of the option holds for all.
    fn of(kind: &FileKind, role: Role) -> Self {
        let option = max_bytes();
        let (own, what) = match kind {
            FileKind::Scenario | FileKind::Result => (LARGEST_SCENARIO, "a scenario has some kilobytes"),
            FileKind::Json if !matches!(role, Role::KeepOut | Role::KeepIn) => (LARGEST_SCENARIO, "a result has some megabytes"),
            FileKind::GeoJson | FileKind::Json => (LARGEST_GEOJSON, "simplify the polygons"),
            _ => (u64::MAX, ""),
        };
        let reason = if own < option {
            what.to_owned()
        } else {
            format!("is it endless? For more give --input-max-gib {}", (20.0 * gib(option)).ceil() / 10.0)
        };
        let longest_line = match kind {
            FileKind::Raster("ESRI ASCII grid") => Some(LONGEST_GRID_LINE),
            FileKind::Raster("XYZ grid")
            | FileKind::Mesh(_, true)
            | FileKind::ChainCsv
            | FileKind::PairsCsv
            | FileKind::PositionsCsv
            | FileKind::MeasuredCsv => Some(LONGEST_LINE),
            _ => None,
        };
        Self { most: own.min(option), reason, longest_line }
    }
}

/// Copies a pipe whose beginning was read, until its end or a bound.
fn copy_bounded(beginning: Vec<u8>, source: &mut dyn Read, copy: &mut File, path: &Path, bounds: &Bounds) -> Result<(), Failure> {
    let mut piece = beginning;
    let (mut total, mut line) = (0_u64, 0_u64);
    while !piece.is_empty() {
        interrupt::check()?;
        total += piece.len() as u64;
        if total > bounds.most {
            let Bounds { most, reason, .. } = bounds;
            let message =
                format!("{}: more than {} comes through the pipe, expected at most that: {reason}", path.display(), amount(*most));
            return Err(Failure::message(message));
        }
        if let Some(longest) = bounds.longest_line {
            for part in piece.split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
                line += part.len() as u64;
                if line > longest {
                    let message = format!(
                        "{}: a line of more than {} comes through the pipe, expected text with line ends: check what is piped",
                        path.display(),
                        amount(longest)
                    );
                    return Err(Failure::message(message));
                }
                if part.ends_with(b"\n") || part.ends_with(b"\r") {
                    line = 0;
                }
            }
        }
        copy.write_all(&piece).map_err(|error| not_kept(path, &error))?;
        piece.clear();
        let read = source.take(1 << 20).read_to_end(&mut piece);
        read.map_err(|error| Failure::message(format!("{}: cannot be read ({error}): check what is piped", path.display())))?;
    }
    copy.flush().map_err(|error| not_kept(path, &error))
}

/// The name of the image that a PDS3 label without it points to.
fn detached_image(kind: &FileKind, beginning: &[u8]) -> Option<String> {
    if *kind != FileKind::Raster("PDS3 image") {
        return None;
    }
    let text = String::from_utf8_lossy(beginning);
    let pointer = text.lines().map(str::trim).find(|line| line.to_ascii_uppercase().starts_with("^IMAGE"))?.to_owned();
    let name = pointer.split('"').nth(1)?.to_owned();
    Some(name)
}

/// Whether a file of this kind is read whole into memory.
fn is_read_whole(kind: &FileKind) -> bool {
    matches!(
        kind,
        FileKind::ChainCsv
            | FileKind::PairsCsv
            | FileKind::PositionsCsv
            | FileKind::MeasuredCsv
            | FileKind::Mesh(..)
            | FileKind::Raster("ESRI ASCII grid" | "XYZ grid")
    )
}

fn max_bytes() -> u64 {
    MAX_BYTES.load(Ordering::Relaxed)
}

#[expect(clippy::cast_precision_loss, reason = "a size for reading")]
fn gib(bytes: u64) -> f64 {
    bytes as f64 / GIB
}

/// A number of bytes for reading.
fn amount(bytes: u64) -> String {
    match bytes {
        1_073_741_824.. => format!("{} GiB", gib(bytes)),
        1_048_576.. => format!("{:.1} MiB", gib(bytes) * 1024.0),
        _ => format!("{bytes} bytes"),
    }
}

fn too_large(path: &Path, size: &str) -> Failure {
    Failure::message(format!(
        "{}: found {size}, expected at most {}, since this format is read whole into memory: cut it, convert it to GeoTIFF, or give \
         --input-max-gib",
        path.display(),
        amount(max_bytes())
    ))
}

/// A pipe that cannot be kept in a temporary file.
fn not_kept(path: &Path, error: &io::Error) -> Failure {
    Failure::message(format!(
        "{}: what comes through the pipe cannot be kept in {} ({error}): give the file itself, or set TMPDIR to a folder with more space",
        path.display(),
        std::env::temp_dir().display()
    ))
}

/// Reads a number of GiB.
pub(crate) fn max_gib(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|gib: &f64| *gib > 0.0 && *gib <= 1_048_576.0);
    number.ok_or_else(|| format!("found `{text}`, expected a number of GiB above 0 and at most 1048576, such as 16"))
}

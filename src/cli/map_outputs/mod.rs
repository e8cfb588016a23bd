//! The files that `map` writes: opened before the search, and written after it, all or none.

mod legs;
mod pictures;
mod profiles;
mod rasters;
mod travel;

use std::path::{Path, PathBuf};

use chta::{
    path::HopPath,
    report::{MapKnowledge, paths_geojson, write_paths_csv},
    study::map::{MapStudy, PreparedMap},
};

pub(crate) use legs::LegsMapOutputs;
pub(crate) use travel::TravelMapOutputs;

use super::{
    Failure,
    args::MapArgs,
    map_input::MapInput,
    output::{self, Pending},
};

/// The files of a map, opened.
#[derive(Debug)]
pub(crate) struct MapOutputs<'a> {
    opened: Vec<Pending<'a>>,
}

impl<'a> MapOutputs<'a> {
    /// Checks the extensions of all files and opens them.
    pub(crate) fn begin(args: &'a MapArgs) -> Result<Self, Failure> {
        check_extensions(args)?;
        let others = [&args.paths, &args.geojson, &args.profiles, &args.plot].into_iter().flatten().map(PathBuf::as_path);
        let files = rasters(args).filter_map(|(_, file)| file).chain(others);
        Ok(Self { opened: files.map(Pending::begin).collect::<Result<_, _>>()? })
    }

    /// Writes all files or none.
    pub(crate) fn write(self, args: &MapArgs, input: &MapInput, prepared: &PreparedMap, study: &MapStudy) -> Result<(), Failure> {
        let projection = prepared.projection.as_ref();
        let mut files: Vec<(PathBuf, Vec<u8>)> = rasters::encoded(args, input, prepared, study)?;
        if let Some(file) = &args.paths {
            let known = if projection.is_ok() { MapKnowledge::Projection } else { MapKnowledge::Metres };
            let mut csv = Vec::new();
            let goals = study.answer.goals.iter().map(|goal| &goal.path[..]);
            write_paths_csv(goals, known, &mut csv).map_err(|e| Failure::of(&e))?;
            files.push((file.clone(), csv));
        }
        if let Some(file) = &args.geojson {
            let none = HopPath { hops: Vec::new(), totals: chta::path::Totals::default() };
            let paths: Vec<&HopPath> = study.paths.iter().map(|path| path.as_ref().unwrap_or(&none)).collect();
            let gravity_m_s2 = input.bare.scenario.body.gravity.m_s2();
            let geojson = paths_geojson(&paths, gravity_m_s2, projection.ok()).unwrap_or_default();
            files.push((file.clone(), geojson.into_bytes()));
            files.extend(output::prj(projection.ok()).map(|text| (file.with_extension("prj"), text)));
        }
        if let Some(file) = &args.profiles {
            files.extend(profiles::pages(input, &study.goal_hops, projection.ok(), (file, args.profiles_from))?);
        }
        if let Some(file) = &args.plot {
            files.push((file.clone(), pictures::map(input, prepared, study, file)?));
        }
        finish(self.opened, &files)
    }
}

/// Writes all files or none; those that were not opened before are opened now.
fn finish(mut begun: Vec<Pending<'_>>, files: &[(PathBuf, Vec<u8>)]) -> Result<(), Failure> {
    let mut opened = Vec::new();
    for (file, bytes) in files {
        let place = begun.iter().position(|one| one.path() == file);
        let pending = place.map_or_else(|| Pending::begin(file), |place| Ok(begun.swap_remove(place)))?;
        opened.push((pending, bytes.clone()));
    }
    output::finish(opened)
}

/// The rasters of the options, in the order in which they are opened.
fn rasters(args: &MapArgs) -> impl Iterator<Item = (&'static str, Option<&Path>)> {
    let MapArgs { output, effort_output, return_output, mobility, nearest_output, predecessor_output, .. } = args;
    let amounts = args.amount_output.iter().map(|output| ("--amount-output", Some(output.file.as_path())));
    [
        ("-o", output),
        ("--effort-output", effort_output),
        ("--return-output", return_output),
        ("--mobility", mobility),
        ("--nearest-output", nearest_output),
        ("--predecessor-output", predecessor_output),
    ]
    .into_iter()
    .map(|(option, file)| (option, file.as_deref()))
    .chain(amounts)
}

/// Checks that each output has an extension that its readers recognise, and that a style has its raster.
fn check_extensions(args: &MapArgs) -> Result<(), Failure> {
    let rasters = || rasters(args).filter_map(|(option, file)| Some((option, file?)));
    let tables = [("--paths", &args.paths, &["csv"][..]), ("--geojson", &args.geojson, &["geojson", "json"][..])];
    let tables = tables.into_iter().filter_map(|(option, file, endings)| Some((option, file.as_deref()?, endings)));
    for (option, file, endings) in rasters().map(|(option, file)| (option, file, &["tif", "tiff"][..])).chain(tables) {
        let ending = file.extension().unwrap_or_default();
        let special = file.exists() && !file.is_file();
        if !special && !endings.iter().any(|one| ending.eq_ignore_ascii_case(one)) {
            let message = format!("{option} {}: expected a file that ends in .{}", file.display(), endings.join(" or ."));
            return Err(Failure::message(message));
        }
    }
    for (option, file) in [("--profiles", &args.profiles), ("--plot", &args.plot)] {
        file.as_deref().map_or(Ok(()), |file| output::check_picture(option, file))?;
    }
    if args.qml && rasters().next().is_none() {
        return Err(Failure::message(
            "--qml: found no raster to write a style for, expected at least one: give -o FILE.tif, or --effort-output, --amount-output, --return-output, \
             --nearest-output, --predecessor-output or --mobility",
        ));
    }
    Ok(())
}

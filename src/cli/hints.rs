//! The options that mend an error of the library: its messages name keys and facts, and the command adds the options here.

use std::{error::Error, path::Path};

use chta::{
    path::TooManyHops,
    quantity::format_number,
    reach::{FanError, map::MapError},
    report::FurtherMeans,
    scenario::{ProblemKind, ScenarioProblem},
    study::{PipelineError, fan::FanStudyError, map::MapStudyError, slice::SliceStudyError},
    terrain::{LonLat, ScaleMend, TerrainError},
};

use super::{help::takes, inputs};

/// The message of an error, with the options that mend it.
pub(crate) fn sentence(error: &(dyn Error + 'static)) -> String {
    let error = of_study(error);
    match error.downcast_ref() {
        Some(SliceStudyError::LonLatOnMesh) => {
            return "--from-lonlat, --to-lonlat, --via-lonlat: a mesh has no projection; give --from X,Y, --to X,Y and --via X,Y"
                .to_owned();
        }
        Some(SliceStudyError::ScaleOfRaster { file, scale }) => {
            let name = file.display();
            return format!("--mesh-scale {scale}: {name} is an elevation raster, expected a mesh; omit the option");
        }
        _ => {}
    }
    if let Some(FanStudyError::TooMuchMemory { needed_bytes, .. }) = error.downcast_ref() {
        let enough = needed_bytes.div_ceil(1 << 20);
        return format!(
            "--memory-max-mib: {error}; the options for that: --length, --node-spacing-max-m, --threads, or --memory-max-mib {enough}"
        );
    }
    if let Some(sentence) = error.downcast_ref().and_then(of_map_study) {
        return sentence;
    }
    match of_terrain(error) {
        Some(TerrainError::MapScale { found, mend }) => map_scale(found, mend),
        Some(TerrainError::UnknownScale { reason, mend }) => {
            format!(
                "{reason}, expected a map whose scale can be worked out; mend it with: {mend}; or accept it as it is with {}",
                accepted()
            )
        }
        _ => format!("{error}{}{}", hint(error), beside_a_pipe(error)),
    }
}

/// Whether the error's message already names this file.
pub(crate) fn names(error: &(dyn Error + 'static), file: &Path) -> bool {
    let error = of_study(error);
    if let Some(SliceStudyError::LonLatOnMesh | SliceStudyError::ScaleOfRaster { .. }) = error.downcast_ref() {
        return true;
    }
    let same = |path: &Path| path.file_name() == file.file_name();
    match (of_terrain(error), error.downcast_ref()) {
        (Some(TerrainError::InFile { path, .. } | TerrainError::Overlay { path, .. }), _)
        | (_, Some(PipelineError::Read { path, .. })) => same(path),
        // The commands that use these add the name.
        (Some(TerrainError::MapScale { mend, .. }), _) => !matches!(mend, ScaleMend::Shorter { .. }),
        _ => false,
    }
}

/// The addition to the help of a scenario's problem.
pub(crate) fn of_problem(problem: &ScenarioProblem) -> &'static str {
    let ScenarioProblem { key, kind, .. } = problem;
    match kind {
        ProblemKind::Missing if key.is_one_of("body", &["gravity_m_s2"]) && takes("body") && takes("gravity-m-s2") => {
            ", or use --body or --gravity-m-s2"
        }
        ProblemKind::Misplaced if key.is_one_of("surface", &["friction_raster", "keep_out", "keep_in"]) => {
            ", as chta slice --scenario does"
        }
        ProblemKind::Misplaced if key.is_one_of("terrain", &["via_m", "via_lonlat_deg"]) => ", as chta slice --via does",
        _ => "",
    }
}

/// How to get a stronger answer, by the options of the command that was called or else of another one.
pub(crate) fn further_means() -> FurtherMeans<'static> {
    let proof = if takes("prove") { "--prove" } else { "chta check --prove" };
    FurtherMeans { budget: "--prove-cells-max", proof, requirement: "chta require SCENARIO --vary" }
}

/// The error that the error of a study wraps.
fn of_study<'a>(error: &'a (dyn Error + 'static)) -> &'a (dyn Error + 'static) {
    match error.downcast_ref() {
        Some(MapStudyError::Pipeline(error)) => error,
        Some(MapStudyError::Terrain(error)) => error,
        Some(MapStudyError::Map(error)) => error,
        Some(MapStudyError::Simulation(error)) => error,
        _ => match error.downcast_ref() {
            Some(FanStudyError::Dem(error)) => error,
            Some(FanStudyError::Place(error) | FanStudyError::Scale(error)) => error,
            Some(FanStudyError::Fan(error)) => error,
            _ => match error.downcast_ref() {
                Some(SliceStudyError::Pipeline(error)) => error,
                Some(SliceStudyError::Overlay(error)) => error,
                Some(SliceStudyError::Chain(error)) => error,
                _ => error,
            },
        },
    }
}

/// The sentence of a map's error that options mend.
fn of_map_study(error: &MapStudyError) -> Option<String> {
    match error {
        MapStudyError::SamePost { stride, asked: [first, second], post } => Some(format!(
            "with --stride {stride}, ({:.3}, {:.3}) m and ({:.3}, {:.3}) m have the same nearest post, ({:.3}, {:.3}) m: give a smaller \
             --stride",
            first.x, first.y, second.x, second.y, post.x, post.y
        )),
        MapStudyError::NoTargetOfTrials => Some(format!("--trials: {error}; the option for a target: --target X,Y")),
        MapStudyError::MissionsTooLarge { needed_bytes, .. } => {
            Some(format!("--memory-max-mib: {error}; the option for that: --memory-max-mib {}", needed_bytes.div_ceil(1 << 20)))
        }
        MapStudyError::TooMuchMemory { needed_bytes, .. } => Some(format!(
            "--memory-max-mib: {error}; the options for that: --stride N, fewer of --effort, --return, --mobility and \
             --predecessor-output, or --memory-max-mib {}",
            needed_bytes.div_ceil(1 << 20)
        )),
        _ => None,
    }
}

/// The terrain error that an error is or wraps.
fn of_terrain<'a>(error: &'a (dyn Error + 'static)) -> Option<&'a TerrainError> {
    let of_map = || match error.downcast_ref() {
        Some(MapError::Terrain(terrain)) => Some(terrain),
        _ => None,
    };
    let of_fan = || match error.downcast_ref() {
        Some(FanError::Terrain(terrain)) => Some(terrain),
        _ => None,
    };
    match error.downcast_ref() {
        Some(PipelineError::Terrain(terrain)) => Some(terrain),
        _ => error.downcast_ref().or_else(of_map).or_else(of_fan),
    }
}

/// The addition to the message of an error.
fn hint(error: &(dyn Error + 'static)) -> String {
    if let Some(mut terrain) = of_terrain(error) {
        while let TerrainError::InFile { problem, .. } = terrain {
            terrain = problem;
        }
        return match terrain {
            TerrainError::NotProjected { .. } => {
                "; the options for that: slice --from-lonlat and --to-lonlat, fan --from-lonlat, map --start-lonlat and --goal-lonlat"
                    .to_owned()
            }
            TerrainError::Void(void) if takes("no-data") => {
                format!("; the options for that: --no-data={} and --no-data none", format_number(void.stored))
            }
            _ => String::new(),
        };
    }
    if error.is::<TooManyHops>() {
        return ", or ask `chta check` for the count alone".to_owned();
    }
    match error.downcast_ref() {
        Some(MapError::TooFar { stride, .. }) => return format!("; for that stride give --stride {stride}"),
        Some(MapError::TooManyHops { .. }) => return "; a greater stride is given with --stride".to_owned(),
        _ => {}
    }
    String::new()
}

/// The addition for a file through a pipe that lacks what may stand in a file beside it.
fn beside_a_pipe(error: &(dyn Error + 'static)) -> &'static str {
    let Some(TerrainError::InFile { path, problem }) = of_terrain(error) else { return "" };
    let may_stand_beside = matches!(**problem, TerrainError::Unsuitable { .. } | TerrainError::NoProjection { .. });
    if may_stand_beside && inputs::given_name(path).is_some() {
        "; it came through a pipe, where no file stands beside it (.tfw, .prj, .aux.xml): if it has one, give the file itself"
    } else {
        ""
    }
}

/// The remedy for a map whose scale is off.
fn map_scale(found: &str, mend: &ScaleMend) -> String {
    let place = |place: &LonLat| format!("{:.9},{:.9}", place.lon_deg, place.lat_deg);
    let mend = match mend {
        ScaleMend::AlongTransect { command, ends: [from, to] } => {
            format!("{command}, then slice out.tif --from-lonlat {} --to-lonlat {}", place(from), place(to))
        }
        ScaleMend::AboutStart { command, start, true_within_m } => format!(
            "{command}, then map out.tif --start-lonlat {} (a map about the start, which holds true {true_within_m} m to every side at \
             most)",
            place(start)
        ),
        ScaleMend::Shorter { .. } => mend.to_string(),
    };
    format!("{found}, expected 1 within 1 %; mend it with: {mend}; or accept it as it is with {}", accepted())
}

/// How to accept a map's scale as it is.
fn accepted() -> String {
    let key = "terrain.accept_map_scale = true";
    if takes("accept-map-scale") { format!("--accept-map-scale ({key})") } else { key.to_owned() }
}

#[cfg(test)]
mod tests {
    use chta::{
        quantity::MapPoint,
        scenario::{Entries, Scenario},
        terrain::{Dem, GeoReference, geotiff_bytes, read_geotiff_bytes},
    };
    use clap::CommandFactory;

    use super::*;
    use crate::cli::{args::Args, help::offers};

    /// Each option that a sentence names, with its command: the last one named before it, or the command that prints the sentence.
    fn options<'a>(sentence: &'a str, saying: &'a str) -> Vec<(&'a str, &'a str)> {
        let commands: Vec<String> = Args::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
        let (mut command, mut found) = (saying, Vec::new());
        for word in sentence.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')) {
            if commands.iter().any(|name| name == word) {
                command = word;
            }
            found.extend(word.strip_prefix("--").map(|option| (command, option)));
        }
        found
    }

    fn place() -> LonLat {
        LonLat { lon_deg: 12.5, lat_deg: -3.25 }
    }

    fn problems(source: &str) -> Vec<ScenarioProblem> {
        Scenario::new(Entries::from_toml(source)).unwrap_err()
    }

    #[test]
    fn every_option_of_a_hint_exists() {
        let command = || "gdalwarp in.tif out.tif".to_owned();
        let scale = |mend| TerrainError::MapScale { found: "the scale is 1.3".to_owned(), mend };
        let degrees = GeoReference::local(MapPoint::new(0.0, 9.0), 1.0, 1.0).unwrap();
        let degrees = Dem::new(2, 2, vec![0.0, 900.0, 0.0, 900.5], degrees).unwrap();
        let not_projected = read_geotiff_bytes(geotiff_bytes(&degrees).unwrap()).unwrap_err();
        assert!(matches!(not_projected, TerrainError::NotProjected { .. }));
        let in_file = TerrainError::InFile { path: "a.tif".into(), problem: Box::new(not_projected) };
        let errors: [(&str, Box<dyn Error>, &str); 6] = [
            ("map", Box::new(MapError::TooFar { range_m: 9.0, posts: 9.0, offsets: 9, stride: 4 }), "--stride 4"),
            ("map", Box::new(MapError::TooManyHops { most: 9 }), "--stride"),
            ("plan", Box::new(TooManyHops { hops: 9 }), "`chta check`"),
            ("plan", Box::new(PipelineError::from(in_file)), "map --start-lonlat"),
            (
                "slice",
                Box::new(scale(ScaleMend::AlongTransect { command: command(), ends: [place(), place()] })),
                "then slice out.tif --from-lonlat 12.500000000,-3.250000000 --to-lonlat 12.500000000,-3.250000000; or accept it as it is \
                 with --accept-map-scale (terrain.accept_map_scale = true)",
            ),
            (
                "map",
                Box::new(MapError::from(scale(ScaleMend::AboutStart { command: command(), start: place(), true_within_m: 9.0 }))),
                "then map out.tif --start-lonlat 12.500000000,-3.250000000 (",
            ),
        ];
        for (saying, error, part) in &errors {
            let sentence = sentence(&**error);
            assert!(sentence.contains(part), "{part:?} is not in {sentence}");
            assert!(options(&error.to_string(), saying).is_empty(), "the library names options: {error}");
            for (command, option) in options(&sentence, saying) {
                // The name of a command may be a plain word of the sentence, such as hop.
                assert!(offers(command, option) || offers(saying, option), "{command} has no --{option}: {sentence}");
            }
        }
        assert!(!offers("slice", "body") && offers("slice", "via"), "the lookup tells options apart");
    }

    #[test]
    fn problems_of_a_scenario_are_mended_by_options_that_exist() {
        let on_chain =
            "[body]\nname = \"mars\"\n[terrain]\nchain = \"a.csv\"\nvia_m = [[1, 2]]\n[surface]\nkeep_out = \"a.json\"\n";
        let on_mesh =
            "[body]\nname = \"mars\"\n[terrain]\nmesh = \"a.obj\"\nstart_m = [0, 0]\ngoal_m = [1, 1]\nvia_lonlat_deg = [[1, 2]]\n";
        for (source, expected) in [
            ("", vec![", or use --body or --gravity-m-s2"]),
            (on_chain, vec![", as chta slice --via does", ", as chta slice --scenario does"]),
            (on_mesh, vec![""]),
        ] {
            let hints: Vec<_> = problems(source).iter().map(of_problem).collect();
            assert_eq!(hints, expected, "{source}");
            for (command, option) in hints.iter().flat_map(|hint| options(hint, "plan")) {
                assert!(offers(command, option), "{command} has no --{option}");
            }
        }
        let FurtherMeans { budget, proof, requirement } = further_means();
        for (command, option) in [budget, proof, requirement].into_iter().flat_map(|words| options(words, "check")) {
            assert!(offers(command, option), "{command} has no --{option}");
        }
    }

    #[test]
    fn a_file_is_named_once() {
        let file = Path::new("folder/a.tif");
        let wrong = || Box::new(TerrainError::InvalidDem("one row".to_owned()));
        let in_file = TerrainError::InFile { path: file.to_path_buf(), problem: wrong() };
        assert!(names(&PipelineError::from(in_file), file));
        assert!(!names(&*wrong(), file));
        let cover = TerrainError::Overlay { what: "friction raster", path: "b.tif".into(), problem: "wrong".to_owned() };
        assert!(!names(&cover, file));
        let shorter = TerrainError::MapScale { found: "1.3".to_owned(), mend: ScaleMend::Shorter { longest_m: 9.0 } };
        assert!(!names(&shorter, file) && sentence(&shorter).contains("shorter transects"));
    }
}

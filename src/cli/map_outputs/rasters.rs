//! The rasters of a map as `GeoTIFF`s, and their styles for QGIS.

use std::path::PathBuf;

use chta::{
    figure::RasterStyle,
    graph::Effort,
    planner::Amount,
    reach::map::{HopMap, NO_GROUND, NOT_SEARCHED, UNREACHED},
    study::map::{MapStudy, NO_PREDECESSOR, PreparedMap},
    terrain::{Band, ResultBands, result_geotiff_bytes},
};

use crate::cli::{Failure, args::MapArgs, map_input::MapInput};

/// The marks of the rasters of whole numbers.
const MARKS: &str = "-1 unreachable";

/// Every raster of the options with its bytes, and its style beside it if asked for.
pub(super) fn encoded(
    args: &MapArgs,
    input: &MapInput,
    prepared: &PreparedMap,
    study: &MapStudy,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let (lattice, map) = (prepared.lattice, prepared.nodes().citing_the_code());
    let mut files = Vec::new();
    let mut add = |file: &Option<PathBuf>, bands: &ResultBands<'_>, style: RasterStyle| -> Result<(), Failure> {
        let Some(file) = file else { return Ok(()) };
        let bytes = result_geotiff_bytes(lattice.rows, lattice.cols, &map, bands).map_err(|e| Failure::of(&e))?;
        files.push((file.clone(), bytes));
        if args.qml {
            files.push((file.with_extension("qml"), style.qml().into_bytes()));
        }
        Ok(())
    };
    let MapStudy { out, back, mobility, predecessors, .. } = study;
    let several = prepared.starts.len() > 1;
    let (from, to) = if several { ("the nearest start", "the nearest start") } else { ("the start", "the start") };
    let beyond = beyond(study);
    let of = match &study.answer.objective {
        None => format!("fewest hops from {from}"),
        Some(objective) => format!("hops from {from} on the path of least {}", listed(&objective.amounts)),
    };
    let name = format!("{of}; {MARKS}{beyond}");
    add(&args.output, &whole(&name, "hops", &out.hops), RasterStyle::hops(&out.hops))?;
    if let Some(back) = back {
        let name = format!("fewest hops back to {to}; -1 no way{beyond}");
        add(&args.return_output, &whole(&name, "hops", &back.hops), RasterStyle::hops(&back.hops))?;
    }
    if args.effort_output.is_some() {
        #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
        let samples: Vec<f32> = out.effort.iter().map(|&effort| effort as f32).collect();
        let effort = input.bare.scenario.search.effort;
        let name = effort_name(effort);
        let band = Band { name: &name, unit: effort.unit().name(), samples: &samples };
        add(&args.effort_output, &ResultBands::Float32(vec![band]), RasterStyle::values(&samples, effort.unit().name()))?;
    }
    for (output, (amount, totals)) in args.amount_output.iter().zip(&study.amounts) {
        #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
        let samples: Vec<f32> = totals.iter().map(|&total| total as f32).collect();
        let is_least = study.least.first().is_some_and(|(first, _)| first == amount);
        let of = if is_least { format!("least {}", amount.words()) } else { format!("{} along the path found", amount.words()) };
        let unit = match amount.unit() {
            "" => "hops",
            unit => unit,
        };
        let name = format!("{of} from {from}, {unit}");
        let band = Band { name: &name, unit, samples: &samples };
        add(&Some(output.file.clone()), &ResultBands::Float32(vec![band]), RasterStyle::values(&samples, unit))?;
    }
    if let Some(mobility) = mobility {
        let share = Band { name: "share of the reach disc that one hop reaches", unit: "1", samples: &mobility.share };
        let directions = Band { name: "directions of 16 with a hop", unit: "directions", samples: &mobility.directions };
        let style = RasterStyle::values(&mobility.share, "of the disc");
        add(&args.mobility, &ResultBands::Float32(vec![share, directions]), style)?;
    }
    if args.nearest_output.is_some() {
        let samples = nearest(out, prepared);
        let name = format!("number of the nearest start, from 1; {MARKS}{beyond}");
        let band = Band { name: &name, unit: "start", samples: &samples };
        add(
            &args.nearest_output,
            &ResultBands::Int32(vec![band], i32::from(NO_GROUND)),
            RasterStyle::starts(prepared.starts.len()),
        )?;
    }
    if let Some(samples) = predecessors {
        let name = "post that the last hop comes from, as row * columns + column of this raster from the north-west; -1 at a start";
        let bands = ResultBands::Int32(vec![Band { name, unit: "post", samples }], NO_PREDECESSOR);
        add(&args.predecessor_output, &bands, RasterStyle::predecessors(lattice.count()))?;
    }
    Ok(files)
}

/// What the mark of nodes that were not searched means; nothing where all were.
fn beyond(study: &MapStudy) -> String {
    let budget = study.answer.objective.as_ref().and_then(|objective| objective.budget.as_ref());
    match (study.answer.hops_max, budget) {
        (Some(most), _) => format!("; -2 more than {most}, not searched"),
        (None, Some(budget)) => format!("; -2 beyond {} {}, not searched", budget.max, budget.amount.unit()),
        (None, None) => String::new(),
    }
}

/// The names of amounts with commas.
fn listed(amounts: &[Amount]) -> String {
    amounts.iter().map(|amount| amount.name()).collect::<Vec<_>>().join(", ")
}

/// A band of hop counts.
fn whole<'a>(name: &'a str, unit: &'a str, samples: &'a [i16]) -> ResultBands<'a> {
    ResultBands::Int16(vec![Band { name, unit, samples }], NO_GROUND)
}

/// For each post the number of its nearest start, from 1, or the mark of a post without one.
fn nearest(out: &HopMap, prepared: &PreparedMap) -> Vec<i32> {
    let number = |index: usize| match out.source(prepared.lattice, prepared.lattice.node(index)) {
        Some(number) => i32::try_from(number + 1).unwrap_or(i32::MAX),
        None => i32::from(match out.hops[index] {
            NO_GROUND => NO_GROUND,
            NOT_SEARCHED => NOT_SEARCHED,
            _ => UNREACHED,
        }),
    };
    (0..prepared.lattice.count()).map(number).collect()
}

/// The band description of an effort raster.
fn effort_name(effort: Effort) -> String {
    format!("least {} among fewest hops, {}", effort.total(), effort.unit())
}

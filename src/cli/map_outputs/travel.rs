//! The files of a map of missions.

use std::path::{Path, PathBuf};

use chta::{
    figure::{Caption, GoalMark, MapPosts, RasterStyle, TravelMapFigure, draw_travel_map},
    planner::{Amount, Travel},
    quantity::MapPoint,
    study::{ReachedBy, TravelMap, conditions, map::PreparedMap, wheels},
    terrain::{Band, ResultBands, result_geotiff_bytes},
};

use super::{check_extensions, finish};
use crate::cli::{
    Failure,
    args::MapArgs,
    map_input::MapInput,
    output::{self, Pending},
};

/// The files, opened.
#[derive(Debug)]
pub(crate) struct TravelMapOutputs<'a> {
    opened: Vec<Pending<'a>>,
}

impl<'a> TravelMapOutputs<'a> {
    /// Checks the extensions of all files and opens them.
    pub(crate) fn begin(args: &'a MapArgs) -> Result<Self, Failure> {
        check_extensions(args)?;
        let rasters = args.amount_output.iter().map(|output| output.file.as_path());
        let files = rasters.chain([&args.output, &args.return_output, &args.plot].into_iter().flatten().map(PathBuf::as_path));
        Ok(Self { opened: files.map(Pending::begin).collect::<Result<_, _>>()? })
    }

    /// Writes all files or none.
    pub(crate) fn write(self, args: &MapArgs, input: &MapInput, prepared: &PreparedMap, found: &TravelMap) -> Result<(), Failure> {
        let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
        let mut add = |file: &Path, amount: Amount, (totals, whose): (Option<Vec<f64>>, &str)| -> Result<(), Failure> {
            let Some(totals) = totals else { return Err(unknown(amount, found)) };
            #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
            let samples: Vec<f32> = totals.iter().map(|&total| total as f32).collect();
            let unit = if amount.unit().is_empty() { amount.name() } else { amount.unit() };
            let name = format!("{} of the best mission {whose}, {unit}", amount.words());
            let bands = ResultBands::Float32(vec![Band { name: &name, unit, samples: &samples }]);
            let map = prepared.nodes().citing_the_code();
            let (rows, cols) = (prepared.lattice.rows, prepared.lattice.cols);
            files.push((file.to_path_buf(), result_geotiff_bytes(rows, cols, &map, &bands).map_err(|e| Failure::of(&e))?));
            if args.qml {
                files.push((file.with_extension("qml"), RasterStyle::values(&samples, unit).qml().into_bytes()));
            }
            Ok(())
        };
        let there = "from a start";
        if let Some(file) = &args.output {
            add(file, Amount::Hops, (found.totals(Amount::Hops), there))?;
        }
        for output in &args.amount_output {
            add(&output.file, output.amount, (found.totals(output.amount), there))?;
        }
        if let Some(file) = &args.return_output {
            let first = found.amounts()[0];
            add(file, first, (found.totals_back(first), "back to a start"))?;
        }
        if let Some(file) = &args.plot {
            files.push((file.clone(), picture(input, prepared, found, file)?));
        }
        finish(self.opened, &files)
    }
}

/// An amount that the field does not know.
fn unknown(amount: Amount, found: &TravelMap) -> Failure {
    let known: Vec<&str> = found.amounts().iter().map(|amount| amount.name()).collect();
    Failure::message(format!(
        "--amount-output: found {}, expected one of {}, which the missions of this map count: put it into --objective",
        amount.name(),
        known.join(", ")
    ))
}

fn picture(input: &MapInput, prepared: &PreparedMap, found: &TravelMap, file: &Path) -> Result<Vec<u8>, Failure> {
    let surface = prepared.finest().map_err(|e| Failure::of(&e))?;
    let answer = &found.answer;
    let only = match answer.travel {
        Travel::Both => None,
        Travel::Drive => Some("by driving"),
        Travel::Hop => Some("by hops"),
    };
    let class = |index: usize| {
        found.reached_by(index).map(|by| match by {
            _ if only.is_some() => 0,
            ReachedBy::Either => 0,
            ReachedBy::Drive => 1,
            ReachedBy::Hop => 2,
            ReachedBy::Together => 3,
        })
    };
    let classes: Vec<Option<usize>> = (0..prepared.lattice.count()).map(class).collect();
    let first = found.amounts()[0];
    let goals = prepared.goals.iter().zip(&answer.goals);
    let shares: Vec<String> = answer
        .reached
        .iter()
        .map(|row| {
            let by = match row.travel {
                Travel::Both => "by driving and hops",
                Travel::Drive => "by driving alone",
                Travel::Hop => "by hops alone",
            };
            format!("{:.1} % of the nodes {by}", 100.0 * row.reached_share)
        })
        .collect();
    let lines = vec![conditions(&input.bare.scenario), wheels(&input.bare.scenario), format!("reached: {}", shares.join(", "))];
    let figure = TravelMapFigure {
        caption: Caption { title: format!("Where by driving and by hops: {}", input.title()), lines },
        posts: MapPosts { dem: &surface, stride: prepared.lattice.stride, per_post: prepared.lattice.per_post },
        classes: &classes,
        only,
        values: &found.totals(first).unwrap_or_default(),
        value_name: format!("least {} ({})", first.words(), first.unit()),
        starts: prepared.starts.iter().map(|start| start.at).collect::<Vec<MapPoint>>(),
        goals: goals.map(|(goal, record)| GoalMark { at: goal.at, hops: record.totals.map(|sums| sums.hops) }).collect(),
    };
    output::encoded(draw_travel_map(&figure), file)
}

//! The files of a map of a robot with legs.

use std::path::{Path, PathBuf};

use chta::{
    figure::{Caption, GoalMark, LegsMapFigure, LegsMapLayer, MapPosts, RasterStyle, draw_legs_map},
    reach::{map::NO_GROUND, stances::NodeStance},
    study::{LegsMap, PreparedLegsMap, conditions},
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
pub(crate) struct LegsMapOutputs<'a> {
    opened: Vec<Pending<'a>>,
}

impl<'a> LegsMapOutputs<'a> {
    /// Checks the extensions of all files and opens them.
    pub(crate) fn begin(args: &'a MapArgs) -> Result<Self, Failure> {
        check_extensions(args)?;
        let files = [&args.output, &args.mobility, &args.plot].into_iter().flatten().map(PathBuf::as_path);
        Ok(Self { opened: files.map(Pending::begin).collect::<Result<_, _>>()? })
    }

    /// Writes all files or none.
    pub(crate) fn write(
        self,
        args: &MapArgs,
        input: &MapInput,
        prepared: &PreparedLegsMap,
        found: &LegsMap,
    ) -> Result<(), Failure> {
        let lattice = prepared.lattice;
        let map = lattice.map(prepared.dem().georeference()).citing_the_code();
        let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
        let mut add = |file: &Path, bands: &ResultBands<'_>, style: &RasterStyle| -> Result<(), Failure> {
            let bytes = result_geotiff_bytes(lattice.rows, lattice.cols, &map, bands).map_err(|e| Failure::of(&e))?;
            files.push((file.to_path_buf(), bytes));
            if args.qml {
                files.push((file.with_extension("qml"), style.qml().into_bytes()));
            }
            Ok(())
        };
        if let (Some(file), Some(hops)) = (&args.output, &found.hops) {
            let name = "fewest hops from stance to stance from a start; -1 not reached over these stances; -2 not searched";
            let band = Band { name, unit: "hops", samples: &hops.hops };
            add(file, &ResultBands::Int16(vec![band], NO_GROUND), &RasterStyle::hops(&hops.hops))?;
        }
        if let Some(file) = &args.mobility {
            let samples = |of: &dyn Fn(&NodeStance) -> f64| -> Vec<f32> {
                #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
                let sample = |node| found.nodes.found(node).map_or(f32::NAN, |found| of(found) as f32);
                (0..lattice.count()).map(sample).collect()
            };
            let [legs, beam, directions, headings] = [
                samples(&legs_of),
                samples(&|node| node.beam_deg.unwrap_or(0.0)),
                samples(&|node| node.directions),
                samples(&|node| node.headings),
            ];
            let bands = ResultBands::Float32(vec![
                Band { name: "most legs that find ground", unit: "legs", samples: &legs },
                Band { name: "widest beam of take-off angles, 0 where it does not stand, deg", unit: "deg", samples: &beam },
                Band { name: "share of 36 directions in which the feet push", unit: "1", samples: &directions },
                Band { name: "share of the headings of the trunk in which it stands", unit: "1", samples: &headings },
            ]);
            add(file, &bands, &RasterStyle::values(&legs, "legs"))?;
        }
        if let Some(file) = &args.plot {
            files.push((file.clone(), picture(input, prepared, found, file)?));
        }
        finish(self.opened, &files)
    }
}

#[expect(clippy::cast_precision_loss, reason = "a number of legs")]
fn legs_of(node: &NodeStance) -> f64 {
    node.legs as f64
}

fn picture(input: &MapInput, prepared: &PreparedLegsMap, found: &LegsMap, file: &Path) -> Result<Vec<u8>, Failure> {
    let answer = &found.answer;
    let values = |of: &dyn Fn(&NodeStance) -> f64| -> Vec<f64> {
        (0..prepared.lattice.count()).map(|node| found.nodes.found(node).map_or(f64::NAN, of)).collect()
    };
    let mut layers = vec![
        LegsMapLayer {
            name: "most legs that find ground".to_owned(),
            values: values(&legs_of),
            none_name: String::new(),
            counts: true,
        },
        LegsMapLayer {
            name: "widest beam of take-off angles (deg)".to_owned(),
            values: values(&|node| node.beam_deg.unwrap_or(f64::NAN)),
            none_name: "does not stand".to_owned(),
            counts: false,
        },
    ];
    let mut lines = vec![
        conditions(&prepared.scenario),
        format!(
            "{}: stands at {} of {} nodes, {} headings at each",
            answer.robot, answer.standing_nodes, answer.nodes, answer.headings
        ),
    ];
    if let (Some(hops), Some(reach)) = (&found.hops, &answer.reach) {
        let value = |hops: &i16| if *hops < 0 { f64::NAN } else { f64::from(*hops) };
        layers.push(LegsMapLayer {
            name: "fewest hops from a start, from stance to stance".to_owned(),
            values: hops.hops.iter().map(value).collect(),
            none_name: "not reached over these stances".to_owned(),
            counts: true,
        });
        lines.push(format!(
            "reached: {} node{} over {} stances; other stances may reach more",
            reach.reached_nodes,
            if reach.reached_nodes == 1 { "" } else { "s" },
            reach.stances
        ));
    }
    let figure = LegsMapFigure {
        caption: Caption { title: format!("Stances of a robot with legs: {}", input.title()), lines },
        posts: MapPosts { dem: prepared.dem(), stride: prepared.lattice.stride, per_post: 1 },
        layers,
        starts: prepared.starts.iter().map(|start| start.at).collect(),
        goals: prepared.goals.iter().zip(&answer.goals).map(|(goal, record)| GoalMark { at: goal.at, hops: record.hops }).collect(),
    };
    output::encoded(draw_legs_map(&figure), file)
}

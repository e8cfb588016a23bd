//! From the command line of `sites` to its question, and the files that it writes.

use std::path::Path;

use chta::{
    figure::{Caption, FigureError, Picture, SiteMark, SitesFigure, draw_sites},
    quantity::MapPoint,
    report::{SiteRecord, SitesAnswer},
    study::{
        Candidates, SitesQuestion, conditions,
        map::{MapQuestion, MapStudyError, NamedPlace, PreparedMap},
    },
    terrain::{Band, ResultBands, result_geotiff_bytes},
};

use super::{
    Failure,
    args::{NodeSpacing, SearchArgs, SitesArgs},
    effects::Purpose,
    load::{Bare, load_map},
    map_input::{goals_of, of_file, of_options},
    output::{self, Pending, TableFormat},
    views::{Files, Table, Views},
};

/// What `sites` answers for.
#[derive(Debug)]
pub(crate) struct SitesInput {
    /// The DEM and the scenario.
    pub(crate) bare: Bare,
    candidates: Candidates,
    targets: Vec<NamedPlace>,
    /// Warnings about the file of candidates.
    warnings: Vec<String>,
}

impl SitesInput {
    /// Reads the scenario and the candidates.
    pub(crate) fn of(args: &SitesArgs) -> Result<Self, Failure> {
        let node_spacing_max_m = args.node_spacing_max_m.and_then(NodeSpacing::metres);
        let searched = SearchArgs { points_per_segment: None, node_spacing_max_m, effort: None };
        let purpose = |ends| Purpose::Sites { trials: args.trials.is_some(), ends };
        let bare = load_map(&args.dem, &args.common, (&searched, &args.objective, &args.own_keys()), purpose, true)?;
        if bare.scenario.drives().is_some() {
            return Err(Failure::message(
                "[drive]: found a scenario that drives, expected hops alone: landing sites are ranked by hops; set drive.travel = \"hop\"",
            ));
        }
        let mut warnings = Vec::new();
        let candidates = match &args.candidates {
            Some(file) => Candidates::Places(of_file(file, &mut warnings)?),
            None => Candidates::Every(args.every.unwrap_or(1) as usize),
        };
        let targets = of_options("--target", &args.target, &args.target_lonlat);
        let targets = if targets.is_empty() { goals_of(&bare) } else { targets };
        Ok(Self { bare, candidates, targets, warnings })
    }

    /// The question.
    pub(crate) fn question<'a>(&'a self, args: &SitesArgs) -> SitesQuestion<'a> {
        let map = MapQuestion {
            scenario: &self.bare.scenario,
            base: &self.bare.base,
            dem: &self.bare.dem,
            starts: Vec::new(),
            goals: self.targets.clone(),
            stride: args.stride as usize,
            auto_nodes: args.node_spacing_max_m == Some(NodeSpacing::Auto),
            effort: false,
            returns: true,
            mobility: false,
            ranks_sites: true,
            predecessors: false,
            refusals: false,
            trials: args.trials.is_some(),
            hops_max: None,
            amounts: Vec::new(),
            memory_max_bytes: args.size.memory_max_bytes(),
        };
        SitesQuestion { map, candidates: self.candidates.clone() }
    }

    /// The failure for an error of the study.
    pub(crate) fn failure(&self, error: &MapStudyError) -> Failure {
        Failure::about(&self.bare.dem, error)
    }

    /// All warnings, those of the study last, printed on standard error.
    pub(crate) fn warned(&self, of_study: &[String], quiet: bool) -> Vec<String> {
        output::warned(quiet, &[&self.bare.warnings, &self.warnings, of_study])
    }

    /// The picture: the candidates by the share of the nodes that they reach.
    pub(crate) fn picture(&self, prepared: &PreparedMap, answer: &SitesAnswer) -> Result<Picture, FigureError> {
        let scenario = &self.bare.scenario;
        let count = answer.targets_m.len();
        let best = answer.sites.first().map_or_else(String::new, |best| {
            let targets = if count > 0 { format!(", {} of {count} targets", best.targets_reached) } else { String::new() };
            format!(
                "best of {}: ({:.1}, {:.1}) m reaches {:.1} %{targets}, of these {:.1} % lead back",
                answer.sites.len(),
                best.x_m,
                best.y_m,
                100.0 * best.reachable_share,
                100.0 * best.return_share
            )
        });
        let shares = || answer.sites.iter().filter(|site| site.refusal.is_none()).map(|site| site.reachable_share);
        let spread = shares().fold(0.0, f64::max) - shares().fold(1.0, f64::min);
        // Where all reach the same, hops tell them apart.
        let by_hops = count > 0 || spread < ALIKE;
        let value_name = match (by_hops, count) {
            (false, _) => "share of the nodes that is reached from a candidate (%)",
            (true, 0) => "mean hops from a candidate to the nodes that it reaches",
            (true, _) => "mean hops from a candidate to the targets that it reaches",
        };
        draw_sites(&SitesFigure {
            caption: Caption {
                title: format!("Landing sites: {}", self.bare.title_of_map()),
                lines: vec![conditions(scenario), best],
            },
            dem: prepared.dem(),
            sites: answer.sites.iter().map(|site| mark(site, by_hops)).collect(),
            value_name: value_name.to_owned(),
            targets: answer.targets_m.iter().map(|[x_m, y_m]| MapPoint::new(*x_m, *y_m)).collect(),
        })
    }
}

/// Shares that differ by less are alike in a picture.
const ALIKE: f64 = 0.01;

fn mark(site: &SiteRecord, by_hops: bool) -> SiteMark {
    let share = 100.0 * site.reachable_share;
    let (value, name) = match site.mean_hops.filter(|_| by_hops) {
        Some(hops) => (Some(hops), format!("{}: {hops:.1} hops", site.rank)),
        None if by_hops => (None, String::new()),
        None => (Some(share), format!("{}: {share:.0} %", site.rank)),
    };
    SiteMark { at: MapPoint::new(site.x_m, site.y_m), value: value.filter(|_| site.refusal.is_none()), name }
}

/// The file of the sites: a table, or a raster.
pub(crate) struct SitesOutput<'a> {
    pub(crate) table: Table<'a>,
    raster: Option<Pending<'a>>,
}

impl<'a> SitesOutput<'a> {
    /// Opens it.
    pub(crate) fn begin(path: Option<&'a Path>) -> Result<Self, Failure> {
        let ending = path.and_then(Path::extension).unwrap_or_default();
        if ["tif", "tiff"].iter().any(|one| ending.eq_ignore_ascii_case(one)) {
            let raster = path.map(Pending::begin).transpose()?;
            return Ok(Self { table: Table::begin(None, TableFormat::Csv)?, raster });
        }
        Ok(Self { table: Table::by_extension(path)?, raster: None })
    }

    /// Adds it to the files to write. `every`: the candidates are every so many nodes, and so the pixels where these are posts.
    pub(crate) fn write(
        &mut self,
        files: &mut Files<'a>,
        views: &Views<'_>,
        (prepared, answer, every): (&PreparedMap, &SitesAnswer, Option<u32>),
    ) -> Result<(), Failure> {
        if let Some(raster) = self.raster.take() {
            files.bytes(raster, raster_of(prepared, answer, every.unwrap_or(1) as usize)?);
        }
        files.table(&mut self.table, views)
    }
}

/// The sites as a raster of the nodes, or of every so many of them.
fn raster_of(prepared: &PreparedMap, answer: &SitesAnswer, every: usize) -> Result<Vec<u8>, Failure> {
    let lattice = prepared.lattice;
    let every = if lattice.per_post == 1 { every } else { 1 };
    let (rows, cols) = (lattice.rows.div_ceil(every), lattice.cols.div_ceil(every));
    let nodes = prepared.nodes();
    let map = if every > 1 { nodes.every(every) } else { nodes.clone() }.citing_the_code();
    let mut bands = [(); 3].map(|()| vec![f32::NAN; rows * cols]);
    for site in answer.sites.iter().filter(|site| site.reachable_nodes > 0) {
        let node = lattice.nearest(prepared.dem().georeference(), MapPoint::new(site.x_m, site.y_m));
        let pixel = node.row / every * cols + node.col / every;
        #[expect(clippy::cast_possible_truncation, reason = "the file holds 32-bit floats")]
        let values = [site.reachable_share, site.return_share, site.mean_hops.unwrap_or(f64::NAN)].map(|value| value as f32);
        for (band, value) in bands.iter_mut().zip(values) {
            band[pixel] = value;
        }
    }
    let [reached, back, hops] = &bands;
    let bands = vec![
        Band { name: "share of the nodes that is reached from here", unit: "1", samples: reached },
        Band { name: "share of these from which it is reached again", unit: "1", samples: back },
        Band { name: "mean hops to the nodes reached, or to the targets reached", unit: "hops", samples: hops },
    ];
    result_geotiff_bytes(rows, cols, &map, &ResultBands::Float32(bands)).map_err(|e| Failure::of(&e))
}

//! The picture of one analysis, for a mission report: 170 mm wide.
//!
//! ```text
//!   title, body, limits, verdict
//!   +----------------------------------+   ground, nodes, flights, cones, closed stretches;
//!   |    .-1-.     .-2-.               |   without a path: how far one gets from either end
//!   | __/     \___/     \___           |
//!   +----------------------------------+
//!   legend
//!   +----------------------------------+   a route in any direction: the path from above,
//!   |  o---.---.--<>                   |   over a hillshade
//!   +----------------------------------+
//!   +----------------------------------+   each hop's feasible take-off angles and the one chosen;
//!   |    |         |                   |   without a path: what refused, how often
//!   +----------------------------------+
//!   totals, or the nearest miss
//! ```
//!
//! [`FigureData`] holds the data of the picture, in metres; [`draw`] puts it on the sheet. Heights are drawn at true scale if that
//! is readable, else exaggerated by a round factor that the axis states; cones and flights have the same scale. No kind of mark is
//! distinguished by colour alone.

mod angle_panel;
mod arena;
mod arena_tree;
mod axes;
mod bands;
mod bitmap;
mod chains;
mod clearance;
mod data;
mod heading;
mod keys;
mod legend;
mod limits;
mod map;
mod mesh_hop;
mod mesh_oblique;
mod mesh_paint;
mod mesh_raster;
mod mesh_reach;
mod mesh_route;
mod mesh_table;
mod of_answers;
mod palette;
mod picture;
mod postures;
mod robot_view;
mod rose;
mod scale;
mod sheet;
mod spans;
mod stance;
mod stop_panel;
mod symbols;
mod terrain_panel;
mod ticks;
mod touchdown;
mod trials;

#[cfg(test)]
mod samples;
#[cfg(test)]
mod tests;

pub use arena::{ArenaFigure, ArenaPanel, draw_arena};
pub use chains::{
    CompareFigure, ComparedScenario, Flight, HopProfile, HopProfilesFigure, ProofClass, ProofFigure, ProofGap, ProofStretch,
    TradeAxis, TradeCell, TradeFigure, draw_compare, draw_hop_profiles, draw_proof, draw_trade,
};
pub use data::{Cone, FigureData, HopFigure, MOST_HOPS_DRAWN, StoppedFigure, Subject, Thinned};
pub use heading::conditions;
pub use map::{
    DensityFigure, GoalMark, HOPS_NO_DATA, HOPS_NOT_SEARCHED, HOPS_UNREACHABLE, HopMapFigure, LandingCloud, LandingEllipse,
    LandingMapFigure, LegsMapFigure, LegsMapLayer, MapPosts, PlanView, RasterStyle, RefusedBy, RefusedPosts, SiteMark, SitesFigure,
    TargetMark, TargetsFigure, TravelFigure, TravelLine, TravelMapFigure, ValueMapFigure, VisitRow, draw_density, draw_hop_map,
    draw_landing_map, draw_legs_map, draw_sites, draw_targets, draw_travel, draw_travel_map, draw_value_map,
};
pub use mesh_hop::{MeshHopFigure, draw_mesh_hop};
pub use mesh_reach::{MeshReachFigure, ReachedContact, draw_mesh_reach};
pub use mesh_route::{MeshRouteFigure, MeshRouteLine, SeenFrom, draw_mesh_route};
pub use picture::{Caption, Picture, PictureFormat, WIDTH_MAX_MM, WIDTH_MIN_MM};
pub use postures::{POSTURE_ROWS_MAX, PostureMark, PostureRow, PosturesFigure, draw_postures};
pub use robot_view::{LimbMark, RobotMark};
pub use rose::draw_rose;
pub use scale::Scale;
pub use spans::{Closure, GroundSpan, GroundUse};
pub use stance::{StanceFigure, StandingRobot, draw_stance};
pub use trials::{
    ConeWidthFigure, ConeWidthPoint, ConvergencePoint, ErrorQuantiles, FlownFigure, FlownTrial, FrontAgainst, FrontFigure,
    FrontPoint, FrontValue, LandingBoxes, LandingErrorFigure, OutcomeBars, SensitivityBar, SensitivityFigure, SimulationFigure,
    Success, draw_cone_width, draw_convergence, draw_flown, draw_front, draw_landing_errors, draw_outcomes, draw_sensitivity,
    draw_simulation,
};

use crate::{
    chain::Station,
    graph::{Answer, NodesError},
    hop::HopTest,
    path::HopPath,
};
use sheet::Sheet;

/// The input of a picture.
#[derive(Clone, Debug)]
pub struct FigureInput<'a> {
    /// The chain, the hopper and the gravity.
    pub test: &'a HopTest,
    /// The answer of the search.
    pub answer: &'a Answer,
    /// The hops, if the answer is a path.
    pub path: Option<&'a HopPath>,
    /// Where the journey begins.
    pub start: Station,
    /// Where it should end.
    pub goal: Station,
    /// The route from above, if the chain was unrolled along one over a DEM: the nodes of the search then lie beside the chain, and the profile
    /// shows none.
    pub plan_view: Option<PlanView<'a>>,
    /// The texts of the title.
    pub title: FigureTitle,
}

/// Texts for the title that the analysis does not contain; empty ones are omitted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FigureTitle {
    /// The name of the scenario.
    pub name: String,
    /// The name of the body.
    pub body: String,
    /// The ground's grip, such as `friction coefficient 0.6`.
    pub ground: String,
    /// Why no commands in the machine's steps fly the path, with its hop and limit; `None` if some do.
    pub refusal: Option<String>,
}

/// The reasons why a figure cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// A path without its hops.
    #[error("the answer is a path, but its hops were not given: generate them and pass them with the answer")]
    NoHops,
    /// The nodes of the search cannot be generated again.
    #[error(transparent)]
    Nodes(#[from] NodesError),
    /// A raster or the cells of a trade have the wrong size.
    #[error("the {what} has {found} values, expected {rows} rows times {cols} columns")]
    RasterSize {
        /// The figure's content.
        what: &'static str,
        /// The number of values found.
        found: usize,
        /// The expected number of rows.
        rows: usize,
        /// The expected number of columns.
        cols: usize,
    },
    /// The ground has too few points.
    #[error("the ground of {what} has {points} points, expected at least 2")]
    NoGround {
        /// The owner of the ground.
        what: String,
        /// The number of points.
        points: usize,
    },
    /// The file's extension is not that of a picture format.
    #[error("'{file}' does not end in .svg or .png, the two formats of pictures: give it one of these endings")]
    UnknownFormat {
        /// The file's name.
        file: String,
    },
    /// The width of a picture is out of range.
    #[error(
        "found a picture {width_mm} mm wide, expected {WIDTH_MIN_MM} to {WIDTH_MAX_MM} mm, such as 84 for a column of a journal"
    )]
    Width {
        /// The width asked for, mm.
        width_mm: f64,
    },
    /// plotters failed.
    #[error("the figure could not be drawn: {0}")]
    Drawing(String),
}

/// Draws the picture of one analysis.
///
/// The same input gives the same bytes. A path of more than [`MOST_HOPS_DRAWN`] hops is thinned to every n-th, which the legend
/// says.
///
/// # Errors
/// [`FigureError`].
///
/// # Examples
/// ```
/// use chta::{ballistics::*, chain::*, graph::*, hop::*, path::generate, quantity::ChainPoint, figure::*, world::*};
/// let hopper = Hopper::with_speeds(10.0, 10.0).unwrap();
/// let surface = SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(0.6)?)), rest: RestSlope::AsFrictionHolds };
/// let ground = PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(30.0, 2.0), ChainPoint::new(60.0, 0.0)])?;
/// let chain = ConstrainedChain::new(ground, &hopper, Gravity::new(3.711)?, &surface)?;
/// let test = HopTest::new(chain.clone());
/// let (start, goal) = (chain.geometry().station(0.0)?, chain.geometry().station(60.0)?);
/// let answer = search(&test, start, goal, &SearchOptions::default(), &())?;
/// let Outcome::Path { legs, .. } = &answer.outcome else { panic!("no path") };
/// let path = generate(&test, legs, TakeoffChoice::LeastSpeed, Split::FullReach)?;
/// let title = FigureTitle { body: "Mars".into(), ..FigureTitle::default() };
/// let input = FigureInput { test: &test, answer: &answer, path: Some(&path), start, goal, plan_view: None, title };
/// let svg = draw(&input)?.to_svg()?;
/// assert!(svg.starts_with("<svg") && svg.contains("traversable"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(input: &FigureInput<'_>) -> Result<Picture, FigureError> {
    let (sheet, height_mm) = laid_out(input, &FigureData::new(input)?);
    Ok(Picture::page(sheet, height_mm))
}

/// The sheet with all its marks, and its height.
fn laid_out(input: &FigureInput<'_>, data: &FigureData) -> (Sheet, f64) {
    let mut sheet = Sheet::default();
    let top = heading::above(&mut sheet, input, data);
    let panel = terrain_panel::TerrainPanel::new(data, input.test.chain(), top);
    let end = panel.draw(&mut sheet);
    let end = legend::draw(&mut sheet, &legend::entries(data, panel.marks()), end + 0.5) + 2.5;
    let end = input.plan_view.as_ref().map_or(end, |view| map::draw_plan_view(&mut sheet, view, end) + 2.5);
    let end = match &data.subject {
        Subject::Path { hops, .. } if !hops.shown.is_empty() => angle_panel::draw(&mut sheet, hops, end),
        Subject::Stopped(stop) => stop_panel::draw(&mut sheet, stop, end),
        Subject::Path { .. } | Subject::NoCommands(..) | Subject::EndpointsRefuse(_) | Subject::RouteNotFound => end,
    };
    let end = heading::below(&mut sheet, data, end + 1.0);
    (sheet, end + 2.5)
}

//! The picture of a map.

use std::path::Path;

use chta::{
    figure::{Caption, GoalMark, HopMapFigure, MapPosts, RefusedPosts, ValueMapFigure, draw_hop_map, draw_value_map},
    path::HopPath,
    planner::Amount,
    quantity::MapPoint,
    report::MapAnswer,
    scenario::Scenario,
    study::{
        conditions,
        map::{MapStudy, PreparedMap},
    },
};

use crate::cli::{Failure, map_input::MapInput, output};

/// The map as a picture, in the format of the file's extension.
pub(super) fn map(input: &MapInput, prepared: &PreparedMap, study: &MapStudy, file: &Path) -> Result<Vec<u8>, Failure> {
    let MapStudy { answer, out, back, paths, least, .. } = study;
    let goals = prepared.goals.iter().zip(&answer.goals);
    let marks: Vec<GoalMark> = goals
        .clone()
        .map(|(goal, record)| GoalMark { at: goal.at, hops: record.hops.and_then(|hops| u64::try_from(hops).ok()) })
        .collect();
    let ways: Vec<Vec<MapPoint>> = goals
        .zip(paths)
        .filter_map(|((_, record), path)| {
            let start = prepared.starts.get(record.start?.checked_sub(1)?)?;
            Some(places(start.at, path.as_ref()?))
        })
        .collect();
    let starts: Vec<MapPoint> = prepared.starts.iter().map(|start| start.at).collect();
    let lines = subtitle(answer, &input.bare.scenario);
    let surface = prepared.finest().map_err(|e| Failure::of(&e))?;
    let posts = MapPosts { dem: &surface, stride: prepared.lattice.stride, per_post: prepared.lattice.per_post };
    if let Some((amount, totals)) = least.first().filter(|(amount, _)| *amount != Amount::Hops) {
        let within = answer.objective.as_ref().and_then(|objective| objective.budget.as_ref());
        let figure = ValueMapFigure {
            caption: Caption { title: format!("By the least {}: {}", amount.words(), input.title()), lines },
            posts,
            values: totals,
            value_name: format!("least {} ({})", amount.words(), amount.unit()),
            none_name: within.map_or("not reached".to_owned(), |budget| format!("not within {} {}", budget.max, amount.unit())),
            starts,
            goals: marks,
            paths: ways,
        };
        return output::encoded(draw_value_map(&figure), file);
    }
    if let Some(mobility) = study.mobility.as_ref().filter(|_| starts.is_empty()) {
        let values: Vec<f64> = mobility.share.iter().map(|share| 100.0 * f64::from(*share)).collect();
        let figure = ValueMapFigure {
            caption: Caption { title: format!("Single hops: {}", input.title()), lines: vec![conditions(&input.bare.scenario)] },
            posts,
            values: &values,
            value_name: format!(
                "mobility: share of the {}s within {:.1} m that one hop reaches (%)",
                answer.node(),
                mobility.disc_radius_m
            ),
            none_name: format!("no {} within reach", answer.node()),
            starts,
            goals: marks,
            paths: ways,
        };
        return output::encoded(draw_value_map(&figure), file);
    }
    let can_return: Option<Vec<bool>> = back.as_ref().map(|back| back.hops.iter().map(|&hops| hops >= 0).collect());
    let figure = HopMapFigure {
        caption: Caption { title: format!("Where in how few hops: {}", input.title()), lines },
        posts,
        hops: &out.hops,
        can_return: can_return.as_deref(),
        refused: refused(prepared),
        starts,
        goals: marks,
        paths: ways,
    };
    output::encoded(draw_hop_map(&figure), file)
}

/// The start and every landing.
fn places(start: MapPoint, path: &HopPath) -> Vec<MapPoint> {
    let landings = path.hops.iter().filter_map(|hop| hop.landing.map());
    std::iter::once(start).chain(landings).collect()
}

/// Which posts of the map refuse every contact: in a keep-out zone or outside the keep-in zones, and by each layer on contacts.
fn refused(prepared: &PreparedMap) -> Vec<RefusedPosts> {
    let (nodes, overlays) = (prepared.nodes(), prepared.ground.terrain().overlays());
    let where_refused = |refuses: &dyn Fn(MapPoint) -> bool| {
        let posts = (0..prepared.lattice.count()).map(|index| prepared.lattice.node(index));
        posts.map(|post| refuses(nodes.post(post.row, post.col))).collect()
    };
    let zones = overlays
        .zones()
        .next()
        .map(|_| RefusedPosts { reason: "keep-out".to_owned(), posts: where_refused(&|at| overlays.keeps_out(at)) });
    let layers = overlays.layers().iter().filter(|layer| layer.rule().on_contact).map(|layer| RefusedPosts {
        reason: format!("layer {} does not hold", layer.rule().name),
        posts: where_refused(&|at| !layer.holds_at(at)),
    });
    zones.into_iter().chain(layers).collect()
}

/// The subtitle of the picture: the map's assumptions and a summary of its result.
fn subtitle(answer: &MapAnswer, scenario: &Scenario) -> Vec<String> {
    let stride = match (answer.stride, answer.nodes_per_post) {
        (1, 1) => String::new(),
        (1, n) => format!(", {n} nodes a post spacing"),
        (stride, _) => format!(", every {stride} posts"),
    };
    let by = if answer.objective.is_some() { " by paths of" } else { " in" };
    let bound = answer.hops_max.map_or(String::new(), |most| format!(", searched up to {most}"));
    let found = format!(
        "{} of {} {}s reachable from {}{by} at most {} hops{bound}{stride}",
        answer.reachable_posts,
        answer.posts,
        answer.node(),
        answer.from(),
        answer.farthest_hops
    );
    vec![conditions(scenario), found]
}

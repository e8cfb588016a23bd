//! The picture of a map.

use std::path::Path;

use chta::{
    figure::{Caption, GoalMark, HopMapFigure, MapPosts, RefusedBy, RefusedPosts, ValueMapFigure, draw_hop_map, draw_value_map},
    path::HopPath,
    planner::Amount,
    quantity::MapPoint,
    report::MapAnswer,
    scenario::Scenario,
    study::{
        conditions,
        map::{MapStudy, NodeRefusal, PreparedMap, RefusedNodes},
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
            refused: refused(study),
            value_name: format!("least {} ({})", amount.words(), amount.unit()),
            none_name: within.map_or("not reached".to_owned(), |budget| format!("not within {} {}", budget.max, amount.unit())),
            starts,
            goals: marks,
            paths: ways,
        };
        return output::encoded(draw_value_map(&figure), file);
    }
    if let Some(mobility) = study.mobility.as_ref().filter(|_| starts.is_empty()) {
        // Where every contact is refused no hop begins: its share of 0 is drawn as the reason.
        let is_refused = |node: usize| study.refused.iter().any(|refused| refused.nodes[node]);
        let percent = |(node, share): (usize, &f32)| if is_refused(node) { f64::NAN } else { 100.0 * f64::from(*share) };
        let values: Vec<f64> = mobility.share.iter().enumerate().map(percent).collect();
        let figure = ValueMapFigure {
            caption: Caption { title: format!("Single hops: {}", input.title()), lines: vec![conditions(&input.bare.scenario)] },
            posts,
            values: &values,
            refused: refused(study),
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
        refused: refused(study),
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

/// The nodes that refuse every contact, as the picture takes them.
fn refused(study: &MapStudy) -> Vec<RefusedPosts> {
    let of = |RefusedNodes { by, nodes }: &RefusedNodes| RefusedPosts {
        by: match by {
            NodeRefusal::Zone => RefusedBy::Zone,
            NodeRefusal::TooSteep => RefusedBy::Slope,
            NodeRefusal::Footprint => RefusedBy::Footprint,
            NodeRefusal::Layer(_) => RefusedBy::Layer,
        },
        reason: by.words(),
        posts: nodes.clone(),
    };
    study.refused.iter().map(of).collect()
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

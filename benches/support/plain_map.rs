//! Hop maps by the plain method, as a reference: from each post of the layer, every unreached post within reach; first the
//! parabolas of safety, then the slice between the two posts and the hop test.

use chta::{
    ballistics::{safety_ceiling_m, safety_range_m},
    chain::{ConstrainedChain, PolygonalChain},
    hop::HopTest,
    quantity::VertexId,
    terrain::{Dem, slice},
    world::{Gravity, Grip, Hopper, SurfaceProperties},
};

/// Fewest hops from a post (row, column) to every other; -1 for unreachable posts. Every post has an elevation.
pub(crate) fn plain_map(
    dem: &Dem,
    start: (usize, usize),
    hopper: &Hopper,
    surface: &SurfaceProperties,
    gravity_m_s2: f64,
) -> Vec<i16> {
    let (rows, cols, map) = (dem.rows(), dem.cols(), dem.georeference());
    let heights: Vec<f64> = dem.elevations().map(|z_m| z_m.unwrap_or(f64::NAN)).collect();
    let (low_m, high_m) = dem.elevation_range_m();
    let speeds = [hopper.limits().takeoff_speed_max_m_s, hopper.limits().landing_speed_max_m_s].map(|v| v * (1.0 + 1e-6));
    let reach_m = speeds.map(|v| safety_range_m(high_m - low_m, v, gravity_m_s2)).into_iter().fold(f64::INFINITY, f64::min);
    let mut hops = vec![-1i16; rows * cols];
    let mut layer = vec![start];
    hops[start.0 * cols + start.1] = 0;
    for next in 1.. {
        let mut reached = Vec::new();
        for &(row, col) in &layer {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a reach in posts")]
            let (down, across) = ((reach_m / map.dy_m()) as usize, (reach_m / map.dx_m()) as usize);
            for to_row in row.saturating_sub(down)..=(row + down).min(rows - 1) {
                for to_col in col.saturating_sub(across)..=(col + across).min(cols - 1) {
                    let to = to_row * cols + to_col;
                    if hops[to] >= 0 {
                        continue;
                    }
                    let run_m = (map.post(to_row, to_col) - map.post(row, col)).norm();
                    let rise_m = heights[to] - heights[row * cols + col];
                    let within = rise_m <= safety_ceiling_m(run_m, speeds[0], gravity_m_s2)
                        && -rise_m <= safety_ceiling_m(run_m, speeds[1], gravity_m_s2);
                    if within && joins(dem, (row, col), (to_row, to_col), hopper, surface, gravity_m_s2) {
                        hops[to] = next;
                        reached.push((to_row, to_col));
                    }
                }
            }
        }
        if reached.is_empty() {
            break;
        }
        layer = reached;
    }
    hops
}

/// One hop by the slice and the hop test.
fn joins(
    dem: &Dem,
    from: (usize, usize),
    to: (usize, usize),
    hopper: &Hopper,
    surface: &SurfaceProperties,
    gravity_m_s2: f64,
) -> bool {
    let map = dem.georeference();
    let friction = match surface.grip {
        Some(Grip::Friction(cone)) => Some(cone),
        _ => None,
    };
    let chain = slice(dem, map.post(from.0, from.1), map.post(to.0, to.1))
        .ok()
        .and_then(|profile| PolygonalChain::from_profile(&profile, friction).ok())
        .and_then(|geometry| ConstrainedChain::new(geometry, hopper, Gravity::new(gravity_m_s2).expect("a gravity"), surface).ok());
    chain.is_some_and(|chain| {
        let geometry = chain.geometry();
        let ends = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        HopTest::new(chain.clone()).lofts(&ends.0, &ends.1).is_ok()
    })
}

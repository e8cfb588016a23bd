//! Layers: against the cells one by one, against a mask of the same cells, and in every form that a hop, a chain, a leg and a trial has.
#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small rasters")]

use std::sync::Arc;

use chta::{
    ballistics::TakeoffChoice,
    chain::{ConstrainedChain, GroundRefusal, PolygonalChain, Station},
    drive::{DriveGround, DriveRefusal},
    graph::{Outcome, PointSpacing, SearchOptions, search},
    ground::{DemGround, LandingTable, NodeLattice, PostHops, Surface, Sweep, Windows},
    hop::{HopTest, Split},
    path::{StatedValue, ViolatedLimit, execute, generate},
    quantity::{Angle, ChainPoint, MapPoint, VertexId},
    terrain::{
        Dem, GeoReference, KeepOut, Layer, LayerCondition, LayerCost, LayerRule, MapLayers, OverlaidDem, Overlays, read_keep_out,
        read_layer, write_geotiff,
    },
    world::{
        Contact, Direction, FrictionCone, Gravity, Grip, Hopper, LayerName, Limit, RestSlope, Rover, RoverLimits, SurfaceProperties,
    },
};

use crate::{map_world::random_dem, support::Draw};

const GRAVITY_M_S2: f64 = 1.62;

/// A layer that holds where the raster is at least 0.5.
fn layer(raster: &Dem, name: &str, [on_contact, on_flight]: [bool; 2]) -> Layer {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layer.tif");
    write_geotiff(raster, std::fs::File::create(&path).unwrap()).unwrap();
    let condition = LayerCondition { min: Some(0.5), ..LayerCondition::default() };
    read_layer(
        &path,
        LayerRule { name: LayerName::new(name).unwrap(), condition, on_contact, on_flight, outage: None, cost: None },
        None,
    )
    .unwrap()
}

/// Zones that are the cells of the same raster where the layer does not hold.
fn mask(raster: &Dem) -> KeepOut {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mask.tif");
    let kept = raster.elevations().map(|value| f64::from(value.is_none_or(|value| value < 0.5))).collect();
    let kept = Dem::new(raster.rows(), raster.cols(), kept, raster.georeference().clone()).unwrap();
    write_geotiff(&kept, std::fs::File::create(&path).unwrap()).unwrap();
    read_keep_out(&path, None, raster.bounds()).unwrap()
}

/// A raster of a layer over a DEM: cells of its own, aligned with the posts, half a post off, or anywhere; with or without gaps.
fn raster(draw: &mut Draw, dem: &Dem) -> Dem {
    let map = dem.georeference();
    let (dx_m, dy_m) = (map.dx_m(), map.dy_m());
    let aligned = draw.chance(0.5);
    let (scale, off) =
        if aligned { ([0.5, 1.0, 2.0][draw.below(3)], [0.0, 0.5][draw.below(2)]) } else { (draw.uniform(0.4, 3.0), draw.unit()) };
    let beyond_cells = if draw.chance(0.85) { 2.0 } else { -1.0 };
    let [width_m, height_m] = [dem.bounds().max.x - dem.bounds().min.x, dem.bounds().max.y - dem.bounds().min.y];
    let cells = |length_m: f64, step_m: f64| ((length_m / step_m).ceil() as usize + 5).max(2);
    let (cols, rows) = (cells(width_m, scale * dx_m), cells(height_m, scale * dy_m));
    let (share, gaps) = (draw.uniform(0.02, 0.3), if draw.chance(0.3) { 0.05 } else { 0.0 });
    let values = (0..rows * cols).map(|_| if draw.chance(gaps) { f64::NAN } else { f64::from(!draw.chance(share)) }).collect();
    let corner =
        map.north_west() + nalgebra::Vector2::new(-(beyond_cells - off) * scale * dx_m, (beyond_cells - off) * scale * dy_m);
    Dem::new(rows, cols, values, GeoReference::local(corner, scale * dx_m, scale * dy_m).unwrap()).unwrap()
}

/// Whether a line touches a cell that does not hold or leaves the raster, by all cells one by one.
fn refused_by_cells(raster: &Dem, from: MapPoint, to: MapPoint) -> bool {
    let map = raster.georeference();
    let place = |at: MapPoint| [(at.x - map.north_west().x) / map.dx_m() + 0.5, (map.north_west().y - at.y) / map.dy_m() + 0.5];
    let (a, b) = (place(from), place(to));
    let meets = |low: [f64; 2]| {
        // The shares of the way between the sides of the cell.
        let (mut begin, mut end) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let (low, high) = (low[axis] - 1e-9, low[axis] + 1.0 + 1e-9);
            let by = b[axis] - a[axis];
            if by == 0.0 {
                if a[axis] < low || a[axis] > high {
                    return false;
                }
                continue;
            }
            let (s, t) = ((low - a[axis]) / by, (high - a[axis]) / by);
            (begin, end) = (begin.max(s.min(t)), end.min(s.max(t)));
        }
        begin <= end
    };
    let counts = [raster.cols() as f64, raster.rows() as f64];
    let leaves = |at: [f64; 2]| (0..2).any(|axis| at[axis] < -1e-9 || at[axis] > counts[axis] + 1e-9);
    let holds = |row, col| raster.elevation(row, col).is_some_and(|value| value >= 0.5);
    let cells = (0..raster.rows()).flat_map(|row| (0..raster.cols()).map(move |col| (row, col)));
    leaves(a) || leaves(b) || cells.into_iter().any(|(row, col)| !holds(row, col) && meets([col as f64, row as f64]))
}

fn surface(mu: f64) -> SurfaceProperties {
    SurfaceProperties { grip: Some(Grip::Friction(FrictionCone::new(mu).unwrap())), rest: RestSlope::AsFrictionHolds }
}

fn ground(dem: &Dem, overlays: Overlays, speed_m_s: f64) -> DemGround {
    let hopper = Hopper::with_speeds(speed_m_s, speed_m_s).unwrap();
    DemGround::new(OverlaidDem::new(dem.clone(), overlays), &hopper, Gravity::new(GRAVITY_M_S2).unwrap(), &surface(1.0))
}

/// A point of a DEM: anywhere, or on a lattice that the borders of aligned cells lie on.
fn place(draw: &mut Draw, dem: &Dem) -> MapPoint {
    let (bounds, map) = (dem.bounds(), dem.georeference());
    if draw.chance(0.5) {
        let node = |draw: &mut Draw, posts: usize| 0.25 * draw.below(4 * (posts - 1) + 1) as f64;
        let (col, row) = (node(draw, dem.cols()), node(draw, dem.rows()));
        return MapPoint::new(map.north_west().x + col * map.dx_m(), map.north_west().y - row * map.dy_m());
    }
    MapPoint::new(draw.uniform(bounds.min.x, bounds.max.x), draw.uniform(bounds.min.y, bounds.max.y))
}

#[test]
fn a_layer_holds_along_a_line_that_touches_no_other_cell() {
    let draw = &mut Draw::seeded(2101);
    let (mut held, mut refused, mut points) = (0, 0, 0);
    for _ in 0..300 {
        let dem = random_dem(draw, 9);
        let raster = raster(draw, &dem);
        let layer = layer(&raster, "sun", [true, true]);
        for _ in 0..40 {
            let (from, to) = (place(draw, &dem), place(draw, &dem));
            let expected = !refused_by_cells(&raster, from, to);
            assert_eq!(layer.holds_between(from, to), expected, "{from} to {to} over {:?}", raster.georeference());
            assert_eq!(layer.holds_between(to, from), expected);
            assert_eq!(layer.holds_at(from), !refused_by_cells(&raster, from, from));
            points += u32::from(layer.holds_at(from));
            *(if expected { &mut held } else { &mut refused }) += 1;
        }
    }
    assert!(held > 1000 && refused > 3000 && points > 3000, "{held} {refused} {points}");
}

/// A hop under a contact layer is a hop with the same cells kept out, where no contact lies on a border; under a flight layer it is a hop
/// without it whose line touches no refused cell. In every form that a hop has: over nodes, by the slice, and by the walk of replanning.
#[test]
fn hops_under_layers_are_those_over_a_mask_by_hand() {
    let draw = &mut Draw::seeded(2102);
    let (mut hops, mut by_contact, mut by_flight, mut unlike) = (0, 0, 0, 0);
    for round in 0..40 {
        let dem = random_dem(draw, 8);
        let map = dem.georeference();
        // On the posts' own cells, in whose middles the posts lie.
        let values = (0..64).map(|_| f64::from(!draw.chance(0.15))).collect();
        let own = Dem::new(8, 8, values, map.clone()).unwrap();
        let other = raster(draw, &dem);
        let speed_m_s = draw.uniform(1.5, 4.0);
        let per_post = 1 + round % 2;
        let lattice = NodeLattice::finer(&dem, per_post);
        let over = |overlays: Overlays| PostHops::over(ground(&dem, overlays, speed_m_s), lattice).unwrap();
        let bare = over(Overlays::default());
        let flown = over(Overlays::default().with_layers(MapLayers::new(vec![layer(&other, "link", [false, true])])));
        let contacts = over(Overlays::default().with_layers(MapLayers::new(vec![layer(&own, "sun", [true, false])])));
        let masked = over(Overlays::new(None, Some(mask(&own))));
        for index in 0..lattice.count() {
            let from = lattice.node(index);
            for offset in 0..bare.offset_count() {
                let Some(to) = bare.landing(from, offset) else { continue };
                let [begin, end] = [from, to].map(|node| lattice.at(map, node));
                let free = bare.lofts(from, offset).unwrap();
                let clear = !refused_by_cells(&other, begin, end);
                let under_flight = flown.lofts(from, offset).unwrap();
                assert_eq!(under_flight, free.filter(|_| clear), "{begin} to {end}");
                by_flight += u32::from(free.is_some() && !clear);
                let stands = ![begin, end].iter().any(|at| refused_by_cells(&own, *at, *at));
                let under_contact = contacts.lofts(from, offset).unwrap();
                assert_eq!(under_contact, free.filter(|_| stands), "{begin} to {end}");
                by_contact += u32::from(free.is_some() && !stands);
                if per_post == 1 {
                    // The borders of a mask add vertices to a slice: by their rounding, a hop on the very edge of a limit may differ.
                    let under_mask = masked.lofts(from, offset).unwrap();
                    assert!(stands || under_mask.is_none(), "{begin} to {end}");
                    unlike += u32::from(under_mask.is_some() != under_contact.is_some());
                }
                hops += u32::from(under_contact.is_some());
                if draw.chance(0.02) {
                    for (hops, expected) in [(&flown, under_flight), (&contacts, under_contact)] {
                        let places = [hops.position(from), hops.position(to)];
                        let [Some(a), Some(b)] = places else { continue };
                        let exact = hops.ground().windows(&a, &b).is_some_and(|windows| !windows.lofts.is_empty());
                        assert_eq!(exact, expected.is_some(), "{begin} to {end}");
                    }
                }
            }
        }
    }
    assert!(hops > 10_000 && by_contact > 3000 && by_flight > 3000, "{hops} {by_contact} {by_flight}");
    assert!(unlike * 500 < hops, "{unlike} of {hops} hops differ from those over the mask");
}

/// A transect under layers, its ground and a hopper.
fn transect(draw: &mut Draw) -> (ConstrainedChain, Dem, [bool; 2]) {
    loop {
        let dem = random_dem(draw, 12);
        let raster = raster(draw, &dem);
        let applied = [[true, false], [false, true], [true, true]][draw.below(3)];
        let overlays = Overlays::default().with_layers(MapLayers::new(vec![layer(&raster, "sun", applied)]));
        let ground = ground(&dem, overlays, draw.uniform(1.5, 5.0));
        let (from, to) = (place(draw, &dem), place(draw, &dem));
        if (to - from).norm() > 4.0 * dem.georeference().dx_m()
            && let Ok(chain) = ground.chain(from, to)
        {
            return (chain, raster, applied);
        }
    }
}

#[test]
fn a_transect_obeys_the_layers_under_it() {
    let draw = &mut Draw::seeded(2103);
    let (mut allowed, mut by_contact, mut by_flight, mut swept) = (0, 0, 0, 0);
    for _ in 0..150 {
        let (chain, raster, [on_contact, on_flight]) = transect(draw);
        let bare = PolygonalChain::new(
            chain.geometry().vertices().to_vec(),
            chain.geometry().grounds().to_vec(),
            chain.geometry().map_points().map(<[MapPoint]>::to_vec),
        );
        let bare = HopTest::new(ConstrainedChain::new(bare.unwrap(), chain.hopper(), chain.gravity(), chain.surface()).unwrap());
        let test = HopTest::new(chain);
        let geometry = test.chain().geometry();
        let (first_m, last_m) = geometry.extent_m();
        let mut stations: Vec<Station> = (0..=geometry.segment_count()).map(|i| geometry.vertex_station(VertexId(i))).collect();
        stations.extend((0..20).map(|_| geometry.station(draw.uniform(first_m, last_m)).unwrap()));
        stations.sort_by(|a, b| a.point.x_m.total_cmp(&b.point.x_m));
        let map = |station: &Station| geometry.map_point(station).unwrap();
        let sun = Limit::Layer(LayerName::new("sun").unwrap());
        let table = Arc::new(LandingTable::new(&test, stations.as_slice()));
        let mut sweep = Sweep::new(Arc::clone(&table));
        for takeoff in &stations {
            for direction in Direction::BOTH {
                sweep.landings(takeoff, 0..stations.len(), direction, |i, verdict| {
                    let landing = &stations[i];
                    let plain = test.lofts(takeoff, landing);
                    assert_eq!(verdict.is_ok(), plain.is_ok());
                    let [a, b] = [map(takeoff), map(landing)];
                    let stands = !on_contact || ![a, b].iter().any(|at| refused_by_cells(&raster, *at, *at));
                    let clear = !on_flight || !refused_by_cells(&raster, a, b);
                    let free = bare.lofts(takeoff, landing);
                    assert_eq!(plain.is_ok(), free.is_ok() && stands && clear, "{a} to {b}");
                    if free.is_ok() && !(stands && clear) {
                        assert_eq!((verdict, plain), (Err(sun), Err(sun)));
                        by_contact += u32::from(!stands);
                        by_flight += u32::from(!clear);
                        let set = test.takeoff_set(takeoff, landing).unwrap();
                        assert_eq!(set.conflict().unwrap().counted_under(), sun);
                    }
                    allowed += u32::from(plain.is_ok());
                    swept += 1;
                });
            }
        }
    }
    assert!(
        allowed > 3000 && by_contact > 1000 && by_flight > 1000 && swept > 50_000,
        "{allowed} {by_contact} {by_flight} {swept}"
    );
}

/// A planned path holds for the checker; on the same ground with a layer that refuses what the path uses it does not, under that name.
#[test]
fn the_checker_judges_layers_by_itself() {
    let draw = &mut Draw::seeded(2104);
    let (mut verified, mut spoiled) = (0, 0);
    for _ in 0..400 {
        let (chain, _, _) = transect(draw);
        let test = HopTest::new(chain);
        let geometry = test.chain().geometry();
        let (start, goal) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(2)), ..SearchOptions::default() };
        let Outcome::Path { legs, .. } = search(&test, start, goal, &options, &()).unwrap().outcome else { continue };
        let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::Equal).unwrap();
        let execution = execute(test.chain(), &path, Some((start, goal)));
        assert!(execution.passes(), "{:?}", execution.violations);
        verified += 1;
        // A cell under a place of a hop that is not near a border of the cell.
        let hop = &path.hops[draw.below(path.hops.len())];
        let [from, to] = [hop.takeoff.map().unwrap(), hop.landing.map().unwrap()];
        let in_flight = draw.chance(0.5);
        let at = if in_flight { from + (to - from) * draw.unit() } else { to };
        let cell_m = draw.log_uniform(0.02, 1.0) * (to - from).norm();
        let north_west = at + nalgebra::Vector2::new(-50.0 * cell_m, 50.0 * cell_m);
        let values = (0..101 * 101).map(|cell| f64::from(cell != 50 * 101 + 50)).collect();
        let planted = Dem::new(101, 101, values, GeoReference::local(north_west, cell_m, cell_m).unwrap()).unwrap();
        let whole = |at: MapPoint| (at - planted.bounds().min).min() > cell_m && (planted.bounds().max - at).min() > cell_m;
        if !path.hops.iter().all(|hop| [hop.takeoff, hop.landing].iter().all(|end| whole(end.map().unwrap()))) {
            continue;
        }
        let layers = MapLayers::new(vec![layer(&planted, "planted", [!in_flight, in_flight])]);
        let other = ConstrainedChain::new(
            geometry.clone().with_layers(&layers),
            test.hopper(),
            test.chain().gravity(),
            test.chain().surface(),
        );
        let violated = execute(&other.unwrap(), &path, None).violations;
        let planted = ViolatedLimit::Limit(Limit::Layer(LayerName::new("planted").unwrap()));
        assert!(violated.iter().any(|violation| violation.limit == planted), "{violated:?}");
        assert!(violated.iter().all(|violation| violation.limit == planted), "{violated:?}");
        spoiled += 1;
    }
    assert!(verified > 60 && spoiled > 30, "{verified} {spoiled}");
}

/// Hops along one long segment touch no ground that a layer refuses.
#[test]
fn the_checker_sums_costs_of_layers_by_itself() {
    let draw = &mut Draw::seeded(2107);
    let (mut held, mut noticed) = (0, 0);
    for case in 0..120 {
        let dem = random_dem(draw, 12);
        let values = (0..30 * 30).map(|_| if draw.chance(0.3) { 0.0 } else { draw.uniform(0.0, 5.0) }).collect();
        let (scale, map) = ([0.37, 0.5, 1.0][draw.below(3)], dem.georeference());
        let corner = map.north_west() + nalgebra::Vector2::new(-2.0 * scale * map.dx_m(), 2.0 * scale * map.dy_m());
        let raster = GeoReference::local(corner, scale * map.dx_m(), scale * map.dy_m()).unwrap();
        let raster = Dem::new(30, 30, values, raster).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("cost.tif");
        write_geotiff(&raster, std::fs::File::create(&file).unwrap()).unwrap();
        let [per_contact, per_m] = [[2.0, 0.0], [0.0, 0.3], [1.0, 1.0]][draw.below(3)];
        let cost = Some(LayerCost { per_contact, per_m, total_max: None });
        let (name, condition) = (LayerName::new("hazard").unwrap(), LayerCondition::default());
        let rule = LayerRule { name, condition, on_contact: false, on_flight: false, outage: None, cost };
        let layers = MapLayers::new(vec![read_layer(&file, rule, None).unwrap()]);
        let ground = ground(&dem, Overlays::default().with_layers(layers.clone()), draw.uniform(2.0, 6.0));
        let ends = [place(draw, &dem), place(draw, &dem)];
        let Ok(chain) = ground.chain(ends[0], ends[1]) else { continue };
        let test = HopTest::new(chain);
        let geometry = test.chain().geometry();
        let (start, goal) = (geometry.vertex_station(VertexId(0)), geometry.vertex_station(VertexId(geometry.segment_count())));
        let options = SearchOptions { spacing: Some(PointSpacing::PerSegment(2)), ..SearchOptions::default() };
        let Ok(answer) = search(&test, start, goal, &options, &()) else { continue };
        let Outcome::Path { legs, .. } = answer.outcome else { continue };
        let Ok(path) = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::Equal) else { continue };
        let stated = path.totals.layers.of(name).unwrap_or_default();
        let execution = execute(test.chain(), &path, Some((start, goal)));
        assert!(execution.passes(), "case {case}: {stated} {:?}", execution.violations);
        let Some(hop) = path.hops.first() else { continue };
        let (from, to) = hop.map_ends().unwrap();
        let own = layers.iter().next().unwrap().cost_of_hop(from, to);
        assert!(own >= 0.0 && own <= stated * (1.0 + 1e-12));
        held += 1;
        let mut spoiled = path.clone();
        spoiled.totals.layers = path.totals.layers.with(name, stated * 1.001 + 0.01);
        let violations = execute(test.chain(), &spoiled, Some((start, goal))).violations;
        assert!(matches!(violations[..], [v] if v.limit == ViolatedLimit::StatedValue(StatedValue::LayerCost)), "{violations:?}");
        noticed += u32::from(stated > 0.0);
    }
    assert!(held > 20 && noticed > 15, "{held} held, {noticed} with a cost");
}

#[test]
fn hops_along_a_segment_leave_out_what_a_layer_refuses() {
    let map = GeoReference::local(MapPoint::new(0.0, 40.0), 40.0, 40.0).unwrap();
    let plain = Dem::new(2, 2, vec![0.0; 4], map).unwrap();
    let shade = |cells: std::ops::Range<usize>| {
        let values = (0..3 * 50).map(|cell| f64::from(!cells.contains(&(cell % 50)))).collect();
        Dem::new(3, 50, values, GeoReference::local(MapPoint::new(0.5, 40.0), 1.0, 20.0).unwrap()).unwrap()
    };
    // One hop of 45 degrees spans 2.47 m.
    let reach_m = 4.0 / GRAVITY_M_S2;
    for (cells, on_contact, hops) in [(20..21, true, true), (20..23, true, false), (20..21, false, false), (45..46, false, true)] {
        let layers = MapLayers::new(vec![layer(&shade(cells.clone()), "sun", [on_contact, !on_contact])]);
        let ground = ground(&plain, Overlays::default().with_layers(layers), 2.0);
        let test = HopTest::new(ground.chain(MapPoint::new(1.0, 10.0), MapPoint::new(39.0, 10.0)).unwrap());
        let geometry = test.chain().geometry();
        let (start, goal) = (geometry.station(0.0).unwrap(), geometry.station(38.0).unwrap());
        let outcome = search(&test, start, goal, &SearchOptions::default(), &()).unwrap().outcome;
        let Outcome::Path { legs, .. } = outcome else {
            assert!(!hops, "{cells:?} {on_contact}");
            continue;
        };
        assert!(hops, "{cells:?} {on_contact}");
        let path = generate(&test, &legs, TakeoffChoice::LeastSpeed, Split::FullReach).unwrap();
        assert!(path.hops.len() as f64 >= 38.0 / reach_m);
        let shaded = |x: f64| cells.contains(&(x.floor() as usize));
        assert!(path.hops.iter().all(|hop| !on_contact || !shaded(hop.landing.map().unwrap().x)), "{cells:?}");
    }
}

#[test]
fn a_start_in_the_shade_is_refused_with_the_nearest_place_in_the_sun() {
    let map = GeoReference::local(MapPoint::new(0.0, 9.0), 9.0, 9.0).unwrap();
    let plain = Dem::new(2, 2, vec![0.0; 4], map).unwrap();
    let values = (0..100).map(|cell| f64::from(cell % 10 > 2)).collect();
    let raster = Dem::new(10, 10, values, GeoReference::local(MapPoint::new(0.0, 9.0), 1.0, 1.0).unwrap()).unwrap();
    let ground = ground(&plain, Overlays::default().with_layers(MapLayers::new(vec![layer(&raster, "sun", [true, false])])), 2.0);
    let chain = ground.chain(MapPoint::new(1.0, 4.0), MapPoint::new(8.0, 4.0)).unwrap();
    let start = chain.geometry().station(0.0).unwrap();
    let refusal = chta::graph::endpoint_refusal(&chain, &start, Contact::Takeoff, Direction::Forward).unwrap();
    assert_eq!(refusal.refusal, GroundRefusal::Layer(LayerName::new("sun").unwrap()));
    // The shade ends 2.5 m east of the first post, 1.5 m from the start.
    assert!((refusal.nearest.unwrap().point.x_m - 1.5).abs() < 1e-4, "{:?}", refusal.nearest);
    let hops = PostHops::new(ground, 1).unwrap();
    assert_eq!(hops.refusal(hops.lattice().node(0)).unwrap().to_string(), "is refused by the layer sun");
}

/// A leg is driven where the layer holds all along it, and the leg without the layer is allowed.
#[test]
fn wheels_obey_layers_all_along_a_leg() {
    let draw = &mut Draw::seeded(2105);
    let rover = Rover::new(RoverLimits::new(0.1, Angle::from_degrees(60.0)), None).unwrap();
    let (mut driven, mut refused) = (0, 0);
    for _ in 0..150 {
        let dem = random_dem(draw, 9);
        let raster = raster(draw, &dem);
        let layers = MapLayers::new(vec![layer(&raster, "sun", [true, false]), layer(&raster, "a-link", [false, true])]);
        let [bare, laid] =
            [Overlays::default(), Overlays::default().with_layers(layers)].map(|overlays| ground(&dem, overlays, 1.0));
        for _ in 0..20 {
            let ends = [place(draw, &dem), place(draw, &dem)];
            let [Some(from), Some(to)] = ends.map(|at| bare.position(at)) else { continue };
            let Ok(leg) = DriveGround::new(&bare, &rover).leg(&from, &to) else { continue };
            match DriveGround::new(&laid, &rover).leg(&from, &to) {
                Ok(same) => {
                    assert_eq!(same, leg);
                    assert!(!refused_by_cells(&raster, from.at, to.at));
                    driven += 1;
                }
                Err(refusal) => {
                    assert_eq!(refusal, DriveRefusal::Layer { layer: LayerName::new("sun").unwrap() });
                    assert!(refused_by_cells(&raster, from.at, to.at));
                    refused += 1;
                }
            }
        }
    }
    assert!(driven > 100 && refused > 100, "{driven} {refused}");
}

#[test]
fn the_name_of_a_layer_is_the_name_of_a_refusal() {
    let flat = ConstrainedChain::new(
        PolygonalChain::bare(vec![ChainPoint::new(0.0, 0.0), ChainPoint::new(9.0, 0.0)]).unwrap(),
        &Hopper::with_speeds(2.0, 2.0).unwrap(),
        Gravity::new(GRAVITY_M_S2).unwrap(),
        &surface(1.0),
    );
    assert!(Surface::layers(&flat.unwrap()).is_none(), "a chain without a map has no layers");
    let sun = Limit::Layer(LayerName::new("sun").unwrap());
    let mut counts = chta::graph::RefusalCounts::default();
    (0..3).for_each(|_| counts.count(sun));
    counts.count(Limit::Terrain);
    let mut twice = counts.clone();
    twice += counts;
    assert_eq!((twice.of(sun), twice.total(), twice.ranked()), (6, 8, vec![(sun, 6), (Limit::Terrain, 2)]));
    let json = serde_json::to_value(chta::report::LimitCounts::from(&twice)).unwrap();
    assert_eq!(json, serde_json::json!({ "layer:sun": 6, "terrain": 2 }));
}

//! Synthetic meshes with overhangs, from a seed: a cave, an overhang, a rubble field.
//!
//! ```text
//!     cave                          overhang                         rubble
//!     ______________                    ________________                  __   _
//!    |  __________  |  tunnel with          |___________|  roof        __/  \_/ \__    boulders on a floor,
//!    |_/          \_|  a rough floor        |  |             pillar   |____________|   some on others
//!    |______________|  and ceiling     _____|__|_________
//!                                     |__________________|  floor
//! ```
//!
//! All bodies are closed, their outer sides outwards; where they overlap, their union is meant. Corners lie on a grid of 1/256 m, which
//! every format holds exactly.

use std::collections::HashMap;

use nalgebra::{Point3, Vector3};

use super::random::{Draws, Layer};
use crate::terrain::{FaceKind, Mesh, TerrainError, mesh::FaceKindsBuilder};

/// A scene of closed bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SyntheticMesh {
    /// A tunnel of some 24 m, about 3 m wide and 2 m high, that bends and climbs.
    Cave,
    /// A cliff whose roof reaches 5 m out, 3 m over the ground.
    Overhang,
    /// Boulders of 0.4 to 2 m on ground of 16 m by 10 m.
    Rubble,
}

impl SyntheticMesh {
    /// All scenes.
    pub const ALL: [Self; 3] = [Self::Cave, Self::Overhang, Self::Rubble];

    /// The name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cave => "cave",
            Self::Overhang => "overhang",
            Self::Rubble => "rubble",
        }
    }
}

/// Corners and triangles under construction.
#[derive(Debug, Default)]
struct Solids {
    corners: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    kinds: FaceKindsBuilder,
}

/// The grid of all corners, 1/m.
const GRID: f64 = 256.0;

impl Solids {
    /// The triangles that follow belong to a group.
    fn begin(&mut self, group: &str) {
        self.kinds.begin(FaceKind { names: vec![group.to_owned()], ..FaceKind::default() });
    }

    fn corner(&mut self, at: Point3<f64>) -> u32 {
        self.corners.push(at.map(|coordinate| (coordinate * GRID).round() / GRID));
        u32::try_from(self.corners.len() - 1).unwrap_or(u32::MAX)
    }

    /// Two triangles; the corners run counter-clockwise seen from outside.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.extend([[a, b, c], [a, c, d]]);
        self.kinds.fill(self.triangles.len());
    }

    /// The surface of a block of cells, each corner placed by its position in the block, from -1 to 1 along each axis.
    fn block(&mut self, cells: [u32; 3], mut place: impl FnMut(Vector3<f64>) -> Point3<f64>) {
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let share = |at: u32, of: u32| 2.0 * f64::from(at) / f64::from(of) - 1.0;
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for end in [0, cells[axis]] {
                for i in 0..cells[u] {
                    for j in 0..cells[v] {
                        let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[di, dj]: [u32; 2]| {
                            let mut at = [0; 3];
                            (at[axis], at[u], at[v]) = (end, i + di, j + dj);
                            if let Some(corner) = known.get(&at) {
                                return *corner;
                            }
                            let place = place(Vector3::from([0, 1, 2].map(|axis| share(at[axis], cells[axis]))));
                            let corner = self.corner(place);
                            known.insert(at, corner);
                            corner
                        });
                        // The axes u, v, axis are right-handed.
                        if end == 0 {
                            corners.reverse();
                        }
                        self.quad(corners);
                    }
                }
            }
        }
    }

    /// A box with a rough surface.
    fn rough_box(&mut self, draws: &mut Draws, [low, high]: [[f64; 3]; 2], cell_m: f64, rough_m: f64) {
        let (low, high) = (Point3::from(low), Point3::from(high));
        let size = high - low;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cells")]
        let cells = [size.x, size.y, size.z].map(|length| (length / cell_m).round().max(1.0) as u32);
        self.block(cells, |at| {
            let shake = Vector3::from_fn(|_, _| draws.between(-rough_m, rough_m));
            low + size.component_mul(&(at.add_scalar(1.0) * 0.5)) + shake
        });
    }

    /// A boulder: a sphere with half-axes, and bumps.
    fn boulder(&mut self, draws: &mut Draws, middle: Point3<f64>, half_m: Vector3<f64>) {
        self.block([4; 3], |at| middle + at.normalize().component_mul(&half_m) * draws.between(0.88, 1.12));
    }

    /// A tube whose wall is rough inside: rings of corners about stations, an inner one and an outer one.
    fn tunnel(&mut self, stations: u32, around: u32, mut ring: impl FnMut(u32, u32) -> [Point3<f64>; 2]) {
        let mut corners: [Vec<u32>; 2] = [Vec::new(), Vec::new()];
        for station in 0..=stations {
            for step in 0..around {
                for (side, at) in ring(station, step).into_iter().enumerate() {
                    let corner = self.corner(at);
                    corners[side].push(corner);
                }
            }
        }
        let at = |side: usize, station: u32, step: u32| corners[side][(station * around + step % around) as usize];
        let mut quads = Vec::new();
        for station in 0..stations {
            for step in 0..around {
                let of = |side| {
                    [
                        at(side, station, step),
                        at(side, station, step + 1),
                        at(side, station + 1, step + 1),
                        at(side, station + 1, step),
                    ]
                };
                let mut inner = of(0);
                inner.reverse();
                quads.extend([inner, of(1)]);
            }
        }
        for step in 0..around {
            let of = |station| [at(0, station, step), at(1, station, step), at(1, station, step + 1), at(0, station, step + 1)];
            let mut first = of(0);
            first.reverse();
            quads.extend([first, of(stations)]);
        }
        for quad in quads {
            self.quad(quad);
        }
    }
}

/// Generates a mesh.
///
/// # Errors
/// [`TerrainError::InvalidMesh`], which these bodies do not give.
///
/// # Examples
/// ```
/// use chta::terrain::{MeshTree, SyntheticMesh, synthesise_mesh};
/// let cave = MeshTree::new(synthesise_mesh(SyntheticMesh::Cave, 1)?);
/// assert_eq!(cave.body_counts(), [1, 1, 0]);
/// # Ok::<(), chta::terrain::TerrainError>(())
/// ```
pub fn synthesise_mesh(scene: SyntheticMesh, seed: u64) -> Result<Mesh, TerrainError> {
    let draws = &mut Draws::of(seed, Layer::Solids);
    let mut solids = Solids::default();
    match scene {
        SyntheticMesh::Cave => cave(&mut solids, draws),
        SyntheticMesh::Overhang => {
            solids.begin("floor");
            solids.rough_box(draws, [[-8.0, -4.0, -0.5], [8.0, 4.0, 0.0]], 0.5, 0.04);
            solids.begin("pillar");
            solids.rough_box(draws, [[4.0, -3.5, -0.25], [7.0, 3.5, 3.5]], 0.5, 0.05);
            solids.begin("roof");
            solids.rough_box(draws, [[-1.0, -3.5, 3.0], [7.0, 3.5, 4.0]], 0.5, 0.05);
            solids.begin("step");
            solids.rough_box(draws, [[-3.5, -3.0, -0.25], [-2.0, 3.0, 1.0]], 0.5, 0.04);
        }
        SyntheticMesh::Rubble => rubble(&mut solids, draws),
    }
    let Solids { corners, triangles, kinds } = solids;
    Mesh::with_faces(corners, triangles, kinds.finish())
}

/// A rough tube that bends to the side and climbs, with a flattened floor.
fn cave(solids: &mut Solids, draws: &mut Draws) {
    const STATIONS: u32 = 40;
    const AROUND: u32 = 20;
    const LENGTH_M: f64 = 24.0;
    solids.begin("rock");
    solids.tunnel(STATIONS, AROUND, |station, step| {
        let share = f64::from(station) / f64::from(STATIONS);
        let middle = Point3::new(LENGTH_M * share, 2.0 * libm::sin(4.0 * share), 1.5 * share + 0.3 * libm::sin(9.0 * share));
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * f64::from(step) / f64::from(AROUND));
        let rough = draws.between(0.93, 1.07);
        // The floor is flatter than the ceiling, 0.8 m below the middle.
        let inner = Vector3::new(0.0, 1.6 * cosine * rough, if sine < 0.0 { 0.8 * libm::cbrt(sine) } else { 1.3 * sine * rough });
        let floor = if sine < -0.3 { draws.between(-0.04, 0.04) } else { 0.0 };
        [middle + inner + Vector3::new(0.0, 0.0, floor), middle + Vector3::new(0.0, 2.4 * cosine, 2.0 * sine)]
    });
}

/// Boulders on a floor, the later ones on earlier ones where these lie below them.
fn rubble(solids: &mut Solids, draws: &mut Draws) {
    solids.begin("ground");
    solids.rough_box(draws, [[-8.0, -5.0, -0.5], [8.0, 5.0, 0.0]], 0.5, 0.05);
    let mut placed: Vec<(Point3<f64>, Vector3<f64>)> = Vec::new();
    for number in 0..24 {
        let size_m = 0.4 * libm::pow(5.0, draws.uniform() * draws.uniform());
        let half_m = Vector3::from_fn(|_, _| 0.5 * size_m * draws.between(0.7, 1.3));
        let (x, y) = (draws.between(-6.5, 6.5), draws.between(-4.0, 4.0));
        let below = placed.iter().filter(|(middle, half_m)| {
            let (u, v) = ((x - middle.x) / half_m.x, (y - middle.y) / half_m.y);
            u * u + v * v < 0.8
        });
        let ground_m = below.map(|(middle, half_m)| middle.z + 0.7 * half_m.z).fold(0.0, f64::max);
        let middle = Point3::new(x, y, ground_m + 0.6 * half_m.z);
        solids.begin(&format!("boulder_{}", number + 1));
        solids.boulder(draws, middle, half_m);
        placed.push((middle, half_m));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::MeshTree;

    #[test]
    fn all_bodies_are_closed_and_face_outwards_and_seeds_repeat() {
        for scene in SyntheticMesh::ALL {
            for seed in 1..6 {
                let mesh = synthesise_mesh(scene, seed).unwrap();
                assert_eq!(mesh, synthesise_mesh(scene, seed).unwrap());
                assert_ne!(mesh, synthesise_mesh(scene, seed + 1).unwrap());
                assert_eq!(mesh.dropped_triangles(), 0, "{scene:?} {seed}");
                let tree = MeshTree::new(mesh);
                let [bodies, closed, inverted] = tree.body_counts();
                let wanted = match scene {
                    SyntheticMesh::Cave => 1,
                    SyntheticMesh::Overhang => 4,
                    SyntheticMesh::Rubble => 25,
                };
                assert_eq!([bodies, closed, inverted], [wanted, wanted, 0], "{scene:?} {seed}");
                assert_eq!((tree.flaws().duplicates, tree.flaws().crossed), (0, Some(0)), "{scene:?} {seed}");
            }
        }
    }
}

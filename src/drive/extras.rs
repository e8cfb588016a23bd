//! What legs between posts have to keep beside slopes: zones, layers, steps and roughness.

use rayon::prelude::*;

use super::{
    leg::DriveGround,
    refusal::DriveLimit,
    slopes::{KEPT, NO_LEG},
    template::{Facet, Piece, Place, Template},
    wheels::Axles,
};
use crate::{
    ground::{MapPosition, NodeLattice, OverlayTable, Post},
    terrain::OverlaidDem,
};

/// The limits beside those of slopes, for legs between posts.
#[derive(Debug)]
pub(super) struct Extras<'a> {
    drive: &'a DriveGround<'a>,
    lattice: NodeLattice,
    zones: Zones,
    /// Whether layers restrict contacts.
    layers: bool,
    /// Of every offset, where the step is limited.
    wheels: Vec<Wheels>,
    /// Of every post, where the roughness is limited: [`KEPT`], or the limit that refuses it.
    rough: Vec<u8>,
}

/// Keep-out zones at posts.
#[derive(Debug)]
enum Zones {
    None,
    /// Where no border is near, a leg lies inside or outside with its posts.
    Table(Box<OverlayTable>),
    /// The mask does not cover the whole DEM: every leg is looked at by itself.
    EachLeg,
}

/// The heights under the axles of a leg of one offset.
#[derive(Debug)]
struct Wheels {
    template: Template,
    axles: Option<Axles>,
}

impl<'a> Extras<'a> {
    /// Of the legs of these offsets; `None` if no such limit is set.
    pub(super) fn new(drive: &'a DriveGround<'a>, lattice: NodeLattice, offsets: &[(i32, i32)]) -> Option<Self> {
        let terrain = drive.ground().terrain();
        let limits = drive.rover().limits();
        let keeps_out = terrain.overlays().zones().next().is_some();
        let layers = terrain.overlays().layers().iter().any(|layer| layer.rule().on_contact);
        if !keeps_out && !layers && limits.step_max_m.is_none() && limits.roughness_max_m.is_none() {
            return None;
        }
        let zones = if keeps_out {
            let alone = OverlaidDem::new(terrain.shared_dem(), terrain.overlays().zones_alone());
            let table = OverlayTable::new(&alone, None).ok().flatten();
            table.map_or(Zones::EachLeg, |table| Zones::Table(Box::new(table)))
        } else {
            Zones::None
        };
        let base_m = limits.wheelbase_m.filter(|_| limits.step_max_m.is_some());
        let map = terrain.dem().georeference();
        let wheels = base_m.map_or_else(Vec::new, |base_m| {
            offsets
                .iter()
                .map(|offset| {
                    let template = Template::new(map, *offset, 0.5 * base_m);
                    let x_m: Vec<f64> = template.vertices.iter().map(|vertex| vertex.x_m).collect();
                    Wheels { axles: Axles::new(&x_m, base_m), template }
                })
                .collect()
        });
        let rough = |post: usize| {
            let position = lattice.position(terrain.dem(), lattice.node(post));
            match position.and_then(|position| drive.residual_m(&position)) {
                None => DriveLimit::Ground as u8,
                Some(residual_m) if residual_m > drive.heights_m()[1] => DriveLimit::Roughness as u8,
                Some(_) => KEPT,
            }
        };
        let rough = match limits.roughness_max_m {
            Some(_) => (0..lattice.count()).into_par_iter().map(rough).collect(),
            None => Vec::new(),
        };
        Some(Self { drive, lattice, zones, layers, wheels, rough })
    }

    /// Judges the leg of an offset from a post there and back, after its slopes. `heights` is a buffer.
    pub(super) fn judge(
        &self,
        from: Post,
        (index, offset): (usize, (i32, i32)),
        verdicts: [u8; 2],
        heights: &mut Vec<f64>,
    ) -> [u8; 2] {
        let no_ground = DriveLimit::Ground as u8;
        if verdicts == [NO_LEG; 2] || verdicts == [no_ground; 2] {
            return verdicts;
        }
        let to =
            Post { row: from.row.wrapping_add_signed(-offset.1 as isize), col: from.col.wrapping_add_signed(offset.0 as isize) };
        if self.keeps_out(from, to) {
            return [DriveLimit::KeepOut as u8; 2];
        }
        if self.layers && self.layers_refuse(from, to) {
            return [DriveLimit::Layer as u8; 2];
        }
        if verdicts.iter().all(|verdict| *verdict != KEPT) {
            return verdicts;
        }
        let refused =
            self.wheels.get(index).and_then(|wheels| self.step(wheels, from, heights)).or_else(|| self.roughness(from, to));
        verdicts.map(|verdict| if verdict == KEPT { refused.unwrap_or(KEPT) } else { verdict })
    }

    fn keeps_out(&self, from: Post, to: Post) -> bool {
        let each = || {
            let ends = [from, to].map(|post| self.position(post));
            matches!(ends, [Some(from), Some(to)] if self.drive.is_kept_out(&from, &to))
        };
        match &self.zones {
            Zones::None => false,
            Zones::Table(table) if !table.has_border(from, to) => table.kept(self.lattice.index(from)),
            Zones::Table(_) | Zones::EachLeg => each(),
        }
    }

    fn layers_refuse(&self, from: Post, to: Post) -> bool {
        let ends = [from, to].map(|post| self.position(post));
        matches!(ends, [Some(from), Some(to)] if self.drive.is_refused_by_layer(&from, &to))
    }

    fn position(&self, post: Post) -> Option<MapPosition> {
        self.lattice.position(self.drive.ground().terrain().dem(), post)
    }

    /// What refuses a leg by its wheels.
    fn step(&self, wheels: &Wheels, from: Post, heights: &mut Vec<f64>) -> Option<u8> {
        let dem = self.drive.ground().terrain().dem();
        let at = |(east, south): Place| {
            let row = from.row.checked_add_signed(south as isize)?;
            dem.elevation(row, from.col.checked_add_signed(east as isize)?)
        };
        let axles = wheels.axles.as_ref()?;
        let (template, no_ground) = (&wheels.template, Some(DriveLimit::Ground as u8));
        let known = |facet: Facet| facet.corners().into_iter().all(|corner| at(corner).is_some());
        let stands = |piece: &Piece| known(piece.facet) || piece.other.is_some_and(known);
        if !template.pieces.iter().all(stands) {
            return no_ground;
        }
        heights.clear();
        for vertex in &template.vertices {
            let mut z_m = 0.0;
            for (place, weight) in vertex.height.terms() {
                let Some(post_m) = at(place) else { return no_ground };
                z_m += weight * post_m;
            }
            heights.push(z_m);
        }
        (axles.greatest(heights).value > self.drive.heights_m()[0]).then_some(DriveLimit::Step as u8)
    }

    /// What refuses a leg by the ground at its ends.
    fn roughness(&self, from: Post, to: Post) -> Option<u8> {
        let of = |post| self.rough.get(self.lattice.index(post)).copied();
        let (begin, end) = (of(from)?, of(to)?);
        [DriveLimit::Ground as u8, DriveLimit::Roughness as u8].into_iter().find(|limit| begin == *limit || end == *limit)
    }
}

//! The options for start and goal.

use std::path::Path;

use chta::{scenario::Entries, study::JourneyEnd as End};

use crate::cli::{Failure, args::Position};

/// The options for start and goal. Commands name them differently; some have none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EndOptions {
    names: Option<[&'static str; 2]>,
    at: [Option<Position>; 2],
}

impl EndOptions {
    /// A command without such options.
    pub(crate) const NONE: Self = Self { names: None, at: [None, None] };

    /// The ends of one hop.
    pub(crate) const fn of_hop(from: Option<Position>, to: Option<Position>) -> Self {
        Self { names: Some(["--from", "--to"]), at: [from, to] }
    }

    /// Whether they are those of one hop.
    pub(crate) fn is_of_hop(&self) -> bool {
        self.names.is_some_and(|[from, _]| from == "--from")
    }

    /// The ends of a path.
    pub(crate) const fn of_path(start: Option<Position>, goal: Option<Position>) -> Self {
        Self { names: Some(["--start", "--goal"]), at: [start, goal] }
    }

    /// Sets the keys that they stand for. A hop or path between positions on a map goes straight: it has the bends of no scenario.
    pub(super) fn set(&self, entries: &mut Entries) {
        let on_map = self.at.iter().any(|at| matches!(at, Some(Position::OnMap(_))));
        if on_map {
            for key in ["via_m", "via_lonlat_deg"] {
                entries.forget("terrain", key);
            }
        }
        for end in [End::Start, End::Goal] {
            let (name, option) = (end.name(), self.place(end));
            match self.at[end as usize] {
                Some(Position::Along(x_m)) => {
                    entries.set_by_option(&option, "terrain", &format!("{name}_x_m"), x_m.into());
                }
                Some(Position::OnMap(at)) => {
                    entries.forget("terrain", &format!("{name}_lonlat_deg"));
                    entries.set_by_option(&option, "terrain", &format!("{name}_m"), vec![at.x, at.y].into());
                }
                Some(Position::InSpace(at)) => {
                    entries.forget("terrain", &format!("{name}_lonlat_deg"));
                    entries.set_by_option(&option, "terrain", &format!("{name}_m"), at.to_vec().into());
                }
                None => {}
            }
            if on_map {
                entries.forget("terrain", &format!("{name}_x_m"));
            }
        }
    }

    /// Refuses positions with a number too many or too few for a terrain, and two of different forms.
    ///
    /// `on_raster`: the terrain is an elevation raster as it stands, which has positions on its map alone; `on_chain`: it is a chain, which has
    /// positions along it alone. A scenario's transect has both.
    pub(super) fn check_counts(&self, terrain: &Path, on_raster: bool, on_chain: bool) -> Result<(), Failure> {
        let name = terrain.display();
        for (end, at) in [End::Start, End::Goal].into_iter().zip(self.at) {
            let option = self.place(end);
            match at {
                Some(at @ (Position::Along(_) | Position::InSpace(_))) if on_raster => {
                    return Err(Failure::message(format!("{option}: {}; {name} is an elevation raster", at.misfit_on_map())));
                }
                Some(at @ (Position::OnMap(_) | Position::InSpace(_))) if on_chain => {
                    return Err(Failure::message(format!("{option}: {}; {name} is a chain", at.misfit_along_chain())));
                }
                Some(at @ Position::InSpace(_)) => {
                    return Err(Failure::message(format!("{option}: {}; {name} is taken along its transect", at.misfit_on_map())));
                }
                None if on_raster => {
                    let (end, option) = (end.name(), self.names.map_or("", |names| names[end as usize]));
                    return Err(Failure::message(format!(
                        "{name}: found no {end}, expected {option} X,Y: a position on its map, in metres"
                    )));
                }
                _ => {}
            }
        }
        match self.at {
            [Some(first @ Position::Along(_)), Some(last @ Position::OnMap(_))]
            | [Some(first @ Position::OnMap(_)), Some(last @ Position::Along(_))] => Err(Failure::message(format!(
                "{}: {}, {}: {}; expected both in one form: X along the transect of {name}, or X,Y on its map",
                self.place(End::Start),
                first.found(),
                self.place(End::Goal),
                last.found()
            ))),
            _ => Ok(()),
        }
    }

    /// Whether one of the two is a position in space.
    pub(super) fn are_in_space(&self) -> bool {
        self.at.iter().any(|at| matches!(at, Some(Position::InSpace(_))))
    }

    /// The ends of a hop over a mesh.
    pub(super) fn in_space(&self, mesh: &Path) -> Result<[[f64; 3]; 2], Failure> {
        let name = mesh.display();
        let of_end = |end: End| {
            let option = self.names.map_or("", |names| names[end as usize]);
            match self.at[end as usize] {
                Some(Position::InSpace(at)) => Ok(at),
                Some(other) => Err(Failure::message(format!("{option}: {}; {name} is a mesh", other.misfit_in_space()))),
                None => Err(Failure::message(format!(
                    "{name}: found no {}, expected {option} X,Y,Z: a position near the surface of the mesh, in metres",
                    end.name()
                ))),
            }
        };
        Ok([of_end(End::Start)?, of_end(End::Goal)?])
    }

    /// The source of an end's value.
    pub(super) fn place(&self, end: End) -> String {
        match (self.names, self.at[end as usize]) {
            (Some(names), Some(_)) => names[end as usize].to_owned(),
            _ => format!("terrain.{}_x_m", end.name()),
        }
    }

    /// The failure for an end that is given nowhere.
    pub(super) fn missing(&self, end: End) -> Failure {
        let name = end.name();
        Failure::message(match self.names {
            Some(names) => format!(
                "found no {name}: give {} X along the chain, or [terrain] {name}_x_m (for a dem or mesh {name}_m) in the scenario",
                names[end as usize]
            ),
            None => {
                format!("found no {name}: add {name}_x_m = X (for a dem or mesh {name}_m = [x, y]) to the scenario's [terrain]")
            }
        })
    }
}

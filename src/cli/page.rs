//! The page of an answer, of `chta report` and of `run --report`.

use std::path::Path;

use chta::{
    report::page_html,
    study::{PageDocuments, page_ground, page_ground_over_facets},
};

use super::{
    Failure,
    load::{Loaded, MeshPlanInput},
    output::Pending,
};

/// The file of a page, opened before the computation begins.
#[derive(Debug)]
pub(crate) struct PageFile<'a>(Pending<'a>);

impl<'a> PageFile<'a> {
    /// Opens the file of an option, after checking its name.
    pub(crate) fn begin(option: &str, path: &'a Path) -> Result<Self, Failure> {
        let is_special = path.exists() && !path.is_file();
        let is_html = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("html") || ending.eq_ignore_ascii_case("htm");
        if !is_special && !path.extension().is_some_and(is_html) {
            return Err(Failure::message(format!("{option} {}: expected a file that ends in .html", path.display())));
        }
        Pending::begin(path).map(Self)
    }

    /// The opened file with its content.
    pub(crate) fn filled(self, page: Vec<u8>) -> (Pending<'a>, Vec<u8>) {
        (self.0, page)
    }
}

/// What the ground of a page is read from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PageInput<'a> {
    /// A chain or a DEM.
    Case(&'a Loaded),
    /// Facets: a mesh, or the ground of a robot with legs.
    Facets(&'a MeshPlanInput),
}

impl PageInput<'_> {
    /// The page of documents over this ground.
    pub(crate) fn page(self, documents: &PageDocuments) -> Result<Vec<u8>, Failure> {
        let ground = match self {
            Self::Case(loaded) => page_ground(&loaded.case, documents, &loaded.record.inputs),
            Self::Facets(input) => page_ground_over_facets((&input.scenario, &input.base), documents, input.inputs()),
        };
        let ground = ground.map_err(|error| Failure::of(&error))?;
        Ok(page_html(&documents.of_page(), &ground).map_err(|error| Failure::of(&error))?.into_bytes())
    }
}

//! An answer as a command writes it: the views of it, and the files that hold them.

use std::{io, path::Path};

use chta::{
    figure::{FigureError, Picture},
    path::HopPath,
    study::{Case, MeshRouted},
    terrain::MapProjection,
};

use serde::Serialize;

use super::{
    Failure,
    args::Format,
    output::{self, Pending, TableFormat},
    pictures,
    trajectory::TrajectoryFile,
};

/// The views of an answer, each made when it is wanted.
pub(crate) struct Views<'v> {
    /// For reading.
    pub(crate) text: &'v dyn Fn() -> String,
    /// One document.
    pub(crate) json: &'v dyn Fn() -> Result<String, Failure>,
    /// A table.
    pub(crate) csv: &'v dyn Fn(&mut Vec<u8>) -> io::Result<()>,
}

impl Views<'_> {
    /// The table in a format.
    fn table(&self, format: TableFormat) -> Result<Vec<u8>, Failure> {
        if format == TableFormat::Json {
            return (self.json)().map(String::into_bytes);
        }
        let mut csv = Vec::new();
        (self.csv)(&mut csv).map_err(|error| Failure::message(format!("the table cannot be written ({error})")))?;
        Ok(csv)
    }

    /// Writes the answer to standard output: the table where that is wanted there.
    pub(crate) fn show(&self, format: Format, table_to_stdout: bool) -> Result<(), Failure> {
        let answer = match format {
            _ if table_to_stdout => self.table(TableFormat::Csv)?,
            Format::Text => ((self.text)() + &pictures::pages_text()).into_bytes(),
            Format::Json => (self.json)()?.into_bytes(),
        };
        output::to_stdout(&answer)
    }
}

/// Writes an answer that has no table to standard output.
pub(crate) fn show(
    format: Format,
    text: impl FnOnce() -> String,
    json: impl FnOnce() -> Result<String, Failure>,
) -> Result<(), Failure> {
    let answer = match format {
        Format::Text => text() + &pictures::pages_text(),
        Format::Json => json()?,
    };
    output::to_stdout(answer.as_bytes())
}

/// The file of a table.
#[derive(Debug)]
pub(crate) struct Table<'a> {
    file: Option<Pending<'a>>,
    format: TableFormat,
    /// Whether it goes to standard output, in place of the answer.
    pub(crate) to_stdout: bool,
}

impl<'a> Table<'a> {
    /// Opens the file of a table before the computation begins, in this format.
    pub(crate) fn begin(path: Option<&'a Path>, format: TableFormat) -> Result<Self, Failure> {
        let to_stdout = path == Some(Path::new("-"));
        Ok(Self { file: path.filter(|_| !to_stdout).map(Pending::begin).transpose()?, format, to_stdout })
    }

    /// The same in the format of the file's extension.
    pub(crate) fn by_extension(path: Option<&'a Path>) -> Result<Self, Failure> {
        Self::begin(path, path.map(TableFormat::of).transpose()?.unwrap_or(TableFormat::Csv))
    }
}

/// The file of a GeoJSON, with its `.prj` where it needs one.
#[derive(Debug)]
pub(crate) struct GeoJsonFile<'a> {
    file: Pending<'a>,
    prj: Option<(Pending<'a>, Vec<u8>)>,
}

impl<'a> GeoJsonFile<'a> {
    /// Opens both before the computation begins.
    pub(crate) fn begin(path: Option<&'a Path>, projection: Option<&MapProjection>) -> Result<Option<Self>, Failure> {
        let Some(path) = path else { return Ok(None) };
        let file = Pending::begin(path)?;
        let prj = output::prj(projection).map(|text| Ok::<_, Failure>((Pending::begin(path.with_extension("prj"))?, text)));
        Ok(Some(Self { file, prj: prj.transpose()? }))
    }
}

/// The files of an answer: each was opened before the computation, which may take long; all are written together after it.
#[derive(Debug, Default)]
pub(crate) struct Files<'a>(Vec<(Pending<'a>, Vec<u8>)>);

impl<'a> Files<'a> {
    /// Adds a picture, in the format of the file's extension, with a file for each page; without a picture the file is not written.
    pub(crate) fn picture(
        &mut self,
        file: Option<Pending<'a>>,
        draw: impl FnOnce() -> Option<Result<Picture, FigureError>>,
    ) -> Result<(), Failure> {
        if let Some(file) = file
            && let Some(drawn) = draw()
        {
            let mut pages = pictures::encoded(drawn, file.path())?.into_iter();
            self.0.extend(pages.next().map(|(_, first)| (file, first)));
            for (path, page) in pages {
                self.0.push((Pending::begin(path)?, page));
            }
        }
        Ok(())
    }

    /// Adds a table.
    pub(crate) fn table(&mut self, table: &mut Table<'a>, views: &Views<'_>) -> Result<(), Failure> {
        if let Some(file) = table.file.take() {
            self.0.push((file, views.table(table.format)?));
        }
        Ok(())
    }

    /// Adds a file of these bytes.
    pub(crate) fn bytes(&mut self, file: Pending<'a>, bytes: Vec<u8>) {
        self.0.push((file, bytes));
    }

    /// Adds a GeoJSON on a map whose reference system was not known before the computation, with the `.prj` file beside it; without one no file is
    /// written.
    pub(crate) fn geojson_on(
        &mut self,
        file: Option<Pending<'a>>,
        geojson: Option<String>,
        projection: Option<&MapProjection>,
    ) -> Result<(), Failure> {
        let (Some(file), Some(geojson)) = (file, geojson) else { return Ok(()) };
        if let Some(text) = output::prj(projection) {
            self.0.push((Pending::begin(file.path().with_extension("prj"))?, text));
        }
        self.0.push((file, geojson.into_bytes()));
        Ok(())
    }

    /// Adds a GeoJSON; without one the file is not written.
    pub(crate) fn geojson(&mut self, file: Option<GeoJsonFile<'a>>, geojson: Option<String>) {
        if let (Some(GeoJsonFile { file, prj }), Some(geojson)) = (file, geojson) {
            self.0.push((file, geojson.into_bytes()));
            self.0.extend(prj);
        }
    }

    /// Adds data that is written as JSON; without any the file is not written.
    pub(crate) fn json<T: Serialize>(&mut self, file: Option<Pending<'a>>, data: Option<&T>) -> Result<(), Failure> {
        if let (Some(file), Some(data)) = (file, data) {
            self.0.push((file, serde_json::to_vec(data)?));
        }
        Ok(())
    }

    /// Adds the roadmap of a plan over a mesh.
    pub(crate) fn roadmap(&mut self, file: Option<Pending<'a>>, routed: &MeshRouted) -> Result<(), Failure> {
        if let Some(file) = file {
            let mut json = Vec::new();
            routed.grown.roadmap.write_json(&routed.ground, &mut json)?;
            self.0.push((file, json));
        }
        Ok(())
    }

    /// Adds a path in time.
    pub(crate) fn trajectory(
        &mut self,
        file: Option<TrajectoryFile<'a>>,
        path: Option<&HopPath>,
        case: &Case,
    ) -> Result<(), Failure> {
        self.0.extend(file.map(|file| file.filled(path, case)).transpose()?);
        Ok(())
    }

    /// Writes all files or none.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        output::finish(self.0)
    }
}

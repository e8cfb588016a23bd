//! `chta schema`: the JSON schemas of scenario and answers.

use std::io::Read;

use chta::study::SchemaKind;
use flate2::read::ZlibDecoder;

use crate::cli::{Answer, Failure, args::SchemaArgs, output};

/// The schemas of docs/schema by name, compressed by the build script; `tests/library/schemas.rs` keeps those files current.
const SCHEMAS: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/schemas.rs"));

/// Lists the kinds of schemas, or writes one.
pub(crate) fn run(args: &SchemaArgs) -> Result<Answer, Failure> {
    let text = match &args.kind {
        None => SchemaKind::all().map(SchemaKind::name).collect::<Vec<_>>().join("\n") + "\n",
        Some(name) => {
            let (_, compressed) = SCHEMAS.iter().find(|(known, _)| known == name).ok_or_else(|| unknown(name))?;
            let mut text = String::new();
            ZlibDecoder::new(*compressed).read_to_string(&mut text).map_err(|error| Failure::of(&error))?;
            text
        }
    };
    output::to_stdout(text.as_bytes())?;
    Ok(Answer::Yes)
}

/// No schema has this name.
fn unknown(name: &str) -> Failure {
    let names: Vec<_> = SchemaKind::all().map(SchemaKind::name).collect();
    let near = names.iter().min_by_key(|known| strsim::damerau_levenshtein(name, known)).copied().unwrap_or_default();
    Failure::message(format!("KIND: '{name}' is unknown, expected one of {}; the nearest is {near}", names.join(", ")))
}

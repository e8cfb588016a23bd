//! `chta schema`: the JSON schemas of scenario and answers.

use chta::study::SchemaKind;

use crate::cli::{Answer, Failure, args::SchemaArgs, output};

/// Lists the kinds of schemas, or writes one.
pub(crate) fn run(args: &SchemaArgs) -> Result<Answer, Failure> {
    let text = match &args.kind {
        None => SchemaKind::all().map(|kind| format!("{}\n", kind.name())).collect(),
        Some(name) => {
            let kind = SchemaKind::all().find(|kind| kind.name() == name).ok_or_else(|| unknown(name))?;
            serde_json::to_string_pretty(&kind.schema())? + "\n"
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

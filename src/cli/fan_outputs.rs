//! The files that `fan` writes.

use std::path::Path;

use chta::{figure::draw_rose, report::FanAnswer, study::conditions};

use super::{
    Failure,
    args::FanArgs,
    load::Bare,
    output::{self, Pending},
};

/// Writes the picture and the table; whether the table has taken the place of the answer on standard output.
pub(crate) fn write(args: &FanArgs, bare: &Bare, answer: &FanAnswer, picture: Option<Pending<'_>>) -> Result<bool, Failure> {
    let mut csv = Vec::new();
    if args.output.is_some() {
        answer.write_csv(&mut csv).map_err(|e| Failure::of(&e))?;
    }
    if let Some(file) = picture {
        let title = format!("How far in how few hops: {}", bare.title_of_map());
        let encoded = output::encoded(Ok(draw_rose(answer, &title, &subtitle(answer, bare))), file.path())?;
        output::finish(vec![(file, encoded)])?;
    }
    let Some(table) = &args.output else { return Ok(false) };
    output::to_file_or_stdout(Some(table), &csv)?;
    Ok(table == Path::new("-"))
}

/// Numbers under the title of the picture.
fn subtitle(answer: &FanAnswer, bare: &Bare) -> String {
    let [x, y] = answer.from_m;
    format!(
        "{} headings from ({x}, {y}) m, at most {} m; {}; {} headings lead to their far end",
        answer.headings,
        answer.length_m,
        conditions(&bare.scenario),
        answer.reached_ends()
    )
}

//! Several scenarios loaded and planned one by one; one that fails does not end the others.

use std::path::Path;

use chta::{
    report::CompareRow,
    study::{Compared, Comparison, PlanOptions, plan},
};

use super::{
    Failure,
    args::{CommonArgs, CompareArgs},
    effects::Purpose,
    interrupt,
    load::{Loaded, load_scenario, relative_name},
    output,
    progress::Progress,
};

/// Loads and plans all scenarios, with a row for each and what was loaded for those with an answer.
///
/// A scenario that fails has a row with its error. What is at fault in the options, or in every scenario, is a failure.
pub(crate) fn compare_all(args: &CompareArgs) -> Result<(Vec<Loaded>, Comparison), Failure> {
    let (mut all, mut cases, mut first_failure) = (Vec::new(), Vec::new(), None);
    for file in &args.scenarios {
        match compared(file, args) {
            Ok((loaded, one)) => {
                all.push(loaded);
                cases.push(Ok(one));
            }
            Err(failure) if failure.is_of_option() || interrupt::is_requested() => return Err(failure),
            Err(failure) => {
                cases.push(Err(CompareRow::failed(relative_name(file), file.display().to_string(), failure.sentence())));
                first_failure = first_failure.or(Some(failure));
            }
        }
    }
    match first_failure {
        Some(failure) if all.is_empty() => Err(failure),
        _ => Ok((all, Comparison::of(cases))),
    }
}

/// Loads and plans one scenario.
fn compared(file: &Path, args: &CompareArgs) -> Result<(Loaded, Compared), Failure> {
    let common = CommonArgs::of_scenarios(&args.set, args.accept_map_scale, args.input_max_gib, args.quiet);
    let loaded = load_scenario(file, &common, Purpose::Compare)?;
    loaded.ends()?;
    let options = PlanOptions { proof: args.prove.proof(), ..PlanOptions::default() };
    let planned = plan(&loaded.case, options, &Progress::new(args.quiet))?;
    output::warn_all(args.quiet, &planned.warnings);
    Ok((loaded, Compared::of(planned, relative_name(file), &file.display().to_string())))
}

//! The plan whose path trials fly: that of a result as it stands, or a new one.

use std::{fs, sync::Arc};

use chta::study::{PlanOptions, Planned, plan};

use super::Loaded;
use crate::cli::{Failure, args::SimulateArgs, inputs, progress::Progress, wrong_thing::Role};

/// Reads back the path of a result. An input that is no result is planned, and a result where the options say so.
pub(crate) fn plan_to_fly(args: &SimulateArgs, loaded: &Loaded, progress: &Progress) -> Result<Arc<Planned>, Failure> {
    let input = inputs::open(&args.journey.chain, Role::Chain)?;
    let name = input.given.display();
    if args.plan_anew && !input.is_result() {
        return Err(Failure::message(format!("--plan-anew: {name} is no result, and is planned anyway: omit it")));
    }
    if args.plan_anew || !input.is_result() {
        return Ok(Arc::new(plan(&loaded.case, PlanOptions::default(), progress)?));
    }
    let refused = |reason: String| Failure::message(format!("{name}: {reason}; --plan-anew plans its scenario anew"));
    let text = fs::read(&input.file).map_err(|error| refused(error.to_string()))?;
    let document = serde_json::from_slice(&text).map_err(|error| refused(error.to_string()))?;
    let planned = Planned::read_back(&loaded.case, &document, &loaded.record.inputs);
    planned.map(Arc::new).map_err(|error| refused(error.to_string()))
}

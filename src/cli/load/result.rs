//! The plan whose path trials fly: that of a result as it stands, or a new one.

use std::{error::Error, fs, sync::Arc};

use chta::{
    report::HopRecord,
    study::{PlanOptions, Planned, plan, same_path_over_mesh},
};

use super::{Loaded, MeshPlanInput};
use crate::cli::{
    Failure,
    args::SimulateArgs,
    inputs::{self, Input},
    progress::Progress,
    wrong_thing::Role,
};

/// Reads back the path of a result. An input that is no result is planned, and a result where the options say so.
pub(crate) fn plan_to_fly(args: &SimulateArgs, loaded: &Loaded, progress: &Progress) -> Result<Arc<Planned>, Failure> {
    let input = inputs::open(&args.journey.chain, Role::Chain)?;
    args.check_plan_anew(&input)?;
    if args.plan_anew || !input.is_result() {
        return Ok(Arc::new(plan(&loaded.case, PlanOptions::default(), progress)?));
    }
    let refused = |error: &dyn Error| refused_result(&input, error);
    let text = fs::read(&input.file).map_err(|error| refused(&error))?;
    let document = serde_json::from_slice(&text).map_err(|error| refused(&error))?;
    let planned = Planned::read_back(&loaded.case, &document, &loaded.record.inputs);
    planned.map(Arc::new).map_err(|error| refused(&error))
}

/// Refuses a result over a mesh whose path is not the one that was planned for its scenario, unless that is to be flown anyway.
pub(crate) fn check_result_over_mesh(args: &SimulateArgs, loaded: &MeshPlanInput, planned: &[HopRecord]) -> Result<(), Failure> {
    let input = inputs::open(&args.journey.chain, Role::Chain)?;
    args.check_plan_anew(&input)?;
    if args.plan_anew || !input.is_result() {
        return Ok(());
    }
    let refused = |error: &dyn Error| refused_result(&input, error);
    let text = fs::read(&input.file).map_err(|error| refused(&error))?;
    let document = serde_json::from_slice(&text).map_err(|error| refused(&error))?;
    same_path_over_mesh(&document, loaded.inputs(), planned).map_err(|error| refused(&error))
}

/// Why the path of a result is not flown, and what to do.
fn refused_result(input: &Input, reason: &dyn Error) -> Failure {
    Failure::message(format!("{}: {reason}; --plan-anew plans its scenario anew", input.given.display()))
}

impl SimulateArgs {
    /// Refuses `--plan-anew` of an input that is no result.
    fn check_plan_anew(&self, input: &Input) -> Result<(), Failure> {
        if self.plan_anew && !input.is_result() {
            let name = input.given.display();
            return Err(Failure::message(format!("--plan-anew: {name} is no result, and is planned anyway: omit it")));
        }
        Ok(())
    }
}

//! The plan whose path trials fly: that of a result as it stands, or a new one.

use std::{error::Error, fs, sync::Arc};

use chta::{
    report::HopRecord,
    study::{MeshResultPath, PlanOptions, Planned, plan},
};
use serde_json::Value;

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
    let planned = Planned::read_back(&loaded.case, &document(&input)?, &loaded.record.inputs);
    planned.map(Arc::new).map_err(|error| refused(&input, &error))
}

/// The result over a mesh whose path trials fly, if they are those of a result.
pub(crate) struct MeshResult(Option<(Input, MeshResultPath)>);

impl MeshResult {
    /// Reads it; nothing of an input that is no result, or is to be planned anew.
    pub(crate) fn of(args: &SimulateArgs, loaded: &MeshPlanInput) -> Result<Self, Failure> {
        let input = inputs::open(&args.journey.chain, Role::Chain)?;
        args.check_plan_anew(&input)?;
        if args.plan_anew || !input.is_result() {
            return Ok(Self(None));
        }
        let path = MeshResultPath::read(&document(&input)?, loaded.inputs()).map_err(|error| refused(&input, &error))?;
        Ok(Self(Some((input, path))))
    }

    /// Refuses a plan with another path.
    pub(crate) fn check_planned(&self, planned: &[HopRecord]) -> Result<(), Failure> {
        let Self(Some((input, path))) = self else { return Ok(()) };
        path.check_planned(planned).map_err(|error| refused(input, &error))
    }
}

/// The document of a result.
fn document(input: &Input) -> Result<Value, Failure> {
    let text = fs::read(&input.file).map_err(|error| refused(input, &error))?;
    serde_json::from_slice(&text).map_err(|error| refused(input, &error))
}

/// Why the path of a result is not flown, and what to do.
fn refused(input: &Input, reason: &dyn Error) -> Failure {
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

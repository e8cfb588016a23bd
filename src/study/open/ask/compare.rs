//! Several scenarios side by side.

use std::path::Path;

use super::{
    super::{AskError, Draft, OpenError, Purpose, Reply},
    OF_DRIVES, OF_TARGETS, OVER_FACETS, refuse,
};
#[cfg(feature = "plot")]
use crate::figure::SeenFrom;
use crate::{
    progress::Progress,
    report::{CompareRow, DocumentKind},
    study::{
        CaseRecord, Compared, Comparison, MeshRouteQuestion, MeshRouted, PlanOptions, Planned, Proof, TargetsPlanned,
        TravelOptions, TravelPlanned, comparison_document, mesh_route, plan, targets_plan, travel_plan,
    },
};

/// Plans for every scenario and shows the answers side by side: all along chains or free routes over DEMs, all over a mesh, all driving,
/// or all missions over targets, as the first is. A scenario that fails has a row with its error; so has one that `progress` cancels.
///
/// # Errors
/// [`AskError`]: the first error, if no scenario has an answer.
pub fn compare(drafts: &[Draft], proof: Option<Proof>, progress: &dyn Progress) -> Result<Reply, AskError> {
    let Some(first) = drafts.first() else {
        return Err(AskError::Value { what: "scenarios", found: "none".to_owned(), expected: "at least one" });
    };
    if first.is_over_facets() {
        refuse(&[(proof.is_some(), "a proof")], OVER_FACETS)?;
        let (records, comparison) = each(drafts, |draft, names| over_mesh(draft, names, progress))?;
        let warnings = comparison.compared.iter().flat_map(Compared::<MeshRouted>::warnings).collect();
        let reply = replied(&records, warnings, &comparison)?;
        #[cfg(feature = "plot")]
        let reply = reply.drawn(move || Some(comparison.picture(SeenFrom::default())));
        return Ok(reply);
    }
    if first.validated(false).is_ok_and(|scenario| scenario.drives().is_some()) {
        refuse(&[(proof.is_some(), "a proof")], OF_DRIVES)?;
        let (records, comparison) = each(drafts, |draft, names| travelling(draft, names, progress))?;
        return replied(&records, comparison.compared.iter().flat_map(Compared::<TravelPlanned>::warnings).collect(), &comparison);
    }
    if first.validated(false).is_ok_and(|scenario| scenario.mission.is_some()) {
        refuse(&[(proof.is_some(), "a proof")], OF_TARGETS)?;
        let (records, comparison) = each(drafts, |draft, names| visiting(draft, names, progress))?;
        return replied(&records, comparison.compared.iter().flat_map(Compared::<TargetsPlanned>::warnings).collect(), &comparison);
    }
    let options = PlanOptions { proof, ..PlanOptions::default() };
    let (records, comparison) = each(drafts, |draft, names| along_chain(draft, names, options, progress))?;
    let reply = replied(&records, comparison.compared.iter().flat_map(Compared::<Planned>::warnings).collect(), &comparison)?;
    #[cfg(feature = "plot")]
    let reply = reply.drawn(move || Some(comparison.picture()));
    Ok(reply)
}

/// How a scenario is named in a comparison: its file, and its name without a title.
type Names = (String, String);

/// A scenario's record and its plan.
type One<P> = Result<(CaseRecord, Compared<P>), AskError>;

/// Plans scenario after scenario.
fn each<P>(drafts: &[Draft], one: impl Fn(&Draft, Names) -> One<P>) -> Result<(Vec<CaseRecord>, Comparison<P>), AskError> {
    let (mut records, mut cases, mut first_error) = (Vec::new(), Vec::new(), None);
    for (number, draft) in (1..).zip(drafts) {
        let name = if draft.name.is_empty() { format!("scenario {number}") } else { draft.name.clone() };
        let file = if draft.name.is_empty() { name.clone() } else { (draft.wording.file_name)(Path::new(&name)) };
        match one(draft, (file.clone(), name.clone())) {
            Ok((record, compared)) => {
                records.push(record);
                cases.push(Ok(compared));
            }
            Err(error) => {
                cases.push(Err(CompareRow::failed(file, name, error.to_string())));
                first_error = first_error.or(Some(error));
            }
        }
    }
    match first_error {
        Some(error) if records.is_empty() => Err(error),
        _ => Ok((records, Comparison::of(cases))),
    }
}

fn replied<P>(records: &[CaseRecord], warnings: Vec<String>, comparison: &Comparison<P>) -> Result<Reply, AskError> {
    let json = comparison_document(&records.iter().collect::<Vec<_>>(), warnings, &comparison.answer)?;
    Ok(Reply::new(DocumentKind::Compare, json, comparison.answer.is_traversable()))
}

fn along_chain(draft: &Draft, (file, name): Names, options: PlanOptions, progress: &dyn Progress) -> One<Planned> {
    let open = draft.case(Purpose::Compare)?;
    open.case.ends()?;
    let planned = plan(&open.case, options, progress)?;
    Ok((open.record, Compared::<Planned>::of(planned, file, &name)))
}

fn travelling(draft: &Draft, (file, name): Names, progress: &dyn Progress) -> One<TravelPlanned> {
    let open = draft.case(Purpose::Compare)?;
    open.case.ends()?;
    let planned = travel_plan(&open.case, TravelOptions::default(), progress)?;
    Ok((open.record, Compared::<TravelPlanned>::of(planned, file, &name)))
}

fn visiting(draft: &Draft, (file, name): Names, progress: &dyn Progress) -> One<TargetsPlanned> {
    let open = draft.case(Purpose::Compare)?;
    open.case.ends()?;
    let planned = targets_plan(&open.case, progress)?;
    Ok((open.record, Compared::<TargetsPlanned>::of(planned, file, &name)))
}

fn over_mesh(draft: &Draft, (file, name): Names, progress: &dyn Progress) -> One<MeshRouted> {
    let none = || {
        let reason = "it has no free route over a mesh, as the first scenario has".to_owned();
        OpenError::unreadable(&name, reason, "compare scenarios over one mesh, or none over a mesh")
    };
    let open = draft.facets(Purpose::Compare)?.ok_or_else(none)?;
    let question = MeshRouteQuestion { scenario: &open.scenario, base: &open.base, front: None, roadmap: None };
    let routed = mesh_route(&question, progress)?;
    let compared = Compared::<MeshRouted>::of(routed, &open.scenario, file, &name);
    Ok((open.record, compared))
}

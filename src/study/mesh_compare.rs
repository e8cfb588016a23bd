//! Several scenarios over one mesh side by side: the paths of weak and strong constraints.

use super::{Compared, Comparison, MeshRouted};
#[cfg(feature = "plot")]
use crate::figure::{Caption, FigureError, MeshRouteFigure, MeshRouteLine, Picture, SeenFrom, draw_mesh_route};
use crate::{
    report::{CompareRow, MarginsRecord, TotalsRecord},
    scenario::Scenario,
};

impl Compared<MeshRouted> {
    /// A plan and the file of its scenario; `untitled` is the name of a scenario without a title.
    pub fn of(routed: MeshRouted, scenario: &Scenario, file: String, untitled: &str) -> Self {
        let (answer, path) = (&routed.answer, routed.path.as_ref());
        let row = CompareRow {
            file,
            name: scenario.title.clone().unwrap_or_else(|| untitled.to_owned()),
            start_x_m: None,
            goal_x_m: None,
            start_m: Some(answer.start.point_m),
            goal_m: Some(answer.goal.point_m),
            verdict: Some(answer.verdict),
            hops: answer.hops,
            lower_bound: Some(answer.hops_lower_bound),
            totals: path.map(|path| TotalsRecord::from(&path.totals)),
            margins: path.and_then(MarginsRecord::of),
            error: None,
        };
        Self { planned: routed, row }
    }

    /// The warnings about the plan, each with the name of the file.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.of_file(self.planned.warnings.iter().cloned())
    }
}

impl Comparison<MeshRouted> {
    /// The first file whose mesh is another one than that of the first scenario: their paths are not drawn over one another.
    pub fn other_mesh(&self) -> Option<&str> {
        let (first, others) = self.compared.split_first()?;
        let own = first.planned.ground.tree().mesh();
        let is_other = |one: &&Compared<MeshRouted>| {
            let mesh = one.planned.ground.tree().mesh();
            mesh.vertices() != own.vertices() || mesh.indices() != own.indices()
        };
        others.iter().find(is_other).map(|other| other.row.file.as_str())
    }

    /// The picture with all paths overlaid on the mesh of the first scenario.
    ///
    /// # Errors
    /// [`FigureError`], also without any answer.
    #[cfg(feature = "plot")]
    pub fn picture(&self, seen_from: SeenFrom) -> Result<Picture, FigureError> {
        let Some(first) = self.compared.first() else {
            return Err(FigureError::NoGround { what: "the comparison".to_owned(), points: 0 });
        };
        let words = |row: &CompareRow| {
            let hops = row.hops.map(|hops| format!(", at most {hops} hop{}", if hops == 1 { "" } else { "s" }));
            format!("{}: {}{}", row.name, row.format_verdict(), hops.unwrap_or_default())
        };
        let line = self.answer.compared.iter().map(words).collect::<Vec<_>>().join("; ");
        let mut lines = vec![line];
        let end = |one: &Compared<MeshRouted>| (one.row.start_m, one.row.goal_m);
        if self.compared.iter().any(|one| end(one) != end(first)) {
            lines.push(format!("start and goal are those of {}; other paths have their own", first.row.name));
        }
        let names: Vec<_> = self.compared.iter().map(|one| one.row.name.as_str()).collect();
        let [start, goal] = [first.planned.grown.ends.0, first.planned.grown.ends.1]
            .map(|node| first.planned.grown.roadmap.contact(node).point_m());
        let route = |one| {
            let Compared { planned: routed, row }: &Compared<MeshRouted> = one;
            let gravity_m_s2 = routed.ground.envelope().gravity_m_s2();
            routed.path.as_ref().map(|path| MeshRouteLine { name: &row.name, path, gravity_m_s2 })
        };
        draw_mesh_route(&MeshRouteFigure {
            caption: Caption { title: names.join(" and "), lines },
            mesh: first.planned.ground.tree().mesh(),
            seen_from,
            cut_z_m: None,
            start,
            goal,
            routes: self.compared.iter().filter_map(route).collect(),
            walks: Vec::new(),
            nearest: None,
        })
    }
}

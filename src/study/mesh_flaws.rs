//! Warnings about meshes whose triangles do not form sound bodies.

use crate::terrain::MeshTree;

/// A number of things, the word in its plural unless there is one.
fn counted(count: usize, one: &str, several: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {several}") }
}

/// What is doubtful about a mesh, one sentence for each kind, with what follows for hops.
pub(super) fn flaw_warnings(tree: &MeshTree) -> Vec<String> {
    let flaws = tree.flaws();
    let [bodies, closed, _] = tree.body_counts();
    let mut warnings = Vec::new();
    if flaws.inverted_bodies > 0 {
        warnings.push(format!(
            "{} of {closed} closed bodies of the mesh are inside out (the corners of their triangles run clockwise seen from outside): \
             contacts on them face inwards; turn them round in the modeller",
            flaws.inverted_bodies
        ));
    }
    if flaws.border_edges > 0 {
        warnings.push(format!(
            "{} of the {bodies} bodies of the mesh are open, with {}: nothing counts as inside them, so a point behind their surface is moved \
             to it and not refused",
            flaws.open_bodies,
            counted(flaws.border_edges, "border edge", "border edges")
        ));
    }
    if flaws.unlike_edges > 0 {
        warnings.push(format!(
            "{} of the mesh {} triangles that turn opposite ways round: contacts on some of them face the wrong side; let the modeller \
             recompute the outside",
            counted(flaws.unlike_edges, "edge", "edges"),
            if flaws.unlike_edges == 1 { "joins" } else { "join" }
        ));
    }
    if flaws.duplicates > 0 {
        warnings.push(format!("{} of the mesh repeat an earlier one", counted(flaws.duplicates, "triangle", "triangles")));
    }
    if let Some(crossed) = flaws.crossed.filter(|crossed| *crossed > 0) {
        warnings.push(format!(
            "{} of the mesh are crossed by another part of the same body: surface inside it may count as open",
            counted(crossed, "triangle", "triangles")
        ));
    }
    warnings
}

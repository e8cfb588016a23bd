//! Index types that cannot be confused with one another.

/// Defines an index type.
macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);

        impl $name {
            /// The index, from 0.
            pub const fn index(self) -> usize {
                self.0
            }
        }
    };
}

id! {
    /// A vertex of the chain, counted from 0 in the direction of +x.
    VertexId
}
id! {
    /// A segment of the chain: segment `i` joins vertices `i` and `i + 1`.
    SegmentId
}
id! {
    /// A triangle of a mesh, counted from 0 in the order of the mesh.
    FacetId
}
id! {
    /// A node of the hop graph, counted from 0 in the direction of +x.
    NodeId
}

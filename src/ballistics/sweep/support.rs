//! An upper bound on what the ground asks for that needs neither hull nor division.
//!
//! ```text
//!     an arc of loft n to (X, b) clears a vertex at distance d, seen at slope s, where   s + c d <= b + n,   c = n / X
//!
//!   h(c) = max (s + c d)                     over all vertices: convex, and rising with c
//!   |                     . /
//!   |                . `  /                  h is kept at a few nodes c_k; between them a chord lies above it,
//!   |           .  `  _ -                    and below the first node its height there does
//!   |  ____._`_ -  -
//!   +---+-----+-----+-----+--- c
//! ```

/// The support function of the ground seen so far, at some nodes.
#[derive(Clone, Debug)]
pub(super) struct Support {
    nodes: [f64; Self::NODES],
    /// The support function at the nodes.
    heights: [f64; Self::NODES],
    /// One over the distance from each node to the next.
    per_width: [f64; Self::NODES],
    /// Which cell of all positive doubles the first node begins.
    base: u64,
    /// How many vertices it covers.
    covered: usize,
}

impl Support {
    /// Two cells an octave: from the greatest `c` of interest down to a tenth of it.
    const NODES: usize = 8;

    /// So many bits of a double tell places within a cell; those above number the cells.
    const WITHIN: u32 = 51;

    pub(super) const fn new() -> Self {
        let zeros = [0.0; Self::NODES];
        Self { nodes: zeros, heights: zeros, per_width: zeros, base: 0, covered: 0 }
    }

    /// Lays the nodes anew, for falls up to `greatest`, over no vertex.
    pub(super) fn lay(&mut self, greatest: f64) {
        self.base = (greatest.to_bits() >> Self::WITHIN).saturating_sub(Self::NODES as u64 - 2);
        for (node, cell) in self.nodes.iter_mut().zip(self.base..) {
            *node = f64::from_bits(cell << Self::WITHIN);
        }
        for k in 1..Self::NODES {
            self.per_width[k - 1] = 1.0 / (self.nodes[k] - self.nodes[k - 1]);
        }
        self.heights = [f64::NEG_INFINITY; Self::NODES];
        self.covered = 0;
    }

    /// Covers the first `count` vertices, given by their distances and the slopes at which they are seen.
    #[inline]
    pub(super) fn cover(&mut self, count: usize, distance_m: &[f64], seen: &[f64]) {
        let (nodes, mut heights) = (&self.nodes, self.heights);
        for (distance_m, seen) in distance_m[self.covered..count].iter().zip(&seen[self.covered..count]) {
            for k in 0..Self::NODES {
                let height = seen + nodes[k] * distance_m;
                heights[k] = if height > heights[k] { height } else { heights[k] };
            }
        }
        self.heights = heights;
        self.covered = count;
    }

    /// How many vertices it covers.
    #[inline]
    pub(super) const fn covered(&self) -> usize {
        self.covered
    }

    /// The greatest node.
    #[inline]
    pub(super) const fn greatest(&self) -> f64 {
        self.nodes[Self::NODES - 1]
    }

    /// No vertex covered has `s + fall d` above this, but for rounding; infinite or not a number where nothing is known.
    #[inline]
    pub(super) fn bound(&self, fall: f64) -> f64 {
        if fall <= self.nodes[0] {
            return self.heights[0];
        }
        let cell = (fall.to_bits() >> Self::WITHIN).wrapping_sub(self.base) as usize;
        if cell >= Self::NODES - 1 {
            return f64::INFINITY;
        }
        let (low, high) = (self.heights[cell], self.heights[cell + 1]);
        low + (high - low) * ((fall - self.nodes[cell]) * self.per_width[cell])
    }
}

#[cfg(test)]
mod tests {
    use super::Support;

    #[test]
    fn the_bound_holds_and_is_close_between_the_nodes() {
        let distance_m = [1.0, 2.0, 5.0, 9.0];
        let seen = [0.5, 0.45, 0.3, -0.1];
        let mut support = Support::new();
        support.lay(0.3);
        support.cover(2, &distance_m, &seen);
        support.cover(4, &distance_m, &seen);
        for i in 0..=1000 {
            let fall = 0.3 * f64::from(i) / 1000.0;
            let exact = distance_m.iter().zip(&seen).map(|(d, s)| s + fall * d).fold(f64::NEG_INFINITY, f64::max);
            let bound = support.bound(fall);
            assert!(bound >= exact - 1e-15, "{bound} below {exact} at {fall}");
            assert!(fall < 0.04 || bound <= exact + 0.1, "{bound} far above {exact} at {fall}");
        }
        // At a node it is the support itself: 0.25 is one.
        assert_eq!(support.bound(0.25), 2.15);
        assert_eq!(support.bound(10.0), f64::INFINITY);
        // Nothing finite is claimed of what is not a number.
        assert!(support.bound(f64::NAN).is_nan() || support.bound(f64::NAN).is_infinite());
    }
}

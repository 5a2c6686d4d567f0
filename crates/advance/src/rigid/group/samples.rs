//! Values of watched functions along a segment.

/// Values of watched functions at the nodes, row by row; empty lists where nothing needs a watch.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Samples {
    pub(crate) forces: Vec<[f64; NODES]>,
    pub(crate) rooms: Vec<[f64; NODES]>,
    pub(crate) heights: Vec<[f64; NODES]>,
    /// Heights soon after the start.
    pub(crate) early: Vec<[f64; EARLY]>,
}

/// Number of samples along a segment: both ends and three places between, equally far apart.
pub(crate) const NODES: usize = 5;

/// Number of samples between the start of a segment and its first node: a function that starts at nearly zero dips at
/// once or, mostly, not at all.
pub(crate) const EARLY: usize = 5;

/// Index of the middle node of a segment, for polynomials whose argument is zero there.
pub(crate) const fn middle_node() -> f64 {
    (NODES - 1) as f64 / 2.0
}

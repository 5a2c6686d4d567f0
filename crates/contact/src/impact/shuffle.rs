//! A small random generator for the order of rows in an impact: the same numbers for the same seed, everywhere.

/// SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
#[derive(Clone, Debug)]
pub(super) struct Shuffle {
    state: u64,
}

impl Shuffle {
    /// The generator for impact number `stream` of a run with the given seed.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        let mut shuffle = Self { state: seed };
        shuffle.state = shuffle.next() ^ stream.wrapping_mul(0xD1B5_4A32_D192_ED03);
        shuffle
    }

    /// A number from 0 to `count` - 1; `count` is not 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        // The high half of the product is uniform up to 2^-64 times the count.
        let wide = u128::from(self.next()) * count as u128;
        (wide >> 64) as usize
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }
}

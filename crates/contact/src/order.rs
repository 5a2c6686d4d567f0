//! An order of rows that keeps the envelope of the factor narrow.
//!
//! The envelope of a factor is that of its matrix, so rows that touch the same bodies should be near each other. The
//! rows' own order often is such (stacks, walls); where it is not, the reverse of a breadth-first walk through the
//! contact graph is better: E. Cuthill, J. McKee, "Reducing the bandwidth of sparse symmetric matrices", ACM 1969; A.
//! George, 1971.

/// Number of rows below which the order does not matter.
const FEW_ROWS: usize = 24;

/// Largest mean number of entries per row of the envelope that is not worth improving.
const NARROW: usize = 12;

/// A row order, kept while the pattern stays the same.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct RowOrder {
    pub(crate) rows: Vec<u32>,
    start: Vec<usize>,
    column: Vec<u32>,
    /// Rows per column: offsets and rows.
    touching_start: Vec<u32>,
    touching: Vec<u32>,
    /// First place of the rows of each column in an order.
    first: Vec<u32>,
    seen: Vec<bool>,
    column_seen: Vec<bool>,
}

impl RowOrder {
    /// Finds an order for rows with this pattern; their own order is kept if it is narrow enough.
    pub(crate) fn prepare(&mut self, start: &[usize], column: &[u32], columns: usize) {
        if self.take_pattern(start, column) && self.rows.len() >= FEW_ROWS {
            let given = self.envelope(columns);
            if given > self.rows.len() * NARROW {
                self.improve(columns, given);
            }
        }
    }

    /// Finds the narrower of the rows' own order and that of the walk, at any size, for a factor that is made many
    /// times.
    pub(crate) fn prepare_narrow(&mut self, start: &[usize], column: &[u32], columns: usize) {
        if self.take_pattern(start, column) {
            let given = self.envelope(columns);
            self.improve(columns, given);
        }
    }

    /// Takes over a pattern, with the rows in their own order. False if it is the last one, whose order is known.
    fn take_pattern(&mut self, start: &[usize], column: &[u32]) -> bool {
        if self.start == start && self.column == column {
            return false;
        }
        self.start.clear();
        self.start.extend_from_slice(start);
        self.column.clear();
        self.column.extend_from_slice(column);
        self.rows.clear();
        self.rows.extend(0..start.len() as u32 - 1);
        true
    }

    /// Walks through the rows, and keeps the order of the walk if its envelope is less than that of their own order.
    fn improve(&mut self, columns: usize, given: usize) {
        let n = self.rows.len();
        self.list_touching(columns);
        self.walk(columns);
        if self.envelope(columns) >= given {
            self.rows.clear();
            self.rows.extend(0..n as u32);
        }
    }

    /// Entries left of the diagonal in the envelope of Ĵ Ĵᵀ in the present order.
    fn envelope(&mut self, columns: usize) -> usize {
        self.first.clear();
        self.first.resize(columns, u32::MAX);
        let mut sum = 0;
        for (place, &row) in self.rows.iter().enumerate() {
            let mut first = place as u32;
            for &k in &self.column[self.start[row as usize]..self.start[row as usize + 1]] {
                let seen = &mut self.first[k as usize];
                *seen = (*seen).min(place as u32);
                first = first.min(*seen);
            }
            sum += place - first as usize;
        }
        sum
    }

    fn list_touching(&mut self, columns: usize) {
        self.touching_start.clear();
        self.touching_start.resize(columns + 2, 0);
        for &k in &self.column {
            self.touching_start[k as usize + 2] += 1;
        }
        for k in 2..self.touching_start.len() {
            self.touching_start[k] += self.touching_start[k - 1];
        }
        self.touching.clear();
        self.touching.resize(self.column.len(), 0);
        for row in 0..self.start.len() - 1 {
            for e in self.start[row]..self.start[row + 1] {
                let next = &mut self.touching_start[self.column[e] as usize + 1];
                self.touching[*next as usize] = row as u32;
                *next += 1;
            }
        }
    }

    /// Walks breadth first through each connected group of rows, from a row at its far end, and reverses the result.
    fn walk(&mut self, columns: usize) {
        let n = self.start.len() - 1;
        self.rows.clear();
        self.seen.clear();
        self.seen.resize(n, false);
        self.column_seen.clear();
        self.column_seen.resize(columns, false);
        for seed in 0..n as u32 {
            if self.seen[seed as usize] {
                continue;
            }
            // The last row of a walk from any row is far from the middle: begin there.
            let begin = self.rows.len();
            self.spread(seed, begin);
            let far = self.rows[self.rows.len() - 1];
            for at in begin..self.rows.len() {
                let row = self.rows[at];
                self.seen[row as usize] = false;
                for e in self.start[row as usize]..self.start[row as usize + 1] {
                    self.column_seen[self.column[e] as usize] = false;
                }
            }
            self.rows.truncate(begin);
            self.spread(far, begin);
        }
        self.rows.reverse();
    }

    fn spread(&mut self, seed: u32, begin: usize) {
        self.rows.push(seed);
        self.seen[seed as usize] = true;
        let mut at = begin;
        while at < self.rows.len() {
            let row = self.rows[at];
            at += 1;
            for e in self.start[row as usize]..self.start[row as usize + 1] {
                let k = self.column[e] as usize;
                if std::mem::replace(&mut self.column_seen[k], true) {
                    continue;
                }
                for t in self.touching_start[k]..self.touching_start[k + 1] {
                    let other = self.touching[t as usize];
                    if !std::mem::replace(&mut self.seen[other as usize], true) {
                        self.rows.push(other);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows 0..n tie column i to i + 1, given in an order that jumps about.
    #[test]
    fn a_shuffled_chain_becomes_narrow() {
        let n = 101;
        let column: Vec<u32> = (0..n).flat_map(|i| [(i * 37 % n) as u32, (i * 37 % n) as u32 + 1]).collect();
        let start: Vec<usize> = (0..=n).map(|i| 2 * i).collect();
        let mut order = RowOrder::default();
        order.prepare(&start, &column, n + 1);
        assert_eq!(order.envelope(n + 1), n - 1);
    }
}

//! Sparse Cholesky factor of I + Ĵᵀ W Ĵ, the Newton matrix in body space with a weight W of each row, by faer.
//!
//! Its pattern is that of all rows, closed or not, so that the symbolic analysis (fill-reducing order, elimination
//! tree) stays valid while the same bodies touch. Buffers are kept; factoring again allocates nothing.

#[cfg(feature = "save")]
mod saved;

use std::fmt;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltParams;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::system::System;

/// The factor, its symbolic analysis and its pattern.
#[derive(Debug, Default)]
pub(crate) struct BodyFactor {
    /// The pattern of rows for which the analysis was made.
    start: Vec<usize>,
    column: Vec<u32>,
    /// Lower triangle of the matrix, by columns.
    column_start: Vec<usize>,
    row: Vec<usize>,
    value: Vec<f64>,
    /// Per row of Ĵ, the places of its products in `value`.
    place: Vec<u32>,
    place_start: Vec<usize>,
    analysis: Option<Analysis>,
}

struct Analysis {
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl fmt::Debug for Analysis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Analysis").field("entries", &self.factor.len()).finish_non_exhaustive()
    }
}

impl Clone for BodyFactor {
    /// Makes the analysis anew, as it cannot be copied; for the same pattern it is the same.
    fn clone(&self) -> Self {
        let mut copy = Self {
            start: self.start.clone(),
            column: self.column.clone(),
            column_start: self.column_start.clone(),
            row: self.row.clone(),
            value: self.value.clone(),
            place: self.place.clone(),
            place_start: self.place_start.clone(),
            analysis: None,
        };
        if let Some(known) = &self.analysis {
            copy.analyse_as(&known.factor);
        }
        copy
    }
}

impl BodyFactor {
    /// Prepares for the rows of `system`; the analysis is kept if the pattern is the same. Returns whether there is an
    /// analysis.
    pub(crate) fn prepare(&mut self, system: &System, columns: usize) -> bool {
        let same = self.analysis.is_some()
            && self.column_start.len() == columns + 1
            && self.start == system.pattern().0
            && self.column == system.pattern().1;
        if !same {
            self.analysis = None;
            let (start, column) = system.pattern();
            self.start.clear();
            self.start.extend_from_slice(start);
            self.column.clear();
            self.column.extend_from_slice(column);
            self.build_pattern(columns);
            self.analyse(columns);
        }
        self.analysis.is_some()
    }

    fn build_pattern(&mut self, columns: usize) {
        let mut below: Vec<Vec<usize>> = (0..columns).map(|k| vec![k]).collect();
        for range in self.start.windows(2) {
            let row = &self.column[range[0]..range[1]];
            for (x, &k) in row.iter().enumerate() {
                below[k as usize].extend(row[x + 1..].iter().map(|&l| l as usize));
            }
        }
        self.column_start.clear();
        self.column_start.push(0);
        self.row.clear();
        for list in &mut below {
            list.sort_unstable();
            list.dedup();
            self.row.extend_from_slice(list);
            self.column_start.push(self.row.len());
        }
        self.place.clear();
        self.place_start.clear();
        self.place_start.push(0);
        for range in self.start.windows(2) {
            let row = &self.column[range[0]..range[1]];
            for (x, &k) in row.iter().enumerate() {
                let begin = self.column_start[k as usize];
                let list = &self.row[begin..self.column_start[k as usize + 1]];
                for &l in &row[x..] {
                    let found = list.partition_point(|&r| r < l as usize);
                    self.place.push((begin + found) as u32);
                }
            }
            self.place_start.push(self.place.len());
        }
        self.value.clear();
        self.value.resize(self.row.len(), 0.0);
    }

    fn analyse(&mut self, columns: usize) {
        let pattern =
            SymbolicSparseColMatRef::new_checked(columns, columns, &self.column_start, None, &self.row);
        let parameters = CholeskySymbolicParams::default();
        let Ok(symbolic) =
            factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, parameters)
        else {
            return;
        };
        let numeric = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, llt_parameters());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let factor = vec![0.0; symbolic.len_val()];
        self.analysis = Some(Analysis { symbolic, factor, memory: MemBuffer::new(numeric.or(solve)) });
    }

    /// Makes the analysis of the present pattern, with the numbers of a known factor of it. Returns false if they do not
    /// belong to it.
    fn analyse_as(&mut self, factor: &[f64]) -> bool {
        self.analyse(self.column_start.len().saturating_sub(1));
        let fits = |analysis: &&mut Analysis| analysis.factor.len() == factor.len();
        let Some(analysis) = self.analysis.as_mut().filter(fits) else { return false };
        analysis.factor.copy_from_slice(factor);
        true
    }

    /// Factors I + Ĵᵀ W Ĵ with a weight W of each row. Returns whether that succeeded.
    pub(crate) fn factor(&mut self, system: &System, weight: impl Fn(usize) -> f64) -> bool {
        self.value.fill(0.0);
        for begin in &self.column_start[..self.column_start.len() - 1] {
            self.value[*begin] = 1.0;
        }
        let rows = (0..self.start.len() - 1).map(|row| (row, weight(row)));
        for (i, weight) in rows.filter(|(_, weight)| *weight != 0.0) {
            let values = system.row_values(i);
            let mut place = self.place[self.place_start[i]..self.place_start[i + 1]].iter();
            for (x, &v) in values.iter().enumerate() {
                let v = v * weight;
                for (&w, &at) in values[x..].iter().zip(place.by_ref()) {
                    self.value[at as usize] += v * w;
                }
            }
        }
        let Some(analysis) = &mut self.analysis else { return false };
        let n = self.column_start.len() - 1;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.column_start, None, &self.row);
        let matrix = SparseColMatRef::new(pattern, &self.value[..]);
        let stack = MemStack::new(&mut analysis.memory);
        analysis
            .symbolic
            .factorize_numeric_llt(
                &mut analysis.factor,
                matrix,
                Side::Lower,
                faer::linalg::cholesky::llt::factor::LltRegularization::default(),
                Par::Seq,
                stack,
                llt_parameters(),
            )
            .is_ok()
    }

    /// x := (the factored matrix)⁻¹ x.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        if let Some(analysis) = &mut self.analysis {
            let n = x.len();
            let factor = LltRef::new(&analysis.symbolic, &analysis.factor);
            let right = MatMut::from_column_major_slice_mut(x, n, 1);
            factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, MemStack::new(&mut analysis.memory));
        }
    }
}

fn llt_parameters() -> Spec<LltParams, f64> {
    Spec::default()
}

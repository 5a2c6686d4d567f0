//! The scaled problem that symmetric solvers work on.
//!
//! With s_i = sqrt(A_ii) (1 where A_ii = 0): f̂ = s f, â = a/s, b̂ = b/s, Â_ij = A_ij/(s_i s_j), so that Â has a unit
//! diagonal and nothing depends on units. For rows of bodies Â = Ĵ Ĵᵀ with Ĵ_ik = J_ik sqrt(M⁻¹_k)/s_i. The entries of
//! Â are formed only if the same pattern of rows comes again (see `entries`); without them an entry costs at most six
//! products, and a product Â f̂ costs twelve per row. Immovable columns drop out.

use crate::entries::Entries;
use crate::matrix::{BodyRows, Matrix, SparseMatrix};
use crate::problem::Problem;

/// The end of a list, or the position of an open row.
const NONE: u32 = u32::MAX;

/// Scaled rows. The closed rows are listed per column, so that Â_dC takes time proportional to the contacts of the
/// bodies that row d touches.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct System {
    /// Whether the rows below are Ĵ; otherwise they are Â.
    bodies: bool,
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
    /// s_i [1/sqrt(kg)].
    pub(crate) row_scale: Vec<f64>,
    /// 1/s_i.
    inverse_scale: Vec<f64>,
    /// b̂_i.
    pub(crate) b: Vec<f64>,
    /// max |b̂_i|, or 1 where b = 0.
    pub(crate) scale: f64,
    /// Per row, whether it moves any body: A_ii > 0.
    pub(crate) movable: Vec<bool>,
    /// sqrt(M⁻¹) per column; below, Ĵᵀ f̂ with the sum of the absolute terms.
    root: Vec<f64>,
    motion: Vec<[f64; 2]>,
    /// Ĵᵀ f̂ alone.
    speed: Vec<f64>,
    /// The matrix that is loaded, for comparison with the next one.
    source_rows: SparseMatrix,
    source_mass: Vec<f64>,
    /// The entries of A, if the pattern of the rows was seen before, and those of Â off the diagonal, by rows.
    pub(crate) entries: Entries,
    entry: Vec<f64>,
    /// Without entries: doubly linked lists of the coefficients of closed rows, one list per column.
    head: Vec<u32>,
    next: Vec<u32>,
    previous: Vec<u32>,
    row_of: Vec<u32>,
}

impl System {
    pub(crate) fn rows(&self) -> usize {
        self.b.len()
    }

    /// Whether the matrix of `problem` is the one that is loaded.
    pub(crate) fn is_loaded(&self, problem: &Problem) -> bool {
        let (rows, mass, bodies) = source(problem);
        self.bodies == bodies && self.source_mass == mass && self.source_rows == *rows
    }

    /// Scales `problem`, whose matrix must be symmetric. If its matrix is the one that is loaded, only b is replaced,
    /// and the result is true; the lists of closed rows stay.
    pub(crate) fn load(&mut self, problem: &Problem) -> bool {
        let same = self.is_loaded(problem);
        self.b.clear();
        if same {
            self.b.extend(problem.offset.iter().zip(&self.inverse_scale).map(|(b, inverse)| b * inverse));
        } else {
            let (rows, mass, _) = source(problem);
            self.source_rows.clone_from(rows);
            self.source_mass.clear();
            self.source_mass.extend_from_slice(mass);
            self.start.clear();
            self.start.push(0);
            self.column.clear();
            self.value.clear();
            self.row_scale.clear();
            self.inverse_scale.clear();
            self.movable.clear();
            match &problem.matrix {
                Matrix::Bodies(bodies) => self.load_bodies(bodies, &problem.offset),
                Matrix::Symmetric(matrix) | Matrix::General(matrix) => {
                    self.load_matrix(matrix, &problem.offset);
                }
            }
        }
        let largest = self.b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
        self.scale = if largest > 0.0 { largest } else { 1.0 };
        same
    }

    fn load_bodies(&mut self, bodies: &BodyRows, offset: &[f64]) {
        self.bodies = true;
        self.root.clear();
        self.root.extend(bodies.inverse_mass.iter().map(|w| w.sqrt()));
        self.row_of.clear();
        for (i, &b) in offset.iter().enumerate() {
            let (columns, values) = bodies.rows.row(i);
            let begin = self.value.len();
            let mut square = 0.0;
            for (&k, &v) in columns.iter().zip(values) {
                let scaled = v * self.root[k];
                if scaled != 0.0 {
                    square += scaled * scaled;
                    self.column.push(k as u32);
                    self.value.push(scaled);
                    self.row_of.push(i as u32);
                }
            }
            let inverse = self.finish_row(square, b);
            self.value[begin..].iter_mut().for_each(|v| *v *= inverse);
        }
        self.motion.clear();
        self.motion.resize(bodies.inverse_mass.len(), [0.0; 2]);
        self.speed.clear();
        self.speed.resize(bodies.inverse_mass.len(), 0.0);
    }

    /// Prepares for [`gather`](Self::gather), with all rows open: forms the entries of Â, or begins the lists.
    pub(crate) fn prepare_to_gather(&mut self, problem: &Problem) {
        match &problem.matrix {
            Matrix::Bodies(bodies) if self.entries.load(bodies) => {
                self.entries.write_by_rows(&self.inverse_scale, &mut self.entry);
            }
            Matrix::Bodies(_) => {
                self.head.clear();
                self.head.resize(self.root.len(), NONE);
                self.next.clear();
                self.next.resize(self.value.len(), NONE);
                self.previous.clear();
                self.previous.resize(self.value.len(), NONE);
            }
            Matrix::Symmetric(_) | Matrix::General(_) => self.entries.forget(),
        }
    }

    /// Forms the entries of Â when the same rows are solved again and the entries were not looked for before.
    pub(crate) fn form_entries(&mut self, problem: &Problem) {
        match &problem.matrix {
            Matrix::Bodies(bodies) if !self.entries.are_listed() && self.entries.load(bodies) => {
                self.entries.write_by_rows(&self.inverse_scale, &mut self.entry);
            }
            _ => {}
        }
    }

    fn load_matrix(&mut self, matrix: &SparseMatrix, offset: &[f64]) {
        self.bodies = false;
        for (i, &b) in offset.iter().enumerate() {
            let (columns, values) = matrix.row(i);
            let mut diagonal = 0.0;
            for (&j, &v) in columns.iter().zip(values) {
                if i == j {
                    diagonal = v;
                }
                self.column.push(j as u32);
                self.value.push(v);
            }
            self.finish_row(diagonal, b);
        }
        for i in 0..offset.len() {
            for e in self.start[i]..self.start[i + 1] {
                self.value[e] /= self.row_scale[i] * self.row_scale[self.column[e] as usize];
            }
        }
    }

    /// Records scale and offset of a row whose entries were just pushed; returns 1/s.
    fn finish_row(&mut self, diagonal: f64, b: f64) -> f64 {
        let s = if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 };
        let inverse = 1.0 / s;
        self.movable.push(diagonal > 0.0);
        self.start.push(self.value.len());
        self.row_scale.push(s);
        self.inverse_scale.push(inverse);
        self.b.push(b * inverse);
        inverse
    }

    /// Adds Â_dC to `y`, which is zero, and returns the first position that is not zero (the number of closed rows if
    /// there is none). `position` gives the place of each closed row.
    pub(crate) fn gather(&self, d: usize, position: &[u32], closed: usize, y: &mut [f64]) -> usize {
        let mut first = closed;
        if self.entries.are_formed() {
            let (range, others) = self.entries.of_row(d);
            for (&other, &value) in others.iter().zip(&self.entry[range]) {
                let at = position[other as usize];
                if at != NONE {
                    y[at as usize] = value;
                    first = first.min(at as usize);
                }
            }
            return first;
        }
        for e in self.start[d]..self.start[d + 1] {
            let (k, v) = (self.column[e] as usize, self.value[e]);
            if self.bodies {
                let mut other = self.head[k];
                while other != NONE {
                    let at = position[self.row_of[other as usize] as usize] as usize;
                    y[at] += v * self.value[other as usize];
                    first = first.min(at);
                    other = self.next[other as usize];
                }
            } else if position[k] != NONE {
                let at = position[k] as usize;
                y[at] = v;
                first = first.min(at);
            }
        }
        first
    }

    fn has_lists(&self) -> bool {
        self.bodies && !self.entries.are_formed()
    }

    /// Lists a row as closed.
    pub(crate) fn close(&mut self, row: usize) {
        if self.has_lists() {
            for e in self.start[row]..self.start[row + 1] {
                let k = self.column[e] as usize;
                let old = self.head[k];
                self.next[e] = old;
                self.previous[e] = NONE;
                if old != NONE {
                    self.previous[old as usize] = e as u32;
                }
                self.head[k] = e as u32;
            }
        }
    }

    /// Takes a row off the lists of closed rows.
    pub(crate) fn open(&mut self, row: usize) {
        if self.has_lists() {
            for e in self.start[row]..self.start[row + 1] {
                let (before, after) = (self.previous[e], self.next[e]);
                match before {
                    NONE => self.head[self.column[e] as usize] = after,
                    _ => self.next[before as usize] = after,
                }
                if after != NONE {
                    self.previous[after as usize] = before;
                }
            }
        }
    }

    /// a := Â f + b̂. Returns the largest sum of absolute terms of a component, the measure of its rounding.
    pub(crate) fn accelerate(&mut self, f: &[f64], a: &mut [f64]) -> f64 {
        if !self.bodies {
            return self.accelerate_matrix(f, a);
        }
        self.motion.fill([0.0; 2]);
        for (j, &force) in f.iter().enumerate() {
            if force != 0.0 {
                for e in self.start[j]..self.start[j + 1] {
                    let push = self.value[e] * force;
                    let motion = &mut self.motion[self.column[e] as usize];
                    motion[0] += push;
                    motion[1] += push.abs();
                }
            }
        }
        let mut largest: f64 = 0.0;
        for (i, out) in a.iter_mut().enumerate() {
            let (mut sum, mut terms) = (0.0, 0.0);
            for e in self.start[i]..self.start[i + 1] {
                let motion = self.motion[self.column[e] as usize];
                sum += self.value[e] * motion[0];
                terms += self.value[e].abs() * motion[1];
            }
            *out = sum + self.b[i];
            largest = largest.max(terms);
        }
        largest
    }

    /// a := Â f + b̂ without the sums of terms, for rows of bodies only. Returns whether the rows are of bodies.
    pub(crate) fn evaluate(&mut self, f: &[f64], a: &mut [f64]) -> bool {
        if self.bodies {
            let mut speed = std::mem::take(&mut self.speed);
            self.push(f, &mut speed);
            self.pull(&speed, a);
            a.iter_mut().zip(&self.b).for_each(|(a, b)| *a += b);
            self.speed = speed;
        }
        self.bodies
    }

    fn accelerate_matrix(&self, f: &[f64], a: &mut [f64]) -> f64 {
        let mut largest: f64 = 0.0;
        for (i, out) in a.iter_mut().enumerate() {
            let (mut sum, mut terms) = (0.0, 0.0);
            for e in self.start[i]..self.start[i + 1] {
                let term = self.value[e] * f[self.column[e] as usize];
                sum += term;
                terms += term.abs();
            }
            *out = sum + self.b[i];
            largest = largest.max(terms);
        }
        largest
    }
}

/// The matrix and masses of a problem, and whether its rows are those of bodies.
fn source(problem: &Problem) -> (&SparseMatrix, &[f64], bool) {
    match &problem.matrix {
        Matrix::Bodies(bodies) => (&bodies.rows, &bodies.inverse_mass, true),
        Matrix::Symmetric(matrix) | Matrix::General(matrix) => (matrix, &[], false),
    }
}

/// Products with Ĵ, for problems of bodies.
impl System {
    /// Number of columns of Ĵ, or of Â.
    pub(crate) fn columns(&self) -> usize {
        if self.bodies { self.root.len() } else { self.rows() }
    }

    /// Where the entries of each row begin, and their columns.
    pub(crate) fn pattern(&self) -> (&[usize], &[u32]) {
        (&self.start, &self.column)
    }

    /// Entries of a row.
    pub(crate) fn row_values(&self, row: usize) -> &[f64] {
        &self.value[self.start[row]..self.start[row + 1]]
    }

    /// u := Ĵᵀ f.
    pub(crate) fn push(&self, f: &[f64], u: &mut [f64]) {
        u.fill(0.0);
        for (i, &force) in f.iter().enumerate() {
            if force != 0.0 {
                for e in self.start[i]..self.start[i + 1] {
                    u[self.column[e] as usize] += self.value[e] * force;
                }
            }
        }
    }

    /// a := Ĵ u.
    pub(crate) fn pull(&self, u: &[f64], a: &mut [f64]) {
        for (i, out) in a.iter_mut().enumerate() {
            let range = self.start[i]..self.start[i + 1];
            let terms = self.column[range.clone()].iter().zip(&self.value[range]);
            *out = terms.map(|(&k, v)| v * u[k as usize]).sum();
        }
    }
}

#[cfg(feature = "qp")]
impl System {
    /// Rows Ĵ with Â = Ĵ Ĵᵀ as (column, value), and the number of columns: the rows of bodies themselves, or
    /// a factor of Â by Cholesky with diagonal pivoting, ended where at most `dependence` is left of any
    /// diagonal entry.
    pub(crate) fn rows_or_factor(&self, dependence: f64) -> (Vec<Vec<(usize, f64)>>, usize) {
        let n = self.rows();
        let entries =
            |i: usize| (self.start[i]..self.start[i + 1]).map(|e| (self.column[e] as usize, self.value[e]));
        if self.bodies {
            return ((0..n).map(|i| entries(i).collect()).collect(), self.root.len());
        }
        let mut rows: Vec<Vec<f64>> = vec![Vec::new(); n];
        let mut rest: Vec<f64> = self.movable.iter().map(|&m| f64::from(u8::from(m))).collect();
        for rank in 0..n {
            let pivot = (0..n).max_by(|&i, &j| rest[i].total_cmp(&rest[j])).unwrap_or(0);
            if rest[pivot] <= dependence {
                break;
            }
            let root = rest[pivot].sqrt();
            let mut line = vec![0.0; n];
            entries(pivot).for_each(|(j, v)| line[j] = v);
            let own = rows[pivot].clone();
            for i in 0..n {
                let value = (line[i] - rows[i].iter().zip(&own).map(|(x, y)| x * y).sum::<f64>()) / root;
                debug_assert_eq!(rows[i].len(), rank);
                rows[i].push(if i == pivot { root } else { value });
                rest[i] -= value * value;
            }
            rest[pivot] = f64::NEG_INFINITY;
        }
        let columns = rows.first().map_or(0, Vec::len);
        (rows.into_iter().map(|row| row.into_iter().enumerate().collect()).collect(), columns)
    }
}

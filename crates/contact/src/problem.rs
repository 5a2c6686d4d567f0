//! The contact problem: rows in, forces out.
//!
//! With n rows, find f and a with
//!
//! ```text
//! a = A f + b        A (n, n) [1/kg], b (n) [m/s²], f (n) \[N\]
//! f ≥ 0, a ≥ 0, fᵀa = 0      on unilateral rows
//! a = 0, f free              on bilateral rows
//! ```
//!
//! A = J M⁻¹ Jᵀ when the rows J (n, columns) of the bodies are given, which is the natural form; or its entries. With
//! b made from accelerations f are forces; with b made from closing velocities and elasticities a are velocities [m/s]
//! and f impulses [N·s]. Source: D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies",
//! SIGGRAPH '94, 23-34, section 3.

use crate::error::ProblemError;
use crate::matrix::{BodyRows, Matrix, SparseMatrix, check_finite};

/// A contact problem, complete and checked: every number is finite, every index exists.
///
/// To be reused from step to step: [`clear`](Self::clear) keeps the room of all buffers.
///
/// # Examples
///
/// ```
/// use halfgap_contact::{InverseInertia, Problem, Row, Solution, Solver, DualActiveSet};
///
/// // A block of 2 kg, half a metre wide, at rest on a floor under its two lower corners.
/// let mut problem = Problem::new();
/// let block = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 20.0 })?;
/// for arm in [-0.25, 0.25] {
///     problem.add_row(&Row::new(block, [0.0, 1.0, arm], -9.81))?;
/// }
/// let mut solution = Solution::new();
/// DualActiveSet::default().solve(&problem, &mut solution)?;
/// assert!((solution.force[0] - 9.81).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    pub(crate) matrix: Matrix,
    pub(crate) offset: Vec<f64>,
    pub(crate) bilateral: Vec<bool>,
    pub(crate) keys: Vec<ContactKey>,
}

/// The force of a unilateral row, which pushes or is none. Zero has no sign then, which `f64::max` leaves to the compiler.
#[inline(always)]
pub(crate) fn pushing(force: f64) -> f64 {
    if force > 0.0 { force } else { 0.0 }
}

/// Index of a body within one problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProblemBody(pub u32);

/// Identity of a contact, kept from one problem to the next, by which a warm start finds it again.
///
/// Any number the caller likes but that of [`NONE`](Self::NONE); two rows of one problem should not share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContactKey(pub u64);

impl ContactKey {
    /// Stands for no identity. Where not all rows have one, a warm start finds all of them by their place.
    pub const NONE: Self = Self(u64::MAX);
}

/// Inverse masses of a body; zero for a body that nothing moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseInertia {
    /// 1/m [1/kg].
    pub inverse_mass: f64,
    /// 1/I about the centre of mass [1/(kg m²)].
    pub inverse_moment: f64,
}

/// One row: how the motion of one or two bodies changes a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The primary body and the row's coefficients for its x, y \[1\] and rotation \[m\].
    pub primary: (ProblemBody, [f64; 3]),
    /// The normal body and its coefficients, if the other side is a body of the problem.
    pub normal: Option<(ProblemBody, [f64; 3])>,
    /// b_i: the gap's acceleration without contact forces [m/s²], or what an impulse has to undo [m/s].
    pub offset: f64,
    /// Whether the row is an equation (a = 0, f free), as of a connector.
    pub bilateral: bool,
    /// Identity for warm starts.
    pub key: Option<ContactKey>,
}

impl Row {
    /// A unilateral row against something immovable.
    #[must_use]
    pub fn new(body: ProblemBody, coefficients: [f64; 3], offset: f64) -> Self {
        Row { primary: (body, coefficients), normal: None, offset, bilateral: false, key: None }
    }

    /// The same row with a second body.
    #[must_use]
    pub fn against(self, body: ProblemBody, coefficients: [f64; 3]) -> Self {
        Row { normal: Some((body, coefficients)), ..self }
    }

    /// A unilateral row of two sides, of which some are no bodies of the problem, with the coefficients for x, y and rotation of
    /// either; `None` if neither is.
    #[must_use]
    pub fn between(sides: [Option<ProblemBody>; 2], coefficients: &[f64; 6], offset: f64) -> Option<Self> {
        let [c0, c1, c2, c3, c4, c5] = *coefficients;
        let (primary, normal) = ([c0, c1, c2], [c3, c4, c5]);
        match sides {
            [Some(a), Some(b)] => Some(Self::new(a, primary, offset).against(b, normal)),
            [Some(a), None] => Some(Self::new(a, primary, offset)),
            [None, Some(b)] => Some(Self::new(b, normal, offset)),
            [None, None] => None,
        }
    }

    /// The same row as an equation.
    #[must_use]
    pub fn bilateral(self) -> Self {
        Row { bilateral: true, ..self }
    }

    /// The same row with an identity.
    #[must_use]
    pub fn with_key(self, key: ContactKey) -> Self {
        Row { key: Some(key), ..self }
    }
}

impl Problem {
    /// A problem without bodies and rows, to be filled by [`add_body`](Self::add_body) and [`add_row`](Self::add_row).
    #[must_use]
    pub fn new() -> Self {
        Problem {
            matrix: Matrix::Bodies(BodyRows::new()),
            offset: Vec::new(),
            bilateral: Vec::new(),
            keys: Vec::new(),
        }
    }

    /// From rows J as entries (row, column, coefficient), which add up at one place, and the inverse mass per column.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row, column or list that is wrong.
    pub fn from_rows(
        triplets: &[(usize, usize, f64)],
        inverse_mass: &[f64],
        offset: &[f64],
    ) -> Result<Self, ProblemError> {
        for (column, &value) in inverse_mass.iter().enumerate() {
            check_inverse_mass(column, value)?;
        }
        let rows = SparseMatrix::from_triplets(offset.len(), inverse_mass.len(), triplets)?;
        let bodies = BodyRows { rows, inverse_mass: inverse_mass.to_vec() };
        (0..offset.len()).try_for_each(|row| bodies.check_square(row))?;
        Self::checked(Matrix::Bodies(bodies), offset)
    }

    /// From the entries (row, column, value) of a symmetric, positive semidefinite A; entries at one place add up.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong; an unsymmetric matrix is one for [`Problem::from_general`].
    pub fn from_symmetric(triplets: &[(usize, usize, f64)], offset: &[f64]) -> Result<Self, ProblemError> {
        let matrix = SparseMatrix::from_triplets(offset.len(), offset.len(), triplets)?;
        matrix.check_symmetric()?;
        Self::checked(Matrix::Symmetric(matrix), offset)
    }

    /// From the entries of any square A: a general linear complementarity problem, for Lemke's method.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    pub fn from_general(triplets: &[(usize, usize, f64)], offset: &[f64]) -> Result<Self, ProblemError> {
        let matrix = SparseMatrix::from_triplets(offset.len(), offset.len(), triplets)?;
        Self::checked(Matrix::General(matrix), offset)
    }

    /// From the dense rows of a symmetric, positive semidefinite A.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    pub fn from_dense(rows: &[Vec<f64>], offset: &[f64]) -> Result<Self, ProblemError> {
        Self::from_symmetric(&dense_triplets(rows, offset.len())?, offset)
    }

    /// From the dense rows of any square A.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    pub fn from_general_dense(rows: &[Vec<f64>], offset: &[f64]) -> Result<Self, ProblemError> {
        Self::from_general(&dense_triplets(rows, offset.len())?, offset)
    }

    fn checked(matrix: Matrix, offset: &[f64]) -> Result<Self, ProblemError> {
        let mut problem = Problem {
            matrix,
            offset: vec![0.0; offset.len()],
            bilateral: vec![false; offset.len()],
            keys: Vec::new(),
        };
        problem.set_offset(offset)?;
        Ok(problem)
    }

    /// Removes all rows and bodies, keeps the room.
    pub fn clear(&mut self) {
        if let Matrix::Bodies(bodies) = &mut self.matrix {
            bodies.rows.start.truncate(1);
            bodies.rows.column.clear();
            bodies.rows.value.clear();
            bodies.inverse_mass.clear();
        } else {
            self.matrix = Matrix::Bodies(BodyRows::new());
        }
        self.offset.clear();
        self.bilateral.clear();
        self.keys.clear();
    }

    /// Adds a body of three columns: x, y, rotation.
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadInverseMass`]; [`ProblemError::NoBodies`] if the problem was made from a matrix A.
    pub fn add_body(&mut self, inertia: InverseInertia) -> Result<ProblemBody, ProblemError> {
        let Matrix::Bodies(bodies) = &mut self.matrix else {
            return Err(ProblemError::NoBodies);
        };
        let first = bodies.inverse_mass.len();
        check_inverse_mass(first, inertia.inverse_mass)?;
        check_inverse_mass(first + 2, inertia.inverse_moment)?;
        bodies.inverse_mass.extend([inertia.inverse_mass, inertia.inverse_mass, inertia.inverse_moment]);
        Ok(ProblemBody((first / 3) as u32))
    }

    /// Adds a row; rows are numbered from 0 in the order in which they are added.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row; the problem is unchanged then.
    pub fn add_row(&mut self, row: &Row) -> Result<usize, ProblemError> {
        let index = self.offset.len();
        let Matrix::Bodies(bodies) = &mut self.matrix else {
            return Err(ProblemError::NoBodies);
        };
        let columns = bodies.inverse_mass.len();
        check_finite(index, "the offset b", row.offset)?;
        for (body, coefficients) in std::iter::once(row.primary).chain(row.normal) {
            let column = 3 * body.0 as usize;
            if column + 3 > columns {
                return Err(ProblemError::NoSuchColumn { row: index, column, columns });
            }
            coefficients.iter().try_for_each(|&value| check_finite(index, "a coefficient", value))?;
        }
        push_coefficients(&mut bodies.rows, row);
        if let Err(error) = bodies.check_square(index) {
            bodies.rows.pop_row();
            return Err(error);
        }
        self.offset.push(row.offset);
        self.bilateral.push(row.bilateral);
        if let Some(key) = row.key {
            self.keys.resize(index, ContactKey::NONE);
            self.keys.push(key);
        }
        Ok(index)
    }

    /// Replaces b, for a later step with the same rows.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is not finite, or the wrong length; b is unchanged then.
    pub fn set_offset(&mut self, offset: &[f64]) -> Result<(), ProblemError> {
        check_length("b", offset.len(), self.offset.len())?;
        for (row, &value) in offset.iter().enumerate() {
            check_finite(row, "the offset b", value)?;
        }
        self.offset.copy_from_slice(offset);
        Ok(())
    }

    /// Says which rows are equations.
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadLength`].
    pub fn set_bilateral(&mut self, bilateral: &[bool]) -> Result<(), ProblemError> {
        check_length("bilateral", bilateral.len(), self.offset.len())?;
        self.bilateral.copy_from_slice(bilateral);
        Ok(())
    }

    /// Gives every row an identity for warm starts; rows of bodies may have theirs from the start, by
    /// [`Row::with_key`].
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadLength`].
    pub fn set_keys(&mut self, keys: &[ContactKey]) -> Result<(), ProblemError> {
        check_length("keys", keys.len(), self.offset.len())?;
        self.keys.clear();
        self.keys.extend_from_slice(keys);
        Ok(())
    }

    /// Number of rows n.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offset.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.offset.is_empty()
    }

    /// The offset b of a = A f + b: what contacts would do without their forces, an acceleration [m/s²], or
    /// what an impulse must undo [m/s].
    #[must_use]
    pub fn offset(&self) -> &[f64] {
        &self.offset
    }

    /// Which rows are equations.
    #[must_use]
    pub fn bilateral(&self) -> &[bool] {
        &self.bilateral
    }

    /// Identities of the rows for warm starts: [`ContactKey::NONE`] for a row without one, and none at all
    /// for the rows after the last that has one.
    #[must_use]
    pub fn keys(&self) -> &[ContactKey] {
        &self.keys
    }

    /// Whether the rows are given as J and inverse masses.
    #[must_use]
    pub fn has_bodies(&self) -> bool {
        matches!(self.matrix, Matrix::Bodies(_))
    }

    /// Whether A is symmetric and positive semidefinite, so that forces minimise an energy.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        !matches!(self.matrix, Matrix::General(_))
    }

    /// Columns and coefficients of a row, in ascending order, without zeros: of J where the rows are given as
    /// such (columns 3 k to 3 k + 2 are x, y and rotation of body k), of A otherwise. With
    /// [`inverse_mass`](Self::inverse_mass) that is all a solver of one's own needs.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    #[must_use]
    pub fn row(&self, row: usize) -> (&[usize], &[f64]) {
        match &self.matrix {
            Matrix::Bodies(bodies) => bodies.rows.row(row),
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => matrix.row(row),
        }
    }

    /// Inverse mass of each column of J [1/kg, 1/(kg m²)]; `None` where A itself is given.
    #[must_use]
    pub fn inverse_mass(&self) -> Option<&[f64]> {
        match &self.matrix {
            Matrix::Bodies(bodies) => Some(&bodies.inverse_mass),
            Matrix::Symmetric(_) | Matrix::General(_) => None,
        }
    }

    /// The matrix A, dense, by rows [1/kg]: for looking at it, and for checks; O(n²).
    #[must_use]
    pub fn dense(&self) -> Vec<Vec<f64>> {
        let n = self.len();
        (0..n).map(|i| (0..n).map(|j| self.entry(i, j)).collect()).collect()
    }

    /// s_i = sqrt(A_ii), 1 where that is zero.
    pub(crate) fn row_scale(&self, row: usize) -> f64 {
        let diagonal = self.entry(row, row);
        if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 }
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        match &self.matrix {
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => matrix.entry(i, j),
            Matrix::Bodies(bodies) => {
                let (columns, values) = bodies.rows.row(i);
                let terms = columns.iter().zip(values);
                terms.map(|(&k, v)| v * bodies.inverse_mass[k] * bodies.rows.entry(j, k)).sum()
            }
        }
    }
}

impl Default for Problem {
    fn default() -> Self {
        Self::new()
    }
}

/// Appends the coefficients of a row in ascending order of column; zeros are left out, a body named twice adds up.
fn push_coefficients(rows: &mut SparseMatrix, row: &Row) {
    let (first, second) = match row.normal {
        Some(normal) if normal.0 == row.primary.0 => {
            let sum = std::array::from_fn(|k| row.primary.1[k] + normal.1[k]);
            ((row.primary.0, sum), None)
        }
        Some(normal) if normal.0 < row.primary.0 => (normal, Some(row.primary)),
        other => (row.primary, other),
    };
    for (body, coefficients) in std::iter::once(first).chain(second) {
        for (k, &value) in coefficients.iter().enumerate() {
            if value != 0.0 {
                rows.column.push(3 * body.0 as usize + k);
                rows.value.push(value);
            }
        }
    }
    rows.start.push(rows.column.len());
}

fn dense_triplets(rows: &[Vec<f64>], n: usize) -> Result<Vec<(usize, usize, f64)>, ProblemError> {
    check_length("A", rows.len(), n)?;
    let mut triplets = Vec::with_capacity(n * n);
    for (i, row) in rows.iter().enumerate() {
        check_length("a row of A", row.len(), n)?;
        triplets.extend(row.iter().enumerate().filter(|(_, v)| **v != 0.0).map(|(j, &v)| (i, j, v)));
    }
    Ok(triplets)
}

fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), ProblemError> {
    if found == expected { Ok(()) } else { Err(ProblemError::BadLength { what, found, expected }) }
}

fn check_inverse_mass(column: usize, value: f64) -> Result<(), ProblemError> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(ProblemError::BadInverseMass { column, value })
    }
}

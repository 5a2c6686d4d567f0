//! The contact problem: rows in, forces out.
//!
//! With n rows, find f and a with
//!
//! ```text
//! a = A f + b        A (n, n) [1/kg], b (n) [m/s²], f (n) [N]
//! f ≥ 0, a ≥ 0, fᵀa = 0      on unilateral rows
//! a = 0, f free              on bilateral rows
//! ```
//!
//! A is given by the rows J (n, columns) of the bodies and their inverse masses, A = J M⁻¹ Jᵀ, which is the natural
//! form, or by its entries. With b made from accelerations, f are forces; with b made from closing velocities and
//! elasticities, a are velocities [m/s] and f impulses [N·s]. Source: D. Baraff, "Fast contact force computation for
//! nonpenetrating rigid bodies", SIGGRAPH '94, 23-34, section 3.

use crate::error::ProblemError;
use crate::kind::{Direction, FurtherRows, RowKind};
use crate::matrix::{BodyRows, Matrix, SparseMatrix, check_finite};

/// A contact problem: the rows J and inverse masses of bodies, or the entries of A, and the offsets b of a = A f + b.
///
/// It is checked when built: every number is finite, every index exists.
///
/// Problems can be reused from step to step: [`clear`](Self::clear) keeps the memory of the buffers.
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
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Problem {
    pub(crate) matrix: Matrix,
    pub(crate) offset: Vec<f64>,
    /// True for each row that is bilateral.
    pub(crate) bilateral: Vec<bool>,
    /// The rows that are neither unilateral nor bilateral, or whose force acts in a direction of its own.
    pub(crate) further: FurtherRows,
    pub(crate) keys: Vec<ContactKey>,
}

/// Clamps the force of a unilateral row to zero or more. The zero is always +0.0; with `f64::max` its sign would be up
/// to the compiler.
#[inline(always)]
pub(crate) fn pushing(force: f64) -> f64 {
    if force > 0.0 { force } else { 0.0 }
}

/// Index of a body within one problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProblemBody(pub u32);

/// Identity of a contact across problems, by which a warm start finds the row again.
///
/// Any number except that of [`NONE`](Self::NONE); two rows of one problem should not share a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactKey(pub u64);

impl ContactKey {
    /// The key of a row without identity. If any row of a problem lacks a key, warm starts find all its rows by index.
    pub const NONE: Self = Self(u64::MAX);
}

/// Inverse mass and inverse moment of inertia of a body; both are 0 for an immovable body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct InverseInertia {
    /// Inverse mass 1/m [1/kg].
    pub inverse_mass: f64,
    /// Inverse moment of inertia 1/I about the centre of mass [1/(kg m²)].
    pub inverse_moment: f64,
}

/// One row of J: the rate of a gap per velocity of its one or two bodies, with the offset b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The primary body and its coefficients for x, y \[1\] and rotation \[m\].
    pub primary: (ProblemBody, [f64; 3]),
    /// The normal body and its coefficients for x, y \[1\] and rotation \[m\]; `None` if that side is immovable.
    pub normal: Option<(ProblemBody, [f64; 3])>,
    /// A third body, with the coefficient of its rotation \[m\]; `None` for most rows.
    pub third: Option<(ProblemBody, f64)>,
    /// b_i, negative when the gap closes: acceleration of the gap without contact forces [m/s²], or in impact problems
    /// its rate less the rate to be reached [m/s].
    pub offset: f64,
    /// How its force and its acceleration belong together.
    pub kind: RowKind,
    /// Coefficients of the force for x, y \[1\] and rotation \[m\] of the primary, then of the normal side, where it does
    /// not act in the direction that is measured; `None` if it does.
    pub force: Option<[[f64; 3]; 2]>,
    /// Identity for warm starts.
    pub key: Option<ContactKey>,
}

impl Row {
    /// Makes a unilateral row between `body` and something immovable: coefficients for x, y \[1\] and rotation \[m\],
    /// offset b [m/s²] (or [m/s] in impact problems).
    #[must_use]
    #[inline]
    pub fn new(body: ProblemBody, coefficients: [f64; 3], offset: f64) -> Self {
        Row {
            primary: (body, coefficients),
            normal: None,
            third: None,
            offset,
            kind: RowKind::Unilateral,
            force: None,
            key: None,
        }
    }

    /// Adds the normal body, with its coefficients for x, y \[1\] and rotation \[m\].
    #[must_use]
    #[inline]
    pub fn against(self, body: ProblemBody, coefficients: [f64; 3]) -> Self {
        Row { normal: Some((body, coefficients)), ..self }
    }

    /// Makes a unilateral row between a primary and a normal side, `None` for an immovable one. `coefficients` are
    /// those for x, y \[1\] and rotation \[m\] of the primary, then of the normal side. Returns `None` if both are
    /// immovable.
    #[must_use]
    #[inline]
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

    /// Adds the rotation of a further body to a row of one or two sides, with its coefficient \[m\]; where neither side can move, as
    /// told by `None`, the row has that body alone.
    #[must_use]
    #[inline]
    pub fn turning(sides: Option<Self>, body: ProblemBody, coefficient: f64, offset: f64) -> Self {
        match sides {
            Some(row) => Row { third: Some((body, coefficient)), ..row },
            None => Row::new(body, [0.0, 0.0, coefficient], offset),
        }
    }

    /// Makes the row bilateral: a = 0 with a force of either sign.
    #[must_use]
    #[inline]
    pub fn bilateral(self) -> Self {
        Row { kind: RowKind::Bilateral, ..self }
    }

    /// Bounds the force \[N\] of the row by constants: see [`RowKind::Bounded`].
    #[must_use]
    #[inline]
    pub fn bounded(self, least: f64, most: f64) -> Self {
        Row { kind: RowKind::Bounded { least, most }, ..self }
    }

    /// Bounds the force of the row by a coefficient times that of a unilateral row added before: see
    /// [`RowKind::Friction`].
    #[must_use]
    #[inline]
    pub fn friction(self, normal: usize, coefficient: f64) -> Self {
        Row { kind: RowKind::Friction { normal, coefficient }, ..self }
    }

    /// Lets the force act in a direction of its own: its coefficients for x, y \[1\] and rotation \[m\] of the primary,
    /// then of the normal side (zeros if that is immovable).
    #[must_use]
    #[inline]
    pub fn with_force(self, primary: [f64; 3], normal: [f64; 3]) -> Self {
        Row { force: Some([primary, normal]), ..self }
    }

    /// Gives the row an identity for warm starts.
    #[must_use]
    #[inline]
    pub fn with_key(self, key: ContactKey) -> Self {
        Row { key: Some(key), ..self }
    }
}

impl Problem {
    /// Makes a problem without bodies and rows, to be filled by [`add_body`](Self::add_body) and
    /// [`add_row`](Self::add_row).
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Problem {
            matrix: Matrix::Bodies(BodyRows::new()),
            offset: Vec::new(),
            bilateral: Vec::new(),
            further: FurtherRows::default(),
            keys: Vec::new(),
        }
    }

    /// Makes a problem from the entries (row, column, coefficient) of J, the inverse mass of each column [1/kg, 1/(kg
    /// m²)] and the offset b of each row [m/s²]. Entries at the same place add up.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row, column or list that is wrong.
    #[inline]
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

    /// Makes a problem from the entries (row, column, value) [1/kg] of a symmetric, positive semidefinite A and the
    /// offset b of each row [m/s²]. Entries at the same place add up.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong. For an unsymmetric matrix use [`Problem::from_general`].
    #[inline]
    pub fn from_symmetric(triplets: &[(usize, usize, f64)], offset: &[f64]) -> Result<Self, ProblemError> {
        let matrix = SparseMatrix::from_triplets(offset.len(), offset.len(), triplets)?;
        matrix.check_symmetric()?;
        Self::checked(Matrix::Symmetric(matrix), offset)
    }

    /// Makes a general linear complementarity problem, for Lemke's method, from the entries (row, column, value) of any
    /// square A and the offset b of each row. Entries at the same place add up.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    #[inline]
    pub fn from_general(triplets: &[(usize, usize, f64)], offset: &[f64]) -> Result<Self, ProblemError> {
        let matrix = SparseMatrix::from_triplets(offset.len(), offset.len(), triplets)?;
        Self::checked(Matrix::General(matrix), offset)
    }

    /// Makes a problem from the dense rows [1/kg] of a symmetric, positive semidefinite A and the offset b of each row
    /// [m/s²].
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    #[inline]
    pub fn from_dense(rows: &[Vec<f64>], offset: &[f64]) -> Result<Self, ProblemError> {
        Self::from_symmetric(&dense_triplets(rows, offset.len())?, offset)
    }

    /// Makes a general linear complementarity problem from the dense rows of any square A and the offset b of each row.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is wrong.
    #[inline]
    pub fn from_general_dense(rows: &[Vec<f64>], offset: &[f64]) -> Result<Self, ProblemError> {
        Self::from_general(&dense_triplets(rows, offset.len())?, offset)
    }

    fn checked(matrix: Matrix, offset: &[f64]) -> Result<Self, ProblemError> {
        let mut problem = Problem {
            matrix,
            offset: vec![0.0; offset.len()],
            bilateral: vec![false; offset.len()],
            further: FurtherRows::default(),
            keys: Vec::new(),
        };
        problem.set_offset(offset)?;
        Ok(problem)
    }

    /// Removes all rows and bodies and keeps the memory of the buffers. A problem given by the entries of A becomes one
    /// that takes bodies.
    #[inline]
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
        self.further.clear();
        self.keys.clear();
    }

    /// Adds a body with its three columns x, y and rotation.
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadInverseMass`]; [`ProblemError::NoBodies`] if the problem was made from a matrix A.
    #[inline]
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
    /// [`ProblemError`] names the row, or is [`ProblemError::NoBodies`] if the problem was made from a matrix A. The
    /// problem is unchanged then.
    pub fn add_row(&mut self, row: &Row) -> Result<usize, ProblemError> {
        let index = self.offset.len();
        check_finite(index, "the offset b", row.offset)?;
        let measured = [row.primary.1, row.normal.map_or([0.0; 3], |normal| normal.1)];
        let bodies = [Some(row.primary.0.0), row.normal.map(|normal| normal.0.0)];
        let direction = row.force.filter(|force| *force != measured);
        let direction = direction.map(|coefficients| Direction { bodies, coefficients });
        FurtherRows::check_row(index, row.kind, direction, self)?;
        let Matrix::Bodies(bodies) = &mut self.matrix else {
            return Err(ProblemError::NoBodies);
        };
        let columns = bodies.inverse_mass.len();
        let third = row.third.map(|(body, coefficient)| (body, [0.0, 0.0, coefficient]));
        for (body, coefficients) in std::iter::once(row.primary).chain(row.normal).chain(third) {
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
        self.bilateral.push(row.kind == RowKind::Bilateral);
        self.further.push(index, row.kind, direction);
        if let Some(key) = row.key {
            self.keys.resize(index, ContactKey::NONE);
            self.keys.push(key);
        }
        Ok(index)
    }

    /// Replaces the offsets b [m/s²], for a later step with the same rows.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] names the row that is not finite, or the wrong length; b is unchanged then.
    #[inline]
    pub fn set_offset(&mut self, offset: &[f64]) -> Result<(), ProblemError> {
        check_length("b", offset.len(), self.offset.len())?;
        for (row, &value) in offset.iter().enumerate() {
            check_finite(row, "the offset b", value)?;
        }
        self.offset.copy_from_slice(offset);
        Ok(())
    }

    /// Makes all rows bilateral (true) or unilateral (false).
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadLength`] if there is not one flag per row.
    #[inline]
    pub fn set_bilateral(&mut self, bilateral: &[bool]) -> Result<(), ProblemError> {
        check_length("bilateral", bilateral.len(), self.offset.len())?;
        self.bilateral.copy_from_slice(bilateral);
        self.further.clear();
        Ok(())
    }

    /// Gives every row an identity for warm starts. Rows of bodies can also get theirs by [`Row::with_key`].
    ///
    /// # Errors
    ///
    /// [`ProblemError::BadLength`] if there is not one key per row.
    #[inline]
    pub fn set_keys(&mut self, keys: &[ContactKey]) -> Result<(), ProblemError> {
        check_length("keys", keys.len(), self.offset.len())?;
        self.keys.clear();
        self.keys.extend_from_slice(keys);
        Ok(())
    }

    /// Number of rows n.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.offset.len()
    }

    /// Whether there are no rows.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.offset.is_empty()
    }

    /// The offset b of a = A f + b by row, negative when closing: accelerations of the gaps without contact forces
    /// [m/s²], or in impact problems their rates less the rates to be reached [m/s].
    #[must_use]
    #[inline]
    pub fn offset(&self) -> &[f64] {
        &self.offset
    }

    /// Kind of a row.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    #[must_use]
    #[inline]
    pub fn kind(&self, row: usize) -> RowKind {
        self.further.kind(row).unwrap_or(RowKind::plain(self.bilateral[row]))
    }

    /// Coefficients of the force of a row for x, y \[1\] and rotation \[m\] of the primary, then of the normal side;
    /// `None` if it acts in the direction that is measured.
    #[must_use]
    #[inline]
    pub fn force_direction(&self, row: usize) -> Option<[[f64; 3]; 2]> {
        self.further.direction(row).map(|direction| direction.coefficients)
    }

    /// One flag per row: true if it is bilateral.
    #[must_use]
    #[inline]
    pub fn bilateral(&self) -> &[bool] {
        &self.bilateral
    }

    /// Identities of the rows for warm starts, [`ContactKey::NONE`] for a row without one. The list ends at the last
    /// row that was given one, so it may be shorter than the problem.
    #[must_use]
    #[inline]
    pub fn keys(&self) -> &[ContactKey] {
        &self.keys
    }

    /// Whether the rows are given as J and inverse masses.
    #[must_use]
    #[inline]
    pub fn has_bodies(&self) -> bool {
        matches!(self.matrix, Matrix::Bodies(_))
    }

    /// Whether the problem was given with a symmetric, positive semidefinite A, so that forces minimise an energy.
    #[must_use]
    #[inline]
    pub fn is_symmetric(&self) -> bool {
        !matches!(self.matrix, Matrix::General(_))
    }

    /// Stored columns (ascending) and coefficients of a row: of J where the problem has bodies (columns 3 k to 3 k + 2
    /// are x \[1\], y \[1\] and rotation \[m\] of body k), of A [1/kg] otherwise. Entries that are not stored are zero.
    /// With [`inverse_mass`](Self::inverse_mass) and [`offset`](Self::offset) this is the whole problem, for solvers
    /// outside this crate.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    #[must_use]
    #[inline]
    pub fn row(&self, row: usize) -> (&[usize], &[f64]) {
        match &self.matrix {
            Matrix::Bodies(bodies) => bodies.rows.row(row),
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => matrix.row(row),
        }
    }

    /// Inverse mass of each column of J: [1/kg] for x and y, [1/(kg m²)] for rotation. `None` if the problem was given
    /// by A.
    #[must_use]
    #[inline]
    pub fn inverse_mass(&self) -> Option<&[f64]> {
        match &self.matrix {
            Matrix::Bodies(bodies) => Some(&bodies.inverse_mass),
            Matrix::Symmetric(_) | Matrix::General(_) => None,
        }
    }

    /// The dense matrix A by rows [1/kg], for inspection and checks; O(n²).
    #[must_use]
    #[inline]
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
                if let Some(direction) = self.further.direction(j) {
                    let pushed = direction.entries();
                    return pushed.map(|(k, d)| bodies.rows.entry(i, k) * bodies.inverse_mass[k] * d).sum();
                }
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

/// Appends the coefficients of a row in ascending order of column. Zeros are left out; the coefficients of a body on
/// both sides add up.
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
    if let Some((body, value)) = row.third.filter(|(_, value)| *value != 0.0) {
        push_third(rows, 3 * body.0 as usize + 2, value);
    }
    rows.start.push(rows.column.len());
}

/// Puts the coefficient of a third body at its place among those of the row that is being appended.
fn push_third(rows: &mut SparseMatrix, column: usize, value: f64) {
    let begin = rows.start.last().copied().unwrap_or_default();
    let at = begin + rows.column[begin..].partition_point(|&other| other < column);
    if rows.column.get(at) == Some(&column) {
        rows.value[at] += value;
    } else {
        rows.column.insert(at, column);
        rows.value.insert(at, value);
    }
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

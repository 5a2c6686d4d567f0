//! Reading the collected problems, and a check of answers that shares no code with the crate.

use std::path::{Path, PathBuf};

use halfgap_contact::{ContactFile, Problem};

/// A problem of the collection.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) file: ContactFile,
    pub(crate) problem: Problem,
}

impl Case {
    pub(crate) fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let file = ContactFile::parse(&text).unwrap();
        let problem = file.problem().unwrap();
        Case { name: path.file_stem().unwrap().to_string_lossy().into_owned(), file, problem }
    }

    pub(crate) fn named(name: &str) -> Self {
        let mut path = folder().join(format!("{name}.json"));
        if !path.exists() {
            path = folder().join("problems").join(format!("{name}.json"));
        }
        Self::read(&path)
    }

    /// A problem that went wrong once.
    pub(crate) fn found(name: &str) -> Self {
        Self::read(&folder().join("../contact_found").join(format!("{name}.json")))
    }

    pub(crate) fn feasible(&self) -> bool {
        self.file.feasible.unwrap_or(true)
    }

    /// The problem one step later.
    pub(crate) fn next(&self) -> Problem {
        let mut next = self.problem.clone();
        next.set_offset(self.file.b_next.as_ref().unwrap()).unwrap();
        next
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/contact")
}

/// All problems, by name.
pub(crate) fn collection() -> Vec<Case> {
    let mut paths = Vec::new();
    for folder in [folder(), folder().join("problems")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "json") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    paths.iter().map(|path| Case::read(path)).collect()
}

/// Residuals of an answer, by the formulas of the documentation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub(crate) natural: f64,
    pub(crate) growth: f64,
    pub(crate) backward: f64,
}

impl Judged {
    /// Whether the answer is right: to rounding, where that suffices, else backward.
    pub(crate) fn good(&self) -> bool {
        if self.growth < 1e3 { self.natural <= 1e-12 } else { self.growth < 1e12 && self.backward <= 1e-14 }
    }
}

/// s_i = sqrt(A_ii), 1 where that is zero, and max |b_i / s_i|, 1 where that is zero.
pub(crate) fn scales(problem: &Problem) -> (Vec<f64>, f64) {
    let a = problem.dense();
    let s: Vec<f64> = (0..a.len()).map(|i| if a[i][i] > 0.0 { a[i][i].sqrt() } else { 1.0 }).collect();
    let scale = problem.offset().iter().zip(&s).fold(0.0, |m: f64, (b, s)| m.max(b.abs() / s));
    (s, if scale == 0.0 { 1.0 } else { scale })
}

/// Judges forces by the dense matrix.
pub(crate) fn judge(problem: &Problem, force: &[f64]) -> Judged {
    let a = problem.dense();
    let (s, scale) = scales(problem);
    let (mut residual, mut terms) = (0.0_f64, 0.0_f64);
    for (i, row) in a.iter().enumerate() {
        let acceleration = row.iter().zip(force).map(|(x, f)| x * f).sum::<f64>() + problem.offset()[i];
        let size: f64 = row.iter().zip(force).map(|(x, f)| (x * f).abs()).sum();
        let scaled = acceleration / s[i];
        let wrong = if problem.bilateral()[i] { scaled } else { (s[i] * force[i]).min(scaled) };
        assert!(wrong.is_finite());
        residual = residual.max(wrong.abs());
        terms = terms.max(size / s[i]);
    }
    let (natural, growth) = (residual / scale, terms / scale);
    Judged { natural, growth, backward: natural / (1.0 + growth) }
}

/// The reason why z proves nothing, `None` if it is a proof: z ≥ 0 and Aᵀz ≤ 0 (= 0 for bilateral rows) up to
/// rounding, and bᵀz < 0.
pub(crate) fn disproof(problem: &Problem, z: &[f64]) -> Option<&'static str> {
    let (s, scale) = scales(problem);
    let a = problem.dense();
    let largest = z.iter().zip(&s).fold(0.0, |m: f64, (z, s)| m.max((z * s).abs()));
    let worth: f64 = z.iter().zip(problem.offset()).map(|(z, b)| z * b).sum();
    let mut wrong = worth >= -1e-8 * scale * largest;
    for j in 0..z.len() {
        let image: f64 = (0..z.len()).map(|i| a[i][j] * z[i]).sum::<f64>() / s[j];
        let outside = if problem.bilateral()[j] { image.abs() } else { image.max(-z[j] * s[j]) };
        wrong |= outside > 1e-12 * largest;
    }
    wrong.then_some("not a proof")
}

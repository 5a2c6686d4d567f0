//! The language of scene files: names for numbers, expressions, repetition.
//!
//! A text becomes a [`Tree`]; [`Expansion`] finds what the names of `[let]` are worth and how often elements are
//! repeated; [`Reading`] hands the result to serde as if it had been written out. Places in what is read are led back to those in
//! the text by [`Expansion::origin`].

mod expression;
mod lets;
mod reading;
mod repeat;
mod tree;

pub(super) use expression::expression_in;
pub(super) use reading::Reading;
pub(super) use tree::Tree;

use super::error::SceneError;
use super::field_path::{FieldPath, Step};
use lets::Lets;
use repeat::{LISTS, Run, runs_of};

/// What a scene's names stand for, and how often its elements are repeated.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expansion {
    lets: Lets,
    /// The elements of the lists.
    runs: [Vec<Run>; LISTS.len()],
}

/// Where in the text a field comes from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Origin {
    pub(super) field: FieldPath,
    /// What names stand for there: `i = 3, j = 0`; empty where nothing is repeated.
    pub(super) bindings: String,
}

impl Expansion {
    /// Finds all names and repetitions of a scene; `changes` are values that take the place of those in `[let]`.
    ///
    /// # Errors
    /// [`SceneError`] for the first that is wrong, at its field in the text.
    pub(super) fn of(top: &Tree, changes: &[(String, String)]) -> Result<Self, SceneError> {
        let lets = Lets::read(top, changes)?;
        let mut runs: [Vec<Run>; LISTS.len()] = Default::default();
        let mut total = 0;
        for (runs, list) in runs.iter_mut().zip(LISTS) {
            if let Some(Tree::Array(elements)) = top.get(list) {
                *runs = runs_of(list, elements, &lets, &mut total)?;
            }
        }
        Ok(Self { lets, runs })
    }

    /// Where a field of the scene as it is read comes from.
    pub(super) fn origin(&self, field: &FieldPath) -> Origin {
        let plain = || Origin { field: field.clone(), bindings: String::new() };
        let [Step::Field(list), Step::Element(index), rest @ ..] = field.steps() else { return plain() };
        let Some(list) = LISTS.iter().position(|other| other == list) else { return plain() };
        let after = self.runs[list].partition_point(|run| run.first <= *index);
        let run = self.runs[list][..after].iter().rev().find(|run| run.count() > 0);
        let Some(run) = run else { return plain() };
        let steps = [Step::Field(LISTS[list].to_owned()), Step::Element(run.source)];
        let within = run.bindings((index - run.first) as u64);
        let told: Vec<String> = within.all().map(|(name, number)| format!("{name} = {number}")).collect();
        Origin { field: steps.into_iter().chain(rest.iter().cloned()).collect(), bindings: told.join(", ") }
    }
}

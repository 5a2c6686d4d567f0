//! Elements that are repeated: which elements of a list become how many, and with which numbers.
//!
//! `repeat = { i = [0, 11] }` makes one of each whole number from the first to the last, several names all combinations, the last
//! running fastest. *Invariant*: all elements of a scene together are at most [`MOST_ELEMENTS`], so that their number fits everywhere.

use super::expression::{evaluate, expression_in, is_name, is_taken};
use super::lets::{Lets, in_expression};
use super::tree::{LARGEST_WHOLE, Tree};
use crate::scene::error::SceneError;
use crate::scene::field_path::FieldPath;

/// The field that repeats an element.
pub(in crate::scene) const REPEAT: &str = "repeat";
/// Lists at the top of a scene whose elements may be repeated.
pub(super) const LISTS: [&str; 5] = ["body", "connector", "force", "pair", "probe"];
/// Most elements of all lists: more would not fit into the memory of a common machine.
const MOST_ELEMENTS: u64 = 1_000_000;
/// By how much the bound of a range may be off a whole number [-]: quotients of decimal fractions are off by rounding.
const WHOLE: f64 = 1e-9;

/// Whole numbers that a name takes.
#[derive(Clone, Debug, PartialEq)]
struct Range {
    name: String,
    from: i64,
    count: u64,
}

/// An element of a list, and what it becomes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Run {
    /// Its place in the text, and the place of the first that it becomes.
    pub(super) source: usize,
    pub(super) first: usize,
    ranges: Vec<Range>,
}

/// What the names of a repeated element stand for in one of those that it becomes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bindings<'t> {
    ranges: &'t [Range],
    /// Which of them.
    index: u64,
}

impl Run {
    pub(super) fn count(&self) -> u64 {
        self.ranges.iter().map(|range| range.count).product()
    }

    pub(super) fn is_repeated(&self) -> bool {
        !self.ranges.is_empty()
    }

    pub(super) fn bindings(&self, index: u64) -> Bindings<'_> {
        Bindings { ranges: &self.ranges, index }
    }
}

impl<'t> Bindings<'t> {
    /// Names and numbers; the last runs fastest.
    pub(super) fn all(self) -> impl Iterator<Item = (&'t str, i64)> {
        let mut every: u64 = self.ranges.iter().map(|range| range.count).product();
        self.ranges.iter().map(move |Range { name, from, count }| {
            every /= count;
            // Counts are bounded, and so are the numbers.
            (name.as_str(), from + ((self.index / every) % count) as i64)
        })
    }

    pub(super) fn get(self, name: &str) -> Option<i64> {
        self.all().find(|(other, _)| *other == name).map(|(_, number)| number)
    }

    pub(super) fn is_empty(self) -> bool {
        self.ranges.is_empty()
    }

    /// A text in which each `{expression}` is replaced by its whole number; `None` if it is the same.
    ///
    /// # Errors
    /// Says which expression has none.
    pub(super) fn fill(self, text: &str, lets: &Lets) -> Result<Option<String>, String> {
        if self.is_empty() || !text.contains('{') {
            return Ok(None);
        }
        let (mut filled, mut rest) = (String::new(), text);
        while let Some((before, after)) = rest.split_once('{') {
            let Some((expression, after)) = after.split_once('}') else { break };
            let value = self.value(expression, lets).and_then(nearest_whole);
            let number = value.map_err(|why| format!("in `{{{expression}}}`: {why}"))?;
            filled.push_str(before);
            filled.push_str(&number.to_string());
            rest = after;
        }
        filled.push_str(rest);
        Ok(Some(filled))
    }

    /// The value of an expression in these names and those of `[let]`.
    ///
    /// # Errors
    /// Says what is wrong with it.
    pub(super) fn value(self, expression: &str, lets: &Lets) -> Result<f64, String> {
        let mut lookup = |name: &str| {
            let bound = self.get(name).map(|number| number as f64);
            bound.or_else(|| lets.get(name)).map(Ok)
        };
        let known: Vec<&str> = lets.names().chain(self.all().map(|(name, _)| name)).collect();
        evaluate(expression, &mut lookup, &known)
    }
}

/// The runs of a list at the top of a scene; `elements` counts those of all lists.
///
/// # Errors
/// [`SceneError`] for the first `repeat` that is none, at its field.
pub(super) fn runs_of(
    list: &str,
    elements: &[Tree],
    lets: &Lets,
    total: &mut u64,
) -> Result<Vec<Run>, SceneError> {
    let mut first = 0;
    let mut runs = Vec::with_capacity(elements.len());
    for (source, element) in elements.iter().enumerate() {
        let at = FieldPath::top().field(list).element(source);
        let ranges =
            element.get(REPEAT).map(|repeat| ranges_of(repeat, lets, &at.field(REPEAT))).transpose()?;
        let run = Run { source, first, ranges: ranges.unwrap_or_default() };
        let count = run.ranges.iter().try_fold(1u64, |count, range| count.checked_mul(range.count));
        let sum = count.and_then(|count| total.checked_add(count)).filter(|&sum| sum <= MOST_ELEMENTS);
        let Some(sum) = sum else {
            let why = format!(
                "a scene has at most {MOST_ELEMENTS} bodies, connectors, forces, pairs and probes together"
            );
            return Err(SceneError::new(if run.is_repeated() { at.field(REPEAT) } else { at }, why));
        };
        first += usize::try_from(sum - *total).unwrap_or(usize::MAX);
        *total = sum;
        runs.push(run);
    }
    Ok(runs)
}

fn ranges_of(repeat: &Tree, lets: &Lets, at: &FieldPath) -> Result<Vec<Range>, SceneError> {
    let Tree::Table(names) = repeat else {
        return Err(SceneError::new(at.clone(), "must be a table of ranges such as { i = [0, 11] }"));
    };
    if names.is_empty() {
        return Err(SceneError::new(at.clone(), "has no range: write one such as { i = [0, 11] }"));
    }
    let mut ranges: Vec<Range> = Vec::with_capacity(names.len());
    for (name, bounds) in names {
        let at = at.field(name);
        let range = range_of(name, bounds, lets).map_err(|(element, why)| {
            SceneError::new(element.map_or(at.clone(), |element| at.element(element)), why)
        })?;
        if ranges.iter().any(|other| other.name == *name) {
            return Err(SceneError::new(at, "is named twice"));
        }
        ranges.push(range);
    }
    Ok(ranges)
}

/// A range from its name and its two bounds. An error tells which of them is wrong.
fn range_of(name: &str, bounds: &Tree, lets: &Lets) -> Result<Range, (Option<usize>, String)> {
    let fail = |why: &str| (None, why.to_owned());
    if !is_name(name) {
        return Err(fail("a name has letters a to z, digits and `_`, no digit first"));
    }
    if is_taken(name) || lets.get(name).is_some() {
        let place = if is_taken(name) { "part of the language" } else { "a name in `[let]`" };
        return Err((None, format!("`{name}` is {place}: take another name")));
    }
    let ends = if let Tree::Array(ends) = bounds { ends.as_slice() } else { &[] };
    let [first, last] = ends else {
        return Err((None, format!("must be [first, last], both included, got {}", bounds.unexpected())));
    };
    let from = whole(first, lets).map_err(|why| (Some(0), why))?;
    let to = whole(last, lets).map_err(|why| (Some(1), why))?;
    let count = u64::try_from(to - from + 1).map_err(|_| {
        (
            None,
            format!(
                "runs from {from} to {to}: the last must not be less than the first (by one: none is made)"
            ),
        )
    })?;
    Ok(Range { name: name.to_owned(), from, count })
}

/// The whole number that a bound is.
fn whole(bound: &Tree, lets: &Lets) -> Result<i64, String> {
    let number = match bound.text().and_then(expression_in) {
        Some(text) => Bindings::default().value(text, lets).map_err(|why| in_expression(text, &why))?,
        None => {
            bound.number().ok_or_else(|| format!("must be a whole number, got {}", bound.unexpected()))?
        }
    };
    nearest_whole(number)
}

fn nearest_whole(number: f64) -> Result<i64, String> {
    let nearest = number.round();
    let is_whole = (number - nearest).abs() <= WHOLE && nearest.abs() < LARGEST_WHOLE;
    if is_whole { Ok(nearest as i64) } else { Err(format!("must be a whole number, got {number}")) }
}

//! The numbers that `[let]` names, in any order.

use super::expression::{DEEPEST, evaluate, expression_in, is_name, is_taken};
use super::tree::Tree;
use crate::scene::error::SceneError;
use crate::scene::field_path::FieldPath;
use crate::scene::nearest::did_you_mean;
use std::collections::BTreeMap;

/// The table of the names.
pub(in crate::scene) const LET: &str = "let";

/// Values of all names.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lets {
    values: BTreeMap<String, f64>,
}

/// A name whose value is not known yet.
#[derive(Clone, Copy)]
enum Given<'t> {
    Number(f64),
    Expression(&'t str),
    /// Its value is being found.
    Open,
}

impl Lets {
    /// Finds the values of all names of the table at the top of a scene; `changes` are values that take the place of its own.
    ///
    /// # Errors
    /// [`SceneError`] for the first name that has none, at its field.
    pub(super) fn read(top: &Tree, changes: &[(String, String)]) -> Result<Self, SceneError> {
        let at = FieldPath::top().field(LET);
        let mut given = BTreeMap::new();
        if let Some(table) = top.get(LET) {
            let Tree::Table(names) = table else {
                return Err(SceneError::new(at, "must be a table of numbers"));
            };
            for (name, value) in names {
                let value = Given::of(name, value).map_err(|why| SceneError::new(at.field(name), why))?;
                if given.insert(name.as_str(), value).is_some() {
                    return Err(SceneError::new(at.field(name), "is named twice"));
                }
            }
        }
        for (name, text) in changes {
            let question = did_you_mean(name, given.keys().copied(), '`');
            let Some(value) = given.get_mut(name.as_str()) else {
                let why = format!("there is no `{name}` in `[let]` that could be set{question}");
                return Err(SceneError::new(at, why));
            };
            *value = Given::Expression(expression_in(text).unwrap_or(text));
        }
        let names: Vec<&str> = given.keys().copied().collect();
        let mut finding = Finding { given, names: &names, depth: 0, without: None };
        for &name in &names {
            if let Some(Err(why)) = finding.value(name) {
                return Err(SceneError::new(at.field(finding.without.unwrap_or(name)), why));
            }
        }
        let number = |(name, given): (&str, Given<'_>)| match given {
            Given::Number(number) => Some((name.to_owned(), number)),
            Given::Expression(_) | Given::Open => None,
        };
        Ok(Self { values: finding.given.into_iter().filter_map(number).collect() })
    }

    pub(super) fn get(&self, name: &str) -> Option<f64> {
        self.values.get(name).copied()
    }

    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.values.keys().map(String::as_str)
    }
}

impl<'t> Given<'t> {
    fn of(name: &str, value: &'t Tree) -> Result<Self, String> {
        if !is_name(name) {
            return Err("a name has letters a to z, digits and `_`, no digit first".to_owned());
        }
        if is_taken(name) {
            return Err(format!("`{name}` is part of the language: take another name"));
        }
        let number = value.number().filter(|number| number.is_finite()).map(Self::Number);
        let expression = || value.text().and_then(expression_in).map(Self::Expression);
        number.or_else(expression).ok_or_else(|| {
            format!("must be a number or an expression such as \"= 2*pi/12\", got {}", value.unexpected())
        })
    }
}

/// Names of which the values of some have been found.
struct Finding<'t, 'n> {
    given: BTreeMap<&'t str, Given<'t>>,
    names: &'n [&'t str],
    depth: usize,
    /// The first name whose expression has turned out to have no value.
    without: Option<&'t str>,
}

impl Finding<'_, '_> {
    /// The value of a name, which is found if it is not known yet; `None` if there is no such name.
    fn value(&mut self, name: &str) -> Option<Result<f64, String>> {
        let (&name, &given) = self.given.get_key_value(name)?;
        let text = match given {
            Given::Number(number) => return Some(Ok(number)),
            Given::Open => return Some(Err(format!("`{name}` is defined by itself"))),
            Given::Expression(text) => text,
        };
        self.given.insert(name, Given::Open);
        self.depth += 1;
        let found = if self.depth > DEEPEST {
            Err(format!("is defined by more than {DEEPEST} names, one by the other"))
        } else {
            let names = self.names;
            evaluate(text, &mut |other| self.value(other), names)
        };
        self.depth -= 1;
        let found = found.map_err(|why| in_expression(text, &why));
        match found {
            Ok(number) => drop(self.given.insert(name, Given::Number(number))),
            Err(_) => drop(self.without.get_or_insert(name)),
        }
        Some(found)
    }
}

/// What is wrong with an expression, with the expression itself, unless that has been said already.
pub(super) fn in_expression(text: &str, why: &str) -> String {
    if why.starts_with("in `") { why.to_owned() } else { format!("in `={text}`: {why}") }
}

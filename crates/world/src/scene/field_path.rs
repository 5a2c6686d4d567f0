//! Places in a scene file, such as `body[1].shape.disc.radius`.

use std::fmt;

/// One step of a path: into a field of a table, or to an element of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// A field of a table.
    Field(String),
    /// An element of an array, counted from 0.
    Element(usize),
}

/// The path from the top of a scene file to a field.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldPath {
    steps: Vec<Step>,
}

impl FieldPath {
    /// The top of the file.
    #[must_use]
    pub fn top() -> Self {
        Self::default()
    }

    /// The field `name` of the table at this path.
    #[must_use]
    pub fn field(&self, name: impl Into<String>) -> Self {
        self.then(Step::Field(name.into()))
    }

    /// The element `index` of the array at this path.
    #[must_use]
    pub fn element(&self, index: usize) -> Self {
        self.then(Step::Element(index))
    }

    /// The steps from the top.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// True for the top of the file.
    #[must_use]
    pub fn is_top(&self) -> bool {
        self.steps.is_empty()
    }

    fn then(&self, step: Step) -> Self {
        let mut steps = self.steps.clone();
        steps.push(step);
        Self { steps }
    }
}

impl FromIterator<Step> for FieldPath {
    fn from_iter<I: IntoIterator<Item = Step>>(steps: I) -> Self {
        Self { steps: steps.into_iter().collect() }
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, step) in self.steps.iter().enumerate() {
            match step {
                Step::Element(index) => write!(formatter, "[{index}]")?,
                Step::Field(name) => {
                    let dot = if place == 0 { "" } else { "." };
                    if is_bare(name) {
                        write!(formatter, "{dot}{name}")?;
                    } else {
                        write!(formatter, "{dot}{name:?}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// True for names that need no quotes in TOML.
fn is_bare(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_reads_like_an_expression() {
        let path = FieldPath::top().field("expected").element(2).field("bodies").field("big ball");
        assert_eq!(path.to_string(), "expected[2].bodies.\"big ball\"");
        assert_eq!(FieldPath::top().to_string(), "");
    }
}

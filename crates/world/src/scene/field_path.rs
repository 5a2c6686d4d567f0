//! Paths to fields of a scene file, such as `body[1].shape.disc.radius`.

use std::fmt;
use std::str::FromStr;

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

    /// Returns the path of the field `name` of the table at this path.
    #[must_use]
    pub fn field(&self, name: impl Into<String>) -> Self {
        self.then(Step::Field(name.into()))
    }

    /// Returns the path of the element `index`, from 0, of the array at this path.
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

/// Error for a text that is no path to a field.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a field is written like run.tolerance, body[0].position[1] or body.\"big ball\".mass, got {0}")]
pub struct BadFieldPath(String);

impl FromStr for FieldPath {
    type Err = BadFieldPath;

    /// Parses the form that `Display` writes.
    fn from_str(text: &str) -> Result<Self, BadFieldPath> {
        let bad = || BadFieldPath(text.to_owned());
        let (mut path, mut rest) = (Self::top(), text);
        while !rest.is_empty() {
            let (step, after) = if let Some(inside) = rest.strip_prefix('[') {
                read_element(inside)
            } else {
                let name = if path.is_top() { Some(rest) } else { rest.strip_prefix('.') };
                name.and_then(read_name)
            }
            .ok_or_else(bad)?;
            path = path.then(step);
            rest = after;
        }
        if path.is_top() { Err(bad()) } else { Ok(path) }
    }
}

/// Reads the number of an element, and returns it with the text after its bracket.
fn read_element(text: &str) -> Option<(Step, &str)> {
    let (number, after) = text.split_once(']')?;
    Some((Step::Element(number.parse().ok()?), after))
}

/// Reads a name, bare or in quotes, and returns it with the text after it.
fn read_name(text: &str) -> Option<(Step, &str)> {
    let Some(quoted) = text.strip_prefix('"') else {
        let end = text.find(['.', '[']).unwrap_or(text.len());
        let (name, after) = text.split_at(end);
        return is_bare(name).then(|| (Step::Field(name.to_owned()), after));
    };
    let (mut name, mut letters) = (String::new(), quoted.char_indices());
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => return Some((Step::Field(name), &quoted[at + 1..])),
            '\\' => name.push(escaped(&mut letters)?),
            _ => name.push(letter),
        }
    }
    None
}

/// Reads the rest of a Rust escape sequence after its backslash, and returns the character.
fn escaped(letters: &mut std::str::CharIndices<'_>) -> Option<char> {
    Some(match letters.next()?.1 {
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        '0' => '\0',
        'u' => {
            letters.next().filter(|&(_, letter)| letter == '{')?;
            let digits: String =
                letters.map(|(_, letter)| letter).take_while(|&letter| letter != '}').collect();
            char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?
        }
        letter => letter,
    })
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

    #[test]
    fn a_path_is_read_as_it_is_written() {
        for text in
            ["run.tolerance", "body[0].position[1]", "body.\"big \\\"ball\".mass", "expected[2].bodies.a-b_3"]
        {
            assert_eq!(text.parse::<FieldPath>().map(|path| path.to_string()), Ok(text.to_owned()));
        }
        for name in ["a\tb", "a\nb\r", "\0", "e\u{301}", "\u{7f}\u{1f600}", "a\\n\"b\""] {
            let path = FieldPath::top().field("body").field(name).field("mass");
            assert_eq!(path.to_string().parse::<FieldPath>(), Ok(path), "{name:?}");
        }
        for text in
            ["", ".run", "run.", "run..x", "body[x]", "body[1", "body.\"a", "big ball", "body[0]position"]
        {
            assert!(text.parse::<FieldPath>().is_err(), "{text}");
        }
    }
}

//! Which value of a problem file is of the wrong kind.
//!
//! The messages of serde name types of this crate, and no fields; so a file that it refuses is searched once more, in
//! the order of the format's fields.

use serde_json::{Map, Value};

use super::{FileError, PROBLEM_FORMAT};

const NUMBERS: &str = "an array of numbers";
const FLAGS: &str = "an array of true and false";
const MATRIX: &str = "rows of numbers, or an object with `n` and `triplets`";
const TRIPLETS: &str = "an array of entries [row, column, value]";
const FRICTION: &str = "an object with whole numbers `row` and `normal`, and a number `coefficient`";
const BOUNDS: &str = "an object with a whole number `row`, and numbers `least` and `most` or one of them";
const WHOLE: &str = "a whole number that is not negative";
/// Largest number of characters of a value in a message.
const LONGEST: usize = 40;

/// Result of a search: an error that names the first wrong value.
type Search = Result<(), FileError>;

/// Returns the error for the first wrong value of a text that is JSON; `None` if the text is none, or has none.
pub(super) fn find_fault(text: &str) -> Option<FileError> {
    let file: Value = serde_json::from_str(text).ok()?;
    search(&file).err()
}

fn search(file: &Value) -> Search {
    let Value::Object(fields) = file else { return Err(wrong("", "an object", file)) };
    if let Some(Value::String(format)) = fields.get("format").filter(|format| *format != PROBLEM_FORMAT) {
        return Err(FileError::Format(format.clone()));
    }
    for name in ["format", "b"] {
        if !fields.contains_key(name) {
            return Err(FileError::Missing(name));
        }
    }
    for name in ["format", "title", "family"] {
        check(fields, name, "a string", Value::is_string)?;
    }
    for name in ["symmetric", "feasible"] {
        check(fields, name, "true or false", Value::is_boolean)?;
    }
    if let Some(matrix) = given(fields, "A") {
        search_matrix(matrix)?;
    }
    if let Some(rows) = given(fields, "J") {
        search_sparse(rows, "J", &["rows", "columns"], "an object with `rows`, `columns` and `triplets`")?;
    }
    for name in ["inverse_mass", "b", "b_next", "reference_force"] {
        search_array(fields, "", name, NUMBERS, "a number", Value::is_number)?;
    }
    search_array(fields, "", "bilateral", FLAGS, "true or false", Value::is_boolean)?;
    search_array(fields, "", "friction", "an array of objects", FRICTION, is_friction)?;
    search_array(fields, "", "bounds", "an array of objects", BOUNDS, is_bounds)?;
    search_expected(fields)
}

fn is_friction(value: &Value) -> bool {
    let is_whole = |name: &str| value.get(name).is_some_and(Value::is_u64);
    is_whole("row") && is_whole("normal") && value.get("coefficient").is_some_and(Value::is_number)
}

fn is_bounds(value: &Value) -> bool {
    let is_bound = |name: &str| value.get(name).is_none_or(|bound| bound.is_number() || bound.is_null());
    value.get("row").is_some_and(Value::is_u64) && is_bound("least") && is_bound("most")
}

/// Returns the value of a field; `None` if it is missing or null.
fn given<'a>(fields: &'a Map<String, Value>, name: &str) -> Option<&'a Value> {
    fields.get(name).filter(|value| !value.is_null())
}

fn check(
    fields: &Map<String, Value>,
    name: &str,
    expected: &'static str,
    is_right: fn(&Value) -> bool,
) -> Search {
    match given(fields, name).filter(|value| !is_right(value)) {
        Some(value) => Err(wrong(name, expected, value)),
        None => Ok(()),
    }
}

/// Checks the array in a field, whose path begins with `around`, and its elements.
fn search_array(
    fields: &Map<String, Value>,
    around: &str,
    name: &str,
    whole: &'static str,
    part: &'static str,
    is_right: fn(&Value) -> bool,
) -> Search {
    let Some(value) = given(fields, name) else { return Ok(()) };
    let path = format!("{around}{name}");
    let Value::Array(elements) = value else { return Err(wrong(&path, whole, value)) };
    search_elements(elements, &path, part, is_right)
}

fn search_elements(
    elements: &[Value],
    path: &str,
    part: &'static str,
    is_right: fn(&Value) -> bool,
) -> Search {
    match elements.iter().position(|element| !is_right(element)) {
        Some(index) => Err(wrong(&format!("{path}[{index}]"), part, &elements[index])),
        None => Ok(()),
    }
}

fn search_matrix(matrix: &Value) -> Search {
    let Value::Array(rows) = matrix else { return search_sparse(matrix, "A", &["n"], MATRIX) };
    for (index, row) in rows.iter().enumerate() {
        let path = format!("A[{index}]");
        let Value::Array(entries) = row else { return Err(wrong(&path, NUMBERS, row)) };
        search_elements(entries, &path, "a number", Value::is_number)?;
    }
    Ok(())
}

/// Checks a sparse matrix with the given names of its sizes.
fn search_sparse(matrix: &Value, name: &str, sizes: &[&str], expected: &'static str) -> Search {
    let Value::Object(fields) = matrix else { return Err(wrong(name, expected, matrix)) };
    if sizes.iter().chain(&["triplets"]).any(|field| !fields.contains_key(*field)) {
        return Err(wrong(name, expected, matrix));
    }
    if let Some(size) = sizes.iter().find(|size| !is_index(&fields[**size])) {
        return Err(wrong(&format!("{name}.{size}"), WHOLE, &fields[*size]));
    }
    let triplets = &fields["triplets"];
    let Value::Array(entries) = triplets else {
        return Err(wrong(&format!("{name}.triplets"), TRIPLETS, triplets));
    };
    for (index, entry) in entries.iter().enumerate() {
        let path = format!("{name}.triplets[{index}]");
        let parts = entry.as_array().filter(|parts| parts.len() == 3);
        let Some(parts) = parts else { return Err(wrong(&path, "[row, column, value]", entry)) };
        search_elements(&parts[..2], &path, WHOLE, is_index)?;
        if !parts[2].is_number() {
            return Err(wrong(&format!("{path}[2]"), "a number", &parts[2]));
        }
    }
    Ok(())
}

fn search_expected(fields: &Map<String, Value>) -> Search {
    let Some(value) = given(fields, "expected") else { return Ok(()) };
    let Value::Object(expected) = value else { return Err(wrong("expected", "an object", value)) };
    for name in ["acceleration", "force"] {
        search_array(expected, "expected.", name, NUMBERS, "a number", Value::is_number)?;
    }
    match given(expected, "tolerance").filter(|value| !value.is_number()) {
        Some(value) => Err(wrong("expected.tolerance", "a number", value)),
        None => Ok(()),
    }
}

fn is_index(value: &Value) -> bool {
    value.as_u64().is_some_and(|index| usize::try_from(index).is_ok())
}

fn wrong(field: &str, expected: &'static str, value: &Value) -> FileError {
    let found = match value {
        Value::Array(_) => "an array".to_owned(),
        Value::Object(_) => "an object".to_owned(),
        other => other.to_string().chars().take(LONGEST).collect(),
    };
    FileError::WrongValue { field: field.to_owned(), expected, found }
}

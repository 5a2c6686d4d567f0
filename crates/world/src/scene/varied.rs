//! A scene in which one number takes other values.
//!
//! The text is kept as plain data; each value is put in its place, and the whole is read and checked like a file.

use super::Scene;
use super::error::SceneError;
use super::field_path::{FieldPath, Step};
use super::language::{Tree, expression_in};
use super::nearest::did_you_mean;
use super::source::SceneSource;

/// Tables at the top of a scene that have numbers.
const TABLES: [&str; 7] = ["let", "run", "body", "connector", "force", "pair", "expected"];

/// A scene in which one number takes other values.
#[derive(Clone, Debug)]
pub struct VariedScene {
    source: SceneSource,
    data: Tree,
    field: FieldPath,
}

impl VariedScene {
    /// Makes a scene whose number at `field` can be varied. An element of `body` may be named by its `name`, as in
    /// `body.ball.elasticity`; a field that the text leaves out can be varied too, if the format has it.
    ///
    /// # Errors
    /// [`SceneError`] if the scene is not valid, there is no such field, or it is not a number.
    pub fn new(source: SceneSource, field: &FieldPath) -> Result<Self, SceneError> {
        let data = source.tree()?;
        source.scene_of(&data)?;
        let field = resolved(&data, field).map_err(|error| source.place(error))?;
        Ok(Self { source, data, field })
    }

    /// Path of the field, with elements by their index: `body[1].elasticity`.
    #[must_use]
    pub fn field(&self) -> &FieldPath {
        &self.field
    }

    /// Returns the scene with a value in the field.
    ///
    /// # Errors
    /// [`SceneError`] if the format has no such field, or the value is out of its range.
    pub fn with(&self, value: f64) -> Result<Scene, SceneError> {
        let told = |error: SceneError| {
            let (field, message) =
                (error.field().clone(), format!("{} (varied to {value})", error.message()));
            error.moved_to(field, message)
        };
        let bad = |message: &str| told(self.source.place(SceneError::new(self.field.clone(), message)));
        if !value.is_finite() {
            return Err(bad("must be finite"));
        }
        let mut data = self.data.clone();
        put(&mut data, self.field.steps(), value).ok_or_else(|| bad("there is no such field"))?;
        self.source.scene_of(&data).map_err(told)
    }
}

/// Returns the path with names of elements replaced by their indices.
fn resolved(data: &Tree, field: &FieldPath) -> Result<FieldPath, SceneError> {
    let (mut place, mut now) = (FieldPath::top(), Some(data));
    for (index, step) in field.steps().iter().enumerate() {
        let is_last = index + 1 == field.steps().len();
        let missing = |what: String| SceneError::new(field.clone(), what);
        match (now, step) {
            (Some(table @ Tree::Table(fields)), Step::Field(name)) => {
                now = table.get(name);
                if now.is_none() && !is_last {
                    let tables = index == 0;
                    let keys = fields.iter().map(|(key, _)| key.as_str());
                    let known = keys.chain(TABLES.into_iter().filter(|_| tables));
                    let question = did_you_mean(name, known, '`');
                    return Err(missing(format!("there is no `{name}` in the scene{question}")));
                }
                place = place.field(name);
            }
            (Some(Tree::Array(elements)), step) => {
                let found = element(elements, step).ok_or_else(|| missing(absent(elements, step)))?;
                now = elements.get(found);
                place = place.element(found);
            }
            _ => return Err(missing(format!("`{place}` has no parts"))),
        }
    }
    let is_number = |value: &Tree| {
        value.number().is_some() || value.text().is_some_and(|text| expression_in(text).is_some())
    };
    match now.is_none_or(is_number) && !field.is_top() {
        true => Ok(place),
        false => Err(SceneError::new(place, "is no number and cannot be varied")),
    }
}

/// Returns the index of the element with an index or a name.
fn element(elements: &[Tree], step: &Step) -> Option<usize> {
    match step {
        Step::Element(index) => (*index < elements.len()).then_some(*index),
        Step::Field(name) => {
            let has_name = |element: &Tree| element.get("name").and_then(Tree::text) == Some(name);
            elements.iter().position(has_name)
        }
    }
}

fn absent(elements: &[Tree], step: &Step) -> String {
    match step {
        Step::Element(index) => format!("there is no element {index}: there are {}", elements.len()),
        Step::Field(name) => {
            let names: Vec<_> = elements.iter().filter_map(|element| element.get("name")?.text()).collect();
            match names.is_empty() {
                true => format!(
                    "there is no `{name}`: none of the {} has a name, use [0], [1], ...",
                    elements.len()
                ),
                false => {
                    let question = did_you_mean(name, names.iter().copied(), '`');
                    format!("there is no `{name}`{question}: there are {}", names.join(", "))
                }
            }
        }
    }
}

/// Puts a number at a path; returns `None` if the data have no such path.
fn put(data: &mut Tree, steps: &[Step], number: f64) -> Option<()> {
    let Some((step, rest)) = steps.split_first() else {
        *data = Tree::of_number(number);
        return Some(());
    };
    let part = match (data, step) {
        (Tree::Table(fields), Step::Field(name)) => {
            let place = fields.iter().position(|(key, _)| key == name).unwrap_or_else(|| {
                fields.push((name.clone(), Tree::Null));
                fields.len() - 1
            });
            &mut fields.get_mut(place)?.1
        }
        (Tree::Array(elements), Step::Element(index)) => elements.get_mut(*index)?,
        _ => return None,
    };
    put(part, rest, number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFormat;

    const TEXT: &str = r#"
        format = "halfgap-scene-1"
        title = "two discs"
        run = { duration = 1 }

        [[body]]
        name = "left disc"
        shape = { disc = { radius = 0.5 } }
        mass = 1

        [[body]]
        name = "ball"
        shape = { disc = { radius = 0.5 } }
        mass = 1
        position = [3, 0.5]

        [[force]]
        gravity = { acceleration = [0, -9.81] }
    "#;

    fn varied(field: &str) -> Result<VariedScene, SceneError> {
        let field = field.parse().expect("a path");
        VariedScene::new(SceneSource::new(TEXT, SceneFormat::Toml), &field)
    }

    #[test]
    fn a_field_is_found_by_name_and_by_place() {
        let scene = varied("body.ball.position[1]").expect("it is there");
        assert_eq!(scene.field().to_string(), "body[1].position[1]");
        let changed = scene.with(0.1).expect("a good place");
        assert_eq!(changed.bodies[1].position.map(|place| place.y), Some(0.1));
        let unchanged = scene.with(0.5).expect("the same scene");
        assert_eq!(unchanged, SceneSource::new(TEXT, SceneFormat::Toml).parse().expect("a good scene"));
        let by_place = varied(r#"body[0].shape.disc.radius"#).and_then(|scene| scene.with(0.25));
        assert!(by_place.is_ok_and(|scene| scene.bodies[0].shape != changed.bodies[0].shape));
    }

    #[test]
    fn a_field_that_is_left_out_is_varied_too() {
        let scene = varied("body.\"left disc\".elasticity").and_then(|scene| scene.with(0.25));
        assert_eq!(scene.expect("elasticity is a field").bodies[0].elasticity, 0.25);
        let seeded = varied("run.seed").and_then(|scene| scene.with(7.0));
        assert_eq!(seeded.expect("seed is a whole number").run.seed, Some(7));
    }

    #[test]
    fn fields_that_cannot_be_varied_are_named() {
        let message = |field: &str| {
            varied(field).and_then(|scene| scene.with(-1.0)).expect_err("a bad field").to_string()
        };
        for (field, why) in [
            (
                "body.bal.mass",
                "line 6: body.bal.mass: there is no `bal` (did you mean `ball`?): there are left disc, ball",
            ),
            (
                "force.gravity.acceleration[1]",
                "there is no `gravity`: none of the 1 has a name, use [0], [1], ...",
            ),
            ("body[2].mass", "body[2].mass: there is no element 2: there are 2"),
            ("run.speed.x", "line 4: run.speed.x: there is no `speed` in the scene"),
            ("run.duration.x", "`run.duration` has no parts"),
            ("title", "line 3: title: is no number and cannot be varied"),
            ("body.ball.bounce", "body[1].bounce: unknown field `bounce`"),
        ] {
            assert!(message(field).contains(why), "{}", message(field));
        }
        let mass = message("body.ball.mass");
        assert_eq!(mass, "line 14: body[1].mass: must be positive, got -1 kg (varied to -1)");
    }
}

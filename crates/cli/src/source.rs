//! The scene of a command: a file or standard input, with other values for what its `[let]` names.

use clap::ValueEnum;
use halfgap::scene::{SceneError, SceneFormat, SceneSource};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The name that stands for standard input.
const STANDARD_INPUT: &str = "-";

/// Which scene is read, and how.
#[derive(Debug, clap::Args)]
pub(crate) struct SceneArgs {
    /// The scene, a .toml or .json file, or - for standard input.
    pub(crate) scene: PathBuf,
    /// Give a name in the scene's `[let]` another value, a number or an expression; may be given several times.
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<Setting>,
    /// Format of standard input; guessed if not given.
    #[arg(long)]
    pub(crate) format: Option<TextFormat>,
}

/// A format of scenes.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TextFormat {
    Toml,
    Json,
}

/// A name with its other value.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    name: String,
    value: String,
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) =
            text.split_once('=').ok_or("must be NAME=VALUE, such as r=0.4 or pitch=2*pi/12")?;
        // Names may be written as fields are elsewhere.
        let name = name.trim();
        let name = name.strip_prefix("let.").unwrap_or(name);
        Ok(Self { name: name.to_owned(), value: value.to_owned() })
    }
}

/// Reads the text of a scene from a file or from standard input.
pub(crate) fn read(path: &Path, format: Option<TextFormat>) -> Result<SceneSource, SceneError> {
    if path != Path::new(STANDARD_INPUT) {
        return SceneSource::read(path);
    }
    let format = format.map(|format| match format {
        TextFormat::Toml => SceneFormat::Toml,
        TextFormat::Json => SceneFormat::Json,
    });
    SceneSource::read_from(std::io::stdin().lock(), format)
}

impl SceneArgs {
    /// Reads the text of the scene.
    pub(crate) fn source(&self) -> Result<SceneSource, SceneError> {
        let source = read(&self.scene, self.format)?;
        let set = |source: SceneSource, Setting { name, value }: &Setting| source.with_let(name, value);
        Ok(self.set.iter().fold(source, set))
    }
}

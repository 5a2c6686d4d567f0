//! The CSV file of a sweep, which grows while it runs: nothing that was computed is lost if the sweep is.

use crate::failure::Failure;
use halfgap::csv_field;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Quantities of each body in the table: SI units and radians, `w` for the angular velocity.
pub(crate) const QUANTITIES: [&str; 6] = ["x", "y", "angle", "vx", "vy", "w"];

/// A file of rows in the order of their indices, whatever the order in which they are added.
#[derive(Debug)]
pub(crate) struct Rows {
    path: PathBuf,
    file: File,
    /// Index of the row to be written next.
    next: usize,
    /// Rows that wait for those before them.
    waiting: BTreeMap<usize, String>,
    /// The first failure to write, after which nothing more is written.
    failure: Option<io::Error>,
}

impl Rows {
    /// Makes the file with its heads, for a varied field and the movable bodies of a scene.
    pub(crate) fn create(path: &Path, field: &str, bodies: &[String]) -> Result<Self, Failure> {
        let mut heads = format!("{},status,time,energy_start,energy_end,impacts,steps", csv_field(field));
        for name in bodies {
            for quantity in QUANTITIES {
                heads.push(',');
                heads.push_str(&csv_field(&format!("{name}.{quantity}")));
            }
        }
        heads.push('\n');
        let made = File::create(path).and_then(|mut file| file.write_all(heads.as_bytes()).map(|()| file));
        let file = made.map_err(|error| Failure::Write(path.to_path_buf(), error))?;
        Ok(Self { path: path.to_path_buf(), file, next: 0, waiting: BTreeMap::new(), failure: None })
    }

    /// Adds a row, and writes it as soon as all rows before it are written.
    pub(crate) fn add(&mut self, index: usize, row: String) {
        self.waiting.insert(index, row);
        while let Some(row) = self.waiting.remove(&self.next) {
            self.next += 1;
            self.write(&row);
        }
    }

    /// Writes the rows that still wait for others: these were never added.
    pub(crate) fn finish(mut self) -> Result<(), Failure> {
        for row in std::mem::take(&mut self.waiting).into_values() {
            self.write(&row);
        }
        self.failure.map_or(Ok(()), |error| Err(Failure::Write(self.path, error)))
    }

    /// Writes a row in one piece.
    fn write(&mut self, row: &str) {
        if self.failure.is_none() {
            self.failure = self.file.write_all(row.as_bytes()).err();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_written_in_order_as_soon_as_those_before_them_are() {
        let path = std::env::temp_dir().join(format!("halfgap-rows-{}.csv", std::process::id()));
        let mut rows = Rows::create(&path, "run.tolerance", &["a, b".to_owned()]).expect("a file");
        let text = || std::fs::read_to_string(&path).expect("the file");
        let heads = text();
        assert!(
            heads.starts_with("run.tolerance,status,") && heads.ends_with(",\"a, b.vy\",\"a, b.w\"\n"),
            "{heads}"
        );
        let after = |rows: &str| format!("{heads}{rows}");
        rows.add(1, "one\n".to_owned());
        assert_eq!(text(), heads);
        rows.add(0, "zero\n".to_owned());
        assert_eq!(text(), after("zero\none\n"));
        rows.add(4, "four\n".to_owned());
        rows.add(3, "three\n".to_owned());
        assert_eq!(text(), after("zero\none\n"));
        rows.finish().expect("it can be written");
        assert_eq!(text(), after("zero\none\nthree\nfour\n"));
        std::fs::remove_file(&path).expect("it is there");
    }
}

//! What other programs wrote is read as they meant it.

mod calculix;
mod exports;
mod fe_model;
mod harwell_boeing;
mod matrix_market;
mod mesh;
mod modes;
mod oracles;
mod reduced;
mod toml_files;
mod trajectory;
mod uff;

use ferrom::format::FormatError;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder of its own for one test, removed at its end.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new() -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("ferrom-formats-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).expect("temporary folder");
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("temporary folder");
        fs::write(&path, bytes).expect("temporary file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that stays behind in the system's temporary directory does no harm.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The error names the line (0: none) and says all of these.
pub fn assert_says<T: std::fmt::Debug>(result: Result<T, FormatError>, line: usize, words: &[&str]) {
    let error = result.expect_err("an error");
    let text = error.to_string();
    assert_eq!(error.line().unwrap_or(0), line, "{text}");
    assert!(text.starts_with(&error.path().display().to_string()), "{text}");
    for word in words {
        assert!(text.contains(word), "no `{word}` in: {text}");
    }
}

/// A file of the repository's reference leaf.
pub fn leaf(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models/leaf-spring").join(name)
}

/// A file of tests/data, or else of the collection beside the repository; says so where there is none.
#[allow(clippy::print_stdout)] // a test that checks nothing must say so
pub fn shared(name: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let own = root.join("tests/data").join(name);
    if own.is_file() {
        return Some(own);
    }
    let path = root.join("../shared").join(name);
    if !path.exists() {
        println!("{name}: skipped, not here");
    }
    path.exists().then_some(path)
}

#[test]
fn every_row_of_the_table_is_named_once_and_says_what_it_is() {
    let mut names: Vec<&str> = ferrom::format::FORMATS.iter().map(|f| f.name).collect();
    assert!(ferrom::format::FORMATS.iter().all(|f| (f.reads || f.writes) && !f.help.is_empty()));
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn formats_are_told_by_content_not_by_name() {
    let folder = Folder::new();
    let cases = [
        ("a.txt", "%%matrixmarket matrix coordinate real symmetric\n1 1 1\n1 1 2.0\n", Some("matrix-market")),
        ("b.mtx", "1 1 2.0\n1 2 0.0\n2 2 1.0D+00\n", Some("triplets")),
        ("c.csv", "12.1\n12.2\n", Some("calculix-dofs")),
        ("d.sti", "** comment\n*NODE\n1, 0, 0, 0\n", Some("inp")),
        ("e.inp", "time [s],z [m]\n0.0,1.0\n", Some("csv")),
        ("f.h5", "hello\n", None),
    ];
    for (name, text, expected) in cases {
        let path = folder.write(name, text);
        let found = ferrom::format::detect(&path).expect("readable").map(|f| f.name);
        assert_eq!(found, expected, "{name}");
    }
    for (name, expected) in [("leaf.sti.gz", "triplets"), ("leaf.dof.gz", "calculix-dofs"), ("leaf_mesh.inp", "inp")] {
        assert_eq!(ferrom::format::detect(&leaf(name)).expect("readable").map(|f| f.name), Some(expected));
    }
}

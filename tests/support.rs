//! What several tests need: the project's folders, the leaf's modes, scenes run with changes.

use ferrom::model::{InterfaceNode, Modes, NodeId, Progress, Role, Silent, Trajectory};
use ferrom::pipeline::{Analysed, Loaded, analyse, load_scene};
use ferrom::simulate::{Scene, simulate};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A path inside the repository.
pub fn at_root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The leaf with 56 modes (as many as the reference files have), damping of its recipe.
pub fn leaf() -> &'static Analysed {
    static LEAF: OnceLock<Analysed> = OnceLock::new();
    LEAF.get_or_init(|| {
        analyse(&at_root("models/leaf-spring/model.toml"), Some(56), silent()).expect("the leaf's modes")
    })
}

/// Nobody listens to progress.
pub fn silent() -> &'static dyn Progress {
    &Silent
}

/// The surface nodes of the reference files: c = 12, d = 2852, a = 897, b = 1977.
pub fn surface_nodes() -> Vec<InterfaceNode> {
    [("a", 897), ("b", 1977), ("c", 12), ("d", 2852)]
        .map(|(name, label)| {
            InterfaceNode::single(&leaf().fe, name, Role::Joint, NodeId(label)).expect("a node of the mesh")
        })
        .to_vec()
}

/// The leaf's modes with one damping ratio for all.
pub fn damped(zeta: f64) -> Modes {
    let mut modes = leaf().modes.clone();
    modes.zeta.fill(zeta);
    modes
}

/// A scene of the leaf project, changed, run.
pub fn run_leaf(scene: &str, change: impl FnOnce(&mut Scene)) -> Trajectory {
    let mut loaded = load_scene(&at_root(&format!("models/leaf-spring/{scene}.toml"))).expect("a scene");
    change(&mut loaded.scene);
    run(&loaded)
}

/// Runs a loaded scene.
pub fn run(loaded: &Loaded) -> Trajectory {
    let system = loaded.assemble().expect("an assembled scene");
    simulate(&system, silent()).expect("a run")
}

/// Sets the step, s.
pub fn set_step(scene: &mut Scene, step: f64) {
    scene.run.step = Some(toml::Spanned::new(0..0, step.into()));
}

/// Sets the end, s.
pub fn set_until(scene: &mut Scene, until: f64) {
    scene.run.until = Some(toml::Spanned::new(0..0, until.into()));
}

/// Rows of numbers of a CSV file with a header line; empty and non-numeric cells are NaN.
pub fn csv(path: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(at_root(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    let mut lines = text.lines();
    let header = lines.next().unwrap_or("").split(',').map(str::to_string).collect();
    let rows = lines.map(|l| l.split(',').map(|c| c.trim().parse().unwrap_or(f64::NAN)).collect()).collect();
    (header, rows)
}

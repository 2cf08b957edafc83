//! The recipe: model.toml as it is written.

use crate::format::{FeFiles, FileUnits};
use crate::quantity::{AngularFrequency, Dimension, Kind, Length, Mass, Quantity, Ratio, Time, factor};
use crate::rank::Rule;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// models/NAME/model.toml.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Recipe {
    /// Name of the model and of its reduced file.
    pub name: String,
    /// What it is, in words.
    #[serde(default)]
    pub about: String,
    /// Units of the files.
    #[serde(default)]
    pub units: Units,
    /// Files.
    pub source: SourceFiles,
    /// Joints by name.
    #[serde(default)]
    pub joint: BTreeMap<Spanned<String>, NodeSpec>,
    /// Measured points by name.
    #[serde(default)]
    pub measured: BTreeMap<Spanned<String>, NodeSpec>,
    /// Modal analysis.
    #[serde(default)]
    pub modal: ModalSettings,
    /// Damping; there is no default.
    pub damping: Spanned<Damping>,
    /// Ranking.
    pub rank: RankSettings,
    /// Selection rule.
    pub select: Rule,
    /// Reduction.
    #[serde(default)]
    pub reduce: ReduceSettings,
    /// Published or measured frequencies to compare with.
    #[serde(default)]
    pub reference: Vec<ReferenceFrequencies>,
}

impl Recipe {
    /// SI factors of the units of the files; the place and the reason when a symbol is none.
    pub fn file_units(&self) -> Result<FileUnits, (Range<usize>, String)> {
        let in_si = |unit: &Spanned<String>, dimension: Dimension| {
            factor(unit.get_ref(), dimension).map_err(|message| (unit.span(), message))
        };
        Ok(FileUnits {
            length: in_si(&self.units.length, Length::DIMENSION)?,
            mass: in_si(&self.units.mass, Mass::DIMENSION)?,
            time: in_si(&self.units.time, Time::DIMENSION)?,
        })
    }

    /// The FE files, found from the folder of the recipe.
    pub fn fe_files(&self, folder: &Path) -> Result<FeFiles, (Range<usize>, String)> {
        let source = &self.source;
        Ok(FeFiles {
            name: self.name.clone(),
            stiffness: folder.join(&source.stiffness),
            mass: folder.join(&source.mass),
            dofs: source.dofs.as_ref().map(|p| folder.join(p)),
            mesh: source.mesh.as_ref().map(|p| folder.join(p)),
            units: self.file_units()?,
        })
    }
}

/// `[units]`: symbols of the units the files are written in.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Units {
    /// "m", "mm", "in".
    pub length: Spanned<String>,
    /// "kg", "t".
    pub mass: Spanned<String>,
    /// "s".
    pub time: Spanned<String>,
}

impl Default for Units {
    fn default() -> Self {
        let unit = |symbol: &str| Spanned::new(0..0, symbol.to_string());
        Self { length: unit("m"), mass: unit("kg"), time: unit("s") }
    }
}

/// `[source]`: paths relative to the recipe.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SourceFiles {
    /// K.
    pub stiffness: PathBuf,
    /// M.
    pub mass: PathBuf,
    /// Row ↔ node and direction.
    pub dofs: Option<PathBuf>,
    /// Node positions and sets.
    pub mesh: Option<PathBuf>,
}

/// `[joint.NAME]` or `[measured.NAME]`: one of the two keys.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeSpec {
    /// An FE node.
    pub node: Option<Spanned<u32>>,
    /// A node set, averaged.
    pub set: Option<Spanned<String>>,
}

/// `[modal]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModalSettings {
    /// Modes to compute, rigid ones included.
    pub count: Spanned<usize>,
    /// σ, (rad/s)², negative; found automatically when absent.
    pub shift: Option<f64>,
}

impl Default for ModalSettings {
    fn default() -> Self {
        Self { count: Spanned::new(0..0, 50), shift: None }
    }
}

/// `[damping]`: one of the keys.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// The same ratio for every elastic mode.
    pub ratio: Option<Quantity<Ratio>>,
    /// C = αM + βK.
    pub rayleigh: Option<Rayleigh>,
    /// Ratios of single modes, [[7, 0.012], …]; `ratio` holds for the others.
    pub modes: Option<Vec<(u32, Quantity<Ratio>)>>,
    /// A named preset.
    pub preset: Option<String>,
}

/// ζ = (α/ω + βω)/2.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// α, 1/s.
    pub alpha: f64,
    /// β, s.
    pub beta: f64,
}

/// `[rank]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RankSettings {
    /// Name of the criterion.
    #[serde(default = "default_criterion")]
    pub criterion: Spanned<String>,
    /// "d:z".
    pub input: Spanned<String>,
    /// "d:z".
    pub output: Spanned<String>,
    /// More pairs [input, output]: a mode is as important as its best pair.
    #[serde(default)]
    pub also: Vec<[Spanned<String>; 2]>,
    /// More outputs to draw beside the ranked path in the receptance plot, for the same input.
    #[serde(default)]
    pub draw: Vec<Spanned<String>>,
}

fn default_criterion() -> Spanned<String> {
    Spanned::new(0..0, "peak-gain".into())
}

/// `[reduce]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct ReduceSettings {
    /// Name of the method.
    pub method: Spanned<String>,
    /// Reduced file, relative to the recipe.
    pub output: Option<PathBuf>,
    /// Also writes A, B, C, D for forces and motions at all joints.
    pub state_space: bool,
}

impl Default for ReduceSettings {
    fn default() -> Self {
        Self { method: Spanned::new(0..0, "truncation-residual".into()), output: None, state_space: false }
    }
}

/// `[[reference]]`: frequencies to compare the modes with.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceFrequencies {
    /// Where they come from.
    pub name: String,
    /// [mode, frequency] pairs; a bare number is rad/s.
    pub omega: Vec<(u32, Quantity<AngularFrequency>)>,
}

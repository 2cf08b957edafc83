//! The pipeline itself: read, analyse, rank, select, reduce, write.

use super::recipe::{Damping, NodeSpec, Recipe};
use super::{PipelineError, output_file, summary_file};
use crate::format::{
    nearest, parse_toml, read_fe_model, read_summary, reduced_to_bytes, summary_to_text, toml_error_at,
    write_atomically,
};
use crate::modal::{DAMPING_PRESETS, DampingModel, ModalOptions, SolveReport, set_damping, solve_with_report};
use crate::model::{
    Axis, FeModel, InterfaceNode, ModeNo, Modes, NodeId, Progress, Ranking, ReducedModel, Role, Selection, StateSpace,
};
use crate::rank::{CRITERIA, Path as TransferPath, PathEnd, Rule, criterion, rank, select};
use crate::reduce::{METHODS, Made, method, reduce};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;
use toml::Spanned;

/// Seconds a stage took.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// "read", "modal analysis", …
    pub stage: &'static str,
    /// Wall time, s.
    pub wall_s: f64,
}

/// A model with its modes.
#[derive(Clone, Debug)]
pub struct Analysed {
    /// Path of the recipe.
    pub file: PathBuf,
    /// The recipe.
    pub recipe: Recipe,
    /// Its text.
    pub text: String,
    /// The FE model.
    pub fe: FeModel,
    /// Its modes, damping set.
    pub modes: Modes,
    /// Joints and measured nodes.
    pub nodes: Vec<InterfaceNode>,
    /// Time and memory of the eigen-solution by stage.
    pub solve_report: SolveReport,
    /// Seconds per stage.
    pub timings: Vec<Timing>,
}

/// A model ranked, selected, reduced.
#[derive(Clone, Debug)]
pub struct Built {
    /// The model with its modes.
    pub analysed: Analysed,
    /// Paths the ranking used.
    pub paths: Vec<TransferPath>,
    /// Paths to draw: those of the ranking and the recipe's `draw`.
    pub drawn: Vec<TransferPath>,
    /// Scores.
    pub ranking: Ranking,
    /// Kept modes.
    pub selection: Selection,
    /// The result.
    pub reduced: ReducedModel,
    /// Where it belongs.
    pub output: PathBuf,
}

/// "ferrom 0.1.0".
pub fn tool() -> String {
    format!("ferrom {}", env!("CARGO_PKG_VERSION"))
}

impl Analysed {
    /// An error at a place of the recipe.
    fn at(&self, span: Range<usize>, message: impl Into<String>) -> PipelineError {
        recipe_error(&self.file, &self.text, span, message)
    }
}

fn recipe_error(file: &Path, text: &str, span: Range<usize>, message: impl Into<String>) -> PipelineError {
    if span.is_empty() {
        return PipelineError::Request(format!("{}: {}", file.display(), message.into()));
    }
    toml_error_at(file, text, span, message).into()
}

/// Reads the recipe and its files, computes modes (`count` overrides the recipe's), sets damping.
pub fn analyse(file: &Path, count: Option<usize>, progress: &dyn Progress) -> Result<Analysed, PipelineError> {
    let (recipe, text): (Recipe, String) = parse_toml(file)?;
    let fail = |span: Range<usize>, message: String| recipe_error(file, &text, span, message);
    let folder = file.parent().unwrap_or(Path::new("."));
    let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if recipe.name.is_empty() || !recipe.name.chars().all(plain) {
        return Err(PipelineError::Request(format!(
            "{}: name \"{}\" also names files; use letters, digits, - and _",
            file.display(),
            recipe.name
        )));
    }
    let damping = damping_model(&recipe.damping).map_err(|m| fail(recipe.damping.span(), m))?;
    let asked = count.unwrap_or(*recipe.modal.count.get_ref());
    if asked == 0 {
        return Err(fail(recipe.modal.count.span(), "count is 0, expected at least one mode".into()));
    }
    let mut timings = Vec::new();
    let clock = Instant::now();
    let files = recipe.fe_files(folder).map_err(|(span, message)| fail(span, message))?;
    let mut fe = read_fe_model(&files, progress)?;
    // Provenance names files as the recipe does, so that it does not depend on where the project lies.
    for source in &mut fe.sources {
        if let Ok(relative) = Path::new(&source.path).strip_prefix(folder) {
            source.path = relative.display().to_string();
        }
    }
    let nodes = interface_nodes(&recipe, &fe).map_err(|(span, message)| fail(span, message))?;
    timings.push(Timing { stage: "read", wall_s: clock.elapsed().as_secs_f64() });
    let clock = Instant::now();
    let options = ModalOptions { count: asked, shift: recipe.modal.shift };
    let (mut modes, solve_report) = solve_with_report(&fe, &options, progress)?;
    set_damping(&mut modes, damping);
    for (number, zeta) in recipe.damping.get_ref().modes.iter().flatten() {
        match modes.zeta.get_mut((*number as usize).wrapping_sub(1)) {
            Some(slot) => *slot = zeta.si,
            None => {
                let message = format!("damping names mode {number}, but {} modes were computed", modes.omega.len());
                return Err(fail(recipe.damping.span(), message));
            }
        }
    }
    timings.push(Timing { stage: "modal analysis", wall_s: clock.elapsed().as_secs_f64() });
    Ok(Analysed { file: file.to_path_buf(), recipe, text, fe, modes, nodes, solve_report, timings })
}

fn damping_model(spec: &Spanned<Damping>) -> Result<DampingModel, String> {
    let damping = spec.get_ref();
    let in_range = |z: f64| {
        if z >= 0.0 { Ok(z) } else { Err(format!("damping ratio {z} is negative")) }
    };
    for (_, zeta) in damping.modes.iter().flatten() {
        in_range(zeta.si)?;
    }
    match (damping.ratio, damping.rayleigh, &damping.preset) {
        (Some(ratio), None, None) => Ok(DampingModel::Ratio(in_range(ratio.si)?)),
        (None, Some(r), None) if r.alpha >= 0.0 && r.beta >= 0.0 => {
            Ok(DampingModel::Rayleigh { alpha: r.alpha, beta: r.beta })
        }
        (None, None, Some(name)) => DAMPING_PRESETS
            .iter()
            .find(|p| p.0 == name)
            .map(|p| p.1)
            .ok_or_else(|| {
                let known = DAMPING_PRESETS.iter().map(|p| p.0).collect::<Vec<_>>().join(", ");
                format!("unknown damping preset \"{name}\"; the presets are {known}")
            }),
        _ => Err("expected exactly one of ratio = 0.03, rayleigh = { alpha, beta } (zero or above), preset = \"adams\"; ratios of single modes may stand beside ratio as modes = [[7, 0.012], …]".into()),
    }
}

type Located = (Range<usize>, String);

fn interface_nodes(recipe: &Recipe, fe: &FeModel) -> Result<Vec<InterfaceNode>, Located> {
    let mut all: Vec<InterfaceNode> = Vec::new();
    for (role, specs) in [(Role::Joint, &recipe.joint), (Role::Measured, &recipe.measured)] {
        for (key, spec) in specs {
            let name = key.get_ref();
            if all.iter().any(|n| n.name == *name) {
                return Err((key.span(), format!("\"{name}\" names both a joint and a measured node")));
            }
            if name.is_empty() || name.contains([':', ' ', ',']) {
                return Err((
                    key.span(),
                    format!("the name \"{name}\" cannot be used as in \"{name}:z\"; use letters, digits and -"),
                ));
            }
            all.push(interface_node(name, key.span(), role, spec, fe)?);
        }
    }
    Ok(all)
}

fn interface_node(
    name: &str,
    key: Range<usize>,
    role: Role,
    spec: &NodeSpec,
    fe: &FeModel,
) -> Result<InterfaceNode, Located> {
    match (&spec.node, &spec.set) {
        (Some(node), None) => InterfaceNode::single(fe, name, role, NodeId(*node.get_ref()))
            .map_err(|e| (node.span(), format!("{} \"{name}\": {e}", role.name()))),
        (None, Some(set)) => {
            let wanted = set.get_ref();
            let found = fe.node_sets.iter().find(|s| s.0.eq_ignore_ascii_case(wanted)).ok_or_else(|| {
                let close = nearest(wanted, fe.node_sets.keys().map(String::as_str));
                let hint = close.map_or_else(
                    || "the mesh has no node sets".to_string(),
                    |c| format!("did you mean \"{c}\"? The mesh has {} sets", fe.node_sets.len()),
                );
                (set.span(), format!("{} \"{name}\": the mesh has no node set \"{wanted}\"; {hint}", role.name()))
            })?;
            InterfaceNode::average(fe, name, role, found.1)
                .map_err(|e| (set.span(), format!("{} \"{name}\": {e}", role.name())))
        }
        _ => Err((key, format!("\"{name}\" needs exactly one of node = LABEL or set = \"NAME\""))),
    }
}

/// A transfer-path end "d:z" (interface node or FE label, and direction) with its modal row.
pub fn path_of(analysed: &Analysed, text: &str) -> Result<PathEnd, String> {
    let (name, axis) = text.rsplit_once(':').and_then(|(n, a)| Some((n, Axis::parse(a)?))).ok_or_else(|| {
        format!("found \"{text}\", expected NODE:DIRECTION such as \"d:z\", directions x y z rx ry rz")
    })?;
    let modes = &analysed.modes;
    let row = match (analysed.nodes.iter().find(|n| n.name == name), name.parse::<u32>()) {
        (Some(node), _) => node
            .modal_row(axis, modes)
            .ok_or_else(|| format!("node \"{name}\" has no direction {axis}: it averages no area (one solid node turns nowhere); use a node set"))?,
        (None, Ok(label)) => {
            let row = analysed.fe.dofs.row(NodeId(label), axis).ok_or_else(|| format!("the matrices have no dof {label}.{axis}"))?;
            modes.shapes.row(row).iter().copied().collect()
        }
        (None, Err(_)) => {
            let known = analysed.nodes.iter().map(|n| n.name.as_str()).collect::<Vec<_>>().join(", ");
            return Err(format!("there is no node \"{name}\"; joints and measured nodes are {known}"));
        }
    };
    Ok(PathEnd { name: text.to_string(), axis, row })
}

/// The whole pipeline up to the reduced model; nothing is written.
pub fn build(mut analysed: Analysed, rule: Option<&Rule>, progress: &dyn Progress) -> Result<Built, PipelineError> {
    let clock = Instant::now();
    let settings = analysed.recipe.rank.clone();
    let end = |text: &Spanned<String>| path_of(&analysed, text.get_ref()).map_err(|m| analysed.at(text.span(), m));
    let mut paths = vec![TransferPath { input: end(&settings.input)?, output: end(&settings.output)? }];
    for [input, output] in &settings.also {
        paths.push(TransferPath { input: end(input)?, output: end(output)? });
    }
    let mut drawn = paths.clone();
    for output in &settings.draw {
        drawn.push(TransferPath { input: end(&settings.input)?, output: end(output)? });
    }
    let criterion = criterion(settings.criterion.get_ref()).ok_or_else(|| {
        let known = CRITERIA.iter().map(|c| c.name).collect::<Vec<_>>().join(", ");
        analysed.at(
            settings.criterion.span(),
            format!("unknown criterion \"{}\"; the criteria are {known}", settings.criterion.get_ref()),
        )
    })?;
    let ranking = rank(&analysed.modes, criterion, &paths);
    if let Some(score) = ranking.scores.iter().find(|s| !s.score.is_finite()) {
        let message = format!(
            "{} of mode {} is not finite: its damping ratio is {}; rank undamped modes by \"static-gain\", or state damping",
            ranking.criterion,
            score.mode,
            analysed.modes.zeta[score.mode.column()]
        );
        return Err(analysed.at(settings.criterion.span(), message));
    }
    let selection = select(&analysed.modes, &ranking, rule.unwrap_or(&analysed.recipe.select))?;
    analysed.timings.push(Timing { stage: "rank and select", wall_s: clock.elapsed().as_secs_f64() });
    let clock = Instant::now();
    let name = &analysed.recipe.reduce.method;
    let method = method(name.get_ref()).ok_or_else(|| {
        let known = METHODS.iter().map(|m| m.name).collect::<Vec<_>>().join(", ");
        analysed.at(name.span(), format!("unknown method \"{}\"; the methods are {known}", name.get_ref()))
    })?;
    progress.report("reduce", 0, 0);
    let reduced = reduce(
        method,
        &Made {
            fe: Some(&analysed.fe),
            modes: &analysed.modes,
            ranking: &ranking,
            selection: &selection,
            nodes: &analysed.nodes,
            name: &analysed.recipe.name,
            recipe: &analysed.text,
            tool: &tool(),
        },
    )?;
    analysed.timings.push(Timing { stage: "reduce", wall_s: clock.elapsed().as_secs_f64() });
    let output = output_file(&analysed.file, &analysed.recipe);
    Ok(Built { analysed, paths, drawn, ranking, selection, reduced, output })
}

/// Writes the reduced model and its summary; returns the size of the model in bytes.
pub fn write(model: &ReducedModel, output: &Path, state_space: bool) -> Result<u64, PipelineError> {
    let all: Vec<usize> = (0..model.dofs.len()).collect();
    let joints: Vec<usize> =
        all.iter().copied().filter(|&r| model.nodes[model.dofs[r].node].role == Role::Joint).collect();
    let system = state_space.then(|| StateSpace::new(model, &joints, &all));
    if output.extension().is_none_or(|e| e != "h5") {
        return Err(PipelineError::Request(format!("{}: a reduced model is written as .h5", output.display())));
    }
    let summary = summary_file(output);
    if summary.exists() && read_summary(&summary).is_err() {
        return Err(PipelineError::Request(format!(
            "{}: this file is no summary of a reduced model and would be overwritten by one; choose another name than {}",
            summary.display(),
            output.display()
        )));
    }
    let bytes = reduced_to_bytes(model, system.as_ref())?;
    write_atomically(output, &bytes)?;
    write_atomically(&summary, summary_to_text(model).as_bytes())?;
    Ok(bytes.len() as u64)
}

impl Built {
    /// The kept modes' numbers.
    pub fn kept(&self) -> &[ModeNo] {
        &self.selection.modes
    }
}

//! `ferrom inspect`: what an export holds and what looks suspicious.

use super::matrices::Matrices;
use super::output::Outcome;
use crate::format::{Holds, detect, read_dof_map, read_fe_model, read_mesh, read_reduced, read_symmetric};
use crate::modal::survey;
use crate::model::{FeModel, Progress};
use crate::pipeline::{PipelineError, Recipe, model_file};
use crate::report::number::significant;
use crate::report::{Cell, Column, Table};
use clap::Args;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  ferrom inspect models/leaf-spring\n  ferrom inspect K.mtx\n  ferrom inspect --stiffness leaf.sti.gz --mass leaf.mas.gz --dofs leaf.dof.gz --mesh leaf_mesh.inp"
)]
pub(super) struct Arguments {
    /// Files, or one model folder
    #[arg(required_unless_present = "stiffness")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    matrices: Matrices,
}

pub(super) fn run(arguments: &Arguments, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    if let Some(files) = arguments.matrices.files() {
        return Ok(model(&read_fe_model(&files, progress)?, &files.stiffness));
    }
    if let [one] = arguments.files.as_slice() {
        if one.is_dir() || one.file_name().is_some_and(|n| n == "model.toml") {
            return project(&model_file(one)?, progress);
        }
        let (json, table) = file(one)?;
        return Ok(Outcome::new(Value::Object(json), table.text()));
    }
    let mut all = Vec::new();
    let mut text = String::new();
    for path in &arguments.files {
        let (json, table) = file(path)?;
        all.push(Value::Object(json));
        text += &format!("{}\n", table.text());
    }
    Ok(Outcome::new(json!({ "files": all }), text))
}

fn project(path: &Path, progress: &dyn Progress) -> Result<Outcome, PipelineError> {
    let (recipe, _): (Recipe, String) = crate::format::parse_toml(path)?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let files = recipe.fe_files(folder).map_err(|(_, m)| PipelineError::Request(format!("{}: {m}", path.display())))?;
    let fe = read_fe_model(&files, progress)?;
    Ok(model(&fe, &files.stiffness))
}

fn rows(title: &str, pairs: Vec<(&str, String)>) -> Table {
    let mut table = Table::new(title, vec![Column::text(""), Column::text("")]);
    table.rows = pairs.into_iter().map(|(name, value)| vec![Cell(name.into()), Cell(value)]).collect();
    table
}

/// K and M together.
fn model(fe: &FeModel, stiffness: &Path) -> Outcome {
    let facts = survey(fe);
    let format = detect(stiffness).ok().flatten().map_or("unknown", |f| f.name);
    let mut pairs = vec![
        ("format", format.to_string()),
        ("nodes", fe.nodes.len().to_string()),
        ("dofs", fe.dofs.len().to_string()),
        ("entries of K, of M", format!("{}, {}", fe.stiffness.nonzeros(), fe.mass.nonzeros())),
    ];
    let mut object = json!({
        "format": format,
        "nodes": fe.nodes.len(),
        "dofs": fe.dofs.len(),
        "nonzeros": fe.stiffness.nonzeros(),
        "nonzeros_mass": fe.mass.nonzeros(),
        "symmetric": true,
        "empty_rows": facts.empty_rows.len(),
        "massless_rows": facts.massless_rows,
        "negative_diagonal": facts.negative_diagonal.len(),
        "node_sets": fe.node_sets.iter().map(|(name, set)| json!({ "name": name, "nodes": set.len() })).collect::<Vec<_>>(),
        "suspicions": facts.suspicions,
        "sources": fe.sources,
    });
    if let (Some(body), Some(map)) = (facts.rigid, object.as_object_mut()) {
        let i = body.inertia;
        let inertia = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
        map.insert("mass_kg".into(), json!(body.mass));
        map.insert("mass_by_axis_kg".into(), json!(facts.mass_by_axis));
        map.insert("centre_m".into(), json!(body.centre));
        map.insert("inertia_kg_m2".into(), json!(inertia));
        map.insert("rigid_body_residual".into(), json!(facts.rigid_residual));
        // Components that are rounding beside the largest read as 0.
        let list = |v: &[f64], digits| {
            let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let plain = |x: f64| if x.abs() < 1e-12 * largest { 0.0 } else { x };
            v.iter().map(|x| significant(plain(*x), digits)).collect::<Vec<_>>().join(", ")
        };
        pairs.push(("mass", format!("{} kg", significant(body.mass, 7))));
        pairs.push(("centre of mass", format!("{} m", list(&body.centre, 5))));
        pairs.push(("inertia xx yy zz xy xz yz", format!("{} kg m²", list(&inertia, 5))));
        if let Some(residual) = facts.rigid_residual {
            pairs.push(("‖K r‖ of rigid motions x y z rx ry rz", list(&residual, 2)));
        }
    }
    let sets: Vec<String> = fe.node_sets.iter().map(|(n, s)| format!("{n} ({})", s.len())).collect();
    if !sets.is_empty() {
        pairs.push(("node sets", sets.join(", ")));
    }
    let mut table = rows(&fe.name, pairs);
    table.notes = facts.suspicions.iter().map(|s| format!("Suspicious: {s}.")).collect();
    if facts.suspicions.is_empty() {
        table.notes.push("Nothing suspicious.".into());
    }
    Outcome::new(object, table.text())
}

/// One file by itself.
fn file(path: &Path) -> Result<(Map<String, Value>, Table), PipelineError> {
    let Some(format) = detect(path)? else {
        let known = crate::format::FORMATS.iter().map(|f| f.name).collect::<Vec<_>>().join(", ");
        return Err(PipelineError::Request(format!(
            "{}: not one of the known formats ({known}); see `ferrom list formats`",
            path.display()
        )));
    };
    let mut map = Map::new();
    map.insert("file".into(), json!(path.display().to_string()));
    map.insert("format".into(), json!(format.name));
    map.insert("holds".into(), json!(format.holds.name()));
    let mut pairs = vec![("format", format!("{} ({})", format.name, format.holds.name()))];
    match format.holds {
        Holds::Matrix => {
            let (matrix, source) = read_symmetric(path, "matrix")?;
            let diagonal = matrix.diagonal();
            let negative = diagonal.iter().filter(|d| **d < 0.0).count();
            let zero = diagonal.iter().filter(|d| **d == 0.0).count();
            map.insert("dofs".into(), json!(matrix.order()));
            map.insert("nonzeros".into(), json!(matrix.nonzeros()));
            map.insert("symmetric".into(), json!(true));
            map.insert("trace".into(), json!(matrix.trace()));
            map.insert("negative_diagonal".into(), json!(negative));
            map.insert("zero_diagonal".into(), json!(zero));
            map.insert("sha256".into(), json!(source.sha256));
            pairs.push(("rows", matrix.order().to_string()));
            pairs.push(("entries", matrix.nonzeros().to_string()));
            pairs.push(("trace", significant(matrix.trace(), 8)));
            pairs.push(("zero, negative diagonals", format!("{zero}, {negative}")));
        }
        Holds::Dofs => {
            let (dofs, _) = read_dof_map(path)?;
            map.insert("dofs".into(), json!(dofs.len()));
            pairs.push(("dofs", dofs.len().to_string()));
        }
        Holds::Mesh => {
            let (mesh, _) = read_mesh(path)?;
            let sets: Map<String, Value> =
                mesh.node_sets.iter().map(|(name, nodes)| (name.clone(), json!(nodes.len()))).collect();
            map.insert("nodes".into(), json!(mesh.nodes.len()));
            pairs.push(("nodes", mesh.nodes.len().to_string()));
            let shown: Vec<String> = mesh.node_sets.iter().map(|(n, s)| format!("{n} ({})", s.len())).collect();
            pairs.push(("node sets", shown.join(", ")));
            map.insert("node_sets".into(), Value::Object(sets));
        }
        Holds::ReducedModel => {
            let model = read_reduced(path)?;
            map.insert("name".into(), json!(model.name));
            map.insert("dofs".into(), json!(model.full_dofs));
            map.insert("kept_dofs".into(), json!(model.dofs.len()));
            map.insert("selected".into(), json!(model.selection.modes));
            map.insert("mass_kg".into(), json!(model.rigid.body.mass));
            pairs.push(("model", format!("{}, made by {}", model.name, model.tool)));
            pairs.push(("modes", model.selection.ranges()));
            pairs.push(("kept dofs", format!("{} of {}", model.dofs.len(), model.full_dofs)));
            pairs.push(("mass", format!("{} kg", significant(model.rigid.body.mass, 7))));
        }
        _ => {}
    }
    Ok((map, rows(&path.display().to_string(), pairs)))
}

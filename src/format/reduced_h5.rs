//! The reduced model as HDF5 (reduced/NAME.h5), readable with h5py and MATLAB.
//!
//! Matrices are stored row by row: `/shapes` is (kept dofs, modes). No time stamps: the same model
//! gives the same bytes, and reading gives the same bits.

use super::error::{Fault, FormatError};
use super::h5::{Reader, Tree, refused};
use super::summary::label_ranges;
use crate::model::{
    Axis, KeptDof, KeptMode, KeptNode, ModeNo, NodeId, Origin, Ranking, ReducedModel, Residual, RigidBody, RigidPart,
    Role, Score, Selection, Source, StateSpace,
};
use hdf5_pure::{AttrValue, FileBuilder};
use nalgebra::Matrix3;
use std::path::Path;

/// Attribute `format` of the root.
const KIND: &str = "ferrom reduced model 1";

/// The file's bytes, with the state-space form when one is given.
pub fn reduced_to_bytes(model: &ReducedModel, state_space: Option<&StateSpace>) -> Result<Vec<u8>, FormatError> {
    build(model, state_space).map_err(|fault| fault.in_file(Path::new(&format!("{}.h5", model.name))))
}

fn build(model: &ReducedModel, state_space: Option<&StateSpace>) -> Result<Vec<u8>, Fault> {
    let mut file = FileBuilder::new();
    file.set_attr("format", AttrValue::String(KIND.into()));
    file.set_attr("name", AttrValue::String(model.name.clone()));

    let mut modes = Tree::new(&mut file, "modes");
    let column = |f: fn(&KeptMode) -> f64| model.modes.iter().map(f).collect::<Vec<f64>>();
    modes.integers("number", &model.modes.iter().map(|m| m.number.0).collect::<Vec<_>>());
    modes.reals("omega", &column(|m| m.omega), &[model.modes.len()], "rad/s");
    modes.reals("zeta", &column(|m| m.zeta), &[model.modes.len()], "1");
    modes.texts("origin", &model.modes.iter().map(|m| m.origin.name()).collect::<Vec<_>>());
    modes.matrix("participation", &model.participation, "sqrt(kg)");
    file.add_group(modes.finish()?);
    file.create_dataset("shapes")
        .with_f64_data(&super::h5::row_major(&model.shapes))
        .with_shape(&[model.shapes.nrows() as u64, model.shapes.ncols() as u64])
        .set_attr("unit", AttrValue::String("1/sqrt(kg); rotations rad/(m*sqrt(kg))".into()));

    let node_of = |dof: &KeptDof| {
        model
            .nodes
            .get(dof.node)
            .ok_or_else(|| refused(format!("a kept dof names node {} of {}", dof.node, model.nodes.len())))
    };
    let owners = model.dofs.iter().map(node_of).collect::<Result<Vec<_>, _>>()?;
    let mut dofs = Tree::new(&mut file, "dofs");
    dofs.texts("node", &owners.iter().map(|n| n.name.as_str()).collect::<Vec<_>>());
    dofs.integers("node_index", &model.dofs.iter().map(|d| d.node as u32).collect::<Vec<_>>());
    dofs.texts("axis", &model.dofs.iter().map(|d| d.axis.name()).collect::<Vec<_>>());
    dofs.texts("unit", &model.dofs.iter().map(|d| d.axis.unit()).collect::<Vec<_>>());
    dofs.texts("frame", &vec!["model"; model.dofs.len()]);
    dofs.texts("labels", &owners.iter().map(|n| label_ranges(&n.labels)).collect::<Vec<_>>());
    file.add_group(dofs.finish()?);

    let mut nodes = Tree::new(&mut file, "nodes");
    nodes.texts("name", &model.nodes.iter().map(|n| n.name.as_str()).collect::<Vec<_>>());
    nodes.texts("role", &model.nodes.iter().map(|n| n.role.name()).collect::<Vec<_>>());
    let positions: Vec<f64> = model.nodes.iter().flat_map(|n| n.position).collect();
    nodes.reals("position", &positions, &[model.nodes.len(), 3], "m");
    nodes.integers("labels", &model.nodes.iter().flat_map(|n| n.labels.iter().map(|l| l.0)).collect::<Vec<_>>());
    let mut start = vec![0u32];
    for node in &model.nodes {
        start.push(start[start.len() - 1] + node.labels.len() as u32);
    }
    nodes.integers("label_start", &start);
    nodes.note("about", "labels[label_start[k]..label_start[k+1]] are averaged into node k");
    file.add_group(nodes.finish()?);

    let mut rigid = Tree::new(&mut file, "rigid");
    rigid.reals("mass", &[model.rigid.body.mass], &[1], "kg");
    rigid.reals("centre", &model.rigid.body.centre, &[3], "m");
    rigid.reals("inertia", model.rigid.body.inertia.transpose().as_slice(), &[3, 3], "kg*m2");
    rigid.matrix("shapes", &model.rigid.shapes, "1/sqrt(kg)");
    rigid.matrix("participation", &model.rigid.participation, "sqrt(kg)");
    file.add_group(rigid.finish()?);

    if let Some(residual) = &model.residual {
        file.create_dataset("residual_flexibility")
            .with_f64_data(&super::h5::row_major(&residual.flexibility))
            .with_shape(&[residual.flexibility.nrows() as u64, residual.flexibility.ncols() as u64])
            .set_attr("unit", AttrValue::String("m/N; rotations rad/(N*m)".into()));
        let mut vectors = Tree::new(&mut file, "residual_vectors");
        vectors.reals("omega", &residual.omega, &[residual.omega.len()], "rad/s");
        vectors.reals("zeta", &residual.zeta, &[residual.zeta.len()], "1");
        vectors.matrix("shapes", &residual.shapes, "1/sqrt(kg)");
        vectors.matrix("participation", &residual.participation, "sqrt(kg)");
        file.add_group(vectors.finish()?);
    }

    let ranking = &model.ranking;
    let mut selection = Tree::new(&mut file, "selection");
    selection.integers("modes", &model.selection.modes.iter().map(|m| m.0).collect::<Vec<_>>());
    selection.texts("reason", &[&model.selection.reason]);
    selection.texts("warnings", &model.selection.warnings);
    selection.texts("criterion", &[&ranking.criterion]);
    selection.texts("input", &[&ranking.input]);
    selection.texts("output", &[&ranking.output]);
    selection.integers("scored_modes", &ranking.scores.iter().map(|s| s.mode.0).collect::<Vec<_>>());
    let scores: Vec<f64> = ranking.scores.iter().map(|s| s.score).collect();
    selection.reals("scores", &scores, &[scores.len()], &ranking.unit);
    selection.texts("unit", &[&ranking.unit]);
    let relative: Vec<f64> = ranking.scores.iter().map(|s| s.relative).collect();
    selection.reals("relative", &relative, &[relative.len()], "1");
    file.add_group(selection.finish()?);

    let mut provenance = Tree::new(&mut file, "provenance");
    let full = u32::try_from(model.full_dofs).map_err(refused)?;
    provenance.integers("full_dofs", &[full]);
    provenance.texts("role", &model.sources.iter().map(|s| s.role.as_str()).collect::<Vec<_>>());
    provenance.texts("path", &model.sources.iter().map(|s| s.path.as_str()).collect::<Vec<_>>());
    provenance.texts("sha256", &model.sources.iter().map(|s| s.sha256.as_str()).collect::<Vec<_>>());
    provenance.texts("recipe", &[&model.recipe]);
    provenance.texts("tool", &[&model.tool]);
    file.add_group(provenance.finish()?);

    let mut units = Tree::new(&mut file, "units");
    for (what, unit) in [("length", "m"), ("mass", "kg"), ("time", "s"), ("angle", "rad"), ("force", "N")] {
        units.note(what, unit);
    }
    file.add_group(units.finish()?);

    if let Some(s) = state_space {
        let mut space = Tree::new(&mut file, "state_space");
        for (name, matrix) in [("A", &s.a), ("B", &s.b), ("C", &s.c), ("D", &s.d)] {
            space.matrix(name, matrix, "");
        }
        space.texts("inputs", &s.inputs);
        space.texts("outputs", &s.outputs);
        space.note("about", "x' = A x + B u, y = C x + D u; x = modal displacements, then modal velocities");
        file.add_group(space.finish()?);
    }
    file.finish().map_err(refused)
}

/// Reads a reduced model: the inverse of [`reduced_to_bytes`], to the last bit.
pub fn read_reduced(path: &Path) -> Result<ReducedModel, FormatError> {
    let (bytes, _) = super::input::read_all(path)?;
    parse(bytes).map_err(|fault| fault.in_file(path))
}

/// What to do about damaged content.
const REMAKE: &str = "the file is damaged: remake it with `ferrom reduce`";

fn parse(bytes: Vec<u8>) -> Result<ReducedModel, Fault> {
    let file = Reader::open(bytes)?;
    let kind = file.root_note("format")?;
    if kind != KIND {
        return Err(Fault::new(format!("the file says it is `{kind}`"))
            .expected(format!("`{KIND}`"))
            .cure("remake it with this version's `ferrom reduce`"));
    }
    let numbers = file.integers("modes/number", None)?;
    let r = numbers.len();
    let omega = file.reals("modes/omega", &[r])?;
    let zeta = file.reals("modes/zeta", &[r])?;
    let origin = file.texts("modes/origin", Some(r))?;
    if let Some(w) = omega.iter().find(|w| !(w.is_finite() && **w > 0.0)) {
        return Err(Fault::new(format!("modes/omega holds {w}")).expected("frequencies above zero").cure(REMAKE));
    }
    if let Some(z) = zeta.iter().find(|z| !(z.is_finite() && **z >= 0.0)) {
        return Err(Fault::new(format!("modes/zeta holds {z}"))
            .expected("damping ratios of zero or above")
            .cure(REMAKE));
    }
    let mut modes = Vec::with_capacity(r);
    for k in 0..r {
        let all = [Origin::Rigid, Origin::Computed, Origin::Imported, Origin::Measured];
        let origin = one_of("modes/origin", &origin[k], all, Origin::name)?;
        modes.push(KeptMode { number: mode(numbers[k])?, omega: omega[k], zeta: zeta[k], origin });
    }

    let names = file.texts("nodes/name", None)?;
    let roles = file.texts("nodes/role", Some(names.len()))?;
    let positions = file.reals("nodes/position", &[names.len(), 3])?;
    let labels = file.integers("nodes/labels", None)?;
    let start = file.integers("nodes/label_start", Some(names.len() + 1))?;
    let mut nodes = Vec::with_capacity(names.len());
    for (k, name) in names.into_iter().enumerate() {
        let own = labels.get(start[k] as usize..start[k + 1] as usize).ok_or_else(|| {
            Fault::new(format!("/nodes/label_start runs from {} to {}", start[k], start[k + 1]))
                .expected(format!("ascending numbers up to {}", labels.len()))
        })?;
        nodes.push(KeptNode {
            name,
            role: one_of("nodes/role", &roles[k], [Role::Joint, Role::Measured], Role::name)?,
            position: [positions[3 * k], positions[3 * k + 1], positions[3 * k + 2]],
            labels: own.iter().map(|&l| NodeId(l)).collect(),
        });
    }

    let owners = file.integers("dofs/node_index", None)?;
    let k = owners.len();
    let axes = file.texts("dofs/axis", Some(k))?;
    let mut dofs = Vec::with_capacity(k);
    for (owner, axis) in owners.into_iter().zip(&axes) {
        if owner as usize >= nodes.len() {
            return Err(
                Fault::new(format!("/dofs/node_index holds {owner}")).expected(format!("less than {}", nodes.len()))
            );
        }
        dofs.push(KeptDof { node: owner as usize, axis: one_of("dofs/axis", axis, Axis::ALL, Axis::name)? });
    }

    let rigid_modes = file.columns("rigid/shapes", k)?;
    let centre = file.reals("rigid/centre", &[3])?;
    let body = RigidBody {
        mass: file.reals("rigid/mass", &[1])?[0],
        centre: [centre[0], centre[1], centre[2]],
        inertia: Matrix3::from_row_slice(&file.reals("rigid/inertia", &[3, 3])?),
    };
    let rigid = RigidPart {
        body,
        shapes: file.matrix("rigid/shapes", k, rigid_modes)?,
        participation: file.matrix("rigid/participation", rigid_modes, 3)?,
    };
    let residual = if file.has("residual_flexibility") {
        let vectors = file.columns("residual_vectors/shapes", k)?;
        Some(Residual {
            flexibility: file.matrix("residual_flexibility", k, k)?,
            omega: file.reals("residual_vectors/omega", &[vectors])?,
            zeta: file.reals("residual_vectors/zeta", &[vectors])?,
            shapes: file.matrix("residual_vectors/shapes", k, vectors)?,
            participation: file.matrix("residual_vectors/participation", vectors, 3)?,
        })
    } else {
        None
    };

    let scored = file.integers("selection/scored_modes", None)?;
    let score = file.reals("selection/scores", &[scored.len()])?;
    let relative = file.reals("selection/relative", &[scored.len()])?;
    let mut scores = Vec::with_capacity(scored.len());
    for (i, number) in scored.into_iter().enumerate() {
        scores.push(Score { mode: mode(number)?, score: score[i], relative: relative[i] });
    }
    let paths = file.texts("provenance/path", None)?;
    let source_roles = file.texts("provenance/role", Some(paths.len()))?;
    let hashes = file.texts("provenance/sha256", Some(paths.len()))?;
    let sources = paths.into_iter().zip(source_roles).zip(hashes);
    let kept = file.integers("selection/modes", None)?;
    let mass = file.reals("rigid/mass", &[1])?[0];
    if !(mass.is_finite() && mass > 0.0) {
        return Err(Fault::new(format!("rigid/mass holds {mass}")).expected("a mass above zero").cure(REMAKE));
    }
    if file.matrix("shapes", k, r)?.iter().any(|v| !v.is_finite()) {
        return Err(Fault::new("shapes holds a value that is no number").expected("finite numbers").cure(REMAKE));
    }
    Ok(ReducedModel {
        name: file.root_note("name")?,
        shapes: file.matrix("shapes", k, r)?,
        participation: file.matrix("modes/participation", r, 3)?,
        modes,
        dofs,
        nodes,
        rigid,
        residual,
        ranking: Ranking {
            criterion: file.text("selection/criterion")?,
            input: file.text("selection/input")?,
            output: file.text("selection/output")?,
            unit: file.text("selection/unit")?,
            scores,
        },
        selection: Selection {
            modes: kept.into_iter().map(mode).collect::<Result<_, _>>()?,
            reason: file.text("selection/reason")?,
            warnings: file.texts("selection/warnings", None)?,
        },
        full_dofs: file.integers("provenance/full_dofs", Some(1))?[0] as usize,
        sources: sources.map(|((path, role), sha256)| Source { role, path, sha256 }).collect(),
        recipe: file.text("provenance/recipe")?,
        tool: file.text("provenance/tool")?,
    })
}

fn mode(number: u32) -> Result<ModeNo, Fault> {
    if number == 0 {
        return Err(Fault::new("a mode has the number 0").expected("numbers from 1"));
    }
    Ok(ModeNo(number))
}

fn one_of<T: Copy, const N: usize>(
    path: &str,
    found: &str,
    known: [T; N],
    name: fn(T) -> &'static str,
) -> Result<T, Fault> {
    known.into_iter().find(|&k| name(k) == found).ok_or_else(|| {
        let names: Vec<&str> = known.into_iter().map(name).collect();
        Fault::new(format!("/{path} holds `{found}`")).expected(names.join(", "))
    })
}

//! Scene and reduced models to a system: bodies, joints eliminated by a null space, forces.

use super::assembly::Assembly;
use super::bodies::bodies;
use super::body::{Body, Make};
use super::channels::channels;
use super::constraints::{constraints, jointed_modes};
use super::effect::{damping_rates, weight};
use super::error::{SceneError, names};
use super::forces::{applied, load_cases, tires};
use super::scene::{Analysis, Scene};
use super::system::{Deflection, System};
use crate::linalg::split;
use crate::model::ReducedModel;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Constraint rows (unit length) closer to the span of the others than this are redundant. Averaged
/// joints of a laminate repeat a constraint to about 1e-9; a real constraint of an elastic body is
/// of the order of its shapes relative to the rigid ones, above 1e-4.
const REDUNDANT: f64 = 1e-7;

/// Builds the system of a scene. `models` holds the reduced model of each body that names one, by
/// body name.
pub fn assemble(scene: &Scene, models: &BTreeMap<String, ReducedModel>) -> Result<System, SceneError> {
    check_effects(scene)?;
    let (step, until) = run_times(scene)?;
    let bodies = bodies(scene, models)?;
    let total = bodies.iter().map(Body::count).sum();
    let mut assembly = Assembly { scene, bodies, basis: DMatrix::identity(total, total) };
    let mut warnings = Vec::new();
    let constraints = constraints(&assembly)?;
    let joints = split(&constraints, REDUNDANT);
    let held = constraints.row_iter().filter(|r| r.norm() > 0.0).count();
    if held > joints.range.ncols() {
        warnings.push(format!(
            "{} of {held} held directions repeat others and were left out (redundant joints)",
            held - joints.range.ncols()
        ));
    }
    if joints.null.ncols() == 0 {
        return Err(SceneError::missing("the joints hold every motion; nothing is left to simulate"));
    }
    let omega = DVector::from_iterator(total, assembly.bodies.iter().flat_map(|b| b.omega.iter().copied()));
    let (basis, stiffness) = jointed_modes(&joints.null, &omega);
    assembly.basis = basis;
    let n = stiffness.len();

    let rates: Vec<f64> = if scene.has("structural-damping") {
        assembly.bodies.iter().flat_map(|b| damping_rates(&b.omega, &b.zeta)).collect()
    } else {
        vec![0.0; total]
    };
    let damped = DMatrix::from_fn(total, n, |r, c| assembly.basis[(r, c)] * rates[r]);
    let damping = assembly.basis.transpose() * damped;
    let gravity = match (scene.has("gravity"), &scene.effect.gravity) {
        (false, _) => DVector::zeros(n),
        (true, None) => {
            return Err(SceneError::missing(
                "effect \"gravity\" is on without parameters; add [effect.gravity] with acceleration = \"9.81 m/s^2\"",
            ));
        }
        (true, Some(table)) => weight(&(assembly.basis.transpose() * assembly.participation(2)), table.acceleration.si),
    };
    let tires = tires(&assembly)?;
    let applied = applied(&assembly)?;
    let cases = if scene.run.analysis == Analysis::Static { load_cases(&applied)? } else { 0 };
    let start_velocity = start_velocity(&assembly)?;
    let channels = channels(&assembly, &tires)?;
    Ok(System {
        name: scene.name.clone(),
        analysis: scene.run.analysis,
        effects: super::effect::EFFECTS.iter().filter(|e| scene.has(e.name)).map(|e| e.name.to_string()).collect(),
        deflections: deflections(&assembly),
        stiffness,
        damping: (&damping + damping.transpose()) * 0.5,
        gravity,
        tires,
        applied,
        start_velocity,
        channels,
        step,
        until,
        cases,
        warnings,
    })
}

fn check_effects(scene: &Scene) -> Result<(), SceneError> {
    for (k, effect) in scene.effects.iter().enumerate() {
        let name = effect.get_ref();
        if scene.effects[..k].iter().any(|e| e.get_ref() == name) {
            return Err(SceneError::at(effect.span(), format!("effect \"{name}\" is listed twice")));
        }
        if !super::effect::EFFECTS.iter().any(|e| e.name == name) {
            let nearest = super::effect::EFFECTS
                .iter()
                .max_by(|a, b| strsim::jaro_winkler(a.name, name).total_cmp(&strsim::jaro_winkler(b.name, name)))
                .map_or("", |e| e.name);
            return Err(SceneError::at(
                effect.span(),
                format!(
                    "unknown effect \"{name}\"; did you mean \"{nearest}\"? The effects are {}",
                    names(super::effect::EFFECTS.iter().map(|e| e.name))
                ),
            ));
        }
    }
    if scene.has("residual-flexibility") && !scene.has("flexibility") {
        return Err(SceneError::missing(
            "effect \"residual-flexibility\" completes \"flexibility\" and cannot act without it; list both or neither",
        ));
    }
    if scene.has("tire-lateral") && !scene.has("tire-normal") {
        return Err(SceneError::missing(
            "effect \"tire-lateral\" needs \"tire-normal\": the side force is capped by the normal force",
        ));
    }
    Ok(())
}

fn run_times(scene: &Scene) -> Result<(f64, f64), SceneError> {
    if scene.run.analysis == Analysis::Static {
        return Ok((0.0, 0.0));
    }
    let (Some(step), Some(until)) = (&scene.run.step, &scene.run.until) else {
        return Err(SceneError::missing("[run] needs step and until, such as step = \"1 ms\" and until = \"1.5 s\""));
    };
    let (h, end) = (step.get_ref().si, until.get_ref().si);
    if h <= 0.0 {
        return Err(SceneError::at(step.span(), format!("step is {h} s, expected a time above zero")));
    }
    if end < h {
        return Err(SceneError::at(until.span(), format!("until is {end} s, expected at least one step of {h} s")));
    }
    if end / h > 1e10 {
        return Err(SceneError::at(step.span(), format!("{end} s in steps of {h} s is more than 1e10 steps")));
    }
    Ok((h, end))
}

/// The start speed downward of everything, as ẇ; refused where a joint does not allow it.
fn start_velocity(assembly: &Assembly) -> Result<DVector<f64>, SceneError> {
    let speed = assembly.scene.start.speed.map_or(0.0, |v| v.si);
    let falling = assembly.participation(2) * -speed;
    let velocity = assembly.basis.transpose() * &falling;
    let lost = (&falling - &assembly.basis * &velocity).norm();
    // Elastic shapes read from files of six digits carry 1e-6 of rigid motion; a held body loses all.
    if lost > 1e-4 * falling.norm() {
        return Err(SceneError::missing(format!(
            "a joint to the ground holds what the start speed of {speed} m/s moves; free z there or start at rest"
        )));
    }
    Ok(velocity)
}

fn deflections(assembly: &Assembly) -> Vec<Deflection> {
    let mut all = Vec::new();
    for body in &assembly.bodies {
        let Make::Flexible { model, shapes } = &body.make else { continue };
        let length = model
            .nodes
            .iter()
            .flat_map(|a| {
                model
                    .nodes
                    .iter()
                    .map(move |b| (0..3).map(|d| (a.position[d] - b.position[d]).powi(2)).sum::<f64>().sqrt())
            })
            .fold(0.0, f64::max);
        let mut rows = DMatrix::zeros(3 * model.nodes.len(), assembly.basis.ncols());
        for (k, dof) in model.dofs.iter().enumerate().filter(|d| !d.1.axis.is_rotation()) {
            let elastic = DVector::from_fn(body.count(), |c, _| if body.omega[c] > 0.0 { shapes[(k, c)] } else { 0.0 });
            let row = assembly.basis.rows(body.first, body.count()).transpose() * elastic;
            rows.set_row(3 * dof.node + dof.axis.index(), &row.transpose());
        }
        if length > 0.0 {
            all.push(Deflection { body: body.name.clone(), length, rows });
        }
    }
    all
}

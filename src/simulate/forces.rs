//! Force laws of a scene attached to the jointed coordinates: tyres, given forces.

use super::assembly::Assembly;
use super::bodies::{find, place};
use super::effect::{AppliedForce, TireLateral, TireNormal};
use super::error::SceneError;
use super::scene::{ForceValues, Scene};
use super::system::Tire;
use crate::model::Axis;
use nalgebra::DVector;

/// A gap below this is touching: positions of averaged nodes carry rounding of 1e-16 m.
const TOUCHING: f64 = 1e-9;

/// The tyres of the scene; none when the effect is off.
pub(super) fn tires(assembly: &Assembly) -> Result<Vec<Tire>, SceneError> {
    let scene = assembly.scene;
    if !scene.has("tire-normal") {
        return Ok(Vec::new());
    }
    let table = scene.effect.tire_normal.as_ref().ok_or_else(|| {
        SceneError::missing("effect \"tire-normal\" is on without parameters; add [effect.tire-normal] with at, radius, stiffness, damping")
    })?;
    let table = table.get_ref();
    let (stiffness, damping) = (table.stiffness.get_ref().si, table.damping.get_ref().si);
    for (key, value, span) in
        [("stiffness", stiffness, table.stiffness.span()), ("damping", damping, table.damping.span())]
    {
        if value < 0.0 {
            return Err(SceneError::at(span, format!("tire {key} is {value}, expected zero or above")));
        }
    }
    if table.radius.si <= 0.0 {
        return Err(SceneError::missing(format!("tire radius is {} m, expected above zero", table.radius.si)));
    }
    if let Some(height) = scene.start.height.filter(|h| h.si < 0.0) {
        return Err(SceneError::missing(format!(
            "start height is {} m: the tyres would begin pressed into the ground; expected zero or above",
            height.si
        )));
    }
    let lateral = lateral_law(scene)?;
    let mut tires = Vec::new();
    let mut heights = Vec::new();
    for at in &table.at {
        let here = |e: SceneError| place(e, at.span());
        let (body, node) = find(at.get_ref(), &assembly.bodies).map_err(here)?;
        let carrier = &assembly.bodies[body];
        let hub = carrier.position(node).map_err(here)?;
        let vertical = carrier.motion(node, hub, Axis::Z).map_err(here)?;
        // The contact point hangs one radius below the hub: it moves sideways by u_y + r θ_x.
        let sideways = carrier.motion(node, hub, Axis::Y).map_err(here)?
            + carrier.motion(node, hub, Axis::Rx).map_err(here)? * table.radius.si;
        heights.push(hub[2] - table.radius.si);
        tires.push(Tire {
            name: at.get_ref().clone(),
            normal_row: assembly.jointed(body, &vertical),
            lateral_row: assembly.jointed(body, &sideways),
            gap: 0.0,
            normal: TireNormal { stiffness, damping },
            lateral,
        });
    }
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let drop = scene.start.height.map_or(0.0, |h| h.si);
    for (tire, height) in tires.iter_mut().zip(heights) {
        let gap = height - lowest + drop;
        tire.gap = if gap.abs() < TOUCHING { 0.0 } else { gap };
    }
    Ok(tires)
}

fn lateral_law(scene: &Scene) -> Result<Option<TireLateral>, SceneError> {
    if !scene.has("tire-lateral") {
        return Ok(None);
    }
    let table = scene.effect.tire_lateral.as_ref().ok_or_else(|| {
        SceneError::missing("effect \"tire-lateral\" is on without parameters; add [effect.tire-lateral] with cornering-stiffness, friction, regularization-speed")
    })?;
    let table = table.get_ref();
    let law = TireLateral {
        cornering_stiffness: table.cornering_stiffness.get_ref().si,
        friction: table.friction.get_ref().si,
        base_speed: table.regularization_speed.get_ref().si + scene.start.forward_speed.map_or(0.0, |v| v.si.abs()),
    };
    if law.cornering_stiffness < 0.0 {
        return Err(SceneError::at(table.cornering_stiffness.span(), "cornering stiffness is negative"));
    }
    if law.friction < 0.0 {
        return Err(SceneError::at(table.friction.span(), "friction coefficient is negative"));
    }
    if table.regularization_speed.get_ref().si < 0.0 {
        return Err(SceneError::at(table.regularization_speed.span(), "regularization-speed is negative"));
    }
    if law.base_speed <= 0.0 {
        return Err(SceneError::at(
            table.regularization_speed.span(),
            "regularization-speed plus forward speed is zero: the slip angle would jump at rest; give a speed above zero",
        ));
    }
    Ok(Some(law))
}

/// The given forces of the scene; none when the effect is off.
pub(super) fn applied(assembly: &Assembly) -> Result<Vec<(AppliedForce, DVector<f64>)>, SceneError> {
    let scene = assembly.scene;
    if !scene.has("applied-force") {
        return Ok(Vec::new());
    }
    if scene.effect.applied_force.is_empty() {
        return Err(SceneError::missing(
            "effect \"applied-force\" is on without parameters; add [[effect.applied-force]]",
        ));
    }
    let mut all = Vec::new();
    for table in &scene.effect.applied_force {
        let (span, table) = (table.span(), table.get_ref());
        let (row, _) = assembly.motion_row(&table.at).map_err(|e| place(e, span.clone()))?;
        let law = match (&table.force, &table.half_sine, &table.table) {
            (Some(values), None, None) => AppliedForce::Constant(match values {
                ForceValues::One(f) => vec![f.si],
                ForceValues::Cases(all) => all.iter().map(|f| f.si).collect(),
            }),
            (Some(ForceValues::One(peak)), Some(duration), None) if duration.si > 0.0 => {
                AppliedForce::HalfSine { peak: peak.si, duration: duration.si }
            }
            (None, None, Some(points)) if points.windows(2).all(|w| w[0].0.si < w[1].0.si) && !points.is_empty() => {
                AppliedForce::Table(points.iter().map(|p| (p.0.si, p.1.si)).collect())
            }
            _ => {
                return Err(SceneError::at(
                    span,
                    "an applied force is one of: force = F (constant); force = F with half-sine = T above zero; table = [[t, F], …] with ascending times",
                ));
            }
        };
        all.push((law, row));
    }
    Ok(all)
}

/// Number of load cases of a static analysis.
pub(super) fn load_cases(applied: &[(AppliedForce, DVector<f64>)]) -> Result<usize, SceneError> {
    let mut cases = 1;
    for (law, _) in applied {
        match law {
            AppliedForce::Constant(values) if values.len() == 1 => {}
            AppliedForce::Constant(values) if cases == 1 || values.len() == cases => cases = values.len(),
            _ => {
                return Err(SceneError::missing(
                    "a static analysis takes constant forces, all with the same number of load cases (or one value)",
                ));
            }
        }
    }
    Ok(cases)
}

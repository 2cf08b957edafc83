//! Scene and reduced models to a system: bodies, joints eliminated by a null space, forces.

use super::body::{Body, Make};
use super::channels::channels;
use super::effect::{
    AppliedForce, TireLateral, TireNormal, add_residual_vectors, damping_rates, elastic_coordinates, weight,
};
use super::error::{SceneError, names};
use super::joint::held;
use super::scene::{Analysis, BodySpec, ForceValues, Formulation, Place, Scene};
use super::system::{Deflection, System, Tire};
use crate::linalg::split;
use crate::model::{Axis, ReducedModel, RigidBody};
use nalgebra::{DMatrix, DVector, Matrix3};
use std::collections::BTreeMap;
use std::ops::Range;

/// Constraint rows (unit length) closer to the span of the others than this are redundant. Averaged
/// joints of a laminate repeat a constraint to about 1e-9; a real constraint of an elastic body is
/// of the order of its shapes relative to the rigid ones, above 1e-4.
const REDUNDANT: f64 = 1e-7;

/// Directions whose elastic part is below this share are motions of the mechanism as a whole.
const NO_ELASTIC_PART: f64 = 1e-9;

/// A gap below this is touching: positions of averaged nodes carry rounding of 1e-16 m.
const TOUCHING: f64 = 1e-9;

/// Bodies, and how coordinates of the scene's vector map to those of the jointed system.
pub(super) struct Assembly<'a> {
    pub(super) scene: &'a Scene,
    pub(super) bodies: Vec<Body<'a>>,
    /// N×n: scene coordinates per jointed coordinate.
    pub(super) basis: DMatrix<f64>,
}

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
    for effect in &scene.effects {
        let name = effect.get_ref();
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

fn bodies<'a>(scene: &Scene, models: &'a BTreeMap<String, ReducedModel>) -> Result<Vec<Body<'a>>, SceneError> {
    let mut bodies: Vec<Body<'a>> = Vec::new();
    // Flexible bodies first: rigid ones may stand at their nodes.
    for flexible in [true, false] {
        for (key, spec) in scene.body.iter().filter(|b| b.1.model.is_some() == flexible) {
            let name = key.get_ref();
            let body = if flexible {
                flexible_body(scene, name, spec, models).map_err(|m| place(m, key.span()))?
            } else {
                rigid_body(name, key.span(), spec, &bodies)?
            };
            bodies.push(body);
        }
    }
    let mut first = 0;
    for body in &mut bodies {
        body.first = first;
        first += body.count();
    }
    Ok(bodies)
}

/// Gives an error without a place the place of the key it belongs to.
fn place(error: SceneError, span: Range<usize>) -> SceneError {
    match error {
        SceneError::Scene { span: None, message } => SceneError::at(span, message),
        other => other,
    }
}

fn flexible_body<'a>(
    scene: &Scene,
    name: &str,
    spec: &BodySpec,
    models: &'a BTreeMap<String, ReducedModel>,
) -> Result<Body<'a>, SceneError> {
    let model = models.get(name).ok_or_else(|| SceneError::missing(format!("body \"{name}\" has no reduced model")))?;
    if let Some(mass) = &spec.mass {
        return Err(SceneError::at(mass.span(), "a body with a model takes its mass from there; remove mass"));
    }
    let rigid = spec.rigid || scene.run.formulation == Formulation::Rigid || !scene.has("flexibility");
    let listed = scene.effect.flexibility.as_ref().and_then(|f| f.modes.as_ref());
    let modes = if rigid { None } else { listed.map(|m| m.get_ref().as_str()) };
    let mut coordinates = elastic_coordinates(model, modes)
        .map_err(|m| SceneError::Scene { span: listed.map(toml::Spanned::span), message: m })?;
    if rigid {
        coordinates.omega.clear();
        coordinates.zeta.clear();
        coordinates.shapes = DMatrix::zeros(model.dofs.len(), 0);
        coordinates.participation = DMatrix::zeros(0, 3);
    } else if scene.has("residual-flexibility") {
        add_residual_vectors(model, &mut coordinates).map_err(SceneError::missing)?;
    }
    Ok(Body::flexible(
        name,
        model,
        &coordinates.shapes,
        &coordinates.omega,
        &coordinates.zeta,
        &coordinates.participation,
    ))
}

fn rigid_body<'a>(
    name: &str,
    key: Range<usize>,
    spec: &BodySpec,
    flexible: &[Body<'a>],
) -> Result<Body<'a>, SceneError> {
    let mass = spec.mass.as_ref().ok_or_else(|| {
        SceneError::at(key.clone(), format!("body \"{name}\" has neither model nor mass; give one of them"))
    })?;
    if mass.get_ref().si <= 0.0 {
        return Err(SceneError::at(mass.span(), format!("mass of \"{name}\" is {} kg, expected above zero", mass.get_ref().si)));
    }
    let inertia = match &spec.inertia {
        None => [0.0; 3],
        Some(given) => {
            let values = given.get_ref().map(|q| q.si);
            if values.iter().any(|&v| v < 0.0) {
                return Err(SceneError::at(given.span(), format!("inertia of \"{name}\" is negative")));
            }
            values
        }
    };
    let centre = match (&spec.at, &spec.inertia) {
        (Some(at), _) => resolve(at.get_ref(), flexible).map_err(|e| place(e, at.span()))?,
        (None, None) => [0.0; 3],
        (None, Some(given)) => {
            return Err(SceneError::at(
                given.span(),
                format!("body \"{name}\" can rotate (it has inertia) and needs a place: at = \"leaf:c\" or at = [x, y, z]"),
            ));
        }
    };
    let inertia = Matrix3::from_diagonal(&nalgebra::Vector3::from(inertia));
    Ok(Body::rigid(name, RigidBody { mass: mass.get_ref().si, centre, inertia }))
}

fn resolve(at: &Place, bodies: &[Body]) -> Result<[f64; 3], SceneError> {
    match at {
        Place::Position(p) => Ok(p.map(|q| q.si)),
        Place::Node(text) => {
            let (body, node) = find(text, bodies)?;
            bodies[body].position(node)
        }
    }
}

/// "leaf:c" → (index of "leaf", "c"); "load" → (index, none).
pub(super) fn find<'t>(text: &'t str, bodies: &[Body]) -> Result<(usize, Option<&'t str>), SceneError> {
    let (body, node) = text.split_once(':').map_or((text, None), |(b, n)| (b, Some(n)));
    let index = bodies.iter().position(|b| b.name == body).ok_or_else(|| {
        SceneError::missing(format!(
            "there is no body \"{body}\"; the scene has {}",
            names(bodies.iter().map(|b| b.name.as_str()))
        ))
    })?;
    Ok((index, node))
}

impl Assembly<'_> {
    /// A row over one body's coordinates as a row over the jointed coordinates.
    pub(super) fn jointed(&self, body: usize, row: &DVector<f64>) -> DVector<f64> {
        let body = &self.bodies[body];
        self.basis.rows(body.first, body.count()).transpose() * row
    }

    /// Participation of all scene coordinates along an axis.
    fn participation(&self, axis: usize) -> DVector<f64> {
        DVector::from_iterator(
            self.basis.nrows(),
            self.bodies.iter().flat_map(|b| b.participation.column(axis).iter().copied().collect::<Vec<_>>()),
        )
    }

    /// Row over the jointed coordinates of "leaf:b:z" or "load:z", and its direction.
    pub(super) fn motion_row(&self, text: &str) -> Result<(DVector<f64>, Axis), SceneError> {
        let (place, axis) = text
            .rsplit_once(':')
            .and_then(|(p, a)| Some((p, Axis::parse(a)?)))
            .ok_or_else(|| SceneError::missing(format!("found \"{text}\", expected \"body:node:direction\" or \"body:direction\", such as \"leaf:b:z\"")))?;
        let (body, node) = find(place, &self.bodies)?;
        let point = self.bodies[body].position(node)?;
        let row = self.bodies[body].motion(node, point, axis)?;
        Ok((self.jointed(body, &row), axis))
    }
}

/// One row over the scene coordinates per held direction: motion of the first end less the second.
fn constraints(assembly: &Assembly) -> Result<DMatrix<f64>, SceneError> {
    let total = assembly.basis.nrows();
    let mut rows: Vec<DVector<f64>> = Vec::new();
    for (name, joint) in &assembly.scene.joint {
        let between = &joint.between;
        let at_ends = |e: SceneError| place(e, between.span());
        let ends: Vec<Option<(usize, Option<&str>)>> = between
            .get_ref()
            .iter()
            .map(|end| if end == "ground" { Ok(None) } else { find(end, &assembly.bodies).map(Some) })
            .collect::<Result<_, _>>()
            .map_err(at_ends)?;
        if ends[0].is_none() && ends[1].is_none() {
            return Err(SceneError::at(between.span(), format!("joint \"{}\" joins the ground to itself", name.get_ref())));
        }
        let point = match &joint.at {
            Some(at) => resolve(at.get_ref(), &assembly.bodies).map_err(|e| place(e, at.span()))?,
            None => {
                let named = ends.iter().flatten().find(|e| e.1.is_some()).or(ends.iter().flatten().next());
                match named {
                    Some(&(body, node)) => assembly.bodies[body].position(node).map_err(at_ends)?,
                    None => [0.0; 3],
                }
            }
        };
        for axis in held(joint.holds.get_ref()).map_err(|m| SceneError::at(joint.holds.span(), m))? {
            let mut row = DVector::zeros(total);
            for (end, sign) in ends.iter().zip([1.0, -1.0]) {
                if let Some((body, node)) = *end {
                    let motion = assembly.bodies[body].motion(node, point, axis).map_err(at_ends)?;
                    let first = assembly.bodies[body].first;
                    for (k, value) in motion.iter().enumerate() {
                        row[first + k] += sign * value;
                    }
                }
            }
            rows.push(row);
        }
    }
    Ok(DMatrix::from_fn(rows.len(), total, |r, c| rows[r][c]))
}

/// Basis (N×n) and λ (n) of the jointed coordinates: mechanism motions with λ exactly 0 first, then
/// the modes of the jointed system. λ are squared singular values of diag(ω) Z, so that low
/// frequencies keep their digits beside very high ones.
fn jointed_modes(null: &DMatrix<f64>, omega: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let elastic: Vec<usize> = (0..omega.len()).filter(|&k| omega[k] > 0.0).collect();
    let parts = split(&null.select_rows(&elastic), NO_ELASTIC_PART);
    let free = null * &parts.null;
    let moving = null * &parts.range;
    let count = moving.ncols();
    let mut stiffness = DVector::zeros(free.ncols() + count);
    let mut basis = DMatrix::zeros(null.nrows(), free.ncols() + count);
    basis.columns_mut(0, free.ncols()).copy_from(&free);
    if count > 0 {
        let weighted = DMatrix::from_fn(elastic.len(), count, |r, c| omega[elastic[r]] * moving[(elastic[r], c)]);
        let svd = weighted.svd(false, true);
        let vectors = svd.v_t.map(|v| v.transpose()).unwrap_or_else(|| DMatrix::identity(count, count));
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|&a, &b| svd.singular_values[a].total_cmp(&svd.singular_values[b]));
        for (c, &k) in order.iter().enumerate() {
            stiffness[free.ncols() + c] = svd.singular_values[k].powi(2);
            basis.set_column(free.ncols() + c, &(&moving * vectors.column(k)));
        }
    }
    (basis, stiffness)
}

fn tires(assembly: &Assembly) -> Result<Vec<Tire>, SceneError> {
    let scene = assembly.scene;
    if !scene.has("tire-normal") {
        return Ok(Vec::new());
    }
    let table = scene.effect.tire_normal.as_ref().ok_or_else(|| {
        SceneError::missing("effect \"tire-normal\" is on without parameters; add [effect.tire-normal] with at, radius, stiffness, damping")
    })?;
    let table = table.get_ref();
    let (stiffness, damping) = (table.stiffness.get_ref().si, table.damping.get_ref().si);
    for (key, value, span) in [("stiffness", stiffness, table.stiffness.span()), ("damping", damping, table.damping.span())] {
        if value < 0.0 {
            return Err(SceneError::at(span, format!("tire {key} is {value}, expected zero or above")));
        }
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
    if law.base_speed <= 0.0 {
        return Err(SceneError::at(
            table.regularization_speed.span(),
            "regularization-speed plus forward speed is zero: the slip angle would jump at rest; give a speed above zero",
        ));
    }
    Ok(Some(law))
}

fn applied(assembly: &Assembly) -> Result<Vec<(AppliedForce, DVector<f64>)>, SceneError> {
    let scene = assembly.scene;
    if !scene.has("applied-force") {
        return Ok(Vec::new());
    }
    if scene.effect.applied_force.is_empty() {
        return Err(SceneError::missing("effect \"applied-force\" is on without parameters; add [[effect.applied-force]]"));
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

fn load_cases(applied: &[(AppliedForce, DVector<f64>)]) -> Result<usize, SceneError> {
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
            .flat_map(|a| model.nodes.iter().map(move |b| {
                (0..3).map(|d| (a.position[d] - b.position[d]).powi(2)).sum::<f64>().sqrt()
            }))
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

//! The bodies of a scene: reduced models and rigid bodies, placed and numbered.

use super::body::Body;
use super::effect::{add_residual_vectors, elastic_coordinates};
use super::error::{SceneError, names};
use super::scene::{BodySpec, Formulation, Place, Scene};
use crate::model::{ReducedModel, RigidBody};
use nalgebra::{DMatrix, Matrix3};
use std::collections::BTreeMap;
use std::ops::Range;

/// All bodies, flexible ones first, with their place in the scene's coordinates.
pub(super) fn bodies<'a>(
    scene: &Scene,
    models: &'a BTreeMap<String, ReducedModel>,
) -> Result<Vec<Body<'a>>, SceneError> {
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
pub(super) fn place(error: SceneError, span: Range<usize>) -> SceneError {
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
        return Err(SceneError::at(
            mass.span(),
            format!("mass of \"{name}\" is {} kg, expected above zero", mass.get_ref().si),
        ));
    }
    let inertia = match &spec.inertia {
        None => [0.0; 3],
        Some(given) => {
            let values = given.get_ref().map(|q| q.si);
            if values.iter().any(|&v| v < 0.0) {
                return Err(SceneError::at(given.span(), format!("inertia of \"{name}\" is negative")));
            }
            if values == [0.0; 3] {
                return Err(SceneError::at(
                    given.span(),
                    format!(
                        "inertia of \"{name}\" is zero, which would hold it against rotation; give its inertia, or leave the key out for a body that does not rotate"
                    ),
                ));
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
                format!(
                    "body \"{name}\" can rotate (it has inertia) and needs a place: at = \"leaf:c\" or at = [x, y, z]"
                ),
            ));
        }
    };
    let inertia = Matrix3::from_diagonal(&nalgebra::Vector3::from(inertia));
    Ok(Body::rigid(name, RigidBody { mass: mass.get_ref().si, centre, inertia }))
}

/// The position of a place.
pub(super) fn resolve(at: &Place, bodies: &[Body]) -> Result<[f64; 3], SceneError> {
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

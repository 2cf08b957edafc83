//! The scene's measured channels as rows of the system.

use super::assembly::Assembly;
use super::error::{SceneError, names};
use super::scene::Shown;
use super::system::{ChannelSpec, Reading, Tire};

/// Resolves every `[[measure]]`; names must differ.
pub(super) fn channels(assembly: &Assembly, tires: &[Tire]) -> Result<Vec<ChannelSpec>, SceneError> {
    let mut all: Vec<ChannelSpec> = Vec::new();
    for measure in &assembly.scene.measure {
        let name = measure.name.get_ref();
        if all.iter().any(|c| c.name == *name) {
            return Err(SceneError::at(measure.name.span(), format!("two channels are called \"{name}\"")));
        }
        let spec = if measure.show == Shown::Force {
            if let Some(other) = &measure.minus {
                return Err(SceneError::at(other.span(), "minus goes with motions, not with forces; remove it"));
            }
            let reading = force_reading(measure.of.get_ref(), tires, assembly)
                .map_err(|m| SceneError::at(measure.of.span(), m))?;
            ChannelSpec { name: name.clone(), unit: "N".into(), reading, shown: measure.show, datum: measure.datum }
        } else {
            let row_of = |text: &toml::Spanned<String>| {
                assembly.motion_row(text.get_ref()).map_err(|e| SceneError::at(text.span(), e.to_string()))
            };
            let (mut row, axis) = row_of(&measure.of)?;
            if let Some(other) = &measure.minus {
                let (second, second_axis) = row_of(other)?;
                if axis.is_rotation() != second_axis.is_rotation() {
                    return Err(SceneError::at(other.span(), "a rotation cannot be subtracted from a translation"));
                }
                row -= second;
            }
            let per_time = match measure.show {
                Shown::Velocity => "/s",
                Shown::Acceleration => "/s2",
                Shown::Displacement | Shown::Force => "",
            };
            ChannelSpec {
                name: name.clone(),
                unit: format!("{}{per_time}", axis.unit()),
                reading: Reading::Motion(row),
                shown: measure.show,
                datum: measure.datum,
            }
        };
        all.push(spec);
    }
    for reference in &assembly.scene.reference {
        let channel = &reference.channel;
        if !all.iter().any(|c| c.name == *channel.get_ref()) {
            return Err(SceneError::at(
                channel.span(),
                format!(
                    "there is no channel \"{}\"; the scene measures {}",
                    channel.get_ref(),
                    names(all.iter().map(|c| c.name.as_str()))
                ),
            ));
        }
    }
    Ok(all)
}

fn force_reading(of: &str, tires: &[Tire], assembly: &Assembly) -> Result<Reading, String> {
    let (effect, place) = of.split_once(':').unwrap_or((of, ""));
    let tire = || {
        tires.iter().position(|t| t.name == place).ok_or_else(|| {
            format!("there is no tyre \"{place}\"; tyres are at {}", names(tires.iter().map(|t| t.name.as_str())))
        })
    };
    match effect {
        "tire-normal" => tire().map(Reading::NormalForce),
        "tire-lateral" => tire().map(Reading::LateralForce),
        "applied-force" => assembly
            .scene
            .effect
            .applied_force
            .iter()
            .position(|f| f.get_ref().at == place)
            .map(Reading::AppliedForce)
            .ok_or_else(|| format!("there is no applied force at \"{place}\"")),
        _ => Err(format!(
            "found \"{of}\", expected \"tire-normal:BODY\", \"tire-lateral:BODY\" or \"applied-force:PLACE\""
        )),
    }
}

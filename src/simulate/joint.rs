//! Joints: which relative directions of two points are held.

use crate::model::Axis;

/// A named set of held directions.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Name in a scene.
    pub name: &'static str,
    /// Held directions.
    pub holds: &'static [Axis],
    /// One line of help.
    pub help: &'static str,
}

use Axis::{Rx, Ry, Rz, X, Y, Z};

/// All presets; axes are the model's.
pub const PRESETS: &[Preset] = &[
    Preset { name: "fixed", holds: &[X, Y, Z, Rx, Ry, Rz], help: "all six directions" },
    Preset { name: "spherical", holds: &[X, Y, Z], help: "all translations" },
    Preset { name: "revolute-x", holds: &[X, Y, Z, Ry, Rz], help: "turns about x only" },
    Preset { name: "revolute-y", holds: &[X, Y, Z, Rx, Rz], help: "turns about y only" },
    Preset { name: "revolute-z", holds: &[X, Y, Z, Rx, Ry], help: "turns about z only" },
    Preset { name: "prismatic-x", holds: &[Y, Z, Rx, Ry, Rz], help: "slides along x only" },
    Preset { name: "prismatic-y", holds: &[X, Z, Rx, Ry, Rz], help: "slides along y only" },
    Preset { name: "prismatic-z", holds: &[X, Y, Rx, Ry, Rz], help: "slides along z only" },
];

/// The directions of a preset's name or of a list such as "x y z ry".
pub(super) fn held(text: &str) -> Result<Vec<Axis>, String> {
    if let Some(preset) = PRESETS.iter().find(|p| p.name == text.trim()) {
        return Ok(preset.holds.to_vec());
    }
    let mut axes = Vec::new();
    for word in text.split([' ', ',']).filter(|w| !w.is_empty()) {
        let axis = Axis::parse(word).ok_or_else(|| {
            let presets = PRESETS.iter().map(|p| p.name).collect::<Vec<_>>().join(", ");
            format!(
                "found \"{word}\" in holds = \"{text}\", expected directions among x y z rx ry rz, or one of {presets}"
            )
        })?;
        if !axes.contains(&axis) {
            axes.push(axis);
        }
    }
    if axes.is_empty() {
        return Err(
            "holds is empty: the joint would hold nothing; name directions such as \"x y z\" or remove it".into()
        );
    }
    Ok(axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_presets() {
        assert_eq!(held("x, z ry"), Ok(vec![X, Z, Ry]));
        assert_eq!(held("revolute-y"), Ok(vec![X, Y, Z, Rx, Rz]));
        assert!(held("x q").is_err() && held(" ").is_err());
    }
}

//! Picture: receptance over frequency, with the kept modes marked at their resonances.

use super::plot::{Axis, Colour, Curve, Key, Marker, Picture, Plot, PlotError, Stroke, Symbol, draw};
use crate::frf::{frequency_grid, receptance};
use crate::model::{ModeNo, Modes, Selection};

/// A transfer path: where a force acts, where the motion is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Its name: "Z-Z".
    pub label: String,
    /// Modal row of the output, one entry per mode, 1/√kg.
    pub output: Vec<f64>,
    /// Modal row of the input, one entry per mode, 1/√kg.
    pub input: Vec<f64>,
}

/// The magnitude of a receptance over the frequencies of its [`Receptance`].
#[derive(Clone, Debug, PartialEq)]
pub struct Magnitude {
    /// Its name: "Z-Z".
    pub label: String,
    /// |H|, in `Receptance::unit`.
    pub values: Vec<f64>,
}

/// A mode on the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeMark {
    /// Its number.
    pub number: ModeNo,
    /// Natural frequency, rad/s.
    pub omega: f64,
    /// Where its mark stands, in `Receptance::unit`: the curve at its frequency.
    pub height: f64,
    /// Whether the reduced model keeps it.
    pub kept: bool,
}

/// Receptance curves over a common frequency grid, and the modes on the first of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Receptance {
    /// What is shown: "leaf-spring, receptance at joint d".
    pub title: String,
    /// The kept modes in words: "modes 7–17 kept".
    pub selection: String,
    /// Unit of the magnitudes: "m/N".
    pub unit: String,
    /// Frequencies, rad/s, ascending.
    pub omega: Vec<f64>,
    /// Curves; modes are marked on the first.
    pub curves: Vec<Magnitude>,
    /// Elastic modes.
    pub marks: Vec<ModeMark>,
}

impl Receptance {
    /// Curves of all modes for the given paths (the first carries the marks), at `count` frequencies
    /// from 0.4 of the first to 1.15 of the last elastic frequency and at every resonance.
    ///
    /// Damping must have been stated: a NaN ratio leaves a curve without points.
    pub fn of(title: &str, unit: &str, modes: &Modes, selection: &Selection, paths: &[Path], count: usize) -> Self {
        let elastic: Vec<ModeNo> = modes.elastic().collect();
        let peaks: Vec<f64> = elastic.iter().map(|m| modes.omega[m.column()]).collect();
        let (first, last) = (peaks.first().copied().unwrap_or(1.0), peaks.last().copied().unwrap_or(1.0));
        let omega = frequency_grid(0.4 * first, 1.15 * last, count, &peaks);
        let magnitude = |p: &Path, w: f64| receptance(modes, &p.output, &p.input, 0..modes.len(), w).magnitude();
        let curve =
            |p: &Path| Magnitude { label: p.label.clone(), values: omega.iter().map(|&w| magnitude(p, w)).collect() };
        let mark = |&number: &ModeNo| {
            let omega = modes.omega[number.column()];
            let height = paths.first().map_or(f64::NAN, |p| magnitude(p, omega));
            ModeMark { number, omega, height, kept: selection.modes.contains(&number) }
        };
        Self {
            title: title.to_owned(),
            selection: format!("modes {} kept", selection.ranges().replace('-', "–").replace(',', ", ")),
            unit: unit.to_owned(),
            curves: paths.iter().map(curve).collect(),
            marks: elastic.iter().map(mark).collect(),
            omega,
        }
    }
}

/// |H| over ω, both logarithmic. Kept modes are discs with their numbers, the others rings, numbered
/// where there is room; modes outside the grid are not shown.
///
/// # Errors
/// [`PlotError`] when no curve has a positive finite value, or a curve and the grid differ in length.
pub fn receptance_plot(r: &Receptance) -> Result<Picture, PlotError> {
    let palette = [Colour::Blue, Colour::Vermillion, Colour::Green, Colour::Purple];
    let curve = |(k, m): (usize, &Magnitude)| Curve {
        label: m.label.clone(),
        x: r.omega.clone(),
        y: m.values.clone(),
        colour: palette[k % palette.len()],
        stroke: if k < palette.len() { Stroke::Solid } else { Stroke::Dashed },
    };
    let marker = |m: &ModeMark| Marker {
        x: m.omega,
        y: m.height,
        label: m.number.to_string(),
        colour: if m.kept { Colour::Ink } else { Colour::Grey },
        symbol: if m.kept { Symbol::Disc } else { Symbol::Ring },
        always_named: m.kept,
    };
    // The first curve carries the marks: paint it last.
    let curves = r.curves.iter().enumerate().rev().map(curve).collect();
    let (first, last) = (r.omega.first().copied(), r.omega.last().copied());
    let on_grid = r.marks.iter().filter(|m| Some(m.omega) >= first && Some(m.omega) <= last);
    let (kept, left): (Vec<_>, Vec<_>) = on_grid.partition(|m| m.kept);
    let key = |symbol, colour, label: &str| Key { symbol, colour, label: label.to_owned() };
    let mut keys = vec![key(Symbol::Disc, Colour::Ink, "kept mode")];
    if !left.is_empty() {
        keys.push(key(Symbol::Ring, Colour::Grey, "mode left out"));
    }
    draw(&Plot {
        title: format!("{}: {}", r.title, r.selection),
        key: keys,
        x: Axis::log("ω (rad/s)"),
        y: Axis::log(&format!("|H| ({})", r.unit)),
        curves,
        markers: left.into_iter().chain(kept).map(marker).collect(),
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Completeness, DofMap, Origin};
    use nalgebra::DMatrix;

    fn modes() -> Modes {
        Modes {
            omega: vec![0.0, 100.0, 300.0],
            zeta: vec![0.0, 0.03, 0.03],
            shapes: DMatrix::zeros(0, 3),
            participation: DMatrix::zeros(3, 3),
            dofs: DofMap::unlabelled(0),
            origin: vec![Origin::Rigid, Origin::Computed, Origin::Computed],
            rigid: 1,
            residual: vec![0.0; 3],
            orthogonality: 0.0,
            shift: -1.0,
            complete: Completeness { proved: true, count: 3, below: 310.0 },
            warnings: vec![],
        }
    }

    #[test]
    fn marks_stand_on_the_curve_at_the_resonances() {
        let selection = Selection { modes: vec![ModeNo(2)], reason: String::new(), warnings: vec![] };
        let path = Path { label: "Z-Z".into(), output: vec![0.5, 1.0, 0.2], input: vec![0.5, 1.0, 0.2] };
        let r = Receptance::of("two modes", "m/N", &modes(), &selection, &[path], 200);
        assert_eq!(r.selection, "modes 2 kept");
        assert_eq!(r.marks.iter().map(|m| (m.number.0, m.kept)).collect::<Vec<_>>(), [(2, true), (3, false)]);
        for mark in &r.marks {
            let at = r.omega.iter().position(|&w| w == mark.omega).expect("every resonance is on the grid");
            assert_eq!(r.curves[0].values[at], mark.height);
        }
        let svg = receptance_plot(&r).expect("drawn").svg;
        assert!(svg.contains("two modes: modes 2 kept") && svg.contains("|H| (m/N)"));
    }

    #[test]
    fn unstated_damping_is_an_error_not_an_empty_picture() {
        let mut modes = modes();
        modes.zeta = vec![f64::NAN; 3];
        let selection = Selection { modes: vec![], reason: String::new(), warnings: vec![] };
        let path = Path { label: "Z-Z".into(), output: vec![0.0, 1.0, 1.0], input: vec![0.0, 1.0, 1.0] };
        let r = Receptance::of("t", "m/N", &modes, &selection, &[path], 50);
        assert!(matches!(receptance_plot(&r), Err(PlotError::Nothing { .. })));
    }
}

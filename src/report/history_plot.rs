//! Picture: a channel over time, its turning points named, reference points laid over it.

use super::number::{decimals, display_unit};
use super::plot::{Axis, Colour, Curve, Key, Marker, Picture, Plot, PlotError, Stroke, Symbol, draw};
use crate::model::{Channel, Extreme, Trajectory};

/// Turning points named in the picture; later ones are small.
const NAMED: usize = 6;

/// Points of another source over the curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Its name: "drop test 2 of the paper".
    pub label: String,
    /// (s, value in the channel's SI unit).
    pub points: Vec<(f64, f64)>,
}

impl Reference {
    /// Turning points published without times: each at the time of ours with the same number.
    pub fn at_turning_points(label: &str, values: &[f64], ours: &[Extreme]) -> Self {
        Self { label: label.to_owned(), points: ours.iter().zip(values).map(|(e, &v)| (e.t, v)).collect() }
    }
}

/// A channel over time as a picture; lengths in mm.
///
/// # Errors
/// [`PlotError`] when the channel has no finite values (a static analysis), or not as many as times.
pub fn history_plot(
    title: &str,
    trajectory: &Trajectory,
    channel: &Channel,
    references: &[Reference],
) -> Result<Picture, PlotError> {
    let (factor, unit) = display_unit(&channel.unit);
    let extremes = &channel.extremes[..channel.extremes.len().min(NAMED)];
    let ours = Curve {
        label: String::new(),
        x: trajectory.time.clone(),
        y: channel.values.iter().map(|v| v * factor).collect(),
        colour: Colour::Blue,
        stroke: Stroke::Solid,
    };
    let style = [(Colour::Vermillion, Symbol::Diamond), (Colour::Green, Symbol::Cross), (Colour::Purple, Symbol::Ring)];
    let reference = |(k, r): (usize, &Reference)| Curve {
        label: r.label.clone(),
        x: r.points.iter().map(|p| p.0).collect(),
        y: r.points.iter().map(|p| p.1 * factor).collect(),
        colour: style[k % style.len()].0,
        stroke: Stroke::Points(style[k % style.len()].1),
    };
    let marker = |e: &Extreme| Marker {
        x: e.t,
        y: e.value * factor,
        label: decimals(e.value * factor, 1).replace('-', "−"),
        colour: Colour::Blue,
        symbol: Symbol::Dot,
        always_named: true,
    };
    // Without a time axis from 0 the first moment of a drop would be lost in the margin.
    let last = trajectory.time.iter().copied().filter(|t| t.is_finite()).fold(f64::NAN, f64::max);
    draw(&Plot {
        title: title.to_owned(),
        subtitle: format!("zero: {}", channel.datum),
        key: vec![Key { symbol: Symbol::Dot, colour: Colour::Blue, label: "ferrom".into() }],
        x: Axis { range: (last > 0.0).then_some((0.0, last)), ..Axis::linear("t (s)") },
        y: Axis::linear(&format!("{} ({unit})", channel.name)),
        curves: std::iter::once(ours).chain(references.iter().enumerate().map(reference)).collect(),
        markers: extremes.iter().map(marker).collect(),
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stats;

    fn trajectory(time: Vec<f64>, values: Vec<f64>) -> Trajectory {
        let e = |t, value| Extreme { t, value };
        let channel = Channel {
            name: "pin".into(),
            unit: "m".into(),
            datum: "static equilibrium".into(),
            values,
            at_rest: None,
            extremes: vec![e(0.1166, -0.15346)],
            range: [e(0.1166, -0.15346), e(0.0, 0.0)],
        };
        Trajectory {
            scene: "drop".into(),
            time,
            channels: vec![channel],
            energy: None,
            effects: vec![],
            stats: Stats::default(),
            warnings: vec![],
        }
    }

    #[test]
    fn lengths_are_drawn_in_millimetres_with_both_sources_named() {
        let t = trajectory(vec![0.0, 0.1166, 0.3], vec![0.0, -0.15346, 0.1]);
        let c = &t.channels[0];
        let paper = Reference::at_turning_points("paper", &[-0.1554, 0.1225], &c.extremes);
        assert_eq!(paper.points, [(0.1166, -0.1554)]);
        let svg = history_plot("Drop", &t, c, &[paper]).expect("drawn").svg;
        for part in ["pin (mm)", "−153.5", "ferrom", "paper", "t (s)"] {
            assert!(svg.contains(part), "{part}");
        }
    }

    #[test]
    fn a_static_analysis_has_no_history() {
        let t = trajectory(vec![], vec![]);
        let mut c = t.channels[0].clone();
        c.extremes.clear();
        assert!(matches!(history_plot("Static", &t, &c, &[]), Err(PlotError::Nothing { .. })));
    }
}

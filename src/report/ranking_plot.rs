//! Picture: the relative score of each mode as a bar, the threshold, the kept modes in colour.

use super::plot::{Axis, Bar, Colour, Key, Picture, Plot, PlotError, Rule, Symbol, draw};
use super::words::SCORE_NOISE;
use crate::model::{Ranking, Selection};

/// Bars of the relative scores, logarithmic; kept modes in colour, `threshold` (relative, when the
/// rule has one) as a line. Scores that are zero by symmetry stand as "0" on the axis.
///
/// # Errors
/// [`PlotError`] when no score is positive and finite.
pub fn ranking_plot(
    title: &str,
    ranking: &Ranking,
    selection: &Selection,
    threshold: Option<f64>,
) -> Result<Picture, PlotError> {
    let shown = |relative: f64| if relative.abs() < SCORE_NOISE { 0.0 } else { relative };
    let bars: Vec<Bar> = ranking
        .scores
        .iter()
        .map(|s| Bar {
            x: f64::from(s.mode.0),
            y: shown(s.relative),
            colour: if selection.modes.contains(&s.mode) { Colour::Blue } else { Colour::Grey },
        })
        .collect();
    let threshold = threshold.filter(|t| *t > 0.0 && t.is_finite());
    let positive = bars.iter().map(|b| b.y).chain(threshold).filter(|y| *y > 0.0 && y.is_finite());
    let least = positive.fold(f64::INFINITY, f64::min);
    // Bars need a foot: half a decade below the least score.
    let range = least.is_finite().then(|| (10f64.powf((least.log10() - 0.3).floor()), 2.0));
    let rule = |y| Rule { y, label: format!("threshold {y:e}"), colour: Colour::Vermillion };
    let zeros = if bars.iter().any(|b| b.y == 0.0) { "; 0: no share, by symmetry" } else { "" };
    let key = |colour, label: &str| Key { symbol: Symbol::Square, colour, label: label.to_owned() };
    let kept = selection.ranges().replace('-', "–").replace(',', ", ");
    draw(&Plot {
        title: format!("{title}: modes {kept} kept"),
        subtitle: format!("{}, {} to {}{zeros}", ranking.criterion, ranking.input, ranking.output),
        key: vec![key(Colour::Blue, "kept"), key(Colour::Grey, "left out")],
        x: Axis::linear("mode"),
        y: Axis { range, ..Axis::log("score relative to the largest") },
        bars,
        rules: threshold.map(rule).into_iter().collect(),
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ModeNo, Score};

    fn ranking(relative: &[f64]) -> Ranking {
        let score = |(k, &relative): (usize, &f64)| Score { mode: ModeNo(7 + k as u32), score: relative, relative };
        Ranking {
            criterion: "peak-gain".into(),
            input: "d:z".into(),
            output: "d:z".into(),
            unit: "m/N".into(),
            scores: relative.iter().enumerate().map(score).collect(),
        }
    }

    #[test]
    fn zeros_and_the_threshold_are_shown() {
        let selection = Selection { modes: vec![ModeNo(7)], reason: String::new(), warnings: vec![] };
        let svg = ranking_plot("leaf", &ranking(&[1.0, 1e-20, 5e-2]), &selection, Some(2e-4)).expect("drawn").svg;
        for part in ["leaf: modes 7 kept", "threshold 2e-4", "no share, by symmetry"] {
            assert!(svg.contains(part), "{part}");
        }
    }

    #[test]
    fn only_zeros_are_an_error() {
        let selection = Selection { modes: vec![], reason: String::new(), warnings: vec![] };
        for relative in [&[][..], &[0.0][..], &[f64::NAN, f64::NAN][..]] {
            assert!(ranking_plot("leaf", &ranking(relative), &selection, None).is_err());
        }
    }
}

//! The criteria a mode can be ranked by: one table of plain functions.

use crate::frf::receptance;
use crate::model::{Axis, ModeNo, Modes, Ranking, Score};

/// One end of a transfer path: a direction of an interface node and its modal row.
#[derive(Clone, Debug)]
pub struct PathEnd {
    /// "d:z".
    pub name: String,
    /// The direction.
    pub axis: Axis,
    /// φ of the direction per mode, 1/√kg; m.
    pub row: Vec<f64>,
}

/// A transfer path: force at `input`, displacement at `output`.
#[derive(Clone, Debug)]
pub struct Path {
    /// Where the force acts.
    pub input: PathEnd,
    /// Where the displacement is taken.
    pub output: PathEnd,
}

/// A way to score modes.
#[derive(Clone, Copy)]
pub struct Criterion {
    /// Name in recipes and on the command line.
    pub name: &'static str,
    /// One line of help with the formula.
    pub help: &'static str,
    /// Unit of the score for a path.
    unit: fn(&Path) -> String,
    /// Score of one elastic mode (column) for a path; never negative.
    score: fn(&Modes, &Path, usize) -> f64,
}

/// All criteria.
pub const CRITERIA: &[Criterion] = &[
    Criterion {
        name: "peak-gain",
        help: "height of the mode's own resonance peak, |φo φi| / (2 ζ ω² √(1−ζ²)); for ζ ≥ 1/√2, which has no peak, |φo φi| / ω²",
        unit: receptance_unit,
        score: |modes, path, c| gain(path, c) * peak_factor(modes.zeta[c]) / modes.omega[c].powi(2),
    },
    Criterion {
        name: "static-gain",
        help: "the mode's share of the static flexibility, |φo φi| / ω²",
        unit: receptance_unit,
        score: |modes, path, c| gain(path, c) / modes.omega[c].powi(2),
    },
    Criterion {
        name: "h2",
        help: "the mode's H2 norm, |φo φi| / (2 √(ζ ω³))",
        unit: |path| format!("{}·s^-1/2", receptance_unit(path)),
        score: |modes, path, c| gain(path, c) / (2.0 * (modes.zeta[c] * modes.omega[c].powi(3)).sqrt()),
    },
    Criterion {
        name: "effective-mass",
        help: "modal effective mass along the input direction (a translation), Γ²; zero for every elastic mode of a free body",
        unit: |_| "kg".into(),
        score: |modes, path, c| {
            let axis = path.input.axis.index();
            if axis < 3 { modes.participation[(c, axis)].powi(2) } else { 0.0 }
        },
    },
    Criterion {
        name: "frf-peak",
        help: "height of the whole receptance curve at the mode's resonance, all modes taking part",
        unit: receptance_unit,
        score: |modes, path, c| {
            receptance(modes, &path.output.row, &path.input.row, 0..modes.len(), modes.omega[c]).magnitude()
        },
    },
];

/// The criterion of a name.
pub fn criterion(name: &str) -> Option<&'static Criterion> {
    CRITERIA.iter().find(|c| c.name == name)
}

/// |φo φi|, 1/kg.
fn gain(path: &Path, column: usize) -> f64 {
    (path.output.row[column] * path.input.row[column]).abs()
}

/// Peak of 1/|1 − x² + 2jζx| over x: 1/(2ζ√(1−ζ²)) where a peak exists (ζ < 1/√2), else 1 at x = 0
/// (Ewins, Modal Testing, 2nd ed., sec. 2.4).
fn peak_factor(zeta: f64) -> f64 {
    if zeta < std::f64::consts::FRAC_1_SQRT_2 { 1.0 / (2.0 * zeta * (1.0 - zeta * zeta).sqrt()) } else { 1.0 }
}

fn receptance_unit(path: &Path) -> String {
    let force = if path.input.axis.is_rotation() { "(N·m)" } else { "N" };
    format!("{}/{force}", path.output.axis.unit())
}

/// Scores every elastic mode for the best of the given paths: a mode is as important as its best
/// path makes it, each path relative to its own largest score. With one path the score is that
/// path's; with several, `score` and `relative` are those of the mode's best path.
pub fn rank(modes: &Modes, criterion: &Criterion, paths: &[Path]) -> Ranking {
    let mut best: Vec<Score> = modes.elastic().map(|mode| Score { mode, score: 0.0, relative: 0.0 }).collect();
    for path in paths {
        let scores: Vec<f64> = modes.elastic().map(|m: ModeNo| (criterion.score)(modes, path, m.column())).collect();
        let largest = scores.iter().copied().fold(0.0, f64::max);
        for (entry, score) in best.iter_mut().zip(scores) {
            let relative = if largest > 0.0 { score / largest } else { 0.0 };
            if relative > entry.relative || entry.score == 0.0 {
                (entry.score, entry.relative) = (score, relative);
            }
        }
    }
    let join = |end: fn(&Path) -> &PathEnd| paths.iter().map(|p| end(p).name.as_str()).collect::<Vec<_>>().join(" ");
    Ranking {
        criterion: criterion.name.into(),
        input: join(|p| &p.input),
        output: join(|p| &p.output),
        unit: paths.first().map_or_else(String::new, |p| (criterion.unit)(p)),
        scores: best,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Completeness, DofMap, Origin};
    use nalgebra::DMatrix;

    /// Two rigid modes and three elastic ones with chosen gains.
    fn modes(sign: f64) -> Modes {
        let omega = vec![0.0, 0.0, 10.0, 20.0, 40.0];
        Modes {
            zeta: vec![0.03; 5],
            shapes: DMatrix::from_row_slice(1, 5, &[1.0, 1.0, sign * 0.5, 0.0, -0.25]),
            participation: DMatrix::from_fn(5, 3, |r, _| if r < 2 { 1.0 } else { 0.1 }),
            dofs: DofMap::unlabelled(1),
            origin: vec![Origin::Computed; 5],
            rigid: 2,
            residual: vec![0.0; 5],
            orthogonality: 0.0,
            shift: -1.0,
            complete: Completeness { proved: true, count: 5, below: 50.0 },
            warnings: vec![],
            omega,
        }
    }

    fn path(modes: &Modes) -> Path {
        let end = || PathEnd { name: "d:z".into(), axis: Axis::Z, row: modes.shapes.row(0).iter().copied().collect() };
        Path { input: end(), output: end() }
    }

    #[test]
    fn every_criterion_ignores_mode_signs_and_is_finite() {
        for c in CRITERIA {
            let (plus, minus) = (modes(1.0), modes(-1.0));
            let a = rank(&plus, c, &[path(&plus)]);
            let b = rank(&minus, c, &[path(&minus)]);
            assert_eq!(a, b, "{}", c.name);
            assert_eq!(a.scores.len(), 3);
            assert!(a.scores.iter().all(|s| s.score.is_finite() && s.relative <= 1.0), "{}", c.name);
        }
    }

    #[test]
    fn peak_gain_is_the_closed_form() {
        let m = modes(1.0);
        let r = rank(&m, criterion("peak-gain").expect("in the table"), &[path(&m)]);
        let expected = 0.25 / (2.0 * 0.03 * 100.0 * (1.0f64 - 0.0009).sqrt());
        assert!((r.scores[0].score / expected - 1.0).abs() < 1e-14);
        assert_eq!(r.scores[1].score, 0.0);
        // (0.25/40)²-type ratio: 0.0625/1600 against 0.25/100.
        assert!((r.scores[2].relative - (0.0625 / 1600.0) / (0.25 / 100.0)).abs() < 1e-15);
        assert_eq!(r.unit, "m/N");
    }

    #[test]
    fn a_mode_is_as_important_as_its_best_path() {
        let m = modes(1.0);
        let mut other = path(&m);
        other.output.row = vec![0.0, 0.0, 0.0, 1.0, 0.0];
        other.input.row = vec![0.0, 0.0, 0.0, 1.0, 0.0];
        let r = rank(&m, criterion("static-gain").expect("in the table"), &[path(&m), other]);
        assert_eq!((r.scores[0].relative, r.scores[1].relative), (1.0, 1.0));
    }
}

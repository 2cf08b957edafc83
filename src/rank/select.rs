//! The rules that turn a ranking into the kept modes.

use crate::model::{ModeNo, Modes, Ranking, Score, Selection};
use serde::Deserialize;
use thiserror::Error;

/// A selection rule with its parameter, as `[select]` of a recipe gives it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "rule", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Rule {
    /// Every elastic mode up to the last one whose score is at least `threshold` times the largest.
    LastAbove {
        /// Relative score.
        threshold: f64,
    },
    /// Every elastic mode whose score is at least `threshold` times the largest.
    EachAbove {
        /// Relative score.
        threshold: f64,
    },
    /// The `count` modes of highest score.
    Count {
        /// How many.
        count: usize,
    },
    /// The modes named: "7-17" or "7,8,10-13".
    List {
        /// Mode numbers and ranges.
        modes: String,
    },
}

/// Name and one line of help of every rule.
pub const RULES: &[(&str, &str)] = &[
    (
        "last-above",
        "every elastic mode up to the last whose score is at least `threshold` times the largest (the paper's)",
    ),
    ("each-above", "every elastic mode whose own score is at least `threshold` times the largest"),
    ("count", "the `count` elastic modes of highest score"),
    ("list", "the modes named in `modes`, such as \"7-17\""),
];

/// Why a rule cannot select.
#[derive(Debug, Error, PartialEq)]
pub enum SelectError {
    /// Thresholds compare with relative scores.
    #[error("select threshold {0} is outside (0, 1]; scores are relative to the largest")]
    Threshold(f64),
    /// A list that cannot be read.
    #[error("{0}")]
    List(String),
    /// A listed mode that is not an elastic mode of the analysis.
    #[error(
        "mode {mode} is not one of the computed elastic modes {first}–{last}; compute more ([modal] count) or list others"
    )]
    NotComputed {
        /// As listed.
        mode: ModeNo,
        /// First elastic mode.
        first: ModeNo,
        /// Last computed mode.
        last: ModeNo,
    },
    /// More modes asked for than there are.
    #[error("count {asked} is more than the {computed} computed elastic modes; raise [modal] count")]
    TooMany {
        /// As asked.
        asked: usize,
        /// Computed elastic modes.
        computed: usize,
    },
}

/// Frequencies closer than this (relative) are one cluster: exports rarely separate them.
const CLUSTER: f64 = 1e-4;

/// Applies the rule. The reason names what decided; warnings tell of split clusters and of
/// discarded modes with more static gain than a kept one that was kept for its score.
pub fn select(modes: &Modes, ranking: &Ranking, rule: &Rule) -> Result<Selection, SelectError> {
    let scores = &ranking.scores;
    let above = |threshold: f64| -> Result<Vec<&Score>, SelectError> {
        if threshold > 0.0 && threshold <= 1.0 {
            Ok(scores.iter().filter(|s| s.relative >= threshold).collect())
        } else {
            Err(SelectError::Threshold(threshold))
        }
    };
    let path = format!("{} {} → {}", ranking.criterion, ranking.input, ranking.output);
    let (kept, reason) = match rule {
        Rule::LastAbove { threshold } => {
            let last = above(*threshold)?.last().map(|s| **s);
            let kept: Vec<ModeNo> =
                scores.iter().map(|s| s.mode).filter(|&m| last.is_some_and(|l| m <= l.mode)).collect();
            let reason = match last {
                None => format!("last-above: no mode has a {path} score"),
                Some(last) => {
                    let next =
                        scores.iter().filter(|s| s.mode > last.mode).max_by(|a, b| a.relative.total_cmp(&b.relative));
                    let after = next.map_or_else(
                        || "no mode was computed after it".into(),
                        |n| format!("the largest after it is mode {} with {:.3e}", n.mode, n.relative),
                    );
                    format!(
                        "last-above: mode {} is the last whose {path} score ({:.3e} of the largest) reaches {threshold:e}; {after}",
                        last.mode, last.relative
                    )
                }
            };
            (kept, reason)
        }
        Rule::EachAbove { threshold } => (
            above(*threshold)?.iter().map(|s| s.mode).collect(),
            format!("each-above: every mode whose {path} score reaches {threshold:e} of the largest"),
        ),
        Rule::Count { count } => {
            if *count > scores.len() {
                return Err(SelectError::TooMany { asked: *count, computed: scores.len() });
            }
            let mut order: Vec<&Score> = scores.iter().collect();
            order.sort_by(|a, b| b.relative.total_cmp(&a.relative).then(a.mode.cmp(&b.mode)));
            let mut kept: Vec<ModeNo> = order[..*count].iter().map(|s| s.mode).collect();
            kept.sort_unstable();
            (kept, format!("count: the {count} modes of highest {path} score"))
        }
        Rule::List { modes: list } => {
            let listed = Selection::parse_ranges(list).map_err(SelectError::List)?;
            if let Some(&mode) = listed.iter().find(|m| !scores.iter().any(|s| s.mode == **m)) {
                let first = ModeNo::from_column(modes.rigid);
                return Err(SelectError::NotComputed { mode, first, last: ModeNo(modes.len() as u32) });
            }
            (listed, format!("list: modes {list} were asked for"))
        }
    };
    let mut warnings = split_clusters(modes, &kept);
    warnings.extend(outranked(modes, ranking, &kept));
    Ok(Selection { modes: kept, reason, warnings })
}

fn split_clusters(modes: &Modes, kept: &[ModeNo]) -> Vec<String> {
    let mut found = Vec::new();
    for c in modes.rigid..modes.len().saturating_sub(1) {
        let (a, b) = (ModeNo::from_column(c), ModeNo::from_column(c + 1));
        let close = modes.omega[c + 1] - modes.omega[c] <= CLUSTER * modes.omega[c + 1];
        if close && kept.contains(&a) != kept.contains(&b) {
            found.push(format!(
                "modes {a} and {b} are a repeated root ({:.6} and {:.6} rad/s) and only one is kept: its direction within the pair is arbitrary",
                modes.omega[c],
                modes.omega[c + 1]
            ));
        }
    }
    found
}

/// Scores below this share of the largest are symmetry zeros plus rounding.
const SYMMETRY_ZERO: f64 = 1e-12;

fn outranked(modes: &Modes, ranking: &Ranking, kept: &[ModeNo]) -> Option<String> {
    // A mode kept only because it lies below the last one carries no score: it outranks nobody.
    let weakest = ranking
        .scores
        .iter()
        .filter(|s| kept.contains(&s.mode) && s.relative > SYMMETRY_ZERO)
        .min_by(|a, b| a.relative.total_cmp(&b.relative))?;
    let outranking: Vec<String> = ranking
        .scores
        .iter()
        .filter(|s| !kept.contains(&s.mode) && s.relative > weakest.relative)
        .map(|s| format!("{} ({:.2e}, {:.1} rad/s)", s.mode, s.relative, modes.omega[s.mode.column()]))
        .collect();
    (!outranking.is_empty()).then(|| {
        format!(
            "discarded modes outrank kept mode {} ({:.2e}): {}",
            weakest.mode,
            weakest.relative,
            outranking.join(", ")
        )
    })
}

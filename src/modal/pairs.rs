//! Eigenpairs of a model: the way is chosen by size, and a bad shift is noticed and replaced.

use super::{ModalError, SolveReport};
use crate::linalg::{
    Analysis, EigenPairs, FactorError, LanczosOptions, ShiftedFactor, SymSparse, dense_pencil, lanczos,
};
use crate::model::{DofMap, FeModel, Progress};
use nalgebra::DMatrix;
use std::sync::Arc;
use std::time::Instant;

/// Models up to this size are solved whole: faster than the iteration and just as accurate.
const DENSE: usize = 300;
/// Pairs to which all of them are solved whole when most are wanted.
const DENSE_MOST: usize = 1500;
/// Residual of the inverted problem asked of the iteration: a tenth of the 1e-9 promised for
/// ‖Kφ − ω²Mφ‖ / ‖Kφ‖, which is measured in another norm.
const TOLERANCE: f64 = 1e-10;
/// The shift is kept while its ratio to the first elastic ω² lies between these: a smaller one
/// loses digits to the rigid modes, a larger one costs steps and digits of the lowest modes.
const RATIO: (f64, f64) = (1e-1, 1e3);

/// Moves of the shift at most. From far off, early Ritz values are poor bounds and each move gains
/// a few powers of ten; from a mesh none is needed.
const MOVES: usize = 6;

/// Share of |σ| below which λ is not distinguished from a rigid mode's zero.
const VISIBLE: f64 = 1e-5;

/// Basis vectors allowed per pair wanted: enough that a restart, which costs digits, is rare. They
/// are only held when they are needed.
const ROOM: usize = 6;

/// Pairs with everything the later stages need.
pub(super) struct Pairs {
    pub(super) lambda: Vec<f64>,
    pub(super) vectors: DMatrix<f64>,
    /// First eigenvalue estimate not in `lambda`; `None` when there is none.
    pub(super) next: Option<f64>,
    pub(super) shift: f64,
    pub(super) analysis: Arc<Analysis>,
    /// Given up before the completeness count, which needs the memory.
    pub(super) factor: Option<ShiftedFactor>,
    pub(super) warnings: Vec<String>,
}

/// What is known before the first factorisation.
pub(super) struct Start {
    /// σ to begin with.
    pub(super) shift: f64,
    /// Pairs wanted.
    pub(super) wanted: usize,
    /// Pairs after them that need only be seen.
    pub(super) seen: usize,
    /// |ω²| up to which an eigenvalue is a rigid one in the given digits.
    pub(super) rigid_below: f64,
}

pub(super) fn compute(
    fe: &FeModel,
    start: &Start,
    progress: &dyn Progress,
    report: &mut SolveReport,
) -> Result<Pairs, ModalError> {
    let (k, m) = (&fe.stiffness, &fe.mass);
    let since = Instant::now();
    progress.report("ordering", 0, 0);
    let analysis = Arc::new(Analysis::new(k, m, groups(&fe.dofs).as_deref())?);
    let note = format!("{}, {:.2e} operations", analysis.ordering(), analysis.flops());
    report.add("ordering", since, 0, note);
    let warnings = Vec::new();
    let mut shift = start.shift;
    for attempt in 0..=MOVES + 1 {
        let since = Instant::now();
        progress.report("factorisation", attempt, 0);
        let factor = ShiftedFactor::with_analysis(&analysis, k, m, shift).map_err(|e| named(e, &fe.dofs))?;
        report.add("factorisation", since, factor.bytes(), format!("shift {shift:.4e}"));
        let below = factor.negative_eigenvalues();
        if below > 0 {
            // Rounding can make rigid ω² negative; a shift beyond that noise must be below them all.
            if shift.abs() < 10.0 * start.rigid_below && attempt < MOVES {
                shift = -100.0 * start.rigid_below;
                continue;
            }
            return Err(ModalError::NegativeStiffness { count: below, below: shift });
        }
        let since = Instant::now();
        let n = k.order();
        let dense = n <= DENSE || (n <= DENSE_MOST && 2 * start.wanted >= n);
        let found = if dense {
            let (lambda, vectors) = dense_pencil(k, m, shift).map_err(|e| named(e, &fe.dofs))?;
            match better_shift(&lambda, shift, start.rigid_below).filter(|_| attempt < MOVES) {
                Some(better) => Err(better),
                None => Ok(whole(lambda, vectors, start.wanted + start.seen)),
            }
        } else {
            // Early Ritz values are only bounds; the converged ones tell whether the shift was right.
            iterate(&factor, m, start, shift, attempt < MOVES, progress).and_then(|pairs| {
                match better_shift(&pairs.lambda, shift, start.rigid_below).filter(|_| attempt < MOVES) {
                    Some(better) => Err(better),
                    None => Ok(pairs),
                }
            })
        };
        match found {
            Err(better) => {
                report.add("lanczos", since, 0, format!("shift {shift:.4e} badly placed, moved to {better:.4e}"));
                shift = better;
            }
            Ok(pairs) => {
                report.add("lanczos", since, pairs.bytes, note_of(&pairs, dense));
                if !pairs.converged {
                    let converged = pairs.estimate.iter().take_while(|e| **e <= TOLERANCE).count();
                    return Err(ModalError::NotConverged { converged, wanted: start.wanted });
                }
                return Ok(Pairs {
                    lambda: pairs.lambda,
                    vectors: pairs.vectors,
                    next: pairs.next.map(|n| n.0),
                    shift,
                    analysis,
                    factor: Some(factor),
                    warnings,
                });
            }
        }
    }
    Err(ModalError::BadShift(shift))
}

fn note_of(pairs: &EigenPairs, dense: bool) -> String {
    if dense {
        "dense".into()
    } else {
        format!("{} solves, {} vectors, {} restarts", pairs.solves, pairs.basis, pairs.restarts)
    }
}

/// −(first elastic ω²) when the shift is out of range.
fn better_shift(lambda: &[f64], shift: f64, rigid_below: f64) -> Option<f64> {
    // λ = σ + 1/θ carries rounding of σ and of the solves: what is below that may be a rigid mode.
    match lambda.iter().copied().find(|&l| l > rigid_below && l > VISIBLE * shift.abs()) {
        Some(elastic) => {
            let ratio = shift.abs() / elastic;
            (ratio < RATIO.0 || ratio > RATIO.1).then_some(-elastic)
        }
        // Everything seen is nothing beside σ: go down as far as can be seen.
        None => lambda.last().filter(|_| shift.abs() > rigid_below).map(|_| 1e-2 * shift),
    }
}

fn whole(lambda: Vec<f64>, vectors: DMatrix<f64>, wanted: usize) -> EigenPairs {
    let count = wanted.min(lambda.len());
    EigenPairs {
        next: lambda.get(count).map(|&l| (l, 0.0)),
        vectors: vectors.columns(0, count).into_owned(),
        estimate: vec![0.0; count],
        converged: true,
        solves: 0,
        restarts: 0,
        basis: lambda.len(),
        bytes: vectors.len() * 16,
        lambda: lambda[..count].to_vec(),
    }
}

/// The iteration; `Err` carries a better shift noticed on the way.
fn iterate(
    factor: &ShiftedFactor,
    mass: &SymSparse,
    start: &Start,
    shift: f64,
    may_move: bool,
    progress: &dyn Progress,
) -> Result<EigenPairs, f64> {
    let options = LanczosOptions {
        wanted: start.wanted,
        seen: start.seen,
        basis: ROOM * start.wanted + 64,
        tolerance: TOLERANCE,
        restarts: 100,
    };
    let mut better = None;
    let pairs = lanczos(factor, mass, options, &mut |status| {
        progress.report("lanczos", status.converged, start.wanted);
        // By the fifth step rigid Ritz values have fallen below what counts as visible.
        if may_move && status.steps == 5 {
            better = better_shift(status.lambda, shift, start.rigid_below);
        }
        better.is_none()
    });
    pairs.ok_or_else(|| better.unwrap_or(shift))
}

/// Node of each row, numbered as met; `None` without labels.
fn groups(dofs: &DofMap) -> Option<Vec<u32>> {
    let labels = dofs.labels();
    if labels.is_empty() {
        return None;
    }
    let mut number = std::collections::HashMap::with_capacity(labels.len() / 3);
    Some(
        labels
            .iter()
            .map(|d| {
                let next = number.len() as u32;
                *number.entry(d.node).or_insert(next)
            })
            .collect(),
    )
}

fn named(error: FactorError, dofs: &DofMap) -> ModalError {
    match error {
        FactorError::Singular { row } => ModalError::CommonNull { dof: dofs.describe(row) },
        other => ModalError::Factor(other),
    }
}

//! Multifrontal factorisation of K − σM.

use super::front::{Pivoting, Pivots, Scratch, eliminate};
use super::symbolic::Analysis;
use super::tree::NONE;
use super::{FactorError, SymSparse};
use faer::Par;
use rayon::prelude::*;
use std::sync::Arc;

/// Fronts with less work than this (operations) are not worth a second thread.
const PARALLEL_FRONT: f64 = 4e6;

/// P (K − σM) Pᵀ = L B Lᵀ, multifrontal (Duff & Reid 1983; Liu 1992), with dense fronts factored
/// by faer. σ below every eigenvalue gives a Cholesky factor; otherwise B has 1×1 and 2×2 pivots
/// chosen inside each front.
#[derive(Debug)]
pub struct ShiftedFactor {
    pub(super) analysis: Arc<Analysis>,
    /// Panels [L₁₁; L₂₁] of all supernodes, column-major.
    pub(super) panels: Vec<f64>,
    pub(super) pivoting: Pivoting,
    /// Diagonal and subdiagonal of B and the column each pivot came from; n long when indefinite.
    pub(super) diagonal: Vec<f64>,
    pub(super) off: Vec<f64>,
    pub(super) from: Vec<u32>,
    negative: usize,
    shift: f64,
}

/// Number of eigenvalues below μ, from a factorisation that is not kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// Negative pivots of K − μM.
    pub negative: usize,
    /// Largest |entry of L|: multiplies the rounding error of the count. A count with entries up
    /// to 10⁸ may still be trusted only when μ lies well away from every eigenvalue.
    pub growth: f64,
}

impl ShiftedFactor {
    /// Orders, analyses and factors K − σM; σ = `shift` in (rad/s)².
    ///
    /// # Errors
    /// [`FactorError`]; a singular K − σM never gives a factor.
    pub fn new(k: &SymSparse, m: &SymSparse, shift: f64) -> Result<Self, FactorError> {
        Self::with_analysis(&Arc::new(Analysis::new(k, m, None)?), k, m, shift)
    }

    /// The same with an analysis at hand.
    ///
    /// # Errors
    /// [`FactorError`].
    pub fn with_analysis(
        analysis: &Arc<Analysis>,
        k: &SymSparse,
        m: &SymSparse,
        shift: f64,
    ) -> Result<Self, FactorError> {
        let lower = Lower::new(analysis, k, m, shift)?;
        // Below the spectrum the factor is definite, and that is what a shift σ ≤ 0 is for.
        if shift <= 0.0 {
            match Self::factor(analysis, &lower, Pivoting::Definite, shift) {
                Err(FactorError::NotDefinite { .. }) => {}
                other => return other,
            }
        }
        Self::factor(analysis, &lower, Pivoting::Indefinite, shift)
    }

    fn factor(analysis: &Arc<Analysis>, lower: &Lower, pivoting: Pivoting, shift: f64) -> Result<Self, FactorError> {
        let mut panels = vec![0.0; analysis.factor_entries()];
        let kept = if pivoting == Pivoting::Indefinite { analysis.order } else { 0 };
        let (mut diagonal, mut off, mut from) = (vec![0.0; kept], vec![0.0; kept], vec![0u32; kept]);
        let store = Store { panels: &mut panels, diagonal: &mut diagonal, off: &mut off, from: &mut from };
        let inertia = run(analysis, lower, pivoting, Some(store))?;
        Ok(Self {
            analysis: Arc::clone(analysis),
            panels,
            pivoting,
            diagonal,
            off,
            from,
            negative: inertia.negative,
            shift,
        })
    }

    /// Inertia of K − μM by a factorisation whose factor is thrown away front by front.
    ///
    /// # Errors
    /// [`FactorError::Singular`] when μ is an eigenvalue to rounding.
    pub fn inertia(analysis: &Analysis, k: &SymSparse, m: &SymSparse, shift: f64) -> Result<Inertia, FactorError> {
        let lower = Lower::new(analysis, k, m, shift)?;
        run(analysis, &lower, Pivoting::Indefinite, None)
    }

    /// Number of eigenvalues of K φ = λ M φ below σ (M positive semidefinite; Sylvester).
    pub fn negative_eigenvalues(&self) -> usize {
        self.negative
    }

    /// σ.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// The analysis it was made with.
    pub fn analysis(&self) -> &Arc<Analysis> {
        &self.analysis
    }

    /// Bytes held by the factor.
    pub fn bytes(&self) -> usize {
        self.panels.len() * 8 + self.diagonal.len() * 20
    }
}

/// Lower triangle of P (K − σM) Pᵀ by columns; entries of K and M stand side by side and add up
/// in the fronts.
struct Lower {
    start: Vec<usize>,
    row: Vec<u32>,
    value: Vec<f64>,
}

impl Lower {
    fn new(analysis: &Analysis, k: &SymSparse, m: &SymSparse, shift: f64) -> Result<Self, FactorError> {
        let n = analysis.order;
        if k.order() != n || m.order() != n {
            return Err(FactorError::OrderMismatch { stiffness: k.order(), mass: m.order() });
        }
        if !shift.is_finite() {
            return Err(FactorError::BadShift { shift });
        }
        let inverse = &analysis.inverse;
        let parts = [(k, 1.0), (m, -shift)];
        let parts = if shift == 0.0 { &parts[..1] } else { &parts[..] };
        let mut start = vec![0usize; n + 1];
        for (matrix, _) in parts {
            for j in 0..n {
                let pj = inverse[j];
                for &i in &matrix.rows()[matrix.col_starts()[j]..matrix.col_starts()[j + 1]] {
                    start[inverse[i].min(pj) as usize + 1] += 1;
                }
            }
        }
        for j in 0..n {
            start[j + 1] += start[j];
        }
        let mut at = start.clone();
        let mut row = vec![0u32; start[n]];
        let mut value = vec![0.0; start[n]];
        for &(matrix, factor) in parts {
            for j in 0..n {
                let pj = inverse[j];
                for (i, v) in matrix.column(j) {
                    let pi = inverse[i];
                    let slot = &mut at[pi.min(pj) as usize];
                    row[*slot] = pi.max(pj);
                    value[*slot] = factor * v;
                    *slot += 1;
                }
            }
        }
        Ok(Self { start, row, value })
    }
}

/// Where a factor that is kept goes; slices of consecutive supernodes.
struct Store<'a> {
    panels: &'a mut [f64],
    diagonal: &'a mut [f64],
    off: &'a mut [f64],
    from: &'a mut [u32],
}

impl<'a> Store<'a> {
    /// Takes the first `entries` of the panels and `columns` of the pivots.
    fn take(&mut self, entries: usize, columns: usize) -> Store<'a> {
        let columns = columns.min(self.diagonal.len());
        Store {
            panels: split(&mut self.panels, entries),
            diagonal: split(&mut self.diagonal, columns),
            off: split(&mut self.off, columns),
            from: split(&mut self.from, columns),
        }
    }
}

fn split<'a, T>(slice: &mut &'a mut [T], at: usize) -> &'a mut [T] {
    let (head, tail) = std::mem::take(slice).split_at_mut(at);
    *slice = tail;
    head
}

/// State of one worker: children's updates waiting for their parent, and memory to reuse.
struct Worker<'a> {
    analysis: &'a Analysis,
    lower: &'a Lower,
    pivoting: Pivoting,
    /// Update matrices by supernode.
    waiting: Vec<(usize, Vec<f64>)>,
    local: Vec<u32>,
    scratch: Scratch,
    spare: Vec<Vec<f64>>,
    panel: Vec<f64>,
    pivots: (Vec<f64>, Vec<f64>, Vec<u32>),
    inertia: Inertia,
}

fn run(
    analysis: &Analysis,
    lower: &Lower,
    pivoting: Pivoting,
    mut store: Option<Store<'_>>,
) -> Result<Inertia, FactorError> {
    let mut jobs = Vec::with_capacity(analysis.tasks.len());
    for task in &analysis.tasks {
        let entries = analysis.panel_start[task.end] - analysis.panel_start[task.start];
        let columns = (analysis.first[task.end] - analysis.first[task.start]) as usize;
        jobs.push((task.clone(), store.as_mut().map(|s| s.take(entries, columns))));
    }
    let done: Vec<Result<Worker<'_>, FactorError>> = jobs
        .into_par_iter()
        .map(|(task, mut store)| {
            let mut worker = Worker::new(analysis, lower, pivoting);
            for s in task {
                worker.supernode(s, store.as_mut(), Par::Seq)?;
            }
            worker.spare.clear();
            Ok(worker)
        })
        .collect();
    let mut worker = Worker::new(analysis, lower, pivoting);
    for part in done {
        let part = part?;
        worker.waiting.extend(part.waiting);
        worker.inertia.negative += part.inertia.negative;
        worker.inertia.growth = worker.inertia.growth.max(part.inertia.growth);
    }
    let threads = rayon::current_num_threads();
    for s in analysis.top..analysis.supernodes() {
        let width = analysis.columns(s).len();
        let work = super::tree::front_flops(width, analysis.below(s).len());
        let par = if threads > 1 && work > PARALLEL_FRONT { Par::rayon(threads) } else { Par::Seq };
        worker.supernode(s, store.as_mut(), par)?;
    }
    Ok(worker.inertia)
}

impl<'a> Worker<'a> {
    fn new(analysis: &'a Analysis, lower: &'a Lower, pivoting: Pivoting) -> Self {
        Self {
            analysis,
            lower,
            pivoting,
            waiting: Vec::new(),
            local: vec![0; analysis.order],
            scratch: Scratch::default(),
            spare: Vec::new(),
            panel: Vec::new(),
            pivots: Default::default(),
            inertia: Inertia { negative: 0, growth: 1.0 },
        }
    }

    /// Assembles and eliminates one supernode.
    fn supernode(&mut self, s: usize, store: Option<&mut Store<'_>>, par: Par) -> Result<(), FactorError> {
        let analysis = self.analysis;
        let columns = analysis.columns(s);
        let below = analysis.below(s);
        let (width, height) = (columns.len(), columns.len() + below.len());
        let keeps = store.is_some();
        let mut panel_kept;
        let mut own_panel = std::mem::take(&mut self.panel);
        let mut own_pivots = std::mem::take(&mut self.pivots);
        if !keeps {
            own_panel.clear();
            own_panel.resize(height * width, 0.0);
        }
        if !keeps || self.pivoting == Pivoting::Definite {
            own_pivots.0.resize(width, 0.0);
            own_pivots.1.resize(width, 0.0);
            own_pivots.2.resize(width, 0);
        }
        let panel: &mut [f64];
        let mut pivots;
        if let Some(store) = store {
            panel_kept = store.take(height * width, width);
            panel = panel_kept.panels;
            panel_kept.panels = &mut [];
            pivots = if self.pivoting == Pivoting::Definite {
                Pivots {
                    diagonal: &mut own_pivots.0[..width],
                    off: &mut own_pivots.1[..width],
                    from: &mut own_pivots.2[..width],
                }
            } else {
                Pivots { diagonal: panel_kept.diagonal, off: panel_kept.off, from: panel_kept.from }
            };
        } else {
            panel = &mut own_panel;
            pivots = Pivots {
                diagonal: &mut own_pivots.0[..width],
                off: &mut own_pivots.1[..width],
                from: &mut own_pivots.2[..width],
            };
        }
        for (at, &row) in below.iter().enumerate() {
            self.local[row as usize] = (width + at) as u32;
        }
        for (c, j) in columns.clone().enumerate() {
            let column = &mut panel[c * height..(c + 1) * height];
            for e in self.lower.start[j]..self.lower.start[j + 1] {
                let row = self.lower.row[e] as usize;
                let at = if row < columns.end { row - columns.start } else { self.local[row] as usize };
                column[at] += self.lower.value[e];
            }
        }
        // Children wait at the end of the list; in the top they may be scattered.
        let mut children = Vec::new();
        let mut index = 0;
        while index < self.waiting.len() {
            if analysis.parent[self.waiting[index].0] as usize == s {
                children.push(self.waiting.remove(index));
            } else {
                index += 1;
            }
        }
        let maps: Vec<Vec<u32>> = children
            .iter()
            .map(|(c, _)| {
                let place = |&row: &u32| {
                    let row = row as usize;
                    if row < columns.end { (row - columns.start) as u32 } else { self.local[row] }
                };
                analysis.below(*c).iter().map(place).collect()
            })
            .collect();
        for ((_, update), map) in children.iter().zip(&maps) {
            let inside = map.partition_point(|&at| (at as usize) < width);
            for c in 0..inside {
                let target = &mut panel[map[c] as usize * height..(map[c] as usize + 1) * height];
                scatter_add(target, 0, &update[c * map.len() + c..(c + 1) * map.len()], &map[c..]);
            }
        }
        let under = below.len();
        let mut update = self.spare.pop().unwrap_or_default();
        update.resize((under * under).max(update.len()), 0.0);
        let outcome =
            eliminate(panel, width, &mut update[..under * under], self.pivoting, &mut pivots, &mut self.scratch, par)
                .map_err(|e| e.at(|local| analysis.perm[columns.start + local] as usize))?;
        self.inertia.negative += outcome.negative;
        self.inertia.growth = self.inertia.growth.max(outcome.largest);
        for ((_, child), map) in children.iter().zip(&maps) {
            let inside = map.partition_point(|&at| (at as usize) < width);
            for c in inside..map.len() {
                let column = map[c] as usize - width;
                let target = &mut update[column * under..(column + 1) * under];
                scatter_add(target, width, &child[c * map.len() + c..(c + 1) * map.len()], &map[c..]);
            }
        }
        self.spare.extend(children.into_iter().map(|c| c.1));
        if analysis.parent[s] == NONE {
            self.spare.push(update);
        } else {
            self.waiting.push((s, update));
        }
        self.panel = own_panel;
        self.pivots = own_pivots;
        Ok(())
    }
}

/// `target[map[i] - offset] += source[i]`, run by run: the rows of a node stay together.
fn scatter_add(target: &mut [f64], offset: usize, source: &[f64], map: &[u32]) {
    let mut i = 0;
    while i < source.len() {
        let begin = i;
        let at = map[i] as usize - offset;
        i += 1;
        while i < source.len() && map[i] as usize == at + offset + (i - begin) {
            i += 1;
        }
        target[at..at + i - begin].iter_mut().zip(&source[begin..i]).for_each(|(t, s)| *t += s);
    }
}

//! Forward and backward substitution with a block of right-hand sides.

use super::factor::ShiftedFactor;
use super::front::Pivoting;
use super::vectorised::{Kernel, fma, vectorised};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Columns of the factor worked on together: their products fill the registers.
const STRIP: usize = 8;

/// Rows of P right-hand sides side by side: row i of the block is `[f64; P]`.
type Rows<const P: usize> = [[f64; P]];

impl ShiftedFactor {
    /// X ← (K − σM)⁻¹ X, n×p.
    pub fn solve_in_place(&self, rhs: &mut DMatrix<f64>) {
        let n = self.analysis.order;
        let mut begin = 0;
        while begin < rhs.ncols() {
            let columns = match rhs.ncols() - begin {
                1 => 1,
                2..=4 => rhs.ncols() - begin,
                rest => rest.min(8),
            };
            let part = &mut rhs.as_mut_slice()[begin * n..(begin + columns) * n];
            match columns {
                1 => self.solve_columns::<1>(part),
                2..=4 => self.solve_columns::<4>(part),
                _ => self.solve_columns::<8>(part),
            }
            begin += columns;
        }
    }

    fn solve_columns<const P: usize>(&self, columns: &mut [f64]) {
        let n = self.analysis.order;
        let mut block = vec![[0.0; P]; n];
        for (c, column) in columns.chunks_exact(n).enumerate() {
            self.analysis.perm.iter().zip(&mut block).for_each(|(&old, row)| row[c] = column[old as usize]);
        }
        self.solve_block(&mut block);
        for (c, column) in columns.chunks_exact_mut(n).enumerate() {
            self.analysis.perm.iter().zip(&block).for_each(|(&old, row)| column[old as usize] = row[c]);
        }
    }

    /// The same for rows in the factor's order. Subtrees are solved side by side; what they add to
    /// the rows of the top is collected per subtree and summed in a fixed order, so that the
    /// result does not depend on the number of threads.
    pub(super) fn solve_block<const P: usize>(&self, x: &mut Rows<P>) {
        let analysis = &*self.analysis;
        let (mut inside, top) = x.split_at_mut(analysis.top_row());
        let mut jobs = Vec::with_capacity(analysis.tasks.len());
        for task in &analysis.tasks {
            let rows = (analysis.first[task.end] - analysis.first[task.start]) as usize;
            let (head, tail) = inside.split_at_mut(rows);
            inside = tail;
            jobs.push((task.clone(), head));
        }
        let added: Vec<Vec<[f64; P]>> = jobs
            .par_iter_mut()
            .map(|(task, rows)| {
                let mut beyond = vec![[0.0; P]; top.len()];
                let base = analysis.first[task.start] as usize;
                let mut view = View { own: rows, base, beyond: &mut beyond, split: analysis.top_row() };
                let mut gathered = Vec::new();
                for s in task.clone() {
                    self.forward(s, &mut view, &mut gathered);
                }
                beyond
            })
            .collect();
        for part in &added {
            for (row, add) in top.iter_mut().zip(part) {
                (0..P).for_each(|q| row[q] += add[q]);
            }
        }
        drop(added);
        let base = analysis.top_row();
        let mut gathered = Vec::new();
        let mut none: [[f64; P]; 0] = [];
        let mut view = View { own: top, base, beyond: &mut none, split: analysis.order };
        for s in analysis.top..analysis.supernodes() {
            self.forward(s, &mut view, &mut gathered);
        }
        for s in (analysis.top..analysis.supernodes()).rev() {
            let (below, columns) = (analysis.below(s), analysis.columns(s));
            gathered.clear();
            gathered.extend(below.iter().map(|&r| view.own[r as usize - base]));
            self.backward(s, &mut view.own[columns.start - base..columns.end - base], &gathered);
        }
        let top: &Rows<P> = view.own;
        jobs.par_iter_mut().for_each(|(task, rows)| {
            let begin = analysis.first[task.start] as usize;
            let mut gathered = Vec::new();
            for s in task.clone().rev() {
                let (below, columns) = (analysis.below(s), analysis.columns(s));
                gathered.clear();
                gathered.extend(below.iter().map(|&r| match (r as usize).checked_sub(base) {
                    Some(at) => top[at],
                    None => rows[r as usize - begin],
                }));
                self.backward(s, &mut rows[columns.start - begin..columns.end - begin], &gathered);
            }
        });
    }

    /// y ← B⁻¹ L₁₁⁻¹ y on the supernode's rows, and −L₂₁ (L₁₁⁻¹ y) added below.
    fn forward<const P: usize>(&self, s: usize, view: &mut View<'_, P>, gathered: &mut Vec<[f64; P]>) {
        let analysis = &*self.analysis;
        let columns = analysis.columns(s);
        let panel = &self.panels[analysis.panel_start[s]..analysis.panel_start[s + 1]];
        let own = &mut view.own[columns.start - view.base..columns.end - view.base];
        let indefinite = self.pivoting == Pivoting::Indefinite;
        if indefinite {
            gathered.clear();
            gathered.extend(self.from[columns.clone()].iter().map(|&f| own[f as usize]));
            own.copy_from_slice(gathered);
        }
        let below = analysis.below(s);
        gathered.clear();
        gathered.resize(below.len(), [0.0; P]);
        vectorised(Forward { panel, own: &mut *own, below: &mut *gathered, unit: indefinite });
        if indefinite {
            divide_pivots(own, &self.diagonal[columns.clone()], &self.off[columns]);
        }
        for (&row, add) in below.iter().zip(gathered.iter()) {
            let target = view.row(row as usize);
            (0..P).for_each(|q| target[q] += add[q]);
        }
    }

    /// x ← L₁₁⁻ᵀ (y − L₂₁ᵀ x_below).
    fn backward<const P: usize>(&self, s: usize, own: &mut Rows<P>, below: &Rows<P>) {
        let analysis = &*self.analysis;
        let panel = &self.panels[analysis.panel_start[s]..analysis.panel_start[s + 1]];
        let indefinite = self.pivoting == Pivoting::Indefinite;
        vectorised(Backward { panel, own: &mut *own, below, unit: indefinite });
        if indefinite {
            let sorted: Vec<[f64; P]> = own.to_vec();
            for (&f, row) in self.from[analysis.columns(s)].iter().zip(sorted) {
                own[f as usize] = row;
            }
        }
    }
}

/// The rows one worker may write: its own run and a private copy of the rows above.
struct View<'a, const P: usize> {
    own: &'a mut Rows<P>,
    base: usize,
    beyond: &'a mut Rows<P>,
    split: usize,
}

impl<const P: usize> View<'_, P> {
    fn row(&mut self, row: usize) -> &mut [f64; P] {
        if row >= self.split { &mut self.beyond[row - self.split] } else { &mut self.own[row - self.base] }
    }
}

/// y ← B⁻¹ y.
fn divide_pivots<const P: usize>(y: &mut Rows<P>, diagonal: &[f64], off: &[f64]) {
    let mut c = 0;
    while c < y.len() {
        if off[c] == 0.0 {
            (0..P).for_each(|q| y[c][q] /= diagonal[c]);
            c += 1;
        } else {
            let (p, r) = (diagonal[c] / off[c], diagonal[c + 1] / off[c]);
            let scale = 1.0 / (off[c] * (p * r - 1.0));
            for q in 0..P {
                let (u, v) = (y[c][q], y[c + 1][q]);
                y[c][q] = (r * u - v) * scale;
                y[c + 1][q] = (p * v - u) * scale;
            }
            c += 2;
        }
    }
}

struct Forward<'a, const P: usize> {
    panel: &'a [f64],
    own: &'a mut Rows<P>,
    below: &'a mut Rows<P>,
    unit: bool,
}

impl<const P: usize> Kernel for Forward<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let width = self.own.len();
        let height = width + self.below.len();
        let mut c = 0;
        while c < width {
            let strip = STRIP.min(width - c);
            let mut y = [[0.0; P]; STRIP];
            for k in 0..strip {
                let column = &self.panel[(c + k) * height..(c + k + 1) * height];
                let mut solved = self.own[c + k];
                if !self.unit {
                    let inverse = 1.0 / column[c + k];
                    (0..P).for_each(|q| solved[q] *= inverse);
                }
                self.own[c + k] = solved;
                for i in k + 1..strip {
                    let l = -column[c + i];
                    (0..P).for_each(|q| self.own[c + i][q] = fma::<FMA>(l, solved[q], self.own[c + i][q]));
                }
                y[k] = solved;
            }
            let (_, rest) = self.own.split_at_mut(c + strip);
            if strip == STRIP {
                let columns: [&[f64]; STRIP] =
                    std::array::from_fn(|k| &self.panel[(c + k) * height + c + strip..(c + k + 1) * height]);
                let (inner, outer) = (rest.len(), self.below.len());
                axpy_strip::<P, FMA>(rest, std::array::from_fn(|k| &columns[k][..inner]), &y);
                axpy_strip::<P, FMA>(self.below, std::array::from_fn(|k| &columns[k][inner..inner + outer]), &y);
            } else {
                for k in 0..strip {
                    let column = &self.panel[(c + k) * height + c + strip..(c + k + 1) * height];
                    for (row, &l) in rest.iter_mut().chain(self.below.iter_mut()).zip(column) {
                        (0..P).for_each(|q| row[q] = fma::<FMA>(-l, y[k][q], row[q]));
                    }
                }
            }
            c += strip;
        }
    }
}

/// rows −= Σ_k column_k y_k.
#[inline(always)]
fn axpy_strip<const P: usize, const FMA: bool>(rows: &mut Rows<P>, columns: [&[f64]; STRIP], y: &[[f64; P]; STRIP]) {
    let count = rows.len();
    let columns: [&[f64]; STRIP] = std::array::from_fn(|k| &columns[k][..count]);
    for i in 0..count {
        let mut sum = rows[i];
        for k in 0..STRIP {
            let l = -columns[k][i];
            for q in 0..P {
                sum[q] = fma::<FMA>(l, y[k][q], sum[q]);
            }
        }
        rows[i] = sum;
    }
}

struct Backward<'a, const P: usize> {
    panel: &'a [f64],
    own: &'a mut Rows<P>,
    below: &'a Rows<P>,
    unit: bool,
}

impl<const P: usize> Kernel for Backward<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let width = self.own.len();
        let height = width + self.below.len();
        let mut end = width;
        while end > 0 {
            // The odd strip is the last one, as in the forward sweep.
            let strip = if end.is_multiple_of(STRIP) { STRIP } else { end % STRIP };
            let c = end - strip;
            let mut sum = [[0.0; P]; STRIP];
            let (head, rest) = self.own.split_at_mut(end);
            if strip == STRIP {
                let columns: [&[f64]; STRIP] =
                    std::array::from_fn(|k| &self.panel[(c + k) * height + end..(c + k + 1) * height]);
                let (inner, outer) = (rest.len(), self.below.len());
                dot_strip::<P, FMA>(rest, std::array::from_fn(|k| &columns[k][..inner]), &mut sum);
                dot_strip::<P, FMA>(self.below, std::array::from_fn(|k| &columns[k][inner..inner + outer]), &mut sum);
            } else {
                for k in 0..strip {
                    let column = &self.panel[(c + k) * height + end..(c + k + 1) * height];
                    for (row, &l) in rest.iter().chain(self.below).zip(column) {
                        (0..P).for_each(|q| sum[k][q] = fma::<FMA>(l, row[q], sum[k][q]));
                    }
                }
            }
            for k in (0..strip).rev() {
                let column = &self.panel[(c + k) * height..(c + k + 1) * height];
                let mut solved = [0.0; P];
                (0..P).for_each(|q| solved[q] = head[c + k][q] - sum[k][q]);
                for i in k + 1..strip {
                    let l = -column[c + i];
                    (0..P).for_each(|q| solved[q] = fma::<FMA>(l, head[c + i][q], solved[q]));
                }
                if !self.unit {
                    let inverse = 1.0 / column[c + k];
                    (0..P).for_each(|q| solved[q] *= inverse);
                }
                head[c + k] = solved;
            }
            end = c;
        }
    }
}

/// sum_k += Σ_i column_k[i] row_i.
#[inline(always)]
fn dot_strip<const P: usize, const FMA: bool>(rows: &Rows<P>, columns: [&[f64]; STRIP], sum: &mut [[f64; P]; STRIP]) {
    let count = rows.len();
    let columns: [&[f64]; STRIP] = std::array::from_fn(|k| &columns[k][..count]);
    let mut s = *sum;
    for i in 0..count {
        let row = rows[i];
        for k in 0..STRIP {
            let l = columns[k][i];
            for q in 0..P {
                s[k][q] = fma::<FMA>(l, row[q], s[k][q]);
            }
        }
    }
    *sum = s;
}

//! Symbolic factorisation: supernodes, their rows, and subtrees that can be worked on side by side.

use super::graph::NodeGraph;
use super::ordering::cheapest;
use super::supernodes::{Assembly, amalgamate};
use super::tree::{NONE, inverse};
use super::{FactorError, SymSparse};
use std::ops::Range;

/// Everything about the factor of K − σM that does not depend on σ; n rows, s supernodes.
///
/// Supernodes are numbered so that independent subtrees come first, each in one run (`tasks`),
/// and the rest of the tree (`top`) last; children always before parents. The partition depends
/// on the matrix only, so results do not depend on the number of threads.
#[derive(Debug)]
pub struct Analysis {
    pub(super) order: usize,
    /// New row → old row.
    pub(super) perm: Vec<u32>,
    /// Old row → new row.
    pub(super) inverse: Vec<u32>,
    /// First column of each supernode; s + 1 long.
    pub(super) first: Vec<u32>,
    /// Rows under each supernode's columns, ascending: `rows[row_start[s]..row_start[s + 1]]`.
    pub(super) row_start: Vec<usize>,
    pub(super) rows: Vec<u32>,
    /// Parent supernode; `NONE` at roots.
    pub(super) parent: Vec<u32>,
    /// Where each supernode's panel starts in the factor; s + 1 long.
    pub(super) panel_start: Vec<usize>,
    /// Runs of supernodes that touch each other nowhere.
    pub(super) tasks: Vec<Range<usize>>,
    /// First supernode above the tasks.
    pub(super) top: usize,
    flops: f64,
    ordering: &'static str,
}

impl Analysis {
    /// Orders and analyses the union of the patterns of K and M. `group` names the node of each
    /// row (labels 0, 1, …) where known; it makes the ordering faster and seldom worse.
    ///
    /// # Errors
    /// [`FactorError::OrderMismatch`] and [`FactorError::Empty`].
    pub fn new(k: &SymSparse, m: &SymSparse, group: Option<&[u32]>) -> Result<Self, FactorError> {
        if k.order() != m.order() {
            return Err(FactorError::OrderMismatch { stiffness: k.order(), mass: m.order() });
        }
        if k.order() == 0 {
            return Err(FactorError::Empty);
        }
        let graph = NodeGraph::new(k, m, group);
        let (tree, ordering) = cheapest(&graph);
        let assembly = amalgamate(&graph, &tree);
        Ok(Self::number(&graph, &tree.order, &assembly, ordering))
    }

    /// Number of rows n.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Entries of the factor that are stored.
    pub fn factor_entries(&self) -> usize {
        self.panel_start.last().copied().unwrap_or(0)
    }

    /// Multiply–add operations of one factorisation.
    pub fn flops(&self) -> f64 {
        self.flops
    }

    /// Name of the ordering chosen.
    pub fn ordering(&self) -> &'static str {
        self.ordering
    }

    /// Number of supernodes.
    pub(super) fn supernodes(&self) -> usize {
        self.first.len() - 1
    }

    /// Columns of a supernode.
    pub(super) fn columns(&self, s: usize) -> Range<usize> {
        self.first[s] as usize..self.first[s + 1] as usize
    }

    /// Rows below a supernode's columns.
    pub(super) fn below(&self, s: usize) -> &[u32] {
        &self.rows[self.row_start[s]..self.row_start[s + 1]]
    }

    /// Columns that belong to the tasks; the top starts here.
    pub(super) fn top_row(&self) -> usize {
        self.first[self.top] as usize
    }

    /// Turns the assembly tree into final numbers: tasks first, then the top.
    fn number(graph: &NodeGraph, order: &[u32], assembly: &Assembly, ordering: &'static str) -> Self {
        let (sequence, task_lengths, top) = assembly.sequence();
        let count = sequence.len();
        let place = inverse(&sequence);
        let parent: Vec<u32> = sequence
            .iter()
            .map(|&s| match assembly.parent[s as usize] {
                NONE => NONE,
                p => place[p as usize],
            })
            .collect();
        let mut tasks = Vec::new();
        let mut begin = 0;
        for length in task_lengths {
            tasks.push(begin..begin + length);
            begin += length;
        }
        // Vertices and rows in final order.
        let mut vertex_position = vec![0u32; graph.vertices()];
        let mut vertex_at = Vec::with_capacity(graph.vertices());
        let mut vertex_first = Vec::with_capacity(count + 1);
        let mut row_of_vertex = Vec::with_capacity(graph.vertices() + 1);
        let mut perm = Vec::with_capacity(graph.member.len());
        let mut first = Vec::with_capacity(count + 1);
        for &s in &sequence {
            vertex_first.push(vertex_at.len());
            first.push(perm.len() as u32);
            for &p in &assembly.members[s as usize] {
                let v = order[p as usize];
                vertex_position[v as usize] = vertex_at.len() as u32;
                vertex_at.push(v);
                row_of_vertex.push(perm.len() as u32);
                perm.extend_from_slice(graph.members(v as usize));
            }
        }
        vertex_first.push(vertex_at.len());
        first.push(perm.len() as u32);
        row_of_vertex.push(perm.len() as u32);

        let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
        for s in 0..count {
            if parent[s] != NONE {
                children[parent[s] as usize].push(s as u32);
            }
        }
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut mark = vec![NONE; vertex_at.len()];
        let mut row_start = vec![0usize];
        let mut rows: Vec<u32> = Vec::new();
        let mut panel_start = vec![0usize];
        for s in 0..count {
            let end = vertex_first[s + 1] as u32;
            let mut list = Vec::new();
            let mut add = |v: u32| {
                if v >= end && mark[v as usize] != s as u32 {
                    mark[v as usize] = s as u32;
                    list.push(v);
                }
            };
            for p in vertex_first[s]..vertex_first[s + 1] {
                graph.neighbours(vertex_at[p] as usize).iter().for_each(|&u| add(vertex_position[u as usize]));
            }
            for &c in &children[s] {
                std::mem::take(&mut lists[c as usize]).into_iter().for_each(&mut add);
            }
            list.sort_unstable();
            for &v in &list {
                rows.extend(row_of_vertex[v as usize]..row_of_vertex[v as usize + 1]);
            }
            row_start.push(rows.len());
            let width = (first[s + 1] - first[s]) as usize;
            let height = width + row_start[s + 1] - row_start[s];
            panel_start.push(panel_start[s] + width * height);
            lists[s] = list;
        }
        let flops = assembly.flops.iter().sum();
        Self {
            order: perm.len(),
            inverse: inverse(&perm),
            perm,
            first,
            row_start,
            rows,
            parent,
            panel_start,
            tasks,
            top,
            flops,
            ordering,
        }
    }
}

//! Elimination tree of an ordered graph, and the fill and work an ordering costs.

use super::graph::NodeGraph;

/// No parent.
pub(super) const NONE: u32 = u32::MAX;

/// The elimination tree of a graph whose vertices are eliminated in a postorder (Davis, Direct
/// Methods for Sparse Linear Systems, ch. 4).
pub(super) struct EliminationTree {
    /// New position → vertex; postordered.
    pub(super) order: Vec<u32>,
    /// Parent of each position; `NONE` at roots.
    pub(super) parent: Vec<u32>,
    /// Rows below the diagonal block of each position, counted in matrix rows.
    pub(super) below: Vec<usize>,
}

impl EliminationTree {
    /// Builds the tree for the order given and replaces the order by an equivalent postorder.
    pub(super) fn new(graph: &NodeGraph, order: &[u32]) -> Self {
        let n = graph.vertices();
        let parent = parents(graph, order, &inverse(order));
        let post = postorder(&parent);
        let order: Vec<u32> = post.iter().map(|&p| order[p as usize]).collect();
        let position = inverse(&order);
        let relabel = inverse(&post);
        let mut renamed = vec![NONE; n];
        for v in 0..n {
            if parent[v] != NONE {
                renamed[relabel[v] as usize] = relabel[parent[v] as usize];
            }
        }
        let mut below = vec![0usize; n];
        let mut mark = vec![NONE; n];
        for i in 0..n {
            mark[i] = i as u32;
            let weight = graph.weight(order[i] as usize);
            for &u in graph.neighbours(order[i] as usize) {
                let mut j = position[u as usize] as usize;
                while j < i && mark[j] != i as u32 {
                    mark[j] = i as u32;
                    below[j] += weight;
                    j = renamed[j] as usize;
                }
            }
        }
        Self { order, parent: renamed, below }
    }

    /// Multiplications and additions of a Cholesky factorisation.
    pub(super) fn flops(&self, graph: &NodeGraph) -> f64 {
        self.order.iter().zip(&self.below).map(|(&v, &below)| front_flops(graph.weight(v as usize), below)).sum()
    }
}

/// Operations of eliminating `width` columns with `below` rows under them: Σ (below + i)².
pub(super) fn front_flops(width: usize, below: usize) -> f64 {
    let (w, b) = (width as f64, below as f64);
    w * b * b + b * w * w + w * w * w / 3.0
}

pub(super) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut position = vec![0u32; order.len()];
    for (p, &v) in order.iter().enumerate() {
        position[v as usize] = p as u32;
    }
    position
}

/// Liu's algorithm with path compression.
fn parents(graph: &NodeGraph, order: &[u32], position: &[u32]) -> Vec<u32> {
    let n = order.len();
    let mut parent = vec![NONE; n];
    let mut ancestor = vec![NONE; n];
    for i in 0..n {
        for &u in graph.neighbours(order[i] as usize) {
            let mut j = position[u as usize];
            while (j as usize) < i {
                let above = ancestor[j as usize];
                ancestor[j as usize] = i as u32;
                if above == NONE {
                    parent[j as usize] = i as u32;
                    break;
                }
                j = above;
            }
        }
    }
    parent
}

/// Children before parents, each subtree contiguous; without recursion, since trees may be deep.
pub(super) fn postorder(parent: &[u32]) -> Vec<u32> {
    let n = parent.len();
    let mut first_child = vec![NONE; n];
    let mut sibling = vec![NONE; n];
    for v in (0..n).rev() {
        if parent[v] != NONE {
            sibling[v] = first_child[parent[v] as usize];
            first_child[parent[v] as usize] = v as u32;
        }
    }
    let mut order = Vec::with_capacity(n);
    let mut stack = Vec::new();
    for root in (0..n).filter(|&v| parent[v] == NONE) {
        stack.push(root as u32);
        while let Some(&v) = stack.last() {
            let child = first_child[v as usize];
            if child == NONE {
                order.push(v);
                stack.pop();
            } else {
                first_child[v as usize] = sibling[child as usize];
                stack.push(child);
            }
        }
    }
    order
}

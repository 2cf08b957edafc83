//! Supernodes: columns with (nearly) the same rows, eliminated together as one dense front.

use super::graph::NodeGraph;
use super::tree::{EliminationTree, NONE, front_flops, postorder};

/// Share of the work above which a subtree is split further before it becomes a task of its own.
const TASK_SHARE: f64 = 1.0 / 24.0;
/// Operations below which a whole tree is one task: threads would cost more than they give.
const TASK_WORTH: f64 = 2e7;

/// The tree of merged supernodes.
pub(super) struct Assembly {
    /// Elimination positions of each supernode, ascending.
    pub(super) members: Vec<Vec<u32>>,
    /// Parent supernode; `NONE` at roots.
    pub(super) parent: Vec<u32>,
    /// Operations of each front.
    pub(super) flops: Vec<f64>,
}

/// Zeros accepted in a merged supernode of a given width, as a share of its entries (the scheme of
/// CHOLMOD's relaxed amalgamation; the numbers fit fronts of three rows per vertex).
fn accepted(width: usize) -> f64 {
    match width {
        0..=16 => 0.8,
        17..=48 => 0.3,
        49..=128 => 0.12,
        _ => 0.05,
    }
}

/// Finds columns with equal rows, then merges children into parents while that adds few zeros.
pub(super) fn amalgamate(graph: &NodeGraph, tree: &EliminationTree) -> Assembly {
    let n = tree.order.len();
    let weight = |p: usize| graph.weight(tree.order[p] as usize);
    let mut of = vec![0u32; n];
    let mut start: Vec<usize> = Vec::new();
    for p in 0..n {
        let joins = p > 0 && tree.parent[p - 1] == p as u32 && tree.below[p - 1] == tree.below[p] + weight(p);
        if !joins {
            start.push(p);
        }
        of[p] = start.len() as u32 - 1;
    }
    start.push(n);
    let count = start.len() - 1;
    let mut width = vec![0usize; count];
    let mut below = vec![0usize; count];
    let mut zeros = vec![0usize; count];
    let mut members: Vec<Vec<u32>> = Vec::with_capacity(count);
    let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
    let mut dead = vec![false; count];
    for s in 0..count {
        let last = start[s + 1] - 1;
        width[s] = (start[s]..=last).map(weight).sum();
        below[s] = tree.below[last];
        members.push((start[s] as u32..=last as u32).collect());
        // Children of s come before s in the postorder, so they are final by now.
        let mut kept = Vec::new();
        for c in std::mem::take(&mut children[s]) {
            let child = c as usize;
            let joint = width[child] + width[s];
            let new = zeros[child] + zeros[s] + width[child] * (width[s] + below[s] - below[child]);
            let entries = joint * (joint + 1) / 2 + joint * below[s];
            if (new as f64) <= accepted(joint) * entries as f64 {
                width[s] = joint;
                zeros[s] = new;
                dead[child] = true;
                let inner = std::mem::take(&mut members[child]);
                members[s].extend(inner);
                kept.append(&mut children[child]);
            } else {
                kept.push(c);
            }
        }
        children[s] = kept;
        if tree.parent[last] != NONE {
            children[of[tree.parent[last] as usize] as usize].push(s as u32);
        }
    }
    let mut alive = Vec::new();
    let mut renamed = vec![NONE; count];
    for s in (0..count).filter(|&s| !dead[s]) {
        renamed[s] = alive.len() as u32;
        alive.push(s);
    }
    let mut assembly = Assembly { members: Vec::new(), parent: vec![NONE; alive.len()], flops: Vec::new() };
    for &s in &alive {
        let mut list = std::mem::take(&mut members[s]);
        list.sort_unstable();
        assembly.members.push(list);
        assembly.flops.push(front_flops(width[s], below[s]));
        for &c in &children[s] {
            assembly.parent[renamed[c as usize] as usize] = renamed[s];
        }
    }
    assembly
}

impl Assembly {
    /// The supernodes in their final sequence, the lengths of the tasks at its head, and where the
    /// top begins. A task is a run of whole subtrees worth about `TASK_SHARE` of the work.
    pub(super) fn sequence(&self) -> (Vec<u32>, Vec<usize>, usize) {
        let post = postorder(&self.parent);
        let mut subtree = self.flops.clone();
        for &s in &post {
            if self.parent[s as usize] != NONE {
                subtree[self.parent[s as usize] as usize] += subtree[s as usize];
            }
        }
        let total: f64 = self.flops.iter().sum();
        let share = if total < TASK_WORTH { f64::INFINITY } else { total * TASK_SHARE };
        let mut sequence = Vec::with_capacity(post.len());
        let mut top = Vec::new();
        let mut lengths = Vec::new();
        let (mut begin, mut work) = (0usize, 0.0);
        for &s in &post {
            if subtree[s as usize] > share {
                top.push(s);
                continue;
            }
            sequence.push(s);
            let is_root = match self.parent[s as usize] {
                NONE => true,
                p => subtree[p as usize] > share,
            };
            if is_root {
                work += subtree[s as usize];
                if work > 0.5 * share {
                    lengths.push(sequence.len() - begin);
                    (begin, work) = (sequence.len(), 0.0);
                }
            }
        }
        if sequence.len() > begin {
            lengths.push(sequence.len() - begin);
        }
        let tasks = sequence.len();
        sequence.extend(top);
        (sequence, lengths, tasks)
    }
}

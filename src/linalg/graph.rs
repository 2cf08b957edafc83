//! The graph of K and M with the rows of one node merged.

use super::SymSparse;

/// Which rows are coupled, node by node: rows that belong together (the dofs of one FE node) are
/// one vertex. Ordering vertices instead of rows gives the same fill in a fraction of the time.
pub(super) struct NodeGraph {
    /// Neighbours of vertex v, ascending, without v: `next[start[v]..start[v + 1]]`.
    pub(super) start: Vec<usize>,
    pub(super) next: Vec<u32>,
    /// Rows of vertex v: `member[member_start[v]..member_start[v + 1]]`.
    pub(super) member_start: Vec<usize>,
    pub(super) member: Vec<u32>,
}

/// Largest growth of the pattern accepted when rows are merged in blocks of equal size. Blocks of
/// three are 3D solids, where exact zeros inside a block are common on regular meshes; blocks of
/// six (shells, beams) must fit closely, else two solid nodes would pass for one.
const BLOCKS: [(usize, f64); 3] = [(6, 1.2), (3, 2.0), (2, 1.5)];

impl NodeGraph {
    /// The graph of the union of both patterns. `group` gives each row's node (any labels 0..g);
    /// without it equal blocks of adjacent rows are tried, then every row stands for itself.
    pub(super) fn new(k: &SymSparse, m: &SymSparse, group: Option<&[u32]>) -> Self {
        let n = k.order();
        if let Some(group) = group {
            return Self::with_groups(k, m, group);
        }
        for (size, growth) in BLOCKS {
            if n.is_multiple_of(size) && n > size {
                let blocks: Vec<u32> = (0..n).map(|i| (i / size) as u32).collect();
                let graph = Self::with_groups(k, m, &blocks);
                let entries = (graph.next.len() + n / size) * size * size;
                if entries as f64 <= growth * k.nonzeros().max(m.nonzeros()) as f64 {
                    return graph;
                }
            }
        }
        let own: Vec<u32> = (0..n as u32).collect();
        Self::with_groups(k, m, &own)
    }

    fn with_groups(k: &SymSparse, m: &SymSparse, group: &[u32]) -> Self {
        let n = k.order();
        let vertices = group.iter().max().map_or(0, |&g| g as usize + 1);
        let mut member_start = vec![0usize; vertices + 1];
        for &g in group {
            member_start[g as usize + 1] += 1;
        }
        for v in 0..vertices {
            member_start[v + 1] += member_start[v];
        }
        let mut at = member_start.clone();
        let mut member = vec![0u32; n];
        for i in 0..n {
            let g = group[i] as usize;
            member[at[g]] = i as u32;
            at[g] += 1;
        }
        // Upper neighbours first, duplicates removed by a mark per vertex; then both directions.
        let mut mark = vec![u32::MAX; vertices];
        let mut above: Vec<(u32, u32)> = Vec::new();
        let mut count = vec![0usize; vertices + 1];
        for v in 0..vertices {
            mark[v] = v as u32;
            for &j in &member[member_start[v]..member_start[v + 1]] {
                for matrix in [k, m] {
                    let (from, to) = (matrix.col_starts()[j as usize], matrix.col_starts()[j as usize + 1]);
                    for &i in &matrix.rows()[from..to] {
                        let u = group[i];
                        if mark[u as usize] != v as u32 {
                            mark[u as usize] = v as u32;
                            above.push((u, v as u32));
                            count[u as usize + 1] += 1;
                            count[v + 1] += 1;
                        }
                    }
                }
            }
        }
        for v in 0..vertices {
            count[v + 1] += count[v];
        }
        let mut fill = count.clone();
        let mut raw = vec![0u32; 2 * above.len()];
        for (u, v) in above {
            for (a, b) in [(u, v), (v, u)] {
                raw[fill[a as usize]] = b;
                fill[a as usize] += 1;
            }
        }
        // An edge may have been met from both ends when groups interleave: sort and drop repeats.
        let mut start = Vec::with_capacity(vertices + 1);
        let mut next = Vec::with_capacity(raw.len());
        start.push(0);
        for v in 0..vertices {
            let list = &mut raw[count[v]..count[v + 1]];
            list.sort_unstable();
            let begin = next.len();
            for &u in list.iter() {
                if next.len() == begin || next.last() != Some(&u) {
                    next.push(u);
                }
            }
            start.push(next.len());
        }
        Self { start, next, member_start, member }
    }

    pub(super) fn vertices(&self) -> usize {
        self.start.len() - 1
    }

    pub(super) fn neighbours(&self, v: usize) -> &[u32] {
        &self.next[self.start[v]..self.start[v + 1]]
    }

    /// Rows of a vertex.
    pub(super) fn members(&self, v: usize) -> &[u32] {
        &self.member[self.member_start[v]..self.member_start[v + 1]]
    }

    /// Number of rows of a vertex.
    pub(super) fn weight(&self, v: usize) -> usize {
        self.member_start[v + 1] - self.member_start[v]
    }
}

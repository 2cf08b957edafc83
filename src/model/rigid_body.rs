//! Mass, centre and inertia of a body, and its six rigid motions.

use super::FeModel;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Mass properties; inertia about the centre of mass, in the model's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    /// kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub centre: [f64; 3],
    /// Inertia tensor about the centre, kg·m².
    pub inertia: Matrix3<f64>,
}

impl RigidBody {
    /// Mass properties of an FE model: rᵀMr for the rigid motions r about the origin, with the
    /// inertia moved to the centre of mass (Steiner). Masses that differ by direction (models with
    /// translations along some axes only) give the largest. `None` without labelled dofs.
    pub fn of(fe: &FeModel) -> Option<Self> {
        let rigid = rigid_motions(fe)?;
        let m = rigid.transpose() * fe.mass.mul_block(&rigid);
        let mass = (0..3).map(|d| m[(d, d)]).fold(0.0, f64::max);
        if mass <= 0.0 {
            return None;
        }
        // The coupling block is m·[c]× : rows translations, columns rotations about the origin.
        let coupling = |i: usize, j: usize| m[(i, 3 + j)] / mass;
        let half = |a: f64, b: f64, wa: f64, wb: f64| if wa + wb > 0.0 { (a * wa + b * wb) / (wa + wb) } else { 0.0 };
        let (mx, my, mz) = (m[(0, 0)], m[(1, 1)], m[(2, 2)]);
        let centre = Vector3::new(
            half(coupling(1, 2), -coupling(2, 1), my, mz),
            half(-coupling(0, 2), coupling(2, 0), mx, mz),
            half(coupling(0, 1), -coupling(1, 0), mx, my),
        );
        let about_origin = m.fixed_view::<3, 3>(3, 3).into_owned();
        // Steiner with the mass of each direction, so that partial models stay consistent.
        let c = centre;
        let steiner = Matrix3::new(
            mz * c.y * c.y + my * c.z * c.z,
            -mz * c.x * c.y,
            -my * c.x * c.z,
            -mz * c.x * c.y,
            mz * c.x * c.x + mx * c.z * c.z,
            -mx * c.y * c.z,
            -my * c.x * c.z,
            -mx * c.y * c.z,
            my * c.x * c.x + mx * c.y * c.y,
        );
        Some(Self { mass, centre: centre.into(), inertia: about_origin - steiner })
    }

    /// Displacement (x y z rx ry rz) of a point for unit mass-normalised rigid coordinates:
    /// 6×r, three translations, then rotations about the principal axes of inertia through the
    /// centre of mass; 1/√kg. Rotations without inertia are left out (a point mass has three).
    pub fn motion_at(&self, point: [f64; 3]) -> DMatrix<f64> {
        let eigen = self.inertia.symmetric_eigen();
        let mut order = [0usize, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let floor = eigen.eigenvalues.amax() * 1e-12;
        let turns: Vec<usize> = order.into_iter().filter(|&d| eigen.eigenvalues[d] > floor).collect();
        let arm = Vector3::from(point) - Vector3::from(self.centre);
        let mut motion = DMatrix::zeros(6, 3 + turns.len());
        for d in 0..3 {
            motion[(d, d)] = 1.0 / self.mass.sqrt();
        }
        for (c, &d) in turns.iter().enumerate() {
            let raw: Vector3<f64> = eigen.eigenvectors.column(d).into_owned();
            // An axis and its opposite are the same eigenvector: make the largest component positive.
            let axis = if raw[raw.iamax()] < 0.0 { -raw } else { raw };
            let turn = axis / eigen.eigenvalues[d].sqrt();
            let shift = turn.cross(&arm);
            for k in 0..3 {
                motion[(k, 3 + c)] = shift[k];
                motion[(3 + k, 3 + c)] = turn[k];
            }
        }
        motion
    }
}

/// The six rigid motions about the origin at every degree of freedom, n×6 (translations x y z, then
/// rotations x y z); `None` without labelled dofs or with a node that has no position.
pub fn rigid_motions(fe: &FeModel) -> Option<DMatrix<f64>> {
    if !fe.dofs.is_labelled() || fe.dofs.is_empty() {
        return None;
    }
    let mut motion = DMatrix::zeros(fe.dofs.len(), 6);
    for (row, dof) in fe.dofs.labels().iter().enumerate() {
        let p = fe.nodes.get(&dof.node)?;
        let d = dof.axis.index();
        motion[(row, d)] = 1.0;
        if !dof.axis.is_rotation() {
            // (e_r × p)_d for the unit turns about x, y, z.
            let turns = [[0.0, -p[2], p[1]], [p[2], 0.0, -p[0]], [-p[1], p[0], 0.0]];
            for (r, turn) in turns.iter().enumerate() {
                motion[(row, 3 + r)] = turn[d];
            }
        }
    }
    Some(motion)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::SymSparse;
    use crate::model::{Axis, Dof, DofMap, NodeId};

    #[test]
    fn point_masses_give_their_textbook_inertia() {
        // Masses 1, 2, 3 kg at three points.
        let points = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.5, 0.0, 3.0]];
        let masses = [1.0, 2.0, 3.0];
        let labels =
            (1..=3).flat_map(|n| Axis::ALL[..3].iter().map(move |&axis| Dof { node: NodeId(n), axis })).collect();
        let entries: Vec<_> = (0..9).map(|k| (k, k, masses[k / 3])).collect();
        let fe = FeModel {
            name: "points".into(),
            nodes: (1..=3).map(NodeId).zip(points).collect(),
            dofs: DofMap::labelled(labels).expect("distinct"),
            stiffness: SymSparse::from_triplets(9, &[]).expect("empty"),
            mass: SymSparse::from_triplets(9, &entries).expect("diagonal"),
            node_sets: Default::default(),
            sources: vec![],
        };
        let body = RigidBody::of(&fe).expect("labelled");
        let total = 6.0;
        let c: Vector3<f64> =
            points.iter().zip(masses).map(|(p, m)| Vector3::from(*p) * m).sum::<Vector3<f64>>() / total;
        let mut inertia = Matrix3::zeros();
        for (p, m) in points.iter().zip(masses) {
            let r = Vector3::from(*p) - c;
            inertia += m * (Matrix3::identity() * r.norm_squared() - r * r.transpose());
        }
        // Sums of a dozen terms of order 10: rounding only.
        assert!((body.mass - total).abs() < 1e-12 && (Vector3::from(body.centre) - c).norm() < 1e-13);
        assert!((body.inertia - inertia).norm() < 1e-12);
        // Mass-normalised motions: kinetic energy of each unit coordinate is one half.
        let motion: Vec<DMatrix<f64>> = points.iter().map(|&p| body.motion_at(p)).collect();
        let mut gram = DMatrix::zeros(6, 6);
        for (g, m) in motion.iter().zip(masses) {
            let t = g.rows(0, 3);
            gram += m * t.transpose() * t;
        }
        assert!((gram - DMatrix::identity(6, 6)).norm() < 1e-12);
    }
}

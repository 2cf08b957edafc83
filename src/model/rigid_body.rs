//! Mass, centre and inertia of a body, and its six rigid motions.

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

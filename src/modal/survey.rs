//! What an FE model holds and what looks suspicious, before any eigen-solution.

use crate::linalg::SymSparse;
use crate::model::{FeModel, RigidBody, rigid_motions};

/// Facts about a model's matrices.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Mass, centre, inertia; `None` without labelled dofs and positions.
    pub rigid: Option<RigidBody>,
    /// Total mass along x, y, z, kg: they differ where nodes lack a direction.
    pub mass_by_axis: Option<[f64; 3]>,
    /// ‖K r‖ / (‖K‖_max ‖r‖) for the rigid motions r (translations x y z, turns x y z about the
    /// centre): rounding of the file for a free body, larger where it is held.
    pub rigid_residual: Option<[f64; 6]>,
    /// Rows of K without any entry.
    pub empty_rows: Vec<usize>,
    /// Rows with stiffness and no mass.
    pub massless_rows: usize,
    /// Rows with a negative diagonal in K or M.
    pub negative_diagonal: Vec<usize>,
    /// What an engineer should look at.
    pub suspicions: Vec<String>,
}

/// A free body's rigid residual is rounding of the file, 1e-6 for six digits; a held one's is the
/// share of the supports.
const HELD: f64 = 1e-5;

/// Surveys a model.
pub fn survey(fe: &FeModel) -> Survey {
    let rigid = RigidBody::of(fe);
    let motions = rigid_motions(fe);
    let mut suspicions = Vec::new();
    let mut residual = None;
    let mut by_axis = None;
    if let (Some(mut r), Some(body)) = (motions, rigid) {
        let total = r.transpose() * fe.mass.mul_block(&r);
        let masses = [total[(0, 0)], total[(1, 1)], total[(2, 2)]];
        by_axis = Some(masses);
        if masses.iter().any(|m| (m - body.mass).abs() > 1e-6 * body.mass) {
            suspicions.push(format!(
                "mass differs by direction ({:.6}, {:.6}, {:.6} kg along x, y, z): directions are held or missing",
                masses[0], masses[1], masses[2]
            ));
        }
        // Turns about the centre rather than the origin, so that a part far from the origin is not
        // judged by its distance.
        for axis in 0..3 {
            let unit = nalgebra::Vector3::ith(axis, 1.0);
            let offset = unit.cross(&nalgebra::Vector3::from(body.centre));
            for d in 0..3 {
                let column = r.column(d).into_owned() * offset[d];
                let mut turn = r.column_mut(3 + axis);
                turn -= column;
            }
        }
        let largest = fe.stiffness.values().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let force = fe.stiffness.mul_block(&r);
        let mut found = [0.0; 6];
        for k in 0..6 {
            let size = r.column(k).norm();
            found[k] = if size > 0.0 && largest > 0.0 { force.column(k).norm() / (largest * size) } else { 0.0 };
        }
        residual = Some(found);
        let held: Vec<&str> =
            ["x", "y", "z", "rx", "ry", "rz"].into_iter().zip(found).filter(|f| f.1 > HELD).map(|f| f.0).collect();
        if !held.is_empty() {
            suspicions.push(format!(
                "K resists rigid motion along {}: the export is constrained, a free-free export is needed for a body that moves",
                held.join(", ")
            ));
        }
        if let Some(speed) = wave_speed(fe) {
            suspicions.extend(unit_suspicion(speed));
        }
    }
    let n = fe.stiffness.order();
    let degree = entries_per_row(&fe.stiffness);
    let (k, m) = (fe.stiffness.diagonal(), fe.mass.diagonal());
    let empty_rows: Vec<usize> = (0..n).filter(|&i| degree[i] == 0 || (degree[i] == 1 && k[i] == 0.0)).collect();
    let negative_diagonal: Vec<usize> = (0..n).filter(|&i| k[i] < 0.0 || m[i] < 0.0).collect();
    let massless_rows = (0..n).filter(|&i| m[i] == 0.0 && k[i] != 0.0).count();
    let name = |rows: &[usize]| {
        let shown: Vec<String> = rows.iter().take(4).map(|&i| fe.dofs.describe(i)).collect();
        let more = if rows.len() > 4 { ", …" } else { "" };
        format!("{}{more}", shown.join(", "))
    };
    if !empty_rows.is_empty() {
        suspicions.push(format!("{} rows of K are empty: {}", empty_rows.len(), name(&empty_rows)));
    }
    if !negative_diagonal.is_empty() {
        suspicions.push(format!(
            "{} rows have a negative diagonal in K or M: {}",
            negative_diagonal.len(),
            name(&negative_diagonal)
        ));
    }
    if massless_rows > 0 {
        suspicions.push(format!("{massless_rows} dofs have stiffness and no mass: M is singular"));
    }
    Survey {
        rigid,
        mass_by_axis: by_axis,
        rigid_residual: residual,
        empty_rows,
        massless_rows,
        negative_diagonal,
        suspicions,
    }
}

fn entries_per_row(a: &SymSparse) -> Vec<usize> {
    let mut count = vec![0; a.order()];
    for j in 0..a.order() {
        for (i, _) in a.column(j) {
            count[i] += 1;
            if i != j {
                count[j] += 1;
            }
        }
    }
    count
}

/// An elastic wave speed the mesh implies, in units of the file per second: the highest frequency of
/// a mesh is about 2c/h, so c ≈ h/2·√max(K_ii/M_ii) with h the least distance of two nodes that
/// follow each other in the file. `None` without nodes.
fn wave_speed(fe: &FeModel) -> Option<f64> {
    let positions: Vec<&[f64; 3]> = fe.nodes.values().collect();
    let spacing = positions
        .windows(2)
        .map(|w| (0..3).map(|d| (w[0][d] - w[1][d]).powi(2)).sum::<f64>().sqrt())
        .filter(|d| *d > 0.0)
        .fold(f64::INFINITY, f64::min);
    let (k, m) = (fe.stiffness.diagonal(), fe.mass.diagonal());
    let square = (0..fe.dofs.len())
        .filter(|&i| m[i] > 0.0 && fe.dofs.labels().get(i).is_some_and(|d| !d.axis.is_rotation()))
        .map(|i| k[i] / m[i])
        .fold(0.0, f64::max);
    (spacing.is_finite() && square > 0.0).then(|| 0.5 * spacing * square.sqrt())
}

/// Engineering solids carry waves at 20 (rubber) to 2e4 m/s (diamond-stiff laminates); the estimate is
/// good to a factor of ten or so.
fn unit_suspicion(speed: f64) -> Option<String> {
    if (1.0..2e5).contains(&speed) {
        return None;
    }
    let guess = if speed >= 2e5 {
        "lengths may be in mm (mm-t-s: set [units] length = \"mm\", mass = \"t\")"
    } else {
        "stiffness may be in larger units than the masses, or lengths in km"
    };
    Some(format!(
        "the matrices imply waves at about {speed:.1e} length units a second, where solids carry 1e2–1e4 m/s: {guess}"
    ))
}

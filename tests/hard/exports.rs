//! Exports of a finite-element program against eigenvalues refined in extended precision.

use super::read::{export, reference};
use ferrom::modal::{ModalOptions, solve};
use ferrom::model::{FeModel, Modes, Origin, Silent};

fn modes_of(stem: &str, mesh: &str, count: usize) -> Modes {
    let fe = export(stem, Some(mesh));
    solve(&fe, &ModalOptions { count, shift: None }, &Silent).expect("modes")
}

/// Largest relative error of the elastic ω².
fn error(modes: &Modes, reference: &[(f64, f64)]) -> f64 {
    (modes.rigid..modes.len().min(reference.len()))
        .map(|c| (modes.omega[c].powi(2) / reference[c].0 - 1.0).abs())
        .fold(0.0, f64::max)
}

/// The residual that rounding the shape to double precision alone leaves: entries φ_j off by a
/// uniform error of half a unit in the last place make errors k_ij δφ_j that add up at random.
fn rounding_floor(fe: &FeModel, modes: &Modes, c: usize) -> f64 {
    let n = fe.dofs.len();
    let phi = modes.shapes.column(c);
    let mut square = vec![0.0; n];
    for j in 0..n {
        for (i, a) in fe.stiffness.column(j) {
            square[i] += (a * phi[j]).powi(2);
            if i != j {
                square[j] += (a * phi[i]).powi(2);
            }
        }
    }
    let force = fe.mass.mul(phi.as_slice()).iter().map(|v| v * v).sum::<f64>().sqrt() * modes.omega[c].powi(2);
    0.29 * f64::EPSILON * square.iter().sum::<f64>().sqrt() / force
}

/// Residuals are 1e-9, or five times what rounding makes unavoidable where that is more.
fn check_residuals(fe: &FeModel, modes: &Modes) {
    for c in modes.rigid..modes.len() {
        let floor = rounding_floor(fe, modes, c);
        let residual = modes.residual[c];
        assert!(residual <= 1e-9 + 5.0 * floor, "mode {}: residual {residual:.1e}, rounding alone {floor:.1e}", c + 1);
    }
}

fn check(name: &str, count: usize, rigid: usize, tolerance: f64) -> Modes {
    let fe = export(&format!("tests/data/hard/{name}"), Some(&format!("tests/data/hard/{name}.mesh")));
    let modes = solve(&fe, &ModalOptions { count, shift: None }, &Silent).expect("modes");
    let worst = error(&modes, &reference(&format!("tests/data/hard/{name}_ref.csv")));
    assert_eq!(modes.rigid, rigid, "{name}: rigid modes");
    assert!(worst <= tolerance, "{name}: error {worst:e}");
    check_residuals(&fe, &modes);
    assert!(modes.orthogonality <= 1e-10, "{name}: orthogonality {:e}", modes.orthogonality);
    assert!(modes.complete.proved, "{name}: {:?} {:?}", modes.complete, modes.warnings);
    assert!(modes.omega[..rigid].iter().all(|&w| w == 0.0));
    assert_eq!(modes.complete.count, modes.len());
    modes
}

#[test]
fn leaf_56_modes() {
    let fe = export("models/leaf-spring/leaf", Some("models/leaf-spring/leaf_mesh.inp"));
    let modes = solve(&fe, &ModalOptions { count: 56, shift: None }, &Silent).expect("modes");
    let worst = error(&modes, &reference("models/leaf-spring/reference/leaf_ref.csv"));
    assert_eq!((modes.len(), modes.rigid), (56, 6));
    assert!(modes.complete.proved);
    assert!(modes.orthogonality <= 1e-10);
    // The text's rounding couples mode 7 to the rigid motions by 1e-6; the square of that is lost.
    assert!(worst <= 1e-9, "{worst:e}");
    check_residuals(&fe, &modes);
}

#[test]
fn free_beam() {
    let modes = check("a_beam", 29, 6, 1e-12);
    assert!(modes.origin[..6].iter().all(|&o| o == Origin::Rigid));
}

#[test]
fn stiffness_contrast_of_1e8_with_a_close_triple() {
    // The reference itself is uncertain by 8e-12 there.
    check("b_contrast", 29, 6, 1e-9);
}

#[test]
fn massless_nodes_and_a_stiff_spring() {
    let modes = check("c_singM", 29, 6, 1e-11);
    // Its springs join nodes at different places along a fixed direction, so that two rotations of
    // the mesh stretch them; the six null vectors of K are no rigid motions of the mesh.
    assert!(modes.origin.iter().all(|&o| o == Origin::Computed));
    assert!(modes.warnings.iter().any(|w| w.contains("4 free rigid motions, the eigenvalues show 6")));
}

#[test]
fn no_more_modes_than_the_rank_of_the_mass_matrix() {
    let modes = modes_of("tests/data/hard/c_singM", "tests/data/hard/c_singM.mesh", 618);
    assert_eq!(modes.len(), 558);
    assert!(modes.warnings.iter().any(|w| w.contains("the model has 558")), "{:?}", modes.warnings);
}

#[test]
fn repeated_pairs_stay_together() {
    check("d_square", 28, 6, 1e-12);
    // Mode 9 belongs to the pair 9/10.
    let split = modes_of("tests/data/hard/d_square", "tests/data/hard/d_square.mesh", 9);
    assert_eq!(split.len(), 10);
    assert!(split.complete.proved && split.warnings.iter().any(|w| w.contains("stay together")));
}

#[test]
fn clamped_with_condensed_constraints() {
    check("h_bc", 20, 0, 1e-12);
}

#[test]
fn thin_solid_whose_rigid_modes_drown_in_rounding_says_so() {
    // The text's rigid ω² reach −8 beside 284: coupled modes differ by the square of 8/284.
    let modes = check("e2_thin", 16, 6, 2e-2);
    assert!(modes.warnings.iter().any(|w| w.contains("14 digits")), "{:?}", modes.warnings);
}

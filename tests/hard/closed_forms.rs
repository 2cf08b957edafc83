//! Chains of masses and springs, whose frequencies are known in closed form.

use super::read::bare;
use ferrom::linalg::SymSparse;
use ferrom::modal::{ModalOptions, solve};
use ferrom::model::{FeModel, Silent};
use std::f64::consts::PI;

/// n equal masses joined by n − 1 equal springs, free at both ends:
/// ω_k² = 4 (k/m) sin²(kπ/2n), k = 0 … n − 1 (Thomson, Theory of Vibration, sec. 8.5).
fn chain(n: usize, stiffness: f64, mass: f64) -> FeModel {
    let mut k = Vec::new();
    for i in 0..n - 1 {
        k.extend([(i, i, stiffness), (i + 1, i + 1, stiffness), (i, i + 1, -stiffness)]);
    }
    let k = SymSparse::from_triplets(n, &k).expect("valid");
    bare(k, SymSparse::identity(n).scaled(mass))
}

fn exact(n: usize, k: usize, ratio: f64) -> f64 {
    2.0 * ratio.sqrt() * (k as f64 * PI / (2 * n) as f64).sin()
}

#[test]
fn two_masses_and_a_spring() {
    let modes = solve(&chain(2, 800.0, 2.0), &ModalOptions::default(), &Silent).expect("modes");
    assert_eq!((modes.len(), modes.rigid), (2, 1));
    assert_eq!(modes.omega[0], 0.0);
    assert!((modes.omega[1] / 800f64.sqrt() - 1.0).abs() < 1e-14, "{}", modes.omega[1]);
    assert!(modes.complete.proved, "{:?}", modes.warnings);
}

#[test]
fn one_mass_on_a_spring() {
    let k = SymSparse::from_triplets(1, &[(0, 0, 50.0)]).expect("valid");
    let modes = solve(&bare(k, SymSparse::identity(1).scaled(2.0)), &ModalOptions::default(), &Silent).expect("modes");
    assert_eq!((modes.len(), modes.rigid), (1, 0));
    assert!((modes.omega[0] - 5.0).abs() < 1e-13);
}

#[test]
fn free_chains_dense_and_iterated() {
    // 100 masses are solved whole, 2000 by the iteration; ω² spans 1e7 there.
    for n in [100, 2000] {
        let modes = solve(&chain(n, 3e6, 0.5), &ModalOptions { count: 30, shift: None }, &Silent).expect("modes");
        assert_eq!((modes.len(), modes.rigid), (30, 1), "{:?}", modes.warnings);
        assert!(modes.complete.proved, "{:?}", modes.warnings);
        for k in 1..30 {
            let error = (modes.omega[k] / exact(n, k, 6e6) - 1.0).abs();
            assert!(error < 1e-11, "n {n} mode {} error {error:e}", k + 1);
        }
        assert!(modes.orthogonality < 1e-12);
    }
}

#[test]
fn a_badly_placed_shift_is_replaced() {
    for shift in [-1e-9, -1e15] {
        let options = ModalOptions { count: 10, shift: Some(shift) };
        let modes = solve(&chain(2000, 3e6, 0.5), &options, &Silent).expect("modes");
        for k in 1..10 {
            assert!((modes.omega[k] / exact(2000, k, 6e6) - 1.0).abs() < 1e-10, "shift {shift:e}");
        }
        assert!(modes.complete.proved);
    }
}

#[test]
fn bitwise_the_same_twice() {
    let run = || solve(&chain(2000, 3e6, 0.5), &ModalOptions { count: 20, shift: None }, &Silent).expect("modes");
    let (a, b) = (run(), run());
    assert_eq!(a.omega, b.omega);
    assert_eq!(a.shapes, b.shapes);
}

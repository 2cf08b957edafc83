//! Random pencils with known spectra, and one model in many disguises.

use super::read::{bare, export};
use ferrom::linalg::{ShiftedFactor, SymSparse};
use ferrom::modal::{ModalOptions, solve};
use ferrom::model::{DofMap, FeModel, Modes, Silent};
use proptest::prelude::*;

fn modes(fe: &FeModel, count: usize) -> Modes {
    solve(fe, &ModalOptions { count, shift: None }, &Silent).expect("modes")
}

/// Each entry changed by a function of its value.
fn mapped(a: &SymSparse, change: impl Fn(f64) -> f64) -> SymSparse {
    permuted(a, &(0..a.order()).collect::<Vec<_>>(), change)
}

fn permuted(a: &SymSparse, to: &[usize], change: impl Fn(f64) -> f64) -> SymSparse {
    let mut entries = Vec::new();
    for j in 0..a.order() {
        entries.extend(a.column(j).map(|(i, v)| (to[i], to[j], change(v))));
    }
    SymSparse::from_triplets(a.order(), &entries).expect("valid")
}

fn square() -> FeModel {
    export("tests/data/hard/d_square", Some("tests/data/hard/d_square.mesh"))
}

fn worst(a: &Modes, b: &Modes, scale: f64) -> f64 {
    assert_eq!((a.len(), a.rigid), (b.len(), b.rigid), "{:?} {:?}", a.warnings, b.warnings);
    (a.rigid..a.len()).map(|c| (a.omega[c] * scale / b.omega[c] - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn permuted_rows_change_nothing() {
    let fe = square();
    let n = fe.dofs.len();
    // 7 and n = 1503 have no common factor: a permutation that tears every node apart.
    let to: Vec<usize> = (0..n).map(|i| i * 7 % n).collect();
    let mut labels = fe.dofs.labels().to_vec();
    for (i, &t) in to.iter().enumerate() {
        labels[t] = fe.dofs.labels()[i];
    }
    let mut other = fe.clone();
    other.stiffness = permuted(&fe.stiffness, &to, |v| v);
    other.mass = permuted(&fe.mass, &to, |v| v);
    other.dofs = DofMap::labelled(labels).expect("a permutation");
    assert!(worst(&modes(&fe, 28), &modes(&other, 28), 1.0) < 1e-12);
}

#[test]
fn millimetre_tonne_second_twin() {
    let fe = square();
    let mut other = fe.clone();
    other.stiffness = mapped(&fe.stiffness, |v| v * 1e-3);
    other.mass = mapped(&fe.mass, |v| v * 1e-3);
    other.nodes.values_mut().flatten().for_each(|x| *x *= 1e3);
    assert!(worst(&modes(&fe, 28), &modes(&other, 28), 1.0) < 1e-10);
    // And units in which a second is a microsecond.
    other.mass = mapped(&fe.mass, |v| v * 1e-15);
    assert!(worst(&modes(&fe, 28), &modes(&other, 28), 1e6) < 1e-10);
}

#[test]
fn without_mesh_or_labels_the_same() {
    let fe = square();
    let other = bare(fe.stiffness.clone(), fe.mass.clone());
    assert!(worst(&modes(&fe, 28), &modes(&other, 28), 1.0) < 1e-10);
}

/// a_beam with entries of so many digits.
fn rounded(digits: usize) -> (Modes, Modes) {
    let fe = export("tests/data/hard/a_beam", Some("tests/data/hard/a_beam.mesh"));
    let mut rough = fe.clone();
    let round = |v: f64| format!("{v:.*e}", digits - 1).parse().expect("number");
    rough.stiffness = mapped(&fe.stiffness, round);
    rough.mass = mapped(&fe.mass, round);
    (modes(&fe, 20), modes(&rough, 20))
}

#[test]
fn matrices_of_ten_digits() {
    // Fourteen digits put the rigid ω² at 4e-3; ten put them at 40, 1e-4 of ω7².
    let (a, b) = rounded(10);
    assert!(worst(&a, &b, 1.0) < 1e-4, "{}", worst(&a, &b, 1.0));
    assert!(b.complete.proved);
}

#[test]
fn matrices_of_six_digits_say_so() {
    // Six digits put the rigid ω² near ω7²: no solver can find them, but the user must know.
    let (_, b) = rounded(6);
    assert!(b.warnings.iter().any(|w| w.contains("6 digits")), "{:?}", b.warnings);
}

/// K and M with the spectrum given and dense enough coupling: a chain of rotations applied to
/// diagonal matrices, M = TᵀT of unit diagonal scaled, K = Tᵀ Λ T.
fn pencil(lambda: &[f64], massless: usize, turns: &[(usize, f64)]) -> (SymSparse, SymSparse) {
    let n = lambda.len() + massless;
    let mut k = nalgebra::DMatrix::zeros(n, n);
    let mut m = nalgebra::DMatrix::zeros(n, n);
    for i in 0..n {
        k[(i, i)] = lambda.get(i).copied().unwrap_or(lambda[lambda.len() - 1]);
        m[(i, i)] = if i < lambda.len() { 1.0 } else { 0.0 };
    }
    for &(at, angle) in turns {
        let (i, j) = (at % n, (at / n + at + 1) % n);
        if i != j {
            // A shear is no rotation: M leaves the identity, the spectrum stays.
            let mut t = nalgebra::DMatrix::identity(n, n);
            t[(i, j)] = angle;
            k = t.transpose() * k * &t;
            m = t.transpose() * m * &t;
        }
    }
    let sparse = |a: &nalgebra::DMatrix<f64>| {
        let mut entries = Vec::new();
        for j in 0..n {
            entries.extend((0..=j).map(|i| (i, j, a[(i, j)])));
        }
        SymSparse::from_triplets(n, &entries).expect("valid")
    };
    (sparse(&k), sparse(&m))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn known_spectra_are_found(
        distinct in proptest::collection::vec(1.0f64..1e4, 3..20),
        repeats in 0usize..4,
        rigid in 0usize..3,
        massless in 0usize..4,
        turns in proptest::collection::vec((0usize..400, -0.7f64..0.7), 0..20),
    ) {
        let mut lambda = distinct.clone();
        lambda.extend(distinct.iter().take(repeats));
        lambda.extend(vec![0.0; rigid]);
        lambda.sort_by(f64::total_cmp);
        let (k, m) = pencil(&lambda, massless, &turns);
        let fe = bare(k, m);
        let found = modes(&fe, lambda.len());
        prop_assert_eq!(found.len(), lambda.len(), "{:?}", found.warnings);
        prop_assert_eq!(found.rigid, rigid);
        for c in rigid..lambda.len() {
            // 20 shears of 0.7 make a condition of 1e4 at most; 1e-9 leaves room for its rounding.
            prop_assert!((found.omega[c].powi(2) / lambda[c] - 1.0).abs() < 1e-9, "mode {}: {} {}", c + 1, found.omega[c].powi(2), lambda[c]);
        }
        prop_assert!(found.orthogonality < 1e-10);
        prop_assert!(found.complete.proved, "{:?}", found.warnings);
    }

    #[test]
    fn inertia_counts_what_lies_below(
        lambda in proptest::collection::vec(1.0f64..1e3, 4..40),
        turns in proptest::collection::vec((0usize..900, -0.7f64..0.7), 0..30),
        shift in 0.5f64..1.2e3,
    ) {
        prop_assume!(lambda.iter().all(|l| (l / shift - 1.0).abs() > 1e-6));
        let (k, m) = pencil(&lambda, 0, &turns);
        let factor = ShiftedFactor::new(&k, &m, shift).expect("a factor");
        prop_assert_eq!(factor.negative_eigenvalues(), lambda.iter().filter(|&&l| l < shift).count());
        let b = nalgebra::DMatrix::from_fn(lambda.len(), 3, |i, j| (i + 2 * j) as f64 - 3.0);
        let mut x = b.clone();
        factor.solve_in_place(&mut x);
        let r = k.mul_block(&x) - m.mul_block(&x) * shift - &b;
        prop_assert!(r.amax() <= 1e-9 * (b.amax() + 2e3 * x.amax() * 100.0), "{}", r.amax());
    }
}

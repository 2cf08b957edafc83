//! Wrong input gives one clear error.

use super::read::bare;
use ferrom::linalg::SymSparse;
use ferrom::modal::{ModalError, ModalOptions, solve};
use ferrom::model::{FeModel, Silent};

fn matrix(n: usize, entries: &[(usize, usize, f64)]) -> SymSparse {
    SymSparse::from_triplets(n, entries).expect("valid")
}

fn error(fe: &FeModel) -> ModalError {
    solve(fe, &ModalOptions::default(), &Silent).expect_err("an error")
}

#[test]
fn nothing_to_solve() {
    assert_eq!(error(&bare(matrix(0, &[]), matrix(0, &[]))), ModalError::Empty);
    let fe = bare(SymSparse::identity(2), matrix(2, &[]));
    assert_eq!(error(&fe), ModalError::NoMass);
}

#[test]
fn orders_differ() {
    let fe = bare(SymSparse::identity(3), SymSparse::identity(2));
    assert!(matches!(error(&fe), ModalError::OrderMismatch { stiffness: 3, mass: 2, .. }));
}

#[test]
fn indefinite_mass() {
    let fe = bare(SymSparse::identity(2), matrix(2, &[(0, 0, 1.0), (1, 1, -1.0)]));
    assert!(matches!(error(&fe), ModalError::IndefiniteMass { .. }));
    let fe = bare(SymSparse::identity(2), matrix(2, &[(0, 0, 1.0), (1, 1, 1.0), (0, 1, 2.0)]));
    assert!(matches!(error(&fe), ModalError::IndefiniteMass { .. }));
}

#[test]
fn unstable_structure() {
    let fe = bare(matrix(2, &[(0, 0, -4.0), (1, 1, 9.0)]), SymSparse::identity(2));
    assert!(matches!(error(&fe), ModalError::NegativeStiffness { count: 1, .. }), "{:?}", error(&fe));
}

#[test]
fn null_vectors_common_to_both() {
    // An empty row, and a spring between two massless dofs that nothing holds.
    let fe = bare(matrix(2, &[(0, 0, 4.0)]), matrix(2, &[(0, 0, 1.0)]));
    assert!(matches!(error(&fe), ModalError::CommonNull { .. }));
    let floating = [(0, 0, 4.0), (1, 1, 1.0), (2, 2, 1.0), (1, 2, -1.0)];
    let fe = bare(matrix(3, &floating), matrix(3, &[(0, 0, 1.0)]));
    assert!(matches!(error(&fe), ModalError::CommonNull { .. }), "{:?}", error(&fe));
}

#[test]
fn shifts_that_cannot_be_used() {
    let fe = bare(SymSparse::identity(2), SymSparse::identity(2));
    for shift in [0.0, 1.0, f64::NAN, f64::NEG_INFINITY] {
        let options = ModalOptions { count: 1, shift: Some(shift) };
        assert!(matches!(solve(&fe, &options, &Silent), Err(ModalError::BadShift(_))));
    }
    let none = ModalOptions { count: 0, shift: None };
    assert_eq!(solve(&fe, &none, &Silent).expect_err("none"), ModalError::NoneAsked);
}

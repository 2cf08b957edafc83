//! Modes that CalculiX computed: .frd, .eig, .dat.

use super::{Folder, assert_says, leaf, shared};
use ferrom::format::{read_dat, read_dof_map, read_eig, read_frd, read_symmetric};
use ferrom::linalg::SymSparse;
use ferrom::model::{Axis, Modes, NodeId, Origin};
use nalgebra::DMatrix;
use std::io::Read;

/// max |ΦᵀMΦ − I| of modes whose rows stand in the order of the leaf's dof list.
fn orthogonality(modes: &Modes, mass: &SymSparse) -> f64 {
    let gram = modes.shapes.tr_mul(&mass.mul_block(&modes.shapes));
    (gram - DMatrix::identity(modes.len(), modes.len())).amax()
}

fn plain(name: &str) -> Option<Vec<u8>> {
    let path = shared(name)?;
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(std::fs::File::open(path).expect("there")).read_to_end(&mut bytes).expect("gzip");
    Some(bytes)
}

/// The modes are mass-normalised in the matrices of the same model, as far as the file has digits:
/// six digits give 5e-6, single precision 6e-8 per component (MODELS.md); the sum over 8604 of them
/// is a few times larger at most. Double precision leaves the 14 digits of the text matrices.
#[test]
fn frd_and_eig_modes_of_the_leaf_are_orthonormal_in_its_mass() {
    let (dofs, _) = read_dof_map(&leaf("leaf.dof.gz")).expect("the leaf");
    let (mass, _) = read_symmetric(&leaf("leaf.mas.gz"), "mass").expect("the leaf");
    let (stiffness, _) = read_symmetric(&leaf("leaf.sti.gz"), "stiffness").expect("the leaf");
    let Some(path) = shared("models/leaf-spring/leaf_modes.eig.gz") else { return };
    let (eig, _) = read_eig(&path, &dofs).expect("the leaf");
    assert_eq!((eig.len(), eig.rigid, eig.shapes.nrows()), (56, 6, 8604));
    let defect = orthogonality(&eig, &mass);
    assert!(defect < 1e-9, "{defect:e}");
    // Rayleigh quotient of mode 7 from double precision shapes and the text matrices (1.75e-6: MODELS.md).
    let phi = eig.shapes.column(6).into_owned();
    let lambda: f64 = stiffness.mul(phi.as_slice()).iter().zip(&phi).map(|(a, b)| a * b).sum();
    assert!((lambda / eig.omega[6].powi(2) - 1.0).abs() < 3e-6, "{lambda}");

    for (name, tolerance) in [("leaf_modes_ascii.frd.gz", 2e-5), ("leaf_modes_bin.frd.gz", 3e-7)] {
        let Some(path) = shared(&format!("models/leaf-spring/{name}")) else { return };
        let (read, source) = read_frd(&path).expect("the leaf");
        let modes = &read.modes;
        assert_eq!((modes.len(), modes.rigid, read.nodes.len()), (56, 6, 2868), "{name}");
        assert_eq!(
            (source.role.as_str(), modes.origin[5], modes.origin[6]),
            ("modes", Origin::Rigid, Origin::Imported)
        );
        assert_eq!(modes.dofs.labels(), dofs.labels(), "{name}: the same rows as the matrices");
        assert!(modes.warnings.iter().any(|w| w.contains("modes 1-6")), "{:?}", modes.warnings);
        let defect = orthogonality(modes, &mass);
        assert!(defect < tolerance, "{name}: {defect:e}");
        // Shapes agree with the double precision ones where the mode is alone (7 to 17 are).
        for m in 6..17 {
            // Of an antisymmetric mode two components are largest, and rounding decides on the sign.
            let (mine, exact) = (modes.shapes.column(m), eig.shapes.column(m));
            let gap = (mine - exact).amax().min((mine + exact).amax()) / exact.amax();
            assert!(gap < tolerance, "{name} mode {}: {gap:e}", m + 1);
            assert!((modes.omega[m] / eig.omega[m] - 1.0).abs() < 1e-8, "ten digits of Hz are written");
        }
        let y = modes.dofs.row(NodeId(1), Axis::Y).expect("a row");
        assert!((read.nodes[&NodeId(1)][1] + 7.926643621360e-01).abs() < 1e-5, "six digits are written");
        assert!(modes.shapes[(y, 0)].is_finite());
    }
}

#[test]
fn the_dat_table_of_the_leaf_ends_before_the_participation_factors() {
    let Some(path) = shared("models/leaf-spring/leaf_freq.dat") else { return };
    let (modes, _) = read_dat(&path).expect("the leaf");
    assert_eq!(modes.len(), 56);
    assert_eq!((modes[0].lambda, modes[0].omega), (-0.6406311e-3, 0.0));
    assert_eq!((modes[6].number.0, modes[6].omega), (7, 107.0708));
}

const DAT: &str = "\n     E I G E N V A L U E   O U T P U T\n\n MODE NO    EIGENVALUE\n\n      1   0.1E+03   0.1E+02   0.159E+01   0.0E+00\n      2   0.4E+03   0.2E+02   0.318E+01   0.0E+00\n\n     P A R T I C I P A T I O N   F A C T O R S\n\n      1   0.1E+01\n";

#[test]
fn bad_dat_files_are_named() {
    let folder = Folder::new();
    assert_eq!(read_dat(&folder.write("a.dat", DAT)).expect("good").0.len(), 2);
    assert_eq!(ferrom::format::detect(&folder.path("a.dat")).expect("there").map(|f| f.name), Some("dat"));
    assert_says(read_dat(&folder.write("b.dat", DAT.replace("0.2E+02", "abc"))), 7, &["abc", "rad/time"]);
    assert_says(read_dat(&folder.write("b.dat", DAT.replace("      2  ", "      3  "))), 7, &["mode 3 after mode 1"]);
    assert_says(read_dat(&folder.write("b.dat", &DAT[..DAT.find("0.318").expect("there")])), 7, &["cut short"]);
    assert_says(read_dat(&folder.write("b.dat", "anything\n")), 0, &["no eigenvalue table", "*FREQUENCY"]);
    assert_says(read_dat(&folder.write("b.dat", &DAT[..60])), 0, &["without modes"]);
}

/// Two nodes, two modes; fields abut and an exponent has no room for a blank.
fn frd() -> String {
    let header = |kind: &str, count: usize| format!("{kind:<24}{count:>12}{:38}1\n", "");
    let mut text = String::from("    1C\n    1UPGM               CalculiX\n");
    text += &header("    2C", 2);
    text +=
        " -1         1 1.00000E+00 2.00000E+00 3.00000E+00\n -1        22-1.00000E+00-2.00000E+00-3.00000E+00\n -3\n";
    text += &header("    3C", 1);
    text += " -1         1   11    0    1\n -2         1        22\n -3\n";
    for (mode, hertz) in [(1, "0.00000E+00"), (2, "17.04084544")] {
        text += &format!("    1PMODE{mode:>26}\n  100CL  10{mode} {hertz}{:>12}{:20}2{mode:>5}MODAL{:6}1\n", 2, "", "");
        text += " -4  DISP        4    1\n -5  D1          1    2    1    0\n -5  D2          1    2    2    0\n";
        text += " -5  D3          1    2    3    0\n -5  ALL         1    2    0    0    1ALL\n";
        text += " -1         1 6.32434E-03-6.20011E-02 5.43869E-01\n -1        22-1.00000E-01-2.00000E+00-3.00000-101\n -3\n";
    }
    text + " 9999\n"
}

#[test]
fn frd_columns_abut_and_are_never_split_on_blanks() {
    let folder = Folder::new();
    let (read, _) = read_frd(&folder.write("a.frd", frd())).unwrap_or_else(|e| panic!("{e}\n{}", frd()));
    assert_eq!(read.nodes[&NodeId(22)], [-1.0, -2.0, -3.0]);
    assert_eq!((read.modes.rigid, read.modes.len()), (1, 2));
    assert!((read.modes.omega[1] - 107.0708) < 1e-3);
    // The largest component, −2, is made positive.
    let shape: Vec<f64> = read.modes.shapes.column(1).iter().copied().collect();
    assert_eq!(shape, [-6.32434e-3, 6.20011e-2, -5.43869e-1, 0.1, 2.0, 3e-101]);
    assert_eq!(ferrom::format::detect(&folder.path("a.frd")).expect("there").map(|f| f.name), Some("frd"));
}

#[test]
fn frd_files_cut_at_any_byte_are_refused() {
    let folder = Folder::new();
    let text = frd();
    for cut in 0..text.len() - 1 {
        assert!(read_frd(&folder.write("cut.frd", &text[..cut])).is_err(), "cut at {cut}");
    }
    assert_says(
        read_frd(&folder.write("a.frd", text.replace("5.43869E-01", "5.43869x-01"))),
        18,
        &["-1, a node number"],
    );
    assert_says(read_frd(&folder.write("a.frd", text.replace("    1C", "    1X"))), 1, &["begins with 1C"]);
    let without = text.replace("MODAL", "STATI");
    assert_says(read_frd(&folder.write("a.frd", without)), 0, &["no mode shapes", "*NODE FILE"]);
}

/// A binary file of one mode, cut and flipped: an error or other numbers, never a panic.
#[test]
fn damaged_binary_frd_files_never_panic() {
    let Some(bytes) = plain("models/leaf-spring/leaf_modes_bin.frd.gz") else { return };
    let folder = Folder::new();
    for cut in [100, 1000, 2000, 50_000, 90_000, 150_000, bytes.len() / 2, bytes.len() - 7] {
        assert!(read_frd(&folder.write("cut.frd", &bytes[..cut])).is_err(), "cut at {cut}");
    }
    let mut small = bytes[..200_000].to_vec();
    for k in 0..300 {
        let at = k * 631 % small.len();
        small[at] ^= 0x55;
        let _ = read_frd(&folder.write("flip.frd", &small));
    }
}

#[test]
fn eig_files_that_do_not_fit_the_dof_list_are_refused() {
    let folder = Folder::new();
    let (dofs, _) = read_dof_map(&folder.write("a.dof", "1.1\n1.2\n")).expect("good");
    let mut bytes: Vec<u8> = [0i32, 1, 0, 1].iter().flat_map(|v| v.to_le_bytes()).collect();
    // λ; K: diagonal 2, off-diagonal 1; M the same; one shape.
    for value in [4.0, 4.0, 9.0, 0.0, 1.0, 1.0, 0.0, -1.0, 0.5f64] {
        bytes.extend(value.to_le_bytes());
    }
    let (modes, _) = read_eig(&folder.write("a.eig", &bytes), &dofs).expect("good");
    assert_eq!((modes.omega[0], modes.shapes.as_slice()), (2.0, &[1.0, -0.5][..]));
    for cut in 0..bytes.len() {
        assert!(
            read_eig(&folder.write("cut.eig", &bytes[..cut]), &dofs).is_err() || (bytes.len() - cut).is_multiple_of(16),
            "{cut}"
        );
    }
    assert_says(
        read_eig(&folder.write("b.eig", &bytes[..40]), &dofs),
        0,
        &["do not hold 1 modes of 2 dofs", "one run"],
    );
    bytes[12..16].copy_from_slice(&i32::MAX.to_le_bytes());
    assert_says(read_eig(&folder.write("c.eig", &bytes), &dofs), 0, &["2147483647 modes"]);
    bytes[0] = 1;
    assert_says(read_eig(&folder.write("d.eig", &bytes), &dofs), 0, &["cyclic symmetry"]);
}

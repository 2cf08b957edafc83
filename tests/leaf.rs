//! The reference leaf against independent solutions: refined eigenvalues, CalculiX's frequency
//! response and modal transient.

use crate::support::{at_root, csv, damped, leaf, run, set_step, set_until, surface_nodes};
use ferrom::frf::{modal_term, receptance};
use ferrom::model::{Axis, ModeNo, Selection};
use ferrom::pipeline::{Loaded, path_of};
use ferrom::rank::{Path, criterion, rank, select};
use ferrom::reduce::{Made, method, reduce};
use ferrom::simulate::Scene;
use std::collections::BTreeMap;

#[test]
fn frequencies_equal_the_refined_reference() {
    let modes = &leaf().modes;
    assert_eq!(modes.rigid, 6);
    assert!(modes.omega[..6].iter().all(|&w| w == 0.0));
    let (_, rows) = csv("models/leaf-spring/reference/leaf_ref.csv");
    for row in rows.iter().skip(6) {
        let k = row[0] as usize - 1;
        let error = (modes.omega[k] / row[2] - 1.0).abs();
        // The text matrices' eigenvalues, refined in extended precision and trusted to 1e-12 (λ); ours are
        // Rayleigh quotients in twice the working precision.
        assert!(error < 1e-10, "mode {}: {error:e}", k + 1);
    }
    assert!(modes.complete.proved, "{:?} {:?}", modes.complete, modes.warnings);
    assert!(modes.complete.count >= 56 && modes.complete.below > modes.omega[55]);
    assert!(modes.orthogonality < 1e-10, "{:e}", modes.orthogonality);
    // Fourteen digits leave the rigid motions 2e-2 (rad/s)² instead of zero; a mode 7 that is exactly
    // orthogonal to them is off K's own by 1e-6 of that kind, which its residual shows. From mode 8 on
    // the rounding of double precision remains.
    assert!(modes.residual[6] < 5e-8 && modes.residual[7..].iter().all(|r| *r < 5e-9), "{:?}", &modes.residual[6..]);
}

#[test]
fn ranking_selects_7_to_17_with_the_published_scores() {
    let analysed = leaf();
    let end = || path_of(analysed, "d:z").expect("joint d");
    let path = Path { input: end(), output: end() };
    let ranking = rank(&analysed.modes, criterion("peak-gain").expect("in the table"), &[path]);
    let relative = |n: u32| ranking.scores.iter().find(|s| s.mode == ModeNo(n)).expect("ranked").relative;
    // Three digits, as the reference states them.
    for (mode, expected) in [
        (7, 1.0),
        (8, 5.46e-2),
        (10, 1.97e-3),
        (11, 8.08e-4),
        (13, 3.09e-4),
        (14, 2.58e-4),
        (17, 3.50e-4),
        (18, 1.17e-4),
    ] {
        assert!((relative(mode) / expected - 1.0).abs() < 5e-3, "mode {mode}: {:e}", relative(mode));
    }
    for zero in [9, 12, 15, 16, 19] {
        assert!(relative(zero) < 1e-12, "mode {zero} is zero by symmetry: {:e}", relative(zero));
    }
    let selection = select(&analysed.modes, &ranking, &analysed.recipe.select).expect("a selection");
    assert_eq!(selection.ranges(), "7-17");
    assert!(selection.warnings.is_empty(), "{:?}", selection.warnings);
}

/// CalculiX `*STEADY STATE DYNAMICS`: unit force along z at surface node d, 56 modes, 1 % damping.
#[test]
fn receptance_equals_calculix() {
    let modes = damped(0.01);
    let nodes = surface_nodes();
    let row = |node: &str, axis: Axis| {
        nodes.iter().find(|n| n.name == node).and_then(|n| n.modal_row(axis, &modes)).expect("a direction")
    };
    let input = row("d", Axis::Z);
    let (header, rows) = csv("models/leaf-spring/reference/leaf_frf_ccx.csv");
    let column = |name: String| header.iter().position(|h| *h == name).expect("a column");
    // How far CalculiX's own λ is from that of the matrices it exported, by mode (14 digits of text).
    let (_, refined) = csv("models/leaf-spring/reference/leaf_ref.csv");
    let moved: Vec<f64> = refined.iter().map(|r| r[6]).collect();
    let (mut worst, mut plain) = (0.0_f64, 0);
    for line in &rows {
        let omega = 2.0 * std::f64::consts::PI * line[0];
        for node in ["a", "b", "c", "d"] {
            let (mut difference, mut size, mut by_rounding) = (0.0, 0.0, 0.0);
            for axis in [Axis::X, Axis::Y, Axis::Z] {
                let phi = row(node, axis);
                let h = receptance(&modes, &phi, &input, 0..56, omega);
                let magnitude = line[column(format!("{node}_mag_{axis}"))];
                let phase = line[column(format!("{node}_pha_deg_{axis}"))].to_radians();
                // CalculiX prints ±90° for any real part below 1e-10 m.
                if line[column(format!("{node}_pha_deg_{axis}"))].abs() == 90.0 {
                    by_rounding += 1e-10;
                }
                difference += (h.re - magnitude * phase.cos()).powi(2) + (h.im - magnitude * phase.sin()).powi(2);
                size += magnitude * magnitude;
                for k in 6..24 {
                    // A change of λ by ε changes the mode's term by λε/|D|; shapes change by 2e-6 as well.
                    let term = modal_term(modes.omega[k], 0.01, omega).magnitude();
                    let share = modes.omega[k].powi(2) * moved[k] * term + 2e-6;
                    by_rounding += (phi[k] * input[k]).abs() * term * share;
                }
            }
            // Six printed digits: 5e-6 of a magnitude, and 0.0005° = 8.7e-6 rad of a phase above 100°.
            let printed = 1.4e-5 * size.sqrt();
            plain += usize::from(by_rounding < printed);
            worst = worst.max(difference.sqrt() / (printed + by_rounding));
        }
    }
    println!(
        "{} frequencies at 4 nodes, {plain} of them good to the print alone; worst {worst:.2} of the allowance",
        rows.len()
    );
    assert!(rows.len() > 100 && plain > 3 * rows.len() && worst < 1.0, "{worst:e}, {plain}");
}

/// CalculiX `*MODAL DYNAMIC`: 500 N × 10 ms half-sine (a table every 0.05 ms) at surface node d, +z,
/// free-free, 56 modes, 1 % damping; displacements every 0.2 ms.
#[test]
fn modal_transient_equals_calculix() {
    let analysed = leaf();
    let modes = damped(0.01);
    let end = || path_of(analysed, "2852:z").expect("node d");
    let path = Path { input: end(), output: end() };
    let ranking = rank(&modes, criterion("peak-gain").expect("in the table"), &[path]);
    let selection = Selection { modes: modes.elastic().collect(), reason: "all".into(), warnings: vec![] };
    let nodes = surface_nodes();
    let made = Made {
        fe: Some(&analysed.fe),
        modes: &modes,
        ranking: &ranking,
        selection: &selection,
        nodes: &nodes,
        name: "leaf",
        recipe: "",
        tool: "test",
    };
    let model = reduce(method("truncation").expect("in the table"), &made).expect("reduced");
    let table: Vec<String> = (0..=200)
        .map(|k| format!("[{}, {}]", k as f64 * 5e-5, 500.0 * (std::f64::consts::PI * k as f64 / 200.0).sin()))
        .collect();
    let measures: String = ["a", "b", "c", "d"]
        .iter()
        .flat_map(|n| ["y", "z"].map(|d| format!("[[measure]]\nname = \"{n}_u{d}\"\nof = \"leaf:{n}:{d}\"\n")))
        .collect();
    let text = format!(
        "name = \"pulse\"\neffects = [\"flexibility\", \"structural-damping\", \"applied-force\"]\n\
         [run]\nstep = 1\nuntil = 1\n[body.leaf]\nmodel = \"leaf.h5\"\n\
         [[effect.applied-force]]\nat = \"leaf:d:z\"\ntable = [{}]\n{measures}",
        table.join(", ")
    );
    let mut scene: Scene = toml::from_str(&text).expect("a scene");
    set_step(&mut scene, 5e-5);
    set_until(&mut scene, 0.1);
    let loaded =
        Loaded { file: at_root("pulse.toml"), scene, text, models: BTreeMap::from([("leaf".to_string(), model)]) };
    let result = run(&loaded);
    let (header, rows) = csv("models/leaf-spring/reference/leaf_moddyn_ccx.csv");
    let largest = rows.iter().flat_map(|r| r[1..].iter()).fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut worst = 0.0_f64;
    for row in &rows {
        let k = (row[0] / 5e-5).round() as usize;
        assert!((result.time[k] - row[0]).abs() < 1e-12);
        for channel in &result.channels {
            let column = header.iter().position(|h| *h == channel.name).expect("a column");
            worst = worst.max((channel.values[k] - row[column]).abs() / largest);
        }
    }
    assert!(rows.len() == 500 && worst < 2e-5, "{worst:e} of the largest over {} times", rows.len());
}

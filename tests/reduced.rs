//! Reduced models: what is committed is what the recipe makes; its parts are what they claim.

use crate::support::{at_root, leaf, silent};
use ferrom::format::{read_reduced, summary_to_text};
use ferrom::frf::modal_term;
use ferrom::linalg::ShiftedFactor;
use ferrom::model::{Axis, InterfaceNode, ReducedModel, StateSpace};
use ferrom::pipeline::{Expected, analyse, build, check};
use nalgebra::DMatrix;

fn committed(name: &str) -> ReducedModel {
    read_reduced(&at_root(&format!("reduced/{name}.h5"))).expect("the committed model")
}

#[test]
fn committed_models_are_what_their_recipes_make() {
    for name in ["leaf-spring", "free-free-beam", "two-mass-chain"] {
        let file = at_root(&format!("models/{name}/model.toml"));
        let built = build(analyse(&file, None, silent()).expect("modes"), None, silent()).expect("reduced");
        let old = committed(name);
        assert_eq!(built.reduced.recipe, old.recipe, "{name}: remake it: ferrom reduce models/{name}");
        assert_eq!(built.reduced.sources, old.sources, "{name}: remake it: ferrom reduce models/{name}");
        let expected = Expected {
            modes: None,
            model: Some(old.clone()),
            origin: name.into(),
            frequency_tolerance: 1e-9,
            least_mac: 0.999_999,
        };
        let outcome = check(&built.reduced, &expected);
        assert!(outcome.ok, "{name}: {:?}", outcome.differences);
        let text = std::fs::read_to_string(at_root(&format!("reduced/{name}.toml"))).expect("the summary");
        assert_eq!(text, summary_to_text(&old), "{name}: the summary is of another model");
    }
}

/// C (jωI − A)⁻¹ B + D of eq. (12) against the modal sum, displacement and acceleration rows.
#[test]
fn state_space_reproduces_the_receptance_of_the_kept_modes() {
    let model = committed("leaf-spring");
    let d = model.node("d").expect("joint d");
    let rows: Vec<usize> = [Axis::Y, Axis::Z].iter().map(|&a| model.row(d, a).expect("a row")).collect();
    let system = StateSpace::new(&model, &rows, &rows);
    let n = system.a.nrows();
    assert_eq!((n, system.b.shape(), system.c.shape()), (22, (22, 2), (6, 22)));
    for omega in [30.0_f64, 107.07, 500.0, 3663.7, 2e4] {
        // Real form of (jω I − A)(x + jy) = b: [−A −ωI; ωI −A].
        let mut real = DMatrix::zeros(2 * n, 2 * n);
        real.view_mut((0, 0), (n, n)).copy_from(&-&system.a);
        real.view_mut((n, n), (n, n)).copy_from(&-&system.a);
        for k in 0..n {
            real[(k, n + k)] = -omega;
            real[(n + k, k)] = omega;
        }
        let mut right = DMatrix::zeros(2 * n, 2);
        right.view_mut((0, 0), (n, 2)).copy_from(&system.b);
        let x = real.lu().solve(&right).expect("regular off the poles");
        let (re, im) = (&system.c * x.rows(0, n) + &system.d, &system.c * x.rows(n, n));
        for (o, &out) in rows.iter().enumerate() {
            for (i, &input) in rows.iter().enumerate() {
                let mut sum = (0.0, 0.0);
                for (c, mode) in model.modes.iter().enumerate() {
                    let h =
                        modal_term(mode.omega, mode.zeta, omega) * (model.shapes[(out, c)] * model.shapes[(input, c)]);
                    sum = (sum.0 + h.re, sum.1 + h.im);
                }
                let size = f64::hypot(sum.0, sum.1);
                // An unbalanced 44×44 solve with entries up to ω² = 1.3e7.
                assert!(
                    (re[(o, i)] - sum.0).abs() < 1e-8 * size && (im[(o, i)] - sum.1).abs() < 1e-8 * size,
                    "{omega}"
                );
                let acceleration = (-omega * omega * sum.0, -omega * omega * sum.1);
                let bound = 1e-8 * omega * omega * size;
                assert!(
                    (re[(4 + o, i)] - acceleration.0).abs() < bound && (im[(4 + o, i)] - acceleration.1).abs() < bound
                );
            }
        }
    }
}

/// Static (inertia-relief) flexibility = kept modes + residual flexibility, against a solution that
/// uses no mode at all: K u = P f with the rigid part of f taken off, u freed of rigid motion.
#[test]
fn residual_flexibility_makes_statics_exact() {
    let analysed = leaf();
    let fe = &analysed.fe;
    let model = committed("leaf-spring");
    let residual = model.residual.as_ref().expect("a residual");
    let d = model.node("d").expect("joint d");
    let (mut worst, mut size) = (0.0_f64, 0.0_f64);
    let rigid = analysed.modes.shapes.columns(0, 6).into_owned();
    let mass_rigid = fe.mass.mul_block(&rigid);
    let node: &InterfaceNode = analysed.nodes.iter().find(|n| n.name == "d").expect("joint d");
    let mut force = DMatrix::zeros(fe.dofs.len(), 1);
    for &(row, w) in node.weights(Axis::Z).expect("z") {
        force[(row, 0)] += w;
    }
    force -= &mass_rigid * (rigid.transpose() * &force);
    // (K − σM) u_{k+1} = f − σ M u_k halves the error of mode 7 for σ = −λ7; all others fall faster.
    let shift = -1.2e4;
    let factor = ShiftedFactor::new(&fe.stiffness, &fe.mass, shift).expect("a factor");
    let mut u: DMatrix<f64> = DMatrix::zeros(fe.dofs.len(), 1);
    for _ in 0..60 {
        let mut next = &force - fe.mass.mul_block(&u) * shift;
        factor.solve_in_place(&mut next);
        next -= &rigid * (mass_rigid.transpose() * &next);
        u = next;
    }
    let input = model.row(d, Axis::Z).expect("d:z");
    for row in 0..model.dofs.len() {
        let dof = model.dofs[row];
        let interface = analysed.nodes.iter().find(|n| n.name == model.nodes[dof.node].name).expect("a node");
        let exact: f64 = interface.weights(dof.axis).expect("a direction").iter().map(|&(r, w)| w * u[(r, 0)]).sum();
        let kept: f64 = (0..model.modes.len())
            .map(|c| model.shapes[(row, c)] * model.shapes[(input, c)] / model.modes[c].omega.powi(2))
            .sum();
        let by_vectors: f64 = (0..residual.omega.len())
            .map(|t| residual.shapes[(row, t)] * residual.shapes[(input, t)] / residual.omega[t].powi(2))
            .sum();
        worst = worst.max((kept + residual.flexibility[(row, input)] - exact).abs());
        size = size.max(exact.abs());
        assert!((by_vectors - residual.flexibility[(row, input)]).abs() < 1e-9 * size.max(1e-12));
    }
    // 2^-60 of the fixed point, and rounding of K's solutions of about 1e-9 of the largest.
    assert!(worst < 1e-8 * size, "{worst:e} of {size:e}");
}

/// Undamped receptance at d:z from K − ω²M itself, no mode involved, against kept modes with and
/// without residual vectors: far below the first mode left out (4869 rad/s) the vectors carry nearly
/// all that is missing.
#[test]
fn residual_vectors_carry_the_receptance_beyond_the_kept_modes() {
    let analysed = leaf();
    let fe = &analysed.fe;
    let model = committed("leaf-spring");
    let residual = model.residual.as_ref().expect("a residual");
    let row = model.row(model.node("d").expect("d"), Axis::Z).expect("d:z");
    let node = analysed.nodes.iter().find(|n| n.name == "d").expect("d");
    let weights = node.weights(Axis::Z).expect("z");
    let mut force = DMatrix::zeros(fe.dofs.len(), 1);
    for &(r, w) in weights {
        force[(r, 0)] += w;
    }
    for (omega, share) in [(600.0_f64, 1e-3), (1000.0, 3e-3), (2000.0, 0.05)] {
        let factor = ShiftedFactor::new(&fe.stiffness, &fe.mass, omega * omega).expect("a factor off the poles");
        let mut u = force.clone();
        factor.solve_in_place(&mut u);
        let exact: f64 = weights.iter().map(|&(r, w)| w * u[(r, 0)]).sum();
        let term = |natural: f64, shape: f64| shape * shape / (natural * natural - omega * omega);
        let rigid: f64 = model.rigid.shapes.row(row).iter().map(|s| term(0.0, *s)).sum();
        let kept: f64 = (0..11).map(|c| term(model.modes[c].omega, model.shapes[(row, c)])).sum();
        let extra: f64 = (0..residual.omega.len()).map(|t| term(residual.omega[t], residual.shapes[(row, t)])).sum();
        let (without, with) = ((rigid + kept - exact).abs(), (rigid + kept + extra - exact).abs());
        println!("{omega} rad/s: {exact:e}, kept modes off by {without:e}, with residual vectors by {with:e}");
        assert!(with < share * without, "{omega}: {with:e} {without:e}");
    }
}

//! Small models with closed-form answers, from the files in models/.

use crate::support::{at_root, run, silent};
use ferrom::model::{Axis, RigidBody};
use ferrom::pipeline::{analyse, build, load_scene};
use std::collections::BTreeMap;
use std::f64::consts::PI;

#[test]
fn free_free_beam_has_its_closed_form_frequencies() {
    let beam = analyse(&at_root("models/free-free-beam/model.toml"), Some(30), silent()).expect("modes");
    let modes = &beam.modes;
    assert_eq!(modes.rigid, 6);
    assert!(modes.complete.proved, "{:?}", modes.warnings);
    let (young, density) = (2.1e11_f64, 7850.0_f64);
    let shear = young / 2.6;
    // Roots of cosh x cos x = 1 (Blevins, table 8-1), then (2n + 1)π/2.
    let roots: Vec<f64> = (1..=8)
        .map(|n| match n {
            1 => 4.730_040_744_862_704,
            2 => 7.853_204_624_095_838,
            3 => 10.995_607_838_001_67,
            n => (2.0 * f64::from(n) + 1.0) * PI / 2.0,
        })
        .collect();
    let mut exact: Vec<(f64, f64)> = Vec::new();
    for height in [0.02_f64, 0.03] {
        // √(EI/ρA) = height·√(E/12ρ). Cubic elements: error (βh)⁴/720 of λ (Strang and Fix), half of ω.
        exact.extend(
            roots.iter().map(|x| (x * x * height * (young / density / 12.0).sqrt(), (x / 40.0).powi(4) / 1440.0)),
        );
    }
    for n in 1..=4 {
        // Linear elements: ω(1 + (nπh/L)²/24).
        let error = (f64::from(n) * PI / 40.0).powi(2) / 24.0;
        exact.push((f64::from(n) * PI * (young / density).sqrt(), error));
        exact.push((f64::from(n) * PI * (shear / density).sqrt(), error));
    }
    exact.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (k, (omega, discretisation)) in exact.iter().take(12).enumerate() {
        let found = modes.omega[6 + k];
        let error = found / omega - 1.0;
        // From above (Rayleigh-Ritz), by no more than twice the leading error term; rounding 1e-9.
        assert!(error > -1e-9 && error < 2.0 * discretisation + 1e-9, "mode {}: {found} {omega} {error:e}", 7 + k);
    }
    let body = RigidBody::of(&beam.fe).expect("labelled");
    assert!((body.mass - 7850.0 * 6e-4).abs() < 1e-10 && (body.centre[0] - 0.5).abs() < 1e-12);
    assert!((body.inertia[(1, 1)] - 4.71 / 12.0).abs() < 1e-9);
}

#[test]
fn chain_has_its_frequency_and_moves_as_algebra_says() {
    let chain = analyse(&at_root("models/two-mass-chain/model.toml"), None, silent()).expect("modes");
    let omega = (1000.0_f64 * 1.25).sqrt();
    assert_eq!((chain.modes.rigid, chain.modes.omega[0]), (1, 0.0));
    assert!((chain.modes.omega[1] / omega - 1.0).abs() < 1e-14, "{:?}", chain.modes.omega);
    let built = build(chain, None, silent()).expect("reduced");
    let left = built.reduced.row(0, Axis::X).expect("left x");
    // φ² at the left mass: m2/(m1 (m1 + m2)).
    assert!((built.reduced.shapes[(left, 0)].powi(2) - 0.8).abs() < 1e-14);
    let mut scene = load_scene(&at_root("models/two-mass-chain/push.toml")).expect("a scene");
    scene.models = BTreeMap::from([("chain".to_string(), built.reduced)]);
    let run = run(&scene);
    let channel = |name: &str| &run.channel(name).expect("a channel").values;
    for (k, t) in run.time.iter().enumerate() {
        let wave = (1.0 - (omega * t).cos()) / (omega * omega);
        let right = 2.0 * (t * t / 2.0 - wave);
        let stretch = -10.0 * wave;
        // A thousand exact steps of rounding 1e-16 on metres.
        assert!((channel("right")[k] - right).abs() < 1e-12 && (channel("stretch")[k] - stretch).abs() < 1e-12, "{t}");
    }
    let energy = run.energy.expect("accounts");
    // The work of the force is integrated to fourth order in ωΔt = 0.035.
    assert!(energy.relative_error < 1e-7, "{:e}", energy.relative_error);
}

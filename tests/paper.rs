//! The paper's tests: drops of Table 6, statics of Table 4, against an independent time integration
//! of the same model (fourth-order Runge-Kutta at 20 µs, written apart from this code) and against
//! the paper's own numbers.

use crate::support::{run_leaf, set_step};
use ferrom::model::{Extreme, Trajectory};
use ferrom::simulate::Formulation;

/// Extremes of the pin about static equilibrium, mm, and their times, s.
type Table = [(f64, f64); 5];

const DROP_3: Table = [(-153.46, 0.1166), (127.40, 0.4142), (-61.90, 0.6749), (27.00, 0.9108), (-11.42, 1.1461)];
const DROP_1P8: Table = [(-88.99, 0.1279), (49.37, 0.3728), (-20.89, 0.6083), (8.84, 0.8435), (-3.74, 1.0788)];

fn pin(t: &Trajectory) -> &[Extreme] {
    &t.channel("pin height").expect("the channel").extremes
}

fn assert_near(found: &[Extreme], expected: &Table, millimetres: f64) {
    for (k, (e, (value, at))) in found.iter().zip(expected).enumerate() {
        assert!(
            (e.value * 1e3 - value).abs() < millimetres,
            "extreme {}: {} mm, expected {value}",
            k + 1,
            e.value * 1e3
        );
        // The reference prints times to 0.1 ms; an extreme is flat, so its time is the weaker number.
        assert!((e.t - at).abs() < 2e-4, "extreme {}: {} s, expected {at}", k + 1, e.t);
    }
    assert!(found.len() >= 5);
}

#[test]
fn drops_at_a_tenth_of_a_millisecond() {
    // 0.005 mm is the rounding of the reference's print, 0.005 more for either integration.
    assert_near(pin(&run_leaf("drop-3mps", |s| set_step(s, 1e-4))), &DROP_3, 0.01);
    assert_near(pin(&run_leaf("drop-1p8mps", |s| set_step(s, 1e-4))), &DROP_1P8, 0.01);
}

#[test]
fn drops_at_one_millisecond() {
    // Second order in the step: 0.04 mm at 1 ms, as the halving test below shows.
    assert_near(pin(&run_leaf("drop-3mps", |_| {})), &DROP_3, 0.06);
    assert_near(pin(&run_leaf("drop-1p8mps", |_| {})), &DROP_1P8, 0.06);
}

#[test]
fn forces_spread_and_sag_of_the_drop_at_3_mps() {
    let t = run_leaf("drop-3mps", |s| set_step(s, 1e-4));
    let range = |name: &str| t.channel(name).expect("the channel").range;
    let near = |found: f64, expected: f64, by: f64| assert!((found - expected).abs() < by, "{found} for {expected}");
    near(range("tire force c")[1].value, 2318.0, 1.0);
    near(range("tire side force d")[0].value, -1252.0, 1.0);
    // 100.0 mm on either side.
    near(range("tip spread")[1].value, 0.2000, 1e-4);
    near(t.channel("pin height").and_then(|c| c.at_rest).expect("an equilibrium"), -0.05359, 1e-5);
    // Both tyres carry the same and never pull.
    assert!(range("tire force c")[0].value >= 0.0 && range("tire force d")[0].value >= 0.0);
    near(range("tire force c")[1].value, range("tire force d")[1].value, 0.5);
    assert!(t.warnings.iter().any(|w| w.contains("beyond small deflection")), "{:?}", t.warnings);
}

#[test]
fn one_mode_alone_gives_its_own_row() {
    let t = run_leaf("drop-3mps", |s| {
        set_step(s, 1e-4);
        s.effect.flexibility = toml::from_str("modes = \"7\"").ok();
    });
    for (e, expected) in pin(&t).iter().zip([-152.71, 126.15, -60.63, 26.33, -11.25]) {
        assert!((e.value * 1e3 - expected).abs() < 0.01, "{} for {expected}", e.value * 1e3);
    }
}

/// Kept modes 7–17 plus residual flexibility are what the series of kept modes converges to: it
/// moves from 7–17 (−153.458 mm) over 7–30 (−153.537), 7–120 (−153.557), 7–400 (−153.581) to
/// −153.613. With any of these sets kept the residual vectors give the same −153.613.
#[test]
fn residual_flexibility_completes_the_series_of_modes() {
    let t = run_leaf("drop-3mps", |s| {
        set_step(s, 1e-4);
        s.switch("residual-flexibility", true);
    });
    let first = pin(&t)[0].value * 1e3;
    assert!((first + 153.613).abs() < 0.005, "{first}");
    // Nearer to 7–30 than 7–17 alone, and beyond it.
    assert!((first + 153.54).abs() < (-153.458_f64 + 153.54).abs());
}

#[test]
fn halving_the_step_shows_second_order() {
    let at = |step: f64| {
        let t = run_leaf("drop-3mps", |s| set_step(s, step));
        [pin(&t)[0].value, pin(&t)[2].value]
    };
    let exact = at(6.25e-6);
    let steps = [1e-3, 5e-4, 2.5e-4, 1.25e-4];
    let errors: Vec<f64> =
        steps.iter().map(|&h| at(h).iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)).collect();
    let order = (errors[0] / errors[3]).log2() / 3.0;
    // Kinks of the friction cap are not located, so single halvings scatter; over three the order shows.
    assert!(order > 1.7, "order {order}, errors {errors:?}");
    assert!(errors[0] < 5e-5, "{errors:?}");
}

#[test]
fn energy_balance_closes() {
    for (step, bound) in [(1e-3, 1e-3), (1e-4, 1e-5), (1e-5, 1e-7)] {
        let t = run_leaf("drop-3mps", |s| set_step(s, step));
        let energy = t.energy.expect("accounts");
        assert!(energy.relative_error < bound, "{step}: {:e}", energy.relative_error);
        let sum = |pairs: &[(String, f64)]| pairs.iter().map(|p| p.1).sum::<f64>();
        let gap = energy.initial + sum(&energy.input) - sum(&energy.stored) - sum(&energy.dissipated);
        assert!(gap.abs() <= energy.error * (1.0 + 1e-9), "{gap} {}", energy.error);
        assert!(energy.dissipated.iter().all(|d| d.1 >= 0.0));
    }
}

#[test]
fn static_loads_of_table_4() {
    let t = run_leaf("static", |_| {});
    let pin = &t.channel("pin deflection").expect("the channel").values;
    for (found, expected) in pin.iter().zip([-5.125, -10.249, -15.374, -20.499, -25.624]) {
        assert!((found * 1e3 - expected).abs() < 0.01, "{} for {expected}", found * 1e3);
    }
    let measured = [5.125, 10.250, 15.750, 21.000, 26.625];
    let worst = pin.iter().zip(measured).map(|(f, m)| (-f * 1e3 / m - 1.0).abs()).fold(0.0, f64::max);
    assert!((worst - 0.038).abs() < 5e-4, "{worst}");
}

/// Rigid leaf: 109.7 kg on two tyres. From touchdown to the first extreme nothing acts but springs,
/// dampers and weight: m z̈ + 2C ż + 2K z = −m g in closed form.
#[test]
fn rigid_formulation_is_the_closed_form_of_a_mass_on_two_tyres() {
    let t = run_leaf("drop-3mps", |s| {
        set_step(s, 1e-4);
        s.run.formulation = Formulation::Rigid;
    });
    let mass: f64 = 100.0 + 6.699475 + 3.0;
    let (k, c, g, v0) = (150_000.0_f64, 350.0_f64, 9.81, -3.0);
    let (omega, decay) = ((k / mass).sqrt(), c / (2.0 * mass));
    let damped = (omega * omega - decay * decay).sqrt();
    let sag = -mass * g / k;
    let a = -sag;
    let b = (v0 + decay * a) / damped;
    // ż = e^{−dt}[(b ω_d − a d) cos − (a ω_d + b d) sin] = 0.
    let mut at = ((b * damped - a * decay) / (a * damped + b * decay)).atan() / damped;
    if at < 0.0 {
        at += std::f64::consts::PI / damped;
    }
    let lowest = sag + (-decay * at).exp() * (a * (damped * at).cos() + b * (damped * at).sin());
    let channel = t.channel("pin height").expect("the channel");
    let rest = channel.at_rest.expect("an equilibrium");
    // Leaf mass known to 7 digits.
    assert!((rest - sag).abs() < 1e-8, "{rest} {sag}");
    // Forces linear over a step of h: relative error (ωh)²/12 = 1.1e-6 of an amplitude of 80 mm.
    assert!((channel.extremes[0].value + rest - lowest).abs() < 1e-7, "{} {lowest}", channel.extremes[0].value + rest);
    assert!((channel.extremes[0].t - at).abs() < 1e-6);
}

//! Promises every row of a table makes.

use crate::support::{run_leaf, set_step, set_until};
use ferrom::format::FORMATS;
use ferrom::modal::DAMPING_PRESETS;
use ferrom::rank::{CRITERIA, RULES};
use ferrom::reduce::METHODS;
use ferrom::simulate::{EFFECTS, FORMULATIONS, INTEGRATORS, PRESETS};

#[test]
fn names_in_a_table_differ_and_have_help() {
    let tables: [Vec<(&str, &str)>; 9] = [
        FORMATS.iter().map(|f| (f.name, f.help)).collect(),
        CRITERIA.iter().map(|c| (c.name, c.help)).collect(),
        RULES.to_vec(),
        METHODS.iter().map(|m| (m.name, m.help)).collect(),
        DAMPING_PRESETS.iter().map(|p| (p.0, p.2)).collect(),
        EFFECTS.iter().map(|e| (e.name, e.help)).collect(),
        FORMULATIONS.iter().map(|f| (f.name, f.help)).collect(),
        INTEGRATORS.iter().map(|i| (i.name, i.help)).collect(),
        PRESETS.iter().map(|p| (p.name, p.help)).collect(),
    ];
    for table in tables {
        for (k, (name, help)) in table.iter().enumerate() {
            assert!(!name.is_empty() && help.len() > 5, "{name}");
            assert!(table[..k].iter().all(|other| other.0 != *name), "{name} twice");
        }
    }
}

/// An effect that is not listed leaves the run bitwise the same, whatever its parameters say.
#[test]
fn an_absent_effect_changes_no_bit() {
    for effect in ["tire-lateral", "gravity", "structural-damping", "residual-flexibility", "applied-force"] {
        let without = |with_parameters: bool| {
            run_leaf("drop-3mps", |s| {
                set_until(s, 0.2);
                s.switch(effect, false);
                if !with_parameters {
                    match effect {
                        "tire-lateral" => s.effect.tire_lateral = None,
                        "gravity" => s.effect.gravity = None,
                        _ => {}
                    }
                    s.measure.retain(|m| !m.of.get_ref().starts_with(effect));
                }
            })
        };
        if effect == "tire-lateral" {
            // Its force channel needs the tyre only, so both runs keep it.
            assert_eq!(without(true).channels[0].values, without(false).channels[0].values);
        } else {
            assert_eq!(without(true).channels, without(false).channels, "{effect}");
        }
    }
}

#[test]
fn runs_repeat_to_the_bit() {
    let once = || run_leaf("drop-3mps", |_| {});
    let (a, b) = (once(), once());
    assert_eq!((a.channels, a.energy), (b.channels, b.energy));
}

/// Exact propagation has no step limit: 10 ms steps with modes of ωΔt = 37 and residual vectors far
/// above stay bounded and keep the energy account within a few per cent.
#[test]
fn long_steps_stay_stable() {
    for step in [5e-3, 1e-2] {
        let t = run_leaf("drop-3mps", |s| {
            set_step(s, step);
            s.switch("residual-flexibility", true);
        });
        let pin = t.channel("pin height").expect("the channel");
        assert!(pin.range[0].value > -0.17 && pin.range[1].value < 0.14, "{step}: {:?}", pin.range);
        assert!(t.energy.expect("accounts").relative_error < 0.05);
        assert!(t.warnings.iter().any(|w| w.contains("contact period")), "{:?}", t.warnings);
    }
}

/// Hinges that hold the same directions at both pins repeat constraints to rounding; the repeated
/// ones are left out and said so, and no mode is locked.
#[test]
fn redundant_hinges_do_not_lock_the_leaf() {
    let plain = run_leaf("static", |_| {});
    let hinged = run_leaf("drop-3mps", |s| {
        for (name, joint) in &mut s.joint {
            if ["a", "b"].contains(&name.get_ref().as_str()) {
                joint.holds = toml::Spanned::new(0..0, "x y z ry rz".into());
            }
        }
    });
    assert_eq!(plain.channels.len(), 2);
    let rest = hinged.channel("pin height").and_then(|c| c.at_rest);
    println!("hinged at both pins: rest {rest:?}, {:?}", hinged.warnings);
    let rest = rest.expect("an equilibrium");
    assert!(hinged.warnings.iter().any(|w| w.contains("redundant")), "{:?}", hinged.warnings);
    // Statically determinate sag is -53.59 mm; hinges that hold y at both pins stretch nothing.
    assert!((rest + 0.05359).abs() < 2e-3, "{rest}");
}

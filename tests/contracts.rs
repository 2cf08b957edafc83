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

/// Joints that repeat constraints, exactly or to rounding, are found dependent, said so, and change
/// nothing.
#[test]
fn redundant_joints_change_nothing() {
    let plain = run_leaf("drop-3mps", |_| {});
    let doubled = run_leaf("drop-3mps", |s| {
        for name in ["a", "axle-c", "guide"] {
            let (_, joint) = s.joint.iter().find(|j| j.0.get_ref() == name).expect("the joint");
            let mut copy = joint.clone();
            // The other way round: the same rows with the opposite sign.
            let [first, second] = copy.between.get_ref().clone();
            copy.between = toml::Spanned::new(0..0, [second, first]);
            s.joint.insert(toml::Spanned::new(0..0, format!("{name}-again")), copy);
        }
    });
    assert!(doubled.warnings.iter().any(|w| w.contains("redundant")), "{:?}", doubled.warnings);
    for (a, b) in plain.channels.iter().zip(&doubled.channels).filter(|c| c.0.unit == "m") {
        let worst = a.values.iter().zip(&b.values).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        // Another basis of the same space: rounding, through 1500 steps with contact.
        assert!(worst < 1e-9, "{}: {worst:e}", a.name);
    }
}

/// Hinges that hold y, r_y and r_z at both pins hold the leaf's stretch and twist between them; its
/// bending, which carries the load, must stay free.
#[test]
fn hinges_at_both_pins_do_not_lock_bending() {
    let hinged = run_leaf("drop-3mps", |s| {
        for (name, joint) in &mut s.joint {
            if ["a", "b"].contains(&name.get_ref().as_str()) {
                joint.holds = toml::Spanned::new(0..0, "x y z ry rz".into());
            }
        }
    });
    let rest = hinged.channel("pin height").and_then(|c| c.at_rest).expect("an equilibrium");
    // Statically determinate sag is -53.59 mm; a locked leaf would sag by the tyres' 7.17 mm.
    assert!((rest + 0.05359).abs() < 2e-4, "{rest}");
}

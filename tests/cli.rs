//! The command line as users and CI call it: exit codes, JSON keys, errors that write nothing.

use crate::support::at_root;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn ferrom(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ferrom"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the binary runs")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn json(arguments: &[&str]) -> Value {
    let output = ferrom(arguments);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{arguments:?}: {e}: {text}"))
}

/// A folder of its own under the target folder, empty.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("a folder");
    path
}

/// A copy of the two-mass chain with one file changed.
fn broken_chain(name: &str, file: &str, change: impl FnOnce(String) -> String) -> PathBuf {
    let path = folder(name);
    for entry in std::fs::read_dir(at_root("models/two-mass-chain")).expect("the folder") {
        let from = entry.expect("an entry").path();
        if from.is_file() {
            std::fs::copy(&from, path.join(from.file_name().expect("a name"))).expect("a copy");
        }
    }
    let recipe = path.join("model.toml");
    let text = std::fs::read_to_string(&recipe).expect("a recipe");
    std::fs::write(&recipe, text.replace("[reduce]", "[reduce]\noutput = \"out.h5\"")).expect("a recipe");
    let target = path.join(file);
    let text = std::fs::read_to_string(&target).expect("a file");
    let changed = change(text.clone());
    assert_ne!(changed, text, "{file} did not change");
    std::fs::write(&target, changed).expect("a file");
    path
}

/// The command fails with the code and a message that has every part, and writes nothing.
fn refused(path: &Path, expected_code: i32, parts: &[&str]) {
    let before: usize = std::fs::read_dir(path).expect("the folder").count();
    let output = ferrom(&["reduce", path.to_str().expect("UTF-8")]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(code(&output), expected_code, "{message}");
    for part in parts {
        assert!(message.contains(part), "\"{part}\" is missing in: {message}");
    }
    assert!(output.stdout.is_empty());
    assert_eq!(std::fs::read_dir(path).expect("the folder").count(), before, "something was written");
}

#[test]
fn usage_errors_exit_with_2() {
    assert_eq!(code(&ferrom(&["fly"])), 2);
    assert_eq!(code(&ferrom(&["rank"])), 2);
    assert_eq!(code(&ferrom(&["modes", "models/leaf-spring", "--threads", "0"])), 2);
    assert_eq!(code(&ferrom(&["--help"])), 0);
    for verb in ["run", "inspect", "modes", "rank", "reduce", "check", "simulate", "list"] {
        let help = ferrom(&[verb, "--help"]);
        assert!(String::from_utf8_lossy(&help.stdout).contains("Example"), "{verb} has no example");
    }
}

#[test]
fn missing_file() {
    let output = ferrom(&["modes", "models/no-such-model", "--json"]);
    assert_eq!(code(&output), 3);
    assert!(output.stdout.is_empty());
    refused(
        &broken_chain("missing", "model.toml", |t| t.replace("mass.mtx", "masses.mtx")),
        3,
        &["masses.mtx", "cannot be read"],
    );
}

#[test]
fn unknown_key_names_line_and_nearest_key() {
    let path = broken_chain("unknown-key", "model.toml", |t| t.replace("ratio = 0", "ration = 0"));
    refused(&path, 3, &["model.toml:", "ration", "ratio"]);
}

#[test]
fn repeated_dof_label() {
    let path = broken_chain("repeated", "chain.dof", |t| t.replace("2.1", "1.1"));
    refused(&path, 3, &["chain.dof:2", "1.x"]);
}

#[test]
fn joint_on_a_node_that_does_not_exist() {
    let path = broken_chain("no-node", "model.toml", |t| t.replace("node = 2", "node = 77"));
    refused(&path, 3, &["model.toml:", "77", "not in the mesh"]);
}

#[test]
fn nan_in_a_matrix() {
    let path = broken_chain("nan", "stiffness.mtx", |t| t.replace("2 2 1000", "2 2 NaN"));
    refused(&path, 3, &["stiffness.mtx:", "NaN"]);
}

#[test]
fn truncated_matrix() {
    let path = broken_chain("truncated", "mass.mtx", |t| t.replace("2 2 4\n", ""));
    refused(&path, 3, &["mass.mtx", "2"]);
    // The same for a CalculiX file cut in the middle of a line.
    let cut = folder("truncated-sti");
    std::fs::write(cut.join("k.sti"), "1 1 2.0E+00\n1 2 -1.0E+00\n2 2").expect("a file");
    std::fs::write(cut.join("m.mas"), "1 1 1.0E+00\n2 2 1.0E+00\n").expect("a file");
    let output = ferrom(&[
        "modes",
        "--stiffness",
        cut.join("k.sti").to_str().expect("UTF-8"),
        "--mass",
        cut.join("m.mas").to_str().expect("UTF-8"),
    ]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(code(&output), 3, "{message}");
    assert!(message.contains("k.sti:3"), "{message}");
}

#[test]
fn damping_must_be_stated() {
    let path = broken_chain("undamped", "model.toml", |t| t.replace("[damping]\nratio = 0\n", ""));
    refused(&path, 3, &["model.toml", "damping"]);
    let path =
        broken_chain("twice-damped", "model.toml", |t| t.replace("ratio = 0\n", "ratio = 0\npreset = \"adams\"\n"));
    refused(&path, 3, &["model.toml:", "exactly one of"]);
}

#[test]
fn units_with_the_wrong_dimension() {
    let path = broken_chain("units", "push.toml", |t| t.replace("\"10 N\"", "\"10 kg\""));
    let reduced = path.join("out.h5");
    assert_eq!(code(&ferrom(&["reduce", path.to_str().expect("UTF-8")])), 0);
    assert!(reduced.is_file());
    let output = ferrom(&["simulate", path.join("push.toml").to_str().expect("UTF-8")]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(code(&output), 3);
    assert!(message.contains("push.toml:") && message.contains("kg"), "{message}");
}

#[test]
fn scenes_that_cannot_be_built_name_the_line() {
    let scene = std::fs::read_to_string(at_root("models/leaf-spring/drop-3mps.toml")).expect("a scene");
    let path = folder("scenes");
    let reduced = at_root("reduced/leaf-spring.h5");
    let scene = scene.replace("../../reduced/leaf-spring.h5", reduced.to_str().expect("UTF-8"));
    let cases: [(&str, &str, &[&str]); 13] = [
        ("\"gravity\",\n", "\"gravity\",\n  \"gravity\",\n", &["listed twice"]),
        ("between = [\"load\", \"leaf:b\"]", "between = [\"leaf:b\", \"leaf:b\"]", &["to itself"]),
        ("inertia = [\"3.45e-3 kg m^2\", \"5.62e-3 kg m^2\", \"3.45e-3 kg m^2\"] #", "#", &["axle-c", "no inertia"]),
        ("[start] #", "[start]\nheight = \"-1 m\" #", &["start height", "-1"]),
        ("radius = \"0.1 m\"", "radius = \"-0.1 m\"", &["radius", "above zero"]),
        ("step = \"1 ms\"", "step = \"0 ms\"", &[":16", "above zero"]),
        ("\"tire-lateral\",\n]", "\"tire-latteral\",\n]", &[":11", "tire-lateral"]),
        ("between = [\"load\", \"leaf:b\"]", "between = [\"load\", \"leaf:q\"]", &["leaf", "\"q\""]),
        ("mass = \"100 kg\"", "mass = \"0 kg\"", &["0 kg", "above zero"]),
        ("stiffness = \"75000 N/m\"", "stiffness = \"-75000 N/m\"", &["stiffness", "-75000"]),
        ("of = \"leaf:b:z\"\ndatum", "of = \"leaf:b:w\"\ndatum", &["leaf:b:w"]),
        ("channel = \"pin height\"", "channel = \"pin hight\"", &["pin hight", "pin height"]),
        ("holds = \"prismatic-z\"", "holds = \"fixed\"", &["start speed"]),
    ];
    for (k, (from, to, parts)) in cases.iter().enumerate() {
        assert!(scene.contains(from), "{from}");
        let file = path.join(format!("case-{k}.toml"));
        std::fs::write(&file, scene.replacen(from, to, 1)).expect("a file");
        let output = ferrom(&["simulate", file.to_str().expect("UTF-8")]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(code(&output), 3, "{to}: {message}");
        for part in *parts {
            assert!(message.contains(part), "{to}: \"{part}\" is missing in: {message}");
        }
    }
}

#[test]
fn check_passes_on_7_to_17_and_fails_on_7_to_16() {
    let good = ferrom(&["check", "models/leaf-spring", "--modes", "7-17"]);
    assert_eq!(code(&good), 0, "{}", String::from_utf8_lossy(&good.stdout));
    let bad = ferrom(&["check", "models/leaf-spring", "--modes", "7-16"]);
    let text = String::from_utf8_lossy(&bad.stdout).into_owned();
    assert_eq!(code(&bad), 5);
    assert!(text.contains("FAILED") && text.contains("7-16") && text.contains("7-17"), "{text}");
    let object = json(&["check", "reduced/leaf-spring.h5", "--modes", "7-16", "--json"]);
    assert_eq!(object["ok"], false);
    assert_eq!(object["found"].as_array().map(Vec::len), Some(11));
    assert_eq!(object["expected"].as_array().map(Vec::len), Some(10));
    assert_eq!(object["differences"][0]["what"], "selection");
}

#[test]
fn json_has_the_promised_keys() {
    let keys = |object: &Value, expected: &[&str]| {
        for key in expected {
            assert!(object.get(key).is_some(), "\"{key}\" is missing in {object}");
        }
    };
    let modes = json(&["modes", "models/leaf-spring", "-n", "20", "--json"]);
    keys(&modes, &["rigid", "modes", "complete", "warnings"]);
    keys(&modes["modes"][6], &["number", "omega", "hz", "residual", "origin"]);
    keys(&modes["complete"], &["proved", "count", "below"]);
    assert_eq!(modes["rigid"], 6);
    let rank = json(&["rank", "models/leaf-spring", "--json"]);
    keys(&rank, &["criterion", "input", "output", "scores", "selected", "reason"]);
    assert_eq!(rank["selected"], serde_json::json!((7..=17).collect::<Vec<u32>>()));
    let inspect = json(&["inspect", "models/leaf-spring", "--json"]);
    keys(&inspect, &["format", "dofs", "nonzeros", "mass_kg"]);
    assert!((inspect["mass_kg"].as_f64().expect("a number") - 6.699475).abs() < 1e-6);
    let out = folder("json").join("leaf.h5");
    let reduce = json(&["reduce", "models/leaf-spring", "-o", out.to_str().expect("UTF-8"), "--json"]);
    keys(&reduce, &["selected", "kept_dofs", "bytes", "file"]);
    let drop = json(&["simulate", "models/leaf-spring/drop-3mps.toml", "--json"]);
    keys(&drop, &["channels", "extremes", "static", "energy", "effects", "stats", "warnings"]);
    keys(&drop["stats"], &["steps", "wall_s", "step_s", "real_time_factor"]);
    keys(&drop["extremes"]["pin height"][0], &["t", "value"]);
    keys(&json(&["list", "--json"]), &["formats", "criteria", "methods", "effects", "integrators"]);
}

#[test]
fn a_reduced_model_is_written_the_same_twice() {
    let path = folder("twice");
    let files = ["a.h5", "b.h5"].map(|n| path.join(n));
    for file in &files {
        let output = ferrom(&["reduce", "models/leaf-spring", "-o", file.to_str().expect("UTF-8"), "--state-space"]);
        assert_eq!(code(&output), 0);
    }
    assert!(std::fs::read(&files[0]).expect("a file") == std::fs::read(&files[1]).expect("a file"));
}

#[test]
fn the_main_job_runs_and_keeps_what_is_committed() {
    let committed = std::fs::read(at_root("reduced/leaf-spring.h5")).expect("the committed model");
    let report = folder("report");
    let object = json(&["run", "models/leaf-spring", "--report", report.to_str().expect("UTF-8"), "--json"]);
    assert_eq!(object["check"]["ok"], true);
    assert_eq!(object["scenes"].as_object().map(serde_json::Map::len), Some(3));
    for file in object["report"]["files"].as_array().expect("files") {
        let path = file.as_str().expect("a path");
        assert!(std::fs::metadata(path).is_ok_and(|m| m.len() > 100), "{path}");
    }
    assert!(std::fs::read(at_root("reduced/leaf-spring.h5")).expect("the model") == committed);
}

#[test]
fn a_summary_never_overwrites_another_file() {
    let path = broken_chain("overwrite", "push.toml", |t| t + "\n");
    let scene = std::fs::read_to_string(path.join("push.toml")).expect("a scene");
    let model = path.to_str().expect("UTF-8");
    for name in ["push.h5", "model.h5"] {
        let output = ferrom(&["reduce", model, "-o", path.join(name).to_str().expect("UTF-8")]);
        assert_eq!(code(&output), 3, "{name}");
        assert!(!path.join(name).exists());
    }
    assert_eq!(std::fs::read_to_string(path.join("push.toml")).expect("a scene"), scene);
}

#[test]
fn exchanged_matrices_are_told() {
    let path = folder("exchanged");
    for entry in std::fs::read_dir(at_root("models/free-free-beam")).expect("the folder") {
        let from = entry.expect("an entry").path();
        std::fs::copy(&from, path.join(from.file_name().expect("a name"))).expect("a copy");
    }
    std::fs::rename(path.join("mass.mtx"), path.join("other.mtx")).expect("a move");
    std::fs::rename(path.join("stiffness.mtx"), path.join("mass.mtx")).expect("a move");
    std::fs::rename(path.join("other.mtx"), path.join("stiffness.mtx")).expect("a move");
    let output = ferrom(&["modes", path.to_str().expect("UTF-8")]);
    assert_eq!(code(&output), 3);
    assert!(String::from_utf8_lossy(&output.stderr).contains("exchanged"));
}

#[test]
fn undamped_modes_have_no_peak() {
    let path = broken_chain("peak", "model.toml", |t| t.replace("static-gain", "peak-gain"));
    refused(&path, 3, &["model.toml:", "not finite", "static-gain"]);
}

#[test]
fn fewer_modes_than_rigid_ones_are_not_cut() {
    let modes = json(&["modes", "models/leaf-spring", "-n", "1", "--json"]);
    assert_eq!((&modes["rigid"], &modes["complete"]["proved"]), (&Value::from(6), &Value::from(true)));
}

#[test]
fn a_run_that_blows_up_is_refused() {
    let scene = std::fs::read_to_string(at_root("models/leaf-spring/drop-3mps.toml")).expect("a scene");
    let reduced = at_root("reduced/leaf-spring.h5");
    let scene = scene
        .replace("../../reduced/leaf-spring.h5", reduced.to_str().expect("UTF-8"))
        .replace("damping = \"175 N s/m\"", "damping = \"1e12 N s/m\"");
    let file = folder("blow-up").join("drop.toml");
    std::fs::write(&file, scene).expect("a file");
    let output = ferrom(&["simulate", file.to_str().expect("UTF-8")]);
    assert_eq!(code(&output), 4, "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_closed_pipe_is_no_panic() {
    let output = Command::new("sh")
        .args(["-c", &format!("{} list | head -1; exit ${{PIPESTATUS:-0}}", env!("CARGO_BIN_EXE_ferrom"))])
        .output()
        .expect("a shell");
    assert!(!String::from_utf8_lossy(&output.stderr).contains("panicked"));
}

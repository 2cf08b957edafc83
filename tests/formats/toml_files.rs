//! Recipes and scenes: errors with file, line and the nearest known key.

use super::{Folder, assert_says};
use ferrom::format::{nearest, parse_toml, toml_error_at};
use serde::Deserialize;

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
struct Recipe {
    #[allow(dead_code)]
    name: String,
    source: Files,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
struct Files {
    stiffness: toml::Spanned<String>,
    #[allow(dead_code)]
    rule: Option<Rule>,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Rule {
    LastAbove,
    EachAbove,
}

#[test]
fn errors_carry_the_line_and_the_nearest_key() {
    let folder = Folder::new();
    let cases: [(&str, usize, &[&str]); 7] = [
        (
            "name = \"a\"\n[source]\nstiffness = \"k\"\nstifness = \"k\"\n",
            4,
            &["unknown key `stifness`", "did you mean `stiffness`?"],
        ),
        ("name = \"a\"\n[sorce]\n", 2, &["unknown key `sorce`", "did you mean `source`?"]),
        (
            "name = \"a\"\n[source]\nstiffness = \"k\"\nrule = \"last-abov\"\n",
            4,
            &["unknown variant `last-abov`", "`last-above`?"],
        ),
        ("name = \"a\"\n\n[source]\n", 3, &["missing key `stiffness`"]),
        ("name = \"a\"\n[source]\nstiffness = 3\n", 3, &["invalid type", "string"]),
        ("name = \"a\"\n[source\n", 2, &[]),
        ("name = \"a\"\nname = \"b\"\n[source]\nstiffness = \"k\"\n", 2, &["duplicate key"]),
    ];
    for (text, line, words) in cases {
        assert_says(parse_toml::<Recipe>(&folder.write("model.toml", text)), line, words);
    }
    assert_says(parse_toml::<Recipe>(&folder.write("model.toml", b"name = 1\n# \xff\n")), 2, &["UTF-8"]);
    assert_says(parse_toml::<Recipe>(&folder.path("none.toml")), 0, &["cannot be read"]);
}

#[test]
fn later_errors_find_their_line_again() {
    let folder = Folder::new();
    let path = folder.write("model.toml", "name = \"a\"\n[source]\n\nstiffness = \"k\"\nrule = \"each-above\"\n");
    let (recipe, text) = parse_toml::<Recipe>(&path).expect("good");
    assert!(matches!(recipe.source.rule, Some(Rule::EachAbove)));
    assert_eq!(recipe.source.stiffness.get_ref(), "k");
    let error = toml_error_at(&path, &text, recipe.source.stiffness.span(), "no such file");
    assert_says(Err::<(), _>(error), 4, &["model.toml:4: no such file"]);
}

#[test]
fn a_name_far_from_all_others_gets_no_suggestion() {
    assert_eq!(nearest("peak-gian", ["static-gain", "peak-gain", "h2"]), Some("peak-gain"));
    assert_eq!(nearest("qqq", ["static-gain", "peak-gain", "h2"]), None);
}

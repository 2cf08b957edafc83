//! The allowed-uses table of lib.rs holds: every `crate::x` in the sources stands in the table, every
//! entry of the table occurs in the sources, and a module uses only modules listed above it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A line of the table: a module and the modules it may use.
type Table = Vec<(String, BTreeSet<String>)>;
/// What each top-level module uses, with one file that does so.
type Uses = BTreeMap<String, BTreeMap<String, PathBuf>>;

// ---------------------------------------------------------------- the table

/// The lines "module <- used used …" in the docs of lib.rs.
fn parse_table(lib: &str) -> Table {
    let doc = lib.lines().filter_map(|line| line.strip_prefix("//!"));
    let rows = doc.filter_map(|line| line.split_once("<-"));
    rows.map(|(module, used)| (module.trim().to_owned(), used.split_whitespace().map(str::to_owned).collect()))
        .collect()
}

/// Modules listed twice, and uses that do not point to a line above: with none, there is no cycle.
fn faults_of_table(table: &Table) -> Vec<String> {
    let mut above = BTreeSet::new();
    let mut faults = Vec::new();
    for (module, used) in table {
        for name in used.difference(&above) {
            faults.push(format!("table: {module} <- {name}: {name} does not stand above {module}"));
        }
        if !above.insert(module.clone()) {
            faults.push(format!("table: {module} stands twice"));
        }
    }
    faults
}

// ---------------------------------------------------------------- the sources

/// Source text with comments, strings and characters blanked; what remains is code.
fn code_only(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut code = String::with_capacity(text.len());
    let mut k = 0;
    while k < chars.len() {
        let end = end_of_blank(&chars, k);
        if end > k {
            code.push(' ');
            k = end;
        } else {
            code.push(chars[k]);
            k += 1;
        }
    }
    code
}

/// Where a comment, string or character that begins at `k` ends; `k` when none begins there.
fn end_of_blank(chars: &[char], k: usize) -> usize {
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let inside_word = k > 0 && (at(k - 1).is_alphanumeric() || at(k - 1) == '_');
    match (at(k), at(k + 1)) {
        ('/', '/') => (k..chars.len()).find(|&i| at(i) == '\n').unwrap_or(chars.len()),
        ('/', '*') => end_of_block_comment(chars, k),
        ('"', _) => end_of_quote(chars, k + 1, '"'),
        // A lifetime has no closing quote behind its first character.
        ('\'', '\\') => end_of_quote(chars, k + 1, '\''),
        ('\'', _) if at(k + 2) == '\'' => k + 3,
        ('r', '"' | '#') if !inside_word => end_of_raw_string(chars, k),
        ('b' | 'c', 'r') if !inside_word && matches!(at(k + 2), '"' | '#') => end_of_raw_string(chars, k + 1),
        _ => k,
    }
}

/// Block comments nest.
fn end_of_block_comment(chars: &[char], start: usize) -> usize {
    let (mut depth, mut k) = (0, start);
    while k < chars.len() {
        match (chars[k], chars.get(k + 1)) {
            ('/', Some('*')) => (depth, k) = (depth + 1, k + 2),
            ('*', Some('/')) => (depth, k) = (depth - 1, k + 2),
            _ => k += 1,
        }
        if depth == 0 {
            return k;
        }
    }
    k
}

fn end_of_quote(chars: &[char], start: usize, quote: char) -> usize {
    let mut k = start;
    while k < chars.len() && chars[k] != quote {
        k += if chars[k] == '\\' { 2 } else { 1 };
    }
    (k + 1).min(chars.len())
}

/// r"…", r#"…"#: `start` is at the r. A raw identifier such as r#type is no string.
fn end_of_raw_string(chars: &[char], start: usize) -> usize {
    let hashes = chars[start + 1..].iter().take_while(|&&c| c == '#').count();
    let open = start + 1 + hashes;
    if chars.get(open) != Some(&'"') {
        return start;
    }
    let closes = |i: usize| chars[i] == '"' && chars[i + 1..].iter().take_while(|&&c| c == '#').count() >= hashes;
    (open + 1..chars.len()).find(|&i| closes(i)).map_or(chars.len(), |i| i + 1 + hashes)
}

/// Words, `::`, and single characters of the code.
fn tokens(code: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let word = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let length = match first {
            _ if word > 0 => word,
            ':' if rest.starts_with("::") => 2,
            _ => first.len_utf8(),
        };
        if !first.is_whitespace() {
            found.push(rest[..length].to_owned());
        }
        rest = &rest[length..];
    }
    found
}

/// The index behind the bracket that closes the one at `open`.
fn behind_bracket(tokens: &[String], open: usize) -> usize {
    let mut depth = 0usize;
    for (k, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return k + 1;
        }
    }
    tokens.len()
}

/// The tokens without `#[cfg(test)] mod x { … }`: tests may use what they like.
fn without_test_modules(tokens: &[String]) -> Vec<String> {
    let attribute = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::with_capacity(tokens.len());
    let mut k = 0;
    while k < tokens.len() {
        let is_test = tokens[k..].iter().zip(attribute).filter(|(a, b)| *a == b).count() == attribute.len();
        let module = k + attribute.len();
        if is_test && tokens.get(module).is_some_and(|t| t == "mod") {
            let body = module + 2;
            k = if tokens.get(body).is_some_and(|t| t == "{") { behind_bracket(tokens, body) } else { body + 1 };
        } else {
            kept.push(tokens[k].clone());
            k += 1;
        }
    }
    kept
}

/// First names behind `root::`, in plain paths and in groups `root::{a, b::c, d::{e, f}}`.
fn names_behind(tokens: &[String], root: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for k in 0..tokens.len() {
        if tokens[k] != root || tokens.get(k + 1).is_none_or(|t| t != "::") {
            continue;
        }
        match tokens.get(k + 2).map(String::as_str) {
            Some("{") => names.extend(names_of_group(tokens, k + 2)),
            Some(name) => _ = names.insert(name.to_owned()),
            None => {}
        }
    }
    names
}

/// The first name of each item of the group that opens at `open`.
fn names_of_group(tokens: &[String], open: usize) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let (mut k, mut item_begins) = (open + 1, true);
    while k < tokens.len() && tokens[k] != "}" {
        match tokens[k].as_str() {
            "{" => {
                k = behind_bracket(tokens, k);
                continue;
            }
            "," => item_begins = true,
            name if item_begins => {
                names.insert(name.to_owned());
                item_begins = false;
            }
            _ => {}
        }
        k += 1;
    }
    names
}

/// Top-level modules that the code of a file uses. In the file of a top-level module `super` is the
/// crate too; `main` sees the crate as `ferrom`.
fn modules_used(text: &str, module: &str, is_top_file: bool) -> BTreeSet<String> {
    let tokens = without_test_modules(&tokens(&code_only(text)));
    let mut names = names_behind(&tokens, "crate");
    if is_top_file {
        names.extend(names_behind(&tokens, "super"));
    }
    if module == "main" {
        names.extend(names_behind(&tokens, "ferrom"));
    }
    names.remove(module);
    names
}

/// All .rs files below a folder, sorted.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("folder").map(|e| e.expect("entry").path()) {
        if entry.is_dir() {
            files.extend(rust_files(&entry));
        } else if entry.extension().is_some_and(|e| e == "rs") {
            files.push(entry);
        }
    }
    files.sort();
    files
}

fn source_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file: path below src/, text.
fn sources() -> Vec<(PathBuf, String)> {
    let root = source_folder();
    let read = |p: &PathBuf| fs::read_to_string(p).expect("UTF-8 source");
    rust_files(&root).iter().map(|p| (p.strip_prefix(&root).expect("below src").to_owned(), read(p))).collect()
}

/// The top-level module of a path below src/: its folder, or its name.
fn top_module(path: &Path) -> String {
    let first = path.components().next().expect("a file has a name").as_os_str();
    first.to_string_lossy().trim_end_matches(".rs").to_owned()
}

fn uses_of_sources() -> Uses {
    let mut uses = Uses::new();
    for (path, text) in sources() {
        let module = top_module(&path);
        if module == "lib" {
            continue;
        }
        let depth = path.components().count();
        let is_top_file = depth == 1 || (depth == 2 && path.ends_with("mod.rs"));
        let names = modules_used(&text, &module, is_top_file);
        let of_module = uses.entry(module).or_default();
        names.into_iter().for_each(|name| _ = of_module.entry(name).or_insert_with(|| path.clone()));
    }
    uses
}

/// Where table and code differ, in words.
fn differences(table: &Table, uses: &Uses) -> Vec<String> {
    let mut found = Vec::new();
    for (module, used) in uses {
        let Some((_, allowed)) = table.iter().find(|row| row.0 == *module) else {
            found.push(format!("src has module {module}, the table of lib.rs does not list it"));
            continue;
        };
        for (name, path) in used.iter().filter(|(name, _)| !allowed.contains(*name)) {
            found.push(format!("src/{}: {module} may not use {name}", path.display()));
        }
        for name in allowed.iter().filter(|name| !used.contains_key(*name)) {
            found.push(format!("the table allows {module} <- {name}, which nothing in {module} uses"));
        }
    }
    for (module, _) in table.iter().filter(|row| !uses.contains_key(&row.0)) {
        found.push(format!("the table of lib.rs lists {module}, which is not in src"));
    }
    found
}

fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

// ---------------------------------------------------------------- the house

#[test]
fn code_uses_exactly_what_the_table_allows() {
    let lib = fs::read_to_string(source_folder().join("lib.rs")).expect("lib.rs");
    let table = parse_table(&lib);
    assert!(table.len() > 5, "no table of allowed uses found in the docs of lib.rs");
    assert_none(&differences(&table, &uses_of_sources()));
}

#[test]
fn table_looks_only_up() {
    let lib = fs::read_to_string(source_folder().join("lib.rs")).expect("lib.rs");
    assert_none(&faults_of_table(&parse_table(&lib)));
}

#[test]
fn every_file_says_what_it_is() {
    let says = |text: &str| text.strip_prefix("//! ").is_some_and(|t| t.lines().next().is_some_and(|l| l.len() > 10));
    let silent = sources().into_iter().filter(|(_, text)| !says(text));
    assert_none(
        &silent
            .map(|(p, _)| format!("src/{}: begin with a //! line that says what it is", p.display()))
            .collect::<Vec<_>>(),
    );
}

#[test]
fn nobody_reaches_over_two_levels() {
    let reaches = |text: &str| names_behind(&tokens(&code_only(text)), "super").contains("super");
    let faults = sources().into_iter().filter(|(_, text)| reaches(text));
    assert_none(
        &faults
            .map(|(p, _)| format!("src/{}: super::super; name the path from crate", p.display()))
            .collect::<Vec<_>>(),
    );
}

// ---------------------------------------------------------------- the reader itself

fn used(text: &str) -> Vec<String> {
    modules_used(text, "rank", false).into_iter().collect()
}

#[test]
fn uses_are_found_in_paths_groups_and_nested_groups() {
    assert_eq!(used("use crate::model::Modes;"), ["model"]);
    assert_eq!(used("use crate::{frf, model::{dof::Dof, Modes}, linalg as l};"), ["frf", "linalg", "model"]);
    assert_eq!(used("use { crate::cli::run, std::fmt };"), ["cli"]);
    assert_eq!(used("fn f() -> crate::model::Modes { let x = 'a'; crate :: frf::h(x) }"), ["frf", "model"]);
    assert_eq!(used("pub(in crate::rank) fn f<'a>(x: &'a str) { crate::rank::g() }"), Vec::<String>::new());
    assert_eq!(used("use crate::*;"), ["*"]);
}

#[test]
fn uses_in_comments_strings_and_test_modules_are_ignored() {
    assert!(used("// crate::cli\n/* crate::cli /* nested */ crate::cli */ //! crate::cli").is_empty());
    assert!(used(r##"const A: &str = "crate::cli \" crate::cli"; const B: &str = r#"" crate::cli "#;"##).is_empty());
    assert!(used("#[cfg(test)]\nmod tests { use crate::cli; mod a { use crate::cli; } }").is_empty());
    assert_eq!(used("#[cfg(test)] mod tests { use crate::cli; } use crate::frf;"), ["frf"]);
    assert_eq!(used("#[cfg(test)] mod tests;\nuse crate::frf;"), ["frf"]);
    assert_eq!(used("const Q: char = '\"'; use crate::frf; const R: char = '\\'';"), ["frf"]);
    assert_eq!(used("const Q: &[u8] = br\"x\"; fn f(r#type: u8) { crate::frf::h() }"), ["frf"]);
}

#[test]
fn super_of_a_top_file_is_the_crate() {
    let text = "use super::model::Modes;";
    assert_eq!(modules_used(text, "frf", true).into_iter().collect::<Vec<_>>(), ["model"]);
    assert!(modules_used(text, "frf", false).is_empty());
    assert!(modules_used("fn main() { ferrom::cli::run() }", "main", true).contains("cli"));
}

#[test]
fn table_faults_are_seen() {
    let table = parse_table("//! a <-\n//! b <- a c\n//! c <- b\n//! c <- c\nfn x() { y <- z }");
    let faults = faults_of_table(&table);
    assert_eq!(faults.len(), 2, "{faults:?}");
    assert!(faults[0].contains("b <- c") && faults[1].contains("twice"));
}

#[test]
fn differences_are_seen_both_ways() {
    let table = parse_table("//! a <-\n//! b <- a\n//! gone <-");
    let file = || PathBuf::from("x.rs");
    let uses = Uses::from([
        ("a".into(), BTreeMap::from([("b".into(), file())])),
        ("b".into(), BTreeMap::new()),
        ("new".into(), BTreeMap::new()),
    ]);
    let found = differences(&table, &uses).join("\n");
    for part in ["a may not use b", "b <- a, which nothing", "module new", "lists gone"] {
        assert!(found.contains(part), "{part} not in\n{found}");
    }
}

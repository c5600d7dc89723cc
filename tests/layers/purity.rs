//! Purity: no production line of a core names a clock, a file, a socket, a thread, the environment or chance, iterates in
//! random order, or computes with functions whose last bits differ from machine to machine.

use crate::PURE_CRATES;
use crate::source::{Token, production_tokens};
use std::path::{Path, PathBuf};

/// Modules of `std` that are the outside world.
const OUTSIDE: [&str; 8] = ["env", "fs", "io", "net", "os", "process", "random", "thread"];

/// Types that are the outside world, or iterate in an order that differs from run to run.
const WORDS: [(&str, &str); 5] = [
    ("SystemTime", "time comes in with the event"),
    ("Instant", "time comes in with the event"),
    ("HashMap", "use BTreeMap: its order is fixed"),
    ("HashSet", "use BTreeSet: its order is fixed"),
    ("RandomState", "chance comes from a seed"),
];

/// Macros that read or write what no event and no sink carries.
const MACROS: [&str; 7] = ["dbg", "env", "eprint", "eprintln", "option_env", "print", "println"];

/// What IEEE 754 leaves open: the platform's own version differs in the last bit; `libm`'s does not. (`sqrt` is exact.)
const INEXACT: [&str; 27] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp", "exp2", "exp_m1",
    "hypot", "ln", "ln_1p", "log", "log10", "log2", "powf", "powi", "sin", "sin_cos", "sinh", "tan", "tanh", "angle",
];

/// Rotations of nalgebra, which compute with the platform's sine and cosine.
const ROTATIONS: [&str; 4] = ["Isometry2", "Rotation2", "UnitComplex", "UnitQuaternion"];

/// What is wrong with `source`: line and complaint.
fn violations(source: &str) -> Vec<(usize, String)> {
    let tokens = production_tokens(source);
    let texts: Vec<&str> = tokens.iter().map(|token| &*token.text).collect();
    let at = |(index, token): (usize, &Token)| Some((token.line, complaint(&texts[..index], &texts[index..])?));
    tokens.iter().enumerate().filter_map(at).collect()
}

/// What is wrong with the first word of `here`, which stands behind `before`.
fn complaint(before: &[&str], here: &[&str]) -> Option<String> {
    let word = here[0];
    let next = |offset: usize| here.get(offset).copied().unwrap_or_default();
    if word == "std" && next(1) == ":" {
        return from_std(&here[3..])
            .map(|module| format!("std::{module}: cores touch the outside through events alone"));
    }
    if let Some((_, why)) = WORDS.iter().find(|(banned, _)| *banned == word && is_from_std(before, here)) {
        return Some(format!("{word}: {why}"));
    }
    if MACROS.contains(&word) && next(1) == "!" {
        return Some(format!("{word}!: cores speak through the sink alone"));
    }
    if INEXACT.contains(&word) && is_computed(before, here) {
        return Some(format!("{word}: its last bits differ from machine to machine, use libm"));
    }
    let is_rotation = ROTATIONS.contains(&word) && matches!(next(3), "new" | "from_angle" | "from_euler_angles");
    is_rotation.then(|| format!("{word}::{}: it computes with the platform's sine, use libm::sincos", next(3)))
}

/// The banned module that a path behind `std::`, or a list of paths in braces, begins with.
fn from_std<'a>(path: &[&'a str]) -> Option<&'a str> {
    if path.first() != Some(&"{") {
        return path.first().copied().filter(|module| OUTSIDE.contains(module));
    }
    let mut depth = 0;
    for pair in path.windows(2) {
        depth += i32::from(pair[0] == "{") - i32::from(pair[0] == "}");
        if depth == 0 {
            return None;
        }
        if depth == 1 && matches!(pair[0], "{" | ",") && OUTSIDE.contains(&pair[1]) {
            return Some(pair[1]);
        }
    }
    None
}

/// Whether a banned type is meant: all of them where they are imported or called, not a type of ours with such a name.
fn is_from_std(before: &[&str], here: &[&str]) -> bool {
    here[0] != "Instant" || before.ends_with(&["time", ":", ":"]) || here.get(3) == Some(&"now")
}

/// Whether the word is a function of a floating point number: `.sin(`, `f64::sin`; not `libm::sin(`, not `sink.log(`.
fn is_computed(before: &[&str], here: &[&str]) -> bool {
    let is_method = before.last() == Some(&".") && here.get(1) == Some(&"(") && !before.ends_with(&["sink", "."]);
    is_method || before.ends_with(&["f64", ":", ":"]) || before.ends_with(&["f32", ":", ":"])
}

/// Where the camera's node reads devices and files: in front of its core, as the test of its layers says too.
const EXEMPT: &str = "nodes/overhead_camera/src/source";

fn pure_sources(root: &Path) -> Vec<PathBuf> {
    let nodes = std::fs::read_dir(root.join("nodes")).unwrap().map(|entry| entry.unwrap().path());
    let mut sources = Vec::new();
    for package in PURE_CRATES.map(|name| root.join("crates").join(name)).into_iter().chain(nodes) {
        append_sources(&package.join("src"), &mut sources);
    }
    sources.retain(|path| !path.starts_with(root.join(EXEMPT)));
    sources.sort();
    sources
}

/// All Rust files below `folder` but those of processes and of unit tests.
fn append_sources(folder: &Path, sources: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() && name != "tests" {
            append_sources(&path, sources);
        } else if name.ends_with(".rs") && name != "main.rs" && name != "tests.rs" {
            sources.push(path);
        }
    }
}

#[test]
fn cores_are_pure() {
    let mut wrong = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for path in pure_sources(root) {
        let found = violations(&std::fs::read_to_string(&path).unwrap());
        let file = path.strip_prefix(root).unwrap().display();
        wrong.extend(found.into_iter().map(|(line, complaint)| format!("{file}:{line}: {complaint}")));
    }
    assert!(wrong.is_empty(), "{} impure places:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn violations_are_found() {
    let check = |source: &str, expected: &[usize]| {
        let lines: Vec<usize> = violations(source).into_iter().map(|(line, _)| line).collect();
        assert_eq!(lines, expected, "{source}");
    };
    check("fn f(x: f64) -> f64 {\n    x.sin()\n}", &[2]);
    check("fn f(x: f64) -> f64 { libm::sin(x) + x.sqrt() }", &[]);
    check("const F: fn(f64) -> f64 = f64::exp;", &[1]);
    check("fn f(x: f64) -> String {\n    format!(\"{}\",\n        x.powi(2))\n}", &[3]);
    check("use std::fs::File;", &[1]);
    check("use std::{fmt, mem};\nuse std::{fmt::{self, Display}, thread};", &[2]);
    check("fn f() { std::env::var(\"A\"); println!(\"std::fs\"); }", &[1, 1]);
    check("use std::time::{Duration, SystemTime};\nuse std::time::Duration;", &[1]);
    check("fn f() { let _ = std::time::Instant::now(); }", &[1]);
    check("struct Instant;\nimpl Instant {}", &[]);
    check("use std::collections::{BTreeMap, HashMap};", &[1]);
    check("fn f() { sink.log(level, text); }", &[]);
    check("fn f(a: f64) { Isometry2::new(v, a); Isometry2::identity(); }", &[1]);
    check("/// `x.sin()` and std::fs\n// std::net\nfn f() { \"std::thread\"; r#\"x.cos()\"#; }", &[]);
    check("#[cfg(test)]\nmod tests {\n    use std::fs;\n}\nuse std::net;", &[5]);
    check("#[cfg(test)]\nmod tests;\nuse std::net;", &[3]);
}

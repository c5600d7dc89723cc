//! The layers: who may depend on whom, and what may not reach a core however indirectly.

use crate::PURE_CRATES;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Each crate with the workspace crates it may use. `dev-dependencies` are free: tests drive what stands beside them.
const LAYERS: &[(&str, &[&str])] = &[
    ("trench_rosidl", &[]),
    ("trench_config", &[]),
    ("trench_expression", &[]),
    ("trench_formation", &["trench_expression"]),
    ("trench_radio", &[]),
    ("trench_ssl", &[]),
    ("trench_msgs", &["trench_rosidl"]),
    ("trench_optics", &["trench_config"]),
    ("trench_calibrate", &["trench_config", "trench_optics"]),
    ("trench_launch", &["trench_config"]),
    ("trench_core", &["trench_config", "trench_msgs"]),
    ("trench_sim", &["trench_optics", "trench_radio"]),
    ("trench_plan", &["trench_config", "trench_expression", "trench_formation", "trench_msgs"]),
    ("trench_check", &["trench_config", "trench_formation", "trench_plan", "trench_scenario"]),
    ("trench_scenario", &["trench_config", "trench_formation", "trench_plan"]),
    ("trench_bag", &["trench_config", "trench_core", "trench_msgs", "trench_rosidl"]),
    ("trench_journal", &["trench_bag", "trench_config", "trench_core", "trench_msgs"]),
    ("trench_runtime", &["trench_config", "trench_core", "trench_journal", "trench_msgs", "trench_rosidl"]),
    ("trench_harness", &["trench_bag", "trench_config", "trench_core", "trench_launch", "trench_msgs", NODES]),
    ("trench_harness", &["trench_journal"]),
    ("trench_view", &["trench_bag", "trench_core", "trench_msgs", "trench_plan"]),
    (NODES, &["trench_config", "trench_core", "trench_msgs", LIBRARIES_OF_NODES]),
    ("testbed", &["trench_sim"]),
    (CAMERA, &["trench_bag"]),
    ("trench", &["trench_bag", "trench_config", "trench_core", "trench_harness", "trench_launch", "trench_msgs"]),
    (
        "trench",
        &[
            "trench_calibrate",
            "trench_check",
            "trench_formation",
            "trench_journal",
            "trench_optics",
            "trench_plan",
            "trench_runtime",
            "trench_scenario",
            "trench_ssl",
            "trench_view",
        ],
    ),
];

/// The one node that reads devices, image folders and bags itself: what it publishes is new to the system, and recorded.
const CAMERA: &str = "overhead_camera";
const FOR_CAMERA: &[&str] = &["rustix", "trench_bag"];

/// Stands for every package of the folder `nodes`.
const NODES: &str = "nodes/*";

/// Stands for the pure libraries that any node may use, and for the runtime of its process.
const LIBRARIES_OF_NODES: &str = "libraries of nodes";
const FOR_NODES: &[&str] = &["trench_formation", "trench_optics", "trench_plan", "trench_radio"];

/// What turns a core into a process: as an optional dependency alone.
const RUNTIME: &str = "trench_runtime";

/// Crates that bring sockets, threads, terminals, shared memory, clocks or chance.
const IMPURE: &[&str] = &[
    "getrandom",
    "iceoryx2",
    "jiff",
    "mio",
    "rand",
    "ros2-client",
    "rustdds",
    "rustix",
    "signal-hook",
    "socket2",
    "tokio",
    "trench_bag",
    "trench_runtime",
    "zenoh",
];

struct Package {
    name: String,
    is_node: bool,
    /// Names of the workspace crates it uses outside tests, and whether they are optional.
    uses: Vec<(String, bool)>,
}

fn cargo(arguments: &[&str]) -> String {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn workspace() -> Vec<Package> {
    let metadata = cargo(&["metadata", "--offline", "--no-deps", "--format-version", "1"]);
    let metadata: Value = serde_json::from_str(&metadata).unwrap();
    metadata["packages"].as_array().unwrap().iter().map(package).collect()
}

fn package(package: &Value) -> Package {
    let dependencies = package["dependencies"].as_array().unwrap().iter();
    let ours = dependencies.filter(|dependency| dependency.get("path").is_some() && dependency["kind"] != "dev");
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    Package {
        name: text(&package["name"]),
        is_node: text(&package["manifest_path"]).contains("/nodes/"),
        uses: ours.map(|dependency| (text(&dependency["name"]), dependency["optional"] == true)).collect(),
    }
}

/// All that `package` may use: none where no layer names it.
fn allowed<'a>(package: &Package, nodes: &BTreeSet<&'a str>) -> Option<BTreeSet<&'a str>> {
    let covers = |layer: &&(&str, _)| layer.0 == package.name || (package.is_node && layer.0 == NODES);
    let lists: Vec<&[&str]> = LAYERS.iter().filter(covers).map(|layer| layer.1).collect();
    let expand = |name: &'a str| match name {
        NODES => nodes.iter().copied().collect(),
        LIBRARIES_OF_NODES => FOR_NODES.to_vec(),
        _ => vec![name],
    };
    (!lists.is_empty()).then(|| lists.concat().into_iter().flat_map(expand).collect())
}

#[test]
fn layers_point_one_way() {
    let packages = workspace();
    let nodes: BTreeSet<&str> = packages.iter().filter(|package| package.is_node).map(|node| &*node.name).collect();
    let mut wrong = Vec::new();
    for package in &packages {
        let Some(allowed) = allowed(package, &nodes) else {
            wrong.push(format!("{} belongs to no layer: give it one in {}", package.name, file!()));
            continue;
        };
        for (used, is_optional) in &package.uses {
            let is_runtime_of_node = package.is_node && *is_optional && used == RUNTIME;
            if !allowed.contains(&**used) && !is_runtime_of_node {
                wrong.push(format!("{} depends on {used}", package.name));
            }
        }
    }
    assert!(wrong.is_empty(), "against the layers:\n{}", wrong.join("\n"));
}

/// The crates that `package` without its default features is built from, outside tests and build scripts.
fn built_from(package: &str) -> BTreeSet<String> {
    let tree = cargo(&[
        "tree",
        "--offline",
        "--no-default-features",
        "--edges",
        "normal",
        "--prefix",
        "none",
        "--package",
        package,
    ]);
    tree.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn nothing_impure_reaches_a_core() {
    let pure = PURE_CRATES.map(|name| format!("trench_{name}"));
    let cores = workspace().into_iter().filter(|package| package.is_node).map(|node| node.name);
    let mut wrong = BTreeMap::new();
    for package in pure.into_iter().chain(cores) {
        let built_from = built_from(&package);
        assert!(built_from.contains(&package), "cargo tree does not know {package}");
        let excused = if package == CAMERA { FOR_CAMERA } else { &[] };
        let banned = IMPURE.iter().copied().filter(|name| !excused.contains(name));
        let found: Vec<&str> = banned.filter(|name| built_from.contains(*name)).collect();
        if !found.is_empty() {
            wrong.insert(package, found);
        }
    }
    assert!(wrong.is_empty(), "built from crates that touch the outside: {wrong:?}");
}

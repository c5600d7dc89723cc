//! Every figure of every scenario file: run, drawn as SVG and PNG, with the curves that it is about.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use resvg::usvg;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use trench_scenario::{Drawing, Figure, Scenario, Task};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn trench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trench")).args(arguments).current_dir(root()).output().unwrap()
}

/// The pictures that `trench plot` says it has written.
fn plotted(run: &Path, folder: &Path, more: &[&str]) -> Vec<PathBuf> {
    let arguments = [&["plot", run.to_str().unwrap(), "--out", folder.to_str().unwrap()], more].concat();
    let output = trench(&arguments);
    assert!(output.status.success(), "{run:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(PathBuf::from).collect()
}

/// All texts of an SVG that parses, one a line.
fn texts(svg: &Path) -> String {
    let text = fs::read_to_string(svg).unwrap();
    let tree = usvg::Tree::from_str(&text, &usvg::Options::default()).unwrap();
    assert!(tree.size().width() > 100.0 && tree.size().height() > 100.0, "{svg:?}");
    let document = usvg::roxmltree::Document::parse(&text).unwrap();
    let told = document.descendants().filter(|node| node.has_tag_name("text"));
    told.map(|node| node.text().unwrap_or_default().trim().to_owned() + "\n").collect()
}

/// How much of a PNG is not white: shares of a picture.
fn drawn(png: &Path) -> f64 {
    let picture = image::open(png).unwrap().into_rgb8();
    let coloured = picture.pixels().filter(|pixel| pixel.0 != [255; 3]).count();
    coloured as f64 / f64::from(picture.width() * picture.height())
}

/// What the legend of a figure tells apart.
fn labels(figure: &Figure, scenario: &Scenario) -> Vec<String> {
    if let Task::Launch(_) = scenario.task {
        let robots = if scenario.name.contains("triangle") { 3 } else { 4 };
        return (1..=robots).map(|robot| format!("robot{robot}")).collect();
    }
    let needs_no_run = matches!(
        figure.drawing,
        Drawing::SineIntegrals
            | Drawing::CurvatureTrends(_)
            | Drawing::Solutions { .. }
            | Drawing::StableWedge { .. }
            | Drawing::WedgeInSpace
    );
    if needs_no_run || figure.drawing == Drawing::Speeds {
        return Vec::new();
    }
    let cases: Vec<(&str, &str)> = scenario.cases();
    let wanted = |name: &str| figure.cases.is_empty() || figure.cases.iter().any(|case| case == name);
    let shown: Vec<&str> = cases.iter().filter(|(name, _)| wanted(name)).map(|(_, label)| *label).collect();
    if shown.len() > 1 {
        return shown.into_iter().map(str::to_owned).collect();
    }
    let follows = figure.drawing == Drawing::LeaderDistances;
    let ranks = scenario.seats().into_iter().filter(|seat| !follows || seat.leader.is_some()).map(|seat| seat.rank);
    let mut names: Vec<String> = ranks.map(|rank| format!("r{rank}")).collect();
    names.retain(|name| figure.robots.is_empty() || figure.robots.contains(name));
    names.sort();
    names.dedup();
    // One curve needs no legend.
    if names.len() > 1 { names } else { Vec::new() }
}

/// Runs a scenario for its own time, or for a shorter one, and looks at its figures.
fn check_figures(file: &Path, folder: &Path) {
    let text = fs::read_to_string(file).unwrap();
    let scenario = trench_scenario::parse(&file.display().to_string(), &text).unwrap();
    let pictures = plotted(file, folder, &[]);
    assert_eq!(pictures.len(), 2 * scenario.figures.len(), "{file:?}: SVG and PNG of each");
    for figure in &scenario.figures {
        let name = figure.file_name();
        let [svg, png] = ["svg", "png"].map(|kind| folder.join(format!("{name}.{kind}")));
        assert!(pictures.contains(&svg) && pictures.contains(&png), "{file:?}: {name} is not among {pictures:?}");
        let told = texts(&svg);
        let title = format!("Figure {}: {}", figure.number, figure.title);
        assert!(told.contains(&title), "{file:?}: {name} has no title {title:?}: {told}");
        for label in labels(figure, &scenario) {
            assert!(told.lines().any(|line| line == label), "{file:?}: {name} does not tell of {label}: {told}");
        }
        let share = drawn(&png);
        assert!((0.005..0.9).contains(&share), "{file:?}: {name}: {share} of it is drawn");
    }
}

/// Where a shortened scenario ends, s.
const END: f64 = 4.0;

/// A line of a scenario file whose figures are drawn at no time after [`END`].
fn drawn_before_the_end(line: &str) -> String {
    let Some((before, rest)) = line.split_once("at: [") else { return line.to_owned() };
    let (times, behind) = rest.split_once(']').unwrap();
    let times: Vec<f64> = times.split(',').map(|time| time.trim().parse::<f64>().unwrap().min(END)).collect();
    format!("{before}at: {times:?}{behind}")
}

/// A line of a scenario file in which what happens to a robot or its links begins before [`END`].
fn begun_before_the_end(line: &str) -> String {
    let events = ["from: ", "joins: ", "quits: {at: "];
    let Some((before, rest)) = events
        .into_iter()
        .filter(|_| line.starts_with("- {"))
        .find_map(|event| line.find(event).map(|place| line.split_at(place + event.len())))
    else {
        return line.to_owned();
    };
    let (time, behind) = rest.split_at(rest.find([',', '}']).unwrap());
    format!("{before}{:?}{behind}", time.parse::<f64>().unwrap().min(0.5 * END))
}

/// A copy of a scenario that ends after a few steps, where its figures do not need more.
fn shortened(file: &Path, folder: &Path) -> PathBuf {
    let text = fs::read_to_string(file).unwrap();
    if text.contains("kind: launch") {
        return file.to_owned();
    }
    let shorter: Vec<String> = text
        .lines()
        .map(|line| match line.strip_prefix("duration:") {
            Some(rest) => {
                let whole: f64 = rest.split('#').next().unwrap().trim().parse().unwrap();
                format!("duration: {:?}", whole.min(END))
            }
            None => begun_before_the_end(&drawn_before_the_end(line)),
        })
        .collect();
    let copy = folder.join(file.file_name().unwrap());
    fs::write(&copy, shorter.join("\n")).unwrap();
    copy
}

#[test]
fn every_scenario_file_draws_its_figures() {
    let mut count = 0;
    for entry in fs::read_dir(root().join("config/scenarios")).unwrap() {
        let folder = tempfile::tempdir().unwrap();
        let file = shortened(&entry.unwrap().path(), folder.path());
        check_figures(&file, &folder.path().join("out"));
        count += 1;
    }
    assert!(count > 30, "{count}");
}

/// What the thesis draws in them besides curves.
#[test]
fn signs_are_those_of_the_thesis() {
    let folder = tempfile::tempdir().unwrap();
    let drawn_of = |name: &str| {
        let file = shortened(&root().join("config/scenarios").join(name), folder.path());
        plotted(&file, &folder.path().join("out"), &["--format", "svg"]);
    };
    let svg = |number: &str| folder.path().join(format!("out/figure-{number}.svg"));
    drawn_of("4.4.4.yaml");
    let space = texts(&svg("4.8"));
    assert!(["K1", "K2", "K3", "K3 = K1"].iter().all(|text| space.lines().any(|line| line == *text)), "{space}");
    drawn_of("7.10.yaml");
    // The fastest of Table 6.1 has 1.01 m/s on a map of 114 m.
    let speeds = texts(&svg("7.16"));
    assert!(speeds.contains("→ its velocity: the way of 10 s"), "{speeds}");
    drawn_of("7.10_obstacles.yaml");
    let obstacles = texts(&svg("7.21"));
    assert!(
        obstacles.contains("thin: the pole of their repulsion") && obstacles.contains("rho_hat = 2"),
        "{obstacles}"
    );
    assert!(!obstacles.contains("open end"), "{obstacles}");
    drawn_of("7.13_open.yaml");
    let open = texts(&svg("2.1"));
    assert!(open.contains("- - - segment,  · · · its open end"), "{open}");
}

#[test]
fn a_bag_of_the_square_draws_what_every_run_has() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let run = ["sim", "launch/square.launch.yaml", "--quiet", "--bag", bag.to_str().unwrap(), "duration:=18.0"];
    assert!(trench(&run).status.success());
    let pictures = plotted(&bag, &folder.path().join("out"), &["--at", "0,3,8,16"]);
    assert_eq!(pictures.len(), 8);
    for at in ["99", "-1"] {
        let late = trench(&["plot", bag.to_str().unwrap(), &format!("--at=3,{at}")]);
        let told = String::from_utf8_lossy(&late.stderr);
        let ends = format!("--at {at} is not of the run, which ends 1");
        assert!(!late.status.success() && told.contains(&ends) && told.contains("seconds between 0"), "{told}");
    }
    for (name, expected) in [
        ("trajectories", &["robot1", "robot4"][..]),
        ("errors", &["robot1", "robot4"]),
        ("snapshots", &["robot1", "robot4", "t = 0 s", "t = 16 s"]),
        ("speeds", &["robot1", "forward speed (m/s)", "heading (rad)"]),
    ] {
        let [svg, png] = ["svg", "png"].map(|kind| folder.path().join(format!("out/{name}.{kind}")));
        let told = texts(&svg);
        assert!(expected.iter().all(|text| told.contains(text)), "{name}: {told}");
        assert!((0.005..0.9).contains(&drawn(&png)), "{name}: {}", drawn(&png));
    }
}

#[test]
fn a_bag_knows_the_figures_of_the_scenario_that_drove_the_nodes() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    // The thesis's profile does not come within the operator's tolerance: the run ends with that verdict.
    let run = ["sim", "config/scenarios/4.6_square.yaml", "--quiet", "--bag", bag.to_str().unwrap()];
    assert_eq!(trench(&run).status.code(), Some(10));
    let pictures = plotted(&bag, &folder.path().join("out"), &["--format", "svg"]);
    let names: Vec<_> = pictures.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["figure-4.37-to-4.41.svg", "figure-4.42.svg"]);
    assert!(texts(&pictures[1]).contains("t = 20 s"));
}

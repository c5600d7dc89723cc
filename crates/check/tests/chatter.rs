//! Robots in trenches with a kink at their bottom, judged and simulated.
#![expect(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on fails")]
use trench_check::Verdict;
use trench_scenario::{Scenario, Simulation};

/// Four robots of a chain above a line along x, with a trench and what a test adds.
fn chain(step: f64, method: &str, besides: &str) -> String {
    format!(
        "\
name: it
kind: nearest_points
duration: 60
step: {step}
method: {method}
segment: {{kind: line, points: [[-30, 0], [30, 0]]}}
damping: 5.0
zoning: {{rho_underbar: 1.0, rho_hat: 4.0, rho: 10.0, rho_check: 13.0, rho_bar: 30.0, alpha: 10.0, beta: 10.0, m: 2, edge: continuous, full_acceleration: 1.0e+3}}
team_goal: [10, 0]
{besides}
robots:
- {{position: [10, 8]}}
- {{position: [4, 14]}}
- {{position: [-2, 12]}}
- {{position: [-8, 14]}}
"
    )
}

fn step(scenario: &Scenario) -> Verdict {
    trench_check::scenario("it", scenario).into_iter().find(|verdict| verdict.check == "step").unwrap()
}

/// The number behind a text of a finding.
fn told(verdict: &Verdict, after: &str) -> f64 {
    let rest = verdict.finding.split(after).nth(1).unwrap_or_else(|| panic!("{after:?} in {verdict:?}"));
    rest.split(' ').next().unwrap().parse().unwrap()
}

/// How far off the line anybody is in the last fifth of the run, m.
fn chattering(scenario: &Scenario) -> f64 {
    let mut simulation = Simulation::new(scenario).unwrap();
    let (mut samples, mut farthest) = (Vec::new(), 0.0_f64);
    while simulation.time() < scenario.timing.duration {
        simulation.step().unwrap();
        if simulation.time() > 0.8 * scenario.timing.duration {
            simulation.sample(false, &mut samples).unwrap();
            farthest = samples.iter().map(|sample| sample.position.y.abs()).fold(farthest, f64::max);
        }
    }
    farthest
}

/// Steps of 0.1 s were "stable below 0.4 s"; robots went to and fro by 0.12 m, and nobody conformed.
#[test]
fn what_a_step_makes_of_a_kink_is_told() {
    let cone = "trench: {kind: conic, alpha: 8.0}";
    let limits = "trench: {kind: conic, alpha: 8.0}\nlimits: {speed: 3.0, acceleration: 8.0}";
    for (method, besides) in [("semi_implicit_euler", cone), ("exact", cone), ("semi_implicit_euler", limits)] {
        let coarse = trench_scenario::parse("it", &chain(0.1, method, besides)).unwrap();
        let fails = step(&coarse);
        assert!(!fails.holds && fails.finding.contains("pulls with 8 m/s^2"), "{fails:?}");
        let (most, found) = (told(&fails, "by up to "), chattering(&coarse));
        assert!(found > coarse.tolerance && found <= most, "{method} {besides}: {found} {most}");
        // What is advised is enough.
        let advised = told(&fails, "make step ");
        let fine = trench_scenario::parse("it", &chain(advised, method, besides)).unwrap();
        let noted = step(&fine);
        let found = chattering(&fine);
        assert!(noted.holds && noted.note && noted.finding.contains("within the tolerance of 0.05 m"), "{noted:?}");
        assert!(found <= told(&noted, "by up to ") && found <= fine.tolerance, "{method} {besides}: {found} {noted:?}");
    }
    // Without a kink nothing of it is said.
    let smooth = chain(0.1, "semi_implicit_euler", "trench: {kind: hyperbolic, alpha: 8.0, a: 1.0}");
    let smooth = step(&trench_scenario::parse("it", &smooth).unwrap());
    assert!(smooth.holds && !smooth.finding.contains("kink"), "{smooth:?}");
}

/// Of goal points, by case.
#[test]
fn kinks_about_goal_points() {
    let file =
        std::fs::read_to_string(format!("{}/../../config/scenarios/5.6.yaml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let with = |h: &str| {
        let text = file.replacen("{kind: hyperbolic, alpha: 10.0, a: 1.0}", "{kind: conic, alpha: 2.0}", 1);
        let text =
            text.replace("step: 0.002", &format!("step: {h}")).replace("record_every: 0.02 ", "record_every: 0.2 ");
        let verdicts = trench_check::scenario("it", &trench_scenario::parse("it", &text).unwrap());
        verdicts.into_iter().filter(|verdict| verdict.check == "step").collect::<Vec<_>>()
    };
    // h P/(2 k) + h^2 P under rk4.
    let fine = with("0.002");
    assert!(fine[0].note && (told(&fine[0], "by up to ") - 0.002_008).abs() < 1e-6 && !fine[1].note, "{fine:?}");
    let coarse = with("0.1");
    assert!(!coarse[0].holds && coarse[1].holds && (told(&coarse[0], "by up to ") - 0.12).abs() < 1e-4, "{coarse:?}");
}

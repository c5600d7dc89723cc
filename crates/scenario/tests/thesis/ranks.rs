//! 6.2.1: who leads and who follows whom, where the file leaves that to the rule.

use super::{folder, run_scenario};
use std::fs;
use trench_scenario::parse;

const FILE: &str = "7.10.yaml";

/// The text of 7.10 with its robots in this order, by their places in the file, and `more`.
fn in_order(order: [usize; 10], more: &str) -> String {
    let text = fs::read_to_string(folder().join(FILE)).unwrap();
    let robots: Vec<&str> = text.lines().filter(|line| line.starts_with("- {position:")).collect();
    let mut next = order.iter().map(|place| robots[*place]);
    let lines = text.lines().map(|line| if line.starts_with("- {position:") { next.next().unwrap() } else { line });
    format!("{more}\n{}\n", lines.collect::<Vec<_>>().join("\n"))
}

/// The rule gives r1 r2 r3 r5 r4 r6 ... of Table 6.1 (ERRATA), in whatever order robots stand; and in this order too the team conforms.
#[test]
fn the_rule_orders_a_team_in_any_order() {
    let ruled = parse(FILE, &in_order([0, 1, 2, 4, 3, 5, 6, 7, 8, 9], "")).unwrap();
    for order in [[0, 1, 2, 3, 4, 5, 6, 7, 8, 9], [9, 8, 7, 6, 5, 4, 3, 2, 1, 0], [3, 9, 0, 4, 7, 1, 8, 2, 6, 5]] {
        let found = parse(FILE, &in_order(order, "ranks: nearest")).unwrap();
        assert_eq!(found.task, ruled.task);
    }
    let case = run_scenario(&ruled, &[]).0.cases.remove(0);
    assert!(case.robots.iter().all(|robot| robot.error < 0.1) && case.in_zone_1 == Some(0.0), "{case:?}");
}

#[test]
fn the_rule_needs_a_team_goal() {
    let text = in_order([0, 1, 2, 3, 4, 5, 6, 7, 8, 9], "ranks: nearest");
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("team_goal:")).collect();
    let error = parse(FILE, &without.join("\n")).unwrap_err().to_string();
    assert!(error.contains("ranks = nearest") && error.contains("no team goal"), "{error}");
}

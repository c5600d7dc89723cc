//! What 9.2 asks of a running column and pursuit, in lock-step on the honest bed: commands that the wheels can follow, no missed step;
//! a command and a leader state a tick; and a monitor that finds nothing wrong where nothing is.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use std::collections::BTreeMap;
use support::{root, watched};
use trench_core::{Advertise, Level, Source, Times};
use trench_formation::kinematics::{Axle, Ramp, Twist, Wheels};
use trench_harness::Observer;
use trench_msgs::Message;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{LeaderState, LinkStatus, RunState, Stability};

/// The motors of the honest bed (docs/nodes/testbed.md): m/s, m/s^2.
const MOST: f64 = 0.29994;
const RAMP: Ramp = Ramp { pull_in_speed: 0.08, acceleration: 0.5 };
const AXLE: Axle = Axle { half_track: 0.06 };

/// m/s, for rounding.
const ROUNDING: f64 = 1e-6;

type Violations = BTreeMap<String, Vec<(f64, String)>>;

/// A robot's commands.
#[derive(Debug, Default)]
struct Driven {
    /// When the last one was sent, s, and what it tells the wheels.
    last: Option<(f64, Wheels)>,
    commands: usize,
    leader_states: usize,
    /// Commands beyond what wheels can do, or reach from the one before: time (s), before, told, limits that acted.
    beyond: Vec<(f64, Wheels, Wheels, u8)>,
    doubtful: Option<(f64, Wheels, Wheels)>,
}

/// Looks at everything while the run runs.
#[derive(Debug, Default)]
struct Limits {
    running: bool,
    ticks: usize,
    robots: BTreeMap<String, Driven>,
    /// Time (s) and text of what the monitors complain of, by robot.
    violations: Violations,
    words: usize,
    far: usize,
    missed: Vec<(f64, String)>,
}

impl Observer for Limits {
    fn published(&mut self, at: Times, topic: &str, _: &Advertise, _: Source, cdr: &[u8]) {
        let time = at.steady.0 as f64 * 1e-9;
        if topic == "/run_state" {
            self.running = RunState::decode(cdr).unwrap().state == RunState::RUNNING;
        }
        if !self.running {
            return;
        }
        if topic == "/team_state" {
            self.ticks += 1;
        }
        let Some((robot, part)) = topic.strip_prefix('/').and_then(|rest| rest.split_once('/')) else { return };
        match part {
            "cmd_vel" => {
                let twist = TwistStamped::decode(cdr).unwrap().twist;
                let told = AXLE.wheels(Twist { v: twist.linear.x, omega: twist.angular.z });
                self.robots.entry(robot.to_owned()).or_default().take(time, told);
            }
            "leader_state" => {
                let state = LeaderState::decode(cdr).unwrap();
                let driven = self.robots.entry(robot.to_owned()).or_default();
                driven.leader_states += 1;
                if let Some((time, before, told)) = driven.doubtful.take() {
                    driven.beyond.push((time, before, told, state.limited_by));
                }
            }
            "link" if LinkStatus::decode(cdr).unwrap().fault & LinkStatus::FAULT_MISSED_STEPS != 0 => {
                self.missed.push((time, robot.to_owned()));
            }
            "stability" => {
                let said = Stability::decode(cdr).unwrap();
                self.words += 1;
                // At the start robots are farther apart than rho_bar: that is so, and no false alarm.
                if said.violation.contains(": 6.2.2: ") {
                    self.far += 1;
                } else if !said.holds {
                    self.violations.entry(robot.to_owned()).or_default().push((time, said.violation));
                }
            }
            _ => {}
        }
    }

    fn logged(&mut self, _: Times, _: &str, _: Level, _: &str) {}
}

impl Driven {
    fn take(&mut self, time: f64, told: Wheels) {
        self.commands += 1;
        if let Some((then, before)) = self.last.replace((time, told)) {
            let reached = RAMP.reached(before, told, time - then);
            let most = told.left.abs().max(told.right.abs());
            let off = (told.left - reached.left).abs().max((told.right - reached.right).abs());
            if most > MOST || off > ROUNDING {
                self.doubtful = Some((time, before, told));
            }
        }
    }
}

/// Drives a launch file and asserts that each robot has a command and a leader state a tick, and no command beyond its wheels. Gives what
/// the monitors complain of, and when who missed steps.
fn keeps_within_its_limits(file: &str, arguments: &[(&str, &str)], robots: usize) -> (Violations, Vec<(f64, String)>) {
    let mut limits = Limits::default();
    let ending = watched(&root().join("launch").join(file), arguments, &mut limits);
    let Limits { ticks, robots: driven, violations, words, far, missed, .. } = limits;
    assert_eq!(driven.len(), robots, "{file}: {ending:?}");
    println!("{file}: {ticks} ticks, {words} words of the monitors, {far} of leaders beyond rho_bar");
    for (robot, one) in &driven {
        println!(
            "{robot}: {} commands, {} leader states, {} beyond",
            one.commands,
            one.leader_states,
            one.beyond.len()
        );
        for (time, before, told, limits) in one.beyond.iter().take(12) {
            println!("  {time:.3} s, limits {limits:#x}: {before:.4?} then {told:.4?}");
        }
    }
    for (robot, said) in &violations {
        println!("{robot}: {} words of violations, the first: {:?}", said.len(), &said[..said.len().min(6)]);
    }
    println!("missed steps: {missed:?}");
    for (robot, one) in &driven {
        assert!(one.commands.abs_diff(ticks) <= 1, "{file}: {robot} sent {} commands in {ticks} ticks", one.commands);
        assert!(one.leader_states.abs_diff(ticks) <= 1, "{file}: {robot} spoke {} times", one.leader_states);
        assert!(one.beyond.is_empty(), "{file}: {robot}: {:.4?}", one.beyond);
    }
    assert!(words > ticks * robots / 4, "{file}: the monitors said {words} words");
    (violations, missed)
}

#[test]
fn a_column_misses_no_step_and_raises_no_false_alarm() {
    let (violations, missed) = keeps_within_its_limits("column.launch.yaml", &[("render", "false")], 4);
    assert!(missed.is_empty(), "{missed:?}");
    assert!(violations.is_empty(), "{violations:?}");
}

/// The radio loses some of the commands: the next one leaps, and costs steps, whatever the controller does. And the honest motors miss a
/// few in every step of a ramp, for they are told a new speed thirty times a second: no robot's firmware is.
#[test]
fn a_pursuit_is_told_nothing_that_its_wheels_cannot_follow() {
    let (_, missed) = keeps_within_its_limits("pursuit.launch.yaml", &[("render", "false")], 8);
    println!("missed steps in {} reports", missed.len());
}

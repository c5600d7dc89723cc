//! The pursuit (Figure 1.5) as processes in real time, judged by ground truth, and beside the same cores in lock-step.
//!
//! One random start a day; `TRENCH_LIVE_SEED` names another (scripts/acceptance takes all twenty).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use live_support::{Launch, domain};
use std::time::SystemTime;
use support::conformity::{Conformed, Conformity};
use support::{drive, starts};
use trench_bag::BagReader;
use trench_bag::run::{StepTable, steps};

/// m: what counts as formed.
const BOUND: f64 = 0.05;

/// s: when the target sets out (`target.depart`), and when it has reached the end of its way. In between trap, gaps and
/// moving obstacles lie on the segments without a pause: the field disturbs.
const DISTURBED: [f64; 2] = [20.0, 124.3];

/// s: how soon after a disturbance the formation has to stand.
const PATIENCE: f64 = 15.0;

fn seed() -> u64 {
    let named = std::env::var("TRENCH_LIVE_SEED").ok().and_then(|text| text.parse().ok());
    let today = || SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs() / 86_400;
    named.unwrap_or_else(|| 1 + today() % 20)
}

fn conformed(bag: &BagReader) -> Conformed {
    let mut conformity = Conformity::default();
    for message in bag.messages() {
        let message = message.unwrap();
        conformity.take(&bag.topics()[message.topic].name, &message);
    }
    conformity.finish()
}

/// Launches the pursuit, holds its bag against the bounds, and gives what came of it.
fn pursue(domain: u32, arguments: &[&str]) -> Conformed {
    let launch = Launch::new(domain);
    let (status, text) = launch.finish(launch.recording("pursuit.launch.yaml", arguments));
    assert!(status.success(), "{status}\n{text}");
    let summary = launch.judge(&[]);
    assert!(summary.contacts.is_empty(), "{:?}", summary.contacts);
    assert!(summary.closest.as_ref().unwrap().gap > 0.0, "{:?}", summary.closest);
    let bag = launch.recorded();
    let steps = steps(&bag).unwrap();
    println!("{}", StepTable(&steps));
    assert_eq!(steps.len(), 8, "every controller drives");
    let conformed = conformed(&bag);
    let jitter = steps.iter().map(|robot| robot.jitter).fold(0.0, f64::max);
    let [departure, rest] = DISTURBED;
    let (start, end) = (conformed.formed_after(0.0, BOUND), conformed.formed_after(rest, BOUND));
    let after = |time: Option<f64>| time.map_or("never".to_owned(), |time| format!("{time:.1} s"));
    println!(
        "worst at the end {:.4} m, formed {} after the start, {} after the field; jitter p99 {:.2} ms",
        conformed.at_the_end(),
        after(start),
        after(end),
        jitter * 1e3
    );
    assert!(start.is_some_and(|time| time <= PATIENCE.min(departure)), "formed {} after the start", after(start));
    assert!(end.is_some_and(|time| time <= PATIENCE), "formed {} after the field", after(end));
    assert!(conformed.at_the_end() <= BOUND, "{} m: lost or trapped", conformed.at_the_end());
    conformed
}

#[test]
fn live_pursuit_from_a_random_start() {
    let (poses, seed) = (starts(seed()), seed());
    println!("seed {seed}, poses {poses}");
    pursue(domain(0), &[&format!("poses:={poses}"), &format!("seed:={seed}"), "duration:=145.0"]);
}

/// The column follows its target over an empty field, where nothing decides between two ways: the runs can be compared.
/// In the pursuit who gives way to whom hangs on milliseconds, in lock-step too, and robots end a place apart.
#[test]
fn live_column_is_that_of_lockstep() {
    let launch = Launch::new(domain(1));
    let (status, text) = launch.finish(launch.recording("column.launch.yaml", &[]));
    assert!(status.success(), "{status}\n{text}");
    let live = conformed(&launch.recorded());
    let lockstep = drive("column.launch.yaml", &[]).conformity.finish();
    assert_eq!(live.assignment, lockstep.assignment, "who follows whom");
    let apart = live.apart(&lockstep);
    let [ours, theirs] = [live.median_time(BOUND), lockstep.median_time(BOUND)];
    println!(
        "worst final poses {apart:.4} m apart; median time to conform {ours:.1} s live, {theirs:.1} s in lock-step"
    );
    assert!(apart <= 0.02, "final poses differ by {apart} m");
    assert!((ours / theirs - 1.0).abs() <= 0.15, "{ours} s live, {theirs} s in lock-step");
}

//! The pursuit (Figure 1.5) as processes in real time, judged by ground truth, and beside the same cores in lock-step.
//!
//! A random start an hour in a debug build, three at once in a release build; `TRENCH_LIVE_SEEDS` names others (scripts/acceptance takes all
//! twenty, three at a time).
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod live_support;
#[expect(dead_code, reason = "the experiments use the rest")]
mod support;

use live_support::{Launch, domain};
use std::time::SystemTime;
use support::conformity::{Conformed, Conformity};
use support::pursued::{self, FORMED};
use support::{drive, starts};
use trench_bag::BagReader;
use trench_bag::run::{StepTable, steps};

/// Runs that share the machine. In a debug build each takes 0.8 of one of two slow cores: three of them fall seconds behind.
const AT_ONCE: u64 = if cfg!(debug_assertions) { 1 } else { 3 };

/// Some of twenty starts, others each hour.
fn seeds() -> Vec<u64> {
    if let Ok(named) = std::env::var("TRENCH_LIVE_SEEDS") {
        return named.split_whitespace().map(|seed| seed.parse().unwrap()).collect();
    }
    let hour = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap().as_secs() / 3600;
    (0..AT_ONCE).map(|index| 1 + (AT_ONCE * hour + index) % 20).collect()
}

fn conformed(bag: &BagReader) -> Conformed {
    let mut conformity = Conformity::default();
    for message in bag.messages() {
        let message = message.unwrap();
        conformity.take(&bag.topics()[message.topic].name, &message);
    }
    conformity.finish()
}

/// Launches the pursuit, holds its bag against the bounds, and compares it with the same in lock-step.
fn pursue(domain: u32, seed: u64) {
    let (poses, number) = (starts(seed), seed.to_string());
    println!("seed {seed}, poses {poses}");
    let arguments = [("poses", poses.as_str()), ("seed", &number)];
    let given: Vec<String> = arguments.iter().map(|(name, value)| format!("{name}:={value}")).collect();
    let given: Vec<&str> = given.iter().map(String::as_str).collect();
    let launch = Launch::new(domain);
    let (status, text) = launch.finish(launch.recording("pursuit.launch.yaml", &given));
    assert!(status.success(), "{status}\n{text}");
    let summary = launch.judge(&[]);
    assert!(summary.contacts.is_empty(), "{:?}", summary.contacts);
    assert!(summary.closest.as_ref().unwrap().gap > 0.0, "{:?}", summary.closest);
    let bag = launch.recorded();
    let steps = steps(&bag).unwrap();
    println!("{}", StepTable(&steps));
    assert_eq!(steps.len(), 8, "every controller drives");
    let jitter = steps.iter().map(|robot| robot.jitter).fold(0.0, f64::max);
    println!("seed {seed}: jitter p99 {:.2} ms", jitter * 1e3);
    let live = conformed(&bag);
    let shown = pursued::judge(&live, &format!("seed {seed}"));
    let lockstep = drive("pursuit.launch.yaml", &arguments).conformity.finish();
    let whole = [0.0, f64::INFINITY];
    let [ours, theirs] = [&live, &lockstep].map(|run| run.median_time(whole, FORMED));
    // The law drives a point before the axle; by which heading the robot comes to rest there hangs on how it came, in lock-step
    // too. That it then turns the way the formation faces (`face`) makes whole poses the same.
    let (points, centres, turned) =
        (live.points_apart(&lockstep), live.apart(&lockstep, f64::INFINITY), live.turned(&lockstep));
    println!(
        "seed {seed}: poses end {centres:.4} m and {turned:.4} rad from where they do in lock-step, the points that the law drives {points:.4} m"
    );
    println!("seed {seed}: median time to conform {ours:.1} s, {theirs:.1} s in lock-step");
    assert_eq!(live.assignment, lockstep.assignment, "who follows whom");
    assert!(points <= 0.02, "final points differ by {points} m");
    assert!(centres <= 0.02 && turned <= 0.2, "final poses differ by {centres} m, {turned} rad");
    assert!((ours / theirs - 1.0).abs() <= 0.15, "{ours} s live, {theirs} s in lock-step");
    let (figures, seed) = shown.rsplit_once(": ").unwrap();
    println!(
        "{figures}; poses end within {:.1} mm and {turned:.2} rad of lock-step's; jitter p99 {:.2} ms: {seed}",
        centres * 1e3,
        jitter * 1e3
    );
}

#[test]
fn live_pursuits_from_random_starts() {
    let domains = [0, 2, 3].map(domain);
    let seeds = seeds();
    assert!(seeds.len() <= domains.len(), "{seeds:?}: not more than {} at once", domains.len());
    std::thread::scope(|scope| {
        for (domain, seed) in domains.into_iter().zip(seeds) {
            scope.spawn(move || pursue(domain, seed));
        }
    });
}

/// The column follows its target over an empty field, where nothing decides between two ways: robots come to rest facing the same way
/// in both runs, and whole poses can be compared.
#[test]
fn live_column_is_that_of_lockstep() {
    let launch = Launch::new(domain(1));
    let (status, text) = launch.finish(launch.recording("column.launch.yaml", &[]));
    assert!(status.success(), "{status}\n{text}");
    let live = conformed(&launch.recorded());
    let lockstep = drive("column.launch.yaml", &[]).conformity.finish();
    assert_eq!(live.assignment, lockstep.assignment, "who follows whom");
    let apart = live.apart(&lockstep, f64::INFINITY);
    let [ours, theirs] =
        [live.median_time([0.0, f64::INFINITY], FORMED), lockstep.median_time([0.0, f64::INFINITY], FORMED)];
    let turned = live.turned(&lockstep);
    println!(
        "worst final poses {apart:.4} m and {turned:.4} rad apart; median time to conform {ours:.1} s live, {theirs:.1} s in lock-step"
    );
    assert!(apart <= 0.02 && turned <= 0.1, "final poses differ by {apart} m, {turned} rad");
    assert!((ours / theirs - 1.0).abs() <= 0.15, "{ours} s live, {theirs} s in lock-step");
}

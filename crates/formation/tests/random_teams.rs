//! Random teams among concave and moving obstacles: nobody collides, teams conform in time (docs/theory/chapter7.md has the figures).
//!
//! `TRENCH_TEAMS` sets how many seeds are run (12), `TRENCH_FIRST_SEED` the first of them.
#![expect(clippy::print_stdout, reason = "the figures are of interest")]
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use trench_formation::simulate::{BODY_RADIUS, CAPABILITY, Standard, Verdict, judge, random_team};

const STANDARD: Standard = Standard { body_radius: BODY_RADIUS, capability: CAPABILITY, tolerance: 0.1 };
/// Part of the feasible teams that must conform in time.
const CONFORMING: f64 = 0.995;
/// Seeds whose teams were late: 2 and 6 until robots ahead kept all of their zone 2 free on the segment, 16 until a robot held by a
/// guard was led round, 4 and 15 until leaders drew on nobody within 7 m.
const ONCE_LATE: [u64; 5] = [2, 4, 6, 15, 16];

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// What became of the team of a seed; nothing where no place to start was found.
fn verdict(seed: u64) -> Option<Verdict> {
    random_team(seed).map(|scenario| judge(scenario, &STANDARD).unwrap())
}

/// Verdicts by seed, on all processors.
fn verdicts(seeds: &[u64]) -> BTreeMap<u64, Option<Verdict>> {
    let (next, found) = (AtomicU64::new(0), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
                    let verdict = verdict(*seed);
                    found.lock().unwrap().insert(*seed, verdict);
                }
            });
        }
    });
    found.into_inner().unwrap()
}

#[test]
fn random_teams_conform_and_never_collide() {
    let (first, count) = (number("TRENCH_FIRST_SEED", 0), number("TRENCH_TEAMS", 12));
    let (mut kinds, mut failed) = (BTreeMap::<&str, u32>::new(), Vec::new());
    for (seed, verdict) in verdicts(&(first..first + count).collect::<Vec<_>>()) {
        let kind = match verdict {
            None => "no place to start",
            Some(Verdict::TooFewPlaces { .. }) => "too few places",
            Some(Verdict::Disconnected(_)) => "disconnected",
            Some(Verdict::Conforms { .. }) => "conform",
            Some(Verdict::Late(..)) => "late",
            Some(Verdict::Collision { .. }) => "collision",
            Some(Verdict::NotFinite(_)) => "not finite",
        };
        *kinds.entry(kind).or_default() += 1;
        if matches!(kind, "late" | "collision" | "not finite") {
            failed.push(format!("seed {seed}: {verdict:?}\n"));
        }
    }
    let of = |kind: &str| kinds.get(kind).copied().unwrap_or(0);
    let (conform, late) = (f64::from(of("conform")), f64::from(of("late")));
    println!("figure: {kinds:?}\n{}", failed.concat());
    assert_eq!(of("collision") + of("not finite"), 0, "{}", failed.concat());
    // One team in 200 may be late; in a sample smaller than that, one.
    assert!(late <= ((1.0 - CONFORMING) * (conform + late)).max(1.0), "{kinds:?}\n{}", failed.concat());
}

#[test]
fn seeds_that_were_once_late_conform() {
    for (seed, verdict) in verdicts(&ONCE_LATE) {
        assert!(matches!(verdict, Some(Verdict::Conforms { .. })), "seed {seed}: {verdict:?}");
    }
}

#[test]
fn a_seed_gives_the_same_run_again() {
    // The first small team, which is quickly run.
    let small = |seed: &u64| random_team(*seed).is_some_and(|scenario| scenario.robots.len() < 5);
    let seed = (0..).find(small).unwrap();
    assert_eq!(random_team(seed), random_team(seed));
    assert_eq!(verdict(seed), verdict(seed));
}

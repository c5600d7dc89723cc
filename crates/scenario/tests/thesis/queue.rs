//! Chapter 8: the linear queue laws, A.22, Remarks 8.4.1 and 6.2.1.

use super::{refusal, run_scenario, run_text, run_with, scenario, scenario_with, text};
use trench_formation::Vector2;
use trench_formation::stability::{Coupling, QueueRobot, cascade_bounds};
use trench_scenario::{CaseSummary, Queue, Sample, Task, parse};

fn queue(name: &str) -> Queue {
    let Task::Queue(queue) = scenario(name).task else { panic!("{name} is no queue") };
    *queue
}

/// A place, counted from the first one on, m.
fn place(Queue { queue, .. }: &Queue, slot: u32) -> Vector2<f64> {
    queue.segment.at(queue.first_place() - f64::from(slot) * queue.spacing).point
}

/// e and e' of (8.9): of the first robot from its place, of each other from the one ahead, which keeps its place; in the plane.
fn errors(queue: &Queue, samples: &[Sample]) -> Vec<(Vector2<f64>, Vector2<f64>)> {
    let own = |(sample, slot)| (place(queue, slot) - sample_at(sample), -velocity(sample));
    let own: Vec<_> = samples.iter().zip(0..).map(own).collect();
    let ahead = core::iter::once((Vector2::zeros(), Vector2::zeros())).chain(own.iter().copied());
    own.iter().zip(ahead).map(|(own, ahead)| (own.0 - ahead.0, own.1 - ahead.1)).collect()
}

fn sample_at(sample: &Sample) -> Vector2<f64> {
    sample.position
}

fn velocity(sample: &Sample) -> Vector2<f64> {
    sample.velocity
}

fn norms(errors: &[(Vector2<f64>, Vector2<f64>)]) -> Vec<f64> {
    errors.iter().map(|(e, rate)| e.norm().hypot(rate.norm())).collect()
}

/// e(t) under the poles -1 and -2: e'' + 3 e' + 2 e = 0.
fn free((e, rate): (Vector2<f64>, Vector2<f64>), time: f64) -> Vector2<f64> {
    (-time).exp() * (2.0 * e + rate) - (-2.0 * time).exp() * (e + rate)
}

fn times(until: u32) -> Vec<f64> {
    (0..=10 * until).map(|tenth| 0.1 * f64::from(tenth)).collect()
}

fn changes(case: &CaseSummary) -> Vec<(f64, &str, &str, Option<usize>)> {
    let of = |change: &trench_scenario::ChangeSummary| change.time;
    assert!(case.changes.windows(2).all(|pair| of(&pair[0]) <= of(&pair[1])), "{:?}", case.changes);
    case.changes.iter().map(|change| (change.time, &*change.robot, change.change, change.rank)).collect()
}

/// (8.8) for the first robot, in closed form; (8.28) for all: no error exceeds the bound of its rank, and all decay.
#[test]
fn the_linear_laws_keep_their_bounds() {
    let name = "8.4_queue.yaml";
    let (task, (summary, kept)) = (queue(name), run_with(name, &times(25)));
    let start = errors(&task, &kept[0]);
    let robot = QueueRobot::double_integrator_with(2.0, 3.0);
    let bounds = cascade_bounds(&vec![robot; start.len()], Coupling::Realisable, &norms(&start)).unwrap();
    let mut greatest = vec![0.0_f64; start.len()];
    for (samples, time) in kept.iter().zip(times(25)) {
        let now = errors(&task, samples);
        assert!((now[0].0 - free(start[0], time)).norm() < 1e-8, "{time} s: {:?}", now[0]);
        for ((greatest, norm), bound) in greatest.iter_mut().zip(norms(&now)).zip(&bounds) {
            assert!(norm <= bound * (1.0 + 1e-9), "{time} s: {norm} {bound}");
            *greatest = greatest.max(norm);
        }
    }
    // Bounds of the right size: the one ahead is felt, and no bound is ten times what is there.
    assert!(
        greatest.iter().zip(&bounds).all(|(greatest, bound)| bound < &(10.0 * greatest)),
        "{greatest:?} {bounds:?}"
    );
    let case = &summary.cases[0];
    assert!(case.robots.iter().all(|robot| robot.error < 1e-5) && case.neutral_after.is_none(), "{case:?}");
    for (robot, slot) in case.robots.iter().zip(0..) {
        assert!((Vector2::from(robot.position) - place(&task, slot)).norm() < 1e-5, "{robot:?}");
    }
}

/// (8.11) needs the realisable form: gains whose F is not Hurwitz are refused, by poles and by signs.
#[test]
fn queues_that_are_none_are_refused() {
    for (file, old, new, expected) in [
        ("8.4_queue.yaml", "poles: [-1.0, -2.0]", "poles: [-1.0, 0.0]", "not Hurwitz"),
        ("8.4_queue.yaml", "poles: [-1.0, -2.0]", "position_gain: 2.0, velocity_gain: 0.0", "law.velocity_gain"),
        ("8.4_queue.yaml", "spacing: 4.0", "spacing: 14.0", "leaves no places for 6 robots"),
        // Five gaps of 4 m fit a circle of 22 m, and the last place is 2 m from the first.
        (
            "8.4_queue.yaml",
            "{kind: graph, expression: \"3*sin(0.2*x)\", from: 0.0, to: 40.0}",
            "{kind: circle, centre: [36.5, 2.968], radius: 3.5}",
            "spacing = 4.0: leaves no places for 6 robots: round the closed segment they need 24 m",
        ),
        ("8.4.1_broken_links.yaml", "robot: r6", "robot: r9", "r9"),
        ("8.4.1_broken_links.yaml", "from: 2.0, to: 15.0", "from: 15.0, to: 2.0", "is not after `from`"),
        (
            "A.22_quit_and_join.yaml",
            "joins: 30.0",
            "joins: 30.0, quits: {at: 20.0, to: [0.0, 0.0]}",
            "before the robot joins",
        ),
        ("6.2.1_recovery.yaml", "range: 6.0", "range: 0.0", "recovery.range"),
    ] {
        let error = refusal(file, old, new);
        assert!(error.contains(expected) && error.contains(file), "{error}");
    }
}

/// Proposition 8.4.2: after each change of structure all errors decay again, and everybody comes to the place that A.22 gives it.
#[test]
fn robots_quit_and_join() {
    let name = "A.22_quit_and_join.yaml";
    let task = queue(name);
    let (summary, kept) = run_with(name, &[14.9, 29.9, 44.9, 59.9, 80.0]);
    let case = &summary.cases[0];
    let expected = [
        (15.0, "r3", "quits", None),
        (30.0, "r7", "joins", Some(3)),
        (45.0, "r2", "quits", None),
        (60.0, "r8", "joins", Some(2)),
    ];
    let found = changes(case);
    assert!(found.iter().filter(|change| change.2 != "follows").eq(&expected), "{found:?}");
    // Robots by place, and between changes nobody but those on the way there is anywhere else.
    let queues: [&[(usize, u32)]; 5] = [
        &[(1, 0), (2, 1), (3, 2), (4, 3), (5, 4), (6, 5)],
        &[(1, 0), (2, 1), (4, 2), (5, 3), (6, 4)],
        &[(1, 0), (2, 1), (7, 2), (4, 3), (5, 4), (6, 5)],
        &[(1, 0), (7, 2), (4, 3), (5, 4), (6, 5)],
        &[(1, 0), (8, 1), (7, 2), (4, 3), (5, 4), (6, 5)],
    ];
    for (samples, queue) in kept.iter().zip(queues) {
        for (rank, slot) in queue {
            let off = (samples[rank - 1].position - place(&task, *slot)).norm();
            assert!(off < 0.01, "r{rank} is {off} m from place {slot}");
        }
    }
    assert!((Vector2::from(case.robots[1].position) - Vector2::new(38.0, 12.0)).norm() < 1e-3, "r2 has left");
    // Case 2.1: when r2 quits, those behind stay.
    assert!((3..=6).all(|robot| (kept[3][robot].position - kept[2][robot].position).norm() < 0.01));
}

/// Remark 8.4.1: a robot whose link is broken goes to its place by (8.7), whatever the one ahead does, and follows again afterwards.
#[test]
fn robots_behind_a_broken_link_go_to_their_places() {
    let name = "8.4.1_broken_links.yaml";
    let (task, moments) = (queue(name), times(40));
    let (summary, kept) = run_with(name, &moments);
    let case = &summary.cases[0];
    let expected = [
        (1.0, "r4", "retargets"),
        (2.0, "r6", "retargets"),
        (4.0, "r4", "follows"),
        (15.0, "r6", "follows"),
        (20.0, "r4", "retargets"),
        (25.0, "r4", "follows"),
    ];
    let found = changes(case);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(expected) {
        assert!((found.0 - wanted.0).abs() < 1e-9 && (found.1, found.2) == (wanted.1, wanted.2), "{found:?}");
    }
    let error = |tenth: usize, robot: usize| {
        let sample = &kept[tenth][robot - 1];
        (place(&task, robot as u32 - 1) - sample.position, -sample.velocity)
    };
    for (robot, from, to) in [(4, 10, 40), (6, 20, 150)] {
        for tenth in from..=to {
            let wanted = free(error(from, robot), moments[tenth] - moments[from]);
            let found = error(tenth, robot).0;
            assert!((found - wanted).norm() < 1e-7, "r{robot} at {} s: {found} {wanted}", moments[tenth]);
        }
    }
    // The same without a break goes otherwise, so it is the remark that is seen; and both end in the places.
    let text = text(name);
    let (links, robots) = (text.find("broken_links:").unwrap(), text.find("robots:  ").unwrap());
    let whole = parse(name, &[&text[..links], &text[robots..]].concat()).unwrap();
    let (unbroken, others) = run_scenario(&whole, &moments);
    assert!((others[40][3].position - kept[40][3].position).norm() > 0.1);
    assert!(unbroken.cases[0].changes.is_empty());
    for (robot, slot) in case.robots.iter().zip(0..) {
        assert!((Vector2::from(robot.position) - place(&task, slot)).norm() < 1e-4, "{robot:?}");
    }
}

/// Remark 6.2.1: robots that reach nobody go to the segment, along it towards the team goal at their greatest speed, and join as soon as they
/// reach somebody.
#[test]
fn robots_that_have_lost_their_team_come_to_it() {
    let name = "6.2.1_recovery.yaml";
    let (task, moments) = (queue(name), times(60));
    let recovery = task.queue.recovery.unwrap();
    let (summary, kept) = run_with(name, &moments);
    let case = &summary.cases[0];
    let found = changes(case);
    let of = |robot: &str| -> Vec<(f64, &str, Option<usize>)> {
        found.iter().filter(|change| change.1 == robot).map(|change| (change.0, change.2, change.3)).collect()
    };
    for (robot, rank) in [("r4", 4), ("r5", 5)] {
        let [(lost, "lost", None), (joined, "joins", Some(found_rank))] = of(robot)[..] else { panic!("{found:?}") };
        assert!(lost == 0.0 && found_rank == rank, "{found:?}");
        let (index, after) = (rank - 1, moments.iter().position(|time| *time >= joined).unwrap());
        let nearest = |samples: &Vec<Sample>| {
            let gaps = samples[..index].iter().map(|other| (other.position - samples[index].position).norm());
            gaps.fold(f64::INFINITY, f64::min)
        };
        // One tick before it reaches nobody, one after it does; a tick is 0.2 m at most.
        assert!(nearest(&kept[after - 1]) > recovery.range - 1e-9, "{robot}");
        assert!(nearest(&kept[after]) < recovery.range + 0.2, "{robot}");
        // On the segment, at the greatest speed, for most of the way, and never faster.
        let way = &kept[..after];
        assert!(way.iter().all(|samples| samples[index].velocity.norm() <= recovery.speed + 1e-9));
        let before: Vec<&Sample> = way.iter().rev().take(40).map(|samples| &samples[index]).collect();
        for sample in before {
            let foot = task.queue.segment.nearest(sample.position);
            assert!(foot.distance < 0.7, "{robot}: {} m from the segment", foot.distance);
            let forward = sample.velocity.dot(&foot.tangent);
            assert!(forward > 0.85 * recovery.speed, "{robot}: {forward} m/s along it");
        }
    }
    let ends: Vec<f64> = case
        .robots
        .iter()
        .zip(0..)
        .map(|(robot, slot)| (Vector2::from(robot.position) - place(&task, slot)).norm())
        .collect();
    assert!(ends.iter().all(|off| *off < 0.01), "{ends:?}");
}

/// Remark 6.2.1 for groups, and while the run goes on: r4 and r5 reach each other alone, r3 is thrown out of reach; all come back, slowly, as bodies
/// that do not touch.
#[test]
fn groups_that_have_lost_their_team_come_to_it() {
    let name = "6.2.1_lost_group.yaml";
    let (task, (summary, kept)) = (queue(name), run_with(name, &times(60)));
    let found = changes(&summary.cases[0]);
    let told: Vec<_> = found.iter().map(|(_, robot, change, rank)| (*robot, *change, *rank)).collect();
    let lost = [("r4", "lost", None), ("r5", "lost", None), ("r3", "lost", None)];
    let joins = [("r3", "joins", Some(3)), ("r4", "joins", Some(4)), ("r5", "joins", Some(5))];
    assert_eq!(told, [lost, joins].concat());
    assert!(found[1].0 == 0.0 && (0.1..1.0).contains(&found[2].0), "{found:?}");
    let limits = task.queue.limits.unwrap();
    for samples in kept.iter().skip(40) {
        assert!(samples.iter().all(|sample| sample.velocity.norm() <= limits.speed + 1e-9), "{samples:?}");
    }
    for (sample, slot) in kept.last().unwrap().iter().zip(0..) {
        assert!((sample.position - place(&task, slot)).norm() < 1e-3, "{sample:?}");
    }
    assert!(summary.cases[0].closest_pair.unwrap() > 0.7, "{:?}", summary.cases[0].closest_pair);
}

/// The safety filter keeps the bodies of a queue apart where the linear laws do not: a robot that joins at the first place drives through others.
#[test]
fn bodies_of_a_queue_do_not_touch() {
    let bodies = "limits: {speed: 2.0, acceleration: 4.0}\nsafety: {body_radius: 0.4, margin: 0.05}\nspacing:";
    let crossing = [
        ("method: rk4", "method: semi_implicit_euler"),
        (
            "- {position: [38.0, 1.0]}\n- {position: [35.0, 4.0]}",
            "- {position: [35.0, 2.5]}\n- {position: [38.0, 3.0]}",
        ),
    ];
    let closest = |changes: &[(&str, &str)]| {
        let (summary, _) = run_scenario(&scenario_with("6.2.1_recovery.yaml", changes), &[]);
        (summary.cases[0].closest_pair.unwrap(), summary.cases[0].conforms_after)
    };
    let (bare, _) = closest(&crossing);
    let (kept, conforms) = closest(&[crossing[0], crossing[1], ("spacing:", bodies)]);
    assert!(bare < 0.8 && kept >= 0.9 - 1e-6, "{bare} {kept}");
    assert!(conforms.is_some(), "they still come to their places");
}

#[test]
fn bodies_and_links_that_suit_no_queue() {
    let name = "6.2.1_lost_group.yaml";
    for (old, new, expected) in [
        ("spacing: 4.0", "spacing: 12.0", "links that reach less far than `spacing`"),
        ("semi_implicit_euler", "rk4", "does not suit limits"),
        ("semi_implicit_euler", "exact", "does not suit the safety filter"),
        ("[-4.0, 1.0]", "[-0.5, 1.0]", "bodies overlap"),
        ("limits: {speed: 3.0, acceleration: 3.0}", "# ", "give limits, too"),
    ] {
        let error = refusal(name, old, new);
        assert!(error.contains(expected) && error.contains(name), "{error}");
    }
}

/// A queue with a robot that is behind it, out of its range.
fn lost(segment: &str, target: &str, robots: [&str; 3]) -> CaseSummary {
    let [first, second, third] = robots;
    let text = format!(
        "name: lost
kind: queue
duration: 80
step: 0.01
method: semi_implicit_euler
record_every: 1.0
tolerance: 0.05
segment: {segment}
target: {target}
spacing: 3
law: {{poles: [-1.0, -2.0]}}
recovery: {{range: 8, speed: 1.0}}
robots:
- {{position: {first}}}
- {{position: {second}}}
- {{position: {third}}}
"
    );
    run_text(&text, &[]).0
}

/// Where a corner is nearest, the way goes on along the piece ahead.
#[test]
fn robots_that_have_lost_their_team_go_round_corners() {
    for start in ["[20, -2.0]", "[20, 0.0]", "[20, 2.0]"] {
        let corner = "{kind: polyline, points: [[0, 0], [30, 0], [30, 30]]}";
        let case = lost(corner, "[30, 30]", ["[30, 29]", "[29, 27]", start]);
        assert!(case.conforms_after.is_some_and(|after| after < 50.0), "{case:?}");
    }
}

/// 24 m on, not 102 m back through the front of the queue.
#[test]
fn robots_that_have_lost_their_team_go_the_shorter_way_round() {
    let circle = "{kind: circle, centre: [0, 0], radius: 20}";
    let case = lost(circle, "[20, 0]", ["[20, 0]", "[19.776, -2.992]", "[7.247, -18.641]"]);
    assert!(case.conforms_after.is_some_and(|after| after < 30.0), "{case:?}");
}

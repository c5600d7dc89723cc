use super::*;
use trench_core::{RosTime, Steady};
use trench_msgs::msg::{self, Point2};
use trench_msgs::std_msgs::Header;

fn now(seconds: f64) -> Times {
    Times { ros: RosTime(0).plus_seconds(1000.0 + seconds), steady: Steady(0).plus_seconds(seconds) }
}

fn disc(id: u32, x: f64, speed: f64) -> msg::Obstacle {
    msg::Obstacle { id, polygon: vec![Point2 { x, y: 0.0 }], radius: 0.1, velocity: Point2 { x: speed, y: 0.0 } }
}

fn array(at: f64, obstacles: Vec<msg::Obstacle>) -> ObstacleArray {
    ObstacleArray { header: Header { stamp: now(at).ros.into(), ..Header::default() }, obstacles }
}

fn places(sources: &Sources, at: f64) -> Vec<(u32, f64)> {
    sources.at(now(at)).map(|known| (known.id, known.shape.outline().points[0].x)).collect()
}

#[test]
fn a_source_replaces_its_own_and_leaves_the_others() {
    let mut sources = Sources::default();
    sources.take(now(0.0), [1; 16], &array(0.0, vec![disc(1, 0.0, 0.0), disc(2, 1.0, 0.0)]));
    sources.take(now(0.0), [2; 16], &array(0.0, vec![disc(1, 3.0, 0.0)]));
    assert_eq!(places(&sources, 0.0), [(1, 0.0), (2, 1.0), ((1 << 20) + 1, 3.0)]);
    sources.take(now(0.1), [1; 16], &array(0.1, vec![]));
    assert_eq!(places(&sources, 0.1), [((1 << 20) + 1, 3.0)]);
}

#[test]
fn moving_obstacles_are_carried_on_for_a_second() {
    let mut sources = Sources::default();
    sources.take(now(0.0), [1; 16], &array(0.0, vec![disc(1, 1.0, 0.5)]));
    for (at, x) in [(0.0, 1.0), (0.4, 1.2), (1.0, 1.5), (5.0, 1.5)] {
        assert!((places(&sources, at)[0].1 - x).abs() < 1e-9, "{at}");
    }
}

#[test]
fn what_cannot_be_used_is_named_and_the_rest_is_kept() {
    let mut sources = Sources::default();
    let corner = |x, y| Point2 { x, y };
    let polygon = |id, polygon: Vec<Point2>| msg::Obstacle { id, polygon, radius: 0.0, ..disc(id, 0.0, 0.0) };
    let bad = vec![
        msg::Obstacle { radius: -1.0, ..disc(10, 0.0, 0.0) },
        polygon(11, vec![]),
        disc(13, f64::NAN, 0.0),
        disc(14, 0.0, f64::INFINITY),
        msg::Obstacle { radius: f64::NAN, ..disc(15, 0.0, 0.0) },
        disc(1, 0.5, 0.0),
    ];
    let complaints = sources.take(now(0.0), [1; 16], &array(0.0, [vec![disc(1, 0.0, 0.0)], bad].concat()));
    assert_eq!(complaints.len(), 6, "{complaints:?}");
    assert!(complaints[0].contains("obstacle 10 is left out: the radius is -1"), "{complaints:?}");
    assert_eq!(places(&sources, 0.0), [(1, 0.0)]);
    // Where something is, though no polygon: the hull.
    let crossing = polygon(12, vec![corner(0.0, 0.0), corner(1.0, 1.0), corner(1.0, 0.0), corner(0.0, 1.0)]);
    let flat = polygon(16, vec![corner(0.0, 5.0), corner(1.0, 5.0), corner(2.0, 5.0)]);
    let complaints = sources.take(now(0.1), [1; 16], &array(0.1, vec![crossing, flat]));
    assert!(complaints.len() == 2 && complaints[0].contains("crosses itself"), "{complaints:?}");
    let areas: Vec<f64> = sources.at(now(0.1)).map(|known| known.shape.area()).collect();
    assert_eq!(areas, [1.0, 0.0]);
    sources.take(now(0.2), [1; 16], &array(0.2, vec![disc(1, 0.0, 0.0)]));
    assert_eq!(sources.complaints().count(), 0, "what is mended is not complained of any more");
}

#[test]
fn an_obstacle_of_which_nonsense_is_told_stays_where_it_was() {
    let mut sources = Sources::default();
    let nowhere = |id| disc(id, f64::NAN, 0.0);
    sources.take(now(0.0), [1; 16], &array(0.0, vec![disc(1, 0.0, 0.5), disc(2, 3.0, 0.0)]));
    let complaints = sources.take(now(0.4), [1; 16], &array(0.4, vec![nowhere(1), disc(2, 4.0, 0.0)]));
    assert!(complaints.len() == 1 && complaints[0].contains("obstacle 1 stays where it was"), "{complaints:?}");
    assert_eq!(places(&sources, 0.4), [(1, 0.2), (2, 4.0)], "carried on from its own last news");
    // None that can be used: nothing was told, also of those that are not named.
    let complaints = sources.take(now(0.8), [1; 16], &array(0.8, vec![nowhere(1), nowhere(7)]));
    assert!(complaints.len() == 2 && complaints[1].contains("obstacle 7 is left out"), "{complaints:?}");
    assert_eq!(places(&sources, 2.0), [(1, 0.5), (2, 4.0)]);
    assert!(sources.silence(now(2.0), 1, 1.0).is_some(), "nonsense alone is silence");
    sources.take(now(2.0), [1; 16], &array(2.0, vec![]));
    assert_eq!(places(&sources, 2.0), []);
}

#[test]
fn messages_out_of_time_are_dropped() {
    let mut sources = Sources::default();
    let mut check = |at: f64, stamp: f64, expected: &str| {
        let complaints = sources.take(now(at), [1; 16], &array(stamp, vec![disc(1, stamp, 0.0)]));
        assert_eq!(complaints.is_empty(), expected.is_empty(), "{complaints:?}");
        assert!(complaints.iter().all(|complaint| complaint.contains(expected)), "{complaints:?}");
    };
    check(10.0, 10.0, "");
    check(10.1, 60.0, "in the future");
    check(10.2, 9.9, "older than the last one");
    check(10.3, 10.3, "");
    // A clock set back.
    check(10.4, 2.0, "");
    // One without a stamp.
    let mut message = array(0.0, vec![disc(1, 7.0, 0.0)]);
    message.header = Header::default();
    assert_eq!(sources.take(now(11.0), [1; 16], &message), Vec::<String>::new());
    assert_eq!(places(&sources, 11.0), [(1, 7.0)]);
}

#[test]
fn thousands_of_corners_cost_little_and_more_are_refused() {
    let mut sources = Sources::default();
    let ring = |corners: u32| {
        let corner = |step: u32| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(step) / f64::from(corners));
            Point2 { x: cos, y: sin }
        };
        array(0.0, vec![msg::Obstacle { polygon: (0..corners).map(corner).collect(), ..disc(1, 0.0, 0.0) }])
    };
    assert_eq!(sources.take(now(0.0), [1; 16], &ring(15_000)), Vec::<String>::new());
    assert_eq!(sources.len(), 1);
    let complaints = sources.take(now(0.1), [1; 16], &ring(30_000));
    assert!(complaints[0].contains("30000 corners"), "{complaints:?}");
}

#[test]
fn publishers_that_have_gone_are_forgotten() {
    let mut sources = Sources::default();
    // One speaks all the time, one has spoken once.
    sources.connected(2);
    sources.take(now(0.0), [2; 16], &array(0.0, vec![disc(2, 2.0, 0.0)]));
    for tick in 0..30_u8 {
        let at = 0.1 * f64::from(tick);
        sources.take(now(at), [1; 16], &array(at, vec![disc(1, 1.0, 0.0)]));
    }
    assert!(!sources.forget(now(60.0)), "both are connected");
    sources.connected(1);
    assert!(!sources.forget(now(4.0)), "it may only be late");
    assert!(sources.forget(now(4.3)));
    assert_eq!(places(&sources, 4.3), [(2, 2.0)]);
    sources.connected(0);
    assert!(sources.forget(now(5.0)));
    assert_eq!(sources.len(), 0);
    assert_eq!(sources.orphans(), 0);
}

#[test]
fn of_publishers_without_a_rhythm_none_is_forgotten_by_guess() {
    let mut sources = Sources::default();
    for gid in 1..=2 {
        sources.take(now(0.0), [gid; 16], &array(0.0, vec![disc(1, f64::from(gid), 0.0)]));
    }
    sources.connected(1);
    assert!(!sources.forget(now(100.0)));
    assert_eq!((sources.len(), sources.orphans()), (2, 1));
}

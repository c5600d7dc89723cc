//! The last minute of each robot, for browsers that come late and for jumps in a bag.

use crate::Point;
use serde::Serialize;
use std::collections::{BTreeMap, VecDeque};

/// How long it reaches back, s.
pub(crate) const REACH: f64 = 60.0;
/// The time between two samples, s; one that comes a little early counts.
pub(crate) const STEP: f64 = 0.095;

/// Time (s, ROS time) and place of one sample.
type Place = (f64, Point);
/// Time, V, and what V may be at most where the controller tells it.
type Value = (f64, Option<f64>, Option<f64>);

/// Trail and Lyapunov values of every robot.
#[derive(Debug, Clone, Default, Serialize)]
pub(crate) struct History {
    pub(crate) trails: BTreeMap<String, VecDeque<Place>>,
    values: BTreeMap<String, VecDeque<Value>>,
}

impl History {
    pub(crate) fn seen(&mut self, robot: &str, time: f64, at: Point) {
        keep(&mut self.trails, robot, time, (time, at), |sample| sample.0);
    }

    pub(crate) fn valued(&mut self, robot: &str, time: f64, value: Option<f64>, bound: Option<f64>) {
        keep(&mut self.values, robot, time, (time, value, bound), |sample| sample.0);
    }
}

fn keep<T>(all: &mut BTreeMap<String, VecDeque<T>>, robot: &str, time: f64, sample: T, time_of: fn(&T) -> f64) {
    if !all.contains_key(robot) {
        all.insert(robot.to_owned(), VecDeque::new());
    }
    let Some(samples) = all.get_mut(robot) else { return };
    match samples.back().map(time_of) {
        Some(last) if time >= last && time - last < STEP => return,
        // The clock went back: another run.
        Some(last) if time < last => samples.clear(),
        _ => {}
    }
    samples.push_back(sample);
    while samples.front().is_some_and(|first| time - time_of(first) > REACH) {
        samples.pop_front();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_holds_a_minute_and_starts_again_when_the_clock_does() {
        let mut history = History::default();
        for tick in 0..3000 {
            history.seen("robot1", f64::from(tick) / 30.0, [Some(0.0), Some(0.0)]);
        }
        let trail = &history.trails["robot1"];
        assert!((590..=610).contains(&trail.len()), "{}", trail.len());
        assert!(trail[0].0 >= 99.9 - REACH - 0.1);
        history.seen("robot1", 1.0, [None, None]);
        assert_eq!(history.trails["robot1"].len(), 1);
    }
}

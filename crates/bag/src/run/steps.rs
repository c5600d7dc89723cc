//! How evenly controllers step: one command a tick, and how long after it.

use crate::{BagError, BagReader};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Display};
use trench_core::RosTime;
use trench_msgs::Message;
use trench_msgs::geometry_msgs::TwistStamped;
use trench_msgs::msg::{RunState, TeamState};

/// The steps of one robot's controller while the run ran, seen where the bag was recorded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepSummary {
    /// The robot.
    pub robot: String,
    /// Frames that the localizer told of.
    pub frames: usize,
    /// Frames that a command answered.
    pub answered: usize,
    /// Median time from exposure to command, s.
    pub delay: f64,
    /// Median time from the team state, which is the tick, to the command, s: may be negative where the recorder heard
    /// of the command first.
    pub step: f64,
    /// 99th percentile of what a step differs from that median, s.
    pub jitter: f64,
}

/// When messages came, by the exposures that they are about, ns.
type Arrivals = BTreeMap<i64, i64>;

/// Reads the steps of all controllers that send stamped commands; nothing of a bag without a run.
///
/// # Errors
/// When the bag cannot be read.
pub fn steps(bag: &BagReader) -> Result<Vec<StepSummary>, BagError> {
    let mut ticks = Arrivals::new();
    let mut robots: BTreeMap<String, Arrivals> = BTreeMap::new();
    let (mut began, mut ended) = (None, None);
    for message in bag.messages() {
        let message = message?;
        let Some(topic) = bag.topics().get(message.topic) else { continue };
        let at = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        match (topic.name.as_str(), topic.type_name.as_str()) {
            ("/team_state", "trench_msgs/msg/TeamState") => {
                ticks.extend(TeamState::decode(&message).ok().map(|team| (RosTime::from(&team.header.stamp).0, at)));
            }
            ("/run_state", "trench_msgs/msg/RunState") => {
                let Ok(run) = RunState::decode(&message) else { continue };
                let t0 = RosTime::from(&run.t0).0;
                if run.state == RunState::RUNNING && t0 != 0 {
                    began.get_or_insert(t0);
                } else if began.is_some() {
                    ended.get_or_insert(RosTime::from(&run.header.stamp).0);
                }
            }
            (name, "geometry_msgs/msg/TwistStamped") => {
                let robot = name.strip_suffix("/cmd_vel").map(|robot| robot.trim_start_matches('/').to_owned());
                let Some((robot, command)) = robot.zip(TwistStamped::decode(&message).ok()) else { continue };
                let exposure = RosTime::from(&command.header.stamp).0;
                // A frame that the watchdog answers again counts once.
                robots.entry(robot).or_default().entry(exposure).or_insert(at);
            }
            _ => {}
        }
    }
    let Some(began) = began else { return Ok(Vec::new()) };
    // The frame at which the run stops may find its controller at rest already.
    let run = began..ended.unwrap_or(i64::MAX);
    ticks.retain(|exposure, _| run.contains(exposure));
    let summary = |(robot, commands): (String, Arrivals)| summary(robot, &ticks, &commands);
    Ok(robots.into_iter().filter_map(summary).collect())
}

fn summary(robot: String, ticks: &Arrivals, commands: &Arrivals) -> Option<StepSummary> {
    let answered = || ticks.iter().filter_map(|(exposure, tick)| Some((exposure, tick, commands.get(exposure)?)));
    let sorted = |mut values: Vec<i64>| {
        values.sort_unstable();
        values
    };
    let delays = sorted(answered().map(|(exposure, _, command)| command - exposure).collect());
    let steps = sorted(answered().map(|(_, tick, command)| command - tick).collect());
    let median = percentile(&steps, 50)?;
    let off = sorted(steps.iter().map(|step| (step - median).abs()).collect());
    let seconds = |nanoseconds: i64| nanoseconds as f64 * 1e-9;
    Some(StepSummary {
        robot,
        frames: ticks.len(),
        answered: steps.len(),
        delay: seconds(percentile(&delays, 50)?),
        step: seconds(median),
        jitter: seconds(percentile(&off, 99)?),
    })
}

/// The smallest value that `percent` of the values do not exceed.
fn percentile(sorted: &[i64], percent: usize) -> Option<i64> {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied()
}

impl Display for StepSummary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { robot, frames, answered, delay, step, jitter } = self;
        let [delay, step, jitter] = [delay, step, jitter].map(|seconds| seconds * 1e3);
        write!(out, "{robot:<12} {answered:>6} of {frames:>6} {delay:>11.2} {step:>11.2} {jitter:>12.2}")
    }
}

/// The steps of all controllers as a table.
pub struct StepTable<'a>(pub &'a [StepSummary]);

impl Display for StepTable<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return Ok(());
        }
        let heads = ["frames answered", "delay (ms)", "step (ms)", "jitter (ms)"];
        let [frames, delay, step, jitter] = heads;
        writeln!(out, "\n{:<12} {frames:>16} {delay:>11} {step:>11} {jitter:>12}", "steps of")?;
        self.0.iter().try_for_each(|robot| writeln!(out, "{robot}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jitter_is_what_steps_differ_from_their_median() {
        let ms = |milliseconds: i64| milliseconds * 1_000_000;
        // Every tenth tick is 20 ms late, and the commands with it: no jitter of the controllers.
        let ticks: Arrivals =
            (0..200).map(|frame| (ms(33 * frame), ms(33 * frame + 40 + 20 * i64::from(frame % 10 == 0)))).collect();
        let mut commands: Arrivals = ticks.iter().map(|(exposure, tick)| (*exposure, tick + ms(2))).collect();
        let even = summary("robot1".to_owned(), &ticks, &commands).unwrap();
        let expected = StepSummary {
            robot: "robot1".to_owned(),
            frames: 200,
            answered: 200,
            delay: 0.042,
            step: 0.002,
            jitter: 0.0,
        };
        assert_eq!(even, expected);
        for frame in 2..5 {
            *commands.get_mut(&ms(33 * frame)).unwrap() += ms(7);
        }
        commands.remove(&0);
        let uneven = summary("robot1".to_owned(), &ticks, &commands).unwrap();
        assert_eq!(uneven.answered, 199);
        assert!((uneven.jitter - 0.007).abs() < 1e-12, "{uneven:?}");
        assert_eq!(summary("robot1".to_owned(), &ticks, &Arrivals::new()), None, "nobody steps");
    }
}

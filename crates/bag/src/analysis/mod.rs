//! What a bag tells of the traffic, the links and the rules of a run, besides where the robots went ([`crate::run`]).

mod clearance;
mod conform;
mod latency;
mod links;
mod noise;
mod percentile;
mod tell;
mod traffic;
mod zones;

pub use clearance::Clearance;
pub use conform::Conformance;
pub use latency::Latency;
pub use links::LinkSummary;
pub use noise::{Noise, NoiseSeries, noise};
pub use percentile::Spread;
pub use traffic::{Gap, TopicTraffic};
pub use zones::ZoneVisit;

use crate::run::Run;
use crate::{BagError, BagReader};
use clearance::Obstacles;
use conform::Conformances;
use latency::Latencies;
use links::Links;
use serde::Serialize;
use traffic::{Traffic, is_stamped};

/// What is judged, and by which bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// Nearer than this to each other, centre to centre, robots are in zone 1 (6.3), m.
    pub zone_radius: f64,
    /// Of a robot's body, m.
    pub body_radius: f64,
}

impl Default for AnalysisOptions {
    /// Of the test bed.
    fn default() -> Self {
        Self { zone_radius: 0.2, body_radius: 0.08 }
    }
}

/// A run in numbers. All times are s since the beginning of the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Analysis {
    /// By topic.
    pub traffic: Vec<TopicTraffic>,
    /// From the team state of a frame to what was made of it.
    pub latencies: Vec<Latency>,
    /// Of each robot's command link.
    pub links: Vec<LinkSummary>,
    /// When each robot came to its segment for good.
    pub conformance: Vec<Conformance>,
    /// How near each robot came to an obstacle.
    pub clearances: Vec<Clearance>,
    /// When two robots were in each other's zone 1.
    pub zone_visits: Vec<ZoneVisit>,
}

/// Analyses the bag that `run` was read from.
///
/// # Errors
/// When the bag cannot be read.
pub fn analyze(bag: &BagReader, run: &Run, options: &AnalysisOptions) -> Result<Analysis, BagError> {
    let stamped: Vec<bool> = bag.topics().iter().map(|topic| is_stamped(&topic.definition)).collect();
    let first = bag.span().map_or(0, |(first, _)| first);
    let t0 = run.t0.unwrap_or_else(|| i64::try_from(first).unwrap_or(0));
    let mut traffic = Traffic::new(bag.topics().len());
    let (mut links, mut conformances) = (Links::default(), Conformances::default());
    let (mut obstacles, mut latencies) = (Obstacles::default(), Latencies::default());
    for message in bag.messages() {
        let message = message?;
        let Some(topic) = bag.topics().get(message.topic) else { continue };
        let is_stamped = stamped.get(message.topic) == Some(&true);
        let stamp = is_stamped.then(|| traffic::stamp(&message)).flatten();
        traffic.note(message.topic, message.log_time, stamp);
        latencies.note(&topic.name, message.log_time, stamp);
        match topic.type_name.as_str() {
            "trench_msgs/msg/LinkStatus" => links.take(&message, t0),
            "trench_msgs/msg/LeaderState" => conformances.take(&message, t0),
            "trench_msgs/msg/ObstacleArray" => obstacles.take(&message, t0),
            _ => {}
        }
    }
    Ok(Analysis {
        traffic: traffic.finish(bag.topics(), t0),
        latencies: latencies.finish(),
        links: links.finish(),
        conformance: conformances.finish(),
        clearances: obstacles.finish(run, options.body_radius),
        zone_visits: zones::visits(run, options.zone_radius),
    })
}

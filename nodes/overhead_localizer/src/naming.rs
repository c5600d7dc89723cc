//! The services by which people say who is who, or have it found out.

use crate::track::Tracker;
use trench_core::{RequestId, Sink};
use trench_msgs::Message;
use trench_msgs::msg::{NameRobotsRequest, NameRobotsResponse};
use trench_msgs::std_srvs::TriggerResponse;

/// Ports of services; the third is ~/name_robots.
const RESET: usize = 0;
const IDENTIFY: usize = 1;

/// Does what is asked and says so.
pub(crate) fn answer(tracker: &mut Tracker, service: usize, id: RequestId, cdr: &[u8], sink: &mut dyn Sink) {
    let done = |message: &str| TriggerResponse { success: true, message: message.to_owned() };
    match service {
        RESET => {
            tracker.reset();
            sink.respond(service, id, &done("identities are found anew, from the start poses or as `names` says"));
        }
        IDENTIFY => {
            tracker.doubt();
            sink.respond(service, id, &done("all robots are in doubt; they are told apart as `names` says"));
        }
        _ => {
            let outcome = name(tracker, cdr);
            let (success, message) = (outcome.is_ok(), outcome.unwrap_or_else(|reason| reason));
            sink.respond(service, id, &NameRobotsResponse { success, message });
        }
    }
}

fn name(tracker: &mut Tracker, cdr: &[u8]) -> Result<String, String> {
    let NameRobotsRequest { robots, x, y } = NameRobotsRequest::decode(cdr).map_err(|error| error.to_string())?;
    if robots.is_empty() || robots.len() != x.len() || robots.len() != y.len() {
        return Err(format!("{} names, {} x and {} y: give as many of each", robots.len(), x.len(), y.len()));
    }
    if !x.iter().chain(&y).all(|place| place.is_finite()) {
        return Err("a place is not finite".to_owned());
    }
    let names: Vec<(String, [f64; 2])> =
        robots.into_iter().zip(x.into_iter().zip(y)).map(|(name, (x, y))| (name, [x, y])).collect();
    tracker.name(&names)?;
    Ok(format!("{} named", names.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")))
}

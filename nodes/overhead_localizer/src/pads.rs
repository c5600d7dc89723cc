//! Pads that another vision system has found: SSL-Vision's robots, AprilTags, anything that knows poses and perhaps names.

use crate::track::{NamedPose, wrap};
use crate::vision::coded::CodedPad;
use trench_msgs::Message;
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::msg::{Pad, PadArray};
use trench_optics::Pose2;

/// More pads than any team has: such a message is broken.
const MOST: usize = 512;

/// The pads of a message: poses, and the robots (their places in `ids`) whose codes were read.
///
/// # Errors
/// With the reason, when the message is not what it should be.
pub(crate) fn read(cdr: &[u8], ids: &[i64]) -> Result<(Time, Vec<NamedPose>), String> {
    let message = PadArray::decode(cdr).map_err(|error| error.to_string())?;
    if message.pads.len() > MOST {
        return Err(format!("more than {MOST} pads"));
    }
    let mut pads: Vec<NamedPose> = Vec::with_capacity(message.pads.len());
    for Pad { id, x, y, theta, .. } in message.pads {
        if !(x.is_finite() && y.is_finite() && theta.is_finite()) {
            return Err("a pad's pose is not finite".to_owned());
        }
        let robot = ids.iter().position(|own| *own == i64::from(id));
        // Codes that are nobody's are of other teams' robots.
        if robot.is_none() && id != Pad::NO_ID {
            continue;
        }
        if robot.is_some() && pads.iter().any(|(_, other)| *other == robot) {
            return Err(format!("two pads have the code {id}"));
        }
        pads.push((Pose2 { x, y, theta: wrap(theta) }, robot));
    }
    Ok((message.header.stamp, pads))
}

/// The robots (their places in `ids`) whose codes were read, and a code that two pads have: neither of them is believed.
pub(crate) fn named(coded: &[CodedPad], ids: &[i64]) -> (Vec<NamedPose>, Option<u32>) {
    let count = |id: u32| coded.iter().filter(|pad| pad.id == id).count();
    let twice = coded.iter().map(|pad| pad.id).find(|id| count(*id) > 1);
    let robot = |pad: &CodedPad| ids.iter().position(|own| *own == i64::from(pad.id));
    let once = coded.iter().filter(|pad| count(pad.id) == 1);
    // Codes that are nobody's are of other teams' robots.
    (once.filter_map(|pad| Some((pad.pose, Some(robot(pad)?)))).collect(), twice)
}

//! What the controller is connected to.

use crate::settings::Settings;
use trench_core::{Advertise, Interface, Local, Qos, Subscribe};
use trench_msgs::Encode;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::{
    ApparentObstacleArray, Assignment, Formation, Goals, Identify, LeaderState, LinkStatus, RunState, Stability,
    TeamState,
};
use trench_msgs::std_msgs::{Bool, Float64, Header};
use trench_msgs::visualization_msgs::MarkerArray;

pub(crate) const TEAM_STATE: usize = 0;
pub(crate) const GOALS: usize = 1;
pub(crate) const ASSIGNMENT: usize = 2;
pub(crate) const FORMATION: usize = 3;
pub(crate) const RUN_STATE: usize = 4;
pub(crate) const APPARENT_OBSTACLES: usize = 5;
pub(crate) const EMERGENCY_STOP: usize = 6;
pub(crate) const LINK: usize = 7;
/// What this robot says of itself: whoever else says it is a second controller.
pub(crate) const OWN: usize = 8;
/// Leader states of the others follow from here on, then /identify and /loop_delay.
pub(crate) const OTHERS: usize = 9;

pub(crate) const CMD_VEL: usize = 0;
pub(crate) const LEADER_STATE: usize = 1;
pub(crate) const DIAGNOSTICS: usize = 2;
pub(crate) const STABILITY: usize = 3;
pub(crate) const MARKERS: usize = 4;

/// The frame of all that a controller says.
pub(crate) const MAP: &str = "map";

/// All topics of a controller that hears `others`.
pub(crate) fn interface(settings: &Settings, others: &[String]) -> Interface {
    // Goals, obstacles and what the others say are used at the next tick, and wake nobody.
    let mut subscriptions = vec![
        Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE),
        Subscribe::to::<Goals>("/goals", Qos::RELIABLE).without_waking(),
        Subscribe::to::<Assignment>("/assignment", Qos::LATCHED),
        Subscribe::to::<Formation>("/formation", Qos::LATCHED),
        Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
        Subscribe::to::<ApparentObstacleArray>("/apparent_obstacles", Qos::RELIABLE).without_waking(),
        Subscribe::to::<Bool>("/emergency_stop", Qos::RELIABLE).once(),
        Subscribe::to::<LinkStatus>(format!("/{}/link", settings.robot), Qos::RELIABLE).without_waking(),
    ];
    let leader_state =
        |name: &String| Subscribe::to::<LeaderState>(format!("/{name}/leader_state"), Qos::RELIABLE).without_waking();
    let robot = &settings.robot;
    subscriptions.push(leader_state(robot));
    subscriptions.extend(others.iter().map(leader_state));
    subscriptions.push(Subscribe::to::<Identify>("/identify", Qos::RELIABLE).without_waking());
    subscriptions.push(Subscribe::to::<Float64>("/loop_delay", Qos::LATCHED).without_waking());
    // Just the room it needs: only where messages are short may the network rest.
    let max_len = longest_state(robot, others).encoded_len();
    let command = format!("/{robot}/cmd_vel");
    let command = if settings.stamped {
        Advertise::of::<TwistStamped>(command, Qos::RELIABLE, Local::SMALL)
    } else {
        Advertise::of::<Twist>(command, Qos::RELIABLE, Local::SMALL)
    };
    Interface {
        subscriptions,
        publications: vec![
            command,
            Advertise::of::<LeaderState>(
                format!("/{robot}/leader_state"),
                Qos::RELIABLE,
                Local::SharedMemory { max_len },
            ),
            Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
            Advertise::of::<Stability>(format!("/{robot}/stability"), Qos::RELIABLE, Local::SMALL),
            Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly),
        ],
        ..Interface::default()
    }
}

/// A leader state of `robot` that hears everybody.
fn longest_state(robot: &str, others: &[String]) -> LeaderState {
    let header = Header { frame_id: MAP.to_owned(), ..Header::default() };
    LeaderState { header, robot: robot.to_owned(), hears: others.to_vec(), ..LeaderState::default() }
}

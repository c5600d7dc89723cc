//! How the bridge is made and what it is connected to.

use crate::capacity::shortage;
use crate::channel::Channel;
use crate::core::RfBridge;
use crate::downlink::Downlink;
use crate::robot::Robot;
use crate::run::Run;
use crate::settings::{Settings, descriptors};
use crate::stop::EmergencyStop;
use crate::welcome::Hellos;
use trench_config::Parameters;
use trench_core::{
    Advertise, ByteStream, Files, Health, Interface, Local, Master, NodeContext, NodeCore, NodeDescription, Qos,
    Refusals, Serve, StartError, Steady, Subscribe, resolve_name,
};
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::geometry_msgs::{Twist, TwistStamped};
use trench_msgs::msg::{Identify, LinkStatus, RunState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::{BatteryState, Range};
use trench_msgs::std_msgs::Bool;
use trench_msgs::std_srvs::Trigger;
use trench_msgs::{Encode, Message, service_info};
use trench_radio::{ErrorCounts, RelayList, StreamDecoder};

pub(crate) const RUN_STATE: usize = 0;
pub(crate) const EMERGENCY_STOP: usize = 1;
/// The robots' cmd_vel follow from here on, and /identify.
pub(crate) const COMMANDS: usize = 2;

pub(crate) const DIAGNOSTICS: usize = 0;
/// Each robot's publications follow from here on: battery, odometry, link, ranges.
pub(crate) const REPORTS: usize = 1;
pub(crate) const BATTERY: usize = 0;
pub(crate) const ODOMETRY: usize = 1;
pub(crate) const LINK: usize = 2;
pub(crate) const RANGES: usize = 3;

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "rf_bridge",
        about: "Carries wheel commands to the robots and telemetry back over the radio base station's serial port",
        parameters: descriptors,
        build,
    }
}

fn build(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let settings = Settings::read(parameters, files)?;
    let (promised, stop) = restored(context.checkpoint.as_deref().unwrap_or_default());
    Ok(Box::new(RfBridge {
        interface: interface(&settings),
        tuning: settings.tuning,
        ranges: settings.ranges,
        shortage: shortage(settings.robots.len(), settings.ranges, settings.key.is_some(), settings.baud),
        stamped: settings.stamped,
        robots: settings.robots.iter().map(|(name, id)| Robot::new(name.clone(), *id)).collect(),
        downlink: Downlink::new(settings.key, settings.baud, promised),
        wall: context.wall,
        decoder: StreamDecoder::default(),
        errors: ErrorCounts::default(),
        channel: Channel::default(),
        relays: RelayList::default(),
        hellos: Hellos::default(),
        open: false,
        answered: None,
        run: Run::default(),
        localizer: Master::default(),
        turning: None,
        stop,
        reset_until: None,
        gathered_at: None,
        heartbeat_at: Steady::default(),
        repeat_at: None,
        looked_at: None,
        refusals: Refusals::default(),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
    }))
}

/// The promised counter and the emergency stop of the last life: eight bytes and one, and sixteen for each who said stop.
fn restored(checkpoint: &[u8]) -> (u64, EmergencyStop) {
    let Some((counter, rest)) = checkpoint.split_first_chunk() else { return (0, EmergencyStop::default()) };
    let (stopped, said_stop) = rest.split_first().unwrap_or((&0, &[]));
    let stop = EmergencyStop::restored(*stopped != 0, said_stop.as_chunks().0.iter().copied());
    (u64::from_le_bytes(*counter), stop)
}

fn interface(settings: &Settings) -> Interface {
    let command = if settings.stamped { TwistStamped::TYPE } else { Twist::TYPE };
    let mut subscriptions = vec![
        Subscribe::to::<RunState>("/run_state", Qos::LATCHED),
        Subscribe::to::<Bool>("/emergency_stop", Qos::RELIABLE).once(),
    ];
    // The longest is a link on which everybody is heard.
    let robots = settings.robots.iter().map(|(name, _)| name.clone());
    let link = LinkStatus { hears: robots.collect(), ..LinkStatus::default() };
    let max_len = link.encoded_len().max(Local::SMALL_LEN);
    let advertise = |topic: String, type_info| Advertise {
        topic,
        type_info,
        qos: Qos::RELIABLE,
        local: Local::SharedMemory { max_len },
    };
    let mut publications = vec![Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly)];
    for (name, _) in &settings.robots {
        subscriptions.push(Subscribe::of_type(format!("/{name}/cmd_vel"), command, Qos::RELIABLE));
        publications.push(advertise(format!("/{name}/battery_state"), BatteryState::TYPE));
        publications.push(advertise(format!("/{name}/wheel_odom"), Odometry::TYPE));
        publications.push(advertise(format!("/{name}/link"), LinkStatus::TYPE));
        let ranges = 0..settings.ranges;
        publications.extend(ranges.map(|sensor| advertise(format!("/{name}/range_{sensor}"), Range::TYPE)));
    }
    subscriptions.push(Subscribe::to::<Identify>("/identify", Qos::RELIABLE));
    Interface {
        subscriptions,
        publications,
        services: vec![Serve { name: "~/reset".to_owned(), service: service_info::<Trigger>() }],
        byte_streams: vec![ByteStream::Serial { path: settings.port.clone(), baud: settings.baud }],
        ..Interface::default()
    }
}

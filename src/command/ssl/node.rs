//! The node between /team_state or /overhead/pads and the league's packets.

use super::Link;
use std::io;
use std::net::{Ipv4Addr, SocketAddrV4, UdpSocket};
use std::process::ExitCode;
use std::sync::OnceLock;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Event, Files, Interface, Level, Local, NodeContext, NodeCore, NodeDescription, Qos, RosTime, Sink,
    StartError, Steady, Subscribe, Times,
};
use trench_msgs::Message;
use trench_msgs::msg::{Pad, PadArray, RobotState, TeamState};
use trench_msgs::std_msgs::Header;
use trench_ssl::{Seen, Team, frame_of, packet_of};

/// Which way packets go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// To the league's tools.
    Out,
    /// From the league's cameras.
    In,
}

/// How often the socket is looked at, s.
const LOOK: f64 = 0.002;
/// A packet of UDP.
const LONGEST: usize = 1 << 16;
/// From exposure to sending, s; more is another clock.
const LONGEST_DELAY: f64 = 0.2;

/// What the process was told: nodes are made by plain functions, which can be given nothing else.
static TOLD: OnceLock<(Link, Way)> = OnceLock::new();

/// Runs the node until a signal ends it.
pub(super) fn run(link: &Link, way: Way) -> ExitCode {
    let (link, _) = TOLD.get_or_init(|| (link.clone(), way));
    let arguments = link.node_arguments.iter().cloned();
    ExitCode::from(trench_runtime::run_with_arguments(description(), arguments))
}

fn description() -> NodeDescription {
    NodeDescription { name: "ssl_vision", about: "Speaks SSL-Vision's packets", parameters, build }
}

fn parameters() -> Vec<ParameterDescriptor> {
    Vec::new()
}

fn build(_: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let failed = |problem: String| parameters.error("group", problem, "see trench ssl --help");
    let (link, way) = TOLD.get().ok_or_else(|| failed("is not told".to_owned()))?;
    let socket = open(link, *way).map_err(|error| failed(format!("{}:{}: {error}", link.group, link.port)))?;
    Ok(Box::new(Speaker::new(link, *way, socket)))
}

fn open(link: &Link, way: Way) -> io::Result<UdpSocket> {
    let port = if way == Way::In { link.port } else { 0 };
    let socket = UdpSocket::bind(SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, port))?;
    socket.set_nonblocking(true)?;
    if link.group.is_multicast() && way == Way::In {
        socket.join_multicast_v4(&link.group, &link.network)?;
    }
    Ok(socket)
}

struct Speaker {
    interface: Interface,
    way: Way,
    team: Team,
    origin: [f64; 2],
    target: SocketAddrV4,
    socket: UdpSocket,
    /// The last thing that went wrong, said once.
    fault: Option<String>,
    next: Steady,
}

impl Speaker {
    fn new(link: &Link, way: Way, socket: UdpSocket) -> Self {
        let interface = match way {
            Way::Out => Interface {
                subscriptions: vec![Subscribe::to::<TeamState>("/team_state", Qos::RELIABLE)],
                ..Interface::default()
            },
            Way::In => Interface {
                publications: vec![Advertise::of::<PadArray>(
                    "/overhead/pads",
                    Qos::SENSOR,
                    Local::SharedMemory { max_len: 1 << 15 },
                )],
                ..Interface::default()
            },
        };
        Self {
            interface,
            way,
            team: link.team.into(),
            origin: [0, 1].map(|axis| link.origin.get(axis).copied().unwrap_or(0.0)),
            target: SocketAddrV4::new(link.group, link.port),
            socket,
            fault: None,
            next: Steady::default(),
        }
    }

    fn send(&mut self, at: Times, cdr: &[u8]) -> Result<(), String> {
        let state = TeamState::decode(cdr).map_err(|error| error.to_string())?;
        let known =
            |robot: &&RobotState| matches!(robot.status, RobotState::STATUS_TRACKED | RobotState::STATUS_PREDICTED);
        let seen: Vec<Seen> = state
            .robots
            .iter()
            .enumerate()
            .filter(|(_, robot)| known(robot))
            .map(|(index, robot)| Seen {
                id: number(&robot.name).unwrap_or(index as u32 + 1),
                x: robot.x - self.origin[0],
                y: robot.y - self.origin[1],
                theta: robot.theta,
                confidence: if robot.status == RobotState::STATUS_TRACKED { 1.0 } else { 0.5 },
            })
            .collect();
        let times = [RosTime::from(&state.header.stamp), at.ros].map(|time| time.0 as f64 * 1e-9);
        let packet = packet_of(&seen, self.team, state.frame_number as u32, times);
        self.socket.send_to(&packet, self.target).map(|_| ()).map_err(|error| format!("{}: {error}", self.target))
    }

    /// Takes the packets that have come.
    fn receive(&mut self, at: Times, sink: &mut dyn Sink) -> Result<(), String> {
        let mut bytes = [0; LONGEST];
        loop {
            let length = match self.socket.recv(&mut bytes) {
                Ok(length) => length,
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
                Err(error) => return Err(error.to_string()),
            };
            let frame = frame_of(&bytes[..length], self.team).map_err(|error| error.to_string())?;
            if let Some((frame, seen)) = frame {
                // Their clock is not ours: what counts is how long before sending it was.
                let delay = (frame.t_sent - frame.t_capture).clamp(0.0, LONGEST_DELAY);
                let header = Header { stamp: at.ros.plus_seconds(-delay).into(), frame_id: "map".to_owned() };
                let pads = seen.iter().filter_map(|seen| self.pad(seen)).collect();
                sink.publish(0, &PadArray { header, pads });
            }
        }
    }

    fn pad(&self, seen: &Seen) -> Option<Pad> {
        let [x, y] = [seen.x + self.origin[0], seen.y + self.origin[1]];
        Some(Pad { id: i32::try_from(seen.id).ok()?, x, y, theta: seen.theta, confidence: seen.confidence })
    }
}

impl NodeCore for Speaker {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        let done = match event {
            Event::Message { cdr, .. } => self.send(at, cdr),
            Event::Started | Event::Wakeup if self.way == Way::In => {
                self.next = at.steady.plus_seconds(LOOK);
                self.receive(at, sink)
            }
            _ => return,
        };
        let fault = done.err();
        if let Some(text) = fault.as_ref().filter(|_| fault != self.fault) {
            sink.log(Level::Warn, text);
        }
        self.fault = fault.or_else(|| self.fault.take());
    }

    fn next_wakeup(&self) -> Option<Steady> {
        (self.way == Way::In).then_some(self.next)
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        Ok(())
    }
}

/// The number at the end of a robot's name.
fn number(name: &str) -> Option<u32> {
    let digits = name.len() - name.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
    name[name.len() - digits..].parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::ssl::Colour;
    use trench_core::{Outbox, Source};
    use trench_msgs::Encode;

    #[test]
    fn robots_go_out_and_come_in_again() {
        let inward = UdpSocket::bind(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 0)).unwrap();
        inward.set_nonblocking(true).unwrap();
        let link = Link {
            group: Ipv4Addr::LOCALHOST,
            port: inward.local_addr().unwrap().port(),
            network: Ipv4Addr::UNSPECIFIED,
            team: Colour::Blue,
            origin: vec![1.24, 0.915],
            node_arguments: Vec::new(),
        };
        let mut sender = Speaker::new(&link, Way::Out, open(&link, Way::Out).unwrap());
        let mut receiver = Speaker::new(&link, Way::In, inward);
        let robot = |name: &str, status: u8, x: f64| RobotState {
            name: name.to_owned(),
            status,
            x,
            y: 0.5,
            theta: 1.0,
            ..RobotState::default()
        };
        let robots = vec![
            robot("robot7", RobotState::STATUS_TRACKED, 0.25),
            robot("robot8", RobotState::STATUS_AMBIGUOUS, 1.0),
            robot("scout", RobotState::STATUS_PREDICTED, 2.0),
        ];
        let header = Header { stamp: RosTime(5_000_000_000).into(), frame_id: "map".to_owned() };
        let state = TeamState { header, frame_number: 3, robots, ..TeamState::default() }.to_cdr();
        let at = |milliseconds: i64| Times { ros: RosTime(1_000_000 * milliseconds), steady: Steady(0) };
        let mut outbox = Outbox::default();
        sender.handle(
            at(5040),
            Event::Message { port: 0, source: Source::default(), cdr: &state, arrived: None },
            &mut outbox,
        );
        // Loopback hands a packet over at once, but not always before the next instruction.
        let pads = (0..200).find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            let mut outbox = Outbox::default();
            receiver.handle(at(9000), Event::Wakeup, &mut outbox);
            outbox.published::<PadArray>(0).pop()
        });
        let PadArray { header, pads } = pads.unwrap();
        assert_eq!(RosTime::from(&header.stamp), RosTime(8_960_000_000));
        let seen: Vec<(i32, f64)> = pads.iter().map(|pad| (pad.id, (1e4 * pad.x).round() * 1e-4)).collect();
        assert_eq!(seen, [(7, 0.25), (3, 2.0)]);
    }

    #[test]
    fn names_end_in_numbers() {
        assert_eq!(["robot12", "r2d2", "scout", "7"].map(number), [Some(12), Some(2), None, Some(7)]);
    }
}

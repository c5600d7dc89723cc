//! The node core.

use crate::markers::outlines;
use crate::sources::Sources;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_core::{
    Advertise, Condition, Event, Files, Health, Interface, Level, Local, NodeContext, NodeCore, NodeDescription, Qos,
    Sink, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{ApparentObstacleArray, ObstacleArray};
use trench_msgs::std_msgs::Header;
use trench_msgs::visualization_msgs::MarkerArray;

const OBSTACLES: usize = 0;

const APPARENT_OBSTACLES: usize = 0;
const MARKERS: usize = 1;
const DIAGNOSTICS: usize = 2;

/// Room for some hundred hulls in shared memory.
const HULLS: Local = Local::SharedMemory { max_len: 65_536 };

/// Combines what all sources tell of.
pub struct ObstacleMapper {
    interface: Interface,
    settings: Settings,
    sources: Sources,
    health: Health,
    wakeup: Option<Steady>,
    refused: u64,
}

#[derive(Debug, Clone, Copy)]
struct Settings {
    clearance: f64,
    period: f64,
}

impl Settings {
    fn read(parameters: &Parameters) -> Result<Self, ConfigError> {
        Ok(Self { clearance: parameters.f64("clearance")?, period: 1.0 / parameters.f64("rate")? })
    }
}

/// The node as processes and the simulator make it.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "obstacle_mapper",
        about: "Turns obstacles into apparent obstacles: convex hulls, combined where no robot passes between them",
        parameters: || {
            vec![
                ParameterDescriptor::double("clearance", 0.2, "m, hulls nearer to each other than this are combined")
                    .range(0.0, 100.0),
                ParameterDescriptor::double("rate", 20.0, "1/s, at which /apparent_obstacles is sent")
                    .range(10.0, 100.0),
            ]
        },
        build,
    }
}

fn build(context: &NodeContext, parameters: &Parameters, _: &dyn Files) -> Result<Box<dyn NodeCore>, StartError> {
    let interface = Interface {
        subscriptions: vec![Subscribe::to::<ObstacleArray>("/obstacles", Qos::RELIABLE)],
        publications: vec![
            Advertise::of::<ApparentObstacleArray>("/apparent_obstacles", Qos::RELIABLE, HULLS),
            Advertise::of::<MarkerArray>("/markers", Qos::RELIABLE, Local::NetworkOnly),
            Advertise::of::<DiagnosticArray>("/diagnostics", Qos::RELIABLE, Local::NetworkOnly),
        ],
        ..Interface::default()
    };
    Ok(Box::new(ObstacleMapper {
        interface,
        settings: Settings::read(parameters)?,
        sources: Sources::default(),
        health: Health::new(resolve_name("~", &context.namespace, &context.name)),
        wakeup: None,
        refused: 0,
    }))
}

impl ObstacleMapper {
    fn publish(&mut self, at: Times, changed: bool, sink: &mut dyn Sink) {
        self.wakeup = Some(at.steady.plus_seconds(self.settings.period));
        let obstacles = match self.sources.combined(self.settings.clearance) {
            Ok(obstacles) => obstacles,
            Err(error) => {
                self.health.set("hulls", Condition::Error, error.to_string());
                return;
            }
        };
        if changed {
            sink.publish(MARKERS, &outlines(&obstacles, at.ros));
        }
        self.health.set("hulls", Condition::Ok, format!("{} of {} obstacles", obstacles.len(), self.sources.len()));
        let header = Header { stamp: at.ros.into(), frame_id: "map".to_owned() };
        let message = ApparentObstacleArray { header, clearance: self.settings.clearance, obstacles };
        sink.publish(APPARENT_OBSTACLES, &message);
    }

    fn refuse(&mut self, what: &str, sink: &mut dyn Sink) {
        self.refused += 1;
        self.health.set("obstacles", Condition::Error, what);
        self.health.value("obstacles", "refused", self.refused);
        sink.log(Level::Warn, what);
    }
}

impl NodeCore for ObstacleMapper {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.publish(at, true, sink),
            Event::Wakeup => self.publish(at, false, sink),
            Event::Message { port: OBSTACLES, source, cdr } => match ObstacleArray::decode(cdr) {
                Ok(message) => {
                    for (id, reason) in self.sources.take(source.gid, &message) {
                        self.refuse(&format!("obstacle {id} is left out: {reason}"), sink);
                    }
                    self.publish(at, true, sink);
                }
                Err(error) => self.refuse(&format!("a message on /obstacles was dropped: {error}"), sink),
            },
            _ => {}
        }
        self.health.publish(at, DIAGNOSTICS, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.wakeup
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        self.settings = Settings::read(parameters)?;
        Ok(())
    }
}

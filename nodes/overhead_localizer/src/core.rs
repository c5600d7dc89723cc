//! The localizer as a state machine: frames in, the team's state out.

use crate::messages;
use crate::report::{PERIOD, Report};
use crate::settings::{Input, Settings, descriptors};
use crate::stream::Stream;
use crate::track::{MapDisc, Tracker};
use crate::vision::{Colour, Detector, Disc, Expectation, Frame};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Durability, Event, Files, Health, Interface, Local, NodeContext, NodeCore, NodeDescription, Qos,
    Reliability, RosTime, Serve, Sink, Source, StartError, Steady, Subscribe, Times, resolve_name,
};
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{DiscArray, TeamState};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::sensor_msgs::{Image, ImageView};
use trench_msgs::std_srvs::{Trigger, TriggerResponse};
use trench_msgs::tf2_msgs::TFMessage;
use trench_msgs::{Encode, Message, TypeInfo, service_info};
use trench_optics::Pixel;

/// Ports of publications; `<r>/odom` follows, one a robot.
const TEAM_STATE: usize = 0;
const TF: usize = 1;
const DIAGNOSTICS: usize = 2;
const ODOMETRY: usize = 3;

/// More discs than any detector finds pads for: such a message is broken.
const MOST_DISCS: usize = 1024;

/// The node, for its process, the simulator and the bag checker.
#[must_use]
pub fn description() -> NodeDescription {
    NodeDescription {
        name: "overhead_localizer",
        about: "Finds every robot's colour pad in the overhead camera's frames and publishes the team's state.",
        parameters: descriptors,
        build: |context, parameters, files| Ok(Box::new(OverheadLocalizer::new(context, parameters, files)?)),
    }
}

/// The node's core.
pub struct OverheadLocalizer {
    interface: Interface,
    settings: Settings,
    detector: Detector,
    tracker: Tracker,
    stream: Stream,
    report: Report,
    next_look: Option<Steady>,
    found: Vec<Disc>,
    discs: Vec<MapDisc>,
}

impl OverheadLocalizer {
    /// A localizer that has seen nothing yet.
    ///
    /// # Errors
    /// When parameters or the files they name are wrong.
    pub fn new(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Self, StartError> {
        let settings = Settings::load(parameters, files)?;
        let detector = detector(&settings, parameters)?;
        let tracker = Tracker::new(settings.team.clone(), settings.noise_seed);
        let name = resolve_name(&context.name, &context.namespace, &context.name);
        Ok(Self {
            interface: interface(&settings, &tracker),
            detector,
            tracker,
            stream: Stream::default(),
            report: Report::new(Health::new(name), DIAGNOSTICS),
            next_look: None,
            found: Vec::new(),
            discs: Vec::new(),
            settings,
        })
    }

    fn message(&mut self, at: Times, source: Source, cdr: &[u8], sink: &mut dyn Sink) {
        let taken = match self.settings.input {
            Input::Image => self.image(source, cdr),
            Input::Detections => self.detections(source, cdr),
        };
        match taken {
            Ok(Some((stamp, interval))) => {
                self.tracker.step(interval, &self.discs);
                self.publish(stamp, source.sequence, sink);
                self.report.frame(at, self.tracker.tracks(), &self.stream, sink);
            }
            Ok(None) => {}
            Err(reason) => self.report.reject(reason, sink),
        }
    }

    /// Finds the discs of a frame; gives its stamp and the time since the previous one, nothing if it is not newer.
    fn image(&mut self, source: Source, cdr: &[u8]) -> Result<Option<(Time, f64)>, String> {
        let image = ImageView::decode(cdr).map_err(|error| error.to_string())?;
        let lens = self.settings.camera.lens();
        let expected = [lens.width as usize, lens.height as usize];
        let size = [image.width as usize, image.height as usize];
        let frame = Frame::new(expected, image.encoding, size, image.step as usize, image.data)
            .map_err(|error| error.to_string())?;
        let Some(interval) = self.stream.take(source, RosTime::from(&image.header.stamp)) else { return Ok(None) };
        self.detector.detect(frame, &mut self.found);
        let (camera, height) = (&self.settings.camera, self.settings.team.pad.height);
        self.discs.clear();
        self.discs.extend(self.found.iter().filter_map(|disc| MapDisc::seen(camera, height, disc.colour, disc.centre)));
        Ok(Some((image.header.stamp, interval)))
    }

    /// Takes the discs that another detector found.
    fn detections(&mut self, source: Source, cdr: &[u8]) -> Result<Option<(Time, f64)>, String> {
        use trench_msgs::msg::Disc as Message;
        let message = DiscArray::decode(cdr).map_err(|error| error.to_string())?;
        if message.discs.len() > MOST_DISCS {
            return Err(format!("more than {MOST_DISCS} discs"));
        }
        let (camera, height) = (&self.settings.camera, self.settings.team.pad.height);
        self.discs.clear();
        for Message { colour, u, v, .. } in message.discs {
            let colour = match colour {
                Message::COLOUR_YELLOW => Colour::Yellow,
                Message::COLOUR_BLUE => Colour::Blue,
                other => return Err(format!("a disc has the colour {other}, it must be 0 or 1")),
            };
            if !(u.is_finite() && v.is_finite()) {
                return Err("a disc's place is not finite".to_owned());
            }
            self.discs.extend(MapDisc::seen(camera, height, colour, Pixel { u, v }));
        }
        let interval = self.stream.take(source, RosTime::from(&message.header.stamp));
        Ok(interval.map(|interval| (message.header.stamp, interval)))
    }

    fn publish(&self, stamp: Time, frame_number: u64, sink: &mut dyn Sink) {
        let tracks = self.tracker.tracks();
        // First what controllers wait for.
        sink.publish(TEAM_STATE, &messages::team_state(stamp, frame_number, tracks));
        let mut transforms = Vec::with_capacity(tracks.len());
        for (index, track) in tracks.iter().enumerate() {
            if let Some(state) = messages::shown(track) {
                sink.publish(ODOMETRY + index, &messages::odometry(stamp, &track.name, state));
                transforms.push(messages::transform(stamp, &track.name, state));
            }
        }
        sink.publish(TF, &TFMessage { transforms });
    }
}

impl NodeCore for OverheadLocalizer {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Message { source, cdr, .. } => self.message(at, source, cdr, sink),
            Event::Request { service, id, .. } => {
                self.tracker.reset();
                let message = "identities are found anew, from the start poses or by order".to_owned();
                sink.respond(service, id, &TriggerResponse { success: true, message });
            }
            Event::Started | Event::Wakeup => {
                self.report.publish(at, self.tracker.tracks(), &self.stream, sink);
                self.next_look = Some(at.steady.plus_seconds(PERIOD));
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.next_look
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let mut settings = self.settings.clone();
        settings.tune(parameters)?;
        self.detector = detector(&settings, parameters)?;
        self.tracker.tune(settings.team.clone());
        self.settings = settings;
        Ok(())
    }
}

fn detector(settings: &Settings, parameters: &Parameters) -> Result<Detector, ConfigError> {
    let expectation = Expectation::new(&settings.camera, &settings.team.pad)
        .ok_or_else(|| parameters.error("mount_file", "the camera does not see a pad below it", "measure it again"))?;
    Ok(Detector::new(&settings.colours, expectation))
}

fn interface(settings: &Settings, tracker: &Tracker) -> Interface {
    let read =
        |topic: &str, type_info: &'static TypeInfo| Subscribe { topic: topic.to_owned(), type_info, qos: Qos::SENSOR };
    let write =
        |topic: String, type_info: &'static TypeInfo, local| Advertise { topic, type_info, qos: Qos::RELIABLE, local };
    // Names, frame and the number of robots are fixed, and so is the length.
    let max_len = messages::team_state(Time::default(), 0, tracker.tracks()).encoded_len();
    // tf2's listeners keep a hundred.
    let tf = Qos { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 100 };
    let mut publications = vec![
        write("/team_state".to_owned(), TeamState::TYPE, Local::SharedMemory { max_len }),
        Advertise { qos: tf, ..write("/tf".to_owned(), TFMessage::TYPE, Local::NetworkOnly) },
        write("/diagnostics".to_owned(), DiagnosticArray::TYPE, Local::NetworkOnly),
    ];
    publications.extend(
        tracker.tracks().iter().map(|track| write(format!("/{}/odom", track.name), Odometry::TYPE, Local::NetworkOnly)),
    );
    let subscriptions = match settings.input {
        Input::Image => vec![read("/overhead/image_raw", Image::TYPE)],
        Input::Detections => vec![read("/overhead/detections", DiscArray::TYPE)],
    };
    let services = vec![Serve { name: "~/reset".to_owned(), service: service_info::<Trigger>() }];
    Interface { subscriptions, publications, services, ..Interface::default() }
}

//! The localizer as a state machine: frames in, the team's state out.

use crate::frozen::Frozen;
use crate::gather::{Gather, Look};
use crate::intake::{Intake, Sighting};
use crate::memory::Memory;
use crate::refusal::{Dropped, Refusal};
use crate::report::{PERIOD, Report};
use crate::settings::{Input, Pattern, Settings, descriptors, foreign};
use crate::stream::Stream;
use crate::track::{MapDisc, Tracker};
use crate::{markers, messages, naming, pads, recalibrate};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Durability, Event, Files, Health, Interface, Local, Master, NodeContext, NodeCore, NodeDescription, Qos,
    Reliability, RosTime, Serve, Sink, Source, StartError, Steady, Times, resolve_name,
};
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::msg::{
    Identify, NameRobots, SetCalibration, SetCalibrationRequest, SetCalibrationResponse, TeamState,
};
use trench_msgs::nav_msgs::Odometry;
use trench_msgs::std_msgs::Float64;
use trench_msgs::std_srvs::Trigger;
use trench_msgs::tf2_msgs::TFMessage;
use trench_msgs::visualization_msgs::MarkerArray;
use trench_msgs::{Encode, Message, TypeInfo, service_info};

/// Ports of publications; `<r>/odom` follows, one a robot, /identify and /loop_delay.
const TEAM_STATE: usize = 0;
const TF: usize = 1;
const DIAGNOSTICS: usize = 2;
const MARKERS: usize = 3;
const ODOMETRY: usize = 4;

/// Port of the service ~/set_calibration; those before it are [`naming`]'s.
const SET_CALIBRATION: usize = 3;

/// The shortest time between two pictures for viewers, s; a frame that comes a little early counts as due.
const PICTURES: f64 = 0.095;

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
    /// One a camera.
    intakes: Vec<Intake>,
    /// Whose frames of each camera count.
    masters: Vec<Master>,
    /// Of several cameras.
    gather: Option<Gather>,
    /// One a camera.
    frozen: Vec<Frozen>,
    tracker: Tracker,
    stream: Stream,
    memory: Memory,
    report: Report,
    next_look: Option<Steady>,
    last_picture: Option<Steady>,
    sightings: Vec<Sighting>,
    /// The delay that was published last, s.
    delay: Option<f64>,
}

impl OverheadLocalizer {
    /// A localizer that has seen nothing yet.
    ///
    /// # Errors
    /// When parameters or the files they name are wrong.
    pub fn new(context: &NodeContext, parameters: &Parameters, files: &dyn Files) -> Result<Self, StartError> {
        let settings = Settings::load(parameters, files)?;
        let intakes = intakes(&settings).ok_or_else(|| blind(parameters))?;
        let several = (settings.cameras.len() > 1).then_some(settings.cameras.len());
        let tracker = Tracker::new(settings.team.clone(), settings.noise_seed);
        let name = resolve_name(&context.name, &context.namespace, &context.name);
        Ok(Self {
            interface: interface(&settings, &tracker),
            intakes,
            masters: vec![Master::default(); settings.cameras.len()],
            frozen: vec![Frozen::default(); settings.cameras.len()],
            gather: several.map(|cameras| Gather::new(cameras, settings.together)),
            tracker,
            stream: Stream::default(),
            memory: Memory::new(context.checkpoint.as_deref()),
            report: Report::new(Health::new(name), DIAGNOSTICS),
            next_look: None,
            last_picture: None,
            sightings: Vec::new(),
            delay: None,
            settings,
        })
    }

    fn message(&mut self, at: Times, camera: usize, source: Source, cdr: &[u8], sink: &mut dyn Sink) {
        match self.take(at, camera, source, cdr, sink) {
            Ok(()) => {
                if let Some(master) = self.masters.get_mut(camera) {
                    master.pin(source, at.steady);
                }
            }
            Err(Dropped::Broken(reason)) => self.report.reject(reason, sink),
            Err(Dropped::Refused(refusal)) => {
                self.report.refuse(at.steady, (&self.interface, camera), refusal, sink);
            }
        }
    }

    /// Takes a message of the publisher that counts. Whoever sends what is no frame, or none of this time, does not become it.
    fn take(
        &mut self,
        at: Times,
        camera: usize,
        source: Source,
        cdr: &[u8],
        sink: &mut dyn Sink,
    ) -> Result<(), Dropped> {
        let Some(master) = self.masters.get_mut(camera) else { return Ok(()) };
        master.check(source, at.steady, Master::SILENCE).map_err(Refusal::from)?;
        if self.settings.input == Input::Pads {
            return self.pads(at, source, cdr, sink);
        }
        let Self { intakes, stream, gather, sightings, .. } = self;
        let Some(intake) = intakes.get_mut(camera) else { return Ok(()) };
        let is_new = |stamp: RosTime| {
            at.timely(stamp)?;
            Ok(match gather {
                None => stream.take(at.steady, source, stamp),
                Some(gather) => gather.wants(camera, stamp).then_some(0.0),
            })
        };
        let taken = intake.take(cdr, is_new, sightings)?;
        let is_shown = taken.is_some();
        if is_shown && self.frozen.get_mut(camera).is_some_and(|frozen| frozen.look(sightings, self.settings.frozen)) {
            self.report.reject("the camera is frozen: its pictures are equal to the last bit".to_owned(), sink);
            return Ok(());
        }
        match (taken, gather) {
            (Some((stamp, interval)), None) => {
                if self.settings.pattern != Pattern::Discs {
                    self.coded(at, stamp, interval, source.sequence, sink);
                    return Ok(());
                }
                let discs: Vec<MapDisc> = sightings.iter().map(|sighting| sighting.disc).collect();
                self.step(at, stamp, interval, source.sequence, &discs, sink);
            }
            (Some((stamp, _)), Some(gather)) => {
                for look in gather.take(at.steady, camera, stamp, sightings) {
                    self.look(at, &look, sink);
                }
            }
            (None, None) => {}
            (None, Some(_)) => stream.stale += 1,
        }
        Ok(())
    }

    /// Coded pads that were found in a frame of the only camera.
    fn coded(&mut self, at: Times, stamp: Time, interval: f64, number: u64, sink: &mut dyn Sink) {
        let Some(intake) = self.intakes.first() else { return };
        let (pads, twice) = pads::named(intake.coded(), &self.settings.pad_ids);
        if let Some(id) = twice {
            self.report.reject(format!("two pads have the code {id}: neither is taken"), sink);
        }
        self.tracker.step_pads(interval, &pads);
        self.told(at, stamp, number, pads.len(), sink);
    }

    /// A look of several cameras; its frames are counted by exposure.
    fn look(&mut self, at: Times, look: &Look, sink: &mut dyn Sink) {
        let source = Source { sequence: look.number, ..Source::default() };
        if let Some(interval) = self.stream.take(at.steady, source, RosTime::from(&look.stamp)) {
            self.step(at, look.stamp, interval, look.number, &look.discs, sink);
        }
        if let Some(gather) = &self.gather {
            self.report.cameras(gather.missing);
        }
    }

    /// Pads of another vision system.
    fn pads(&mut self, at: Times, source: Source, cdr: &[u8], sink: &mut dyn Sink) -> Result<(), Dropped> {
        let (stamp, pads) = pads::read(cdr, &self.settings.pad_ids)?;
        at.timely(RosTime::from(&stamp)).map_err(Refusal::from)?;
        if let Some(interval) = self.stream.take(at.steady, source, RosTime::from(&stamp)) {
            self.tracker.step_pads(interval, &pads);
            self.told(at, stamp, source.sequence, pads.len(), sink);
        }
        Ok(())
    }

    fn step(&mut self, at: Times, stamp: Time, interval: f64, number: u64, discs: &[MapDisc], sink: &mut dyn Sink) {
        if let Some((last, age)) = self.memory.recall(stamp) {
            self.tracker.recall(&last, age);
        }
        let pads = self.tracker.step(interval, discs);
        self.told(at, stamp, number, pads, sink);
    }

    /// Sees through other lenses, or from other places, from the next frame on; every robot keeps its name.
    fn calibrate(&mut self, cdr: &[u8]) -> Result<String, String> {
        let request = SetCalibrationRequest::decode(cdr).map_err(|error| error.to_string())?;
        let pad = self.settings.team.pad;
        let mut settings = self.settings.clone();
        settings.cameras = recalibrate::cameras(&self.settings.cameras, &request, pad.height)?;
        if let Some(other) = foreign(&settings.colours_of, &settings.cameras) {
            return Err(format!(
                "the colours in force are those of the camera {}, not of {other}: give its colours together with its lens, or set \
                 colour.camera to nothing",
                settings.colours_of
            ));
        }
        self.intakes = intakes(&settings).ok_or("a camera would not see a pad below it")?;
        let before = &self.settings.cameras;
        self.tracker.remap(|pose| recalibrate::moved(before, &settings.cameras, &pad, pose));
        self.settings = settings;
        Ok("in force from the next frame on; the files are read again at the next start".to_owned())
    }

    /// Publishes what a frame has brought.
    fn told(&mut self, at: Times, stamp: Time, number: u64, pads: usize, sink: &mut dyn Sink) {
        self.publish(stamp, number, sink);
        self.tell_delay(sink);
        self.report.frame(at, self.tracker.tracks(), pads, &self.stream, sink);
        self.memory.keep(at, stamp, self.tracker.tracks(), sink);
        self.show(at, stamp, sink);
    }

    /// Publishes the delay of the loop when turns have told it anew.
    fn tell_delay(&mut self, sink: &mut dyn Sink) {
        let Some((delay, turns)) = self.tracker.delay() else { return };
        if self.delay != Some(delay) {
            self.delay = Some(delay);
            self.report.delay(delay, turns);
            sink.publish(ODOMETRY + self.tracker.tracks().len() + 1, &Float64 { data: delay });
        }
    }

    /// Pictures for viewers.
    fn show(&mut self, at: Times, stamp: Time, sink: &mut dyn Sink) {
        if self.last_picture.is_none_or(|last| at.steady.seconds_since(last) >= PICTURES) {
            self.last_picture = Some(at.steady);
            sink.publish(MARKERS, &markers::robots(stamp, &self.tracker, &self.settings.team.pad));
        }
    }

    fn publish(&self, stamp: Time, frame_number: u64, sink: &mut dyn Sink) {
        let tracks = self.tracker.tracks();
        // The robot's controller acts on it at the tick.
        if let Some(turn) = self.tracker.turn() {
            sink.publish(ODOMETRY + tracks.len(), &messages::identify(stamp, &tracks[turn.robot].name, turn));
        }
        sink.publish(TEAM_STATE, &messages::team_state(stamp, frame_number, tracks, self.tracker.unnamed()));
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
            Event::Message { port, source, cdr, .. } => {
                self.message(at, port, source, cdr, sink);
                if self.report.is_urgent() {
                    self.report.publish(at, self.tracker.tracks(), &self.stream, sink);
                }
            }
            Event::Request { service: SET_CALIBRATION, id, cdr } => {
                let outcome = self.calibrate(cdr);
                let (success, message) = (outcome.is_ok(), outcome.unwrap_or_else(|reason| reason));
                sink.respond(SET_CALIBRATION, id, &SetCalibrationResponse { success, message });
            }
            Event::Request { service, id, cdr } => naming::answer(&mut self.tracker, service, id, cdr, sink),
            Event::Started | Event::Wakeup => {
                if let Some(look) = self.gather.as_mut().and_then(|gather| gather.overdue(at.steady)) {
                    self.look(at, &look, sink);
                }
                if self.next_look.is_none_or(|next| next <= at.steady) {
                    self.report.publish(at, self.tracker.tracks(), &self.stream, sink);
                    self.next_look = Some(at.steady.plus_seconds(PERIOD));
                }
            }
            _ => {}
        }
    }

    fn next_wakeup(&self) -> Option<Steady> {
        let deadline = self.gather.as_ref().and_then(Gather::deadline);
        self.next_look.into_iter().chain(deadline).min()
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        let mut settings = self.settings.clone();
        settings.tune(parameters)?;
        self.intakes = intakes(&settings).ok_or_else(|| blind(parameters))?;
        self.tracker.tune(settings.team.clone());
        self.settings = settings;
        Ok(())
    }
}

/// None if a camera could not see any pad.
fn intakes(settings: &Settings) -> Option<Vec<Intake>> {
    settings.cameras.iter().map(|view| Intake::new(settings, view)).collect()
}

fn blind(parameters: &Parameters) -> ConfigError {
    parameters.error("mount_file", "a camera does not see a pad below it", "measure it again")
}

fn interface(settings: &Settings, tracker: &Tracker) -> Interface {
    let write =
        |topic: String, type_info: &'static TypeInfo, local| Advertise { topic, type_info, qos: Qos::RELIABLE, local };
    // Names, frame, the number of robots and the most pads besides are fixed, and so is the greatest length.
    let max_len =
        messages::team_state(Time::default(), 0, tracker.tracks(), &[[0.0; 2]; TeamState::MOST_UNNAMED as usize])
            .encoded_len();
    // tf2's listeners keep a hundred.
    let tf = Qos { reliability: Reliability::Reliable, durability: Durability::Volatile, depth: 100 };
    let mut publications = vec![
        write("/team_state".to_owned(), TeamState::TYPE, Local::SharedMemory { max_len }),
        Advertise { qos: tf, ..write("/tf".to_owned(), TFMessage::TYPE, Local::NetworkOnly) },
        write("/diagnostics".to_owned(), DiagnosticArray::TYPE, Local::NetworkOnly),
        write("/markers".to_owned(), MarkerArray::TYPE, Local::NetworkOnly),
    ];
    publications.extend(
        tracker.tracks().iter().map(|track| write(format!("/{}/odom", track.name), Odometry::TYPE, Local::SMALL)),
    );
    publications.push(write("/identify".to_owned(), Identify::TYPE, Local::SharedMemory { max_len: 512 }));
    publications
        .push(Advertise { qos: Qos::LATCHED, ..write("/loop_delay".to_owned(), Float64::TYPE, Local::NetworkOnly) });
    let subscriptions = settings.cameras.iter().map(|view| Intake::subscription(settings.input, view)).collect();
    let trigger = |name: &str| Serve { name: name.to_owned(), service: service_info::<Trigger>() };
    let name_robots = Serve { name: "~/name_robots".to_owned(), service: service_info::<NameRobots>() };
    let set_calibration = Serve { name: "~/set_calibration".to_owned(), service: service_info::<SetCalibration>() };
    let services = vec![trigger("~/reset"), trigger("~/identify"), name_robots, set_calibration];
    Interface { subscriptions, publications, services, ..Interface::default() }
}

//! The node core: lets the world go on whenever something is due, and publishes what comes out.

use crate::frames::Picture;
use crate::interface::Ports;
use crate::messages;
use crate::settings::Settings;
use crate::time::ros;
use std::collections::VecDeque;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Condition, Event, Health, Interface, Level, NodeContext, NodeCore, Sink, Steady, Times, resolve_name,
};
use trench_optics::Overhead;
use trench_sim::camera::{Appearance, Renderer};
use trench_sim::{Bed, FaultKind, Frame, Output, Random, Scan};

/// The one byte stream of the test bed.
const STREAM: usize = 0;

/// The test bed.
pub struct Testbed {
    interface: Interface,
    pub(crate) ports: Ports,
    pub(crate) settings: Settings,
    /// The world, from the node's start on.
    bed: Option<Bed>,
    /// Where the numbers come from that its robots draw: another in each process, but in lock-step.
    nonces: u64,
    /// One a camera; none if nothing is rendered.
    pub(crate) renderers: Vec<Renderer>,
    pub(crate) random: Random,
    /// The last frame that came out: what a frozen camera shows.
    pub(crate) last_frame: Option<Frame>,
    /// Those that are to come out.
    pub(crate) pictures: VecDeque<Picture>,
    pub(crate) published: u64,
    pub(crate) dropped: u64,
    /// How many of them were told of.
    dropped_before: u64,
    contacts: u64,
    last_contact: String,
    health: Health,
}

impl Testbed {
    pub(crate) fn new(context: &NodeContext, settings: Settings, interface: Interface, ports: Ports) -> Self {
        // Each camera has noise of its own.
        let seeds = (settings.appearance.seed..).step_by(1 << 32);
        let renderer = |(view, seed): (&Overhead, u64)| {
            Renderer::new(view.camera.clone(), settings.pad, Appearance { seed, ..settings.appearance })
        };
        let rendered = if settings.render { &settings.cameras[..] } else { &[] };
        let renderers = rendered.iter().zip(seeds).map(renderer).collect();
        Self {
            interface,
            ports,
            random: Random::new(settings.bed.seed, 2),
            renderers,
            bed: None,
            nonces: context.seed,
            last_frame: None,
            pictures: VecDeque::new(),
            published: 0,
            dropped: 0,
            dropped_before: 0,
            contacts: 0,
            last_contact: String::new(),
            health: Health::new(resolve_name("~", &context.namespace, &context.name)),
            settings,
        }
    }

    /// The simulated world, once the node has started: for those who judge or interfere.
    #[must_use]
    pub fn bed(&mut self) -> Option<&mut Bed> {
        self.bed.as_mut()
    }

    fn start(&mut self, at: Times, sink: &mut dyn Sink) {
        let mut setup = self.settings.bed.clone();
        setup.start = at.steady.0;
        setup.nonces = self.nonces;
        sink.log(Level::Info, &format!("{} robots, base station at {}", setup.robots.len(), self.settings.link));
        self.bed = Some(Bed::new(setup));
    }

    /// Lets time go on to now and publishes what has come out.
    fn advance(&mut self, at: Times, sink: &mut dyn Sink) {
        let Some(mut bed) = self.bed.take() else { return };
        bed.advance(at.steady.0);
        while let Some(output) = bed.pop_output() {
            match output {
                Output::Serial { bytes, .. } => sink.write_bytes(STREAM, &bytes),
                Output::Frame(frame) => self.frame(at, &bed, frame, sink),
                Output::Scan(scan) => self.scan(at, &bed, scan, sink),
                Output::Contact(contact) => {
                    self.contacts += 1;
                    let message = messages::contact(ros(at, contact.at), &contact, &self.settings.robots);
                    if let Some(status) = message.status.first() {
                        sink.log(Level::Error, &status.message);
                        self.last_contact.clone_from(&status.message);
                    }
                    sink.publish(self.ports.contacts, &message);
                }
            }
        }
        self.show(at, &bed, sink);
        self.tell_faults(at, &bed);
        self.bed = Some(bed);
    }

    fn scan(&self, at: Times, bed: &Bed, scan: Scan, sink: &mut dyn Sink) {
        let blind = |fault: &FaultKind| matches!(fault, FaultKind::Blind { robots } if robots.contains(&scan.robot));
        if bed.faults_at(scan.at).any(blind) {
            return;
        }
        let Settings { robots, bed, .. } = &self.settings;
        let laser = bed.lasers.iter().position(|robot| *robot == scan.robot);
        if let (Some(name), Some(laser)) = (robots.get(scan.robot), laser) {
            let message = messages::scan(ros(at, scan.at), name, &bed.laser, scan.ranges);
            sink.publish(self.ports.scans + laser, &message);
        }
    }

    /// Says what is wrong on purpose.
    fn tell_faults(&mut self, at: Times, bed: &Bed) {
        let names: Vec<&str> = bed.faults_at(at.steady.0).map(FaultKind::name).collect();
        match names.is_empty() {
            true => self.health.set("faults", Condition::Ok, "none"),
            false => self.health.set("faults", Condition::Warn, names.join(", ")),
        }
    }

    pub(crate) fn diagnose(&mut self) {
        match self.dropped - std::mem::replace(&mut self.dropped_before, self.dropped) {
            0 => self.health.set("camera", Condition::Ok, "exposing"),
            late => {
                self.health.set("camera", Condition::Warn, format!("{late} frames were rendered too late and dropped"))
            }
        }
        self.health.value("camera", "published", self.published);
        self.health.value("camera", "too late", self.dropped);
        let condition = if self.contacts == 0 { Condition::Ok } else { Condition::Error };
        let message = if self.contacts == 0 { "no contact".to_owned() } else { format!("last: {}", self.last_contact) };
        self.health.set("bodies", condition, message);
        self.health.value("bodies", "contacts", self.contacts);
        self.health.set("base station", Condition::Ok, "listening");
    }
}

impl NodeCore for Testbed {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.start(at, sink),
            Event::Bytes { stream: STREAM, data } => {
                self.advance(at, sink);
                if let Some(bed) = &mut self.bed {
                    bed.write_serial(at.steady.0, data);
                }
            }
            _ => self.advance(at, sink),
        }
        self.health.publish(at, self.ports.diagnostics, sink);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        self.bed.as_ref().and_then(Bed::next_output).map(Steady).into_iter().chain(self.next_picture()).min()
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        // All parameters are read-only: there is nothing to change.
        Ok(())
    }
}

//! The node core: lets the world go on whenever something is due, and publishes what comes out.

use crate::detections::discs;
use crate::interface::{Ports, image, pixel_bytes};
use crate::messages::{self, CAMERA_FRAME, header};
use crate::settings::Settings;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Condition, Event, Health, Interface, Level, NodeContext, NodeCore, RosTime, Sink, Steady, Times, resolve_name,
};
use trench_msgs::msg::DiscArray;
use trench_msgs::rosgraph_msgs::Clock;
use trench_optics::Pose2;
use trench_sim::camera::{Renderer, Scene};
use trench_sim::{Bed, Frame, Output, Random, Scan};

/// The one byte stream of the test bed.
const STREAM: usize = 0;

/// A frame this late is not published, s: after a pause of the process nobody wants what the camera saw meanwhile.
const LATEST: f64 = 0.1;

/// The test bed.
pub struct Testbed {
    interface: Interface,
    ports: Ports,
    settings: Settings,
    /// The world, from the node's start on.
    bed: Option<Bed>,
    renderer: Option<Renderer>,
    random: Random,
    published: u64,
    dropped: u64,
    contacts: u64,
    last_contact: String,
    health: Health,
}

impl Testbed {
    pub(crate) fn new(context: &NodeContext, settings: Settings, interface: Interface, ports: Ports) -> Self {
        let renderer =
            settings.render.then(|| Renderer::new(settings.camera.clone(), settings.pad, settings.appearance));
        Self {
            interface,
            ports,
            random: Random::new(settings.bed.seed, 2),
            renderer,
            bed: None,
            published: 0,
            dropped: 0,
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
                Output::Frame(frame) => self.frame(at, &frame, sink),
                Output::Scan(scan) => self.scan(at, scan, sink),
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
        self.bed = Some(bed);
    }

    fn scan(&self, at: Times, scan: Scan, sink: &mut dyn Sink) {
        let Settings { robots, bed, .. } = &self.settings;
        let laser = bed.lasers.iter().position(|robot| *robot == scan.robot);
        if let (Some(name), Some(laser)) = (robots.get(scan.robot), laser) {
            let message = messages::scan(ros(at, scan.at), name, &bed.laser, scan.ranges);
            sink.publish(self.ports.scans + laser, &message);
        }
    }

    fn frame(&mut self, at: Times, frame: &Frame, sink: &mut dyn Sink) {
        let stamp = ros(at, frame.exposed_at);
        for (robot, (name, truth)) in self.settings.robots.iter().zip(&frame.truth).enumerate() {
            sink.publish(self.ports.truth + robot, &messages::odometry(stamp, name, truth));
        }
        if at.steady.seconds_since(Steady(frame.ready_at)) > LATEST {
            self.dropped += 1;
            return;
        }
        self.published += 1;
        match &self.renderer {
            Some(renderer) => self.render(renderer, stamp, frame, sink),
            None => self.detect(stamp, frame, sink),
        }
        sink.publish(self.ports.camera_info, &messages::camera_info(stamp, self.settings.camera.lens()));
        if let Some(port) = self.ports.obstacles {
            sink.publish(port, &messages::obstacles(stamp, &frame.obstacles));
        }
        if let Some(port) = self.ports.clock {
            sink.publish(port, &Clock { clock: at.ros.into() });
        }
        self.diagnose();
    }

    /// Paints the frame into the transport's own memory.
    fn render(&self, renderer: &Renderer, stamp: RosTime, frame: &Frame, sink: &mut dyn Sink) {
        let lens = self.settings.camera.lens();
        let (view, pixels) = (image(lens, stamp), pixel_bytes(lens));
        let obstacles: Vec<_> = frame.obstacles.iter().map(|obstacle| obstacle.outline().clone()).collect();
        let scene = Scene { robots: &frame.exposure, obstacles: &obstacles };
        sink.publish_with(self.ports.frames, view.encoded_len_with(pixels), &mut |out| {
            let Some(range) = view.encode_around(pixels, out) else { return 0 };
            let end = range.end;
            match renderer.render(scene, frame.number, &mut out[range]) {
                Ok(()) => end,
                Err(_) => 0,
            }
        });
    }

    fn detect(&mut self, stamp: RosTime, frame: &Frame, sink: &mut dyn Sink) {
        let Settings { camera, pad, detection_noise, .. } = &self.settings;
        let poses: Vec<Pose2> = frame.truth.iter().map(|truth| truth.pose).collect();
        let discs = discs(camera, pad, &poses, *detection_noise, &mut self.random);
        sink.publish(self.ports.frames, &DiscArray { header: header(stamp, CAMERA_FRAME), discs });
    }

    fn diagnose(&mut self) {
        let condition = if self.dropped == 0 { Condition::Ok } else { Condition::Warn };
        self.health.set("camera", condition, "exposing");
        self.health.value("camera", "published", self.published);
        self.health.value("camera", "too late", self.dropped);
        let condition = if self.contacts == 0 { Condition::Ok } else { Condition::Error };
        let message = if self.contacts == 0 { "no contact".to_owned() } else { format!("last: {}", self.last_contact) };
        self.health.set("bodies", condition, message);
        self.health.value("bodies", "contacts", self.contacts);
        self.health.set("base station", Condition::Ok, "listening");
    }
}

/// The ROS time of an instant of the monotonic clock.
fn ros(at: Times, instant: u64) -> RosTime {
    let ago = at.steady.0 as i64 - instant as i64;
    RosTime(at.ros.0 - ago)
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
        self.bed.as_ref().and_then(Bed::next_output).map(Steady)
    }

    fn set_parameters(&mut self, _: &Parameters) -> Result<(), ConfigError> {
        // All parameters are read-only: there is nothing to change.
        Ok(())
    }
}

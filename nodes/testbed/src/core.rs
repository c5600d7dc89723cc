//! The node core: lets the world go on whenever something is due, and publishes what comes out.

use crate::detections::discs;
use crate::interface::{Ports, image, pixel_bytes};
use crate::messages::{self, header};
use crate::settings::Settings;
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Condition, Event, Health, Interface, Level, NodeContext, NodeCore, RosTime, Sink, Steady, Times, resolve_name,
};
use trench_msgs::msg::DiscArray;
use trench_msgs::rosgraph_msgs::Clock;
use trench_optics::{Overhead, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};
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
    /// One a camera; none if nothing is rendered.
    renderers: Vec<Renderer>,
    random: Random,
    published: u64,
    dropped: u64,
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
        for camera in 0..self.settings.cameras.len() {
            match self.renderers.get(camera) {
                Some(renderer) => self.render(camera, renderer, stamp, frame, sink),
                None => self.detect(camera, stamp, frame, sink),
            }
            let view = &self.settings.cameras[camera];
            let info = messages::camera_info(stamp, &view.frame_id(), view.camera.lens());
            sink.publish(self.ports.cameras[camera].info, &info);
        }
        if let Some(port) = self.ports.obstacles {
            sink.publish(port, &messages::obstacles(stamp, &frame.obstacles));
        }
        if let Some(port) = self.ports.clock {
            sink.publish(port, &Clock { clock: at.ros.into() });
        }
        self.diagnose();
    }

    /// Paints the frame into the transport's own memory.
    fn render(&self, camera: usize, renderer: &Renderer, stamp: RosTime, frame: &Frame, sink: &mut dyn Sink) {
        let (lens, frame_id) = (renderer.camera().lens(), self.settings.cameras[camera].frame_id());
        let (view, pixels) = (image(lens, &frame_id, stamp), pixel_bytes(lens));
        let obstacles: Vec<_> = frame.obstacles.iter().map(|obstacle| obstacle.outline().clone()).collect();
        let scene = Scene { robots: &frame.exposure, obstacles: &obstacles };
        sink.publish_with(self.ports.cameras[camera].frames, view.encoded_len_with(pixels), &mut |out| {
            let Some(range) = view.encode_around(pixels, out) else { return 0 };
            let end = range.end;
            match renderer.render(scene, frame.number, &mut out[range]) {
                Ok(()) => end,
                Err(_) => 0,
            }
        });
    }

    fn detect(&mut self, camera: usize, stamp: RosTime, frame: &Frame, sink: &mut dyn Sink) {
        let Settings { cameras, pad, detection_noise, .. } = &self.settings;
        let view = &cameras[camera];
        let poses: Vec<Pose2> = frame.truth.iter().map(|truth| truth.pose).collect();
        let discs = discs(&view.camera, pad, &poses, *detection_noise, &mut self.random);
        let header = header(stamp, &view.frame_id());
        sink.publish(self.ports.cameras[camera].frames, &DiscArray { header, discs });
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

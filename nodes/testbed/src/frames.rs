//! Frames of the camera on their way out, with what is wrong with them.

use crate::core::Testbed;
use crate::detections::discs;
use crate::interface::{image, pixel_bytes};
use crate::messages::{self, header};
use crate::time::ros;
use trench_core::{RosTime, Sink, Steady, Times};
use trench_msgs::msg::DiscArray;
use trench_msgs::rosgraph_msgs::Clock;
use trench_optics::Pose2;
use trench_sim::camera::{Renderer, Scene};
use trench_sim::{Bed, FaultKind, Frame, FrameFault};

/// A frame this late is not published, s: after a pause of the process nobody wants what the camera saw meanwhile.
const LATEST: f64 = 0.1;

/// A frame as it comes out.
#[derive(Debug, Clone)]
pub(crate) struct Picture {
    frame: Frame,
    /// The share of the rows, from the top, that is not black.
    bright: f64,
    /// Robots whose pads are covered.
    covered: Vec<usize>,
}

/// What the camera does to frames, as the faults of their exposures have it; nothing where none comes out.
pub(crate) fn picture(bed: &Bed, mut frame: Frame, last: Option<&Frame>) -> Option<Picture> {
    let (mut bright, mut covered) = (1.0, Vec::new());
    for fault in bed.faults_at(frame.exposed_at) {
        match fault {
            FaultKind::Covered { robots } => covered.extend(robots),
            FaultKind::Frames(FrameFault::Stopped) => return None,
            FaultKind::Frames(FrameFault::Every(each)) if !frame.number.is_multiple_of(*each) => return None,
            FaultKind::Frames(FrameFault::Frozen) => {
                let Frame { exposed_at, ready_at, .. } = frame;
                frame = Frame { exposed_at, ready_at, ..last.cloned().unwrap_or(frame) };
            }
            FaultKind::Frames(FrameFault::Black) => bright = 0.0,
            FaultKind::Frames(FrameFault::Half) => bright = 0.5,
            FaultKind::Frames(FrameFault::Late(delay)) => frame.ready_at += delay,
            _ => {}
        }
    }
    Some(Picture { frame, bright, covered })
}

impl Testbed {
    /// A frame has been exposed and read: the truth of it goes out at once.
    pub(crate) fn frame(&mut self, at: Times, bed: &Bed, frame: Frame, sink: &mut dyn Sink) {
        let stamp = ros(at, frame.exposed_at);
        for (robot, (name, truth)) in self.settings.robots.iter().zip(&frame.truth).enumerate() {
            sink.publish(self.ports.truth + robot, &messages::odometry(stamp, name, truth));
        }
        if let Some(picture) = picture(bed, frame, self.last_frame.as_ref()) {
            self.last_frame = Some(picture.frame.clone());
            self.pictures.push_back(picture);
        }
        self.show(at, bed, sink);
    }

    /// When the next picture comes out.
    pub(crate) fn next_picture(&self) -> Option<Steady> {
        self.pictures.front().map(|picture| Steady(picture.frame.ready_at))
    }

    /// Publishes the pictures whose time has come.
    pub(crate) fn show(&mut self, at: Times, bed: &Bed, sink: &mut dyn Sink) {
        while self.next_picture().is_some_and(|ready| ready <= at.steady) {
            let Some(picture) = self.pictures.pop_front() else { return };
            if at.steady.seconds_since(Steady(picture.frame.ready_at)) > LATEST {
                self.dropped += 1;
            } else {
                self.publish(at, bed, &picture, sink);
            }
        }
    }

    fn publish(&mut self, at: Times, bed: &Bed, picture: &Picture, sink: &mut dyn Sink) {
        let frame = &picture.frame;
        let stamp = ros(at, frame.exposed_at);
        self.published += 1;
        for camera in 0..self.settings.cameras.len() {
            match self.renderers.get(camera) {
                Some(renderer) => self.render(camera, renderer, stamp, picture, sink),
                None => self.detect(camera, stamp, picture, sink),
            }
            let view = &self.settings.cameras[camera];
            let info = messages::camera_info(stamp, &view.frame_id(), view.camera.lens());
            sink.publish(self.ports.cameras[camera].info, &info);
        }
        let untold = bed.faults_at(at.steady.0).any(|fault| *fault == FaultKind::Untold);
        if let Some(port) = self.ports.obstacles.filter(|_| !untold) {
            sink.publish(port, &messages::obstacles(stamp, &frame.obstacles));
        }
        if let Some(port) = self.ports.clock {
            sink.publish(port, &Clock { clock: at.ros.into() });
        }
        self.diagnose();
    }

    /// Paints the frame into the transport's own memory.
    fn render(&self, camera: usize, renderer: &Renderer, stamp: RosTime, picture: &Picture, sink: &mut dyn Sink) {
        let (lens, frame_id) = (renderer.camera().lens(), self.settings.cameras[camera].frame_id());
        let (view, pixels) = (image(lens, &frame_id, stamp), pixel_bytes(lens));
        let frame = &picture.frame;
        let obstacles: Vec<_> = frame.obstacles.iter().map(|obstacle| obstacle.outline().clone()).collect();
        let robots: Vec<Vec<Pose2>> = picture.uncovered(&frame.exposure).cloned().collect();
        let scene = Scene { robots: &robots, obstacles: &obstacles };
        let bright = picture.bright_rows(lens.height) * 3 * lens.width as usize;
        sink.publish_with(self.ports.cameras[camera].frames, view.encoded_len_with(pixels), &mut |out| {
            let Some(range) = view.encode_around(pixels, out) else { return 0 };
            let end = range.end;
            let image = &mut out[range];
            match renderer.render(scene, frame.number, image) {
                Ok(()) => {
                    image[bright..].fill(0);
                    end
                }
                Err(_) => 0,
            }
        });
    }

    fn detect(&mut self, camera: usize, stamp: RosTime, picture: &Picture, sink: &mut dyn Sink) {
        let crate::settings::Settings { cameras, pad, detection_noise, .. } = &self.settings;
        let view = &cameras[camera];
        let poses: Vec<Pose2> = picture.uncovered(&picture.frame.truth).map(|truth| truth.pose).collect();
        let mut discs = discs(&view.camera, pad, &poses, *detection_noise, &mut self.random);
        let bright = picture.bright_rows(view.camera.lens().height) as f64;
        discs.retain(|disc| disc.v < bright);
        let header = header(stamp, &view.frame_id());
        sink.publish(self.ports.cameras[camera].frames, &DiscArray { header, discs });
    }
}

impl Picture {
    fn uncovered<'a, T>(&'a self, robots: &'a [T]) -> impl Iterator<Item = &'a T> {
        robots.iter().enumerate().filter(|(robot, _)| !self.covered.contains(robot)).map(|(_, robot)| robot)
    }

    fn bright_rows(&self, height: u32) -> usize {
        (self.bright * f64::from(height)) as usize
    }
}

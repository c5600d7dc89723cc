//! A folder of rendered frames through camera and localizer: the robots are where they were drawn.

use crate::common::{Shipped, build, lines, run};
use image::RgbImage;
use trench_config::params::{Source as Given, resolve};
use trench_core::{Event, Files, NodeContext, Outbox, Source, Times};
use trench_msgs::Encode;
use trench_msgs::msg::{RobotState, TeamState};
use trench_optics::{Camera, CameraInfo, Mount, Pad, Pose2};
use trench_sim::camera::{Appearance, Renderer, Scene};

const ROBOTS: [Pose2; 2] = [Pose2 { x: 0.5, y: 0.5, theta: 0.8 }, Pose2 { x: 1.5, y: 1.2, theta: -2.0 }];

#[test]
fn robots_in_an_image_folder_are_found() {
    let read = |name: &str| Shipped.read("", name).unwrap();
    let lens = CameraInfo::parse("", &read("overhead.yaml")).unwrap().lens;
    let camera = Camera::new(lens, Mount::parse("", &read("overhead_mount.yaml")).unwrap()).unwrap();
    let renderer = Renderer::new(camera, Pad::NOMINAL, Appearance::default());
    let folder = tempfile::tempdir().unwrap();
    for frame in 0..3 {
        let mut pixels = vec![0; renderer.frame_len()];
        let sweeps = ROBOTS.map(|pose| vec![pose]);
        renderer.render(Scene { robots: &sweeps, obstacles: &[] }, frame, &mut pixels).unwrap();
        let image = RgbImage::from_raw(768, 576, pixels).unwrap();
        image.save(folder.path().join(format!("{frame}.png"))).unwrap();
    }
    let mut camera = build(&lines("folder", folder.path(), "camera_info_file: overhead.yaml")).unwrap();
    let frames = run(camera.as_mut(), 10.0);
    assert_eq!(frames.images.len(), 3);

    let description = overhead_localizer::description();
    let text = "overhead_localizer:
  ros__parameters:
    robots: [robot1, robot2]
    initial_poses: [0.5, 0.5, 0.8, 1.5, 1.2, -2.0]
    camera_info_file: overhead.yaml
    mount_file: overhead_mount.yaml
";
    let sources = [Given::File { name: "localizer.yaml", text }];
    let parameters = resolve(&sources, "/", description.name, &(description.parameters)()).unwrap();
    let mut localizer = (description.build)(&NodeContext::default(), &parameters, &Shipped).unwrap();
    for (sequence, (_, image)) in (1..).zip(&frames.images) {
        let mut outbox = Outbox::default();
        let event =
            Event::Message { port: 0, source: Source { gid: [1; 16], sequence }, cdr: &image.to_cdr(), arrived: None };
        localizer.handle(Times::default(), event, &mut outbox);
        let state: TeamState = outbox.last(0).unwrap();
        for (robot, pose) in state.robots.iter().zip(ROBOTS) {
            assert_eq!(robot.status, RobotState::STATUS_TRACKED);
            assert!((robot.x - pose.x).hypot(robot.y - pose.y) < 3e-4, "{robot:?}");
        }
    }
}

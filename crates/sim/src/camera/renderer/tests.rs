use super::super::Background;
use super::*;
use nalgebra::Point3;
use trench_optics::{Lens, Mount, Pixel, PlumbBob};

fn camera() -> Camera {
    let distortion = PlumbBob { k1: -0.12, k2: 0.03, p1: 5e-4, p2: -4e-4, k3: 0.0 };
    let mount = Mount { roll: 0.01, pitch: -0.008, ..Mount::nominal() };
    Camera::new(Lens { distortion, ..Lens::nominal() }, mount).unwrap()
}

/// Floor and bodies without colour: only discs have an excess of one channel over another.
fn appearance() -> Appearance {
    let background = Background::Plain([150; 3]);
    Appearance { background, body: [40; 3], gradient: 0.0, noise: 0.0, ..Appearance::default() }
}

/// The centre of area of the yellow disc: yellow's excess over blue is linear in the covered fraction.
fn yellow_centroid(image: &[u8], near: Pixel) -> Pixel {
    let (mut sum, mut sum_u, mut sum_v) = (0.0, 0.0, 0.0);
    for v in near.v as usize - 14..near.v as usize + 15 {
        for u in near.u as usize - 14..near.u as usize + 15 {
            let at = 3 * (v * 768 + u);
            let excess = f64::from(image[at]) + f64::from(image[at + 1]) - 2.0 * f64::from(image[at + 2]);
            let weight = excess.max(0.0);
            sum += weight;
            sum_u += weight * u as f64;
            sum_v += weight * v as f64;
        }
    }
    Pixel { u: sum_u / sum, v: sum_v / sum }
}

#[test]
fn discs_are_where_the_camera_says() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, appearance());
    let mut image = vec![0; renderer.frame_len()];
    let (mut sum2, mut worst, mut count) = (0.0_f64, 0.0_f64, 0.0_f64);
    for index in 0..150_i32 {
        // An irrational stride over field and headings, so that every sub-pixel position occurs.
        let step = f64::from(index);
        let pose = Pose2 {
            x: 0.2 + (step * 0.618_034).fract() * 2.0,
            y: 0.2 + (step * 0.414_214).fract() * 1.4,
            theta: step * 2.399_963,
        };
        renderer.render(Scene { robots: &[vec![pose]], obstacles: &[] }, 0, &mut image).unwrap();
        let [yellow, _] = Pad::NOMINAL.discs(pose);
        let expected = renderer.camera().project(Point3::new(yellow.x, yellow.y, Pad::NOMINAL.height)).unwrap();
        let found = yellow_centroid(&image, expected);
        let error = (found.u - expected.u).hypot(found.v - expected.v);
        (sum2, worst, count) = (sum2 + error * error, worst.max(error), count + 1.0);
    }
    let rms = (sum2 / count).sqrt();
    assert!(rms < 0.01 && worst < 0.02, "rms {rms} px, worst {worst} px");
}

#[test]
fn blur_is_centred_on_the_middle_of_the_exposure() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, appearance());
    let mut image = vec![0; renderer.frame_len()];
    let sweep: Vec<Pose2> = (0..5).map(|k| Pose2 { x: 1.0 + 0.0015 * f64::from(k), y: 0.9, theta: 0.0 }).collect();
    renderer.render(Scene { robots: &[sweep], obstacles: &[] }, 0, &mut image).unwrap();
    let [yellow, _] = Pad::NOMINAL.discs(Pose2 { x: 1.003, y: 0.9, theta: 0.0 });
    let expected = renderer.camera().project(Point3::new(yellow.x, yellow.y, Pad::NOMINAL.height)).unwrap();
    let found = yellow_centroid(&image, expected);
    assert!((found.u - expected.u).hypot(found.v - expected.v) < 0.02, "{found:?} {expected:?}");
}

#[test]
fn bodies_hide_obstacles_and_obstacles_the_floor() {
    let look = Appearance { background: Background::Plain([200, 200, 200]), ..appearance() };
    let renderer = Renderer::new(Camera::nominal(), Pad::NOMINAL, look);
    let mut image = vec![0; renderer.frame_len()];
    let wall = Obstacle { corners: vec![[1.0, 0.5], [1.6, 0.5], [1.6, 1.2], [1.0, 1.2]], radius: 0.0 };
    let robot = vec![Pose2 { x: 1.24, y: 0.915, theta: 0.0 }];
    renderer.render(Scene { robots: &[robot], obstacles: &[wall] }, 0, &mut image).unwrap();
    let check = |x: f64, y: f64, expected: [u8; 3]| {
        let pixel = Camera::nominal().project(Point3::new(x, y, 0.0)).unwrap();
        let at = 3 * (pixel.v.round() as usize * 768 + pixel.u.round() as usize);
        assert_eq!(image[at..at + 3], expected, "at ({x}, {y})");
    };
    check(0.5, 0.5, [200, 200, 200]);
    check(1.05, 0.6, look.obstacle);
    check(1.24, 0.915, look.body);
    check(1.2785, 0.915, look.yellow);
    check(1.2015, 0.915, look.blue);
}

#[test]
fn the_same_frame_is_the_same_bytes_and_robots_outside_are_no_trouble() {
    let look = Appearance { background: Background::Wood, seed: 5, ..Appearance::default() };
    let renderer = Renderer::new(camera(), Pad::NOMINAL, look);
    let far = [(-3.0, 1.0), (2.47, 0.01), (1e9, f64::NAN), (0.0, 1.83)];
    let robots: Vec<Vec<Pose2>> = far.iter().map(|(x, y)| vec![Pose2 { x: *x, y: *y, theta: 1.0 }]).collect();
    let frame = |number| {
        let mut image = vec![0; renderer.frame_len()];
        renderer.render(Scene { robots: &robots, obstacles: &[Obstacle::default()] }, number, &mut image).unwrap();
        image
    };
    assert!(frame(1) == frame(1));
    assert!(frame(1) != frame(2));
}

#[test]
fn a_buffer_of_the_wrong_size_is_refused() {
    let renderer = Renderer::new(camera(), Pad::NOMINAL, appearance());
    let error = renderer.render(Scene::default(), 0, &mut [0; 9]).unwrap_err();
    assert_eq!(error, RenderError::Size { expected: 1_327_104, actual: 9 });
}

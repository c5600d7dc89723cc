//! What both examples see: the test bed's camera in two sizes, and robots below it.

use trench_optics::{Lens, Pose2};

/// The same view in more pixels; 1920 x 1080 of 2.5 times as many, which cuts it above and below.
pub(crate) fn scaled(lens: Lens, scale: f64) -> Lens {
    let width = (scale * f64::from(lens.width)) as u32;
    let height = if scale > 1.5 { width * 9 / 16 } else { (scale * f64::from(lens.height)) as u32 };
    let middle = |size: u32| 0.5 * f64::from(size) - 0.5;
    let off = [lens.cx - middle(lens.width), lens.cy - middle(lens.height)].map(|off| scale * off);
    let (cx, cy) = (middle(width) + off[0], middle(height) + off[1]);
    Lens { width, height, fx: scale * lens.fx, fy: scale * lens.fy, cx, cy, ..lens }
}

/// Robots on their way over the part of the field that both cameras see, apart from each other.
pub(crate) fn poses(index: u32, robots: u32) -> Vec<Vec<Pose2>> {
    let columns = if robots > 6 { 5 } else { 3 };
    let rows = robots.div_ceil(columns);
    let cell = [2.16 / f64::from(columns), 1.08 / f64::from(rows)];
    (0..robots)
        .map(|robot| {
            let step = f64::from(index) + 0.37 * f64::from(robot);
            let within = |cell: f64, part: f64| 0.09 + (cell - 0.18).max(0.0) * part.fract();
            let x = 0.16 + cell[0] * f64::from(robot % columns) + within(cell[0], 0.618_034 * step);
            let y = 0.375 + cell[1] * f64::from(robot / columns) + within(cell[1], 0.414_214 * step);
            vec![Pose2 { x, y, theta: 2.399_963 * step }]
        })
        .collect()
}

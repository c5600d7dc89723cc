//! The figures that a scenario file asks for, from its run.

mod chapter4;
mod clip;
mod diagram;
mod map;
mod select;

use super::style::{Area, LEGEND, Picture, REFERENCE, UNIT, centred, font, line, picture, text};
use diagram::Diagram;
use map::Field;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use select::{Selection, Shown, select};
use std::f64::consts::{PI, TAU};
use trench_bag::run::{Pose, Run, distance};
use trench_scenario::{Drawing, Figure, Scenario, Task};

const WIDTH: u32 = 820 * UNIT;
const TITLE: i32 = 34 * UNIT as i32;
const SMALL: u32 = 500 * UNIT;

/// Draws one figure.
pub(super) fn draw(figure: &Figure, scenario: &Scenario, run: &Run) -> Picture {
    let end = run.span().map_or(0.0, |(_, last)| last);
    let selection = select(figure, scenario, run);
    match figure.drawing {
        Drawing::Trajectories => {
            let until = figure.at.last().copied().unwrap_or(end);
            let field = Field::of(figure.window, scenario, &selection, until);
            framed(figure, (&selection.legend, field_notes(scenario, false)), field.height(WIDTH), |area| {
                field.draw(area, scenario, &selection, (until, false))
            })
        }
        Drawing::Snapshots => snapshots(figure, scenario, &selection, end),
        Drawing::Speeds => super::speeds::draw(run, (0.0, end)),
        Drawing::Errors => over_time(figure, &selection, "distance (m)", &[], goal_distance),
        Drawing::Misalignments => over_time(figure, &selection, "phi (rad)", &[], misalignment),
        Drawing::Lyapunov => over_time(figure, &selection, "V", &[], |robot| robot.track.lyapunov.clone()),
        Drawing::Curvatures => over_time(figure, &selection, "curvature (1/m)", &[], curvature),
        Drawing::LeaderDistances => {
            let levels = scenario.zoning().map_or(Vec::new(), |zoning| {
                let radii = zoning.radii();
                vec![radii.rho_underbar, radii.rho_hat, radii.rho, radii.rho_check]
            });
            let followers = Selection {
                robots: selection.robots.into_iter().filter(|robot| robot.leader.is_some()).collect(),
                legend: selection.legend.into_iter().filter(|(label, _)| label != "r1").collect(),
            };
            over_time(figure, &followers, "distance to the leader (m); dashed: zone radii", &levels, leader_distance)
        }
        Drawing::SineIntegrals => chapter4::sine_integrals(figure),
        Drawing::CurvatureTrends(law) => chapter4::curvature_trends(figure, law),
        Drawing::Solutions { critical } => chapter4::solutions(figure, critical),
        Drawing::StableWedge { most } => chapter4::wedge(figure, most),
    }
}

/// A picture with title and legend above what `draw` draws.
fn framed(
    figure: &Figure,
    (legend, notes): (&[(String, RGBColor)], &str),
    height: u32,
    draw: impl FnOnce(&Area<'_>) -> Result<(), String>,
) -> Picture {
    const SCALE: i32 = UNIT as i32;
    let rows = rows(legend);
    let noted = i32::from(!notes.is_empty());
    let top = TITLE + LEGEND * (rows.len() as i32 + noted);
    picture((WIDTH, height + top as u32), |area| {
        let (head, body) = area.split_vertically(top);
        let title = format!("Figure {}: {}", figure.number, figure.title);
        head.draw(&Text::new(title, (WIDTH as i32 / 2, TITLE / 2), centred(15))).map_err(text)?;
        for (row, entries) in rows.iter().enumerate() {
            let middle = TITLE + LEGEND * row as i32 + LEGEND / 2;
            let style = font(13).pos(Pos::new(HPos::Left, VPos::Center));
            let mut left = 24 * SCALE;
            for (label, colour) in *entries {
                let sample = PathElement::new([(left, middle), (left + 22 * SCALE, middle)], line(colour, 3));
                head.draw(&sample).map_err(text)?;
                head.draw(&Text::new(label.clone(), (left + 28 * SCALE, middle), style.clone())).map_err(text)?;
                left += room(label);
            }
        }
        let style = font(12).color(&REFERENCE).pos(Pos::new(HPos::Left, VPos::Center));
        head.draw(&Text::new(notes.to_owned(), (24 * SCALE, top - LEGEND / 2), style)).map_err(text)?;
        draw(&body)
    })
}

/// What signs on maps mean: those alone that this scenario has.
fn field_notes(scenario: &Scenario, bodies: bool) -> &'static str {
    match (&scenario.task, bodies) {
        (Task::Regulating(_), _) => "● start,  ■ end,  × goal",
        (Task::GoalTracking(_), true) => "● robot with its heading,  ○ its goal point",
        (Task::GoalTracking(_), false) => "● start,  ■ end;  grey: path of the goal point",
        (Task::Nearest(chain, _), true) if !chain.obstacles.is_empty() => {
            "● robot,  - - - segment,  × goal of r1;  brown: obstacles, dashed where repulsion begins and around combined hulls"
        }
        (Task::Nearest(chain, _), false) if !chain.obstacles.is_empty() => {
            "● start,  ■ end,  - - - segment,  × goal;  brown: obstacles, dashed where repulsion begins and around combined hulls"
        }
        (_, true) => "● robot with its heading,  - - - segment,  × goal of r1",
        (_, false) => "● start,  ■ end,  - - - segment,  × goal of r1",
    }
}

/// What one entry of a legend takes, units.
fn room(label: &str) -> i32 {
    (28 + 8 * label.chars().count() as i32 + 20) * UNIT as i32
}

/// Entries that fit beside each other; none where there is nothing to tell apart.
fn rows(legend: &[(String, RGBColor)]) -> Vec<&[(String, RGBColor)]> {
    let widest = legend.iter().map(|(label, _)| room(label)).max().unwrap_or(1);
    let fitting = ((WIDTH as i32 - 24 * UNIT as i32) / widest).max(1) as usize;
    if legend.len() < 2 { Vec::new() } else { legend.chunks(fitting).collect() }
}

fn snapshots(figure: &Figure, scenario: &Scenario, selection: &Selection<'_>, end: f64) -> Picture {
    let times = if figure.at.is_empty() { vec![end] } else { figure.at.clone() };
    let last = times.iter().copied().fold(0.0, f64::max);
    let field = Field::of(figure.window, scenario, selection, last);
    let columns = if times.len() > 1 { 2 } else { 1 };
    let rows = times.len().div_ceil(columns);
    let cell = field.height(WIDTH / columns as u32) + TITLE as u32;
    framed(figure, (&selection.legend, field_notes(scenario, true)), cell * rows as u32, |area| {
        for (cell, &time) in area.split_evenly((rows, columns)).iter().zip(&times) {
            let (title, map) = cell.split_vertically(TITLE);
            let middle = (WIDTH / columns as u32) as i32 / 2;
            let name = format!("t = {} s", super::axes::short(time));
            title.draw(&Text::new(name, (middle, TITLE / 2), centred(14))).map_err(text)?;
            field.draw(&map, scenario, selection, (time, true))?;
        }
        Ok(())
    })
}

fn over_time(
    figure: &Figure,
    selection: &Selection<'_>,
    quantity: &str,
    levels: &[f64],
    values: impl Fn(&Shown<'_>) -> Vec<(f64, f64)>,
) -> Picture {
    let curves: Vec<_> = selection.robots.iter().map(|robot| (robot.colour, values(robot))).collect();
    framed(figure, (&selection.legend, ""), SMALL, |area| {
        Diagram { names: ["t (s)", quantity], window: figure.window, levels, filled: &[] }.draw(area, &curves)
    })
}

fn goal_distance(robot: &Shown<'_>) -> Vec<(f64, f64)> {
    let of = |pose: &Pose| Some((pose.time, distance(pose.position(), robot.track.goal_at(pose.time)?)));
    robot.track.poses.iter().filter_map(of).collect()
}

fn leader_distance(robot: &Shown<'_>) -> Vec<(f64, f64)> {
    let of = |pose: &Pose| Some((pose.time, distance(pose.position(), robot.leader?.pose_at(pose.time)?.position())));
    robot.track.poses.iter().filter_map(of).collect()
}

/// phi, in (-pi, pi].
fn misalignment(robot: &Shown<'_>) -> Vec<(f64, f64)> {
    let of = |pose: &Pose| {
        let [x, y] = robot.track.goal_at(pose.time)?;
        let phi = pose.theta - (y - pose.y).atan2(x - pose.x);
        Some((pose.time, PI - (PI - phi).rem_euclid(TAU)))
    };
    robot.track.poses.iter().filter_map(of).collect()
}

fn curvature(robot: &Shown<'_>) -> Vec<(f64, f64)> {
    let moving = robot.track.poses.iter().filter(|pose| pose.v != 0.0);
    moving.map(|pose| (pose.time, (pose.omega / pose.v).abs())).collect()
}

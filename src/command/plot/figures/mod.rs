//! The figures that a scenario file asks for, from its run.

mod arrow;
mod chapter4;
mod diagram;
mod map;
mod obstacles;
mod select;
mod wedge;

use super::extensions;
use super::style::{Area, LEGEND, Picture, REFERENCE, UNIT, centred, font, line, picture, text, titled};
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
/// A line of notes.
const NOTE: i32 = 24 * UNIT as i32;
const SMALL: u32 = 500 * UNIT;

/// Draws one figure.
pub(super) fn draw(figure: &Figure, scenario: &Scenario, run: &Run) -> Picture {
    let end = run.span().map_or(0.0, |(_, last)| last);
    let selection = select(figure, scenario, run);
    match figure.drawing {
        Drawing::Trajectories => {
            let until = figure.at.last().copied().unwrap_or(end);
            let field = Field::of(figure.window, scenario, &selection, until);
            framed(figure, (&selection.legend, &field_notes(scenario, None)), field.height(WIDTH), |area| {
                field.draw(area, scenario, &selection, (until, None))
            })
        }
        Drawing::Snapshots => snapshots(figure, scenario, &selection, end),
        Drawing::Speeds => titled(&title(figure), &super::speeds::draw(run, (0.0, end))?),
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
        Drawing::WedgeInSpace => wedge::draw(figure),
    }
}

/// Number and title, as the thesis numbers it.
pub(super) fn title(figure: &Figure) -> String {
    format!("Figure {}: {}", figure.number, figure.title)
}

/// A picture with title, legend and lines of notes above what `draw` draws.
fn framed(
    figure: &Figure,
    (legend, notes): (&[(String, RGBColor)], &str),
    height: u32,
    draw: impl FnOnce(&Area<'_>) -> Result<(), String>,
) -> Picture {
    const SCALE: i32 = UNIT as i32;
    let rows = rows(legend);
    let above = TITLE + LEGEND * rows.len() as i32;
    let top = above + NOTE * notes.lines().count() as i32;
    picture((WIDTH, height + top as u32), |area| {
        let (head, body) = area.split_vertically(top);
        head.draw(&Text::new(title(figure), (WIDTH as i32 / 2, TITLE / 2), centred(15))).map_err(text)?;
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
        for (row, note) in notes.lines().enumerate() {
            let middle = above + NOTE * row as i32 + NOTE / 2;
            head.draw(&Text::new(note.to_owned(), (24 * SCALE, middle), style.clone())).map_err(text)?;
        }
        draw(&body)
    })
}

/// What signs on maps mean: those alone that this scenario has. Robots have arrows as long as their way of so many seconds, or none.
fn field_notes(scenario: &Scenario, arrows: Option<f64>) -> String {
    let robot =
        arrows.map(|seconds| format!("● robot,  → its velocity: the way of {} s", super::ticks::short(seconds)));
    let signs = match (&scenario.task, robot) {
        (Task::Regulating(_), _) => "● start,  ■ end,  × goal".to_owned(),
        (Task::GoalTracking(_), Some(robot)) => format!("{robot},  ○ its goal point"),
        (Task::GoalTracking(_), None) => "● start,  ■ end;  grey: path of the goal point".to_owned(),
        (Task::Queue(_), robot) => {
            format!("{},  - - - segment,  × target of the queue", robot.unwrap_or("● start,  ■ end".to_owned()))
        }
        (_, robot) => format!("{},  - - - segment,  × goal of r1", robot.unwrap_or("● start,  ■ end".to_owned())),
    };
    let open = extensions::note(map::curve(scenario).into_iter());
    [signs.replacen("- - - segment", &format!("- - - segment{open}"), 1), obstacles::notes(scenario)].join("\n")
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
    let arrows = Some(arrow::seconds(selection, &times, field.width()));
    framed(figure, (&selection.legend, &field_notes(scenario, arrows)), cell * rows as u32, |area| {
        for (cell, &time) in area.split_evenly((rows, columns)).iter().zip(&times) {
            let (title, map) = cell.split_vertically(TITLE);
            let middle = (WIDTH / columns as u32) as i32 / 2;
            let name = format!("t = {} s", super::ticks::short(time));
            title.draw(&Text::new(name, (middle, TITLE / 2), centred(14))).map_err(text)?;
            field.draw(&map, scenario, selection, (time, arrows))?;
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

//! Which robots a figure shows, and in which colours.

use super::super::style::COLOURS;
use plotters::prelude::*;
use plotters::style::RGBColor;
use trench_bag::run::{Run, Track};
use trench_scenario::{Figure, Scenario, Seat};

/// A robot of a figure.
pub(super) struct Shown<'a> {
    pub(super) track: &'a Track,
    /// Beside the robot, where colours alone hardly tell so many apart.
    pub(super) name: Option<String>,
    pub(super) colour: RGBColor,
    /// The robot it follows in its chain.
    pub(super) leader: Option<&'a Track>,
}

/// Robots and legend entries.
pub(super) struct Selection<'a> {
    pub(super) robots: Vec<Shown<'a>>,
    pub(super) legend: Vec<(String, RGBColor)>,
}

/// Colours tell cases apart where a figure shows several, else robots.
pub(super) fn select<'a>(figure: &Figure, scenario: &Scenario, run: &'a Run) -> Selection<'a> {
    let cases = scenario.cases();
    let seats = scenario.seats();
    let wanted_case = |case: usize| {
        let name = cases.get(case).map(|(name, _)| *name);
        figure.cases.is_empty() || figure.cases.iter().any(|wanted| Some(wanted.as_str()) == name)
    };
    let wanted = |seat: &&Seat| {
        wanted_case(seat.case) && (figure.robots.is_empty() || figure.robots.contains(&format!("r{}", seat.rank)))
    };
    let chosen: Vec<&Seat> = seats.iter().filter(wanted).collect();
    let by_case = (0..cases.len()).filter(|&case| wanted_case(case)).count() > 1;
    let mut legend: Vec<(String, RGBColor)> = Vec::new();
    let mut robots = Vec::new();
    for (index, seat) in chosen.iter().enumerate() {
        let Some(track) = run.robots.get(&seat.name) else { continue };
        let (place, count) = if by_case { (seat.case, cases.len()) } else { (index, chosen.len()) };
        let colour = colour(place, count);
        let label = match cases.get(seat.case) {
            Some((_, label)) if by_case => (*label).to_owned(),
            _ => format!("r{}", seat.rank),
        };
        if !legend.iter().any(|(known, _)| *known == label) {
            legend.push((label, colour));
        }
        let leader = seat.leader.and_then(|leader| run.robots.get(&seats.get(leader)?.name));
        let name = (!by_case && count > COLOURS.len()).then(|| format!("r{}", seat.rank));
        robots.push(Shown { track, name, colour, leader });
    }
    Selection { robots, legend }
}

/// One of `count` colours that can be told apart.
fn colour(place: usize, count: usize) -> RGBColor {
    if count <= COLOURS.len() {
        return COLOURS.get(place).copied().unwrap_or(BLACK);
    }
    // Neighbours in rank are neighbours in hue, alternately light and dark.
    let lightness = if place.is_multiple_of(2) { 0.36 } else { 0.55 };
    let (red, green, blue) = HSLColor(place as f64 / count as f64, 0.85, lightness).rgb();
    RGBColor(red, green, blue)
}

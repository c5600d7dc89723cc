//! Noticing that a robot is caught or enclosed, and choosing a remedy.
use super::{Drawn, Pushed, Remedy, Sight, State};
use crate::Vector2;
use crate::avoidance::{Guard, auxiliary_arc, auxiliary_lines, escape};
use crate::curve::Placed;
use crate::hull::Outline;

impl Remedy {
    pub(super) fn choose(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) {
        self.choose_way(sight, robot, drawn);
        if self.state == State::Free
            && self.is_trapped(sight, robot, drawn)
            && let Some(led) = sight.led_to_place(robot, self.wary)
        {
            self.state = led;
        }
    }

    fn choose_way(&mut self, sight: &Sight<'_>, robot: Vector2<f64>, drawn: Drawn) {
        let gap = |index: usize| sight.approach(index, robot).gap;
        let nearest = (0..sight.around.apparent.len()).map(|index| (gap(index), index));
        let target = drawn.point();
        let settings = &sight.remedies.watch;
        let crowded = sight.teammate_gap(robot) < settings.radius;
        let Some((gap, index)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            if self.is_caught(sight, robot, target, Pushed { obstacle: None, crowded }) {
                self.state = sight.led(robot, drawn, self.wary);
            }
            return;
        };
        let obstacle = &sight.around.apparent[index];
        let outline = obstacle.shape.outline();
        let suspended = State::Suspended { until: sight.time() + settings.patience, within: Some(obstacle.id) };
        if gap < 0.0 {
            let walls: Vec<Outline<'_>> = sight.around.real.iter().map(|real| real.shape.outline()).collect();
            let (room, cut) = (sight.potential.pole_with_margin(), sight.potential.cut());
            // Beyond the cut: a robot lags behind its carrot where it has to keep up with a hull that moves.
            let way = escape(&outline, &walls, robot, room, 2.0 * cut);
            self.state = way.map_or(suspended, |way| State::Escaping { obstacle: obstacle.id, carrot: robot, way });
            return;
        }
        let repelled = gap < sight.potential.cut() + settings.radius;
        let pushed = Pushed { obstacle: Some(index).filter(|_| repelled), crowded };
        if self.is_caught(sight, robot, target, pushed) {
            let seen = sight.seen_by(index, robot);
            let guard = || guard(&sight.moment.segment, drawn, &outline, seen, settings.radius);
            let guarded = repelled && !crowded && !sight.is_pulled(robot);
            // Whom it does not shield it would not free: a robot before a gap looks past the end of either obstacle.
            let shields = |guard: &Guard| guard.shields(seen);
            self.state = match Some(()).filter(|()| guarded).and_then(|()| guard()).filter(shields) {
                Some(guard) => {
                    let sunk = guard.protrusion(&outline, seen).max(0.0);
                    State::Guarded { obstacle: obstacle.id, guard, sunk }
                }
                None => sight.led(robot, drawn, self.wary),
            };
        }
    }
}

/// The arc where the nearest point follows a robot that moves by `aside` (m) along the obstacle, lines where it does not.
fn guard(segment: &Placed<'_>, drawn: Drawn, outline: &Outline<'_>, robot: Vector2<f64>, aside: f64) -> Option<Guard> {
    let foot = match drawn {
        Drawn::Goal(goal) => return auxiliary_lines(outline, robot, goal),
        Drawn::To(foot) => foot,
    };
    let towards = outline.approach(robot).towards;
    let beside = segment.track(robot + aside * Vector2::new(-towards.y, towards.x), foot.arc_length);
    let (arc, lines) = (|| auxiliary_arc(outline, robot, &foot), || auxiliary_lines(outline, robot, foot.point));
    if (beside.point - foot.point).norm() > 0.5 * aside { arc().or_else(lines) } else { lines().or_else(arc) }
}

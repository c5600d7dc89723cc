//! Nearest points of a point that moves: what is far stays far for a while.
use super::piece::Piece;
use super::{Curve, Foot};
use nalgebra::Vector2;

/// What the last answer proves about the next questions. It has no influence on what they are answered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Warm {
    /// The curve it is about; 0 for none.
    stamp: u64,
    /// The piece with the nearest point.
    piece: u32,
    /// From here all pieces are at least `room` (m) away but that one and its neighbours.
    pub(super) centre: Vector2<f64>,
    pub(super) room: f64,
    /// How often it has helped, how many questions no proof is tried for, and for how many after the next that has not helped enough.
    helped: u8,
    pause: u8,
    next_pause: u8,
}

/// A proof costs several questions: after one that has helped less often than this the next is tried so many questions later, and from
/// then on after twice as many each time, up to so many.
const WORTH: u8 = 8;
const PAUSES: (u8, u8) = (8, 128);
/// Taken off the room for rounding, as a part of it and of the curve's length.
const ROUNDING: f64 = 1e-12;

impl Default for Warm {
    fn default() -> Self {
        Self { stamp: 0, piece: 0, centre: Vector2::zeros(), room: 0.0, helped: 0, pause: 0, next_pause: PAUSES.0 }
    }
}

impl Warm {
    /// The piece of a curve that a point is near for certain as long as it has moved little.
    #[inline]
    pub(super) fn piece_on(&self, curve: &Curve) -> Option<usize> {
        (self.stamp == curve.stamp && self.room > 0.0).then_some(self.piece as usize)
    }

    /// It has helped.
    #[inline]
    pub(crate) fn thank(&mut self) {
        self.helped = self.helped.saturating_add(1);
    }
}

impl Curve {
    /// [`Self::nearest`] for a point that was asked about before with the same `warm`: as long as it has moved little, one to three
    /// pieces are looked at, and no other can be as near. The result is the same bit for bit.
    pub fn nearest_again(&self, point: Vector2<f64>, warm: &mut Warm) -> Foot {
        let known = warm.stamp == self.stamp;
        if known && warm.room > 0.0 {
            let moved = (point - warm.centre).norm();
            if let Some(best) = self.rest(point, warm.piece as usize).filter(|best| best.distance + moved < warm.room) {
                warm.thank();
                return self.beyond_ends(point, best);
            }
            let mut best = self.none_yet();
            self.look_at(point, warm.piece as usize, &mut best);
            if best.distance + moved < warm.room {
                let [before, after] = self.beside(warm.piece as usize);
                for index in [before, after].into_iter().flatten() {
                    self.improve(point, index, &mut best);
                }
                warm.thank();
                return self.beyond_ends(point, best);
            }
        }
        let best = if known { self.best_from(point, warm.piece as usize) } else { self.best(point) };
        let (pause, next_pause) = match *warm {
            Warm { pause: pause @ 1.., next_pause, .. } if known => (pause - 1, next_pause),
            Warm { helped: ..WORTH, next_pause, .. } if known => {
                (next_pause, next_pause.saturating_mul(2).min(PAUSES.1))
            }
            _ => (0, PAUSES.0),
        };
        let room = || {
            let slack = ROUNDING * (self.length + best.distance);
            // One that would not outlast another step like the last is none.
            let step = if known { (point - warm.centre).norm() } else { 0.0 };
            let least = best.distance + step;
            self.room_beside(best.piece, point, least) * (1.0 - ROUNDING) - slack
        };
        *warm = Warm {
            stamp: self.stamp,
            piece: best.piece as u32,
            centre: point,
            room: if pause == 0 { room() } else { 0.0 },
            helped: 0,
            pause,
            next_pause,
        };
        self.beyond_ends(point, best)
    }

    /// A lower bound of the distance of all pieces but `index` and its neighbours, m; nothing less than `least` is worth the search.
    fn room_beside(&self, index: usize, point: Vector2<f64>, least: f64) -> f64 {
        let [before, after] = self.beside(index);
        let bound = |piece: &Piece| piece.chord_distance_squared(point).sqrt() - piece.sagitta;
        // Most often these are the nearest.
        let next = [before.and_then(|before| self.beside(before)[0]), after.and_then(|after| self.beside(after)[1])];
        let mut room = next.into_iter().flatten().fold(f64::INFINITY, |room, next| room.min(bound(&self.pieces[next])));
        if room < least {
            return 0.0;
        }
        self.tree.visit_near(point, room, |other| {
            if other != index && Some(other) != before && Some(other) != after {
                room = room.min(bound(&self.pieces[other]));
            }
            room.max(0.0)
        });
        room
    }

    /// The pieces before and after a piece.
    pub(super) fn beside(&self, index: usize) -> [Option<usize>; 2] {
        let last = self.pieces.len() - 1;
        let before = if index > 0 { Some(index - 1) } else { Some(last).filter(|_| self.closed) };
        let after = if index < last { Some(index + 1) } else { Some(0).filter(|_| self.closed) };
        [before, after]
    }
}

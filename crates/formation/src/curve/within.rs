//! The nearest point of a part of a curve, (7.2) on a fragment.
use super::minimum::{Minimum, interior_minima};
use super::piece::Piece;
use super::{Curve, Foot, Interval};
use nalgebra::Vector2;

impl Curve {
    /// The nearest point between two arc lengths, certified as [`Self::nearest`]: the interval must meet the curve's domain.
    pub fn nearest_within(&self, point: Vector2<f64>, (from, to): Interval) -> Foot {
        let unrestricted = self.nearest(point);
        if from <= unrestricted.arc_length && unrestricted.arc_length <= to {
            return unrestricted;
        }
        let (start, end) = self.domain();
        let ends = [from.max(start), to.min(end)].into_iter().filter(|at| at.is_finite());
        let extensions = self.extension_feet(point).filter(|at| from <= *at && *at <= to);
        let mut best: Option<Foot> = None;
        for arc_length in ends.chain(extensions) {
            let foot = self.at(arc_length);
            keep_nearer(&mut best, Foot { distance: (foot.point - point).norm(), ..foot });
        }
        let reach = |best: &Option<Foot>| best.map_or(f64::INFINITY, |foot| foot.distance);
        self.tree.visit_near(point, reach(&best), |index| {
            let Some(part) = self.part_of_piece(index, (from, to)) else { return reach(&best) };
            let primitive = &self.primitives[part.primitive];
            for parameter in [part.from, part.to] {
                keep_nearer(&mut best, self.foot_on(index, parameter, point));
            }
            interior_minima(primitive, &part, point, reach(&best), |minimum| {
                let parameter = match minimum {
                    Minimum::At { parameter, .. } => parameter,
                    Minimum::Everywhere { .. } => part.from,
                };
                keep_nearer(&mut best, self.foot_on(index, parameter, point));
                reach(&best)
            });
            reach(&best)
        });
        best.unwrap_or(unrestricted)
    }

    /// What of a piece lies between two arc lengths.
    pub(super) fn part_of_piece(&self, index: usize, (from, to): Interval) -> Option<Piece> {
        let piece = &self.pieces[index];
        let (low, high) = (piece.offset, piece.offset + piece.length);
        if to < low || from > high {
            return None;
        }
        let primitive = &self.primitives[piece.primitive];
        let parameter = |arc_length: f64, otherwise: f64| match self.locate(arc_length) {
            (at, parameter) if at == index => parameter,
            _ => otherwise,
        };
        let start = if from > low { parameter(from, piece.to) } else { piece.from };
        let end = if to < high { parameter(to, piece.from) } else { piece.to };
        let point = |parameter: f64| primitive.evaluate(parameter).point;
        Some(Piece { from: start, to: end, start: point(start), end: point(end), bend: None, ..*piece })
    }
}

fn keep_nearer(best: &mut Option<Foot>, foot: Foot) {
    if best.is_none_or(|other| foot.distance < other.distance) {
        *best = Some(foot);
    }
}

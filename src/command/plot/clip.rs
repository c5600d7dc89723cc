//! Lines cut to a rectangle: plotters would draw on beyond its axes.

/// The parts of a chain of straight pieces within `[left, right, bottom, top]`.
pub(super) fn clip(points: &[(f64, f64)], window: [f64; 4]) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    for pair in points.windows(2) {
        let &[from, to] = pair else { continue };
        let Some((start, end)) = piece(from, to, window) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&start) => part.push(end),
            _ => parts.push(vec![start, end]),
        }
    }
    parts
}

/// The part of one piece inside (Liang and Barsky).
fn piece(from: (f64, f64), to: (f64, f64), [left, right, bottom, top]: [f64; 4]) -> Option<((f64, f64), (f64, f64))> {
    let (along_x, along_y) = (to.0 - from.0, to.1 - from.1);
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (slope, room) in
        [(-along_x, from.0 - left), (along_x, right - from.0), (-along_y, from.1 - bottom), (along_y, top - from.1)]
    {
        if slope == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if slope < 0.0 {
            enters = enters.max(room / slope);
        } else {
            leaves = leaves.min(room / slope);
        }
    }
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => (from.0 + share * along_x, from.1 + share * along_y),
    };
    (enters <= leaves).then(|| (at(enters), at(leaves)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_window() {
        let window = [0.0, 2.0, 0.0, 1.0];
        assert_eq!(clip(&[(-1.0, 0.5), (1.0, 0.5), (3.0, 0.5)], window), [vec![(0.0, 0.5), (1.0, 0.5), (2.0, 0.5)]]);
        assert_eq!(clip(&[(0.5, 2.0), (0.5, 0.5), (0.5, 3.0)], window).len(), 1);
        assert_eq!(clip(&[(0.5, 0.5), (0.5, 3.0), (1.5, 3.0), (1.5, 0.5)], window).len(), 2);
        assert!(clip(&[(-1.0, -1.0), (-1.0, 3.0)], window).is_empty());
    }
}

//! The chessboard that people print and hold before the camera.

use std::fmt::Write as _;

/// A chessboard of `columns` times `rows` squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Board {
    /// Squares along the longer side.
    pub columns: usize,
    /// Squares along the shorter side.
    pub rows: usize,
    /// Side of a square, m.
    pub square: f64,
}

/// White around the board, in squares: corner detectors need it.
const BORDER: f64 = 1.0;
/// Points of PDF in a metre.
const POINTS: f64 = 72.0 / 0.0254;

impl Board {
    /// Where four squares meet: corners along the longer side, and along the shorter one.
    #[must_use]
    pub fn inner(&self) -> [usize; 2] {
        [self.columns.saturating_sub(1), self.rows.saturating_sub(1)]
    }

    /// The corners in the order in which [`crate::find_corners`] gives them, m, in the plane of the board.
    #[must_use]
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let [across, down] = self.inner();
        let corner = |index: usize| [(index % across) as f64 * self.square, (index / across) as f64 * self.square];
        (0..across * down).map(corner).collect()
    }

    /// The black squares: column and row.
    fn black(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let all = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        all.filter(|(column, row)| (column + row).is_multiple_of(2)).map(|(column, row)| [column as f64, row as f64])
    }

    fn size(&self) -> [f64; 2] {
        [self.columns, self.rows].map(|squares| (squares as f64 + 2.0 * BORDER) * self.square)
    }

    /// What is printed below: a scale to check the print by.
    fn caption(&self) -> String {
        let millimetres = 1e3 * self.square;
        format!("{} x {} squares of {millimetres} mm: print at 100 %, measure the bar: 100 mm", self.columns, self.rows)
    }

    /// A drawing at true scale.
    #[must_use]
    pub fn svg(&self) -> String {
        // To a micrometre: no digits that a printer would not know what to do with.
        let millimetres = |metres: f64| (1e6 * metres).round() / 1e3;
        let [width, height] = self.size().map(millimetres);
        let (square, border) = (millimetres(self.square), millimetres(BORDER * self.square));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" viewBox=\"0 0 {width} \
             {height}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
        );
        for [column, row] in self.black() {
            let (x, y) = (border + column * square, border + row * square);
            // Writing to a String cannot fail.
            let _ = writeln!(text, "<rect x=\"{x}\" y=\"{y}\" width=\"{square}\" height=\"{square}\"/>");
        }
        let (bar, letters) = (height - 0.45 * border, height - 0.15 * border);
        let _ = write!(
            text,
            "<path d=\"M {border} {bar} h 100\" stroke=\"black\" stroke-width=\"0.4\"/>\n<text x=\"{border}\" \
             y=\"{letters}\" font-family=\"sans-serif\" font-size=\"4\">{}</text>\n</svg>\n",
            self.caption()
        );
        text
    }

    /// The same as a PDF page of just that size.
    #[must_use]
    pub fn pdf(&self) -> Vec<u8> {
        let [width, height] = self.size().map(|side| side * POINTS);
        let (square, border) = (self.square * POINTS, BORDER * self.square * POINTS);
        let mut drawing = String::new();
        for [column, row] in self.black() {
            // PDF's y goes up.
            let (x, y) = (border + column * square, height - border - (row + 1.0) * square);
            let _ = writeln!(drawing, "{x:.4} {y:.4} {square:.4} {square:.4} re f");
        }
        let (bar, letters, length) = (0.45 * border, 0.15 * border, 0.1 * POINTS);
        let _ = write!(
            drawing,
            "{border:.4} {bar:.4} m {:.4} {bar:.4} l S\nBT /F 11 Tf {border:.4} {letters:.4} Td ({}) Tj ET\n",
            border + length,
            self.caption()
        );
        let objects = [
            "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
            "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_owned(),
            format!(
                "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.4} {height:.4}] /Contents 4 0 R /Resources << /Font \
                 << /F << /Type /Font /Subtype /Type1 /BaseFont /Helvetica >> >> >> >>"
            ),
            format!("<< /Length {} >>\nstream\n{drawing}endstream", drawing.len()),
        ];
        let mut text = "%PDF-1.4\n".to_owned();
        let mut places = Vec::new();
        for (index, object) in objects.iter().enumerate() {
            places.push(text.len());
            let _ = write!(text, "{} 0 obj\n{object}\nendobj\n", index + 1);
        }
        let table = text.len();
        let _ = write!(text, "xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
        for place in places {
            let _ = writeln!(text, "{place:010} 00000 n ");
        }
        let _ = write!(text, "trailer << /Size {} /Root 1 0 R >>\nstartxref\n{table}\n%%EOF\n", objects.len() + 1);
        text.into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_have_the_boards_size() {
        let board = Board { columns: 9, rows: 6, square: 0.025 };
        let svg = board.svg();
        assert!(svg.contains("width=\"275mm\" height=\"200mm\""), "{svg}");
        // Half of 54 squares are black; the page is one more.
        assert_eq!(svg.matches("<rect").count(), 28);
        let pdf = String::from_utf8(board.pdf()).unwrap();
        assert!(pdf.contains("/MediaBox [0 0 779.5276 566.9291]") && pdf.matches(" re f").count() == 27, "{pdf}");
        let place = pdf.find("startxref\n").unwrap() + 10;
        let table: usize = pdf[place..].lines().next().unwrap().parse().unwrap();
        assert!(pdf[table..].starts_with("xref\n0 5\n"));
    }
}

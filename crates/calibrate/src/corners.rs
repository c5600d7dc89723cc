//! A chessboard's corners in a picture, to a small part of a pixel: ChESS (Bennett and Lasenby 2014) finds them, a saddle
//! surface fitted to the grey around each places them (crate `chess-corners-core`).

use crate::{Board, Picture, grid};
use chess_corners_core::{
    ChessParams, Corner, ImageView, Refiner, RefinerKind, chess_response_u8, detect_corners_from_response_with_refiner,
};

/// Why a picture shows no board.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CornerError {
    /// Too few corners of any kind.
    #[error("{found} corners are seen, the board has {expected}: show it whole, flat, sharp and well lit")]
    Few {
        /// That were seen.
        found: usize,
        /// That there should be.
        expected: usize,
    },
    /// Corners that make no board of this size.
    #[error("the corners seen are not those of a board of {0:?} corners: are `--columns` and `--rows` its squares?")]
    Other([usize; 2]),
}

/// Corners weaker than this part of the typical one of the board are something else.
const WEAKEST: f32 = 0.25;

/// The inner corners of `board`, row by row, in pixels; the centre of the first pixel is (0, 0).
///
/// # Errors
/// When the board is not seen whole.
pub fn find_corners(picture: &Picture, board: &Board) -> Result<Vec<[f64; 2]>, CornerError> {
    let ([width, height], [across, down]) = (picture.size(), board.inner());
    let expected = across * down;
    let parameters = ChessParams::default();
    let response = chess_response_u8(picture.pixels(), width, height, &parameters);
    let mut refiner = Refiner::from_kind(RefinerKind::SaddlePoint(Default::default()));
    let view = ImageView::from_u8_slice(width, height, picture.pixels());
    let mut corners = detect_corners_from_response_with_refiner(&response, &parameters, view, &mut refiner);
    corners.sort_by(|a, b| b.strength.total_cmp(&a.strength));
    if corners.len() < expected || expected == 0 {
        return Err(CornerError::Few { found: corners.len(), expected });
    }
    // The board's corners are about equally strong; other things may be stronger, noise is much weaker.
    let typical = corners[expected / 2].strength;
    let strong = corners.iter().take_while(|corner| corner.strength > WEAKEST * typical);
    let points: Vec<[f64; 2]> =
        strong.map(|corner: &Corner| [f64::from(corner.x), f64::from(corner.y)]).take(4 * expected).collect();
    grid::order(&points, [across, down]).ok_or(CornerError::Other([across, down]))
}

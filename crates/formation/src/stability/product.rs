//! Matrix products that are the same on every machine.
use nalgebra::DMatrix;

/// a b, each sum in rising order: for larger matrices nalgebra picks a kernel by the processor, fused multiplications or not.
pub(super) fn product(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(a.nrows(), b.ncols(), |row, column| {
        (0..a.ncols()).map(|inner| a[(row, inner)] * b[(inner, column)]).sum()
    })
}

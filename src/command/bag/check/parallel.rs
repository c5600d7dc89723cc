//! Work on many things at once.

use std::sync::Mutex;
use std::sync::PoisonError;

/// What `work` makes of each item, as many at a time as there are processors, begun in the order given; in no order.
pub(super) fn each<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let processors = std::thread::available_parallelism().map_or(1, usize::from).min(items.len());
    let items = Mutex::new(items.into_iter());
    let results = Mutex::new(Vec::new());
    let one_by_one = || {
        // The lock is free again before the work begins.
        while let Some(item) = { items.lock().unwrap_or_else(PoisonError::into_inner).next() } {
            let result = work(item);
            results.lock().unwrap_or_else(PoisonError::into_inner).push(result);
        }
    };
    std::thread::scope(|scope| (0..processors).for_each(|_| drop(scope.spawn(one_by_one))));
    results.into_inner().unwrap_or_else(PoisonError::into_inner)
}

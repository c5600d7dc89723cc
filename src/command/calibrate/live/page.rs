//! What goes through a browser's WebSocket: it asks for each picture with an empty message when it has drawn the one before;
//! everything else that it says is a command.

use super::table::Table;
use crate::command::web::{Places, Said, hear, tell};
use axum::Router;
use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::HeaderMap;
use axum::response::Response;
use axum::routing::get;
use std::sync::Arc;
use trench_view::page;

/// The page's files.
pub(super) const FILES: &[&[page::File]] = &[page::SHARED, page::COLOURS];
/// What a browser may say at once, bytes.
const LONGEST: usize = 256;

#[derive(Clone)]
struct Served {
    table: Arc<Table>,
    places: Places,
}

/// What the server answers besides the page's files.
pub(super) fn router(table: Arc<Table>) -> Router {
    Router::new().route("/stream", get(open_stream)).with_state(Served { table, places: Places::default() })
}

async fn open_stream(State(served): State<Served>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    let Served { table, places } = served;
    places.open(&headers, upgrade, LONGEST, move |socket| async move { stream(socket, &table).await })
}

async fn stream(mut socket: WebSocket, table: &Table) {
    let mut newest = table.listen();
    let mut wants_more = false;
    loop {
        let waiting = wants_more.then(|| table.wait());
        let said = tokio::select! {
            said = hear(&mut socket) => Some(said),
            changed = newest.changed(), if wants_more => if changed.is_ok() { None } else { return },
        };
        drop(waiting);
        match said {
            None => {
                wants_more = false;
                let message = newest.borrow_and_update().clone();
                if !tell(&mut socket, Message::Binary(message)).await {
                    return;
                }
            }
            Some(Said::More) => wants_more = true,
            Some(Said::Command(command)) => table.ask(command),
            Some(Said::Gone) => return,
        }
    }
}

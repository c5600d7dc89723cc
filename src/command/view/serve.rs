//! The stream for each browser.

use super::hub::Hub;
use super::stream;
use crate::command::web::Places;
use axum::Router;
use axum::extract::State;
use axum::extract::ws::WebSocketUpgrade;
use axum::http::HeaderMap;
use axum::response::Response;
use axum::routing::get;
use std::sync::Arc;
use trench_view::Recording;

/// What a browser may say at once, bytes.
const LONGEST: usize = 256;

/// Where the picture comes from.
#[derive(Clone)]
pub(super) enum Picture {
    /// What happens now.
    Live(Arc<Hub>),
    /// A bag, which each browser plays for itself.
    Bag {
        /// The bag.
        recording: Arc<Recording>,
        /// The part `setup`.
        setup: String,
    },
}

#[derive(Clone)]
struct Served {
    picture: Picture,
    places: Places,
}

/// What the server answers besides the page's files.
pub(super) fn router(picture: Picture) -> Router {
    let served = Served { picture, places: Places::default() };
    Router::new().route("/stream", get(open_stream)).with_state(served)
}

async fn open_stream(State(served): State<Served>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    let Served { picture, places } = served;
    places.open(&headers, upgrade, LONGEST, move |socket| async move {
        match picture {
            Picture::Live(hub) => stream::live(socket, &hub).await,
            Picture::Bag { recording, setup } => stream::bag(socket, recording, setup).await,
        }
    })
}

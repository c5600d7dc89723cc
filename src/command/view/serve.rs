//! The server: the files of the page, and a stream for each browser.

use super::guard::{Guard, is_own_page, stand};
use super::hub::Hub;
use super::stream;
use axum::Router;
use axum::extract::State;
use axum::extract::ws::WebSocketUpgrade;
use axum::http::header::CONTENT_TYPE;
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use std::net::TcpListener;
use std::sync::Arc;
use tokio::sync::Semaphore;
use trench_view::{Recording, page};

/// Browsers at the same time.
const BROWSERS: usize = 32;
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
    places: Arc<Semaphore>,
}

/// Serves until the process ends.
pub(super) fn serve(listener: TcpListener, guard: Guard, picture: Picture) -> std::io::Result<()> {
    let mut router = Router::new().route("/stream", get(open_stream));
    for file in page::FILES {
        let answer = || async { ([(CONTENT_TYPE, file.content_type)], file.bytes) };
        router = router.route(file.path, get(answer));
    }
    let served = Served { picture, places: Arc::new(Semaphore::new(BROWSERS)) };
    let router = router.layer(from_fn_with_state(guard, stand)).with_state(served);
    listener.set_nonblocking(true)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
    runtime.block_on(async { axum::serve(tokio::net::TcpListener::from_std(listener)?, router).await })
}

async fn open_stream(State(served): State<Served>, headers: HeaderMap, upgrade: WebSocketUpgrade) -> Response {
    if !is_own_page(&headers) {
        return (StatusCode::FORBIDDEN, "only the page of this server may open its stream\n").into_response();
    }
    let Ok(place) = served.places.try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many browsers are watching\n").into_response();
    };
    let upgrade = upgrade.max_message_size(LONGEST).max_frame_size(LONGEST);
    upgrade.on_upgrade(move |socket| async move {
        match served.picture {
            Picture::Live(hub) => stream::live(socket, &hub).await,
            Picture::Bag { recording, setup } => stream::bag(socket, recording, setup).await,
        }
        drop(place);
    })
}

//! Pages for a browser: served by this process alone, to those who sit at this host unless told otherwise.

mod guard;

use super::say;
use axum::Router;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::http::header::CONTENT_TYPE;
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::from_fn_with_state;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use guard::{Guard, is_own_page, stand};
use serde::de::DeserializeOwned;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::time::timeout;
use trench_view::page::File;

/// Browsers at the same time.
const BROWSERS: usize = 32;
/// A browser that takes nothing for so long is gone.
const PATIENCE: Duration = Duration::from_secs(20);

/// Where the page is served.
#[derive(clap::Args)]
pub(super) struct Address {
    /// The port of the page; 0 takes any that is free.
    #[arg(long, default_value_t = 8420)]
    port: u16,
    /// The address to serve on. Others than this host's own loopback show the page to everyone who reaches it.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1")]
    bind: IpAddr,
    /// A name under which browsers may ask for the page, besides localhost and addresses.
    #[arg(long, value_name = "NAME")]
    allow_host: Vec<String>,
}

/// The address is not to be had.
#[derive(Debug, thiserror::Error)]
#[error("{address}: {source}; is another page of trench served there? Name another port with --port")]
pub(super) struct BindError {
    address: SocketAddr,
    source: std::io::Error,
}

/// A page's place, before anybody is answered.
pub(super) struct Server {
    listener: TcpListener,
    address: SocketAddr,
    guard: Guard,
}

impl Address {
    /// Takes the address.
    pub(super) fn take(&self) -> Result<Server, BindError> {
        let address = SocketAddr::new(self.bind, self.port);
        let listen = || {
            let listener = TcpListener::bind(address)?;
            // Of port 0 the one that was given.
            Ok((listener.local_addr()?, listener))
        };
        let (address, listener) = listen().map_err(|source| BindError { address, source })?;
        Ok(Server { guard: Guard::new(address, &self.allow_host), listener, address })
    }
}

impl Server {
    /// Prints where the page is; `open` is what everyone may do who reaches an address that others reach.
    pub(super) fn announce(&self, command: &str, open: &str) {
        if !self.address.ip().is_loopback() {
            eprintln!("{command}: everyone who reaches {} {open}", self.address);
        }
        say(format_args!("http://{}/\n", self.address));
    }

    /// Serves the page's files and what `router` has besides, until the process ends.
    pub(super) fn serve(self, files: &[&'static [File]], mut router: Router) -> std::io::Result<()> {
        for file in files.iter().copied().flatten() {
            let answer = || async { ([(CONTENT_TYPE, file.content_type)], file.bytes) };
            router = router.route(file.path, get(answer));
        }
        let router = router.layer(from_fn_with_state(self.guard, stand));
        self.listener.set_nonblocking(true)?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
        runtime.block_on(async { axum::serve(tokio::net::TcpListener::from_std(self.listener)?, router).await })
    }

    /// The same, in a thread of its own.
    pub(super) fn serve_beside(
        self,
        command: &'static str,
        files: &'static [&'static [File]],
        router: Router,
    ) -> std::io::Result<()> {
        let thread = std::thread::Builder::new().name("page".to_owned());
        thread.spawn(move || {
            if let Err(error) = self.serve(files, router) {
                eprintln!("{command}: the server failed: {error}");
            }
        })?;
        Ok(())
    }
}

/// Places for the browsers that may look at the same time.
#[derive(Clone)]
pub(super) struct Places(Arc<Semaphore>);

impl Default for Places {
    fn default() -> Self {
        Self(Arc::new(Semaphore::new(BROWSERS)))
    }
}

impl Places {
    /// Opens the stream of a page of this server, if there is a place for it. Whoever says more than `longest` bytes at once is
    /// cut off.
    pub(super) fn open<Stream>(
        &self,
        headers: &HeaderMap,
        upgrade: WebSocketUpgrade,
        longest: usize,
        stream: impl FnOnce(WebSocket) -> Stream + Send + 'static,
    ) -> Response
    where
        Stream: Future<Output = ()> + Send + 'static,
    {
        if !is_own_page(headers) {
            return (StatusCode::FORBIDDEN, "only the page of this server may open its stream\n").into_response();
        }
        let Ok(place) = Arc::clone(&self.0).try_acquire_owned() else {
            return (StatusCode::SERVICE_UNAVAILABLE, "too many browsers are watching\n").into_response();
        };
        let upgrade = upgrade.max_message_size(longest).max_frame_size(longest);
        upgrade.on_upgrade(move |socket| async move {
            stream(socket).await;
            drop(place);
        })
    }
}

/// Browsers that have drawn what they got and wait for more.
#[derive(Default)]
pub(super) struct Waiters(AtomicUsize);

/// A browser that waits; it does so as long as this lives.
pub(super) struct Waiting<'a>(&'a Waiters);

impl Waiters {
    pub(super) fn wait(&self) -> Waiting<'_> {
        self.0.fetch_add(1, Ordering::Relaxed);
        Waiting(self)
    }

    /// Whether any browser waits.
    pub(super) fn are_there(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What a browser said.
pub(super) enum Said<Command> {
    /// It has drawn and wants more.
    More,
    /// It wants something of the page's.
    Command(Command),
    /// It has gone, or says what nobody understands.
    Gone,
}

/// The next that a browser says.
pub(super) async fn hear<Command: DeserializeOwned>(socket: &mut WebSocket) -> Said<Command> {
    loop {
        return match socket.recv().await {
            Some(Ok(Message::Text(text))) if text.is_empty() => Said::More,
            Some(Ok(Message::Text(text))) => serde_json::from_str(&text).map_or(Said::Gone, Said::Command),
            Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
            _ => Said::Gone,
        };
    }
}

/// Sends a browser something; false if it has gone.
pub(super) async fn tell(socket: &mut WebSocket, message: Message) -> bool {
    matches!(timeout(PATIENCE, socket.send(message)).await, Ok(Ok(())))
}

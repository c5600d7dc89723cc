//! What goes through one browser's WebSocket.
//!
//! The browser asks for each picture with an empty message when it has drawn the one before: a slow browser, or one
//! whose window is hidden, asks less often and holds up nobody, and nothing is made or sent that nobody looks at.

use super::hub::Hub;
use crate::command::web::{Said, hear, tell};
use axum::extract::ws::{Message, WebSocket};
use std::sync::Arc;
use std::time::Duration;
use tokio::time::{Instant, sleep_until};
use trench_view::{Command, Player, Recording, Seen};

/// The shortest time between two pictures of a bag.
const PERIOD: Duration = Duration::from_millis(33);

/// What happens now: the newest picture each time the browser asks.
pub(super) async fn live(mut socket: WebSocket, hub: &Hub) {
    let (mut newest, mut seen) = (hub.listen(), Seen::default());
    while matches!(hear::<Command>(&mut socket).await, Said::More) {
        let news = loop {
            let waiting = hub.wait(seen.needs_history());
            // A browser that goes while it waits is not waited for.
            let changed = tokio::select! {
                changed = newest.changed() => changed.is_ok(),
                _ = hear::<Command>(&mut socket) => false,
            };
            drop(waiting);
            if !changed {
                return;
            }
            let snapshot = newest.borrow_and_update().clone();
            if let Some(news) = seen.news(&snapshot) {
                break news;
            }
        };
        if !tell(&mut socket, Message::Text(news.into())).await {
            return;
        }
    }
}

/// A bag, played for this browser.
pub(super) async fn bag(mut socket: WebSocket, recording: Arc<Recording>, setup: String) {
    let (mut player, mut seen) = (Player::new(recording, setup), Seen::default());
    let (mut last, mut sent) = (Instant::now(), Instant::now() - PERIOD);
    let mut wants_more = false;
    loop {
        let said = tokio::select! {
            said = hear(&mut socket) => Some(said),
            () = sleep_until(sent + PERIOD), if wants_more && !player.rests() => None,
        };
        let now = Instant::now();
        player.advance((now - last).as_secs_f64());
        last = now;
        // Time makes news while it plays; else only the browser does, and is answered at once.
        let is_due = match said {
            Some(Said::Gone) => return,
            Some(Said::More) => {
                wants_more = true;
                player.rests()
            }
            Some(Said::Command(command)) => {
                player.obey(command);
                true
            }
            None => true,
        };
        if !(wants_more && is_due) {
            continue;
        }
        let (snapshot, jumped) = player.snapshot();
        if jumped {
            seen.forget();
        }
        let Some(news) = seen.news(&snapshot) else { continue };
        (wants_more, sent) = (false, now);
        if !tell(&mut socket, Message::Text(news.into())).await {
            return;
        }
    }
}

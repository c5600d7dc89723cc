//! Who may ask. A page of another site must not read the picture through the browser of somebody who sits here: names
//! that are not ours are refused (against DNS rebinding), and so are WebSockets that another page opens.

use axum::extract::{Request, State};
use axum::http::header::{HOST, ORIGIN};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use trench_view::page::CONTENT_SECURITY_POLICY;

/// What this server calls itself.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    address: SocketAddr,
    names: Arc<[String]>,
}

/// On every answer.
const HEADERS: [(&str, &str); 6] = [
    ("content-security-policy", CONTENT_SECURITY_POLICY),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cache-control", "no-store"),
];

impl Guard {
    pub(super) fn new(address: SocketAddr, names: &[String]) -> Self {
        let names = names.iter().map(|name| name.to_ascii_lowercase()).collect();
        Self { address, names }
    }

    /// Whether a request's Host names this server: loopback by name or address, and where it serves others, any
    /// address (one cannot rebind an address).
    fn admits(&self, host: &str) -> bool {
        let (name, port) = split_port(host);
        if port != Some(self.address.port()) && !(port.is_none() && self.address.port() == 80) {
            return false;
        }
        let name = name.to_ascii_lowercase();
        if name == "localhost" || self.names.contains(&name) {
            return true;
        }
        let bare = name.trim_start_matches('[').trim_end_matches(']');
        bare.parse::<IpAddr>().is_ok_and(|address| address.is_loopback() || !self.address.ip().is_loopback())
    }
}

fn split_port(host: &str) -> (&str, Option<u16>) {
    match host.rsplit_once(':') {
        Some((name, port)) if !port.ends_with(']') => (name, port.parse().ok()),
        _ => (host, None),
    }
}

/// Whether a page of this server itself opened the connection.
pub(super) fn is_own_page(headers: &HeaderMap) -> bool {
    let text = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
    let own = text(HOST).map(|host| format!("http://{}", host.to_ascii_lowercase()));
    own.is_some() && own == text(ORIGIN).map(str::to_ascii_lowercase)
}

/// Stands before all paths.
pub(super) async fn stand(State(guard): State<Guard>, request: Request, next: Next) -> Response {
    let hosts: Vec<_> = request.headers().get_all(HOST).iter().collect();
    let admitted = matches!(hosts.as_slice(), [host] if host.to_str().is_ok_and(|host| guard.admits(host)));
    let mut response = if admitted {
        next.run(request).await
    } else {
        (StatusCode::MISDIRECTED_REQUEST, "this server does not go by that name; see --allow-host\n").into_response()
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(HeaderName::from_static(name), HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(address: &str, host: &str, admitted: bool) {
        let guard = Guard::new(address.parse().unwrap(), &["lab-pc".to_owned()]);
        assert_eq!(guard.admits(host), admitted, "{host} at {address}");
    }

    #[test]
    fn only_names_of_this_server_are_admitted() {
        for host in ["localhost:8420", "LOCALHOST:8420", "127.0.0.1:8420", "[::1]:8420", "lab-pc:8420"] {
            check("127.0.0.1:8420", host, true);
        }
        for host in ["evil.example:8420", "localhost", "localhost:80", "192.168.1.4:8420", "127.0.0.1.evil:8420", ""] {
            check("127.0.0.1:8420", host, false);
        }
        check("0.0.0.0:8420", "192.168.1.4:8420", true);
        check("0.0.0.0:8420", "evil.example:8420", false);
        check("127.0.0.1:80", "localhost", true);
    }

    #[test]
    fn only_our_own_page_opens_a_stream() {
        let headers = |host: &'static str, origin: Option<&'static str>| {
            let mut headers = HeaderMap::new();
            headers.insert(HOST, HeaderValue::from_static(host));
            headers.extend(origin.map(|origin| (ORIGIN, HeaderValue::from_static(origin))));
            headers
        };
        assert!(is_own_page(&headers("localhost:1", Some("http://localhost:1"))));
        assert!(!is_own_page(&headers("localhost:1", Some("http://localhost:2"))));
        assert!(!is_own_page(&headers("localhost:1", Some("http://evil.example"))));
        assert!(!is_own_page(&headers("localhost:1", Some("null"))));
        assert!(!is_own_page(&headers("localhost:1", None)));
    }
}

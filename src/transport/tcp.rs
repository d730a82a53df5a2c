//! TCP connections with a deadline. Independent of the protocol above.

use crate::system::SystemError;
use crate::transport::wire::TransportError;
use std::io;
use std::time::Duration;
use tokio::net::{TcpStream, lookup_host};
use tokio::time::timeout;

/// Time limit for a connection: a hand in the same network needs milliseconds, one lost packet a second.
pub const CONNECT_DEADLINE: Duration = Duration::from_secs(2);

/// Connects, with Nagle's delay off. Names are resolved on a thread of the runtime; all of it within [`CONNECT_DEADLINE`].
///
/// # Errors
/// `Name`, `Refused`, `Silent`, or `Io` with the system's message.
pub async fn connect(host: &str, port: u16) -> Result<TcpStream, TransportError> {
    let place = place(host, port);
    match timeout(CONNECT_DEADLINE, connect_now(host, port, &place)).await {
        Ok(result) => result,
        Err(_elapsed) => Err(silent(place)),
    }
}

async fn connect_now(host: &str, port: u16, place: &str) -> Result<TcpStream, TransportError> {
    let name = |_: io::Error| TransportError::Name { place: host.into() };
    let addresses: Vec<_> = lookup_host((host, port)).await.map_err(name)?.collect();
    if addresses.is_empty() {
        return Err(TransportError::Name { place: host.into() });
    }
    let stream = TcpStream::connect(addresses.as_slice())
        .await
        .map_err(|error| refused(place, &error))?;
    stream
        .set_nodelay(true)
        .map_err(|error| refused(place, &error))?;
    Ok(stream)
}

fn refused(place: &str, error: &io::Error) -> TransportError {
    match error.kind() {
        io::ErrorKind::ConnectionRefused => TransportError::Refused {
            place: place.into(),
        },
        io::ErrorKind::TimedOut => silent(place.into()),
        _ => TransportError::Io {
            place: place.into(),
            failure: SystemError::from(error).into(),
        },
    }
}

fn silent(place: String) -> TransportError {
    TransportError::Silent {
        place,
        after_ms: u64::try_from(CONNECT_DEADLINE.as_millis()).unwrap_or(u64::MAX),
    }
}

fn place(host: &str, port: u16) -> String {
    if host.contains(':') {
        format!("[{host}]:{port}")
    } else {
        format!("{host}:{port}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::net::TcpListener;

    #[tokio::test]
    async fn a_port_without_listener_refuses() {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        drop(listener);
        let place = format!("127.0.0.1:{port}");
        let error = connect("127.0.0.1", port).await.unwrap_err();
        assert_eq!(error, TransportError::Refused { place });
    }

    #[tokio::test]
    async fn a_name_that_is_none_says_so() {
        let error = connect("not a host name", 6000).await.unwrap_err();
        let place = "not a host name".into();
        assert_eq!(error, TransportError::Name { place });
    }

    #[tokio::test]
    async fn a_listener_is_reached_and_its_hang_up_is_a_read_of_nothing() {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let mut client = connect("127.0.0.1", port).await.unwrap();
        assert!(client.nodelay().unwrap());
        let (mut server, _) = listener.accept().await.unwrap();
        server.write_all(b"hand").await.unwrap();
        drop(server);
        let mut all = Vec::new();
        client.read_to_end(&mut all).await.unwrap();
        assert_eq!(all, b"hand");
    }

    #[test]
    fn an_unanswered_connection_is_silent_and_others_keep_their_words() {
        let error = refused("h:1", &io::Error::from(io::ErrorKind::TimedOut));
        assert_eq!(error, silent("h:1".into()));
        let error = refused("h:1", &io::Error::from(io::ErrorKind::HostUnreachable));
        assert!(matches!(error, TransportError::Io { .. }));
        assert_eq!(place("::1", 6000), "[::1]:6000");
    }
}

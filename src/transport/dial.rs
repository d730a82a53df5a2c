//! Opens the wires that the system has. The built-in hand is not one of them.

use crate::transport::endpoint::Endpoint;
use crate::transport::wire::{BoxedWire, Dial, TransportError};
use crate::transport::{serial, tcp};
use futures::future::BoxFuture;

/// Dials serial ports and sockets. Other kinds of link are [`TransportError::Unsupported`].
#[derive(Debug, Clone, Copy, Default)]
pub struct SystemDial;

impl Dial for SystemDial {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        let endpoint = endpoint.clone();
        Box::pin(async move {
            match endpoint {
                Endpoint::Rs485(line) | Endpoint::Rtu(line) => {
                    Ok(Box::new(serial::open(&line)?) as BoxedWire)
                }
                Endpoint::Tcp { host, port, .. } => {
                    Ok(Box::new(tcp::connect(&host, port).await?) as BoxedWire)
                }
                other => Err(TransportError::Unsupported {
                    kind: other.kind().into(),
                }),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn other_kinds_are_unsupported() {
        for text in ["sim:", "can:can0", "slcan:/dev/ttyACM0"] {
            let endpoint: Endpoint = text.parse().unwrap_or_else(|_| Endpoint::sim());
            let error = SystemDial.dial(&endpoint).await.err();
            let kind = endpoint.kind().to_owned();
            assert_eq!(error, Some(TransportError::Unsupported { kind }), "{text}");
        }
    }
}

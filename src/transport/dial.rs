//! Opens the system's wires. The built-in hand is not one of them.

#[cfg(target_os = "linux")]
use crate::transport::can;
use crate::transport::endpoint::{DEFAULT_ID, Endpoint, SerialLine};
use crate::transport::found::PortFound;
use crate::transport::wire::{BoxedWire, Dial, TransportError};
use crate::transport::{serial, tcp};
use futures::future::BoxFuture;

/// Baud rate of slcan adapters: those on USB accept any, those on a real line need this.
const ADAPTER_BAUD: u32 = 115_200;

/// Dials serial ports, sockets and CAN interfaces. Other kinds of link are [`TransportError::Unsupported`].
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
                Endpoint::Tcp { .. } | Endpoint::RtuTcp(_) => {
                    let (host, port) = endpoint.host().unwrap_or_default();
                    Ok(Box::new(tcp::connect(host, port).await?) as BoxedWire)
                }
                Endpoint::Slcan { port, .. } => {
                    Ok(Box::new(serial::open(&adapter(port, ADAPTER_BAUD))?) as BoxedWire)
                }
                Endpoint::UsbCan { port, baud, .. } => {
                    Ok(Box::new(serial::open(&adapter(port, baud))?) as BoxedWire)
                }
                #[cfg(target_os = "linux")]
                Endpoint::Can { interface, id } => {
                    Ok(Box::new(can::open(&interface, Some(u32::from(id)))?) as BoxedWire)
                }
                #[cfg(not(target_os = "linux"))]
                Endpoint::Can { .. } => Err(TransportError::LinuxOnly),
                other => Err(TransportError::Unsupported {
                    kind: other.kind().into(),
                }),
            }
        })
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        // Some systems take tens of milliseconds to list their ports, and other links live on this thread.
        Box::pin(async {
            let listed = tokio::task::spawn_blocking(serial::ports).await;
            listed.unwrap_or_default()
        })
    }

    #[cfg(target_os = "linux")]
    fn interfaces(&self) -> BoxFuture<'static, Vec<String>> {
        Box::pin(async {
            let listed = tokio::task::spawn_blocking(can::interfaces).await;
            listed.unwrap_or_default()
        })
    }
}

/// The serial side of a CAN adapter.
fn adapter(port: String, baud: u32) -> SerialLine {
    SerialLine {
        port,
        baud,
        id: DEFAULT_ID,
        packing: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn the_built_in_hand_is_no_wire_of_the_system() {
        let error = SystemDial.dial(&Endpoint::sim()).await.err();
        let kind = "sim".to_owned();
        assert_eq!(error, Some(TransportError::Unsupported { kind }));
    }

    #[tokio::test]
    async fn each_way_to_miss_a_can_bus_has_its_own_error() {
        let dial = async |text: &str| {
            let endpoint: Endpoint = text.parse().unwrap_or_else(|_| Endpoint::sim());
            SystemDial.dial(&endpoint).await.err()
        };
        let place = "/nowhere/ttyACM0".to_owned();
        for kind in ["slcan", "usbcan"] {
            let missing = dial(&format!("{kind}:/nowhere/ttyACM0")).await;
            let place = place.clone();
            assert_eq!(missing, Some(TransportError::Missing { place }));
        }
        let place = "nocan9".to_owned();
        let missing = dial("can:nocan9").await;
        let wanted = if cfg!(target_os = "linux") {
            TransportError::NoInterface { place }
        } else {
            TransportError::LinuxOnly
        };
        assert_eq!(missing, Some(wanted));
    }
}

//! Remembers the adapter of a hand, to find it again under another port name. Chooses the port to dial; opens nothing.

use crate::transport::{
    Adapter, Dial, Endpoint, PortFound, TransportError, Whereabouts, is_same_port,
};

/// The adapter of a link; known once the hand has answered.
#[derive(Debug, Default)]
pub(crate) struct KnownAdapter {
    adapter: Option<Adapter>,
}

impl KnownAdapter {
    /// Notes the adapter through which the hand just answered, and returns what the system reports about its port.
    pub(crate) async fn remember(
        &mut self,
        dial: &dyn Dial,
        endpoint: &Endpoint,
    ) -> Option<PortFound> {
        let port = endpoint.port()?;
        let ports = dial.ports().await;
        self.adapter = Adapter::at(port, &ports);
        ports
            .into_iter()
            .find(|found| is_same_port(port, &found.path))
    }

    /// Endpoint to dial now: the requested one, or the port where the adapter is now. If another adapter has taken over
    /// the port name, the port is not opened.
    pub(crate) async fn endpoint(
        &self,
        dial: &dyn Dial,
        asked: &Endpoint,
    ) -> Result<Endpoint, TransportError> {
        let (Some(adapter), Some(port)) = (&self.adapter, asked.port()) else {
            return Ok(asked.clone());
        };
        let ports = dial.ports().await;
        let alike = match adapter.find(&ports) {
            Whereabouts::At(path) if is_same_port(port, &path) => return Ok(asked.clone()),
            Whereabouts::At(path) => return Ok(asked.through(&path)),
            Whereabouts::Alike(alike) => alike,
            Whereabouts::Gone => {
                let mut taken = ports.iter().filter(|found| is_same_port(port, &found.path));
                match taken.next() {
                    Some(taken) => vec![taken.path.clone()],
                    // Not listed: the error from opening it is the more precise one.
                    None => return Ok(asked.clone()),
                }
            }
        };
        Err(TransportError::Away {
            place: port.into(),
            alike,
        })
    }
}

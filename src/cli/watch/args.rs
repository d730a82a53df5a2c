//! The command line of `watch`.

use crate::cli::parse::seconds;
use crate::link::PollRates;
use crate::transport::Endpoint;
use std::net::SocketAddr;
use std::time::Duration;
use tokio::time::sleep;

#[derive(Debug, clap::Args)]
pub(crate) struct WatchArgs {
    /// The hand to watch
    #[arg(long, value_name = "URL", value_parser = crate::cli::parse::hand)]
    pub(crate) hand: Endpoint,
    /// Seconds to watch [default: until Ctrl-C]
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    pub(crate) length: Option<Duration>,
    /// Print one JSON object per line
    #[arg(long)]
    pub(crate) json: bool,
    /// Send each sample to this address, one JSON object per datagram, instead of printing it
    #[arg(long, value_name = "ADDRESS:PORT", value_parser = address, requires = "json", conflicts_with = "wire")]
    pub(crate) udp: Option<SocketAddr>,
    /// Print the frames on the wire instead of values
    #[arg(long)]
    pub(crate) wire: bool,
    /// Read as fast as the wire allows, instead of 100 states and 30 touch sweeps a second
    #[arg(long)]
    pub(crate) full_rate: bool,
}

impl WatchArgs {
    /// Polling rates of the link.
    pub(crate) fn rates(&self) -> PollRates {
        if self.full_rate {
            PollRates::FULL
        } else {
            PollRates::default()
        }
    }

    /// Resolves when the time is up; never without a limit.
    pub(crate) async fn over(&self) {
        match self.length {
            Some(length) => sleep(length).await,
            None => std::future::pending().await,
        }
    }
}

fn address(text: &str) -> Result<SocketAddr, String> {
    let address = text.parse().ok();
    let address = address.filter(|address: &SocketAddr| address.port() != 0);
    address.ok_or_else(|| {
        format!(
            "'{text}' is not an address with a port: write it in numbers, such as 127.0.0.1:9870"
        )
    })
}

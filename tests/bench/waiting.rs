//! What a link costs while its adapter is unplugged: it looks for it once a second, in real time.

use crate::clock::wall_and_cpu_ms;
use crate::report::{Aim, Failure, Report};
use futures::FutureExt as _;
use futures::future::BoxFuture;
use handscope::link::{self, Clock, LinkConfig, LinkHandle, PollRates};
use handscope::transport::{
    BoxedWire, Dial, Endpoint, PortFound, SystemDial, TransportError, UsbFound,
};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Long enough for ten looks.
const LENGTH: Duration = Duration::from_secs(10);
/// A hand on a pseudo-terminal is live long before, and its end is noticed.
const PATIENCE: Duration = Duration::from_secs(5);

/// The system's wires, with the pseudo-terminal listed as if it were a USB adapter while it is there.
struct Adapter {
    port: PortFound,
    plugged: AtomicBool,
}

impl Dial for Adapter {
    fn dial(&self, endpoint: &Endpoint) -> BoxFuture<'static, Result<BoxedWire, TransportError>> {
        SystemDial.dial(endpoint)
    }

    fn ports(&self) -> BoxFuture<'static, Vec<PortFound>> {
        let mine = self
            .plugged
            .load(Ordering::Relaxed)
            .then(|| self.port.clone());
        async move {
            let mut listed = SystemDial.ports().await;
            listed.extend(mine);
            listed
        }
        .boxed()
    }
}

#[cfg(not(unix))]
pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    report.absent("CPU while the adapter is unplugged", "no pseudo-terminals")
}

#[cfg(unix)]
pub(crate) fn run(report: &mut Report) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("hand");
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()?;
    let link = runtime.block_on(unplugged(&path))?;
    let ([wall, cpu], ()) = wall_and_cpu_ms(|| {
        runtime.block_on(async { tokio::time::sleep(LENGTH).await });
    });
    drop(link);
    report.row(
        "CPU of a link that waits for its unplugged adapter",
        cpu / wall * 100.0,
        "% core",
        Aim::AtMost(2.0),
    )
}

/// A link that was live and has lost its adapter.
#[cfg(unix)]
async fn unplugged(path: &Path) -> Result<LinkHandle, Failure> {
    use handscope::sim::serve::pty;
    use handscope::sim::{SharedHand, SimConfig, SimHand};
    let hand = SharedHand::new(
        SimHand::new(SimConfig::default()),
        tokio::time::Instant::now(),
    );
    let served = tokio::spawn(pty::serve_rs485(hand, path, None)?);
    let port = PortFound {
        path: std::fs::canonicalize(path)?.display().to_string(),
        usb: Some(UsbFound {
            serial: Some("bench".into()),
            ..UsbFound::default()
        }),
    };
    let dial = Arc::new(Adapter {
        port,
        plugged: AtomicBool::new(true),
    });
    let config = LinkConfig {
        endpoint: format!("rs485:{}", path.display()).parse()?,
        rates: PollRates::default(),
        clock: Clock::start(),
        dial: Arc::clone(&dial) as Arc<dyn Dial>,
        wake: Arc::new(|| ()),
    };
    let (link, _records) = link::open(config, &tokio::runtime::Handle::current());
    until(&link, |link| link.status().state.is_live()).await?;
    dial.plugged.store(false, Ordering::Relaxed);
    served.abort();
    until(&link, |link| !link.status().state.is_live()).await?;
    Ok(link)
}

#[cfg(unix)]
async fn until(link: &LinkHandle, wanted: impl Fn(&LinkHandle) -> bool) -> Result<(), Failure> {
    let end = Instant::now() + PATIENCE;
    while !wanted(link) {
        if Instant::now() > end {
            return Err("the link does not follow the bench".into());
        }
        tokio::time::sleep(Duration::from_millis(5)).await;
    }
    Ok(())
}

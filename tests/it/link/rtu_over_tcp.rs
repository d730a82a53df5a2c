//! Modbus RTU over TCP, as a serial device server carries it: the same hand, the same rules, another wire.

use crate::setup::hand;
use crate::setup::link;
use handscope::link::{DeviceSeries, LinkTrouble};
use handscope::record::LinkState;
use handscope::sim::serve::modbus_rtu;
use handscope::transport::{Dial as _, Endpoint, SystemDial};
use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::TcpListener;
use tokio::time::{Duration, sleep};

#[tokio::test(start_paused = true)]
async fn a_hand_behind_a_device_server_is_read_armed_and_stopped() {
    let shared = hand::plain();
    let behind = shared.clone();
    let dial = link::behind(move |_, far| {
        tokio::spawn(modbus_rtu::serve(behind.clone(), far));
    });
    let mut link = link::connect("rtu+tcp:192.168.11.7:4001", dial);
    link::live(&mut link).await;
    link::pass(&mut link, Duration::from_secs(1)).await;
    assert_eq!(link.status().series, DeviceSeries::Ours);
    assert!(link.stats().state_reads > 20, "{:?}", link.stats());
    link.arm(link::gentle());
    link::until(&mut link, Duration::from_secs(1), |status| {
        status.armed.is_some()
    })
    .await;
    link.stop();
    link::until(&mut link, Duration::from_secs(2), |status| {
        status.state == LinkState::Monitoring && status.armed.is_none()
    })
    .await;
}

#[tokio::test(start_paused = true)]
async fn a_line_that_only_gives_back_what_is_sent_is_called_that() {
    for url in [
        "rtu+tcp:192.168.11.7:4001",
        "rtu:/dev/ttyT0",
        "rs485:/dev/ttyT0",
    ] {
        let dial = link::behind(|_, mut far| {
            tokio::spawn(async move {
                let mut chunk = [0; 300];
                while let Ok(len @ 1..) = far.read(&mut chunk).await {
                    far.write_all(&chunk[..len]).await.unwrap();
                }
            });
        });
        let mut link = link::connect(url, dial);
        let place = url.parse::<Endpoint>().unwrap().place();
        let told = link::until(&mut link, Duration::from_secs(3), |status| {
            status.trouble.is_some()
        });
        let trouble = told.await.trouble;
        assert_eq!(trouble, Some(LinkTrouble::OnlyEcho { place }), "{url}");
    }
}

/// Real sockets on loopback.
#[tokio::test]
async fn the_system_dials_a_device_server() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let port = listener.local_addr().unwrap().port();
    let endpoint: Endpoint = format!("rtu+tcp:127.0.0.1:{port}").parse().unwrap();
    let shared = hand::plain();
    tokio::spawn(async move {
        while let Ok((socket, _)) = listener.accept().await {
            tokio::spawn(modbus_rtu::serve(shared.clone(), socket));
        }
    });
    assert!(SystemDial.dial(&endpoint).await.is_ok());
    let mut config = link::config(&endpoint.to_string(), std::sync::Arc::new(SystemDial));
    config.rates = handscope::link::PollRates::default();
    let mut link = link::open(config);
    let live = |status: &handscope::link::LinkStatus| status.state.is_live();
    link::until(&mut link, Duration::from_secs(10), live).await;
    sleep(Duration::from_millis(300)).await;
    assert!(link.stats().state_reads > 0);
}

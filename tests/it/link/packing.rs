//! Single bytes over Modbus TCP: the link finds out at connect, by reading only, how this hand packs them.

use crate::setup::hand;
use crate::setup::link::{self, Client};
use handscope::hand::register::BytePacking;
use handscope::hand::{Dof, Fault, HandCommand, PerDof, TemperatureReading};
use handscope::link::RequestError;
use handscope::record::Record;
use handscope::sim::serve::modbus_tcp;
use handscope::sim::{ByteWords, Personality, SharedHand};
use handscope::transport::SystemDial;
use std::sync::Arc;
use tokio::net::TcpListener;
use tokio::time::{Duration, timeout};

const SOON: Duration = Duration::from_secs(5);

async fn open(byte_words: ByteWords) -> (Client, SharedHand) {
    let hand = hand::shared(hand::like(Personality {
        byte_words,
        ..Personality::default()
    }));
    for (n, dof) in (0u8..).zip(Dof::ALL) {
        hand.with(|hand, _| hand.warm(dof, f64::from(30 + n)));
    }
    hand.with(|hand, _| hand.inject_fault(Dof::Ring, Fault::Motor));
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let endpoint = format!("tcp:{}", listener.local_addr().unwrap());
    tokio::spawn(modbus_tcp::serve(hand.clone(), listener));
    (link::connect(&endpoint, Arc::new(SystemDial)), hand)
}

async fn check(byte_words: ByteWords, packing: BytePacking) -> Result<(), RequestError> {
    let (mut link, hand) = open(byte_words).await;
    let sample = loop {
        let record = timeout(SOON, link.records.next()).await;
        if let Ok(Some(Record::Reading { sample, .. })) = record
            && sample.temperature.is_some()
        {
            break sample;
        }
    };
    assert_eq!(link.status().quirks.packing, Some(packing));
    let temperatures = sample
        .temperature
        .unwrap()
        .value
        .map(TemperatureReading::raw);
    assert_eq!(temperatures, PerDof::new([30, 31, 32, 33, 34, 35]));
    for (dof, faults) in sample.faults.unwrap().value.iter() {
        assert_eq!(faults.contains(Fault::Motor), dof == Dof::Ring, "{dof:?}");
    }
    assert!(
        hand.with(|hand, _| hand.journal().is_empty()),
        "connecting writes nothing"
    );
    timeout(SOON, link.write(HandCommand::ClearErrors))
        .await
        .unwrap()
}

#[tokio::test]
async fn packed_bytes_are_read_and_written() {
    let cleared = check(ByteWords::Packed, BytePacking::LowFirst).await;
    assert_eq!(cleared, Ok(()));
}

#[tokio::test]
async fn one_byte_a_word_is_read_right_and_never_written() {
    let cleared = check(ByteWords::OnePerWord, BytePacking::OnePerWord).await;
    assert!(
        matches!(cleared, Err(RequestError::Refused { address: 1004, .. })),
        "{cleared:?}"
    );
}

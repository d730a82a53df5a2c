//! `watch --udp`: samples as datagrams to whoever listens, and to nobody.

use crate::setup::busy::unless_busy;
use crate::setup::process::run;
use serde_json::Value;
use std::net::UdpSocket;
use std::time::Duration;

#[test]
fn each_sample_is_a_datagram_of_its_own_and_only_the_statistics_are_printed() {
    unless_busy(|| {
        let viewer = UdpSocket::bind("127.0.0.1:0").unwrap();
        viewer
            .set_read_timeout(Some(Duration::from_millis(200)))
            .unwrap();
        let to = viewer.local_addr().unwrap().to_string();
        let reader = std::thread::spawn(move || {
            let (mut bytes, mut samples): (_, Vec<Value>) = (vec![0; 65_536], Vec::new());
            // The program takes a moment to begin, and then never pauses so long.
            let mut quiet = 0;
            while quiet < 25 {
                match viewer.recv(&mut bytes) {
                    Ok(len) => {
                        samples.push(serde_json::from_slice(&bytes[..len]).unwrap());
                        quiet = 20;
                    }
                    Err(_nothing) => quiet += 1,
                }
            }
            samples
        });
        let lines = run(&[
            "watch", "--hand", "sim:", "--json", "--udp", &to, "--for", "1",
        ])
        .ok()
        .lines();
        let samples = reader.join().unwrap();
        assert_eq!(lines.len(), 1, "{lines:?}");
        let udp = &lines[0]["stats"]["udp"];
        assert_eq!(udp["not_sent"], 0);
        assert_eq!(udp["sent"], samples.len(), "all that was sent arrived");
        assert!(samples.len() > 20, "{}", samples.len());
        assert_eq!(samples[5]["angle"].as_array().unwrap().len(), 6);
        let times: Vec<f64> = samples
            .iter()
            .map(|sample| sample["t_s"].as_f64().unwrap())
            .collect();
        assert!(times.is_sorted(), "{times:?}");
    });
}

#[test]
fn nobody_need_listen_and_what_is_not_taken_is_counted() {
    unless_busy(|| {
        let gone = UdpSocket::bind("127.0.0.1:0").unwrap();
        let to = gone.local_addr().unwrap().to_string();
        drop(gone);
        let lines = run(&[
            "watch", "--hand", "sim:", "--json", "--udp", &to, "--for", "0.5",
        ])
        .ok()
        .lines();
        let stats = &lines[0]["stats"];
        let count = |key: &str| stats["udp"][key].as_u64().unwrap();
        assert!(count("not_sent") > 0, "{stats}");
        let told = count("sent") + count("not_sent");
        assert_eq!(told, stats["state_reads"].as_u64().unwrap());
    });
}

#[test]
fn an_address_that_is_none_is_told_in_one_sentence() {
    unless_busy(|| {
        for (args, words) in [
            (
                &["--json", "--udp", "localhost:9870"][..],
                "such as 127.0.0.1:9870",
            ),
            (&["--json", "--udp", "127.0.0.1"], "such as 127.0.0.1:9870"),
            (
                &["--json", "--udp", "127.0.0.1:0"],
                "such as 127.0.0.1:9870",
            ),
            (&["--udp", "127.0.0.1:9870"], "--json"),
            (&["--json", "--wire", "--udp", "127.0.0.1:9870"], "--wire"),
        ] {
            let all = [&["watch", "--hand", "sim:"], args].concat();
            let ended = run(&all);
            assert_eq!(ended.code, Some(2), "{}", ended.err);
            assert!(ended.err.contains(words), "{}", ended.err);
        }
    });
}

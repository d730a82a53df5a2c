//! Exit status 0 means that there is a result. A gateway that answers for a hand, and a recording without the stretch that was
//! asked for, have none.

use crate::setup::busy::unless_busy;
use crate::setup::gateway::Gateway;
use crate::setup::hand;
use crate::setup::process::{run, start};
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;
use tokio::runtime::Runtime;

const WORDS: &str = "Gateway target device failed to respond (Modbus exception 0B)";

/// A gateway on loopback, its URL, and the runtime that it lives in.
fn gateway() -> (Arc<Gateway>, String, Runtime) {
    let runtime = Runtime::new().unwrap();
    let (gateway, port) = runtime.block_on(async {
        let gateway = Gateway::to(hand::plain());
        let port = gateway.listen().await;
        (gateway, port)
    });
    (gateway, format!("tcp:127.0.0.1:{port}"), runtime)
}

#[test]
fn a_hand_that_was_never_there_is_status_1_in_the_gateways_words() {
    unless_busy(|| {
        let (gateway, url, _runtime) = gateway();
        gateway.says(11);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.mcap");
        let file = file.to_str().unwrap();
        for args in [
            &["watch", "--for", "1", "--hand", &url][..],
            &["watch", "--json", "--hand", &url],
            &["watch", "--wire", "--for", "1", "--hand", &url],
            &["record", "--for", "1", "--out", file, "--hand", &url],
            &["doctor", "--for", "0.5", "--hand", &url],
            &["params", "dump", "--hand", &url],
        ] {
            let ended = run(args);
            let told = format!("{}{}", ended.out, ended.err);
            assert_eq!(ended.code, Some(1), "{args:?}: {told}");
            assert!(told.contains(WORDS), "{args:?}: {told}");
            assert!(!told.contains("all is well"), "{told}");
        }
    });
}

#[test]
fn a_hand_that_goes_is_status_1_and_one_that_was_away_is_told_of() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("b.mcap");
        let file = file.to_str().unwrap();
        let (gateway, url, _runtime) = gateway();
        for (args, returns) in [
            (&["watch", "--for", "6", "--hand", &url][..], true),
            (&["watch", "--for", "4", "--hand", &url], false),
            (
                &["record", "--for", "4", "--out", file, "--hand", &url],
                false,
            ),
            (&["doctor", "--for", "6", "--hand", &url], false),
        ] {
            gateway.says(0);
            let running = start(args);
            sleep(Duration::from_secs(2));
            gateway.says(11);
            if returns {
                sleep(Duration::from_millis(1500));
                gateway.says(0);
            }
            let ended = running.end();
            let told = format!("{}{}", ended.out, ended.err);
            assert!(told.contains(WORDS), "{args:?}: {told}");
            assert_eq!(ended.code, Some(i32::from(!returns)), "{args:?}: {told}");
            assert_eq!(told.contains("answers again"), returns, "{told}");
        }
    });
}

#[test]
fn an_export_of_nothing_is_status_1() {
    unless_busy(|| {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        let (file, table) = (path("c.mcap"), path("c.csv"));
        run(&["record", "--hand", "sim:", "--for", "1", "--out", &file]).ok();
        let cut = ["export", &file, "--csv", "--from", "100", "--to", "200"];
        let ended = run(&[&cut[..], &["--out", &table]].concat());
        assert_eq!(ended.code, Some(1), "{}{}", ended.out, ended.err);
        let whole = run(&["export", &file, "--csv", "--out", &path("whole.csv")]);
        assert_eq!(whole.code, Some(0), "{}{}", whole.out, whole.err);
    });
}

//! Facts that Linux reports about a CAN interface without opening it. Changes nothing; other systems report nothing.

use serde::Serialize;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Interfaces of this kind are CAN (Linux, `if_arp.h`).
const ARPHRD_CAN: u32 = 280;
/// The flag of an interface that is up.
const UP: u32 = 1;
/// Default queue length of an interface, frames; so few overflow as soon as no node acknowledges.
pub const QUEUE_LEN_USUAL: u32 = 10;

/// A CAN interface. A fact that the system does not report is `None`.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct CanFacts {
    /// True if there is a network interface of this name.
    pub exists: bool,
    /// True if it is a CAN interface.
    pub is_can: Option<bool>,
    /// True if it is up.
    pub is_up: Option<bool>,
    /// Capacity of the send queue, frames.
    pub queue_len: Option<u32>,
    /// Bits per second; virtual interfaces have none.
    pub bitrate: Option<u64>,
    /// The controller's error state, such as `ERROR-ACTIVE` or `BUS-OFF`.
    pub state: Option<String>,
}

/// Looks up an interface in the tree under `sys` (`/sys`), and runs `ip` for the rest.
pub fn can_facts(interface: &str, sys: &Path) -> CanFacts {
    let folder = sys.join("class/net").join(interface);
    let text = |name: &str| fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| text(name)?.trim().parse::<u32>().ok();
    let flags = text("flags")
        .and_then(|text| u32::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok());
    let exists = folder.exists();
    let details = exists.then(|| link_details(interface)).flatten();
    let (bitrate, state) = details.as_ref().map_or((None, None), controller);
    CanFacts {
        exists,
        is_can: number("type").map(|kind| kind == ARPHRD_CAN),
        is_up: flags.map(|flags| flags & UP != 0),
        queue_len: number("tx_queue_len"),
        bitrate,
        state,
    }
}

/// Output of `ip`; `None` if it is not installed or lacks JSON output.
fn link_details(interface: &str) -> Option<Value> {
    let args = ["-json", "-details", "link", "show", "dev", interface];
    let printed = Command::new("ip").args(args).output().ok()?;
    serde_json::from_slice(&printed.stdout).ok()
}

/// Bit rate and error state from the output of `ip`.
fn controller(printed: &Value) -> (Option<u64>, Option<String>) {
    let of = |path: &str| printed.pointer(&format!("/0/linkinfo/info_data/{path}"));
    let bitrate = of("bittiming/bitrate").and_then(Value::as_u64);
    let state = of("state").and_then(Value::as_str).map(str::to_owned);
    (bitrate, state)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kind_state_and_queue_are_read_from_the_tree() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path().join("class/net/canX9");
        fs::create_dir_all(&folder).unwrap();
        for (name, text) in [
            ("type", "280\n"),
            ("flags", "0x40080\n"),
            ("tx_queue_len", "10\n"),
        ] {
            fs::write(folder.join(name), text).unwrap();
        }
        let facts = can_facts("canX9", dir.path());
        assert_eq!(
            (facts.exists, facts.is_can, facts.is_up, facts.queue_len),
            (true, Some(true), Some(false), Some(10))
        );
        assert_eq!(can_facts("canX8", dir.path()), CanFacts::default());
    }

    #[test]
    fn bit_rate_and_error_state_come_from_what_ip_prints() {
        let printed = serde_json::json!([{"ifname": "can0", "linkinfo": {"info_kind": "can", "info_data":
            {"state": "ERROR-PASSIVE", "restart_ms": 0, "bittiming": {"bitrate": 1_000_000}}}}]);
        let wanted = (Some(1_000_000), Some("ERROR-PASSIVE".to_owned()));
        assert_eq!(controller(&printed), wanted);
        assert_eq!(controller(&serde_json::json!([])), (None, None));
    }
}

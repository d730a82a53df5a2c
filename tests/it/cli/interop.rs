//! The simulated hand as pymodbus sees it, which we did not write. Where python3 has none this is skipped.

use crate::setup::process::{listen, run, sim_on_rtu, sim_on_tcp};
use crate::setup::skipped::skipped;
use std::process::{Command, Stdio};

/// Reads the id and the angles, closes the index finger half, reads the target back, clears errors, and asks for what
/// is not there.
const CLIENT: &str = r#"
import sys
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
kind, place, unit = sys.argv[1], sys.argv[2], int(sys.argv[3])
if kind == "rtu":
    client = ModbusSerialClient(place, baudrate=115200, timeout=5)
else:
    host, port = place.rsplit(":", 1)
    client = ModbusTcpClient(host, port=int(port), timeout=5)
assert client.connect()
def whole(reply):
    assert not reply.isError(), reply
    return reply
print(whole(client.read_holding_registers(1546, count=6, device_id=unit)).registers)
whole(client.write_registers(1486, [0xFFFF, 0xFFFF, 0xFFFF, 500, 0xFFFF, 0xFFFF], device_id=unit))
print(whole(client.read_holding_registers(1486, count=6, device_id=unit)).registers)
whole(client.write_register(1004, 1, device_id=unit))
print(len(whole(client.read_holding_registers(3000, count=125, device_id=unit)).registers))
print(client.read_holding_registers(9000, count=2, device_id=unit).isError())
client.close()
"#;

fn pymodbus_is_there() -> bool {
    let asked = Command::new("python3")
        .args([
            "-c",
            "import serial; from pymodbus.client import ModbusSerialClient, ModbusTcpClient",
        ])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    asked.is_ok_and(|status| status.success())
}

/// Lets pymodbus talk to the hand, then compares with what we read ourselves.
fn talks(kind: &str, place: &str, unit: &str, hand: &str) {
    let mut command = Command::new("python3");
    command
        .args(["-c", CLIENT, kind, place, unit])
        .stdin(Stdio::null());
    let out = listen(command).end().ok().out;
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines[0], "[1000, 1000, 1000, 1000, 1000, 1000]");
    let read = || run(&["read", "ANGLE_SET", "ANGLE_ACT", "--json", "--hand", hand]);
    let mut ours = read().ok().lines().remove(0);
    // A drive needs its dead time before it moves.
    for _ in 0..50 {
        if ours["ANGLE_ACT"][3].as_i64().unwrap() < 1000 {
            break;
        }
        ours = read().ok().lines().remove(0);
    }
    let theirs: Vec<i64> = serde_json::from_str(lines[1]).unwrap();
    assert_eq!(theirs[3], 500);
    assert_eq!(ours["ANGLE_SET"][3], 500);
    assert!(ours["ANGLE_ACT"][3].as_i64().unwrap() < 1000, "{ours}");
    assert_eq!(lines[2..], ["125", "True"]);
}

#[test]
fn pymodbus_reads_and_moves_the_hand_over_rtu_and_tcp() {
    if !pymodbus_is_there() {
        skipped("pymodbus", "python3 has no pymodbus with pyserial");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("hand");
    let (_sim, hand) = sim_on_rtu(&link, &[]);
    talks("rtu", link.to_str().unwrap(), "1", &hand);
    let (_sim, hand) = sim_on_tcp(&[]);
    talks("tcp", hand.strip_prefix("tcp:").unwrap(), "255", &hand);
}

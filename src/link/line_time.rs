//! What one read costs on the line alone, were hand and adapter infinitely quick. Knows no wire that is open.

use crate::transport::Endpoint;
use crate::transport::endpoint::DEFAULT_BITRATE;
use std::time::Duration;

/// Bits of a byte on a serial line: start, eight, stop.
const BITS: u64 = 10;
/// Bytes around the data: request and frame of the reply (manual 2.2.1, 2.4.1).
const RS485_AROUND: u64 = 9 + 8;
const RTU_AROUND: u64 = 8 + 5;
/// Silence between two RTU frames: 3.5 characters, in half characters.
const RTU_GAP_HALVES: u64 = 7;
/// Above this baud that silence does not shrink any more (Modbus over serial line 1.02, 2.5.1.1).
const RTU_FIXED_ABOVE: u32 = 19_200;
const RTU_FIXED_GAP: Duration = Duration::from_micros(1750);
/// Bits of a CAN frame with a long identifier around its data, without stuffing, with the pause behind it.
const CAN_AROUND: u64 = 67;
/// Data bytes of one CAN frame.
const CAN_DATA: u64 = 8;

/// The time in which request and reply of a read of so many bytes pass; `None` where there is no line of a known speed.
#[must_use]
pub fn line_time(endpoint: &Endpoint, bytes: u16) -> Option<Duration> {
    let bytes = u64::from(bytes);
    match endpoint {
        Endpoint::Sim { .. } | Endpoint::Tcp { .. } => None,
        Endpoint::Rs485(line) => Some(bits((bytes + RS485_AROUND) * BITS, line.baud)),
        Endpoint::Rtu(line) => {
            let gap = if line.baud > RTU_FIXED_ABOVE {
                RTU_FIXED_GAP
            } else {
                bits(RTU_GAP_HALVES * BITS, line.baud) / 2
            };
            Some(bits((bytes + RTU_AROUND) * BITS, line.baud) + gap)
        }
        // Manual: 2.3 gives the rate as delivered; that of an interface is set outside of this program.
        Endpoint::Can { .. } => Some(can(bytes, DEFAULT_BITRATE)),
        Endpoint::Slcan { bitrate, .. } => Some(can(bytes, *bitrate)),
    }
}

fn can(bytes: u64, bitrate: u32) -> Duration {
    let frames = bytes.div_ceil(CAN_DATA);
    let asked = frames * (CAN_AROUND + 8);
    let answered = frames * CAN_AROUND + bytes * 8;
    bits(asked + answered, bitrate)
}

fn bits(bits: u64, a_second: u32) -> Duration {
    Duration::from_micros(bits * 1_000_000 / u64::from(a_second.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_those_of_the_frames_on_the_line() {
        for (url, bytes, micros) in [
            // 20 bytes of reply to 9 of request, ten bits each.
            ("rs485:x?baud=115200", 12, Some(2_517)),
            ("rs485:x?baud=921600", 232, Some(2_701)),
            ("rtu:x?baud=115200", 12, Some(2_170 + 1_750)),
            ("rtu:x?baud=9600", 12, Some(26_041 + 3_645)),
            ("can:can0", 8, Some(206)),
            ("slcan:x?bitrate=500000", 12, Some(760)),
            ("tcp:127.0.0.1", 12, None),
        ] {
            let endpoint = url.parse();
            let time =
                endpoint.map(|endpoint| line_time(&endpoint, bytes).map(|time| time.as_micros()));
            assert_eq!(time, Ok(micros), "{url}");
        }
    }
}

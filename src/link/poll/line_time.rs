//! Time of one read on the line alone, without hand and adapter. Needs no open wire.

use crate::link::poll::cost::WireCost;
use crate::transport::Endpoint;
use std::time::Duration;

/// Time for request and reply of a read of this many bytes; `None` if the speed of the line is unknown.
pub fn line_time(endpoint: &Endpoint, bytes: u16) -> Option<Duration> {
    let cost = WireCost::of(endpoint)?;
    Some(cost.read(bytes, Duration::ZERO))
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
            ("can:can0", 8, Some(240)),
            ("slcan:x?bitrate=500000", 12, Some(960)),
            // Two packets of 21 bytes per piece.
            ("usbcan:x", 12, Some(2 * (240 + 3_645))),
            ("tcp:127.0.0.1", 12, None),
        ] {
            let endpoint = url.parse();
            let time =
                endpoint.map(|endpoint| line_time(&endpoint, bytes).map(|time| time.as_micros()));
            let near = time.map(|time| match (time, micros) {
                (Some(time), Some(micros)) => time.abs_diff(micros) <= 2,
                (time, micros) => time == micros,
            });
            assert_eq!(near, Ok(true), "{url}");
        }
    }
}

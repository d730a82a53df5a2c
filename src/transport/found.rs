//! Serial ports that the system lists.

use serde::Serialize;
use std::fmt;

/// Vendor and product of USB adapters that bring CAN frames as text: CANable and its likes, CANtact, Lawicel's CANUSB.
const CAN_ADAPTERS: [(u16, u16); 4] = [
    (0x16D0, 0x117E),
    (0xAD50, 0x60C4),
    (0x04D8, 0x000A),
    (0x0403, 0xFFA8),
];
/// What such adapters call themselves.
const CAN_NAMES: [&str; 5] = ["slcan", "canable", "cantact", "canusb", "usbtin"];

/// A USB adapter.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct UsbFound {
    /// USB vendor id.
    pub vendor_id: u16,
    /// USB product id.
    pub product_id: u16,
    /// Serial number, by which an adapter is known again under another path.
    pub serial: Option<String>,
    /// Maker's name.
    pub maker: Option<String>,
    /// Product's name.
    pub product: Option<String>,
    /// Place on the bus and interface, such as `1-2:1.0`, where the system tells (Linux).
    pub location: Option<String>,
    /// How long it may keep what it got, milliseconds, where its driver tells (Linux).
    #[serde(skip)]
    pub latency_timer_ms: Option<u16>,
}

/// Maker, product and serial number as far as they are told, and the ids.
impl fmt::Display for UsbFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = [&self.maker, &self.product, &self.serial].into_iter();
        for name in named.flatten() {
            write!(f, "{name} ")?;
        }
        write!(f, "USB {:04x}:{:04x}", self.vendor_id, self.product_id)
    }
}

impl UsbFound {
    /// True if it looks like an adapter that brings CAN frames as text, not a serial line.
    pub fn looks_like_can(&self) -> bool {
        let named = [&self.maker, &self.product].into_iter().flatten();
        let mut named = named.map(|name| name.to_lowercase());
        CAN_ADAPTERS.contains(&(self.vendor_id, self.product_id))
            || named.any(|name| CAN_NAMES.iter().any(|can| name.contains(can)))
    }
}

/// A serial port that the system lists.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortFound {
    /// Path or name.
    pub path: String,
    /// What it is, if it is on USB.
    pub usb: Option<UsbFound>,
}

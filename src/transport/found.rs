//! Serial ports that the system lists.

use serde::Serialize;
use std::fmt;

/// Vendor and product of USB adapters that carry CAN frames as text: CANable and similar, CANtact, Lawicel's CANUSB.
const CAN_ADAPTERS: [(u16, u16); 4] = [
    (0x16D0, 0x117E),
    (0xAD50, 0x60C4),
    (0x04D8, 0x000A),
    (0x0403, 0xFFA8),
];
/// Parts of the names of such adapters.
const CAN_NAMES: [&str; 5] = ["slcan", "canable", "cantact", "canusb", "usbtin"];

/// A USB adapter.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct UsbFound {
    /// USB vendor id.
    pub vendor_id: u16,
    /// USB product id.
    pub product_id: u16,
    /// Serial number, which identifies the adapter under another path.
    pub serial: Option<String>,
    /// Maker's name.
    pub maker: Option<String>,
    /// Product's name.
    pub product: Option<String>,
    /// Bus position and interface, such as `1-2:1.0`; `None` if the system does not report it (Linux does).
    pub location: Option<String>,
    /// Latency timer in milliseconds; `None` if the driver does not report it (Linux only).
    #[serde(skip)]
    pub latency_timer_ms: Option<u16>,
}

/// Maker, product and serial number if known, and the ids.
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
    /// True if it looks like an adapter that carries CAN frames as text, not a serial line.
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
    /// The USB adapter, if it is one.
    pub usb: Option<UsbFound>,
}

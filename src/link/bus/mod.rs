//! One request and its reply, over the endpoint's protocol. No polling, no retries.
pub(crate) mod can;
pub(crate) mod can_port;
pub(crate) mod client;
pub(crate) mod echo;
pub(crate) mod error;
pub(crate) mod filter;
pub(crate) mod late_replies;
pub(crate) mod latency;
pub(crate) mod modbus;
pub(crate) mod modbus_rtu;
pub(crate) mod modbus_tcp;
pub(crate) mod packing;
pub(crate) mod rs485;
pub(crate) mod rtu_line;
pub(crate) mod slowness;

pub(crate) use crate::link::bus::client::{Bus, ResultFrame};
pub(crate) use crate::link::bus::error::{BusCounts, BusError, Bytes};

use crate::link::bus::can::Can;
use crate::link::bus::late_replies::LateReplies;
use crate::link::bus::modbus_rtu::ModbusRtu;
use crate::link::bus::modbus_tcp::ModbusTcp;
use crate::link::bus::rs485::Rs485;
use crate::link::clock::Clock;
use crate::transport::{BoxedWire, Endpoint};

/// Creates the endpoint's protocol client on an open wire. `late`: requests that earlier wires to this hand left unanswered.
pub(crate) fn on_wire(
    endpoint: &Endpoint,
    wire: BoxedWire,
    late: LateReplies,
    clock: Clock,
) -> Box<dyn Bus> {
    match endpoint {
        Endpoint::Sim { .. } | Endpoint::Rs485(_) => {
            Box::new(Rs485::new(wire, endpoint, late, clock))
        }
        Endpoint::Tcp { unit, .. } => Box::new(ModbusTcp::new(wire, *unit, endpoint)),
        Endpoint::Rtu(line) | Endpoint::RtuTcp(line) => {
            Box::new(ModbusRtu::new(wire, line.baud, endpoint, late, clock))
        }
        Endpoint::Can { .. } | Endpoint::Slcan { .. } | Endpoint::UsbCan { .. } => {
            Box::new(Can::new(wire, endpoint, late, clock))
        }
    }
}

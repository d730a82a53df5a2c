//! Copies the body's state to the live registers (manual 2.6.14 to 2.6.20). Decides nothing.

use crate::hand::register::{ANGLE_ACT, CURRENT, ERROR, FORCE_ACT, POS_ACT, STATUS, TEMP};
use crate::hand::{Dof, Finger};
use crate::sim::body::Body;
use crate::sim::held::HeldObject;
use crate::sim::memory::Memory;
use crate::sim::number;
use crate::sim::touch::Press;

/// Largest force that the sensor reports in either direction, g (manual 2.6.16).
const FORCE_SHOWN_G: f64 = 4000.0;

/// Index of the joint within a register group.
pub(crate) fn element(dof: Dof) -> u16 {
    u16::try_from(dof.index()).unwrap_or_default()
}

/// Writes position, angle, force, current, faults, status and temperature of all drives to the memory.
pub(crate) fn publish_drives(memory: &mut Memory, body: &Body) {
    for (dof, drive) in body.drives().iter() {
        let at = element(dof);
        let force = body.force_g(dof).clamp(-FORCE_SHOWN_G, FORCE_SHOWN_G);
        memory.put_short(&POS_ACT, at, number::short(drive.motor_position()));
        memory.put_short(&ANGLE_ACT, at, number::short(drive.angle()));
        memory.put_short(&FORCE_ACT, at, number::short(force));
        memory.put_short(&CURRENT, at, number::short(drive.current_ma()));
        memory.put_byte(ERROR.address + at, drive.faults().raw());
        memory.put_byte(STATUS.address + at, drive.status().raw());
        memory.put_byte(TEMP.address + at, drive.read_temperature());
    }
}

/// Load on a fingertip and its distance from the object.
pub(crate) fn press(body: &Body, held: &HeldObject, finger: Finger) -> Press {
    let contact = held.finger(finger);
    Press {
        force_g: body.fingertip_g(finger),
        tangential_g: contact.tangential_g,
        slid_mm: contact.slid_mm,
        gap: body.drives()[finger.bend()].gap(),
    }
}

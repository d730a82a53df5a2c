//! One fuzz target for each function of `targets.rs`. What must hold stands there.

use handscope_fuzz::{OTHERS, State, WIRES};

fn check(name: &str) {
    let mut all = WIRES.iter().chain(&OTHERS);
    let (_, target) = all
        .find(|(known, _)| *known == name)
        .expect("a known target");
    bolero::check!().for_each(|bytes: &[u8]| target(&mut State::default(), bytes));
}

macro_rules! targets {
    ($($name:ident)*) => {
        $(#[test] fn $name() { check(stringify!($name)); })*

        #[test]
        fn every_target_is_here() {
            let here = [$(stringify!($name)),*];
            let there: Vec<&str> = WIRES.iter().chain(&OTHERS).map(|(name, _)| *name).collect();
            assert_eq!(here[..], there[..]);
        }
    };
}

targets! {
    rs485_client rs485_device rtu_client modbus_pdu mbap can_record can_split slcan_answers slcan_commands
    usbcan_packets tap_rs485 tap_rtu tap_tcp tap_can tap_slcan tap_usbcan words tactile values endpoint settings
    parameter_file pose_file exhibit_file exhibit_day recording_file session_about csv_values
}

//! Choices that the manual leaves open, as switches. Only the simulated hand has them.

use std::time::Duration;

/// Description of one switch, for the user.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Switch {
    /// Name.
    pub name: &'static str,
    /// Description.
    pub about: &'static str,
    /// Values; the first is that of a hand without quirks.
    pub values: &'static [&'static str],
}

/// Error for an unknown switch or value.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSwitch {
    /// No switch has this name.
    #[error("there is no quirk '{name}'")]
    Name {
        /// Name that was given.
        name: String,
    },
    /// The switch has no such value.
    #[error("'{value}' is not a value of the quirk '{name}': choose {known}")]
    Value {
        /// The switch.
        name: &'static str,
        /// Value that was given.
        value: String,
        known: String,
    },
}

/// Declares each switch once: its type, its names, and its field in [`Personality`] and entry in [`SWITCHES`].
macro_rules! switches {
    ($($about:literal $field:ident $spelled:literal $Type:ident {
        $first_about:literal $First:ident $first:literal,
        $($value_about:literal $Value:ident $value:literal),+ $(,)?
    })+) => {
        $(
            #[doc = $about]
            #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
            pub enum $Type {
                #[doc = $first_about]
                #[default]
                $First,
                $(#[doc = $value_about] $Value,)+
            }
        )+

        pub const SWITCHES: &[Switch] = &[
            $(Switch { name: $spelled, about: $about, values: &[$first, $($value),+] },)+
        ];

        /// One choice for each point that the manual leaves open.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
        pub struct Personality {
            $(#[doc = $about] pub $field: $Type,)+
            /// If true, 1558 to 1565 hold the time of the read in microseconds, low byte first; for tests.
            pub stamp_gap: bool,
            /// Delay from the end of a request to the reply, in addition to [`Turnaround`].
            pub turnaround: Duration,
        }

        impl Personality {
            /// Sets one switch to a value, both as named in [`SWITCHES`].
            ///
            /// # Errors
            /// [`NoSwitch`] if there is no such switch or no such value.
            pub fn set(&mut self, name: &str, value: &str) -> Result<(), NoSwitch> {
                match (name, value) {
                    $(
                        ($spelled, $first) => self.$field = $Type::$First,
                        $(($spelled, $value) => self.$field = $Type::$Value,)+
                    )+
                    _ => return Err(no_switch(name, value)),
                }
                Ok(())
            }
        }
    };
}

fn no_switch(name: &str, value: &str) -> NoSwitch {
    match SWITCHES.iter().find(|switch| switch.name == name) {
        None => NoSwitch::Name { name: name.into() },
        Some(switch) => NoSwitch::Value {
            name: switch.name,
            value: value.into(),
            known: switch.values.join(", "),
        },
    }
}

switches! {
    "-1 in ANGLE_SET while the joint moves (manual 2.6.11: no action)."
    minus_one_mid_move "minus-one" MinusOne {
        "The joint continues to its previous target." Ignore "ignore",
        "The joint stops where it is." Freeze "freeze",
        "Taken for 65535, which is clamped to 1000." Clamp "clamp",
    }
    "SPEED_SET 0."
    speed_zero "speed-zero" SpeedZero {
        "The joint does not move." Freeze "freeze",
        "The joint creeps." Slowest "slowest",
        "The previous speed stays in effect." Ignored "ignored",
    }
    "What a drive compares FORCE_SET with (manual 2.6.12: FORCE_ACT)."
    force_compared "force-compared" ForceCompared {
        "FORCE_ACT as read: what it reads without load counts, and a threshold below that keeps the joint from closing." AsRead "as-read",
        "The load alone." Load "load",
    }
    "A write outside an element's range."
    out_of_range "out-of-range" OutOfRangeWrite {
        "Acknowledged, without effect." Drop "drop",
        "Taken as the nearest allowed value." Clamp "clamp",
        "Refused: an exception over Modbus, silence elsewhere." Exception "exception",
        "Taken modulo the range." Wrap "wrap",
    }
    "A write to a register that can only be read."
    read_only "read-only" ReadOnlyWrite {
        "Acknowledged, without effect." Ack "ack",
        "Refused: an exception over Modbus, an acknowledgement of 0 elsewhere." Nak "nak",
        "No answer." Nothing "nothing",
    }
    "The acknowledgement of a change of HAND_ID or REDU_RATIO."
    change_ack "change-ack" ChangeAck {
        "Carries the new id." New "new",
        "Carries the old id." Old "old",
        "None comes." None "none",
    }
    "When a new HAND_ID acts."
    id_effect "id-effect" Effect {
        "At once." Now "now",
        "At the next SAVE." AfterSave "after-save",
        "At the next power-up, if saved." AfterPower "after-power",
    }
    "When a new REDU_RATIO acts."
    baud_effect "baud-effect" BaudEffect {
        "At the next power-up, if saved." AfterPower "after-power",
        "At once." Now "now",
        "At the next SAVE." AfterSave "after-save",
    }
    "The second frame after SAVE on a serial line (manual 2.2.2)."
    save_frame "save-result" SaveAnswer {
        "Command byte 0x12, success, after a second." Command12 "command-12",
        "Command byte 0x11, success, after a second." Command11 "command-11",
        "Success after five seconds." Late "late",
        "The parameters are saved, but no frame follows." Never "never",
        "Success, and the same again." Twice "twice",
        "Nothing is saved, and the frame says so." Failed "failed",
    }
    "When a SAVE is in flash."
    flash "flash" FlashWrite {
        "At once." AtOnce "at-once",
        "After a second, if the power stays that long." Slowly "slowly",
    }
    "A write to DEFAULT_SPEED_SET or DEFAULT_FORCE_SET."
    defaults "defaults" DefaultsWrite {
        "Is accepted." Take "take",
        "Is acknowledged, without effect." Drop "drop",
        "Is acknowledged, and limited to 500." Clamp "clamp",
        "Refused: an exception over Modbus, silence elsewhere." Exception "exception",
    }
    "How single bytes become Modbus words."
    byte_words "byte-words" ByteWords {
        "Two a word, low byte first." Packed "low-first",
        "Two a word, high byte first." HighFirst "high-first",
        "One a word where a read begins at ERROR, STATUS or TEMP, as one real hand was seen to do." OnePerWord "one-per-word",
    }
    "A Modbus address inside a group."
    inner_address "inner-address" InnerAddress {
        "Is a byte address." Byte "byte",
        "Counts registers of two bytes from the group's base." Index "index",
        "Is refused." Exception "exception",
    }
    "A read longer than the protocol allows."
    long_read "long-read" LongRead {
        "Refused: an exception over Modbus, silence elsewhere." Exception "exception",
        "Answered as far as allowed." Truncate "truncate",
        "No answer." Silence "silence",
    }
    "The unused addresses 1558 to 1581."
    gap "gap" GapAnswer {
        "Read as zeros." Through "through",
        "Refused." Refused "refused",
    }
    "Reads past 4095, where the resistive sister hand keeps its fingertips; from 3290 on this one holds zeros."
    beyond "beyond" Beyond {
        "Refused: an exception over Modbus, silence elsewhere." Refused "refused",
        "Read as zeros, up to 65535." Zeros "zeros",
    }
    "Ids 0 and 255 on RS485, which the maker's demos use (manual 2.6.1: 1 to 254)."
    any_id "any-id" AnyId {
        "Address no hand." Silent "silent",
        "Mean every hand, which answers with its own id." Answered "answered",
    }
    "From GESTURE_FORCE_CLB to the new zero (manual 2.6.6 names no time; field reports say 2 to 6 s)."
    calibration "calibration" Calibration {
        "Six seconds." SixSeconds "6s",
        "Two seconds." TwoSeconds "2s",
    }
    "CLEAR_ERROR, to a joint that was on its way (manual 2.6.3)."
    clear_error "clear-error" ClearError {
        "The joint stays where it is." Stay "stay",
        "The joint continues to its target." Resume "resume",
    }
    "The frame of a Modbus RTU reply."
    rtu_reply "rtu-reply" RtuReplyGap {
        "Comes in one piece." Whole "whole",
        "Has a pause of two milliseconds inside." Split "split",
    }
    "The unit id in a Modbus TCP reply."
    reply_unit "reply-unit" ReplyUnit {
        "That of the request." Echo "echo",
        "255." Ff "ff",
        "0." Zero "zero",
    }
    "The reply to Modbus function 06 (manual 2.4.2 prints zeros)."
    single_reply "single-reply" SingleReply {
        "Repeats the request." Echo "echo",
        "Holds zeros." Zeros "zeros",
    }
    "Clients of the Modbus TCP server at one time."
    tcp_clients "tcp-clients" TcpClients {
        "Many." Many "many",
        "One; others are turned away." One "one",
        "One; a newer one ends the older." Newest "newest",
    }
    "The check of a fingertip's block."
    tactile_check "tactile-check" TactileCheck {
        "Sum of the block's first 54 bytes." Block "block",
        "Sum that counts the sensor's own header too." Sensor "sensor",
        "Zero." Zero "zero",
    }
    "How long the hand thinks before it answers."
    thinking "thinking" Turnaround {
        "Not at all, or as long as was given." Given "given",
        "3 to 15 ms." Usual "3-15ms",
        "3 to 15 ms, and half a second once in 256." Rarely "rare-500ms",
    }
    "Replies that come twice."
    doubles "doubles" Doubles {
        "None." Never "never",
        "One in 16." Some "some",
    }
    "The 24 V supply."
    power "power" Power {
        "Stays." Stays "stays",
        "Is gone for half a second after three seconds." Cut "cut",
    }
}

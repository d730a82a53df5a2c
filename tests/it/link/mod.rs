//! The link to a hand over every wire: what it asks, what it takes for true, and how it ends. Virtual time nearly everywhere.

mod back;
mod can;
#[cfg(target_os = "linux")]
mod can_vm;
mod ends;
mod faults;
mod frozen;
mod gateway;
mod identify;
mod other_series;
mod others;
mod packing;
mod rates;
mod rtu_over_tcp;
mod scan;
mod settings;
mod several_hands;
mod stall;
mod stop;
mod tap;

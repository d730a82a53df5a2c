//! The command line as scripts meet it: the real program in processes of its own, on loopback and pseudo-terminals only.

#[cfg(unix)]
mod can;
mod check;
mod consent;
#[cfg(unix)]
mod cut_short;
mod datagrams;
#[cfg(unix)]
mod doctor;
#[cfg(unix)]
mod doors;
#[cfg(unix)]
mod exports;
#[cfg(target_os = "linux")]
mod follow;
mod grip;
mod inputs;
#[cfg(unix)]
mod interop;
#[cfg(unix)]
mod loss;
#[cfg(unix)]
mod params;
mod pictures;
#[cfg(unix)]
mod quirks;
#[cfg(unix)]
mod recordings;
#[cfg(unix)]
mod scan;
#[cfg(unix)]
mod several;
#[cfg(unix)]
mod trial;
#[cfg(unix)]
mod tune;
mod tune_close;
mod usage;
#[cfg(unix)]
mod web_page;
mod wire;
#[cfg(unix)]
mod wires;

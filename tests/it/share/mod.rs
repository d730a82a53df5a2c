//! One hand for several programs, as those programs meet it.

#[cfg(unix)]
mod cli;
mod clients;
#[cfg(target_os = "linux")]
mod dds;
#[cfg(target_os = "linux")]
mod fleet;
mod foxglove;
mod lab;
mod place;
mod reads;
#[cfg(unix)]
mod stdio;
mod writes;

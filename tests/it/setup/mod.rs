//! How a test puts up what it tries: simulated hands on wires, links, the program with its window, and the real program as a
//! process. Claims nothing.

pub(crate) mod between;
pub(crate) mod body;
pub(crate) mod busy;
pub(crate) mod device;
pub(crate) mod faulty;
pub(crate) mod gateway;
pub(crate) mod grasp;
pub(crate) mod hand;
pub(crate) mod line;
pub(crate) mod link;
pub(crate) mod process;
pub(crate) mod program;
pub(crate) mod recorded;
#[cfg(unix)]
pub(crate) mod referee;
pub(crate) mod shape;
pub(crate) mod skipped;
pub(crate) mod soak;
pub(crate) mod states;
pub(crate) mod time;
pub(crate) mod view;
pub(crate) mod window;

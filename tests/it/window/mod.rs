//! The real program behind its real window, driven by labels against the simulated hand over the real link. Virtual time.

mod cards;
mod checkup;
mod compare;
mod device;
mod exhibit;
mod faults;
mod grip_size;
mod hands;
mod inputs;
mod joints;
mod keys;
mod layout;
mod mirror;
mod motion;
mod overshoot;
mod plots;
mod poses;
mod recordings;
mod scan;
mod search;
mod stage;
mod start;
mod touch;
mod traffic;
mod trouble;
mod tune;

//! A hand that strangers may touch: what stands in the file of an exhibition, the PIN, heat, and what happens when. Pure; sends
//! nothing and reads no clock.

pub mod file;
pub mod heat;
pub mod pin;
pub mod plan;
pub mod report;
pub mod run;

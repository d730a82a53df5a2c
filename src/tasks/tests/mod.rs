//! Requests that tasks send to a hand, and their reports, on a hand that is only a memory and a script.

mod place;
mod reach;
mod rest;
mod rows;

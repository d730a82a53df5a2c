//! What tasks ask of a hand and what they say of it, on a hand that is only a memory and a script.

mod booth;
mod drive;
mod exhibit;
mod fake;
mod grip;
mod move_to;
mod place;
mod play;
mod rest;
mod rows;
mod series;

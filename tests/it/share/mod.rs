//! One hand for several programs, as those programs meet it.

#[cfg(unix)]
mod cli;
mod clients;
mod foxglove;
mod place;
mod reads;
mod writes;

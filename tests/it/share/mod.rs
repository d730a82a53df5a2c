//! One hand for several programs, as those programs meet it.

mod clients;
mod place;
mod reads;
mod writes;

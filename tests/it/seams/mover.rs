//! What moves the hand of a cell, as the columns of the table see it.

use crate::seams::hand::SeamHand;
use nix::sys::signal::Signal;
use std::sync::Arc;
use std::time::Duration;

/// Something that is moving a hand. What cannot befall it, nobody asks of it.
pub(super) trait Mover {
    fn hand(&self) -> &Arc<SeamHand>;

    /// Time goes by.
    fn pass(&mut self, step: Duration);

    /// Everything that a person was told until now.
    fn said(&mut self) -> String;

    /// A person stops the hand: STOP, or Ctrl-C.
    fn stop(&mut self);

    /// The same, in a message of which little else is right.
    fn stop_oddly(&mut self) {
        panic!("its stop has one spelling");
    }

    /// What moves the hand may not, or may again.
    fn grant(&mut self, _may: bool) {
        panic!("nobody grants it control");
    }

    /// True once its process is over.
    fn has_ended(&mut self) -> bool {
        false
    }

    /// The computer sleeps; the hand does not.
    fn sleep(&mut self, length: Duration);

    /// Its window draws and asks nothing any more.
    fn freeze(&mut self) {
        panic!("it has no window");
    }

    /// A person closes its window.
    fn close(&mut self) {
        panic!("it has no window");
    }

    /// Its process gets this signal.
    fn signal(&mut self, _signal: Signal) {
        panic!("it is no process");
    }

    /// Nobody reads its standard output any more.
    fn lose_reader(&mut self) {
        panic!("it is no process");
    }

    /// Whatever reads its output takes no more of it, and no more fits.
    fn stop_reading(&mut self) {
        panic!("it is no process");
    }

    /// The process that watches over it gets this signal.
    fn signal_holder(&mut self, _signal: Signal) {
        panic!("it is no process");
    }

    /// Its process can open nothing more.
    fn exhaust_descriptors(&mut self) {
        panic!("it is no process");
    }

    /// Another Handscope begins to move the same hand, or tries to. What it says is added to what is said here.
    fn second_handscope(&mut self);
}

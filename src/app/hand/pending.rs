//! A request of a person whose end is awaited.

use crate::app::notices::Asked;
use crate::hand::PerDof;
use crate::link::RequestError;
use crate::store::Job;

/// How a request ended.
pub(crate) type RequestEnd = Result<Option<PerDof<i16>>, RequestError>;

/// A request whose end is awaited.
#[derive(Debug)]
pub(crate) struct Pending {
    pub(crate) what: Asked,
    pub(crate) end: Option<Job<RequestEnd>>,
}

//! Stand-in.
use crate::hand::Moment;
/// Level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// i
    Info,
    /// w
    Warning,
    /// e
    Error,
}
/// Kind.
#[derive(Debug, Clone, PartialEq)]
pub enum NoticeKind {
    /// x
    Text(String),
}
/// Notice.
#[derive(Debug, Clone, PartialEq)]
pub struct Notice {
    /// id
    pub id: u64,
    /// at
    pub at: Moment,
    /// level
    pub level: Level,
    /// what
    pub what: NoticeKind,
}
/// All.
#[derive(Debug, Clone, Default)]
pub struct Notices(pub Vec<Notice>);
impl Notices {
    /// All.
    pub fn iter(&self) -> impl Iterator<Item = &Notice> {
        self.0.iter()
    }
}

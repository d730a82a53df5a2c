//! Replaces what names the user and the computer in texts: the home folder, the user's name, and the computer's. Pure but for the
//! list of names.

use crate::share::fleet;
use directories::UserDirs;

/// Stand-ins of the home folder, the user and the computer.
pub(super) const HOME: &str = "~";
pub(super) const USER: &str = "USER";
pub(super) const COMPUTER: &str = "COMPUTER";
/// Shorter names are initials that occur by chance.
const NAME_LEN_MIN: usize = 2;

/// The texts to replace, each with its stand-in, the longest first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Redaction(Vec<(String, &'static str)>);

impl Redaction {
    /// Those of this user on this computer.
    pub(super) fn of_this_user() -> Self {
        let home = UserDirs::new().map(|user| user.home_dir().to_owned());
        let real = home.as_ref().and_then(|home| home.canonicalize().ok());
        let homes = home.iter().chain(&real);
        let homes = homes.map(|home| home.display().to_string()).collect();
        let host = fleet::host();
        // A full name contains that of the network.
        let short = host.split('.').next().unwrap_or_default().to_owned();
        let hosts = vec![host, short];
        Self::of(homes, user_names(), hosts)
    }

    fn of(homes: Vec<String>, users: Vec<String>, hosts: Vec<String>) -> Self {
        let homes = homes.into_iter().map(|text| (text, HOME));
        let users = users.into_iter().map(|text| (text, USER));
        let hosts = hosts.into_iter().map(|text| (text, COMPUTER));
        let names = users.chain(hosts);
        let names = names.filter(|(text, _)| text.len() >= NAME_LEN_MIN);
        // The root of the file system is part of every path.
        let homes = homes.filter(|(text, _)| text.len() > 1);
        let mut all: Vec<(String, &str)> = homes.chain(names).collect();
        // A name may be part of a longer one, such as a first name.
        all.sort_by_key(|(text, _)| std::cmp::Reverse(text.len()));
        Self(all)
    }

    /// The text without them, where they stand as words of their own, in any case of letters.
    pub(super) fn text(&self, text: &str) -> String {
        let replaced = |text: String, (word, by): &(String, &str)| replace(&text, word, by);
        self.0.iter().fold(text.to_owned(), replaced)
    }
}

/// Names of the user: of the account that runs the program, and as the environment has it.
fn user_names() -> Vec<String> {
    let variables = ["USER", "LOGNAME", "USERNAME", "SUDO_USER"];
    let mut names: Vec<String> = variables.into_iter().flat_map(std::env::var).collect();
    #[cfg(unix)]
    if let Ok(Some(user)) = nix::unistd::User::from_uid(nix::unistd::getuid()) {
        names.push(user.name);
        let full = user.gecos.to_string_lossy();
        names.extend(full.split(',').next().map(ToOwned::to_owned));
    }
    names
}

/// Replaces each occurrence that has no letter or digit beside it. ASCII letters match in either case.
fn replace(text: &str, word: &str, by: &str) -> String {
    let (lower, word) = (text.to_ascii_lowercase(), word.to_ascii_lowercase());
    let mut new = String::with_capacity(text.len());
    let mut copied = 0;
    for (at, found) in lower.match_indices(&word) {
        let before = text.get(..at).and_then(|before| before.chars().last());
        let end = at + found.len();
        let after = text.get(end..).and_then(|after| after.chars().next());
        let is_inside = [before, after]
            .into_iter()
            .flatten()
            .any(char::is_alphanumeric);
        if !is_inside {
            new.push_str(text.get(copied..at).unwrap_or_default());
            new.push_str(by);
            copied = end;
        }
    }
    new.push_str(text.get(copied..).unwrap_or_default());
    new
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn home_user_and_computer_are_replaced_and_nothing_else() {
        let all = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
        let redaction = Redaction::of(
            all(&["/home/alice"]),
            all(&["alice", "Alice Liddell", "a", ""]),
            all(&["lab7.example.org", "lab7"]),
        );
        for (text, expected) in [
            ("folder = \"/home/alice/rec\"", "folder = \"~/rec\""),
            ("/home/alice", "~"),
            ("/home/alice2/rec", "/home/alice2/rec"),
            ("/media/alice/disk", "/media/USER/disk"),
            (r"C:\\Users\\Alice\\rec", r"C:\\Users\\USER\\rec"),
            ("by ALICE_2 of Alice Liddell", "by USER_2 of USER"),
            ("malice alices", "malice alices"),
            ("held by x on lab7", "held by x on COMPUTER"),
            ("lab7.example.org lab72", "COMPUTER lab72"),
            (
                "a palm at rs485:/dev/ttyUSB0",
                "a palm at rs485:/dev/ttyUSB0",
            ),
            ("Aläß Ǆalice É", "Aläß Ǆalice É"),
        ] {
            assert_eq!(redaction.text(text), expected);
        }
        let root = Redaction::of(all(&["/"]), Vec::new(), Vec::new());
        assert_eq!(root.text("/dev/ttyUSB0"), "/dev/ttyUSB0");
    }
}

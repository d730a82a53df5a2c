//! Lists of hand ids as a person types them: `3`, `1,2,3`, `1-10`, or a mixture.

use crate::hand::HandId;

/// Ids in the order they were named, each once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct HandIds(Vec<HandId>);

impl HandIds {
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = HandId> + '_ {
        self.0.iter().copied()
    }
}

impl std::str::FromStr for HandIds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut ids: Vec<HandId> = Vec::new();
        for part in text.split(',') {
            for id in range(part.trim(), text)? {
                if ids.contains(&id) {
                    return Err(format!(
                        "id {} is named twice: two hands of one id would both answer",
                        id.get()
                    ));
                }
                ids.push(id);
            }
        }
        Ok(Self(ids))
    }
}

fn range(part: &str, whole: &str) -> Result<impl Iterator<Item = HandId> + use<>, String> {
    let (first, last) = part.split_once('-').unwrap_or((part, part));
    let (first, last) = (id(first, whole)?, id(last, whole)?);
    if first > last {
        return Err(format!(
            "'{part}' goes backwards: write {}-{}",
            last.get(),
            first.get()
        ));
    }
    Ok((first.get()..=last.get()).map(HandId::nearest))
}

fn id(text: &str, whole: &str) -> Result<HandId, String> {
    let number: Result<i64, _> = text.trim().parse();
    number
        .ok()
        .and_then(|number| HandId::new(number).ok())
        .ok_or_else(|| {
            format!(
                "'{whole}' is not a list of ids: write numbers from 1 to 254, such as 1,2,3 or 1-10"
            )
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ids(text: &str) -> Result<Vec<u8>, String> {
        text.parse()
            .map(|ids: HandIds| ids.iter().map(HandId::get).collect())
    }

    #[test]
    fn lists_and_ranges_keep_their_order() {
        for (text, wanted) in [
            ("1", &[1][..]),
            ("254", &[254]),
            ("3,1,2", &[3, 1, 2]),
            ("1-4", &[1, 2, 3, 4]),
            (" 7 , 1-2 ", &[7, 1, 2]),
        ] {
            assert_eq!(ids(text).unwrap(), wanted, "{text}");
        }
    }

    #[test]
    fn bad_lists_get_one_clear_sentence() {
        for (text, words) in [
            ("", "not a list of ids"),
            ("0", "1 to 254"),
            ("255", "1 to 254"),
            ("1,,2", "not a list of ids"),
            ("1;2", "not a list of ids"),
            ("one", "not a list of ids"),
            ("-3", "not a list of ids"),
            ("1-2-3", "not a list of ids"),
            ("1-300", "1 to 254"),
            ("9-3", "write 3-9"),
            ("1,2,1", "id 1 is named twice"),
            ("1-5,3", "id 3 is named twice"),
        ] {
            let error = ids(text).unwrap_err();
            assert!(error.contains(words), "{text}: {error}");
            assert_eq!(error.lines().count(), 1);
        }
    }
}

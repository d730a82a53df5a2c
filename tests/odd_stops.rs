/// Everything odd that stood beside a stop, or in it, for the tests of the library and those of the program: each door that takes text
/// has to obey each.
pub(crate) fn odd_stops() -> Vec<Vec<u8>> {
    let rows = include_str!("odd_stops.txt").lines();
    let bytes = |row: &str| {
        let text = row.replace("<LF>", "\n").replace("<NUL>", "\0");
        let text = text.replace("<BOM>", "\u{feff}");
        let parts: Vec<&[u8]> = text.split("<FF>").map(str::as_bytes).collect();
        parts.join(&0xff)
    };
    let rows = rows.filter(|row| !row.starts_with('#'));
    let mut all: Vec<Vec<u8>> = rows.map(bytes).collect();
    let utf16 = br#"{"stop":true}"#.iter().flat_map(|byte| [*byte, 0]);
    all.push([0xff, 0xfe].into_iter().chain(utf16).collect());
    let long = format!(r#"{{"stop":true,"x":"{}"}}"#, "y".repeat(3000));
    all.push(long.into_bytes());
    assert!(all.len() > 60);
    all
}

//! The rules of the source tree, as a test: who may import whom, and what may be named where. Nothing is run.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::indexing_slicing,
    reason = "a test may"
)]

use std::fs;
use std::path::Path;

/// Longest file that is still one idea.
const MAX_LINES: usize = 500;
/// Modules with their layer. A module imports from lower layers only.
const LAYERS: [(&str, u8); 14] = [
    ("hand", 0),
    ("codec", 1),
    ("transport", 1),
    ("recording", 1),
    ("link", 2),
    ("sim", 2),
    ("app", 3),
    ("ui", 4),
    ("shell", 5),
    ("raster", 5),
    ("desktop", 6),
    ("headless", 6),
    ("cli", 7),
    ("main", 7),
];
/// The highest layer whose children may not import through their parent.
const LAST_STRICT_LAYER: u8 = 4;
const MAY_DRAW: [&str; 5] = ["ui", "shell", "raster", "desktop", "headless"];
const THEMED: [&str; 4] = ["ui", "shell", "desktop", "cli"];
/// No colours, but "nothing" and "whatever the style says".
const COLOURLESS: [&str; 2] = ["TRANSPARENT", "PLACEHOLDER"];
const FOREIGN_TO_UI: [(&str, &str); 9] = [
    ("Instant::now", "clock"),
    ("SystemTime", "clock"),
    ("std::fs", "file"),
    ("File::", "file"),
    ("std::thread", "thread"),
    ("tokio::", "thread"),
    ("std::net", "port"),
    ("tokio_serial", "port"),
    ("serialport", "port"),
];

/// Calls whose arguments are lengths.
const LENGTH_CALLS: [&str; 27] = [
    "vec2(",
    "pos2(",
    "shrink(",
    "shrink2(",
    "expand(",
    "expand2(",
    "translate(",
    "Stroke::new(",
    "CornerRadius::same(",
    "Margin::same(",
    "FontId::proportional(",
    "FontId::monospace(",
    "FontId::new(",
    "circle(",
    "circle_filled(",
    "circle_stroke(",
    "clamp(",
    "take_left(",
    "take_right(",
    "take_top(",
    "middle(",
    "split_left_right_at_x(",
    "split_top_bottom_at_y(",
    "set_width(",
    "set_max_width(",
    "icon_high(",
    "symmetric(",
];
/// Halves, wholes and doubles of a length with a name.
const FREE_NUMBERS: [&str; 7] = ["0.0", "0.5", "1.0", "2.0", "0", "1", "2"];
/// Names of what is a number of the hand, a share or a turn, and no length on the screen.
const NO_LENGTHS: [&str; 9] = [
    "_MM", "_N", "_S", "_G", "_PX", "_RAD", "_COUNTS", "_PART", "_RATIO",
];

/// Lengths that are written as numbers where they are used.
fn nameless_lengths(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    for call in LENGTH_CALLS {
        for at in words(code, call) {
            let inside = &code[at + call.len()..];
            let end = closing(inside);
            found.extend(plain_numbers(&inside[..end]).map(|number| format!("{call}{number}")));
        }
    }
    for at in words(code, "const ") {
        let line = code[at..].split(';').next().unwrap_or_default();
        if let Some((name, value)) = line.split_once(": f32 =")
            && !NO_LENGTHS.iter().any(|unit| name.ends_with(unit))
        {
            found.extend(plain_numbers(value).map(|number| format!("const of {number}")));
        }
    }
    for sign in [" + ", " - ", " += ", " -= "] {
        for (at, _) in code.match_indices(sign) {
            let rest = &code[at + sign.len()..];
            let number = number_at(rest);
            let factor = rest[number.len()..].trim_start().starts_with(['*', '/']);
            if number.contains('.') && !factor && !FREE_NUMBERS.contains(&number) {
                found.push(format!("{}{number}", sign.trim_start()));
            }
        }
    }
    found.sort();
    found.dedup();
    found
        .into_iter()
        .map(|what| format!("length without a name: {what}"))
        .collect()
}

/// Where the bracket that is open here is closed.
fn closing(inside: &str) -> usize {
    let mut depth = 1_i32;
    for (at, letter) in inside.char_indices() {
        depth += match letter {
            '(' | '[' | '{' => 1,
            ')' | ']' | '}' => -1,
            _ => 0,
        };
        if depth == 0 {
            return at;
        }
    }
    inside.len()
}

/// The number that the text begins with, or nothing.
fn number_at(text: &str) -> &str {
    let digits = |text: &str| {
        text.find(|c: char| !c.is_ascii_digit())
            .unwrap_or(text.len())
    };
    let whole = digits(text);
    let end = match text[whole..].strip_prefix('.') {
        Some(rest) if whole > 0 && digits(rest) > 0 => whole + 1 + digits(rest),
        _ => whole,
    };
    &text[..end]
}

/// Numbers that are neither free nor factors of something with a name.
fn plain_numbers(code: &str) -> impl Iterator<Item = &str> {
    let starts = code.char_indices().filter(|(at, letter)| {
        letter.is_ascii_digit() && !code[..*at].ends_with(|c: char| is_word(c) || c == '.')
    });
    starts.filter_map(|(at, _)| {
        let number = number_at(&code[at..]);
        let before = code[..at].trim_end().chars().next_back();
        let after = code[at + number.len()..].trim_start();
        let factor = matches!(before, Some('*' | '/'))
            || after.starts_with('*')
            || after.starts_with('/')
            || after.starts_with("..")
            || code[..at].ends_with("gamma_multiply(");
        (!factor && !FREE_NUMBERS.contains(&number)).then_some(number)
    })
}

/// What is wrong with one file; `path` is relative to `src/`, with `/`.
fn violations(path: &str, text: &str) -> Vec<String> {
    let with_strings = blank(text, Strings::Keep);
    let code = blank(text, Strings::Blank);
    let tests_from = code.find("#[cfg(test)]\nmod ").unwrap_or(code.len());
    let mut found = Vec::new();
    if !text.starts_with("//!") {
        found.push("does not open with //!".to_owned());
    }
    let lines = text.lines().count();
    if lines > MAX_LINES {
        found.push(format!("{lines} lines, more than {MAX_LINES}"));
    }
    if code.contains("#[ignore") {
        found.push("ignores a test".to_owned());
    }
    if words(&code[..tests_from], "super::").next().is_some() {
        found.push("super:: outside tests".to_owned());
    }
    let module = module_of(path);
    import_rules(path, module, &code, &mut found);
    if module == "ui" {
        found.extend(foreign_to_ui(&code));
    }
    if path.starts_with("ui/") && !path.starts_with("ui/theme/") {
        found.extend(nameless_lengths(&code[..tests_from]));
    }
    if !MAY_DRAW.contains(&module) && identifiers(&code).any(is_egui) {
        found.push("egui outside ui, shell, raster, desktop, headless".to_owned());
    }
    if THEMED.contains(&module) && !path.starts_with("ui/theme/") {
        found.extend(colours(&code, &with_strings));
    }
    found
}

fn import_rules(path: &str, module: &str, code: &str, found: &mut Vec<String>) {
    if module == "main" {
        if words(code, "crate::").next().is_some() || words(code, "mod ").next().is_some() {
            found.push("main.rs reaches the library other than by handscope::".to_owned());
        }
        return;
    }
    if words(code, "handscope::").next().is_some() {
        found.push("handscope:: inside the library".to_owned());
    }
    if module == "lib" {
        return;
    }
    for target in tree_paths(code, "crate::") {
        let first = target[0].as_str();
        if let Some(why) = forbidden(module, first) {
            found.push(format!("crate::{} {why}", target.join("::")));
        }
        if first == module && through_parent(path, module, &target) {
            found.push(format!("crate::{} through the parent", target.join("::")));
        }
    }
}

/// Why `from` may not import `to`.
fn forbidden(from: &str, to: &str) -> Option<&'static str> {
    let (Some(low), Some(high)) = (layer(to), layer(from)) else {
        return Some("is not in the layer table");
    };
    if from == to {
        None
    } else if low > high {
        Some("goes up")
    } else if low == high {
        Some("goes sideways")
    } else if from == "transport" {
        Some("is used by transport, which knows nothing")
    } else {
        None
    }
}

/// Whether a child imports an item (upper-case first letter) from a folder that holds the child.
fn through_parent(path: &str, module: &str, target: &[String]) -> bool {
    let own: Vec<&str> = path.split('/').collect();
    let (file, folders) = own.split_last().expect("a path has a last part");
    let depth = folders.len() - usize::from(*file == "mod.rs");
    let strict = layer(module).is_some_and(|layer| layer <= LAST_STRICT_LAYER);
    strict
        && (1..=depth).any(|length| {
            target.len() > length
                && target.iter().zip(folders).take(length).all(|(a, b)| a == b)
                && target[length].starts_with(char::is_uppercase)
        })
}

fn foreign_to_ui(code: &str) -> Vec<String> {
    let mut found: Vec<String> = FOREIGN_TO_UI
        .iter()
        .filter(|(token, _)| words(code, token).next().is_some())
        .map(|(token, what)| format!("{token}: a {what} inside ui"))
        .collect();
    for target in tree_paths(code, "std::{") {
        if ["fs", "thread", "net"].contains(&target[0].as_str()) {
            found.push(format!("std::{} inside ui", target[0]));
        }
    }
    found
}

fn colours(code: &str, with_strings: &str) -> Vec<String> {
    let mut found = Vec::new();
    for kind in ["Color32::", "Rgba::"] {
        for at in words(code, kind) {
            let name = ident_at(&code[at + kind.len()..]);
            let constant = name.len() > 2 && name.chars().all(|c| c.is_uppercase() || c == '_');
            if name.starts_with("from_") || (constant && !COLOURLESS.contains(&name.as_str())) {
                found.push(format!("colour {kind}{name} outside ui/theme"));
            }
        }
    }
    if words(code, "hex_color!").next().is_some() {
        found.push("colour hex_color! outside ui/theme".to_owned());
    }
    for (at, _) in with_strings.match_indices("\"#") {
        let after = &with_strings[at + 2..];
        let digits = after.len()
            - after
                .trim_start_matches(|c: char| c.is_ascii_hexdigit())
                .len();
        if after[digits..].starts_with('"') && [3, 4, 6, 8].contains(&digits) {
            found.push("colour written in hex outside ui/theme".to_owned());
        }
    }
    found
}

fn module_of(path: &str) -> &str {
    let first = path.split('/').next().unwrap_or(path);
    first.strip_suffix(".rs").unwrap_or(first)
}

fn layer(module: &str) -> Option<u8> {
    let row = LAYERS.iter().find(|(name, _)| *name == module);
    row.map(|(_, layer)| *layer)
}

fn is_egui(word: &str) -> bool {
    word == "egui" || word.starts_with("egui_") || word == "eframe"
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn ident_at(text: &str) -> String {
    text.chars().take_while(|c| is_word(*c)).collect()
}

fn identifiers(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c| !is_word(c)).filter(|word| !word.is_empty())
}

/// Where `token` stands with no word right before it.
fn words<'a>(code: &'a str, token: &'a str) -> impl Iterator<Item = usize> + 'a {
    code.match_indices(token)
        .map(|(at, _)| at)
        .filter(|at| !code[..*at].ends_with(is_word))
}

/// All paths that follow `root` in the code, groups spelt out: `crate::{a::B, c}` gives `a::B` and `c`.
fn tree_paths(code: &str, root: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    for at in words(code, root) {
        let after = &code[at + root.len()..];
        if root.ends_with('{') {
            group(after, &[], &mut paths);
        } else {
            tree(after, &[], &mut paths);
        }
    }
    paths
}

/// Reads one use tree; returns what follows it.
fn tree<'a>(text: &'a str, before: &[String], paths: &mut Vec<Vec<String>>) -> &'a str {
    if let Some(inside) = text.strip_prefix('{') {
        return group(inside, before, paths);
    }
    let name = if text.starts_with('*') {
        "*".to_owned()
    } else {
        ident_at(text)
    };
    let rest = &text[name.len()..];
    let mut path = before.to_vec();
    if !name.is_empty() {
        path.push(name);
    }
    if path.is_empty() {
        return rest;
    }
    match rest.strip_prefix("::") {
        Some(deeper) if !deeper.starts_with('<') => tree(deeper, &path, paths),
        _ => {
            paths.push(path);
            rest
        }
    }
}

/// Reads `a, b::c}`; returns what follows.
fn group<'a>(text: &'a str, before: &[String], paths: &mut Vec<Vec<String>>) -> &'a str {
    let mut rest = text.trim_start();
    while !rest.is_empty() && !rest.starts_with('}') {
        let after = tree(rest, before, paths);
        // Past `as name` and the comma.
        let end = after.find([',', '}']).unwrap_or(after.len());
        rest = after[end..].trim_start_matches(',').trim_start();
    }
    rest.strip_prefix('}').unwrap_or(rest)
}

#[derive(Clone, Copy, PartialEq)]
enum Strings {
    Keep,
    Blank,
}

#[derive(Clone, Copy, PartialEq)]
enum Piece {
    Code,
    Text,
    Comment,
}

/// The text with comments, and if wished strings, turned into spaces. Lines stay.
fn blank(text: &str, strings: Strings) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while !rest.is_empty() {
        let (length, kind) = piece(rest);
        let (piece, after) = rest.split_at(length);
        if kind == Piece::Comment || (kind == Piece::Text && strings == Strings::Blank) {
            out.extend(piece.chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        } else {
            out.push_str(piece);
        }
        rest = after;
    }
    out
}

/// Length and kind of the next comment, string, character, word or sign.
fn piece(text: &str) -> (usize, Piece) {
    if text.starts_with("//") {
        return (text.find('\n').unwrap_or(text.len()), Piece::Comment);
    }
    if text.starts_with("/*") {
        return (block_comment(text), Piece::Comment);
    }
    if let Some(length) = raw_string(text) {
        return (length, Piece::Text);
    }
    if text.starts_with('"') {
        return (quoted(text, '"'), Piece::Text);
    }
    if text.starts_with('\'') {
        let mut inside = text.chars().skip(1);
        let (first, second) = (inside.next(), inside.next());
        // `'a` without a closing quote is a lifetime.
        if first == Some('\\') || second == Some('\'') {
            return (quoted(text, '\''), Piece::Text);
        }
    }
    let one = text.chars().next().map_or(1, char::len_utf8);
    (ident_at(text).len().max(one), Piece::Code)
}

fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(step) = text[at..].find(['/', '*']) {
        at += step;
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

fn raw_string(text: &str) -> Option<usize> {
    let after = text.strip_prefix("br").or_else(|| text.strip_prefix('r'))?;
    let inside = after.trim_start_matches('#');
    let hashes = &after[..after.len() - inside.len()];
    let inside = inside.strip_prefix('"')?;
    let start = text.len() - inside.len();
    let end = format!("\"{hashes}");
    let length = inside.find(&end).map(|at| start + at + end.len());
    Some(length.unwrap_or(text.len()))
}

fn quoted(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, letter) in text.char_indices().skip(1) {
        if escaped {
            escaped = false;
        } else if letter == '\\' {
            escaped = true;
        } else if letter == quote {
            return at + 1;
        }
    }
    text.len()
}

fn check(path: &str, text: &str, wanted: &str) {
    let found = violations(path, &format!("//! Doc.\n{text}\n"));
    if wanted.is_empty() {
        assert_eq!(found, Vec::<String>::new(), "{path}: {text}");
    } else {
        assert!(
            found.len() == 1 && found[0].contains(wanted),
            "{path}: {text}: wanted {wanted:?}, got {found:?}"
        );
    }
}

#[test]
fn imports_go_down_only() {
    for (path, text, wanted) in [
        ("hand/dof.rs", "use crate::codec::crc::Crc;", "goes up"),
        ("hand/dof.rs", "use crate::hand::units::Angle;", ""),
        ("codec/crc.rs", "use crate::hand::Dof;", ""),
        (
            "codec/crc.rs",
            "use crate::transport::Wire;",
            "goes sideways",
        ),
        ("recording/file.rs", "use crate::hand::{Dof, Finger};", ""),
        (
            "recording/file.rs",
            "use crate::codec::crc;",
            "goes sideways",
        ),
        (
            "transport/wire.rs",
            "use crate::hand::Dof;",
            "knows nothing",
        ),
        ("transport/pipe.rs", "use crate::transport::wire::Wire;", ""),
        (
            "link/bus.rs",
            "fn f() { crate::sim::body::run(); }",
            "goes sideways",
        ),
        (
            "sim/body.rs",
            "use crate::{\n    hand::Dof,\n    link::bus,\n};",
            "goes sideways",
        ),
        (
            "app/state.rs",
            "use crate::{hand::Dof as D, link::bus::{Bus, self}, sim};",
            "",
        ),
        (
            "app/state.rs",
            "use crate::{hand::Dof as D, link::{self, Bus}, ui};",
            "crate::ui goes up",
        ),
        ("ui/joint.rs", "use crate::shell::Shell;", "goes up"),
        (
            "desktop.rs",
            "use crate::headless::png::encode;",
            "goes sideways",
        ),
        ("desktop/software.rs", "use crate::raster::Raster;", ""),
        ("shell.rs", "use crate::raster::Raster;", "goes sideways"),
        ("cli/watch.rs", "use crate::{desktop, headless::png};", ""),
        (
            "app/state.rs",
            "use crate::surprise::X;",
            "not in the layer table",
        ),
        (
            "surprise/a.rs",
            "use crate::hand::X;",
            "not in the layer table",
        ),
        (
            "hand/dof.rs",
            "// use crate::ui::X;\n/* crate::ui /* a */ crate::app */",
            "",
        ),
        ("hand/dof.rs", "const A: &str = \"crate::ui::X\";", ""),
        ("hand/dof.rs", "const A: &str = r#\"\"crate::ui::X\"#;", ""),
        (
            "hand/dof.rs",
            "const A: char = '\"'; use crate::ui::X;",
            "goes up",
        ),
        (
            "hand/dof.rs",
            "#[cfg(test)]\nmod tests { use crate::sim::body::Body; }",
            "goes up",
        ),
    ] {
        check(path, text, wanted);
    }
}

#[test]
fn main_uses_the_library_by_name_and_the_library_never_does() {
    check("main.rs", "use handscope::cli;\nfn main() {}", "");
    check("main.rs", "use crate::cli;", "main.rs reaches");
    check("main.rs", "mod cli;", "main.rs reaches");
    check(
        "cli/run.rs",
        "use handscope::hand::Dof;",
        "inside the library",
    );
    check("lib.rs", "pub mod hand;", "");
}

#[test]
fn children_do_not_import_through_their_parent() {
    for (path, text, wanted) in [
        (
            "sim/body.rs",
            "use crate::sim::Memory;",
            "through the parent",
        ),
        (
            "sim/body.rs",
            "use crate::sim::{memory::Memory, Body};",
            "through the parent",
        ),
        ("sim/body.rs", "use crate::sim::memory::Memory;", ""),
        ("sim/mod.rs", "pub use crate::sim::memory::Memory;", ""),
        (
            "ui/tactile/heat.rs",
            "use crate::ui::tactile::Heat;",
            "through the parent",
        ),
        (
            "ui/tactile/mod.rs",
            "use crate::ui::Theme;",
            "through the parent",
        ),
        ("ui/tactile/heat.rs", "use crate::ui::theme::Theme;", ""),
        ("headless/canvas.rs", "use crate::headless::Raster;", ""),
        ("app/state.rs", "use crate::hand::Dof;", ""),
        ("sim/body.rs", "use super::memory::Memory;", "super::"),
        (
            "sim/body.rs",
            "#[cfg(test)]\nmod tests {\n    use super::*;\n}",
            "",
        ),
        ("sim/body.rs", "pub(super) fn f() {}", ""),
    ] {
        check(path, text, wanted);
    }
}

#[test]
fn ui_has_no_clock_file_thread_or_port() {
    for (text, wanted) in [
        ("fn f() { std::time::Instant::now(); }", "clock"),
        ("use std::time::SystemTime;", "clock"),
        ("use std::fs;", "file"),
        ("use std::{fmt, fs};", "std::fs inside ui"),
        ("fn f() { File::open(p); }", "file"),
        ("fn f() { std::thread::spawn(f); }", "thread"),
        ("use tokio::sync::mpsc;", "thread"),
        ("use std::net::TcpStream;", "port"),
        ("use serialport::available_ports;", "port"),
        ("use std::{fmt, time::Duration};", ""),
        ("fn f() { SessionFile::name(x); }", ""),
        ("// Instant::now is for the shell.", ""),
    ] {
        check("ui/joint.rs", text, wanted);
    }
    check("link/session.rs", "fn f() { Instant::now(); }", "");
}

#[test]
fn egui_stays_in_the_drawing_layers() {
    check("app/state.rs", "use egui::Context;", "egui outside");
    check("cli/run.rs", "use eframe::App;", "egui outside");
    check("app/state.rs", "use egui_plot::Line;", "egui outside");
    check("app/state.rs", "// egui reads this.", "");
    check("ui/joint.rs", "use egui::Ui;", "");
    check("headless/canvas.rs", "use egui::Context;", "");
}

#[test]
fn colours_come_from_the_theme() {
    for (path, text, wanted) in [
        (
            "ui/joint.rs",
            "let c = Color32::from_rgb(1, 2, 3);",
            "colour",
        ),
        (
            "shell/top.rs",
            "let c = egui::Color32::LIGHT_BLUE;",
            "colour",
        ),
        ("ui/joint.rs", "let c = Color32::TRANSPARENT;", ""),
        ("ui/joint.rs", "fn f(c: Color32) {}", ""),
        ("ui/joint.rs", "let c = hex(\"#ff00aa\");", "hex"),
        ("ui/joint.rs", "let c = \"#1 finger\";", ""),
        (
            "ui/theme/palette.rs",
            "let c = Color32::from_rgb(1, 2, 3);",
            "",
        ),
        ("raster/surface.rs", "let c = Color32::RED;", ""),
    ] {
        check(path, text, wanted);
    }
}

#[test]
fn lengths_have_names_in_the_theme() {
    for (path, text, wanted) in [
        (
            "ui/joint.rs",
            "fn f() { vec2(theme::GAP, 12.0); }",
            "vec2(12.0",
        ),
        ("ui/joint.rs", "fn f() { vec2(theme::GAP, 0.0); }", ""),
        ("ui/joint.rs", "fn f() { pos2(x + 3.5, y); }", "length"),
        (
            "ui/joint.rs",
            "fn f() { rect.shrink(theme::GAP / 2.0); }",
            "",
        ),
        ("ui/joint.rs", "fn f() { rect.shrink(3.0); }", "shrink(3.0"),
        ("ui/joint.rs", "fn f() { pos2(w * 0.38, y); }", ""),
        ("ui/joint.rs", "fn f() { pos2(0.38 * w, y); }", ""),
        (
            "ui/joint.rs",
            "fn f() { Stroke::new(1.4, c); }",
            "Stroke::new(1.4",
        ),
        ("ui/joint.rs", "fn f() { Stroke::new(theme::LINE, c); }", ""),
        ("ui/joint.rs", "fn f() { CornerRadius::same(3); }", "same(3"),
        ("ui/joint.rs", "fn f() { FontId::monospace(9.0); }", "9.0"),
        (
            "ui/joint.rs",
            "fn f() { take_left(&mut rest, width(a) - 84.0); }",
            "length",
        ),
        ("ui/joint.rs", "fn f() { rest.max.x -= 4.5; }", "-= 4.5"),
        ("ui/joint.rs", "const WIDE: f32 = 84.0;", "const of 84.0"),
        ("ui/joint.rs", "const WIDE: f32 = 2.0 * theme::GAP;", ""),
        ("ui/joint.rs", "const COUNT: usize = 84;", ""),
        ("ui/joint.rs", "fn f() { let a = [1, 84]; }", ""),
        ("ui/theme/sizes.rs", "const WIDE: f32 = 84.0;", ""),
        ("headless/canvas.rs", "const WIDE: f32 = 84.0;", ""),
    ] {
        let found = violations(path, &format!("//! Doc.\n{text}\n"));
        let right = match wanted {
            "" => found.is_empty(),
            part => !found.is_empty() && found.iter().any(|what| what.contains(part)),
        };
        assert!(right, "{path}: {text}: wanted {wanted:?}, got {found:?}");
    }
}

#[test]
fn files_open_with_a_sentence_are_short_and_ignore_no_test() {
    let bare = violations("hand/a.rs", "use std::fmt;\n");
    assert_eq!(bare, ["does not open with //!"]);
    let long = "\n".repeat(MAX_LINES);
    check("hand/a.rs", &long, "lines, more than");
    check("hand/a.rs", &long[2..], "");
    check(
        "hand/a.rs",
        "#[test]\n#[ignore = \"slow\"]\nfn f() {}",
        "ignores a test",
    );
    check("hand/a.rs", "// #[ignore]", "");
}

fn read_tree(folder: &Path, prefix: &str, found: &mut Vec<String>) -> usize {
    let mut files = 0;
    for entry in fs::read_dir(folder).expect("the source tree is there") {
        let entry = entry.expect("an entry can be read");
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            files += read_tree(&entry.path(), &format!("{name}/"), found);
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(entry.path()).expect("source is UTF-8");
            let wrong = violations(&name, &text);
            found.extend(wrong.iter().map(|what| format!("src/{name}: {what}")));
            files += 1;
        }
    }
    files
}

#[test]
fn the_tree_keeps_its_rules() {
    let mut found = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = read_tree(&root.join("src"), "", &mut found);
    found.sort();
    assert!(files > 10, "only {files} files read");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn unsafe_code_is_forbidden() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let lints: toml::Table = manifest.parse().unwrap();
    assert_eq!(
        lints["lints"]["rust"]["unsafe_code"].as_str(),
        Some("forbid")
    );
}

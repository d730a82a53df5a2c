//! The shape of the source tree: a module imports only from floors below its own, and no files import one another in a circle.
//! Sources are read as text; what only tests have does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The modules of each floor, from the lowest up.
const FLOORS: [&[&str]; 12] = [
    &["hand", "manual", "printable", "soak", "system"],
    &["codec", "transport", "record", "store"],
    &["history"],
    &["link", "sim", "params", "poses", "trials"],
    &["exhibit", "share", "inputs", "checkup", "fake"],
    &["motion", "tasks"],
    &["app"],
    &["draw"],
    &["ui"],
    &["shell"],
    &["cli"],
    &["main"],
];

/// The roots of the three crates.
const CRATES: [&str; 3] = ["core.rs", "draw/lib.rs", "lib.rs"];

/// Sources by their path below `src`, without comments, texts and tests.
type Sources = BTreeMap<String, String>;

#[test]
fn modules_import_only_from_floors_below_their_own() {
    let wrong = upward(&sources());
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_files_import_one_another() {
    let found = circles(&sources());
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn no_folders_of_a_module_import_one_another() {
    let found = folder_circles(&sources());
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_methods_of_a_type_stand_in_one_folder() {
    let found = spread(&sources());
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn what_is_forbidden_is_found_and_nothing_else() {
    let tree = |files: &[(&str, &str)]| -> Sources {
        let plain = |(path, text): &(&str, &str)| ((*path).to_owned(), plain(text));
        files.iter().map(plain).collect()
    };
    for (text, wrong) in [
        ("use crate::hand::Dof;", 0),
        ("use crate::{hand, codec::{self, pdu::{Kind, Pdu}}};", 0),
        ("use crate::{hand, app::{Action, State}, ui};", 2),
        ("mod a;\n    pub(crate) use crate::sim::SimHand;", 1),
        ("fn f() { crate::app::run(); crate::link::run() }", 1),
        ("use crate::lost::Child;", 1),
        ("// crate::app\nfn f() {} // as in crate::app", 0),
        ("#[cfg(test)]\nmod tests {\n    use crate::app;\n}", 0),
        ("#[cfg(all(test, unix))]\nmod tests;\nuse crate::app;", 1),
        ("#[cfg(test)]\nfn f() {\n    app()\n}\nuse crate::app;", 1),
    ] {
        assert_eq!(
            upward(&tree(&[("link/bus.rs", text)])).len(),
            wrong,
            "{text}"
        );
    }
    let found = circles(&tree(&[
        (
            "link/mod.rs",
            "pub use bus::{Bus, Wire};\npub use self::plan::Plan;",
        ),
        ("link/bus.rs", "use crate::link::Plan;"),
        ("link/plan.rs", "fn f() { crate::link::Wire::new(); }"),
        ("hand.rs", "use crate::codec::pdu;"),
        ("codec/pdu.rs", "use crate::codec::slcan::Text;"),
    ]));
    assert_eq!(found, ["link/bus.rs link/plan.rs".to_owned()].into());
    let rooms = tree(&[
        (
            "ui/kit/look.rs",
            "use crate::ui::text::main::Text;\nstruct Look;",
        ),
        ("ui/text/main.rs", "struct Text;"),
        (
            "ui/text/words.rs",
            "use crate::ui::kit::look::Look;\nimpl Look {\n}",
        ),
        (
            "ui/plots.rs",
            "use crate::ui::text::main::Text;\nimpl Display for Text {\n}",
        ),
    ]);
    assert!(circles(&rooms).is_empty());
    assert_eq!(folder_circles(&rooms), ["ui: kit text".to_owned()].into());
    let spread = spread(&rooms);
    assert_eq!(
        spread,
        [("Look".to_owned(), "ui/text/words.rs".to_owned())].into()
    );
}

/// All sources of the program.
fn sources() -> Sources {
    let (mut found, mut open) = (Sources::new(), vec![String::new()]);
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(root.join(&folder)).unwrap() {
            let entry = entry.unwrap();
            let path = folder.clone() + entry.file_name().to_str().unwrap();
            if entry.file_type().unwrap().is_dir() {
                open.push(path + "/");
            } else if path.ends_with(".rs")
                && !path.ends_with("tests.rs")
                && !CRATES.contains(&path.as_str())
            {
                let mut text = fs::read_to_string(entry.path()).unwrap();
                if path.starts_with("draw/") {
                    text = text.replace("crate::", "crate::draw::");
                    text = text.replace("handscope_core::", "crate::");
                }
                found.insert(path, plain(&text));
            }
        }
    }
    assert!(found.len() > 50, "the sources are found");
    found
}

/// Imports that do not go down, and modules without a floor.
fn upward(sources: &Sources) -> BTreeSet<String> {
    let floor = |name: &str| FLOORS.iter().position(|modules| modules.contains(&name));
    let first = |path: &str| path.split([':', '/', '.']).next().map(str::to_owned);
    let mut wrong = BTreeSet::new();
    for (path, code) in sources {
        let ours = first(path).unwrap();
        for theirs in imports(code).iter().filter_map(|name| first(name)) {
            let is_below = floor(&theirs).is_some_and(|there| Some(there) < floor(&ours));
            if theirs != ours && !is_below {
                wrong.insert(format!("{path} imports {theirs}"));
            }
        }
    }
    wrong
}

/// What each file imports, as files.
fn arrows(sources: &Sources) -> BTreeMap<&str, BTreeSet<&str>> {
    let names = Names::of(sources);
    let arrows = sources.iter().map(|(path, code)| {
        let imported = imports(code);
        let homes = imported.iter().filter_map(|name| names.home(name, 8));
        (path.as_str(), homes.collect::<BTreeSet<_>>())
    });
    arrows.collect()
}

/// Sets of files that import one another, each as its files in order.
fn circles(sources: &Sources) -> BTreeSet<String> {
    around(&arrows(sources))
}

/// Sets of folders and files of a module that import one another, each with its module.
fn folder_circles(sources: &Sources) -> BTreeSet<String> {
    let mut modules: BTreeMap<&str, BTreeMap<&str, BTreeSet<&str>>> = BTreeMap::new();
    // The module, and what in it; what stands in `mod.rs` belongs to all.
    let place = |path: &'_ str| -> Option<(usize, usize)> {
        let module = path.find('/')?;
        let inner = &path[module + 1..];
        let end = inner.find('/').unwrap_or(inner.len());
        (inner != "mod.rs").then_some((module, module + 1 + end))
    };
    for (path, imported) in &arrows(sources) {
        let Some((module, end)) = place(path) else {
            continue;
        };
        let (module, own) = (&path[..module], &path[module + 1..end]);
        let rooms = modules.entry(module).or_default();
        rooms.entry(own).or_default();
        for other in imported {
            if let Some((there, end)) = place(other)
                && &other[..there] == module
            {
                let other = &other[there + 1..end];
                rooms.entry(other).or_default();
                rooms.entry(own).or_default().insert(other);
            }
        }
    }
    let named = |(module, rooms): (&str, BTreeMap<&str, BTreeSet<&str>>)| {
        let circles = around(&rooms).into_iter();
        let circles = circles.map(move |circle| format!("{module}: {circle}"));
        circles.collect::<Vec<_>>()
    };
    modules.into_iter().flat_map(named).collect()
}

/// Types with methods of their own in another folder than theirs, and the file that has them.
fn spread(sources: &Sources) -> BTreeSet<(String, String)> {
    let names = Names::of(sources);
    let folder = |path: &str| path.rsplit_once('/').map(|(folder, _)| folder.to_owned());
    let mut found = BTreeSet::new();
    for (path, code) in sources {
        let imported = imports(code);
        for (at, start) in code.match_indices("\nimpl") {
            let rest = &code[at + start.len()..];
            let head = rest.split('{').next().unwrap_or_default();
            let of = head.rsplit('>').next().filter(|_| head.starts_with('<'));
            let name: String = of
                .unwrap_or(head)
                .trim()
                .chars()
                .take_while(|c| is_word(*c))
                .collect();
            let is_own = ["struct", "enum"]
                .iter()
                .any(|kind| code.contains(&format!("{kind} {name}")));
            if name.is_empty() || is_own || head.contains(" for ") {
                continue;
            }
            let is_it = |imported: &&String| imported.rsplit("::").next() == Some(&name);
            let home = imported
                .iter()
                .find(is_it)
                .and_then(|whole| names.home(whole, 8));
            if home.is_some_and(|home| folder(home) != folder(path)) {
                found.insert((name, path.clone()));
            }
        }
    }
    found
}

/// Sets of what is in one another's reach, each in order.
fn around(arrows: &BTreeMap<&str, BTreeSet<&str>>) -> BTreeSet<String> {
    let mut reach: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for path in arrows.keys() {
        let (mut seen, mut open) = (BTreeSet::new(), vec![*path]);
        while let Some(next) = open.pop() {
            open.extend(arrows[next].iter().filter(|path| seen.insert(**path)));
        }
        reach.insert(path, seen);
    }
    let circle = |path: &&str| {
        let around = reach[path].iter().copied();
        around.filter(|other| reach[other].contains(path)).collect()
    };
    let all = reach.keys().map(circle);
    let all = all.filter(|files: &Vec<&str>| files.len() > 1);
    all.map(|files| files.join(" ")).collect()
}

/// Where names live: the files of modules, and what a module hands on from another.
struct Names<'a> {
    files: BTreeMap<String, &'a str>,
    handed_on: BTreeMap<String, String>,
}

impl<'a> Names<'a> {
    fn of(sources: &'a Sources) -> Self {
        let (mut files, mut handed_on) = (BTreeMap::new(), BTreeMap::new());
        for (path, code) in sources {
            let module = path.trim_end_matches(".rs").trim_end_matches("/mod");
            let module = module.replace('/', "::");
            for name in uses(code)
                .filter(|(is_public, _)| *is_public)
                .flat_map(|(_, tree)| paths(tree))
            {
                let whole = match name.strip_prefix("crate::") {
                    Some(name) => name.to_owned(),
                    None => format!("{module}::{}", name.trim_start_matches("self::")),
                };
                let last = name.rsplit("::").next().unwrap();
                handed_on.insert(format!("{module}::{last}"), whole);
            }
            files.insert(module, path.as_str());
        }
        Self { files, handed_on }
    }

    /// The file of a name, which may be handed on so many times.
    fn home(&self, name: &str, times: u8) -> Option<&'a str> {
        let ends = name.match_indices("::").map(|(at, _)| at);
        let mut ends: Vec<usize> = ends.chain([name.len()]).collect();
        ends.reverse();
        ends.into_iter()
            .find_map(|end| match self.handed_on.get(&name[..end]) {
                Some(whole) if times > 0 => {
                    self.home(&format!("{whole}{}", &name[end..]), times - 1)
                }
                _ => self.files.get(&name[..end]).copied(),
            })
    }
}

/// Every path that begins with `crate`, without it.
fn imports(code: &str) -> Vec<String> {
    let used = uses(code).flat_map(|(_, tree)| paths(tree));
    let used = used.filter_map(|name| Some(name.strip_prefix("crate::")?.to_owned()));
    let named = code.match_indices("crate::").map(|(at, start)| {
        let rest = &code[at + start.len()..];
        let end = rest.find(|letter: char| !is_word(letter) && letter != ':');
        rest[..end.unwrap_or(rest.len())]
            .trim_end_matches(':')
            .to_owned()
    });
    used.chain(named.filter(|name| !name.is_empty())).collect()
}

/// The trees of all `use` lines, and whether they are public.
fn uses(code: &str) -> impl Iterator<Item = (bool, &str)> {
    code.match_indices("use ").filter_map(|(at, start)| {
        let before = code[..at].rsplit('\n').next()?.trim();
        let tree = code[at + start.len()..].split(';').next()?;
        let is_line = matches!(before, "" | "pub" | "pub(crate)");
        is_line.then_some((!before.is_empty(), tree))
    })
}

/// All paths of one `use` tree.
fn paths(tree: &str) -> Vec<String> {
    let Some((head, group)) = tree.split_once('{') else {
        let name = tree.split(" as ").next().unwrap_or_default().trim();
        return Vec::from_iter((!name.is_empty()).then(|| name.to_owned()));
    };
    let (mut depth, mut begin, mut found) = (0, 0, Vec::new());
    for (at, letter) in group.char_indices() {
        if matches!(letter, ',' | '}') && depth == 0 {
            let inner = paths(&group[begin..at]).into_iter();
            found.extend(inner.map(|name| format!("{}{name}", head.trim())));
            begin = at + 1;
        }
        depth += i32::from(letter == '{') - i32::from(letter == '}');
    }
    found
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

/// The code without comments and without what only tests have, laid out as rustfmt does it.
fn plain(text: &str) -> String {
    let lines = text
        .lines()
        .map(|line| line.split("//").next().unwrap_or(line));
    let mut code = lines.collect::<Vec<_>>().join("\n");
    while let Some(at) = code
        .find("#[cfg(test)]")
        .or_else(|| code.find("#[cfg(all(test"))
    {
        let indent = code[..at].rsplit('\n').next().unwrap_or_default();
        let (block, item) = (code[at..].find('{'), code[at..].find(';'));
        let end = match (block, item) {
            (Some(block), item) if item.is_none_or(|item| block < item) => {
                code[at..].find(&format!("\n{indent}}}"))
            }
            _ => item,
        };
        code.replace_range(at..end.map_or(code.len(), |end| at + end + 1), "");
    }
    code
}

//! What the program is linked with: the page `handscope help licences` is made from the lock file, and nothing else may come in.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const PAGE: &str = "assets/manual/licences.md";
const LOCK: &str = include_str!("../../Cargo.lock");
const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";
/// Licences under which a program may be handed out as this one is, with its licences listed.
const ALLOWED: [&str; 13] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MPL-2.0",
    "OFL-1.1",
    "Ubuntu-font-1.0",
    "Unicode-3.0",
    "Zlib",
];
const COLUMNS: usize = 80;
const OWN: [&str; 3] = ["handscope", "handscope-core", "handscope-draw"];

struct Linked {
    name: String,
    version: String,
    licence: String,
    repository: String,
}

/// Every crate that ends up in the program on Linux: neither what builds it nor what tests it.
fn linked() -> Vec<Linked> {
    let output = Command::new(std::env::var("CARGO").unwrap_or("cargo".into()))
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(["--filter-platform", "x86_64-unknown-linux-gnu"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let graph: Value = serde_json::from_slice(&output.stdout).unwrap();
    let by_id = |list: &Value| -> BTreeMap<String, Value> {
        let rows = list.as_array().unwrap().iter();
        rows.map(|row| (row["id"].as_str().unwrap().to_owned(), row.clone()))
            .collect()
    };
    let packages = by_id(&graph["packages"]);
    let nodes = by_id(&graph["resolve"]["nodes"]);
    let is_macro = |id: &str| {
        let targets = packages[id]["targets"].as_array().unwrap().iter();
        targets
            .flat_map(|target| target["kind"].as_array().unwrap())
            .any(|kind| kind == "proc-macro")
    };
    let root = graph["resolve"]["root"].as_str().unwrap().to_owned();
    let (mut seen, mut waiting) = (BTreeSet::new(), vec![root]);
    while let Some(id) = waiting.pop() {
        if is_macro(&id) || !seen.insert(id.clone()) {
            continue;
        }
        for dependency in nodes[&id]["deps"].as_array().unwrap() {
            let kinds = dependency["dep_kinds"].as_array().unwrap();
            if kinds.iter().any(|kind| kind["kind"].is_null()) {
                waiting.push(dependency["pkg"].as_str().unwrap().to_owned());
            }
        }
    }
    let text = |value: &Value| value.as_str().unwrap_or("").to_owned();
    let all = seen.iter().map(|id| &packages[id]);
    let by_others = all.filter(|package| !package["source"].is_null());
    let linked = by_others.map(|package| Linked {
        name: text(&package["name"]),
        version: text(&package["version"]),
        licence: text(&package["license"])
            .replace(" / ", " OR ")
            .replace('/', " OR "),
        repository: text(&package["repository"]),
    });
    let mut linked: Vec<Linked> = linked.collect();
    linked.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));
    linked
}

/// Whether one of the ways to take the licence is allowed: all that stand between AND, at least one between OR.
fn is_allowed(licence: &str) -> bool {
    licence.split(" AND ").all(|part| {
        let ways = part.trim_matches(|c| c == '(' || c == ')');
        ways.split(" OR ").any(|way| ALLOWED.contains(&way))
    })
}

fn page(linked: &[Linked]) -> String {
    let mut by_licence: BTreeMap<&str, Vec<&Linked>> = BTreeMap::new();
    for one in linked {
        by_licence.entry(&one.licence).or_default().push(one);
    }
    let mut page = String::from(
        "# Licences\n\n\
         Handscope itself is under MIT or Apache-2.0, as you choose. What it is linked\n\
         with on Linux follows, by licence; each source is at\n\
         `https://crates.io/crates/NAME/VERSION`, unchanged.\n\n\
         Fonts in the program: Noto Sans SC (a subset), Noto Emoji: SIL Open Font License\n\
         1.1; Ubuntu Light: Ubuntu Font Licence 1.0; Hack: MIT; Material icons:\n\
         Apache-2.0.\n",
    );
    for (licence, crates) in by_licence {
        writeln!(page, "\n## {licence}\n").unwrap();
        let mut line = String::new();
        for (n, one) in crates.iter().enumerate() {
            let end = if n + 1 == crates.len() { "" } else { "," };
            let word = if licence.contains("MPL") {
                format!("{} {} ({}){end}", one.name, one.version, one.repository)
            } else {
                format!("{} {}{end}", one.name, one.version)
            };
            if !line.is_empty() && line.len() + 1 + word.len() > COLUMNS {
                writeln!(page, "{line}").unwrap();
                line.clear();
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += &word;
        }
        writeln!(page, "{line}").unwrap();
    }
    page
}

#[test]
fn the_page_of_licences_lists_all_that_is_linked_and_nothing_else_is_allowed() {
    let linked = linked();
    assert!(linked.len() > 200, "{}", linked.len());
    for one in &linked {
        assert!(
            is_allowed(&one.licence),
            "{} {}: {}",
            one.name,
            one.version,
            one.licence
        );
    }
    let page = page(&linked);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(PAGE);
    if std::env::var_os("RENEW").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(
        std::fs::read_to_string(path).unwrap(),
        page,
        "RENEW=1 cargo test --test it licences"
    );
}

#[test]
fn everything_in_the_lock_file_comes_from_the_registry_with_a_checksum() {
    let packages: Vec<&str> = LOCK.split("[[package]]").skip(1).collect();
    assert!(packages.len() > 300);
    for package in packages {
        let is_own = OWN
            .iter()
            .any(|name| package.contains(&format!("name = \"{name}\"")));
        let is_registered = package.contains(&format!("source = \"{REGISTRY}\""))
            && package.contains("\nchecksum = \"");
        assert!(is_own || is_registered, "{package}");
    }
}

#[test]
fn a_licence_is_allowed_only_if_each_of_its_parts_is() {
    for (licence, allowed) in [
        ("MIT OR GPL-3.0-only", true),
        ("GPL-3.0-only", false),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("MIT AND GPL-3.0-only", false),
        ("", false),
    ] {
        assert_eq!(is_allowed(licence), allowed, "{licence}");
    }
}

//! The content of the screen as a list for scripts. Draws nothing and presses nothing.

use std::collections::HashMap;

use egui::accesskit::{Node, NodeId, Role, Toggled, TreeUpdate};
use serde_json::{Value, json};

/// Rectangles are rounded to this fraction of a point, so that noise does not change the list.
const PARTS_OF_A_POINT: f64 = 100.0;

/// Lists everything named or valued in `update`, depth first, as objects `{"role", "name", "value", "rect": [x, y, w, h],
/// "disabled", "toggled"}`.
///
/// `role` is in `lower_snake_case`. `name` is the visible text, or `null`. `value` is a number, a text, or `null`. A label that
/// shows a reading has the reading's name as `name` and the displayed text as `value`. `rect` is in points from the top left, or
/// `null`. `toggled` is `true`, `false`, `"mixed"`, or `null` if it does not apply. The order is that of drawing, so equal
/// screens give equal lists.
pub fn labels_json(update: &TreeUpdate) -> Value {
    let mut nodes: HashMap<NodeId, &Node> =
        update.nodes.iter().map(|(id, node)| (*id, node)).collect();
    let names: HashMap<NodeId, String> = update
        .nodes
        .iter()
        .filter_map(|(id, node)| Some((*id, own_text(node)?.to_owned())))
        .collect();
    let mut list = Vec::new();
    let mut open: Vec<NodeId> = update.tree.iter().map(|tree| tree.root).collect();
    while let Some(id) = open.pop() {
        // Removed, so that a node is listed once even in a broken tree.
        let Some(node) = nodes.remove(&id) else {
            continue;
        };
        // Text runs repeat the text of their label or field.
        if node.role() == Role::TextRun {
            continue;
        }
        list.extend(entry(node, &names));
        open.extend(node.children().iter().rev());
    }
    Value::Array(list)
}

fn entry(node: &Node, names: &HashMap<NodeId, String>) -> Option<Value> {
    let name = name(node, names);
    let value = value(node);
    if name.is_none() && value.is_null() {
        return None;
    }
    let rect = node
        .bounds()
        .map(|bounds| [bounds.x0, bounds.y0, bounds.width(), bounds.height()].map(rounded));
    let toggled = match node.toggled() {
        None => Value::Null,
        Some(Toggled::True) => Value::Bool(true),
        Some(Toggled::False) => Value::Bool(false),
        Some(Toggled::Mixed) => Value::from("mixed"),
    };
    Some(json!({
        "role": snake_case(&format!("{:?}", node.role())),
        "name": name,
        "value": value,
        "rect": rect,
        "disabled": node.is_disabled(),
        "toggled": toggled,
    }))
}

/// Name of a node. A plain label has its text where others have their value; one that shows the value of something also has its
/// name.
fn own_text(node: &Node) -> Option<&str> {
    let text = match node.role() {
        Role::Label => node.label().or(node.value()),
        _ => node.label(),
    };
    text.filter(|text| !text.is_empty())
}

fn name(node: &Node, names: &HashMap<NodeId, String>) -> Option<String> {
    if let Some(own) = own_text(node) {
        return Some(own.to_owned());
    }
    let parts: Vec<&str> = node
        .labelled_by()
        .iter()
        .filter_map(|id| names.get(id).map(String::as_str))
        .collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

fn value(node: &Node) -> Value {
    match (node.numeric_value(), node.value()) {
        // A number that JSON cannot represent (NaN) becomes null.
        (Some(number), _) => Value::from(number),
        (None, Some(text)) if node.role() != Role::Label => Value::from(text),
        (None, Some(text)) => node
            .label()
            .map_or(Value::Null, |name| displayed(name, text).into()),
        (None, None) => Value::Null,
    }
}

/// Text that is displayed by a label with this name and value. For a screen reader, the value begins with the name.
pub fn displayed<'a>(name: &str, value: &'a str) -> &'a str {
    let text = value.strip_prefix(name);
    let text = text.and_then(|text| text.strip_prefix(": "));
    text.unwrap_or(value)
}

fn rounded(points: f64) -> f64 {
    (points * PARTS_OF_A_POINT).round() / PARTS_OF_A_POINT
}

fn snake_case(camel: &str) -> String {
    let mut snake = String::with_capacity(camel.len() + 4);
    for letter in camel.chars() {
        if letter.is_uppercase() && !snake.is_empty() {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
    }
    snake
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;

    fn screen() -> Value {
        let (mut gain, mut on) = (40.0_f32, true);
        let mut word = String::from("seven");
        let context = Context::default();
        context.enable_accesskit();
        let mut output = context.run_ui(RawInput::default(), |ui| {
            ui.label("Ring finger");
            ui.add_enabled(false, egui::Button::new("STOP"));
            ui.add(egui::Slider::new(&mut gain, 0.0..=100.0).text("Gain"));
            ui.horizontal(|ui| {
                let title = ui.label("Name");
                ui.text_edit_singleline(&mut word).labelled_by(title.id);
            });
            ui.checkbox(&mut on, "Live");
        });
        output.textures_delta.clear();
        labels_json(&output.platform_output.accesskit_update.unwrap())
    }

    #[test]
    fn every_visible_text_is_listed_once_in_order() {
        let list = screen();
        let named: Vec<(String, String)> = list
            .as_array()
            .unwrap()
            .iter()
            .map(|entry| (entry["role"].to_string(), entry["name"].to_string()))
            .map(|(role, name)| (role.replace('"', ""), name.replace('"', "")))
            .collect();
        let place = |role: &str, name: &str| {
            let hits: Vec<usize> = (0..named.len())
                .filter(|at| named[*at] == (role.to_owned(), name.to_owned()))
                .collect();
            assert_eq!(hits.len(), 1, "{role} {name}: {named:?}");
            hits[0]
        };
        let order = [
            place("label", "Ring finger"),
            place("button", "STOP"),
            place("slider", "Gain"),
            place("label", "Name"),
            place("text_input", "Name"),
            place("check_box", "Live"),
        ];
        assert!(order.is_sorted(), "{named:?}");
    }

    #[test]
    fn values_and_states_are_typed() {
        let list = screen();
        let find = |role: &str| {
            let all = list.as_array().unwrap();
            all.iter()
                .find(|entry| entry["role"] == role)
                .unwrap()
                .clone()
        };
        assert_eq!(find("slider")["value"], json!(40.0));
        assert_eq!(find("text_input")["value"], json!("seven"));
        assert_eq!(find("label")["value"], Value::Null);
        assert_eq!(find("check_box")["toggled"], json!(true));
        assert_eq!(find("button")["disabled"], json!(true));
        assert_eq!(find("button")["toggled"], Value::Null);
        assert_eq!(find("check_box")["disabled"], json!(false));
        let rect: Vec<f64> = serde_json::from_value(find("button")["rect"].clone()).unwrap();
        assert!(
            rect.len() == 4 && rect[2] > 10.0 && rect[3] > 10.0,
            "{rect:?}"
        );
    }

    #[test]
    fn a_reading_has_its_name_beside_what_is_written() {
        let context = Context::default();
        context.enable_accesskit();
        let mut output = context.run_ui(RawInput::default(), |ui| {
            let reading = ui.label("417");
            ui.ctx().accesskit_node_builder(reading.id, |node| {
                node.set_label("Ring angle");
                node.set_value("Ring angle: 417");
            });
        });
        output.textures_delta.clear();
        let list = labels_json(&output.platform_output.accesskit_update.unwrap());
        let all = list.as_array().unwrap();
        let reading = all.iter().find(|entry| entry["role"] == "label").unwrap();
        assert_eq!(reading["name"], json!("Ring angle"));
        assert_eq!(reading["value"], json!("417"));
    }

    #[test]
    fn equal_screens_give_equal_lists() {
        assert_eq!(screen().to_string(), screen().to_string());
    }
}

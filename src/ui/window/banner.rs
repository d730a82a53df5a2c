//! Full-width warnings under the top bar: link lost, stop not confirmed, faults. Decides what to warn of; sends nothing.

use crate::app::hand::Freshness;
use crate::hand::Dof;
use crate::link::Dialling;
use crate::record::{Hold, LinkState};
use crate::ui::kit::controls;
use crate::ui::kit::controls::{Button, Label, take_left, take_right};
use crate::ui::kit::format;
use crate::ui::kit::look::{Look, Pane};
use crate::ui::text::{Text, errors, main, words};
use crate::ui::theme;
use crate::ui::view::View;
use egui::{
    Align2, Color32, CornerRadius, Galley, Id, Rect, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use std::sync::Arc;
use std::time::Duration;

/// A hand that answers sooner is there before a word could be read.
const ANNOUNCE_AFTER: Duration = Duration::from_millis(500);

/// One warning.
pub(crate) struct Banner {
    title: Text,
    body: String,
    aside: String,
    color: Color32,
    /// The view that helps, with the button's text and what it does.
    opens: Option<(View, Text, Text)>,
}

/// The warnings of now, worst first.
pub(crate) fn banners(pane: &Pane<'_>) -> Vec<Banner> {
    [
        alarm(pane),
        lost(pane),
        faults(pane),
        rival(pane),
        stale(pane),
        connecting(pane),
        empty(pane),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn alarm(pane: &Pane<'_>) -> Option<Banner> {
    matches!(pane.state.hand().link.hold, Hold::Alarm { .. }).then(|| Banner {
        title: main::ALARM_TITLE,
        body: pane.look.say(main::ALARM_BODY).into(),
        aside: String::new(),
        color: pane.look.palette.bad,
        opens: None,
    })
}

fn lost(pane: &Pane<'_>) -> Option<Banner> {
    let link = &pane.state.hand().link;
    if link.state != LinkState::Offline && link.state != LinkState::Identifying {
        return None;
    }
    let trouble = link.trouble.as_ref()?;
    // A hand that has answered may be moving; one that never did is only not reached.
    let known = pane.state.hand().sample.angle.is_some();
    let (title, color) = if known {
        (main::LOST_TITLE, pane.look.palette.bad)
    } else {
        (main::UNREACHABLE_TITLE, pane.look.palette.warn)
    };
    let cause = errors::trouble(pane.look, trouble);
    let body = if known {
        format!("{} {cause}", pane.look.say(main::LOST_BODY))
    } else {
        cause
    };
    Some(Banner {
        title,
        body,
        aside: retry(pane),
        color,
        opens: None,
    })
}

fn retry(pane: &Pane<'_>) -> String {
    match pane.state.hand().link.dialling {
        Dialling::Idle => String::new(),
        Dialling::Trying { attempt } => {
            format!("{} {attempt}", pane.look.say(main::LOST_TRYING))
        }
        Dialling::Waiting { until, .. } => {
            let left = until.since(pane.state.now).as_secs_f64();
            format!("{} {left:.1} s", pane.look.say(main::LOST_RETRY_IN))
        }
    }
}

fn faults(pane: &Pane<'_>) -> Option<Banner> {
    let faults = pane
        .state
        .hand()
        .sample
        .faults
        .filter(|_| pane.state.hand().sample.has_fault())?;
    let look = pane.look;
    let list: Vec<String> = Dof::ALL
        .into_iter()
        .flat_map(|dof| faults.value[dof].iter().map(move |fault| (dof, fault)))
        .map(|(dof, fault)| {
            let title = words::fault(fault, look.language).title;
            format!("{}: {title}", look.say(words::dof(dof)))
        })
        .collect();
    Some(Banner {
        title: main::FAULT_TITLE,
        body: format!(
            "{}{}{}",
            list.join(" · "),
            look.say(main::LIST_END),
            look.say(main::FAULT_BODY)
        ),
        aside: String::new(),
        color: look.value(pane.freshness(Some(faults.asked)), look.palette.bad),
        opens: Some((View::Faults, main::FAULT_SHOW, main::FAULT_SHOW_TIP)),
    })
}

fn rival(pane: &Pane<'_>) -> Option<Banner> {
    let link = &pane.state.hand().link;
    (link.state.is_live() && link.other_controller).then(|| Banner {
        title: main::RIVAL_TITLE,
        body: pane.look.say(main::RIVAL_BODY).into(),
        aside: String::new(),
        color: pane.look.palette.warn,
        opens: None,
    })
}

fn stale(pane: &Pane<'_>) -> Option<Banner> {
    let asked = pane.state.hand().sample.angle?.asked;
    let link = &pane.state.hand().link;
    // While the hand saves, nobody asks it: whoever wanted that sees it where it was wanted.
    let expected = link.state.is_live() && !link.line_left;
    (expected && pane.freshness(Some(asked)) == Freshness::Stale).then(|| Banner {
        title: main::STALE_TITLE,
        body: format!(
            "{} {}",
            pane.look.say(main::STALE_BODY),
            format::age(pane.state.now.since(asked))
        ),
        aside: String::new(),
        color: pane.look.palette.warn,
        opens: None,
    })
}

/// A hand that is asked for the first time, and has not said no yet.
fn connecting(pane: &Pane<'_>) -> Option<Banner> {
    let link = &pane.state.hand().link;
    let hand = pane.state.hand().endpoint.as_ref()?;
    let asks = matches!(link.state, LinkState::Offline | LinkState::Identifying);
    // One that answers at once is not announced.
    let waited = pane.state.now.since(link.since) >= ANNOUNCE_AFTER;
    (asks && waited && link.trouble.is_none()).then(|| Banner {
        title: main::CONNECTING_TITLE,
        body: format!("{} {hand}", pane.look.say(main::CONNECTING_BODY)),
        aside: retry(pane),
        color: pane.look.palette.accent,
        opens: Some((View::Connection, main::EMPTY_OPEN, main::EMPTY_OPEN_TIP)),
    })
}

fn empty(pane: &Pane<'_>) -> Option<Banner> {
    pane.state.hand().endpoint.is_none().then(|| Banner {
        title: main::EMPTY_TITLE,
        body: pane.look.say(main::EMPTY_BODY).into(),
        aside: String::new(),
        color: pane.look.palette.accent,
        opens: Some((View::Connection, main::EMPTY_OPEN, main::EMPTY_OPEN_TIP)),
    })
}

impl Banner {
    /// The height it needs: a sentence that does not fit beside the title takes more lines.
    pub(crate) fn height(&self, ui: &Ui, width: f32, look: Look) -> f32 {
        let button = self.opens.map_or(0.0, |(_, text, _)| {
            controls::text_width(ui, look.say(text), theme::body()) + 2.0 * theme::PAD + theme::GAP
        });
        let aside = match self.aside.as_str() {
            "" => 0.0,
            aside => controls::text_width(ui, aside, theme::number()) + 1.0 + theme::GAP,
        };
        let title = controls::text_width(ui, look.say(self.title), theme::title());
        let before = theme::GAP + theme::PAD + theme::SIGN_ROOM + title + theme::GAP + theme::STEP;
        let room = width - before - 1.0 - button - aside - theme::PAD - theme::GAP;
        let body = self.galley(ui, room, look).size().y;
        theme::BANNER.max(body + theme::GAP + 2.0 * theme::STEP)
    }

    fn galley(&self, ui: &Ui, width: f32, look: Look) -> Arc<Galley> {
        let color = look.palette.text;
        ui.painter()
            .layout(self.body.clone(), theme::body(), color, width.max(1.0))
    }

    /// Draws it. The view that was asked for.
    pub(crate) fn ui(&self, ui: &mut Ui, rect: Rect, look: Look) -> Option<View> {
        let palette = look.palette;
        let ground = rect
            .shrink2(vec2(theme::GAP, 0.0))
            .with_min_y(rect.top() + theme::GAP);
        ui.painter().rect(
            ground,
            CornerRadius::same(theme::ROUND),
            palette.wash(self.color),
            Stroke::new(1.0, self.color),
            StrokeKind::Inside,
        );
        let mut rest = ground.shrink2(vec2(theme::PAD, 0.0));
        let sign = Rect::from_center_size(
            pos2(rest.left() + theme::SIGN / 2.0, rest.center().y),
            vec2(theme::SIGN, theme::SIGN_HEIGHT),
        );
        if self.color == palette.accent {
            controls::lamp(ui, sign.center(), self.color);
        } else {
            controls::warning_sign(ui, sign, self.color);
        }
        rest.min.x += theme::SIGN_ROOM;
        let title = look.say(self.title);
        let width = controls::text_width(ui, title, theme::title()) + 1.0;
        Label::new(title, self.color)
            .font(theme::title())
            .put(ui, take_left(&mut rest, width));
        rest.min.x += theme::STEP;
        let mut asked = None;
        if let Some((view, text, tip)) = self.opens {
            let text = look.say(text);
            let width = controls::text_width(ui, text, theme::body()) + 2.0 * theme::PAD;
            let place = controls::middle(take_right(&mut rest, width), theme::CONTROL);
            let button = Button::new(text, look.say(tip));
            let id = Id::unique(("banner", view.name()));
            if button.put(ui, look, place, id).clicked() {
                asked = Some(view);
            }
        }
        if !self.aside.is_empty() {
            let width = controls::text_width(ui, &self.aside, theme::number()) + 1.0;
            let place = take_right(&mut rest, width);
            Label::new(&self.aside, palette.muted)
                .number()
                .right()
                .put(ui, place);
        }
        let response = ui.allocate_rect(rest, egui::Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &self.body));
        let galley = self.galley(ui, rest.width(), look);
        let place = Align2::LEFT_CENTER.align_size_within_rect(galley.size(), rest);
        ui.painter().galley(place.min, galley, palette.text);
        asked
    }
}

//! The hands that are opened at start. Remembers nothing.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::state::State;
use crate::hand::Moment;
use crate::transport::Endpoint;

impl State {
    /// Opens the given hand, else the remembered one, else the built-in one.
    pub(super) fn open(&mut self, endpoint: Option<Endpoint>, env: &Env, now: Moment) {
        let endpoint = endpoint
            .or_else(|| self.remembered(now))
            .unwrap_or_else(Endpoint::sim);
        let Self {
            hands,
            notices,
            settings,
            ..
        } = self;
        let hand = hands.shown_mut();
        hand.now = now;
        hand.go(Some(endpoint), env, notices);
        hand.apply_settings(settings);
    }

    /// Opens further hands, each in a slot of its own; the first stays shown.
    pub(super) fn open_beside(&mut self, endpoints: Vec<Endpoint>, env: &Env, now: Moment) {
        let first = self.hand().label.slot;
        for endpoint in endpoints {
            self.now = now;
            let is_new = !self.is_open_elsewhere(&endpoint, None);
            if is_new && self.hands.has_room() {
                self.hands.add();
                self.open(Some(endpoint), env, now);
            }
        }
        self.hands.show(first);
    }

    fn remembered(&mut self, now: Moment) -> Option<Endpoint> {
        let text = self.settings.endpoint.clone()?;
        match text.parse() {
            Ok(endpoint) => Some(endpoint),
            Err(_) => {
                self.notices.about(None);
                self.notices.push(now, NoticeKind::EndpointIgnored { text });
                None
            }
        }
    }
}

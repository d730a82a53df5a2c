//! The hands that are opened at start. Remembers nothing.

use crate::app::env::Env;
use crate::app::notices::NoticeKind;
use crate::app::program::hands;
use crate::app::state::State;
use crate::hand::Moment;
use crate::transport::Endpoint;

/// Opens the given hand, else the remembered one, else the built-in one.
pub(super) fn open(state: &mut State, endpoint: Option<Endpoint>, env: &Env, now: Moment) {
    let endpoint = endpoint
        .or_else(|| remembered(state, now))
        .unwrap_or_else(Endpoint::sim);
    state.now = now;
    hands::with_shown(state, env, |hand, settings, ctx| {
        hand.go(Some(endpoint), ctx);
        hand.apply_settings(settings);
    });
}

/// Opens further hands, each in a slot of its own; the first stays shown.
pub(super) fn open_beside(state: &mut State, endpoints: Vec<Endpoint>, env: &Env, now: Moment) {
    let first = state.hand().label.slot;
    for endpoint in endpoints {
        state.now = now;
        let is_new = !hands::is_open_elsewhere(state, &endpoint, None);
        if is_new && state.hands.has_room() {
            state.hands.add(now);
            open(state, Some(endpoint), env, now);
        }
    }
    state.hands.show(first);
}

fn remembered(state: &mut State, now: Moment) -> Option<Endpoint> {
    let text = state.settings.endpoint.clone()?;
    match text.parse() {
        Ok(endpoint) => Some(endpoint),
        Err(_) => {
            state
                .notices
                .push(now, NoticeKind::EndpointIgnored { text });
            None
        }
    }
}

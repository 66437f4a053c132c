//! What happened since the last frame, in portions that egui can distinguish.

use egui::{Event, RawInput};

/// Events that wait for the next frame.
#[derive(Default)]
pub(super) struct Waiting(Vec<Event>);

impl Waiting {
    /// Leaves in `input` what one frame takes: all up to the first mouse button that is pressed, or all before
    /// the first one that is released, or that release.
    ///
    /// egui sees the mouse as it is at the end of a frame. Where a frame takes longer than a click or a drag,
    /// it would miss that a button was down, miss how far the mouse went before the release, or drag a slider
    /// to where the mouse went after it.
    pub(super) fn divide(&mut self, input: &mut RawInput) {
        self.0.append(&mut input.events);
        let change = self.0.iter().enumerate().find_map(|(place, event)| match event {
            Event::PointerButton { pressed, .. } => Some((place, *pressed)),
            _ => None,
        });
        let count = match change {
            None => self.0.len(),
            Some((place, false)) if place > 0 => place,
            Some((place, _)) => place + 1,
        };
        input.events = self.0.drain(..count).collect();
    }

    /// Whether another frame is due at once.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, Pos2, pos2};

    use super::*;

    fn button(pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::default() }
    }

    #[test]
    fn a_click_within_a_frame_is_two_frames_and_a_drag_is_three() {
        let (here, there) = (pos2(1.0, 2.0), pos2(30.0, 40.0));
        let events =
            [Event::PointerMoved(here), button(here, true), button(here, false), Event::PointerMoved(there)];
        let mut waiting = Waiting::default();
        let mut portion = |events: &[Event]| {
            let mut input = RawInput { events: events.to_vec(), ..RawInput::default() };
            waiting.divide(&mut input);
            (input.events, waiting.is_empty())
        };
        assert_eq!(portion(&events), (events[..2].to_vec(), false));
        // What comes meanwhile stays behind what waits.
        assert_eq!(portion(&[Event::PointerGone]), (events[2..3].to_vec(), false));
        assert_eq!(portion(&[]), (vec![events[3].clone(), Event::PointerGone], true));
        // A drag: its moves have a frame before the release.
        let drag = [button(here, true), Event::PointerMoved(there), button(there, false)];
        assert_eq!(portion(&drag), (drag[..1].to_vec(), false));
        assert_eq!(portion(&[]), (drag[1..2].to_vec(), false));
        assert_eq!(portion(&[]), (drag[2..].to_vec(), true));
    }
}

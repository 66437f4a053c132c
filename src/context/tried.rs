//! All failed attempts as one refusal: every answer, and the remedies that fit.

use std::collections::BTreeMap;

use super::refusal::Refusal;
use super::{Candidate, DeviceChoice, Missing};

/// The answers of all devices that were tried.
pub(super) struct Tried<'a> {
    choice: &'a DeviceChoice,
    candidates: &'a [Candidate],
    /// A line each.
    answers: Vec<String>,
    /// Each with the devices that it helps.
    remedies: Vec<(String, Vec<String>)>,
    /// The devices that work but were not chosen, with their renderers.
    others: BTreeMap<String, String>,
}

impl<'a> Tried<'a> {
    pub(super) fn new(choice: &'a DeviceChoice, candidates: &'a [Candidate], missing: Vec<Missing>) -> Self {
        let (answers, remedies, others) = (Vec::new(), Vec::new(), BTreeMap::new());
        let mut tried = Self { choice, candidates, answers, remedies, others };
        for Missing { platform, refusal } in missing {
            if choice.covers(&platform) {
                tried.answers.push(format!("{platform}: {}", refusal.reason));
                tried.helps(&platform, refusal.remedy);
            }
        }
        tried
    }

    /// A device that works but was not chosen.
    pub(super) fn other(&mut self, candidate: &Candidate, renderer: &str) {
        let name = candidate.choice.to_string();
        self.answers.push(format!("{name}: is \"{renderer}\""));
        self.others.insert(name, renderer.to_owned());
    }

    /// A device that does not work.
    pub(super) fn refused(&mut self, candidate: &Candidate, refusal: Refusal) {
        let name = &candidate.choice;
        self.answers.push(format!("{name} ({}): {}", candidate.description, refusal.reason));
        self.helps(name, refusal.remedy);
    }

    fn helps(&mut self, device: &DeviceChoice, remedy: String) {
        // The remedy for OSMesa is left out unless OSMesa was chosen.
        if *device == DeviceChoice::OsMesa && *self.choice != DeviceChoice::OsMesa {
            return;
        }
        match self.remedies.iter_mut().find(|(known, _)| *known == remedy) {
            Some((_, devices)) => devices.push(device.to_string()),
            None => self.remedies.push((remedy, vec![device.to_string()])),
        }
    }

    /// All of it in one.
    pub(super) fn refusal(mut self) -> Refusal {
        let has = |choice: &DeviceChoice| self.candidates.iter().any(|one| choice.covers(&one.choice));
        // Where a whole platform is missing, its own reason is more specific.
        let is_unknown = !has(self.choice) && (self.answers.is_empty() || has(&DeviceChoice::Egl(None)));
        if is_unknown {
            self.answers.push("nothing: there is no such device".to_owned());
        }
        if is_unknown || !self.others.is_empty() || self.remedies.is_empty() {
            self.remedies.insert(0, (self.known(), Vec::new()));
        }
        let answers = self.answers.join("\n  ");
        let reason =
            format!("no usable OpenGL 3.3 context for --device {}; tried:\n  {answers}", self.choice);
        let several = self.remedies.len() > 1;
        let remedies = self.remedies.into_iter().map(|(remedy, devices)| {
            let whom = if several && !devices.is_empty() { devices.join(", ") + ": " } else { String::new() };
            whom + &remedy
        });
        Refusal::new(reason, remedies.collect::<Vec<_>>().join("\n  or "))
    }

    /// The devices that could be chosen instead.
    fn known(&self) -> String {
        let known = self.candidates.iter().filter(|candidate| candidate.is_installed()).map(|candidate| {
            let name = candidate.choice.to_string();
            let what = self.others.get(&name).unwrap_or(&candidate.description);
            format!("{name} ({what})")
        });
        let known: Vec<_> = known.collect();
        if known.is_empty() {
            return "`varikernel devices` says why there is none here".to_owned();
        }
        format!("choose a device that is here, by its name or a part of it: {}", known.join(", "))
    }
}

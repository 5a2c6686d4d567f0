//! The books of an advance by steps: where energy went, and counts.
//!
//! *Invariant*: what is booked at the start of a step reaches to the middle of it; with the powers of the step it is known at
//! every time within.

use crate::rigid::{Counts, Ledger};
use crate::stepping::bodies::{Bodies, Motion3, Nature};
use crate::stepping::rows::{Rows, Source};

/// Work [J] of some rows on bodies that can move.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Driven {
    /// By drives, motors and bodies that are moved.
    pub(super) drives: f64,
    /// By dry friction in joints: the heat, negative.
    pub(super) rubbing: f64,
}

/// Sums up to the middle of the present step, and powers [W] within it.
#[derive(Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct StepBooks {
    ledger: Ledger,
    counts: Counts,
    contacts: f64,
    damping: f64,
    drives: f64,
    rubbing: f64,
    laws: Vec<f64>,
    /// Energy [J] that contacts have taken in the present step, and in the one before, and blows at the start of this.
    taken: f64,
    spare: f64,
    blown: f64,
}

impl Clone for StepBooks {
    fn clone(&self) -> Self {
        Self { ledger: self.ledger.clone(), laws: self.laws.clone(), ..*self }
    }

    /// Uses the buffers again.
    fn clone_from(&mut self, source: &Self) {
        let (mut ledger, mut laws) = (std::mem::take(&mut self.ledger), std::mem::take(&mut self.laws));
        ledger.clone_from(&source.ledger);
        laws.clone_from(&source.laws);
        *self = Self { ledger, laws, ..*source };
    }
}

impl StepBooks {
    pub(super) fn new(laws: usize) -> Self {
        let ledger = Ledger { force_laws: vec![0.0; laws], ..Ledger::default() };
        Self { ledger, laws: vec![0.0; laws], ..Self::default() }
    }

    /// Adds a force law.
    pub(super) fn add_law(&mut self) {
        self.ledger.force_laws.push(0.0);
        self.laws.push(0.0);
    }

    /// Begins a step `late` [s] after the middle of the one before, if bodies set out from there with known velocities; from there
    /// on the powers are those of the new step.
    pub(super) fn begin(&mut self, late: f64) {
        self.ledger.steps += late * self.contacts;
        self.ledger.damping += late * self.damping;
        self.ledger.drives += late * self.drives;
        self.ledger.friction += late * self.rubbing;
        for (work, power) in self.ledger.force_laws.iter_mut().zip(&mut self.laws) {
            *work += late * std::mem::take(power);
        }
        (self.contacts, self.damping, self.drives, self.rubbing) = (0.0, 0.0, 0.0, 0.0);
        (self.spare, self.taken, self.blown) = (self.taken, 0.0, 0.0);
        self.counts.segments += 1;
        self.counts.events += 1;
    }

    /// Books what contacts, connectors and damping did to a body in a time `span` [s] that ends in the middle of the step. It went
    /// at a mean velocity, and has changed by `pushed` beyond what forces without contacts do.
    pub(super) fn book_body(
        &mut self,
        (bodies, place): (&Bodies, usize),
        mean: Motion3,
        pushed: Motion3,
        span: f64,
        is_present: bool,
    ) {
        let Nature { body, free_motion, .. } = &bodies.natures[place];
        let in_step = bodies.inertia_in_step(place);
        let against_pushes = [in_step.inverse_mass, in_step.inverse_mass, in_step.inverse_moment];
        let inverse = [body.inverse_mass, body.inverse_mass, body.inverse_moment];
        let rates = [free_motion.linear_rate, free_motion.linear_rate, free_motion.angular_rate];
        let (mut work, mut damped) = (0.0, 0.0);
        for k in 0..3 {
            work += mean[k] * pushed[k] / against_pushes[k];
            damped -= rates[k] * mean[k] * mean[k] / inverse[k];
        }
        self.ledger.steps += work;
        self.taken -= work;
        self.ledger.damping += span * damped;
        if is_present {
            self.contacts += work / span;
            self.damping += damped;
        }
    }

    /// Books what drives did in a time `span` [s] that ends in the middle of the step, of what has been booked of bodies.
    pub(super) fn book_driven(&mut self, driven: Driven, span: f64, is_present: bool) {
        let Driven { drives, rubbing } = driven;
        self.ledger.steps -= drives + rubbing;
        self.ledger.drives += drives;
        self.ledger.friction += rubbing;
        if is_present {
            self.contacts -= (drives + rubbing) / span;
            self.drives += drives / span;
            self.rubbing += rubbing / span;
        }
    }

    /// Books what a force law did in a time `span` [s] that ends in the middle of the step.
    pub(super) fn book_law(&mut self, law: usize, power: f64, span: f64, is_present: bool) {
        self.ledger.force_laws[law] += span * power;
        if is_present {
            self.laws[law] += power;
        }
    }

    pub(super) fn book_impact(&mut self, change: f64) {
        self.book_blow(change);
        self.counts.impacts += 1;
    }

    /// Books what a body loses in contacts that end fast and give nothing back: they are no impacts of their own.
    pub(super) fn book_blow(&mut self, change: f64) {
        self.ledger.impacts += change;
        self.blown -= change;
    }

    /// Energy [J] that contacts have taken in the step before, and blows at its end: a projection may give it back.
    pub(super) fn spare(&self) -> f64 {
        (self.spare + self.blown).max(0.0)
    }

    pub(super) fn book_projection(&mut self, change: f64) {
        self.ledger.projections += change;
    }

    pub(super) fn book_intervention(&mut self, change: f64) {
        self.ledger.interventions += change;
    }

    pub(super) fn note_gaps(&mut self, rows: &Rows, target_gap: f64) {
        for row in &rows.all {
            match row.source {
                Source::Contact { .. } if row.touches => self.counts.note_gap(row.gap + target_gap),
                Source::Connector { .. } if row.is_bilateral => {
                    self.counts.note_connector_error(row.gap.abs())
                }
                _ => {}
            }
        }
    }

    pub(super) fn note_solve(&mut self) {
        self.counts.contact_solves += 1;
    }

    pub(super) fn note_kinetic(&mut self, energy: f64) {
        self.counts.largest_kinetic_energy = self.counts.largest_kinetic_energy.max(energy);
    }

    pub(super) fn counts(&self) -> Counts {
        self.counts
    }

    /// Writes the ledger of a time `late` [s] after the middle of the present step.
    pub(super) fn write(&self, late: f64, ledger: &mut Ledger) {
        ledger.clone_from(&self.ledger);
        ledger.steps += late * self.contacts;
        ledger.damping += late * self.damping;
        ledger.drives += late * self.drives;
        ledger.friction += late * self.rubbing;
        for (work, power) in ledger.force_laws.iter_mut().zip(&self.laws) {
            *work += late * power;
        }
    }
}

//! The length of steps that are chosen by a tolerance: two steps are compared with one of twice the length.
//!
//! *Invariant*: steps of one length come in twos, but for those that a caller cuts short; a trial leaves nothing behind.
//!
//! Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.4 (step doubling).

use crate::rigid::ImpactReport;
use crate::stepping::bodies::{Bodies, Course, Motion3, Places, farthest};
use crate::stepping::books::StepBooks;
use crate::stepping::pairs::Pairs;
use crate::stepping::settings::SteppingSettings;
use crate::stepping::sleep::Sleep;
use crate::stepping::step::{From, Scene, Stepper};
use crate::stepping::ties::Tie;
use crate::time::Time;

/// Error, as a share of the tolerance, below which the next steps are twice as long [-]: that of smooth motion grows eightfold with the length
/// of a step.
const EASY: f64 = 1.0 / 16.0;

/// Largest way by which a body is off after a step in which its acceleration changes at once, in units of the change of velocity that this
/// would make in the step times the length of the step [-]: if it changes in the middle, half of a half of a half.
const TURN: f64 = 0.125;

/// Number of halvings of the longest step after which a step is taken as it is: what differs then is what solvers leave open.
const HALVINGS: i32 = 24;

/// Chooses the lengths of steps.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Pacing {
    /// Length [s] with which the next two steps are tried first.
    next: f64,
    /// The second of two steps is to come.
    owes_second: bool,
    #[cfg_attr(feature = "save", serde(skip))]
    kept: Kept,
    /// Places in the middle of the long step and at its end.
    #[cfg_attr(feature = "save", serde(skip))]
    long: Vec<[Motion3; 2]>,
    /// What trials tell, which nobody reads.
    #[cfg_attr(feature = "save", serde(skip))]
    report: ImpactReport,
}

impl Pacing {
    /// The first steps are tried with a length `first` [s].
    pub(super) fn new(first: f64) -> Self {
        Self {
            next: first,
            owes_second: false,
            kept: Kept::default(),
            long: Vec::new(),
            report: ImpactReport::default(),
        }
    }

    /// Returns the length [s] of the step that begins at a time [s], where the bodies are: with it no way of a body in two steps is off by more
    /// than `accuracy` [m], as far as can be told.
    pub(super) fn choose(
        &mut self,
        (scene, stepper, books): (&mut Scene, &mut Stepper, &mut StepBooks),
        (settings, accuracy): (&SteppingSettings, f64),
        time: f64,
        from: From,
    ) -> f64 {
        if let (true, From::Before(last)) = (self.owes_second, from) {
            self.owes_second = false;
            return last;
        }
        let least = settings.step * 2.0_f64.powi(-HALVINGS);
        let mut span = self.next;
        self.kept.keep(scene, books);
        loop {
            let off = self.try_span((scene, stepper, books), settings, (time, span), from);
            if off <= accuracy || span <= least {
                let is_easy = off <= EASY * accuracy;
                self.next = if is_easy { (2.0 * span).min(settings.step) } else { span };
                self.owes_second = true;
                return span;
            }
            span *= 0.5;
        }
    }

    /// Returns by how much [m] ways are off with steps of a length `span` [s].
    fn try_span(
        &mut self,
        (scene, stepper, books): (&mut Scene, &mut Stepper, &mut StepBooks),
        settings: &SteppingSettings,
        (time, span): (f64, f64),
        from: From,
    ) -> f64 {
        let Self { kept, long, report, .. } = self;
        let mut begin = |scene: &mut Scene, (time, span): (f64, f64), from: From| {
            report.begin(Time::from_seconds(time));
            stepper.begin(scene, (settings, time, span), from, (books, report));
        };
        begin(scene, (time, 2.0 * span), from);
        long.clear();
        let places = |course: &Course| [span, 2.0 * span].map(|since| course.place_at(since, 2.0 * span));
        long.extend(scene.bodies.courses.iter().map(places));
        kept.restore_scene(scene);
        begin(scene, (time, span), from);
        let lost = most_lost(&scene.bodies, span).max(most_turned(&scene.bodies, span));
        let apart = farthest_apart(&scene.bodies, span, long.iter().map(|[middle, _]| middle));
        scene.bodies.go_to(span, span);
        begin(scene, (time + span, span), From::Before(span));
        let lost = lost.max(most_lost(&scene.bodies, span)).max(most_turned(&scene.bodies, span));
        let apart = apart.max(farthest_apart(&scene.bodies, span, long.iter().map(|[_, end]| end)));
        // What turns late in the second step is seen by the kick that leads on from it.
        scene.bodies.go_to(span, span);
        begin(scene, (time + 2.0 * span, span), From::Before(span));
        let turned = most_turned(&scene.bodies, span);
        kept.restore_scene(scene);
        books.clone_from(&kept.books);
        lost.max(apart).max(turned)
    }
}

/// Largest distance [m] of bodies at the end of a step from where they would be.
fn farthest_apart<'a>(bodies: &Bodies, span: f64, others: impl Iterator<Item = &'a Motion3>) -> f64 {
    let Bodies { natures, courses, .. } = bodies;
    let apart = natures.iter().zip(courses).zip(others).map(|((nature, course), other)| {
        let own = course.place_at(span, span);
        farthest(nature.reach, std::array::from_fn(|k| own[k] - other[k]))
    });
    apart.fold(0.0, f64::max)
}

/// Longest way [m] that a body loses in a step because it comes to touch at the end of it, and not before.
fn most_lost(bodies: &Bodies, span: f64) -> f64 {
    let Bodies { natures, courses, .. } = bodies;
    let lost = natures.iter().zip(courses).map(|(nature, course)| {
        let slowed = std::array::from_fn(|k| course.smooth[k] - (1.0 - course.delay) * course.middle[k]);
        span * farthest(nature.reach, slowed)
    });
    lost.fold(0.0, f64::max)
}

/// Longest way [m] by which a body may be off because what pushes it begins, ends or turns near the start of a step: one of twice the length
/// may do the same.
fn most_turned(bodies: &Bodies, span: f64) -> f64 {
    bodies.courses.iter().map(|course| TURN * span * course.jump).fold(0.0, f64::max)
}

/// What a step changes.
#[derive(Clone, Debug, Default)]
struct Kept {
    places: Places,
    pairs: Pairs,
    ties: Vec<Tie>,
    sleep: Sleep,
    books: StepBooks,
}

impl Kept {
    fn keep(&mut self, scene: &Scene, books: &StepBooks) {
        let Scene { bodies, pairs, ties, laws: _, sleep } = scene;
        bodies.keep_places(&mut self.places);
        self.pairs.clone_from(pairs);
        self.ties.clone_from(&ties.memory);
        self.sleep.clone_from(sleep);
        self.books.clone_from(books);
    }

    fn restore_scene(&self, scene: &mut Scene) {
        let Scene { bodies, pairs, ties, laws: _, sleep } = scene;
        bodies.restore_places(&self.places);
        pairs.clone_from(&self.pairs);
        ties.memory.clone_from(&self.ties);
        sleep.clone_from(&self.sleep);
    }
}

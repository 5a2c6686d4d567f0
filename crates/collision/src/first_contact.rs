//! The first time at which a feature pair of two moving shapes closes to its target gap.
//!
//! No contact is missed: the search moves through windows of time, in each of which bounds on the motion leave
//! only feature pairs that can come near; each of these is decided by a closed form or by a march that never
//! passes a contact.

use crate::closed::{of_centers, quadratic};
use crate::detect::pair_tolerances;
use crate::march::{MarchEnd, Pair, Window, contact_is_within, reach_circle};
use crate::motion::{BodyState, Center, Motion, Polynomial};
use crate::tolerances::Tolerances;
use halfgap_geometry::{Feature, FeatureId, PairKind, Pose, Shape, pair_kind};

/// Lean of a corner off a line (angle times lever) at which it still fires, as a fraction of the accuracy [-].
const LEAN_SHARE: f64 = 1.0 / 16.0;

/// Distance beyond the end of a line at which a contact still fires, as a fraction of the accuracy [-]. The end is then
/// farther away than the line only by the order of the square of that distance, which is negligible.
const OVERRUN_SHARE: f64 = 1.0 / 1024.0;

/// Number of windows that are searched after a march that used up its steps, the first as long as the time it covered.
const CREEPING_WINDOWS: u32 = 64;

/// A shape in motion, as a search reads it.
#[derive(Clone, Copy, Debug)]
pub struct MovingShape<'a, M> {
    /// The shape in body coordinates.
    pub shape: &'a Shape,
    /// The motion of the body.
    pub motion: &'a M,
    /// Offset [s] in the motion at time 0 of the search.
    pub offset: f64,
}

impl<M: Motion> MovingShape<'_, M> {
    /// Largest distance [m] from the centre of mass of a point that moves when the shape turns: 0 for a disc about the
    /// centre of mass.
    fn turning_reach(&self) -> f64 {
        if self.shape.centered_disc().is_some() { 0.0 } else { self.shape.reach() }
    }

    /// True if the states at two times [s] of the search are finite, and bounded between them.
    fn is_known(&self, from: f64, to: f64) -> bool {
        let [from, to] = [from, to].map(|time| self.offset + time);
        let is_finite = |time: f64| {
            let BodyState { position, angle, velocity, angular_velocity } = self.motion.state_at(time);
            position.is_finite() && angle.is_finite() && velocity.is_finite() && angular_velocity.is_finite()
        };
        is_finite(from) && is_finite(to) && self.motion.bounds(from, to).are_finite()
    }
}

/// Limits of a search. Only `depth` and `rest` change its result.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SearchSettings {
    /// Number of steps of one march before the search pauses; the next call goes on from there. 0 counts as 1.
    pub march_steps: u32,
    /// Largest number of feature pairs that are all tried by closed form over the whole span at once.
    pub direct_pairs: usize,
    /// Number of feature pairs in a window above which the next window is shorter.
    pub crowded: usize,
    /// Number of windows with near feature pairs in one call of [`search_step`] before it pauses. 0 counts as 1.
    pub windows: u32,
    /// Overlap [m] up to which features count as touching, or `distance_tol` if that is more; deeper ones lie on the
    /// far sides of their bodies.
    pub depth: f64,
    /// Opening rate [m/s] up to which a march still reports a pair at or below its target. If nonzero, a pair that has
    /// not left its target in all steps of a march is reported too: the march would crawl along it. Closed forms ignore
    /// it.
    pub rest: f64,
}

impl SearchSettings {
    /// Settings that serve most scenes.
    pub const STANDARD: Self =
        Self { march_steps: 200, direct_pairs: 64, crowded: 8, windows: 4, depth: 0.0, rest: 0.0 };
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self::STANDARD
    }
}

/// The first contact of two shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstContact {
    /// Time [s] of the search at which the pair is at its target gap and closes.
    pub time: f64,
    /// Feature of the first shape.
    pub feature_a: FeatureId,
    /// Feature of the second shape.
    pub feature_b: FeatureId,
}

/// Result of a search over a span of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// The first contact.
    Contact(FirstContact),
    /// Proof that there is no contact before this time [s].
    NoneBefore(f64),
}

/// Finds the first time in [0, `span`), `span` finite [s], at which a feature pair of the two shapes is at or
/// below its target gap and closes.
///
/// Pairs that start at their target and open do not count until they close again. The result is a contact or
/// `NoneBefore(span)`. If a threshold, a motion at either end, or one of its bounds is not finite, nothing is proven, and
/// the result is `NoneBefore(0.0)`. Target gaps must exceed the rounding of coordinates
/// ([`Tolerances::target_gap`]), and the time a search takes grows with the bounds of the motions.
#[must_use]
pub fn first_contact<A: Motion, B: Motion>(
    a: &MovingShape<'_, A>,
    b: &MovingShape<'_, B>,
    span: f64,
    tolerances: &Tolerances,
    settings: &SearchSettings,
) -> Search {
    let mut from = 0.0;
    if !are_known(a, b, from, span, tolerances) {
        return Search::NoneBefore(from);
    }
    let search = PairSearch { a, b, tolerances, settings, rules: &[] };
    loop {
        match search.step(from, span) {
            Search::NoneBefore(time) if time < span => from = time,
            end => return end,
        }
    }
}

/// True if all numbers of a search are finite: else comparisons prove nothing.
fn are_known<A: Motion, B: Motion>(
    a: &MovingShape<'_, A>,
    b: &MovingShape<'_, B>,
    from: f64,
    span: f64,
    tolerances: &Tolerances,
) -> bool {
    tolerances.are_finite() && a.is_known(from, span) && b.is_known(from, span)
}

/// Continues a search from a time `from` [s], before which there must be no contact, up to `span` [s].
///
/// It may pause early, with proof for the part it has searched. Every call makes progress, but for one with a number that
/// is not finite (see [`first_contact`]): it returns `NoneBefore(from)`.
#[must_use]
#[inline]
pub fn search_step<A: Motion, B: Motion>(
    a: &MovingShape<'_, A>,
    b: &MovingShape<'_, B>,
    from: f64,
    span: f64,
    tolerances: &Tolerances,
    settings: &SearchSettings,
) -> Search {
    if !are_known(a, b, from, span, tolerances) {
        return Search::NoneBefore(from);
    }
    PairSearch { a, b, tolerances, settings, rules: &[] }.step(from, span)
}

/// Exception for one pair of features in a search: another target gap, or no search at all.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct FeatureRule {
    /// Feature of the first and of the second shape.
    pub features: [FeatureId; 2],
    /// Gap [m] at which the pair fires in place of its target gap; `None` if it is not searched at all.
    pub target: Option<f64>,
}

/// Finds the [`first_contact`] in [0, `span`) [s] of two discs about their centres of mass, each given as parabola and
/// radius [m] instead of a shape; `None` if there is no closed form, because the accelerations differ.
#[must_use]
#[inline]
pub fn disc_contact(
    (a, radius_a): (Polynomial, f64),
    (b, radius_b): (Polynomial, f64),
    span: f64,
    tolerances: &Tolerances,
) -> Option<Search> {
    let curve = of_centers(&a, &b, radius_a + radius_b, false, tolerances.target_gap)?;
    let time = curve.first_meeting(tolerances.distance_tol());
    if time >= span {
        return Some(Search::NoneBefore(span));
    }
    // A disc has one feature.
    Some(Search::Contact(FirstContact { time, feature_a: FeatureId(0), feature_b: FeatureId(0) }))
}

/// A search for the first contact of two shapes, with rules for some of their feature pairs.
#[derive(Clone, Copy, Debug)]
pub struct PairSearch<'a, A, B> {
    /// The first shape.
    pub a: &'a MovingShape<'a, A>,
    /// The second shape.
    pub b: &'a MovingShape<'a, B>,
    /// Thresholds of touching.
    pub tolerances: &'a Tolerances,
    /// Limits of the search.
    pub settings: &'a SearchSettings,
    /// Exceptions for single feature pairs, such as contacts that are active already or have just opened.
    pub rules: &'a [FeatureRule],
}

/// The earliest contact so far, and the time up to which all pairs have been searched.
struct Progress {
    contact: Option<FirstContact>,
    /// No contact before this time [s], other than `contact`.
    clear: f64,
}

impl Progress {
    fn none_before(clear: f64) -> Self {
        Self { contact: None, clear }
    }

    fn offer(&mut self, contact: FirstContact) {
        self.clear = self.clear.min(contact.time);
        self.contact = Some(contact);
    }

    fn pause_at(&mut self, time: f64) {
        self.clear = self.clear.min(time);
    }

    fn into_search(self) -> Search {
        match self.contact {
            Some(contact) if contact.time <= self.clear => Search::Contact(contact),
            _ => Search::NoneBefore(self.clear),
        }
    }
}

impl<A: Motion, B: Motion> PairSearch<'_, A, B> {
    /// Continues the search from a time `from` [s], before which there must be no contact, up to `span` [s]; see
    /// [`search_step`].
    #[must_use]
    #[inline]
    pub fn step(&self, from: f64, span: f64) -> Search {
        if self.is_left_alone() {
            return Search::NoneBefore(span);
        }
        self.directly(from, span).unwrap_or_else(|| self.by_windows(from, span))
    }

    /// True if the shapes have only one pair of features, and a rule excludes it.
    fn is_left_alone(&self) -> bool {
        let is_only = self.a.shape.features().len() == 1 && self.b.shape.features().len() == 1;
        is_only && self.rules.iter().any(|rule| rule.target.is_none())
    }

    /// True if both centres of mass follow parabolas: with other motions no feature pair has a closed form.
    fn is_parabolic(&self, from: f64) -> bool {
        let (a, b) = (self.a, self.b);
        a.motion.polynomial_from(a.offset + from).is_some()
            && b.motion.polynomial_from(b.offset + from).is_some()
    }

    /// Number of steps of a march, at least one, so that every call makes progress.
    fn march_steps(&self) -> u32 {
        self.settings.march_steps.max(1)
    }

    /// The largest gap [m] at which any feature pair fires.
    fn widest_target(&self) -> f64 {
        let of_rules = self.rules.iter().filter_map(|rule| rule.target);
        of_rules.fold(self.tolerances.target_gap, f64::max)
    }

    /// The largest distance [m] of two features at which they may fire, apart or overlapping.
    fn farthest_touch(&self) -> f64 {
        let of_rules = self.rules.iter().filter_map(|rule| rule.target).map(f64::abs);
        let depth = self.tolerances.distance_tol().max(self.settings.depth);
        of_rules.fold(self.tolerances.target_gap, f64::max) + depth
    }

    /// Searches all feature pairs over the whole span by closed form; `None` if there are too many or one has no closed
    /// form.
    fn directly(&self, from: f64, span: f64) -> Option<Search> {
        let (features_a, features_b) = (self.a.shape.features(), self.b.shape.features());
        let count = features_a.len() * features_b.len();
        if count > self.settings.direct_pairs || !self.is_parabolic(from) {
            return None;
        }
        // Most neighbouring bodies do not meet.
        if count > 1 && self.skip_far(from, span) >= span {
            return Some(Search::NoneBefore(span));
        }
        let mut progress = Progress::none_before(span);
        for (index_a, a) in features_a.iter().enumerate() {
            for (index_b, b) in features_b.iter().enumerate() {
                let Some(kind) = pair_kind(a, b) else { continue };
                let ids = [FeatureId::from_index(index_a), FeatureId::from_index(index_b)];
                let Some(pair) = self.pair(kind, ids, a, b) else { continue };
                if let Some(contact) = self.closed_form(&pair, ids, from, progress.clear)? {
                    progress.offer(contact);
                }
            }
        }
        Some(progress.into_search())
    }

    /// The contact of one pair between `from` and `limit` [s] by closed form: outer `None` if there is no closed form,
    /// inner `None` if the pair does not touch.
    fn closed_form(
        &self,
        pair: &Pair<'_>,
        ids: [FeatureId; 2],
        from: f64,
        limit: f64,
    ) -> Option<Option<FirstContact>> {
        let offsets = [self.a.offset + from, self.b.offset + from];
        let (a, b) = ((pair.feature_a, self.a.motion), (pair.feature_b, self.b.motion));
        let curve = quadratic(pair.kind, a, b, offsets, pair.target)?;
        let Some(wait) = curve.first_closing(pair.depth) else { return Some(None) };
        let time = from + wait;
        if time >= limit {
            return Some(None);
        }
        let contact = |time: f64| FirstContact { time, feature_a: ids[0], feature_b: ids[1] };
        if self.touches_at(pair, time) {
            return Some(Some(contact(time)));
        }
        // A contact point outside of the features may sink below the target: the pair touches if the point comes upon
        // the features before it is deeper than `depth`.
        let end = limit.min(from + curve.closes_until(wait, pair.depth));
        if end <= time {
            return Some(None);
        }
        let sinking = Window::new(self.a.motion, self.b.motion, [self.a.offset, self.b.offset], time, end);
        match sinking.march(pair, time, end, self.march_steps()) {
            MarchEnd::Closes(time) => Some(Some(contact(time))),
            MarchEnd::NoneBefore(time) => (time >= end).then_some(None),
        }
    }

    /// True if the contact point lies within both features at a time [s].
    fn touches_at(&self, pair: &Pair<'_>, time: f64) -> bool {
        let pose_a = self.a.motion.moving_at(self.a.offset + time).pose;
        let pose_b = self.b.motion.moving_at(self.b.offset + time).pose;
        contact_is_within(pair, [&pose_a, &pose_b])
    }

    /// The pair with its target and thresholds for the search; `None` if it is not searched. Inlined to keep it in
    /// registers.
    #[inline(always)]
    fn pair<'p>(
        &self,
        kind: PairKind,
        ids: [FeatureId; 2],
        a: &'p Feature,
        b: &'p Feature,
    ) -> Option<Pair<'p>> {
        let tolerances = pair_tolerances(a, b, self.tolerances);
        let rule = self.rules.iter().find(|rule| rule.features == ids);
        let target = rule.map_or(Some(tolerances.target_gap), |rule| rule.target)?;
        let depth = tolerances.distance_tol().max(self.settings.depth);
        // A target that a rule raises leaves the gap below which a pair lies behind as it is.
        let depth = depth + (target - tolerances.target_gap).max(0.0);
        let slack = [slack(a, self.a.shape.lever(ids[0]), b), slack(b, self.b.shape.lever(ids[1]), a)];
        let slack = slack.map(|share| share * tolerances.accuracy);
        let overrun = OVERRUN_SHARE * tolerances.accuracy;
        let rest = self.settings.rest;
        Some(Pair { kind, feature_a: a, feature_b: b, target, depth, slack, overrun, rest })
    }

    fn by_windows(&self, from: f64, span: f64) -> Search {
        let mut start = from;
        let mut length = None;
        let mut left = self.settings.windows.max(1);
        let mut is_creeping = false;
        while start < span && left > 0 {
            let near = self.skip_far(start, span);
            if near >= span {
                return Search::NoneBefore(span);
            }
            start = near;
            // A window shorter than the resolution of the clock is made one tick long.
            let end_after = |wanted: f64| span.min(start + wanted).max(start.next_up());
            let over = |end: f64| {
                Window::new(self.a.motion, self.b.motion, [self.a.offset, self.b.offset], start, end)
            };
            let (wanted, window) = match length {
                Some(wanted) => (wanted, over(end_after(wanted))),
                None => {
                    let mut window = over(span);
                    let wanted = self.first_length(&window);
                    let end = end_after(wanted);
                    if end < span {
                        window.end_at(end);
                    }
                    (wanted, window)
                }
            };
            let end = end_after(wanted);
            let (progress, tried) = self.search_window(&window, start, end);
            match progress.into_search() {
                Search::NoneBefore(time) if time >= end => start = end,
                Search::NoneBefore(time) if !is_creeping => {
                    // Bounds over a shorter window are tighter: a stretch along which a march has crept then takes a
                    // few steps.
                    (is_creeping, left) = (true, CREEPING_WINDOWS);
                    (length, start) = (Some(time - start), time);
                    continue;
                }
                end => return end,
            }
            // Windows without near features are not counted: their lengths double, so that few of them follow.
            left -= u32::from(tried > 0);
            length = Some(if tried > self.settings.crowded {
                0.5 * wanted
            } else if tried == 0 {
                2.0 * wanted
            } else {
                wanted
            });
        }
        Search::NoneBefore(start)
    }

    /// A time [s], not before `start`, up to which the circles around the two bodies do not meet.
    fn skip_far(&self, start: f64, span: f64) -> f64 {
        let circles = [reach_circle(self.a.shape.reach()), reach_circle(self.b.shape.reach())];
        let [circle_a, circle_b] = &circles;
        let target = self.widest_target();
        // The circles count as touching however deep they overlap.
        let pair = Pair {
            kind: PairKind::Outer,
            feature_a: circle_a,
            feature_b: circle_b,
            target,
            depth: f64::INFINITY,
            slack: [0.0; 2],
            overrun: 0.0,
            rest: 0.0,
        };
        let offsets = [self.a.offset + start, self.b.offset + start];
        let centers = (Center(self.a.motion), Center(self.b.motion));
        let (a, b) = ((circle_a, &centers.0), (circle_b, &centers.1));
        let distance = (a.1.center_at(offsets[0]).0 - b.1.center_at(offsets[1]).0).length();
        if distance <= self.a.shape.reach() + self.b.shape.reach() + target {
            return start;
        }
        match quadratic(PairKind::Outer, a, b, offsets, target) {
            Some(curve) => curve.first_closing(f64::INFINITY).map_or(span, |wait| start + wait),
            None => {
                let whole = Window::new(&centers.0, &centers.1, [self.a.offset, self.b.offset], start, span);
                match whole.march(&pair, start, span, self.march_steps()) {
                    MarchEnd::Closes(time) | MarchEnd::NoneBefore(time) => time,
                }
            }
        }
    }

    /// Length [s] of a first window, in which the bodies move by at most half of the lesser reach.
    fn first_length(&self, whole: &Window<'_, A, B>) -> f64 {
        let (reach_a, reach_b) = (self.a.shape.reach(), self.b.shape.reach());
        let turning =
            whole.spin_a.speed * self.a.turning_reach() + whole.spin_b.speed * self.b.turning_reach();
        let speed = whole.speed + turning;
        if speed > 0.0 { 0.5 * reach_a.min(reach_b) / speed } else { f64::INFINITY }
    }

    /// Searches one window; also returns the number of feature pairs that had to be tried.
    fn search_window(&self, window: &Window<'_, A, B>, start: f64, end: f64) -> (Progress, usize) {
        let half = 0.5 * (end - start);
        let (at_a, at_b) = window.at(start + half);
        // A point moves by at most its arm times the angle of a turn, and never farther than across its circle.
        let turned = |spin: f64, reach: f64| (spin * half).min(2.0) * reach;
        let moved = window.speed * half
            + turned(window.spin_a.speed, self.a.turning_reach())
            + turned(window.spin_b.speed, self.b.turning_reach());
        let reach = self.farthest_touch() + moved;
        let mut progress = Progress::none_before(end);
        let mut tried = 0;
        self.a.shape.tree().visit_near_pairs(
            &at_a.pose,
            self.b.shape.tree(),
            &at_b.pose,
            reach,
            &mut |a, b| {
                let (feature_a, feature_b) = (self.a.shape.feature(a), self.b.shape.feature(b));
                let Some(kind) = pair_kind(feature_a, feature_b) else { return };
                let sides = [(feature_a, &at_a.pose), (feature_b, &at_b.pose)];
                if is_off_circle(sides[0], sides[1], reach) || is_off_circle(sides[1], sides[0], reach) {
                    return;
                }
                if let Some(pair) = self.pair(kind, [a, b], feature_a, feature_b) {
                    tried += 1;
                    self.try_pair(window, &pair, [a, b], start, &mut progress);
                }
            },
        );
        (progress, tried)
    }

    fn try_pair(
        &self,
        window: &Window<'_, A, B>,
        pair: &Pair<'_>,
        ids: [FeatureId; 2],
        start: f64,
        progress: &mut Progress,
    ) {
        let limit = progress.clear;
        if self.is_parabolic(start)
            && let Some(found) = self.closed_form(pair, ids, start, limit)
        {
            if let Some(contact) = found {
                progress.offer(contact);
            }
            return;
        }
        match window.march(pair, start, limit, self.march_steps()) {
            MarchEnd::Closes(time) if time < limit => {
                progress.offer(FirstContact { time, feature_a: ids[0], feature_b: ids[1] });
            }
            MarchEnd::Closes(_) => {}
            MarchEnd::NoneBefore(time) => progress.pause_at(time),
        }
    }
}

/// True if the first feature is round, and the second surely farther than `reach` [m] from its circle. The tree cannot
/// tell, since the bounds of an arc contain its inside.
fn is_off_circle((feature, pose): (&Feature, &Pose), (other, at): (&Feature, &Pose), reach: f64) -> bool {
    let Feature::Round(round) = feature else { return false };
    let (center, size) = match other {
        Feature::Round(other) => (other.center, other.radius.abs()),
        Feature::Line(line) => (line.point_at(0.5 * (line.start + line.end)), 0.5 * (line.end - line.start)),
    };
    let distance = (pose.point_to_world(round.center) - at.point_to_world(center)).length();
    (distance - round.radius.abs()).abs() > size + reach
}

/// Angle per metre of accuracy [rad/m] by which a corner may lean off a line; 0 for all other pairs.
///
/// Edges that lie flat on each other are parallel up to rounding: their corners are now within, now outside
/// of their cones. A bound well above rounding keeps the search from stepping through every tick of the clock. No
/// corner fires too early because of it: the next corner along the edge is nearer then.
fn slack(feature: &Feature, lever: f64, other: &Feature) -> f64 {
    match (feature, other) {
        (Feature::Round(round), Feature::Line(_)) if round.radius == 0.0 => LEAN_SHARE / lever,
        _ => 0.0,
    }
}

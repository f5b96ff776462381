//! From change to change: what ends a motion, and what follows it.

use crate::clock::Instant;
use crate::contact::{Contact, Ending, Grip};
use crate::flight::{Flight, Landing};
use crate::kinematics::{Change, Kinematics, ModelEvent, Touch};
use crate::law::Law;
use crate::period::Round;
use crate::precision::Precision;
use crate::rigid::Rigid;
use crate::state::{Motion, RigidState};
use crate::turns::Turns;
use crate::wall::{Mode, WallState};
use crate::whirl::whirl;

/// Most impacts followed in one step; beyond it the rest of a bounce series is summed. Chosen, because a
/// whole series at restitution 0.95 fits in.
const IMPACTS_PER_STEP: u32 = 512;
/// Most stretches of contact followed in one step; beyond it whirl goes on by its mean. Chosen, because
/// 20 turns fit in.
const STRETCHES_PER_STEP: u32 = 256;
/// Most of both: forced contacts can lift off again, and grazes are no impacts.
const CHANGES_PER_STEP: u32 = IMPACTS_PER_STEP + STRETCHES_PER_STEP;
/// Square of the speed, in units of V, from which on whirl has a mean.
const WHIRL: f64 = 16.0;
/// Longest rest of a bounce series, in units of T, that is summed.
const LONGEST_REST: f64 = 1e-2;

impl<R: Precision> Rigid<R> {
    /// One step. Bounded; cannot fail. Changes of motion go to `sink` in the order of time.
    #[inline]
    pub fn step(&self, state: &mut RigidState<R>, mut on_event: impl FnMut(ModelEvent<R>)) {
        state.now = Instant::at_tick(state.now.tick + 1);
        if state.ends.is_reached_at(state.now) {
            self.follow(state, &mut on_event, |_| false);
        }
    }

    /// Goes to `until`, which is not before now, by those steps alone in which something changes, and
    /// past whole periods of a motion on the wall at once (`period.rs`): where there are none, it gives
    /// the bits of stepping. Costs the changes, at most what stepping does. Changes of motion go to
    /// `sink` in the order of time.
    pub fn run(
        &self,
        state: &mut RigidState<R>,
        until: Instant<R>,
        on_event: impl FnMut(ModelEvent<R>),
    ) {
        self.run_unless(state, until, on_event, |_| false);
    }

    /// As [`Self::run`], but ends after a step from which on the rotor whirls for ever; whether it does.
    pub fn run_to_verdict(
        &self,
        state: &mut RigidState<R>,
        until: Instant<R>,
        on_event: impl FnMut(ModelEvent<R>),
    ) -> bool {
        self.run_unless(state, until, on_event, |state| self.whirls_for_ever(state))
    }

    fn run_unless(
        &self,
        state: &mut RigidState<R>,
        until: Instant<R>,
        mut on_event: impl FnMut(ModelEvent<R>),
        ends: impl Fn(&RigidState<R>) -> bool,
    ) -> bool {
        let mut round = Round::new(until);
        while state.ends.is_reached_at(until) {
            let eventful = state.ends.next_tick().max(state.now.tick + 1);
            if eventful > until.tick {
                break;
            }
            state.now = Instant::at_tick(eventful);
            self.follow(state, &mut on_event, |state| round.take(self, state));
            if ends(state) {
                return true;
            }
        }
        if state.now != until {
            state.now = until;
            self.follow(state, &mut on_event, |_| false);
        }
        false
    }

    /// Goes through the changes up to now. Before a stretch of contact ends, `watch` may put it off, and
    /// says so. Never inlined: a step in which nothing changes is to stay a comparison.
    #[inline(never)]
    pub(crate) fn follow(
        &self,
        state: &mut RigidState<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
        mut watch: impl FnMut(&mut RigidState<R>) -> bool,
    ) {
        let (mut impacts, mut stretches) = (0, 0);
        while state.ends.is_reached_at(state.now) && impacts < CHANGES_PER_STEP {
            match &state.motion {
                &Motion::Flight { flight, to } => {
                    impacts += 1;
                    let hurry = impacts > IMPACTS_PER_STEP;
                    self.impact(state, &flight, to, hurry, on_event);
                }
                &Motion::Settling { onto, stuck } => self.settled(state, onto, stuck, on_event),
                Motion::Contact(_) if stretches < STRETCHES_PER_STEP => {
                    if watch(state) {
                        continue;
                    }
                    stretches += 1;
                    self.end_of_stretch(state, on_event);
                }
                Motion::Contact(contact) => {
                    let (base, mode) = (contact.base, contact.mode);
                    self.hurry_on(state, &base, mode, on_event);
                    break;
                }
            }
        }
        if impacts > IMPACTS_PER_STEP || stretches >= STRETCHES_PER_STEP {
            state.shortened = state.shortened.saturating_add(1);
        }
    }

    /// Goes to the next change of motion and through it alone; false where none lies ahead.
    pub fn next_change(
        &self,
        state: &mut RigidState<R>,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> bool {
        if state.ends == Instant::NEVER {
            return false;
        }
        state.now = state.ends;
        match &state.motion {
            &Motion::Flight { flight, to } => self.impact(state, &flight, to, false, &mut on_event),
            &Motion::Settling { onto, stuck } => self.settled(state, onto, stuck, &mut on_event),
            Motion::Contact(_) => self.end_of_stretch(state, &mut on_event),
        }
        true
    }

    fn settled(
        &self,
        state: &mut RigidState<R>,
        onto: WallState<R>,
        stuck: bool,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        state.begun = state.ends;
        self.enter_contact(state, onto, grip(stuck), on_event);
    }

    fn impact(
        &self,
        state: &mut RigidState<R>,
        flight: &Flight<R>,
        Landing { after, normal }: Landing<R>,
        hurry: bool,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let law = &self.law;
        let (position, velocity) = flight.at(after, law);
        let [x, y] = position;
        // It is on the wall but for rounding. A root would round down, just above and below 1, and every
        // impact lengthen the velocity.
        let excess = R::HALF * (x * x + y * y - R::ONE);
        let (sin, cos) = (x - excess * x, excess * y - y);
        let tangential = velocity[0] * cos + velocity[1] * sin;
        let normal_acceleration = |tangential: R| tangential * tangential + law.gravity * cos;
        state.begun = state.ends;
        if normal <= R::CUTOFF_SPEED && normal_acceleration(tangential) <= R::ZERO {
            // A graze: the wall gives no impulse and the path bends away from it.
            self.launch(state, sin, cos, R::ZERO, tangential);
            return;
        }
        let hit = law.collide(normal, tangential, &mut state.spin);
        let normal_acceleration = normal_acceleration(hit.tangential);
        if normal > R::CUTOFF_SPEED {
            let launched = Flight::from_wall(sin, cos, hit.launch_speed, hit.tangential);
            let (position, velocity) = launched.at(R::ZERO, law);
            on_event(ModelEvent {
                at: state.begun,
                change: Change::Impact {
                    speed: normal,
                    impulse: normal + hit.launch_speed,
                },
                after: Kinematics {
                    position,
                    velocity,
                    spin: state.spin.value(),
                    touch: Touch::None,
                    turns: (0, R::ZERO),
                },
            });
        }
        let ends = hit.launch_speed <= self.cutoff
            && (normal_acceleration > R::ZERO
                || hit.launch_speed <= R::ZERO && normal_acceleration >= R::ZERO);
        if ends || hurry {
            let rest = law.rest_of_series(hit.launch_speed, normal_acceleration);
            if rest <= R::lit(LONGEST_REST) || hurry {
                let onto = state.on_wall(sin, cos, hit.tangential);
                self.settle(state, onto, hit.launch_speed, rest, grip(hit.stuck));
                return;
            }
        }
        self.launch(state, sin, cos, hit.launch_speed, hit.tangential);
    }

    /// The rest of a bounce series from launch speed `launch` at once: `rest` would be its length if the
    /// wall kept pressing as it does at its start. Its mean is contact, but for the last impact's impulse.
    fn settle(
        &self,
        state: &mut RigidState<R>,
        mut onto: WallState<R>,
        launch: R,
        rest: R,
        grip: Grip,
    ) {
        let law = &self.law;
        let mut after = R::ZERO;
        let mut stuck = grip == Grip::Caught;
        if rest > R::ZERO {
            let mean = Contact::new(onto, grip, law);
            let impulse = R::TWO * launch / (R::ONE - law.restitution);
            after = mean.time_of_impulse(impulse, rest);
            onto = mean.wall_state(after, law);
            stuck = mean.mode == Mode::Rolling;
            // A stretch that ended before has not given all of the impulse, or no longer slips.
            if let Mode::Sliding(friction) = mean.mode
                && after < mean.span
            {
                onto.tangential.add(-friction * launch);
                onto.spin.add(-friction * launch / law.inertia_ratio);
            }
        }
        state.motion = Motion::Settling { onto, stuck };
        state.ends = state.begun.after(after, &self.step);
    }

    pub(crate) fn launch(
        &self,
        state: &mut RigidState<R>,
        sin: R,
        cos: R,
        launch: R,
        tangential: R,
    ) {
        let flight = Flight::from_wall(sin, cos, launch, tangential);
        self.fly(state, flight, |flight, law| {
            flight.landing_from_wall(launch, law)
        });
    }

    pub(crate) fn fly(
        &self,
        state: &mut RigidState<R>,
        flight: Flight<R>,
        next: impl Fn(&Flight<R>, &Law<R>) -> Landing<R>,
    ) {
        let to = next(&flight, &self.law);
        state.solved.flights = state.solved.flights.wrapping_add(1);
        state.turns = Turns::default();
        state.ends = state.begun.after(to.after, &self.step);
        state.motion = Motion::Flight { flight, to };
    }

    pub(crate) fn enter_contact(
        &self,
        state: &mut RigidState<R>,
        onto: WallState<R>,
        grip: Grip,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        state.turns = Turns::default();
        self.touch(state, onto, grip);
        self.tell(state, Change::ContactStarts, on_event);
    }

    /// Starts the next stretch of contact at `state.begun`.
    fn touch(&self, state: &mut RigidState<R>, onto: WallState<R>, grip: Grip) {
        let contact = Contact::new(onto, grip, &self.law);
        state.solved.stretches = state.solved.stretches.wrapping_add(1);
        state.spin = onto.spin;
        state.ends = state.begun.after(contact.span, &self.step);
        state.motion = Motion::Contact(contact);
    }

    fn end_of_stretch(&self, state: &mut RigidState<R>, on_event: &mut impl FnMut(ModelEvent<R>)) {
        let Motion::Contact(contact) = &state.motion else {
            return;
        };
        let (span, ending) = (contact.span, contact.ending);
        let was_rolling = contact.mode == Mode::Rolling;
        let onto = contact.wall_state(span, &self.law);
        state.turns.add(contact.turned(span));
        state.begun = state.ends;
        state.spin = onto.spin;
        match ending {
            Ending::LiftsOff => {
                let (sin, cos) = (onto.sin.value(), onto.cos.value());
                let speed = onto.tangential.value();
                if span > R::ZERO {
                    let flight = Flight::from_wall(sin, cos, R::ZERO, speed);
                    self.fly(state, flight, |flight, law| {
                        flight.landing_from_lift_off(law)
                    });
                } else {
                    self.launch(state, sin, cos, R::ZERO, speed);
                }
                self.tell(state, Change::LiftsOff, on_event);
            }
            Ending::SlipEnds => {
                let mut onto = onto;
                onto.spin = onto.tangential.negative();
                self.touch(state, onto, Grip::Caught);
                if state.is_rolling() {
                    self.tell(state, Change::RollingStarts, on_event);
                }
            }
            Ending::Slips => {
                self.touch(state, onto, Grip::Breaks);
                self.tell(state, Change::SlidingStarts, on_event);
            }
            Ending::Continues => self.touch(state, onto, grip(was_rolling)),
        }
    }

    /// Goes to the end of the step by the mean motion of a whirl. What is no whirl waits for the next
    /// step.
    fn hurry_on(
        &self,
        state: &mut RigidState<R>,
        base: &WallState<R>,
        mode: Mode<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        let speed = base.tangential.value();
        if speed * speed < R::lit(WHIRL) {
            return;
        }
        let now = state.now;
        let time = self.step.time(now.since(state.begun));
        let (onto, angle, stuck) = whirl(base, mode, time, &self.law);
        state.turns.add(angle);
        state.begun = now;
        let was_rolling = mode == Mode::Rolling;
        self.touch(state, onto, grip(stuck));
        if stuck && !was_rolling && state.is_rolling() {
            self.tell(state, Change::RollingStarts, on_event);
        }
    }

    fn tell(
        &self,
        state: &RigidState<R>,
        change: Change<R>,
        on_event: &mut impl FnMut(ModelEvent<R>),
    ) {
        on_event(ModelEvent {
            at: state.begun,
            change,
            after: self.kinematics_after(state, R::ZERO),
        });
    }
}

fn grip(stuck: bool) -> Grip {
    if stuck { Grip::Caught } else { Grip::Open }
}

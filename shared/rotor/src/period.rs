//! Whole periods of the motion on the wall, passed over at once.
//!
//! While the slip keeps its sign, phi'' = -g sin phi + mu_s (phi'^2 + g cos phi) does not know the spin,
//! and phi'^2 = C exp(2 mu_s phi) + A cos phi + B sin phi (docs/know/model.md): a rotor that swings comes back
//! to every place with the speed it had there, and each swing takes the same from its spin. Rolling is a
//! pendulum, phi'' = -g sin phi/(1 + beta), and loses nothing. Whirl is followed as it is: with friction
//! it grows and has no period.
//!
//! The place looked at is the balance of weight and friction, tan phi = mu_s, which every such motion
//! passes at about its largest speed: there the moment is known best. Two passages in the same direction,
//! with one in the other between them, are a period P apart; a whirl passes it in one direction only. What
//! follows is the stretch at hand, n P later: same sine, cosine and speed. Its error is n times that of P.

use crate::clock::Instant;
use crate::contact::{Contact, Ending};
use crate::precision::Precision;
use crate::rigid::Rigid;
use crate::series::reach;
use crate::state::{Motion, RigidState};
use crate::sum::Sum;
use crate::wall::Mode;

/// Most periods passed over at once: a count that f32 still holds exactly.
const MOST_PERIODS: f64 = 16_777_216.0;

/// A passage of the place of balance, in a stretch.
#[derive(Clone, Copy, Debug)]
struct Passage<R> {
    /// Time since the stretch began.
    at: R,
    rising: bool,
    spin: Sum<R>,
    mode: Mode<R>,
    fastest: R,
}

/// The way from a passage.
#[derive(Clone, Copy, Debug)]
struct Lap<R> {
    rising: bool,
    /// Whether it has been passed in the other direction since.
    halfway: bool,
    time: Sum<R>,
    spin: Sum<R>,
    fastest: R,
}

/// Follows a contact, stretch by stretch, until it repeats itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round<R> {
    until: Instant<R>,
    /// Mode and end of the last stretch.
    last: Option<(Mode<R>, Instant<R>)>,
    lap: Option<Lap<R>>,
}

impl<R: Precision> Round<R> {
    /// For a run that ends at `until`.
    pub(crate) fn new(until: Instant<R>) -> Self {
        Self {
            until,
            last: None,
            lap: None,
        }
    }

    /// Takes note of the stretch at hand; whether it has put it off by whole periods.
    pub(crate) fn take(&mut self, model: &Rigid<R>, state: &mut RigidState<R>) -> bool {
        let Motion::Contact(contact) = &state.motion else {
            return false;
        };
        if self.last != Some((contact.mode, state.begun)) {
            self.lap = None;
        }
        if contact.ending != Ending::Continues {
            self.last = None;
            return false;
        }
        let (mode, span, fastest) = (contact.mode, contact.span, fastest(contact));
        if let Some((at, rising)) = contact.crossing() {
            let spin = contact.wall_state(at, &model.law).spin;
            let passage = Passage {
                at,
                rising,
                spin,
                mode,
                fastest,
            };
            if self.pass(&passage, model, state) {
                *self = Self::new(self.until);
                return true;
            }
        }
        if let Some(lap) = &mut self.lap {
            lap.time.add(span);
            lap.fastest = lap.fastest.most(fastest);
        }
        self.last = Some((mode, state.ends));
        false
    }

    fn pass(
        &mut self,
        &Passage {
            at,
            rising,
            spin,
            mode,
            fastest,
        }: &Passage<R>,
        model: &Rigid<R>,
        state: &mut RigidState<R>,
    ) -> bool {
        if let Some(lap) = &mut self.lap
            && lap.rising != rising
        {
            lap.halfway = true;
            return false;
        }
        if let Some(mut lap) = self.lap
            && lap.halfway
        {
            lap.time.add(at);
            lap.fastest = lap.fastest.most(fastest);
            let lost = match mode {
                Mode::Sliding(friction) if friction != R::ZERO => spin.minus(lap.spin),
                _ => Sum::new(R::ZERO),
            };
            if lap.skip(mode, lost, self.until, model, state) {
                return true;
            }
        }
        let mut time = Sum::new(R::ZERO);
        time.add(-at);
        self.lap = Some(Lap {
            rising,
            halfway: false,
            time,
            spin,
            fastest: R::ZERO,
        });
        false
    }
}

impl<R: Precision> Lap<R> {
    /// Puts the stretch at hand off by as many periods as fit in before `until` and before the slip can
    /// end; whether there are any. A period adds `lost` to the spin.
    fn skip(
        &self,
        mode: Mode<R>,
        lost: Sum<R>,
        until: Instant<R>,
        model: &Rigid<R>,
        state: &mut RigidState<R>,
    ) -> bool {
        let left = model.step.time(until.since(state.begun));
        let mut count = left / self.time.value() * (R::ONE - R::TWO * R::TWO * R::EPSILON);
        if let Mode::Sliding(friction) = mode
            && friction != R::ZERO
        {
            let against = if friction > R::ZERO { -R::ONE } else { R::ONE };
            let a_period = lost.value().abs();
            let slip = against * state.spin.value() - self.fastest - a_period;
            count = count.least(slip / a_period);
        }
        let count = count.least(R::lit(MOST_PERIODS)).floor();
        if !(self.time.value() > R::ZERO && count >= R::ONE) {
            return false;
        }
        let put_off = model.step.times(count, self.time);
        let begun = state.begun.plus(put_off);
        if !begun.is_reached_at(until) {
            return false;
        }
        state.begun = begun;
        state.ends = state.ends.plus(put_off);
        if let Motion::Contact(contact) = &mut state.motion
            && lost != Sum::new(R::ZERO)
        {
            contact.base.spin.add_times(count, lost);
            state.spin = contact.base.spin;
        }
        true
    }
}

/// No speed along the wall in the stretch is above this.
fn fastest<R: Precision>(contact: &Contact<R>) -> R {
    let terms = &contact.series.tangential;
    terms[0].abs() + reach(terms, contact.span * contact.series.pace)
}

//! A model behind a pointer.

use std::rc::Rc;

use touchdown_rotor::error::ConfigError;
use touchdown_rotor::{Kinematics, ModelEvent, Precision, Start, Stepper};

/// A model that goes by steps. Whatever is done with one is built once in each kind of numbers, and not for each number
/// of rings and coordinates: that would take most of the time to build this crate and those above.
#[derive(Clone)]
pub(super) struct Boxed<R>(Rc<Begin<R>>);

type Begin<R> = dyn Fn(&Start<R>, R, OnEvent<R>) -> Result<BoxedState<R>, ConfigError>;
type OnEvent<'a, R> = &'a mut dyn FnMut(ModelEvent<R>);

impl<R: Precision> Boxed<R> {
    pub(super) fn new(model: impl Stepper<R> + 'static) -> Self {
        let model = Rc::new(model);
        Self(Rc::new(
            move |start: &Start<R>, spin, on_event: OnEvent<R>| {
                let state = model.start(start, spin, on_event)?;
                Ok(BoxedState(Box::new((model.clone(), state))))
            },
        ))
    }
}

/// A drop of a model, from step to step.
trait Dropping<R> {
    fn step(&mut self, on_event: OnEvent<R>);
    fn part_step(&mut self, fraction: R, on_event: OnEvent<R>);
    fn kinematics(&self) -> Kinematics<R>;
    fn copy(&self) -> Box<dyn Dropping<R>>;
}

impl<R: Precision, M: Stepper<R> + 'static> Dropping<R> for (Rc<M>, M::State) {
    fn step(&mut self, on_event: OnEvent<R>) {
        self.0.step(&mut self.1, on_event);
    }

    fn part_step(&mut self, fraction: R, on_event: OnEvent<R>) {
        self.0.part_step(&mut self.1, fraction, on_event);
    }

    fn kinematics(&self) -> Kinematics<R> {
        self.0.kinematics(&self.1)
    }

    fn copy(&self) -> Box<dyn Dropping<R>> {
        Box::new(self.clone())
    }
}

/// State of a [`Boxed`] model.
pub(super) struct BoxedState<R>(Box<dyn Dropping<R>>);

impl<R> Clone for BoxedState<R> {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

impl<R: Precision> Stepper<R> for Boxed<R> {
    type State = BoxedState<R>;

    fn start(
        &self,
        start: &Start<R>,
        spin: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) -> Result<BoxedState<R>, ConfigError> {
        self.0(start, spin, &mut on_event)
    }

    fn step(&self, state: &mut BoxedState<R>, mut on_event: impl FnMut(ModelEvent<R>)) {
        state.0.step(&mut on_event);
    }

    fn part_step(
        &self,
        state: &mut BoxedState<R>,
        fraction: R,
        mut on_event: impl FnMut(ModelEvent<R>),
    ) {
        state.0.part_step(fraction, &mut on_event);
    }

    fn kinematics(&self, state: &BoxedState<R>) -> Kinematics<R> {
        state.0.kinematics()
    }
}

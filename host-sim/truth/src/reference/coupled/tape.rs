//! Power series in time: their operations, recorded once and then carried from one order to the next.

use super::super::jet::{Jet, ORDER, Shared};
use super::super::press::Press;
use super::linear::{inverse, times};
use super::operation::{LinearSystem, Power, Pressing, Product, Rule, Sine};
use std::cell::RefCell;
use std::ops::{Add, Mul, Neg, Sub};

/// What a series costs besides its products, in products.
const OTHERWISE: usize = 32;

#[derive(Debug)]
struct Record {
    rules: Vec<Rule>,
    /// What the first terms are made of, without their signs: their rounding counts against it.
    sizes: Vec<f64>,
    /// Of each order: the terms of all series.
    rows: Vec<Vec<f64>>,
}

/// The record.
#[derive(Debug)]
pub struct Tape(RefCell<Record>);

/// A series on a tape.
#[derive(Clone, Copy, Debug)]
pub struct Term<'t> {
    tape: &'t Tape,
    /// Its number on the tape.
    pub index: usize,
}

impl Tape {
    /// Empty.
    pub fn new() -> Self {
        Self(RefCell::new(Record {
            rules: Vec::new(),
            sizes: Vec::new(),
            rows: vec![Vec::new()],
        }))
    }

    /// A series of which the first term is known.
    pub fn given(&self, value: f64) -> Term<'_> {
        self.record(Rule::Given, value, value.abs())
    }

    fn record(&self, rule: Rule, value: f64, size: f64) -> Term<'_> {
        let mut record = self.0.borrow_mut();
        let index = record.rules.len();
        record.rules.push(rule);
        record.sizes.push(size);
        record.rows[0].push(value);
        Term { tape: self, index }
    }

    /// What it costs, in products of series; 16 of the other operations take the time of one.
    pub fn cost(&self) -> usize {
        let rules = &self.0.borrow().rules;
        OTHERWISE + rules.iter().map(Rule::cost).sum::<usize>() + rules.len() / 16
    }

    /// Makes the terms of all orders; `given` tells those of the series that it was started with from the terms
    /// before.
    pub fn carry(&self, given: impl Fn(&[f64], usize, &mut [f64])) {
        let Record { rules, rows, .. } = &mut *self.0.borrow_mut();
        for order in 1..=ORDER {
            let mut row = vec![0.0; rules.len()];
            given(&rows[order - 1], order, &mut row);
            for (index, rule) in rules.iter_mut().enumerate() {
                rule.next(&mut row, index, order);
            }
            rows.push(row);
        }
    }

    /// A sum with weights.
    pub fn weighted<'t>(&'t self, parts: &[(Term<'t>, f64)]) -> Term<'t> {
        let value = parts.iter().map(|(of, weight)| of.value() * weight).sum();
        let part = |(of, weight): &(Term, f64)| of.size() * weight.abs();
        let size = parts.iter().map(part).sum();
        let parts = parts.iter().map(|(of, weight)| (of.index, *weight));
        self.record(Rule::Weighted(parts.collect()), value, size)
    }

    /// Solves a linear system; an unknown that the others already determine at the start is 0.
    pub fn solve<'t>(&'t self, matrix: &[Vec<Term<'t>>], right: &[Term<'t>]) -> Vec<Term<'t>> {
        let values = |of: &[Term<'t>]| of.iter().map(Term::value).collect::<Vec<f64>>();
        let indices = |of: &[Term<'t>]| of.iter().map(|it| it.index).collect::<Vec<usize>>();
        let inverse = inverse(matrix.iter().map(|line| values(line)).collect());
        let first = times(&inverse, &values(right));
        let sizes: Vec<f64> = right.iter().map(Term::size).collect();
        let line = |line: &Vec<f64>| line.iter().zip(&sizes).map(|(a, b)| a.abs() * b).sum();
        let sizes: Vec<f64> = inverse.iter().map(line).collect();
        let matrix = matrix.iter().map(|line| indices(line)).collect();
        let system = LinearSystem::new(matrix, indices(right), inverse, &first);
        let mut rule = Rule::Unknowns(Box::new(system));
        let unknown = |(value, size): (f64, f64)| {
            self.record(std::mem::replace(&mut rule, Rule::Made), value, size)
        };
        first.into_iter().zip(sizes).map(unknown).collect()
    }
}

impl<'t> Term<'t> {
    /// At the start.
    pub fn value(&self) -> f64 {
        self.tape.0.borrow().rows[0][self.index]
    }

    /// What that is made of, without signs.
    pub fn size(&self) -> f64 {
        self.tape.0.borrow().sizes[self.index]
    }

    /// All terms, once they are carried.
    pub fn jet(&self) -> Jet {
        let record = self.tape.0.borrow();
        Jet(std::array::from_fn(|order| record.rows[order][self.index]))
    }

    /// A value that stays, on the same tape.
    pub fn constant(&self, value: f64) -> Self {
        self.tape.given(value)
    }

    /// A power of what is above 0.
    pub fn power(self, exponent: f64) -> Self {
        let value = self.value().powf(exponent);
        let power = Power::new(self.index, self.value(), exponent, value);
        let size = value + (value * exponent / self.value()).abs() * self.size();
        self.tape.record(Rule::Power(Box::new(power)), value, size)
    }

    /// The force of a wall that gives way, at this depth above 0.
    pub fn pressed(self, press: &Press) -> Self {
        let force = press.force(self.value());
        let compliance = press.compliance(force);
        let pressing = Pressing::new(self.index, press, force, compliance);
        let size = force + 1.0 / compliance * self.size();
        let rule = Rule::Pressing(Box::new(pressing));
        self.tape.record(rule, force, size)
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value().sin_cos();
        let rule = Rule::Sine(Box::new(Sine::new(self.index, (sine, cosine))));
        let sine = self.tape.record(rule, sine, 1.0);
        (sine, self.tape.record(Rule::Made, cosine, 1.0))
    }

    /// A sum or a difference.
    fn with(self, other: Self, rule: fn(usize, usize) -> Rule, value: f64) -> Self {
        let size = self.size() + other.size();
        self.tape.record(rule(self.index, other.index), value, size)
    }
}

impl Shared for Term<'_> {
    fn weighted(parts: &[(Self, f64)]) -> Self {
        parts[0].0.tape.weighted(parts)
    }
}

impl Add for Term<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, Rule::Sum, self.value() + other.value())
    }
}

impl Sub for Term<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other, Rule::Difference, self.value() - other.value())
    }
}

impl Neg for Term<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Mul<f64> for Term<'_> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.tape.weighted(&[(self, factor)])
    }
}

impl Mul for Term<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value(), other.value());
        let product = Product::new([self.index, other.index], [a, b]);
        let rule = Rule::Product(Box::new(product));
        let size = self.size() * other.size();
        self.tape.record(rule, a * b, size)
    }
}

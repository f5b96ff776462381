//! Power series in time: their operations, recorded once and then carried from one order to the next.

use super::super::press::Press;
use super::jet::{Jet, ORDER};
use super::linear::inverse;
use super::power::Power;
use super::pressing::Pressing;
use super::share::Shared;
use std::cell::RefCell;
use std::ops::{Add, Mul, Neg, Sub};

/// What a series costs besides its products, in products.
const OTHERWISE: usize = 32;

/// SeriesTerms of a series, and zeros up to a multiple of four.
type SeriesTerms = [f64; ORDER + 4];

/// How the next term of a series follows from the terms of others, which stand before it.
#[derive(Clone, Copy, Debug)]
enum Rule {
    /// Set from outside, or 0 beyond the first.
    Given,
    Sum(usize, usize),
    Difference(usize, usize),
    /// Of these, with weights.
    Weighted(usize, usize),
    Product(usize),
    /// A sine; its cosine follows.
    Sine(usize),
    Power(usize),
    /// The force at a depth.
    Pressing(usize),
    /// The first unknown of a linear system; the others follow.
    Unknowns(usize),
    /// Made with the one before.
    Made,
}

#[derive(Clone, Copy, Debug)]
struct Product {
    of: [usize; 2],
    first: SeriesTerms,
    /// From the last order down.
    second: SeriesTerms,
}

#[derive(Clone, Copy, Debug)]
struct Sine {
    angle: usize,
    /// Times its order.
    turned: SeriesTerms,
    /// From the last order down.
    sine: SeriesTerms,
    cosine: SeriesTerms,
}

/// A linear system between series.
#[derive(Debug)]
struct LinearSystem {
    matrix: Vec<Vec<usize>>,
    right: Vec<usize>,
    /// Of the matrix' first terms.
    inverse: Vec<Vec<f64>>,
    /// Of the matrix, without the first term.
    later: Vec<Vec<SeriesTerms>>,
    /// From the last order down.
    unknowns: Vec<SeriesTerms>,
}

/// A term of the product of two series, the second of which stands backward. Four sums, because they do not wait
/// for one another; both hold zeros beyond the order.
fn folded(first: &SeriesTerms, second: &SeriesTerms, order: usize) -> f64 {
    let mut sums = [0.0; 4];
    let second = second[ORDER - order..].chunks_exact(4);
    for (a, b) in first[..order / 4 * 4 + 4].chunks_exact(4).zip(second) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

impl Product {
    fn next(&mut self, row: &[f64], order: usize) -> f64 {
        self.first[order] = row[self.of[0]];
        self.second[ORDER - order] = row[self.of[1]];
        folded(&self.first, &self.second, order)
    }
}

impl Sine {
    fn next(&mut self, row: &[f64], order: usize) -> [f64; 2] {
        self.turned[order] = order as f64 * row[self.angle];
        let part = 1.0 / order as f64;
        let sine = part * folded(&self.turned, &self.cosine, order);
        let cosine = -part * folded(&self.turned, &self.sine, order);
        self.sine[ORDER - order] = sine;
        self.cosine[ORDER - order] = cosine;
        [sine, cosine]
    }
}

impl LinearSystem {
    fn next(&mut self, row: &[f64], order: usize) -> Vec<f64> {
        let mut right: Vec<f64> = self.right.iter().map(|of| row[*of]).collect();
        for ((line, later), right) in self.matrix.iter().zip(&mut self.later).zip(&mut right) {
            for ((of, entry), unknown) in line.iter().zip(later).zip(&self.unknowns) {
                entry[order] = row[*of];
                *right -= folded(entry, unknown, order);
            }
        }
        let next = times(&self.inverse, &right);
        for (unknown, next) in self.unknowns.iter_mut().zip(&next) {
            unknown[ORDER - order] = *next;
        }
        next
    }
}

fn times(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    let line = |line: &Vec<f64>| line.iter().zip(vector).map(|(a, b)| a * b).sum();
    matrix.iter().map(line).collect()
}

fn backward(first: f64) -> SeriesTerms {
    let mut terms = [0.0; ORDER + 4];
    terms[ORDER] = first;
    terms
}

#[derive(Debug, Default)]
struct Record {
    rules: Vec<Rule>,
    /// What the first terms are made of, without their signs: their rounding counts against it.
    sizes: Vec<f64>,
    /// Of each order: the terms of all series.
    rows: Vec<Vec<f64>>,
    weighted: Vec<(usize, f64)>,
    products: Vec<Product>,
    sines: Vec<Sine>,
    powers: Vec<Power>,
    pressings: Vec<Pressing>,
    systems: Vec<LinearSystem>,
}

impl Record {
    fn carry(&mut self, order: usize) {
        let row = &mut self.rows[order];
        for (index, rule) in self.rules.iter().enumerate() {
            row[index] = match *rule {
                Rule::Given | Rule::Made => continue,
                Rule::Sum(a, b) => row[a] + row[b],
                Rule::Difference(a, b) => row[a] - row[b],
                Rule::Weighted(from, to) => {
                    let parts = self.weighted[from..to].iter();
                    parts.fold(0.0, |sum, (of, weight)| sum + row[*of] * weight)
                }
                Rule::Product(number) => self.products[number].next(row, order),
                Rule::Sine(number) => {
                    let [sine, cosine] = self.sines[number].next(row, order);
                    row[index + 1] = cosine;
                    sine
                }
                Rule::Power(number) => {
                    let power = &mut self.powers[number];
                    power.next(row[power.of], order)
                }
                Rule::Pressing(number) => {
                    let pressing = &mut self.pressings[number];
                    pressing.next(row[pressing.of], order)
                }
                Rule::Unknowns(number) => {
                    let next = self.systems[number].next(row, order);
                    row[index..index + next.len()].copy_from_slice(&next);
                    continue;
                }
            };
        }
    }
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
            rows: vec![Vec::new()],
            ..Record::default()
        }))
    }

    /// Series of which the first terms are known.
    pub fn start(&self, values: &[f64]) -> Vec<Term<'_>> {
        let given = |value: &f64| self.record(Rule::Given, *value, value.abs());
        values.iter().map(given).collect()
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
        let record = self.0.borrow();
        let systems = record.systems.iter().map(|it| it.right.len().pow(2));
        let products = record.products.len()
            + 2 * (record.sines.len() + record.powers.len())
            + 3 * record.pressings.len()
            + systems.sum::<usize>();
        OTHERWISE + products + record.rules.len() / 16
    }

    /// Makes the terms of all orders; `given` tells those of the series that it was started with from the terms
    /// before.
    pub fn carry(&self, given: impl Fn(&[f64], usize, &mut [f64])) {
        let mut record = self.0.borrow_mut();
        for order in 1..=ORDER {
            let mut row = vec![0.0; record.rules.len()];
            given(&record.rows[order - 1], order, &mut row);
            record.rows.push(row);
            record.carry(order);
        }
    }

    /// A sum with weights.
    pub fn weighted<'t>(&'t self, parts: &[(Term<'t>, f64)]) -> Term<'t> {
        let value = parts.iter().map(|(of, weight)| of.value() * weight).sum();
        let part = |(of, weight): &(Term, f64)| of.size() * weight.abs();
        let size = parts.iter().map(part).sum();
        let mut record = self.0.borrow_mut();
        let from = record.weighted.len();
        let parts = parts.iter().map(|(of, weight)| (of.index, *weight));
        record.weighted.extend(parts);
        let to = record.weighted.len();
        drop(record);
        self.record(Rule::Weighted(from, to), value, size)
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
        let size = right.len();
        let mut rule = Rule::Unknowns(self.0.borrow().systems.len());
        self.0.borrow_mut().systems.push(LinearSystem {
            matrix: matrix.iter().map(|line| indices(line)).collect(),
            right: indices(right),
            inverse,
            later: vec![vec![[0.0; ORDER + 4]; size]; size],
            unknowns: first.iter().map(|value| backward(*value)).collect(),
        });
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
        Jet::new(|order| record.rows[order][self.index])
    }

    /// A value that stays, on the same tape.
    pub fn constant(&self, value: f64) -> Self {
        self.tape.record(Rule::Given, value, value.abs())
    }

    /// A power of what is above 0.
    pub fn power(self, exponent: f64) -> Self {
        let power = Power::new(self.index, self.value(), exponent);
        let value = power.value();
        let size = value + (value * exponent / self.value()).abs() * self.size();
        let number = self.tape.0.borrow().powers.len();
        self.tape.0.borrow_mut().powers.push(power);
        self.tape.record(Rule::Power(number), value, size)
    }

    /// The force of a wall that gives way, at this depth above 0.
    pub fn pressed(self, press: &Press) -> Self {
        let pressing = Pressing::new(self.index, self.value(), press);
        let value = pressing.value();
        let size = value + pressing.stiffness() * self.size();
        let number = self.tape.0.borrow().pressings.len();
        self.tape.0.borrow_mut().pressings.push(pressing);
        self.tape.record(Rule::Pressing(number), value, size)
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value().sin_cos();
        let number = self.tape.0.borrow().sines.len();
        self.tape.0.borrow_mut().sines.push(Sine {
            angle: self.index,
            turned: [0.0; ORDER + 4],
            sine: backward(sine),
            cosine: backward(cosine),
        });
        let sine = self.tape.record(Rule::Sine(number), sine, 1.0);
        (sine, self.tape.record(Rule::Made, cosine, 1.0))
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
        let rule = Rule::Sum(self.index, other.index);
        self.tape.record(
            rule,
            self.value() + other.value(),
            self.size() + other.size(),
        )
    }
}

impl Sub for Term<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let rule = Rule::Difference(self.index, other.index);
        self.tape.record(
            rule,
            self.value() - other.value(),
            self.size() + other.size(),
        )
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
        let mut first = SeriesTerms::default();
        first[0] = a;
        let number = self.tape.0.borrow().products.len();
        self.tape.0.borrow_mut().products.push(Product {
            of: [self.index, other.index],
            first,
            second: backward(b),
        });
        self.tape
            .record(Rule::Product(number), a * b, self.size() * other.size())
    }
}

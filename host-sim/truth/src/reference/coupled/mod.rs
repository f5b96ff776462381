//! The truth beyond the rigid plane: systems with several round walls, solved event by event,
//! independent of the models under test.
//!
//! Bodies that move in the plane (also tilt and modes of bending) and spins, a constant mass matrix,
//! any smooth forces, and links: walls with Newton's restitution and Coulomb's friction, dry
//! brakes, and rings' seats, whose dry friction has any direction. Smooth motion is a Taylor series of order 20, made by arithmetic with series; the forces
//! of closed walls, of grip without slip and of brakes at rest follow from a linear system at the
//! level of accelerations, and what rounding leaves in the constraints is projected away each step.
//! A step ends where a wall is reached, a normal force or a slip falls to zero or a grip is lost:
//! the first fall of a polynomial, found with steps that a bound of its curvature keeps from
//! passing one, so that no flight is too short to be seen.
//!
//! The force of a magnet is smooth in parts: an axis on which it reaches its greatest force, or leaves it, ends a step too.
//!
//! A wall may give way instead: then it has a force, and no impulse; of such a wall only impacts are told, without
//! impulse. Its force is a series by the law that its compliance obeys. A run ends where a line is pressed deeper than its
//! law goes: it counts as too long. A ring's stop may give way too: a spring, which gives all back.
//!
//! Impacts of links that touch at one moment are solved together: Gauss-Seidel passes find who presses
//! and who sticks, and then all are one linear system. Three walls on one straight axis can share a load in many ways; then the forces of those
//! that others already determine are taken as 0. Where no set of modes lasts (several rings can jam
//! with friction) a short step is forced.
//!
//! Cut-offs: a wall that is left slower than 1e-10 of the unit of speed, sqrt(g clearance), or than
//! 1e-12 of the speed along it, is not left; permanent contact is early by the time that the rest of
//! the bounce series would take. More than 250 impacts in a unit of time double that cut-off, again
//! and again as long as they go on. A wall that falls away at the very start is no contact.
//!
//! Accuracy: in drops without support, or of a rotor with two like ends, impacts differ from the
//! planar reference by less than 1e-12 in units of the scale law, and what follows by 1e-10.

mod drop;
mod forces;
mod impact;
mod keep;
mod linear;
mod machine;
mod motion;
mod operation;
mod pull;
mod seat;
mod soft;
mod soft_force;
mod step;
mod surroundings;
mod system;
mod tape;
mod unknown;

pub use drop::{CoupledReference, CoupledStart, CoupledState, RingState};
pub use machine::{CoupledMachine, Retainer};
pub use system::Mode;

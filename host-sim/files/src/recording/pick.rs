//! From the columns that a recording has to the rows of a stream.

use touchdown_core::sample::CHANNELS;

use super::mapping::{Axes, Column, Mapping, POSITIONS};
use super::unit::{Displacement, Speed, Time, split};
use crate::stream::{Account, Columns, Row};
use touchdown_scene::sensors::{SensorsConfig, to_sensor_axes};

/// A column as the file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// As it is written, unit included.
    pub text: String,
    /// From the row below, or from a place of its own.
    pub unit: Option<String>,
}

impl Heading {
    /// Its name and its unit.
    fn parts(&self) -> (&str, Option<&str>) {
        let (name, unit) = split(&self.text);
        (name, self.unit.as_deref().or(unit))
    }
}

/// What to take from a row, and how it becomes SI.
#[derive(Clone, Debug)]
pub struct Pick {
    positions: Vec<Affine>,
    speed: Option<Affine>,
    /// Column and threshold of the levitation signal, and whether it is on below that.
    levitated: Option<(usize, f64, bool)>,
    /// The column of time and the power of ten of its seconds.
    pub time: Option<(usize, i32)>,
    /// Angle of each plane's sensors, where the columns are along them, rad.
    turned: Option<[f64; 2]>,
}

/// (value - zero) factor.
#[derive(Clone, Copy, Debug)]
struct Affine {
    column: usize,
    zero: f64,
    factor: f64,
}

impl Affine {
    fn of(self, values: &[f64]) -> f64 {
        (values[self.column] - self.zero) * self.factor
    }
}

impl Pick {
    /// Finds the columns of `mapping` among `found`; else the rule that is broken.
    pub fn new(
        mapping: &Mapping,
        found: &[Heading],
        sensors: &SensorsConfig,
        account: &Account,
    ) -> Result<Self, String> {
        let mut positions = Vec::new();
        for (name, column) in POSITIONS.iter().zip(mapping.positions()) {
            let Some(it) = column else { continue };
            let column = find(&it.column, name, found)?;
            let unit = unit(it.unit, name, &found[column], "um")?;
            if let Some(theirs) = found[column].parts().1
                && Displacement::try_from(theirs.to_owned()).is_ok_and(|it| it != unit)
            {
                account.warn(format!(
                    "{name}: the file says {theirs:?}, --columns another unit, which is taken"
                ));
            }
            let scale = match (unit, it.sensitivity) {
                (Displacement::Length(metres), None) => metres,
                (Displacement::Volts(volts), Some(per_metre)) => volts / per_metre.0,
                (Displacement::Volts(_), None) => {
                    let rule = "it needs a sensitivity, as \"200 mV/mil\"";
                    return Err(format!("{name} is in volts: {rule}"));
                }
                (Displacement::Length(_), Some(_)) => {
                    return Err(format!("{name} is a length: a sensitivity is for volts"));
                }
            };
            positions.push(Affine {
                column,
                zero: it.offset,
                factor: if it.reversed { -scale } else { scale },
            });
        }
        let mut speed = None;
        if let Some(it) = &mapping.speed {
            let column = find(&it.column, "speed", found)?;
            let Speed(scale) = unit(it.unit, "speed", &found[column], "rpm")?;
            speed = Some(Affine {
                column,
                zero: 0.0,
                factor: if it.reversed { -scale } else { scale },
            });
        }
        let levitated = mapping.levitated.as_ref().map(|it| {
            let column = find(&it.column, "levitated", found)?;
            Ok::<_, String>((column, it.above, it.reversed))
        });
        let pick = Self {
            positions,
            speed,
            levitated: levitated.transpose()?,
            time: time(mapping, found)?,
            turned: (mapping.axes == Axes::Sensors).then_some(sensors.mounting_angle),
        };
        pick.each_its_own(found)?;
        Ok(pick)
    }

    /// No column is two quantities.
    fn each_its_own(&self, found: &[Heading]) -> Result<(), String> {
        let all: Vec<_> = self.quantities().collect();
        for (index, (name, column)) in all.iter().enumerate() {
            if let Some((before, _)) = all[..index].iter().find(|it| it.1 == *column) {
                let which = format!("column {} {:?}", column + 1, found[*column].text);
                let rule = "each needs a column of its own";
                return Err(format!("{before} and {name} are both {which}: {rule}"));
            }
        }
        Ok(())
    }

    /// What a stream of it would have.
    pub fn columns(&self) -> Columns {
        Columns {
            planes: (self.positions.len() / 2) as u8,
            speed: self.speed.is_some(),
            levitated: self.levitated.is_some(),
            edges: [false; 2],
        }
    }

    /// Each quantity and its column.
    fn quantities(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let positions = self.positions.iter().map(|it| it.column);
        let time = self.time.map(|it| ("time", it.0));
        let speed = self.speed.map(|it| ("speed", it.column));
        let levitated = self.levitated.map(|it| ("levitated", it.0));
        let all = POSITIONS.into_iter().zip(positions).chain(time);
        all.chain(speed).chain(levitated)
    }

    /// Which columns have values that are read; the times are read by their digits.
    pub fn used(&self) -> Vec<usize> {
        let values = self.quantities().filter(|(name, _)| *name != "time");
        values.map(|(_, column)| column).collect()
    }

    /// The row of `values`, of which those that are used are there; NaN where there is none.
    pub fn row(&self, time: f64, values: &[f64]) -> Row {
        let mut positions = [f64::NAN; CHANNELS];
        for (place, column) in positions.iter_mut().zip(&self.positions) {
            *place = column.of(values);
        }
        let (planes, _) = positions.as_chunks_mut::<2>();
        for (place, angle) in planes.iter_mut().zip(self.turned.iter().flatten()) {
            *place = to_sensor_axes(*place, -angle);
        }
        let spin = self.speed.map(|it| it.of(values));
        Row {
            time,
            positions,
            spin: spin.filter(|it| !it.is_nan()),
            levitated: self.levitated.and_then(|(column, above, reversed)| {
                let value = values[column];
                (!value.is_nan()).then_some((value > above) != reversed)
            }),
            edges: [None; 2],
        }
    }
}

fn time(mapping: &Mapping, found: &[Heading]) -> Result<Option<(usize, i32)>, String> {
    let it = mapping.time.as_ref().map(toml::Spanned::get_ref);
    let it = it.and_then(|it| Some((it.column.as_ref()?, it.unit)));
    it.map(|(column, given)| {
        let index = find(column, "time", found)?;
        let Time(power) = unit(given, "time", &found[index], "s")?;
        Ok((index, power))
    })
    .transpose()
}

fn find(column: &Column, what: &str, found: &[Heading]) -> Result<usize, String> {
    let count = found.len();
    let name = match column {
        Column::Number(number) => {
            let index = number.checked_sub(1).filter(|it| *it < count);
            let rule = || format!("{what}: there is no column {number}, there are {count}");
            return index.ok_or_else(rule);
        }
        Column::Name(name) => name.trim(),
    };
    let tests: [&dyn Fn(&Heading) -> bool; 4] = [
        &|it| it.text.trim() == name,
        &|it| it.parts().0 == name,
        &|it| it.text.trim().eq_ignore_ascii_case(name),
        &|it| it.parts().0.eq_ignore_ascii_case(name),
    ];
    for test in tests {
        let mut places = (1..=count).filter(|number| test(&found[number - 1]));
        let rule = match (places.next(), places.next()) {
            (Some(number), None) => return Ok(number - 1),
            (Some(one), Some(other)) => {
                format!("columns {one} and {other} are both named {name:?}; give the number")
            }
            _ => continue,
        };
        return Err(format!("{what}: {rule}"));
    }
    let columns = list(found);
    Err(format!("{what}: there is no column {name:?}; {columns}"))
}

/// The unit that is given, or else that of the column; `example` is one that could be given.
fn unit<T: TryFrom<String>>(
    given: Option<T>,
    what: &str,
    heading: &Heading,
    example: &str,
) -> Result<T, String> {
    let told = || heading.parts().1?.to_owned().try_into().ok();
    let named = &heading.text;
    given.or_else(told).ok_or_else(|| {
        format!("{what}: column {named:?} does not say its unit; give it, as unit = \"{example}\"")
    })
}

/// Columns that are named as in a stream: ax, ay, bx, by, speed, levitated.
pub fn by_name(found: &[Heading]) -> Option<Mapping> {
    let there = |name: &&str| {
        let is = |it: &Heading| it.parts().0.trim().eq_ignore_ascii_case(name);
        found.iter().any(is)
    };
    let groups: [&[&str]; 4] = [&POSITIONS[..2], &POSITIONS[2..], &["speed"], &["levitated"]];
    let groups = groups.into_iter().filter(|it| it.iter().all(there));
    let mut groups = groups.peekable();
    groups.peek().filter(|it| it[0] == POSITIONS[0])?;
    let table = |name: &&str| format!("[{name}]\ncolumn = \"{name}\"\n");
    toml::from_str(&groups.flatten().map(table).collect::<String>()).ok()
}

/// The columns, for people.
pub fn list(found: &[Heading]) -> String {
    const NAMED: usize = 20;
    let names = (1..).zip(found).take(NAMED).map(|(number, it)| {
        let unit = it.unit.as_ref().map(|unit| format!(" in {unit}"));
        format!("{number} {:?}{}", it.text, unit.unwrap_or_default())
    });
    let names: Vec<_> = names.collect();
    let more = if found.len() > NAMED { ", ..." } else { "" };
    format!("its columns are {}{more}", names.join(", "))
}

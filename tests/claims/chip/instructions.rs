//! Counts instructions on the emulated target anew: the tables in `host-sim/data` are current, and what they are
//! put together to is what whole drops take. `cargo xtask instructions` writes the tables instead.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use touchdown_run::instructions::{Instructions, Steps};
use touchdown_scene::{Fidelity, LeftOut, Model, Precision, Scene};
use touchdown_tests::counting::{COUNTS, count};

/// Set by `cargo xtask instructions`.
const WRITE: &str = "TOUCHDOWN_WRITE_TABLES";
/// Largest deviation of another compiler's counts from the tables.
const OTHER_COMPILER: f64 = 0.1;
/// Largest deviation of what is put together from a drop counted as a whole.
const COMPOSITION: f64 = 0.05;
/// Step that the classes are taken from, us.
const STEP: u32 = 10;

/// Steps of one class in one drop.
#[derive(Clone, Copy, Debug)]
struct Class {
    steps: f64,
    flights: f64,
    stretches: f64,
    sum: f64,
    worst: f64,
}

/// Of one rung, scheme, precision, kind of functions and step (us), by class.
type Drops = BTreeMap<(String, u32), BTreeMap<String, Class>>;

fn drops(counts: &str) -> Drops {
    let mut drops = Drops::new();
    for line in counts.lines() {
        let fields: Vec<&str> = line.split(',').collect();
        let [
            "drop",
            rung,
            scheme,
            precision,
            math,
            step,
            class,
            numbers @ ..,
        ] = &fields[..]
        else {
            continue;
        };
        let numbers: Vec<f64> = numbers.iter().map(|n| n.parse().expect(line)).collect();
        let [steps, flights, stretches, sum, worst] = numbers[..] else {
            panic!("{line}");
        };
        let model = [*rung, scheme, precision, math].join(",");
        let drop = drops.entry((model, step.parse().expect(line))).or_default();
        let class = drop.insert(
            (*class).to_owned(),
            Class {
                steps,
                flights,
                stretches,
                sum,
                worst,
            },
        );
        assert!(class.is_none(), "{line}: twice");
    }
    drops
}

fn compiler(counts: &str) -> &str {
    let first = counts.lines().next().and_then(|line| line.split_once(','));
    first.expect("the compiler").1
}

/// The table of `touchdown_run::instructions`.
fn model_table(counts: &str) -> String {
    let mut table = format!(
        "# {}\nrung,scheme,precision,math,class,mean,worst\n",
        compiler(counts)
    );
    for ((model, step), classes) in drops(counts) {
        if step != STEP {
            continue;
        }
        let mean = |class: &str| classes[class].sum / classes[class].steps.max(1.0);
        let (flight, contact) = (mean("flight"), mean("contact"));
        for (class, step) in [
            ("flight", 0.0),
            ("contact", 0.0),
            ("impact", flight),
            ("stretch", contact),
        ] {
            // A time-stepping rung solves nothing: its steps are all alike.
            let beyond = if classes[class].steps > 0.0 {
                step
            } else {
                0.0
            };
            let (mean, worst) = (mean(class) - beyond, classes[class].worst - beyond);
            writeln!(table, "{model},{class},{mean:.1},{worst:.0}").expect("memory");
        }
    }
    table
}

fn function_table(counts: &str) -> String {
    let mut table = format!(
        "# {}\nprecision,math,function,mean,worst\n",
        compiler(counts)
    );
    for line in counts.lines() {
        let fields: Vec<&str> = line.split(',').collect();
        let ["function", precision, math, function, calls, sum, worst] = fields[..] else {
            continue;
        };
        let mean = sum.parse::<f64>().expect(line) / calls.parse::<f64>().expect(line);
        writeln!(table, "{precision},{math},{function},{mean:.1},{worst}").expect("memory");
    }
    table
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../host-sim/data")
        .join(name)
}

/// The same compiler gives the same numbers; another one nearly.
fn assert_current(name: &str, counted: &str) {
    let kept = fs::read_to_string(data(name)).expect("a checked-in table");
    let advice = format!("{name} is out of date: `cargo xtask instructions` counts anew");
    if kept.lines().next() == counted.lines().next() {
        assert!(kept == counted, "{advice}\n{counted}");
        return;
    }
    assert_eq!(kept.lines().count(), counted.lines().count(), "{advice}");
    for (kept, counted) in kept.lines().zip(counted.lines()).skip(2) {
        let means = [kept, counted].map(|line| {
            let field = line.rsplit(',').nth(1);
            field.and_then(|mean| mean.parse::<f64>().ok()).expect(line)
        });
        let deviation = (means[1] / means[0] - 1.0).abs();
        assert!(deviation <= OTHER_COMPILER, "{advice}\n{kept}\n{counted}");
    }
}

#[test]
fn tables_are_current() {
    let counts = &COUNTS;
    let tables = [
        ("instructions.csv", model_table(counts)),
        ("functions.csv", function_table(counts)),
    ];
    for (name, table) in tables {
        if std::env::var_os(WRITE).is_some() {
            assert_eq!(count(), **counts, "two runs differ");
            fs::write(data(name), table).expect("a writable table");
        } else {
            assert_current(name, &table);
        }
    }
}

/// Rungs of the plane: the others do more than one thing in a long step.
const PLANAR: [Fidelity; 3] = [Fidelity::Rigid, Fidelity::Moreau, Fidelity::Hertz];

/// All models of these rungs.
fn models(model: &Model) -> Vec<Model> {
    let mut all = Vec::new();
    for rung in PLANAR {
        for &scheme in rung.schemes() {
            for precision in Precision::ALL {
                all.extend(rung.maths(precision).iter().map(|&math| Model {
                    rung,
                    scheme,
                    precision,
                    math,
                    step: model.step,
                    cutoff: 0.0,
                    left_out: LeftOut::default(),
                }));
            }
        }
    }
    all
}

/// Steps that the image runs, us.
fn counted_steps(rung: Fidelity) -> [u32; 2] {
    match rung {
        Fidelity::Hertz => [10, 100],
        _ => [10, 1_000],
    }
}

#[test]
fn whole_drops_take_what_their_parts_add_up_to() {
    let counts = &COUNTS;
    let (table, drops) = (model_table(counts), drops(counts));
    let mut scene = Scene::load("rig").expect("built-in scene");
    let mut compared = 0;
    for model in models(&scene.model) {
        scene.model = model;
        let names: [&str; 4] = [
            model.rung.into(),
            model.scheme.into(),
            model.precision.into(),
            model.math.into(),
        ];
        let each = Instructions::find(&table, &model).expect("a counted model");
        for step in counted_steps(model.rung) {
            let classes = drops[&(names.join(","), step)].values();
            let sum = |part: fn(&Class) -> f64| classes.clone().map(part).sum::<f64>();
            scene.model.step = 1e-6 * f64::from(step);
            let steps = Steps::of(&scene).expect("valid scene");
            // The same bits on both sides, so the same motions.
            assert_eq!(steps.impacts as f64, sum(|class| class.flights));
            assert_eq!(steps.stretches as f64, sum(|class| class.stretches));
            assert_eq!(
                (steps.flight + steps.contact) as f64,
                sum(|class| class.steps)
            );

            let counted = sum(|class| class.sum) / sum(|class| class.steps);
            let deviation = each.per_step(&steps) / counted - 1.0;
            println!(
                "{names:?} {step} us: {counted:.1} a step, {:+.2} %",
                100.0 * deviation
            );
            assert!(deviation.abs() <= COMPOSITION, "{names:?} {step} us");
            compared += 1;
        }
    }
    let of_plane = |line: &&str| PLANAR.iter().any(|rung| line.starts_with(&rung.to_string()));
    assert_eq!(compared, 2 * table.lines().filter(of_plane).count() / 4);
}

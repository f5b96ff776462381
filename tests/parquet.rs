//! Recordings as Parquet files: the events of the stream, to the bit; files of another implementation; what is
//! damaged is an error.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;
use proptest::prelude::*;
use serde_json::Value;
use tempfile::TempDir;
use touchdown_sim::recording::{Mapping, Reading, Recording};
use touchdown_sim::scene::Scene;
use touchdown_sim::stream::Row;
use touchdown_tests::binary::touchdown;

/// A column: numbers, or microseconds since the first row.
enum Cells {
    Numbers(Vec<f64>),
    Micros(Vec<i64>),
}

fn write(path: &Path, columns: &[(&str, Cells)]) {
    let field = |(name, cells): &(&str, Cells)| {
        let kind = match cells {
            Cells::Numbers(_) => Physical::DOUBLE,
            Cells::Micros(_) => Physical::INT64,
        };
        let column = Type::primitive_type_builder(name, kind);
        Arc::new(
            column
                .with_repetition(Repetition::REQUIRED)
                .build()
                .unwrap(),
        )
    };
    let fields = columns.iter().map(field).collect();
    let schema = Type::group_type_builder("log")
        .with_fields(fields)
        .build()
        .unwrap();
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .build();
    let file = File::create(path).unwrap();
    let mut writer =
        SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    for (_, cells) in columns {
        let mut column = group.next_column().unwrap().unwrap();
        match cells {
            Cells::Numbers(values) => column.typed::<DoubleType>().write_batch(values, None, None),
            Cells::Micros(values) => column.typed::<Int64Type>().write_batch(values, None, None),
        }
        .unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
}

fn replay(folder: &Path, arguments: &[&str]) -> Value {
    let run = touchdown(folder)
        .arg("replay")
        .args(arguments)
        .args(["--scene", "rig", "--json", "-"])
        .assert()
        .success();
    serde_json::from_slice(&run.get_output().stdout).unwrap()
}

#[test]
fn a_parquet_file_gives_the_events_of_the_stream() {
    let folder = TempDir::new().unwrap();
    let at = folder.path();
    touchdown(at)
        .args(["drop", "rig", "--stream", "s.csv"])
        .assert()
        .success();
    let expected = replay(at, &["s.csv"]);
    let text = fs::read_to_string(at.join("s.csv")).unwrap();
    let numbers = |line: &str| line.split(',').map(|it| it.parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(numbers).collect();
    let column = |index: usize| rows.iter().map(|it| it[index]).collect();
    // As a stream is named, and as a logger might.
    let names = ["time_s", "ax_um", "ay_um", "bx_um", "by_um"];
    let named = names.iter().zip(0..);
    let columns: Vec<_> = named
        .map(|(it, index)| (*it, Cells::Numbers(column(index))))
        .collect();
    write(&at.join("stream.parquet"), &columns);
    assert_eq!(replay(at, &["stream.parquet"]), expected);

    let micros = rows.iter().map(|it| (it[0] * 1e6).round() as i64);
    let columns = [
        ("Y / um", Cells::Numbers(column(2))),
        ("ticks", Cells::Micros(micros.collect())),
        ("X", Cells::Numbers(column(1))),
        ("b.x", Cells::Numbers(column(3))),
        ("b.y", Cells::Numbers(column(4))),
    ];
    write(&at.join("logger.PARQUET"), &columns);
    let mapping = "[time]\ncolumn = 'ticks'\nunit = 'us'\n[ax]\ncolumn = 'X'\nunit = 'um'\n[ay]\ncolumn = 'Y'\n\
                   [bx]\ncolumn = 4\nunit = 'um'\n[by]\ncolumn = 'b.y'\nunit = 'um'\n";
    fs::write(at.join("map.toml"), mapping).unwrap();
    assert_eq!(
        replay(at, &["logger.PARQUET", "--columns", "map.toml"]),
        expected
    );
}

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/parquet")
        .join(name)
}

fn reading(mapping: &str) -> Reading {
    Reading {
        mapping: Some(Mapping::parse("map", mapping).unwrap()),
        resample: None,
    }
}

const COLUMNS: &str = "[time]\ncolumn = 't'\n[ax]\ncolumn = 'X1'\n[ay]\ncolumn = 'Y1'\n[bx]\ncolumn = 'X2'\n\
                       [by]\ncolumn = 'Y2'\nreversed = true\n[levitated]\ncolumn = 'AMB'\n";

/// All rows, or the first error.
fn rows(path: &Path, mapping: &str) -> Result<Vec<Row>, String> {
    let scene = Scene::load("rig").unwrap();
    let recording = Recording::open(path, &reading(mapping), &scene);
    let recording = recording.map_err(|error| error.to_string())?;
    assert!(
        (recording.rate / 20e3 - 1.0).abs() < 1e-9,
        "{}",
        recording.rate
    );
    recording
        .map(|it| it.map_err(|error| error.to_string()))
        .collect()
}

/// What tests/data/parquet/make.py put in.
#[test]
fn what_another_implementation_wrote_is_read() {
    for name in ["logger.parquet", "pages.parquet"] {
        let rows = rows(&data(name), COLUMNS).unwrap();
        assert_eq!(rows.len(), 300);
        for (i, row) in rows.iter().enumerate() {
            let k = i as f64;
            assert!((row.time - 50e-6 * k).abs() < 1e-12, "{name}: {row:?}");
            let [ax, ay, bx, by] = row.positions;
            let near = |value: f64, um: f64| (value - um * 1e-6).abs() < 1e-18;
            assert!(near(ax, (37 * i % 400) as f64), "{name} {i}: {ax}");
            assert!(near(ay, 0.5 * (i % 64) as f64), "{name} {i}: {ay}");
            assert!(near(by, k), "{name} {i}: {by}");
            if i % 10 == 3 {
                assert!(bx.is_nan(), "{name} {i}: {bx}");
            } else {
                assert!(
                    near(bx, (i % 128) as f64 / 1024.0 * 1e3),
                    "{name} {i}: {bx}"
                );
            }
            assert_eq!(row.levitated, Some(i < 200));
        }
    }
}

#[test]
fn what_cannot_be_read_says_why() {
    let note = COLUMNS.replace("'X1'", "'note'\nunit = 'um'");
    let no_time = COLUMNS.replace("[time]\ncolumn = 't'\n", "");
    let cases = [
        ("zstd.parquet", COLUMNS, "is compressed by ZSTD"),
        ("logger.parquet", &note, "\"note\" is no column of numbers"),
        (
            "logger.parquet",
            &no_time,
            "nothing says when its rows were sampled",
        ),
        (
            "logger.parquet",
            &COLUMNS.replace("'X1'", "'X9'"),
            "no column \"X9\"",
        ),
    ];
    for (name, mapping, rule) in cases {
        let error = rows(&data(name), mapping).unwrap_err();
        assert!(error.contains(rule) && error.contains(name), "{error}");
    }
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("empty.parquet"), "").unwrap();
    fs::copy(data("logger.parquet"), folder.path().join("l.parquet")).unwrap();
    for (name, rule) in [
        ("empty.parquet", "is no Parquet file"),
        ("l.parquet", "no columns are named time, ax and ay"),
        ("none.parquet", "no such file"),
    ] {
        touchdown(folder.path())
            .args(["replay", name, "--scene", "rig"])
            .assert()
            .code(2)
            .stderr(contains(rule));
    }
}

/// The footer no longer says where a dictionary lies, and its crate would panic.
#[test]
fn a_dictionary_that_is_gone_is_an_error() {
    const FIELD: usize = 10_172;
    let folder = TempDir::new().unwrap();
    let mut bytes = fs::read(data("logger.parquet")).unwrap();
    bytes[FIELD] = 164;
    fs::write(folder.path().join("r.parquet"), &bytes).unwrap();
    fs::write(folder.path().join("columns.toml"), COLUMNS).unwrap();
    touchdown(folder.path())
        .args(["replay", "r.parquet", "--scene", "rig"])
        .args(["--columns", "columns.toml"])
        .assert()
        .code(2)
        .stderr(contains("damaged").and(contains("panicked").not()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn damaged_files_are_rows_or_an_error(
        name in prop::sample::select(vec!["logger.parquet", "pages.parquet"]),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::weighted(0.2, any::<prop::sample::Index>()),
    ) {
        let mut bytes = fs::read(data(name)).unwrap();
        for (at, value) in flips {
            *at.get_mut(&mut bytes[..]) = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let folder = TempDir::new().unwrap();
        let path = folder.path().join("r.parquet");
        fs::write(&path, &bytes).unwrap();
        let scene = Scene::load("rig").unwrap();
        if let Ok(recording) = Recording::open(&path, &reading(COLUMNS), &scene) {
            prop_assert!(recording.filter(|it| it.is_err()).count() <= 1);
        }
    }
}

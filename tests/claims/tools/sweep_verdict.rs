//! Drops that end at their verdict come to what full runs come to; a search brackets what direct counts show.

use std::fs;
use std::path::Path;

use serde_json::Value;
use touchdown_tests::binary::touchdown;

/// Rotors of all kinds: both spins, little and much friction and inertia, long and short runs.
const ALL_KINDS: &str = r#"
scene = "rig"
drops = 500
seed = 31
until = "UNTIL"
[start]
within = 0.9
speed_mm_s = 200
[[parameter]]
key = "rotor.speed_rpm"
values = [-60000, -3000, -300, 0, 2000, 40000]
[[parameter]]
key = "retainer.friction"
log_uniform = [0.01, 1.5]
[[parameter]]
key = "retainer.restitution"
uniform = [0.0, 0.95]
[[parameter]]
key = "rotor.polar_inertia_kg_m2"
log_uniform = [1e-4, 2e-3]
[[parameter]]
key = "run.duration_s"
uniform = [0.05, 0.6]
[[parameter]]
key = "run.gravity_m_s2"
uniform = [0.0, 9.81]
"#;

fn sweep(folder: &Path, plan: &str, out: &str) -> Value {
    fs::write(folder.join("plan.toml"), plan).expect("a plan");
    let run = touchdown(folder)
        .args(["sweep", "plan.toml", "--json", "-", "--out", out])
        .assert();
    serde_json::from_slice(&run.success().get_output().stdout).expect("JSON")
}

#[test]
fn a_drop_to_its_verdict_is_the_full_drop_but_for_its_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let rows = |until: &str| {
        sweep(at, &ALL_KINDS.replace("UNTIL", until), until);
        let path = at.join(until).join("drops.csv");
        let mut table = csv::Reader::from_path(path).expect("a table");
        let rows: Result<Vec<_>, _> = table.records().collect();
        rows.expect("rows")
    };
    let (full, short) = (rows("end"), rows("verdict"));
    assert_eq!((full.len(), short.len()), (3_000, 3_000));
    let mut whirls = 0;
    for (full, short) in full.iter().zip(&short) {
        let columns = full.len() - 2;
        let of = |row: &csv::StringRecord| row.iter().take(columns).map(str::to_owned).collect();
        let (a, b): (Vec<_>, Vec<_>) = (of(full), of(short));
        assert_eq!(a, b);
        assert!(short.iter().skip(columns).all(str::is_empty), "{short:?}");
        whirls += u32::from(full.iter().any(|it| it.ends_with("_whirl")));
    }
    assert!((300..2_700).contains(&whirls), "{whirls} whirls show little");
}

#[test]
fn a_search_brackets_what_direct_counts_show() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let common = "scene = \"rig\"\n[start]\nwithin = 0.5\nspeed_mm_s = 20\n[[parameter]]\nkey = \"retainer.friction\"\n";
    let plan = format!("find = \"whirl < 0.2\"\ndrops = 20000\n{common}from = 0.05\nto = 0.4\nsteps = 15\n");
    let found = sweep(at, &plan, "found");
    let again = sweep(at, &plan, "again");
    assert_eq!(found, again, "the same plan finds the same");
    let of = |key: &str| found["find"][key].as_f64().expect(key);
    let (below, above) = (of("below_at"), of("above_at"));
    assert!(below < above && above - below < 0.06, "{below} {above}");
    // Other starts than those of the search.
    let direct = format!("seed = 99\nuntil = \"verdict\"\ndrops = 3000\n{common}values = [{below}, {above}]\n");
    let direct = sweep(at, &direct, "direct");
    let end = |point: usize, key: &str| direct["points"][point][key].as_f64().expect(key);
    assert!(end(0, "whirl_low") < 0.2, "{direct}");
    assert!(end(1, "whirl_high") > 0.2, "{direct}");
}

#[test]
fn a_search_is_not_divided() {
    let folder = tempfile::tempdir().expect("a folder");
    let plan = "scene = \"rig\"\nfind = \"whirl < 0.1\"\n[start]\nwithin = 0.5\n[[parameter]]\nkey = \"retainer.friction\"\nvalues = [0.1, 0.2]\n";
    fs::write(folder.path().join("plan.toml"), plan).expect("a plan");
    let run = touchdown(folder.path())
        .args(["sweep", "plan.toml", "--shard", "1/2"])
        .assert();
    let error = String::from_utf8(run.code(2).get_output().stderr.clone()).expect("text");
    assert!(error.contains("not divided"), "{error}");
}

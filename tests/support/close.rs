//! Numbers that must be alike.

/// `have` is `want` to `tolerance`, in its unit.
#[track_caller]
pub fn close(have: f64, want: f64, tolerance: f64) {
    let error = (have - want).abs();
    assert!(
        error <= tolerance,
        "{have} is not {want}: off by {error:.1e}"
    );
}

/// Both of a pair.
#[track_caller]
pub fn close_pair(have: [f64; 2], want: [f64; 2], tolerance: f64) {
    close(have[0], want[0], tolerance);
    close(have[1], want[1], tolerance);
}

//! Any bytes are a stream or an error, in bounded memory.

#![no_main]

use libfuzzer_sys::fuzz_target;
use touchdown_files::stream::{Account, Even, Records};

fuzz_target!(|bytes: &[u8]| {
    let account = Account::of("fuzz");
    let records = Records::new(bytes, &account);
    match records.and_then(|it| Even::of_rows(&account, it, 1)) {
        Ok(rows) => {
            let rate = rows.rate;
            assert!((99.0..=201e3).contains(&rate), "{rate}");
            let flaws = rows.filter(|row| row.is_err()).count();
            assert!(flaws <= 1);
        }
        Err(error) => assert!(error.to_string().starts_with("fuzz")),
    }
});

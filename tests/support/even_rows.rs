//! The rows of a stream in memory, at its one rate.

use touchdown_base::input_error::InputError;
use touchdown_files::stream::{Account, Columns, Even, Records};

/// Rows of a stream in memory.
pub type EvenRows<'a> = Even<Records<&'a [u8]>>;

/// Rows of the stream `bytes`, which errors name `file`, and what it has.
pub fn even_rows<'a>(file: &str, bytes: &'a [u8]) -> Result<(EvenRows<'a>, Columns), InputError> {
    let account = Account::of(file);
    let records = Records::new(bytes, &account)?;
    let columns = records.columns;
    Ok((Even::of_rows(&account, records, 1)?, columns))
}

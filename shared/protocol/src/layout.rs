//! Where values stand among bytes: one table of offsets serves writing and reading.

use touchdown_core::event::{EventKind, Level, Motion, Plane};
use touchdown_core::fault::Condition;
use touchdown_core::sensing::PlaneCalibration;

use crate::controller::{Cause, Mode};

/// Where a `T` stands among bytes, and how. A number is that of the first byte, from 0.
pub(crate) trait Offset<T> {
    /// What has no room is not written.
    fn put(self, value: &T, bytes: &mut [u8]);

    /// `None` where the bytes end before it, or stand for no `T`.
    fn get(self, bytes: &[u8]) -> Option<T>;
}

macro_rules! offsets {
    ($($value:ty: $to:expr, $of:expr;)+) => {$(
        impl $crate::layout::Offset<$value> for usize {
            #[inline]
            fn put(self, value: &$value, bytes: &mut [u8]) {
                let room = bytes.get_mut(self..).and_then(|it| it.first_chunk_mut());
                if let Some(room) = room {
                    *room = $to(*value);
                }
            }

            #[inline]
            fn get(self, bytes: &[u8]) -> Option<$value> {
                $of(*bytes.get(self..)?.first_chunk()?)
            }
        }
    )+};
}

/// Little-endian.
macro_rules! numbers {
    ($($number:ident),+) => {
        offsets! { $($number: $number::to_le_bytes, |it| Some($number::from_le_bytes(it));)+ }
    };
}

/// A byte.
macro_rules! codes {
    ($($code:ident),+) => {
        $crate::layout::offsets! { $($code: |it| [it as u8], |[it]: [u8; 1]| $code::from_repr(it);)+ }
    };
}

numbers!(u8, u16, u32, u64, i64, f32);
codes!(EventKind, Plane, Motion, Level, Condition, Mode);

offsets! {
    bool: |it| [it as u8], |[it]: [u8; 1]| Some(it != 0);
}

/// [`Cause::byte_of`]; none where the bytes end before it, as in what was written before it was recorded.
impl Offset<Option<Cause>> for usize {
    fn put(self, value: &Option<Cause>, bytes: &mut [u8]) {
        self.put(&Cause::byte_of(*value), bytes);
    }

    fn get(self, bytes: &[u8]) -> Option<Option<Cause>> {
        Some(self.get(bytes).and_then(Cause::of_byte))
    }
}

/// One after another, each of as many bytes as in memory.
impl<T: Copy + Default, const N: usize> Offset<[T; N]> for usize
where
    Self: Offset<T>,
{
    #[inline]
    fn put(self, values: &[T; N], bytes: &mut [u8]) {
        for (at, value) in (self..).step_by(size_of::<T>()).zip(values) {
            at.put(value, bytes);
        }
    }

    #[inline]
    fn get(self, bytes: &[u8]) -> Option<[T; N]> {
        let mut values = [T::default(); N];
        for (at, value) in (self..).step_by(size_of::<T>()).zip(&mut values) {
            *value = at.get(bytes)?;
        }
        Some(values)
    }
}

/// A value whose fields stand at offsets from its own.
macro_rules! layout {
    ($value:ident { $($field:ident = $offset:expr),+ $(,)? }) => {
        impl $crate::layout::Offset<$value> for usize {
            fn put(self, value: &$value, bytes: &mut [u8]) {
                let bytes = bytes.get_mut(self..).unwrap_or_default();
                $($crate::layout::Offset::put($offset, &value.$field, bytes);)+
            }

            fn get(self, bytes: &[u8]) -> Option<$value> {
                let bytes = bytes.get(self..)?;
                Some($value { $($field: $crate::layout::Offset::get($offset, bytes)?),+ })
            }
        }
    };
}

pub(crate) use {codes, layout, offsets};

layout!(PlaneCalibration { zero = 0, gain = 8, skew = 16 });

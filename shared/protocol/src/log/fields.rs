//! Little-endian fields, one after another.

/// Takes fields off the front; `None` where the bytes end.
pub(super) struct Fields<'a>(pub(super) &'a [u8]);

impl<'a> Fields<'a> {
    pub(super) fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (field, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*field)
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.bytes().map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.bytes().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.bytes().map(u64::from_le_bytes)
    }

    pub(super) fn f32(&mut self) -> Option<f32> {
        self.bytes().map(f32::from_le_bytes)
    }
}

/// Puts fields one after another; what does not fit is left out.
pub(super) struct Row<const N: usize> {
    bytes: [u8; N],
    length: usize,
}

impl<const N: usize> Row<N> {
    pub(super) const fn new() -> Self {
        Self {
            bytes: [0; N],
            length: 0,
        }
    }

    pub(super) fn put(mut self, field: &[u8]) -> Self {
        self.length += copy(self.bytes.get_mut(self.length..).unwrap_or_default(), field);
        self
    }

    pub(super) const fn bytes(self) -> [u8; N] {
        self.bytes
    }
}

/// How many bytes fitted. One copy of it for all fields: they are many.
#[inline(never)]
fn copy(room: &mut [u8], field: &[u8]) -> usize {
    room.iter_mut()
        .zip(field)
        .map(|(byte, new)| *byte = *new)
        .count()
}

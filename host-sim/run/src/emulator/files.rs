//! The files that desktop and image exchange: [`wire`].

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use touchdown_core::monitor::MonitorConfig;
use touchdown_core::sample::Sample;
use touchdown_protocol::wire::{self, Incoming, Record, ReplayHead, Switching};

use crate::controller_trace::{MonitorOutput, Procedure};

/// Writes a replay file; how many samples it has.
pub(super) fn write_replay(
    path: &Path,
    config: &MonitorConfig,
    procedure: &Procedure,
    samples: impl Iterator<Item = Sample>,
) -> io::Result<u64> {
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(&replay_head(&ReplayHead::new(*config, procedure.power_on))?)?;
    let mut count = 0;
    for sample in samples {
        let incoming = Incoming {
            clear: procedure.clear_at.contains(&count),
            ..sample.into()
        };
        file.write_all(&wire::encode_sample(&incoming, None))?;
        count += 1;
    }
    file.flush()?;
    Ok(count)
}

/// What comes before the samples.
pub fn replay_head(head: &ReplayHead) -> io::Result<Vec<u8>> {
    let head = postcard::to_stdvec(head).map_err(io::Error::other)?;
    let length = (head.len() as u32).to_le_bytes();
    Ok([&wire::REPLAY_MAGIC[..], &length, &head].concat())
}

/// What the image answered: what the monitor said, its log still empty, and each change of what the controller showed.
/// `None` for an answer that is damaged or not at its end.
pub(super) fn decode_answer(bytes: &[u8]) -> Option<(MonitorOutput, Vec<Switching>)> {
    let (records, []) = bytes
        .strip_prefix(&wire::ANSWER_MAGIC)?
        .as_chunks::<{ wire::NOTICE_BYTES }>()
    else {
        return None;
    };
    let (records, [severity, summary]) = records.split_last_chunk()?;
    let (Some(Record::Severity(severity)), Some(Record::Summary(summary))) =
        (wire::decode_record(severity), wire::decode_record(summary))
    else {
        return None;
    };
    let mut output = MonitorOutput {
        severity,
        summary,
        ..MonitorOutput::default()
    };
    let mut shown = Vec::new();
    for record in records {
        match wire::decode_record(record)? {
            Record::Notice(notice) => output.hear(notice),
            Record::Switching(switching) => shown.push(switching),
            Record::Severity(_) | Record::Summary(_) => return None,
        }
    }
    Some((output, shown))
}

#[cfg(test)]
mod tests {
    use super::*;
    use touchdown_core::event::Notice;
    use touchdown_core::severity::Severity;
    use touchdown_protocol::controller::Shown;

    #[test]
    fn answer_without_a_summary_is_damaged() {
        let mut bytes = wire::ANSWER_MAGIC.to_vec();
        assert_eq!(decode_answer(&bytes), None);
        let notice = Notice::Withdrawn {
            number: 3,
            sample: 7,
        };
        bytes.extend(wire::encode_record(&Record::Notice(notice)));
        let switching = Switching {
            sample: 8,
            shown: Shown::default(),
        };
        bytes.extend(wire::encode_record(&Record::Switching(switching)));
        assert_eq!(decode_answer(&bytes), None);
        let severity = Severity {
            impacts: 2,
            whirl_load: 40.5,
            ..Severity::default()
        };
        bytes.extend(wire::encode_record(&Record::Severity(severity)));
        assert_eq!(decode_answer(&bytes), None);
        let summary = wire::Summary {
            samples: 9,
            faults: 0,
            conditions: Default::default(),
            state_hash: 5,
        };
        bytes.extend(wire::encode_record(&Record::Summary(summary)));
        let output = MonitorOutput {
            notices: vec![notice],
            left_out: 0,
            severity,
            summary,
            log: Vec::new(),
        };
        assert_eq!(decode_answer(&bytes), Some((output, vec![switching])));
        bytes.pop();
        assert_eq!(decode_answer(&bytes), None);
    }
}

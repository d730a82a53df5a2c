//! What must hold for any bytes, one function a decoder. The plain loops beside this file and the
//! fuzz targets of `tests/fuzz` run the same functions. Each panics where a promise is broken.

use handscope::app::recordings::RecordingAbout;
use handscope::app::settings::Settings;
use handscope::codec::can::{self, CanRecord, from_record, to_record};
use handscope::codec::mbap::{self, MbapSplitter};
use handscope::codec::modbus::{bytes_from_words, words_for};
use handscope::codec::modbus::{detect_packing, group_bytes};
use handscope::codec::modbus_rtu::{self, RtuSplitter, crc16};
use handscope::codec::rs485::{
    BUFFER_LEN, ReplyDecoder, RequestDecoder, Rs485Reply, Rs485Request, client, device, encode_read,
};
use handscope::codec::slcan::{
    AnswerDecoder, CommandDecoder, SlcanAnswer, SlcanCommand, encode_answer, encode_command,
};
use handscope::codec::usbcan::{self, PacketContent, PacketDecoder};
use handscope::codec::{pdu, rs485};
use handscope::exhibit;
use handscope::exhibit::file::ExhibitFile;
use handscope::exhibit::plan::TILES;
use handscope::hand::kinematics::Side;
use handscope::hand::register::BytePacking;
use handscope::hand::{HandId, Moment, PerDof, REGISTERS, Span, TactileBlock};
use handscope::hand::{HandSample, Reply, register};
use handscope::link::traffic::cut::WAITING_MAX;
use handscope::link::traffic::decode::TrafficEvent;
use handscope::link::traffic::{Decoder, values};
use handscope::params;
use handscope::poses;
use handscope::poses::library::PoseLibrary;
use handscope::record::file::reader::TimeRange;
use handscope::record::file::writer::RecordingWriter;
use handscope::record::file::{Opening, RecordingFile};
use handscope::record::import::csv::{CsvValues, ImportError};
use handscope::record::{Direction, Entry, Event, EventKind, LinkState, Piece, PieceKind, Record};
use handscope::store::FileCause;
use handscope::transport::Endpoint;
use std::io::{Seek as _, Write as _};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use tempfile::NamedTempFile;

/// A target: any bytes, nothing may break.
pub type Target = fn(&mut State, &[u8]);

/// All wire decoders, which are run ten million times each by the tests.
pub const WIRES: [(&str, Target); 10] = [
    ("rs485_client", rs485_client),
    ("rs485_device", rs485_device),
    ("rtu_client", rtu_client),
    ("modbus_pdu", modbus_pdu),
    ("mbap", mbap),
    ("can_record", can_record),
    ("can_split", can_split),
    ("slcan_answers", slcan_answers),
    ("slcan_commands", slcan_commands),
    ("usbcan_packets", usbcan_packets),
];

/// Everything else that reads what it was not asked to trust.
pub const OTHERS: [(&str, Target); 18] = [
    ("tap_rs485", |state, bytes| tap(state, 0, bytes)),
    ("tap_rtu", |state, bytes| tap(state, 1, bytes)),
    ("tap_tcp", |state, bytes| tap(state, 2, bytes)),
    ("tap_can", |state, bytes| tap(state, 3, bytes)),
    ("tap_slcan", |state, bytes| tap(state, 4, bytes)),
    ("tap_usbcan", |state, bytes| tap(state, 5, bytes)),
    ("words", words),
    ("tactile", tactile),
    ("values", register_values),
    ("endpoint", endpoint),
    ("settings", settings),
    ("parameter_file", parameter_file),
    ("pose_file", pose_file),
    ("exhibit_file", exhibit_file),
    ("exhibit_day", exhibit_day),
    ("session_file", recording_file),
    ("session_about", session_about),
    ("csv_values", csv_values),
];

/// Decoders that live on from one input to the next, as they do on a wire.
pub struct State {
    replies: ReplyDecoder,
    requests: RequestDecoder,
    rtu: RtuSplitter,
    mbap: MbapSplitter,
    answers: AnswerDecoder,
    commands: CommandDecoder,
    packets: PacketDecoder,
    taps: Vec<Decoder>,
    heard: Vec<TrafficEvent>,
    at: u64,
    session: Option<NamedTempFile>,
    /// Frames that were accepted: a loop that accepts none proves nothing.
    pub accepted: u64,
}

impl Default for State {
    fn default() -> Self {
        let taps = [
            "rs485:x",
            "rtu:x",
            "tcp:127.0.0.1:6000",
            "can:can0",
            "slcan:x",
            "usbcan:x",
        ];
        let endpoint = |url: &&str| url.parse::<Endpoint>().unwrap();
        Self {
            replies: ReplyDecoder::default(),
            requests: RequestDecoder::default(),
            rtu: RtuSplitter::new(1),
            mbap: MbapSplitter::default(),
            answers: AnswerDecoder::default(),
            commands: CommandDecoder::default(),
            packets: PacketDecoder::default(),
            taps: taps
                .iter()
                .map(|url| Decoder::new(&endpoint(url)))
                .collect(),
            heard: Vec::new(),
            at: 0,
            session: None,
            accepted: 0,
        }
    }
}

/// Gives all bytes to a decoder that takes some at a time.
fn feed(mut bytes: &[u8], mut take: impl FnMut(&[u8]) -> usize) {
    while !bytes.is_empty() {
        let taken = take(bytes);
        assert!(
            taken > 0,
            "a decoder takes at least one byte after it said None"
        );
        bytes = &bytes[taken..];
    }
}

fn rs485_client(state: &mut State, bytes: &[u8]) {
    let State {
        replies, accepted, ..
    } = state;
    let mut got = |replies: &mut ReplyDecoder| {
        while let Some(reply) = replies.next() {
            *accepted += 1;
            let frame = match &reply {
                Rs485Reply::Read { id, address, bytes } => {
                    device::encode_read_reply(*id, *address, bytes).unwrap()
                }
                Rs485Reply::WriteAck { id, address, value } => {
                    device::encode_write_ack(*id, *address, *value)
                }
            };
            let mut again = ReplyDecoder::default();
            again.push(&frame);
            assert_eq!(again.next(), Some(reply));
        }
    };
    feed(bytes, |bytes| {
        let taken = replies.push(bytes);
        got(replies);
        taken
    });
    assert!(replies.buffered() < BUFFER_LEN);
    if bytes.len().is_multiple_of(3) {
        replies.flush_pending();
        got(replies);
        assert_eq!(replies.buffered(), 0);
    }
}

fn rs485_device(state: &mut State, bytes: &[u8]) {
    let State {
        requests, accepted, ..
    } = state;
    feed(bytes, |bytes| {
        let taken = requests.push(bytes);
        while let Some(request) = requests.next() {
            *accepted += 1;
            if let Rs485Request::Read { id, span } = &request
                && let (Ok(id), true) = (HandId::new(*id), (1..=252).contains(&span.len))
            {
                let frame = encode_read(id, *span).unwrap();
                let mut again = RequestDecoder::default();
                again.push(&frame);
                assert_eq!(again.next(), Some(request));
            }
        }
        taken
    });
    assert!(requests.buffered() < BUFFER_LEN);
    if bytes.len().is_multiple_of(3) {
        requests.flush_pending();
        while requests.next().is_some() {}
    }
}

fn rtu_client(state: &mut State, bytes: &[u8]) {
    let State { rtu, accepted, .. } = state;
    feed(bytes, |bytes| {
        let taken = rtu.push(bytes);
        while let Some(reply) = rtu.next() {
            *accepted += 1;
            let (body, check) = reply.bytes.split_last_chunk::<2>().unwrap();
            assert_eq!(crc16(body), u16::from_le_bytes(*check));
            assert_eq!(body[0], 1);
        }
        taken
    });
    assert!(rtu.buffered() < modbus_rtu::BUFFER_LEN);
    if bytes.len().is_multiple_of(3) {
        while rtu.buffered() > 0 {
            rtu.flush_pending();
            while rtu.next().is_some() {}
        }
    }
}

fn modbus_pdu(state: &mut State, bytes: &[u8]) {
    for side in [pdu::ModbusRole::Client, pdu::ModbusRole::Server] {
        let said = pdu::parse(side, bytes);
        if let pdu::Len::Known(len) = pdu::len(side, bytes) {
            assert!((2..=252).contains(&len));
            // A message of its own length is understood.
            if len == bytes.len() {
                state.accepted += 1;
                assert!(!matches!(said, pdu::Pdu::Other { .. }), "{bytes:?}");
            }
        }
    }
}

fn mbap(state: &mut State, bytes: &[u8]) {
    let State { mbap, accepted, .. } = state;
    let mut left = bytes;
    while !left.is_empty() {
        let taken = mbap.push(left);
        left = &left[taken..];
        loop {
            match mbap.next() {
                Ok(Some(adu)) => {
                    *accepted += 1;
                    let mut again = MbapSplitter::default();
                    again.push(&adu.bytes);
                    assert_eq!(again.next(), Ok(Some(adu)));
                }
                Ok(None) => break,
                Err(_) => {
                    // The connection is closed and another one opened.
                    mbap.clear();
                    return;
                }
            }
        }
    }
    assert!(mbap.buffered() < mbap::BUFFER_LEN);
}

fn can_record(state: &mut State, bytes: &[u8]) {
    for record in bytes.as_chunks::<16>().0 {
        if let CanRecord::Frame(frame) = from_record(record) {
            state.accepted += 1;
            let again = from_record(&to_record(&frame));
            assert_eq!(again, CanRecord::Frame(frame.clone()));
            if let Some(id) = can::CanId::from_raw(frame.id) {
                assert_eq!(id.raw(), Some(frame.id));
            }
        }
    }
}

fn can_split(state: &mut State, bytes: &[u8]) {
    let Some([a, b, c, ..]) = bytes.first_chunk::<4>() else {
        return;
    };
    let span = Span::new(u16::from_le_bytes([*a, *b]), u16::from(*c));
    let Some(pieces) = can::split(span) else {
        return;
    };
    state.accepted += 1;
    // Reassembled in order they are the run again, and no piece is longer than a frame.
    let mut at = u32::from(span.address);
    for piece in &pieces {
        assert_eq!(u32::from(piece.address), at);
        assert!((1..=8).contains(&piece.len));
        at = piece.end();
    }
    assert_eq!(at, span.end());
}

fn slcan_answers(state: &mut State, bytes: &[u8]) {
    for byte in bytes {
        if let Some(answer) = state.answers.push(*byte)
            && let SlcanAnswer::Frame(_) | SlcanAnswer::Sent = answer
        {
            state.accepted += 1;
            let mut again = AnswerDecoder::default();
            let line = encode_answer(&answer).unwrap();
            let read = line.iter().find_map(|byte| again.push(*byte));
            assert_eq!(read, Some(answer));
        }
    }
}

fn slcan_commands(state: &mut State, bytes: &[u8]) {
    for byte in bytes {
        if let Some(Ok(command)) = state.commands.push(*byte)
            && let Some(line) = encode_command(&command)
        {
            state.accepted += u64::from(matches!(command, SlcanCommand::Send(_)));
            let mut again = CommandDecoder::default();
            let read = line.iter().find_map(|byte| again.push(*byte));
            assert_eq!(read, Some(Ok(command)));
        }
    }
}

fn usbcan_packets(state: &mut State, bytes: &[u8]) {
    for byte in bytes {
        let Some(content) = state.packets.push(*byte) else {
            continue;
        };
        state.accepted += 1;
        if let PacketContent::Frame(frame) = &content {
            let mut again = PacketDecoder::default();
            let packet = usbcan::encode(frame);
            let read = packet.iter().filter_map(|byte| again.push(*byte));
            assert_eq!(read.collect::<Vec<_>>(), [content]);
            assert_eq!(again.counts(), handscope::codec::NoiseCounts::default());
        }
    }
}

/// Any pieces give frames that hold all their bytes, and nothing is kept beyond the limit.
fn tap(state: &mut State, wire: usize, bytes: &[u8]) {
    let (decoder, heard) = (&mut state.taps[wire], &mut state.heard);
    let before = decoder.waiting();
    state.at += 1 + 40_000 * u64::from(bytes.len().is_multiple_of(5));
    let direction = if bytes.len().is_multiple_of(2) {
        Direction::FromHand
    } else {
        Direction::ToHand
    };
    let piece = Piece {
        at: Moment::from_micros(state.at),
        kind: PieceKind::Bytes(direction),
        bytes: bytes.to_vec(),
    };
    decoder.push(&piece, heard);
    let mut cut = 0;
    for one in heard.drain(..) {
        if let TrafficEvent::Frame(frame) = one {
            state.accepted += u64::from(frame.wrong.is_none());
            cut += frame.bytes.len();
            let fields: usize = frame.fields().iter().map(|field| field.at.len()).sum();
            assert_eq!(fields, frame.bytes.len());
            assert!(!frame.text_line().is_empty());
        }
    }
    assert_eq!(
        before + bytes.len(),
        cut + decoder.waiting(),
        "no byte is lost"
    );
    assert!(decoder.waiting() <= 2 * WAITING_MAX);
}

fn words(state: &mut State, bytes: &[u8]) {
    let (pairs, _) = bytes.as_chunks::<2>();
    let words: Vec<u16> = pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect();
    let at = words.first().copied().unwrap_or_default();
    for packing in [BytePacking::HighFirst, BytePacking::OnePerWord] {
        assert_eq!(
            bytes_from_words(at, &words, packing).len(),
            words.len().min(125) * 2
        );
    }
    let memory = bytes_from_words(at, &words, BytePacking::LowFirst);
    assert_eq!(memory.len(), words.len().min(125) * 2);
    let (back, _) = memory.as_chunks::<2>();
    let again = back.iter().map(|pair| u16::from_le_bytes(*pair));
    assert!(again.eq(words.iter().copied().take(125)));
    if let Some(six) = words.first_chunk::<6>() {
        if let Some(packing) = detect_packing(1, six) {
            assert!(group_bytes(packing, &words).is_some());
        }
        state.accepted += 1;
    }
    if let [address, len, ..] = words[..] {
        let span = words_for(Span::new(address, len));
        assert!(u32::from(span.count) * 2 >= u32::from(len));
    }
}

fn tactile(state: &mut State, bytes: &[u8]) {
    let block = TactileBlock::decode(bytes);
    assert_eq!(block.is_some(), bytes.len() == 58);
    let Some(block) = block else { return };
    state.accepted += 1;
    let back = block.encode();
    assert_eq!(back[..54], bytes[..54]);
    assert_eq!(back[56..], bytes[56..]);
    assert!(block.direction_deg().is_none_or(|degrees| degrees < 360));
    assert!(block.normal().is_none_or(f32::is_finite));
}

fn register_values(state: &mut State, bytes: &[u8]) {
    let Some(([low, high], memory)) = bytes.split_first_chunk::<2>() else {
        return;
    };
    let address = 900 + u16::from_le_bytes([*low, *high]) % 2500;
    let span = Span::new(address, u16::try_from(memory.len()).unwrap());
    for held in values::held(span, memory) {
        state.accepted += 1;
        assert!(span.covers(held.span) && held.row.span().covers(held.span));
        assert!(REGISTERS.contains(held.row) && !held.numbers.is_empty());
    }
    assert!(!values::names(span).is_empty());
}

fn endpoint(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(endpoint) = text.parse::<Endpoint>() {
        state.accepted += 1;
        let again: Endpoint = endpoint.to_string().parse().unwrap();
        assert_eq!(again, endpoint, "{text}");
    }
}

/// Any file is settings or none, and what is written is read back as it was.
fn settings(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(settings) = toml::from_str::<Settings>(&text) else {
        return;
    };
    state.accepted += 1;
    let written = toml::to_string_pretty(&settings).unwrap();
    assert_eq!(
        toml::from_str::<Settings>(&written).unwrap(),
        settings,
        "{text}"
    );
}

/// Any file is one of parameters or says what is wrong; what is taken may be written, and is read back as it was.
fn parameter_file(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let file = match params::file::read(&text) {
        Ok(file) => file,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    assert!(!file.params.is_empty());
    for (id, value) in file.params.iter() {
        assert!(id.allows(value), "{text}");
    }
    assert_eq!(params::file::read(&file.to_toml()).unwrap(), file, "{text}");
}

/// Any file is one of poses or says what is wrong; what is taken is read back as it was.
fn pose_file(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let library = match poses::file::read(&text) {
        Ok(library) => library,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    let written = poses::file::write(&library).unwrap();
    assert_eq!(poses::file::read(&written).unwrap(), library, "{text}");
}

/// Any file is one of an exhibition or says what is wrong; what is taken keeps within its limits and can be shown.
fn exhibit_file(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let (folder, own) = (Path::new("booth"), PoseLibrary::default());
    let file = ExhibitFile::parse(&text, folder);
    let read = file.and_then(|file| Ok((file.plan(&own)?, file.poses()?, file.logo()?)));
    let (plan, poses, logo) = match read {
        Ok(read) => read,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    assert!(TILES.contains(&plan.tiles.len()), "{text}");
    let attract = plan.attract.iter().flat_map(|attract| &attract.pieces);
    for piece in plan.tiles.iter().chain(attract) {
        assert!(!piece.plan.cues.is_empty() && !piece.plan.looped, "{text}");
        for cue in &piece.plan.cues {
            let limits = plan.limits;
            assert!(cue.speed <= limits.speed && cue.force <= limits.force);
        }
    }
    for named in poses.into_iter().chain(logo) {
        let told = named.refused(FileCause::Empty.into()).to_string();
        assert!(!told.is_empty(), "{text}");
    }
}

/// Any file is the report of a day or says what is wrong; what is taken is read back as it was, and has a page.
fn exhibit_day(state: &mut State, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let report = match exhibit::report::file::read(&text, "2026-11-23") {
        Ok(report) => report,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    let written = exhibit::report::file::write(&report).unwrap();
    let again = exhibit::report::file::read(&written, &report.day).unwrap();
    assert_eq!(again, report, "{text}");
    let page = exhibit::report::page::html(&report).unwrap();
    assert!(page.ends_with("</body></html>") && !page.contains("<script"));
}

/// Any file is a session or says why not; what is read of it lies in the stretch that was asked for, and reading it again gives
/// the same.
fn recording_file(state: &mut State, bytes: &[u8]) {
    let session = &mut state.session;
    let file = session.get_or_insert_with(in_memory);
    file.as_file().set_len(0).unwrap();
    file.rewind().unwrap();
    file.write_all(bytes).unwrap();
    let session = match RecordingFile::open(file.path()) {
        Ok(session) => session,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    let stretch = TimeRange {
        from: session.first(),
        to: session.last(),
        wire: true,
    };
    let read = || {
        let mut entries = Vec::new();
        let damage = session.entries(stretch, |entry| {
            assert!((stretch.from..=stretch.to).contains(&entry.at()));
            entries.push(entry);
            ControlFlow::Continue(())
        });
        (entries.len(), damage.unwrap())
    };
    assert_eq!(read(), read());
    assert!(session.overview().rows.is_sorted_by_key(|row| row.second));
}

/// Any file beside a session says something of it or what is wrong; what is taken is read back as it was.
fn session_about(state: &mut State, bytes: &[u8]) {
    let session = &mut state.session;
    let session = session.get_or_insert_with(in_memory).path().to_owned();
    let path = RecordingAbout::path(&session);
    std::fs::write(&path, bytes).unwrap();
    let read = RecordingAbout::load(&session);
    std::fs::remove_file(&path).unwrap();
    let about = match read {
        Ok(about) => about,
        Err(why) => return assert!(!why.to_string().is_empty()),
    };
    state.accepted += 1;
    let written = toml::to_string_pretty(&about).unwrap();
    assert_eq!(toml::from_str::<RecordingAbout>(&written).unwrap(), about);
}

/// Any file holds values line by line, until a line of which it says what is wrong. Each reading is about something.
fn csv_values(state: &mut State, bytes: &[u8]) {
    let said = |why: ImportError| {
        let words = why.to_string();
        assert!(!words.contains('\n') && words.len() < 300, "{words}");
    };
    let mut values = match CsvValues::new(bytes) {
        Ok(values) => values,
        Err(why) => return said(why),
    };
    state.accepted += 1;
    loop {
        match values.next_row() {
            Ok(Some(entries)) => assert!(entries.len() <= 2),
            Ok(None) => return,
            Err(why) => return said(why),
        }
    }
}

/// Values with each kind of column.
const VALUES: &str = "time_s,angle_index,force_ring_g,temperature_little_C,normal_thumb_N,channel_1_thumb,mood,event\n\
    0.000000,1000,-33,20,,,calm,\n0.010000,,,,0.25,77,,\"note: a \"\"quoted\"\", one\"\n0.5,0,4000,,,,,link lost\n";

/// A file where no disk slows millions of inputs down, if there is such a place.
fn in_memory() -> NamedTempFile {
    NamedTempFile::new_in("/dev/shm")
        .or_else(|_| NamedTempFile::new())
        .unwrap()
}

/// A short session: a reading, bytes on the wire, a note.
fn session() -> Vec<u8> {
    let at = |millis: u64| Moment::from_micros(1000 * millis);
    let opening = Opening {
        base_nanos: 1_795_219_200_000_000_123,
        began: at(1),
        hand: "sim:?seed=3".into(),
        simulated: true,
        side: Side::Left,
        newtons_per_g: PerDof::splat(None),
        version: "0.1.0".into(),
        part: None,
    };
    let mut sample = HandSample::default();
    let fresh = sample.apply(&Reply {
        span: register::STATE,
        bytes: &[7; 78],
        asked: at(3),
        received: at(4),
    });
    let mut writer = RecordingWriter::new(&opening).unwrap();
    for entry in [
        Entry::Heard(Record::State {
            at: at(2),
            state: LinkState::Monitoring,
        }),
        Entry::Heard(Record::Reading {
            sample: Arc::new(sample),
            fresh,
        }),
        Entry::Wire(Piece {
            at: at(5),
            kind: PieceKind::Bytes(Direction::FromHand),
            bytes: vec![1, 2, 3],
        }),
        Entry::Event(Event {
            at: at(6),
            kind: EventKind::Note,
            words: "a note".into(),
        }),
    ] {
        writer.push(&entry).unwrap();
        writer.flush().unwrap();
    }
    writer.finish().unwrap();
    writer.take_bytes()
}

/// A file of poses.
const POSES: &str = "format = \"handscope-poses\"\nversion = 1\nmood = \"calm\"\n[[pose]]\nname = \"Pinch\"\ntags = [\"a\"]\n\
    speed = 300\nforce = 800\nleave = [\"little\"]\n[pose.angles]\nlittle = 1000\nring = 1000\nmiddle = 1000\n\
    index = 420\nthumb_bend = 420\nthumb_rotate = 0\n";

/// A file of an exhibition, and the report of its day.
const EXHIBIT: &str = "format = \"handscope-exhibit\"\nversion = 1\ntitle = \"x\"\npin = \"4711\"\nlogo = \"a.png\"\nspeed = 300\n\
    poses = \"own.toml\"\ntiles = [\"Fist\", \"V\", \"OK\", \"Rock\", \"Count\", \"Touch me\"]\n[attract]\npieces = [\"Wave\"]\n";
const EXHIBIT_DAY: &str = "format = \"handscope-exhibit-day\"\nversion = 1\nday = \"2026-11-23\"\nhands = [\"sim:\"]\n\
    visits = 1\nrests = 2\nstops = 3\nlink_losses = 4\n[pieces]\nFist = 5\n[faults]\nstall = 6\n[[hour]]\nhour = 9\nring = 41\n";

/// Valid inputs of every target, for mutation.
pub fn seeds(target: &str) -> Vec<Vec<u8>> {
    let block: Vec<u8> = (0..58).collect();
    let rs485_reply = device::encode_read_reply(1, 1546, &[7; 12])
        .unwrap()
        .to_vec();
    let rs485_ask = client::encode_read(HandId::MIN, Span::new(1546, 12))
        .unwrap()
        .to_vec();
    let checked = |body: &[u8]| [body, &crc16(body).to_le_bytes()].concat();
    let record = |data: &[u8]| {
        to_record(&can::frame(can::CanFunction::Read, 1, 1552, data).unwrap()).to_vec()
    };
    match target {
        "rs485_client" | "rs485_device" | "tap_rs485" => vec![
            rs485_reply,
            rs485_ask,
            rs485::encode_write_ack(1, 1486, 1).to_vec(),
            vec![0xEB, 0x90, 1, 5, 0x12, 0xCE, 5, 0xE8, 3, 0xD6],
        ],
        "rtu_client" | "tap_rtu" => vec![
            checked(&[1, 3, 4, 0, 1, 0, 2]),
            checked(&[1, 6, 3, 0xED, 0, 1]),
            checked(&[1, 16, 5, 0xCE, 0, 6]),
            checked(&[1, 0x83, 2]),
            checked(&[1, 3, 6, 10, 0, 6]),
        ],
        "modbus_pdu" => vec![
            vec![3, 6, 10, 0, 3],
            vec![3, 4, 1, 2, 3, 4],
            vec![16, 5, 0xCE, 0, 1, 2, 3, 0xE8],
            vec![0x90, 3],
        ],
        "mbap" | "tap_tcp" => vec![
            vec![0, 7, 0, 0, 0, 6, 255, 3, 6, 10, 0, 1],
            vec![0, 7, 0, 0, 0, 5, 255, 3, 2, 3, 0xE8],
        ],
        "can_record" | "tap_can" => vec![record(&[2]), record(&[0xF4, 1]), record(&[0; 8])],
        "slcan_answers" | "slcan_commands" | "tap_slcan" => vec![
            b"T018400012F401\r".to_vec(),
            b"Z\r\r".to_vec(),
            b"S8\rO\r".to_vec(),
        ],
        "usbcan_packets" | "tap_usbcan" => [
            can::frame(can::CanFunction::Read, 1, 1552, &[2]),
            can::frame(can::CanFunction::Read, 0xAA, 1552, &[0xA5, 0x55, 0xAA, 7]),
        ]
        .map(|frame| usbcan::encode(&frame.unwrap()).to_vec())
        .to_vec(),
        "tactile" => vec![block],
        "values" => vec![[vec![0x60, 0], block].concat(), vec![9; 80]],
        "endpoint" => [
            "sim:?seed=7&scenario=grasp",
            "rs485:/dev/ttyUSB0?baud=115200&id=1",
            "tcp:[::1]:6000?unit=255",
            "slcan:/dev/ttyACM0?bitrate=1000000&id=1",
            "can:can0?id=1",
            "usbcan:/dev/ttyUSB0?baud=115200&id=1",
        ]
        .map(|url| url.as_bytes().to_vec())
        .to_vec(),
        "settings" => vec![
            b"theme = \"light\"\nlanguage = \"zh\"\nendpoint = \"sim:\"\n".to_vec(),
            b"plot_window = \"s30\"\n[gesture_names]\n1 = \"open\"\n[new]\nkey = [1, 2]\n".to_vec(),
        ],
        "parameter_file" => vec![
            b"format = \"handscope-params\"\nversion = 1\nhand_id = 7\nip_address = \"10.0.0.9\"\n[new]\nkey = 1\n".to_vec(),
            b"format = \"handscope-params\"\nversion = 1\n[default_speed]\nindex = 150\n[default_force]\nring = 300\n".to_vec(),
        ],
        "session_file" => {
            let whole = session();
            let unclosed = whole[..whole.len() / 2].to_vec();
            vec![whole, unclosed]
        }
        "csv_values" => vec![VALUES.as_bytes().to_vec()],
        "session_about" => vec![
            b"name = \"egg\"\nstar = true\n[[notes]]\nat_micros = 5\nwords = \"x\"\n[new]\nkey = 1\n".to_vec(),
            b"star = false\nnotes = []\n".to_vec(),
        ],
        "pose_file" => vec![POSES.as_bytes().to_vec()],
        "exhibit_file" => vec![EXHIBIT.as_bytes().to_vec()],
        "exhibit_day" => vec![EXHIBIT_DAY.as_bytes().to_vec()],
        _ => vec![vec![1, 2, 3, 4], (0..24).collect()],
    }
}

//! The records of a file that was not ended, as far as its lists of chunks tell: each minute has one, which tells where the one
//! before stands. So only the last minute of a long recording is gone through record by record.

use super::found::{
    CHUNKS_MAX, ChunkKind, ChunkPlace, Found, HEAD, HEAD_LEN, Place, RECORD_MAX, content, read_at,
    u64_at,
};
use crate::record::file::chunk_list::{CHUNK_LIST, ChunkList};
use mcap::records::{Record, op};
use std::io::{self, Read, Seek};

/// No list is longer; a minute takes some ten kilobytes.
const LIST_MAX: u64 = 1024 * 1024;
/// Lists of one file: a day has 1440.
const LISTS_MAX: usize = 16 * 1024;
/// The last list is searched so far from the end: some minutes of one hand.
const SEARCH_BACK: u64 = 16 * 1024 * 1024;
/// Bytes searched at once.
const SEARCH: usize = 64 * 1024;
/// Places that look like a list and are none, before the search is given up.
const TRIES: usize = 16;
/// From the beginning of an attachment to its name's length: code, length, two times.
const BEFORE_NAME: u64 = HEAD + 16;

/// A list and where it stands.
#[derive(Debug)]
pub(super) struct ListedBlock {
    place: Place,
    /// Where the list before stands; 0 for the first.
    before: u64,
    /// Where the block begins.
    pub(super) from: u64,
    overview: Place,
    chunks: Vec<ChunkPlace>,
}

impl ListedBlock {
    /// `None` if the chunks of the list do not fill its block up to the overview: so it can neither hide one nor tell of one twice.
    fn new(place: Place, list: &ChunkList) -> Option<Self> {
        let (mut at, mut chunks) = (list.from, Vec::new());
        for chunk in list.chunks() {
            let len = chunk.len.checked_sub(HEAD)?;
            if chunk.offset != at || len == 0 || len > RECORD_MAX {
                return None;
            }
            at = chunk.end();
            chunks.push(ChunkPlace {
                kind: ChunkKind::Chunk,
                place: Place {
                    offset: chunk.offset,
                    len,
                },
                first_nanos: chunk.first_nanos,
                last_nanos: chunk.last_nanos,
            });
        }
        let overview = place.offset.checked_sub(list.overview)?;
        let overview = overview.checked_sub(HEAD).filter(|len| *len > 0)?;
        (at == list.overview).then_some(Self {
            place,
            before: list.before,
            from: list.from,
            overview: Place {
                offset: list.overview,
                len: overview,
            },
            chunks,
        })
    }

    /// Where what follows the list begins.
    pub(super) const fn end(&self) -> u64 {
        self.place.offset + HEAD + self.place.len
    }

    pub(super) fn add_to(&self, found: &mut Found) {
        self.chunks.iter().for_each(|chunk| found.chunk(*chunk));
        found.attachment(self.overview);
        found.attachment(self.place);
    }
}

/// The lists from the last one backwards, without a gap between what they tell of.
pub(super) fn by_lists<F: Read + Seek>(file: &mut F, len: u64) -> io::Result<Vec<ListedBlock>> {
    let mut all = Vec::new();
    let mut next = last(file, len)?;
    let mut chunks = 0;
    while let Some(block) = next.take() {
        chunks += block.chunks.len();
        if block.before < block.from
            && block.before > 0
            && chunks < CHUNKS_MAX
            && all.len() < LISTS_MAX
        {
            let earlier = at(file, block.before, block.from)?;
            next = earlier.filter(|earlier| earlier.end() == block.from);
        }
        all.push(block);
    }
    Ok(all)
}

/// The list nearest to the end.
fn last<F: Read + Seek>(file: &mut F, len: u64) -> io::Result<Option<ListedBlock>> {
    let mut name = u32::try_from(CHUNK_LIST.len())
        .unwrap_or_default()
        .to_le_bytes()
        .to_vec();
    name.extend(CHUNK_LIST.bytes());
    let (mut end, mut tries) = (len, 0);
    let mut buffer = vec![0; SEARCH];
    while len - end < SEARCH_BACK && end > name.len() as u64 {
        let there = usize::try_from(end).unwrap_or(usize::MAX).min(SEARCH);
        let bytes = buffer.get_mut(..there).unwrap_or_default();
        let begin = end - there as u64;
        read_at(file, begin, bytes)?;
        let names = bytes.windows(name.len()).enumerate().rev();
        let names = names.filter(|(_, bytes)| bytes.first() == name.first() && *bytes == name);
        for (step, _) in names {
            let offset = (begin + step as u64).checked_sub(BEFORE_NAME);
            let block = offset.map(|offset| at(file, offset, len)).transpose()?;
            if let Some(block) = block.flatten() {
                return Ok(Some(block));
            }
            tries += 1;
            if tries >= TRIES {
                return Ok(None);
            }
        }
        // A name may lie across the border.
        end = match begin {
            0 => 0,
            begin => begin + name.len() as u64 - 1,
        };
    }
    Ok(None)
}

/// The list that begins here and ends by `end`, if it is whole.
fn at<F: Read + Seek>(file: &mut F, offset: u64, end: u64) -> io::Result<Option<ListedBlock>> {
    let mut head = [0; HEAD_LEN];
    if offset.checked_add(HEAD).is_none_or(|body| body > end) {
        return Ok(None);
    }
    read_at(file, offset, &mut head)?;
    let len = u64_at(&head, 1).unwrap_or(u64::MAX);
    let fits = len <= LIST_MAX && offset + HEAD + len <= end;
    if head.first() != Some(&op::ATTACHMENT) || !fits {
        return Ok(None);
    }
    let place = Place { offset, len };
    let content = content(file, place)?;
    let Ok(Record::Attachment { header, data, crc }) = mcap::parse_record(op::ATTACHMENT, &content)
    else {
        return Ok(None);
    };
    let body = content.len().checked_sub(4);
    let body = body.and_then(|end| content.get(..end)).unwrap_or_default();
    let is_whole = crc != 0 && crc32fast::hash(body) == crc && header.name == CHUNK_LIST;
    let list = ChunkList::of_bytes(&data).filter(|_| is_whole);
    let block = list.and_then(|list| ListedBlock::new(place, &list));
    // Where bytes were taken out or put in before it, nothing stands where it says.
    match block {
        Some(block) if is_there(file, block.overview)? => Ok(Some(block)),
        _ => Ok(None),
    }
}

/// True if an attachment of this length stands here.
fn is_there<F: Read + Seek>(file: &mut F, overview: Place) -> io::Result<bool> {
    let mut head = [0; HEAD_LEN];
    read_at(file, overview.offset, &mut head)?;
    Ok(u64_at(&head, 1) == Some(overview.len))
}

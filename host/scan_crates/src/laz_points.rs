//! The compressed points of a LAZ file.

use crate::{file_of, guarded, refused, Failure, Outcome, Text};
use laz::laszip::ChunkTable;
use laz::{LasZipDecompressor, LazItemType, LazVlr};
use std::ffi::c_void;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

/// What the header of the file says of its points.
#[repr(C)]
pub struct LazLayout {
    vlr: *const u8,
    vlr_bytes: usize,
    offset: u64,
    record_bytes: u64,
    points: u64,
}

/// Takes `count` records; false stops.
type TakeRecords = extern "C" fn(user: *mut c_void, records: *const u8, count: usize) -> bool;

/// Points decompressed at once.
const BATCH: u64 = 4096;

/// No scan compresses to fewer bytes than one for so many points.
const POINTS_PER_BYTE: u64 = 64;

const POINT_WISE: u16 = 1;
const LAYERED: u16 = 3;

fn u16_at(bytes: &[u8], at: usize) -> Outcome<u16> {
    let bytes = bytes.get(at..at + 2).ok_or_else(|| refused("its LAZ record is too short"))?;
    Ok(u16::from_le_bytes([bytes[0], bytes[1]]))
}

fn u32_from(source: &mut impl Read) -> Outcome<u32> {
    let mut bytes = [0; 4];
    source.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

fn read_vlr(layout: &LazLayout, bytes: &[u8]) -> Outcome<LazVlr> {
    let vlr = LazVlr::from_buffer(bytes).map_err(|e| refused(e.to_string()))?;
    if u16_at(bytes, 2)? != 0 {
        return Err(refused("its LAZ record names an unknown coder"));
    }
    let items = vlr.items();
    let Some(first) = items.first() else {
        return Err(refused("its LAZ record has no items"));
    };
    let mut sum = 0;
    for item in items {
        let size = match item.item_type() {
            LazItemType::Byte(n) | LazItemType::Byte14(n) => n,
            LazItemType::Point10 => 20,
            LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
            LazItemType::RGB12 | LazItemType::RGB14 => 6,
            LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
            LazItemType::Point14 => 30,
        };
        let layered = item.version() >= 3;
        if item.size() != size || layered != (u16_at(bytes, 0)? == LAYERED) {
            return Err(refused("the items of its LAZ record contradict each other"));
        }
        sum += u64::from(size);
    }
    if sum != layout.record_bytes
        || !matches!(first.item_type(), LazItemType::Point10 | LazItemType::Point14)
    {
        return Err(refused("its LAZ record does not describe the points of the header"));
    }
    Ok(vlr)
}

/// The points of each chunk and the place where the chunk ends, all within the file.
fn read_chunks(
    layout: &LazLayout,
    vlr: &LazVlr,
    file: &mut BufReader<File>,
    size: u64,
) -> Outcome<Vec<(u64, u64)>> {
    let begin = layout.offset + 8;
    let missing = || refused("the table of its compressed chunks is missing");
    if begin + 8 > size {
        return Err(missing());
    }
    let mut bytes = [0; 8];
    file.seek(SeekFrom::Start(layout.offset))?;
    file.read_exact(&mut bytes)?;
    if i64::from_le_bytes(bytes) < begin as i64 {
        // A writer that could not go back put the place at the end.
        file.seek(SeekFrom::Start(size - 8))?;
        file.read_exact(&mut bytes)?;
    }
    let table = i64::from_le_bytes(bytes);
    if table < begin as i64 || table as u64 + 8 > size {
        return Err(missing());
    }
    let table = table as u64;
    file.seek(SeekFrom::Start(table + 4))?;
    let count = u64::from(u32_from(file)?);
    // Every chunk begins with a whole point.
    if count > (table - begin) / layout.record_bytes {
        return Err(refused(format!(
            "the table of its compressed chunks promises {count} chunks, more than the file holds"
        )));
    }
    file.seek(SeekFrom::Start(layout.offset))?;
    let entries = ChunkTable::read_from(&mut *file, vlr).map_err(|e| refused(e.to_string()))?;

    let (mut end, mut points) = (begin, 0);
    let mut chunks = Vec::with_capacity(entries.len());
    for (i, entry) in entries.as_ref().iter().enumerate() {
        let wrong = || refused(format!("the sizes of compressed chunk {i} are wrong"));
        if entry.byte_count < layout.record_bytes
            || entry.byte_count > table - end
            || entry.point_count == 0
            || points >= layout.points
        {
            return Err(wrong());
        }
        let left = layout.points - points;
        if vlr.uses_variable_size_chunks() && entry.point_count > left {
            return Err(wrong());
        }
        points += entry.point_count.min(left);
        end += entry.byte_count;
        chunks.push((entry.point_count.min(left), end));
    }
    if points != layout.points || end != table {
        return Err(refused(format!(
            "its compressed chunks hold {points} points in {} bytes, not {} in {}",
            end - begin,
            layout.points,
            table - begin
        )));
    }
    Ok(chunks)
}

/// The sizes of the layers of a chunk fill it exactly.
fn check_layers(
    layout: &LazLayout,
    vlr: &LazVlr,
    file: &mut BufReader<File>,
    chunks: &[(u64, u64)],
) -> Outcome<()> {
    let layers: u64 = vlr
        .items()
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(n) => u64::from(n),
            _ => 1,
        })
        .sum();
    let mut begin = layout.offset + 8;
    for (i, (points, end)) in chunks.iter().enumerate() {
        let wrong = || refused(format!("the layers of compressed chunk {i} do not fill it"));
        let mut at = layout.record_bytes + 4 + 4 * layers;
        if at > end - begin {
            return Err(wrong());
        }
        file.seek(SeekFrom::Start(begin + layout.record_bytes))?;
        if u64::from(u32_from(file)?) != *points {
            return Err(refused(format!("the number of points of compressed chunk {i} is wrong")));
        }
        for _ in 0..layers {
            at += u64::from(u32_from(file)?);
        }
        if at != end - begin {
            return Err(wrong());
        }
        begin = *end;
    }
    Ok(())
}

fn decompress(
    layout: &LazLayout,
    descriptor: i32,
    take: TakeRecords,
    user: *mut c_void,
) -> Outcome<()> {
    // SAFETY: the caller's bytes, which live during the call.
    let bytes = unsafe { std::slice::from_raw_parts(layout.vlr, layout.vlr_bytes) };
    let vlr = read_vlr(layout, bytes)?;
    let mut file = BufReader::with_capacity(1 << 16, file_of(descriptor)?);
    let size = file.seek(SeekFrom::End(0))?;
    if layout.offset > size || layout.points / POINTS_PER_BYTE > size - layout.offset {
        return Err(refused(format!(
            "the header promises {} points, more than {} bytes can hold",
            layout.points,
            size.saturating_sub(layout.offset)
        )));
    }
    let compressor = u16_at(bytes, 0)?;
    let chunks = if compressor == POINT_WISE {
        vec![(layout.points, size)]
    } else {
        read_chunks(layout, &vlr, &mut file, size)?
    };
    if compressor == LAYERED {
        check_layers(layout, &vlr, &mut file, &chunks)?;
    }

    file.seek(SeekFrom::Start(layout.offset))?;
    let mut decompressor =
        LasZipDecompressor::new(file, vlr).map_err(|e| refused(e.to_string()))?;
    let record = layout.record_bytes as usize;
    let mut records = vec![0; record * BATCH.min(layout.points) as usize];
    for (i, (points, end)) in chunks.iter().enumerate() {
        let damaged = || refused(format!("compressed chunk {i} is damaged"));
        let mut left = *points;
        while left > 0 {
            let now = left.min(BATCH);
            let part = &mut records[..record * now as usize];
            decompressor.decompress_many(part).map_err(|_| damaged())?;
            if !take(user, part.as_ptr(), now as usize) {
                return Err(Failure::Stopped);
            }
            left -= now;
        }
        if compressor != POINT_WISE && decompressor.get_mut().stream_position()? != *end {
            return Err(damaged());
        }
    }
    Ok(())
}

#[no_mangle]
pub extern "C" fn scan_crates_laz(
    descriptor: i32,
    layout: &LazLayout,
    take: TakeRecords,
    user: *mut c_void,
    why: &mut Text,
) -> i32 {
    guarded(why, || decompress(layout, descriptor, take, user))
}

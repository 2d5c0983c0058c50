//! The scans of an E57 file.

use crate::{file_of, guarded, refused, Failure, Outcome, Text};
use e57::{E57Reader, PointCloud, RecordDataType, RecordName, RecordValue};
use std::ffi::c_void;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

/// An open file with its scans.
pub struct E57File {
    reader: E57Reader<File>,
    clouds: Vec<PointCloud>,
}

/// How a coordinate is stored.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub struct Coordinate {
    single: bool,
    /// The step of a scaled integer, 0 of a float.
    scale: f64,
}

/// What the file says of a scan.
#[repr(C)]
pub struct E57Scan {
    records: u64,
    /// Range, azimuth and elevation in place of x, y, z.
    spherical: bool,
    coordinates: [Coordinate; 3],
    has_pose: bool,
    /// w, x, y, z.
    rotation: [f64; 4],
    translation: [f64; 3],
    name: Text,
}

/// Takes `count` points of three coordinates each, with the state of each: 0 valid, 1 only a
/// direction, 2 invalid. False stops.
type TakePoints =
    extern "C" fn(user: *mut c_void, points: *const f64, states: *const u8, count: usize) -> bool;

/// Points handed on at once.
const BATCH: usize = 4096;

const PAGE_BYTES: u64 = 1024;
const PAGE_DATA_BYTES: u64 = 1020;

/// A stream of a scan may be ahead of the others by so many values.
const MOST_AHEAD: u64 = 1 << 21;

/// The crate's message, without what only the crate's authors can use.
fn refusal(error: &e57::Error) -> Failure {
    let text = error.to_string();
    if let Some(at) = text.find("for page ") {
        if text.contains("checksum") {
            return refused(format!("the checksum of {} is wrong", &text[at + 4..]));
        }
    }
    if text.contains("truncated") || text.contains("failed to fill whole buffer") {
        return refused("the file ends before its data");
    }
    let text = text.replace("Invalid E57 content: ", "").replace("Failed to read E57: ", "");
    refused(text)
}

fn open(descriptor: i32) -> Outcome<E57File> {
    let mut file = file_of(descriptor)?;
    let size = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(0))?;
    let mut header = [0; 48];
    file.read_exact(&mut header)?;
    let number = |at: usize| {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&header[at..at + 8]);
        u64::from_le_bytes(bytes)
    };
    if &header[..8] != b"ASTM-E57" {
        return Err(refused("it does not begin as an E57 file"));
    }
    if number(16) != size {
        return Err(refused(format!("the header promises {} bytes, there are {size}", number(16))));
    }
    if number(32) > size {
        return Err(refused(format!(
            "the header promises {} bytes of XML, more than the file has",
            number(32)
        )));
    }
    file.seek(SeekFrom::Start(0))?;
    let reader = E57Reader::new(file).map_err(|e| refusal(&e))?;
    let clouds = reader.pointclouds();
    Ok(E57File { reader, clouds })
}

/// The places of three fields, if all are there.
fn three(cloud: &PointCloud, names: [RecordName; 3]) -> Option<[usize; 3]> {
    let mut places = [0; 3];
    for (place, name) in places.iter_mut().zip(names) {
        *place = cloud.prototype.iter().position(|record| record.name == name)?;
    }
    Some(places)
}

struct Fields {
    places: [usize; 3],
    state: Option<usize>,
    spherical: bool,
}

fn fields(cloud: &PointCloud) -> Outcome<Fields> {
    use RecordName::*;
    let place = |name| cloud.prototype.iter().position(|record| record.name == name);
    if let Some(places) = three(cloud, [CartesianX, CartesianY, CartesianZ]) {
        return Ok(Fields { places, state: place(CartesianInvalidState), spherical: false });
    }
    if let Some(places) = three(cloud, [SphericalRange, SphericalAzimuth, SphericalElevation]) {
        return Ok(Fields { places, state: place(SphericalInvalidState), spherical: true });
    }
    Err(refused("it has neither cartesian nor spherical coordinates"))
}

fn coordinate(data_type: &RecordDataType) -> Outcome<Coordinate> {
    Ok(match data_type {
        RecordDataType::Single { .. } => Coordinate { single: true, scale: 0.0 },
        RecordDataType::Double { .. } => Coordinate { single: false, scale: 0.0 },
        RecordDataType::Integer { .. } => Coordinate { single: false, scale: 1.0 },
        RecordDataType::ScaledInteger { scale, offset, .. } => {
            if !(scale.is_finite() && offset.is_finite() && *scale != 0.0) {
                return Err(refused(format!("its scale {scale} and offset {offset} are no numbers")));
            }
            Coordinate { single: false, scale: scale.abs() }
        }
    })
}

fn describe(cloud: &PointCloud, scan: &mut E57Scan) -> Outcome<()> {
    let fields = fields(cloud)?;
    scan.records = cloud.records;
    scan.spherical = fields.spherical;
    for (to, place) in scan.coordinates.iter_mut().zip(fields.places) {
        *to = coordinate(&cloud.prototype[place].data_type)?;
    }
    scan.has_pose = cloud.transform.is_some();
    let pose = cloud.transform.clone().unwrap_or_default();
    let (q, t) = (&pose.rotation, &pose.translation);
    scan.rotation = [q.w, q.x, q.y, q.z];
    scan.translation = [t.x, t.y, t.z];
    scan.name.set(cloud.name.as_deref().unwrap_or(""));
    Ok(())
}

/// Reads the data of the pages as if there were no checksums between them. The crate checks those.
struct Pages {
    file: File,
    at: u64,
}

impl Pages {
    fn seek_physical(&mut self, offset: u64) -> Outcome<()> {
        if offset % PAGE_BYTES >= PAGE_DATA_BYTES {
            return Err(refused(format!("byte {offset} is part of a checksum")));
        }
        self.at = offset / PAGE_BYTES * PAGE_DATA_BYTES + offset % PAGE_BYTES;
        Ok(())
    }

    fn read(&mut self, bytes: &mut [u8]) -> Outcome<()> {
        let mut done = 0;
        while done < bytes.len() {
            let left = (PAGE_DATA_BYTES - self.at % PAGE_DATA_BYTES) as usize;
            let now = left.min(bytes.len() - done);
            let physical = self.at / PAGE_DATA_BYTES * PAGE_BYTES + self.at % PAGE_DATA_BYTES;
            self.file.seek(SeekFrom::Start(physical))?;
            self.file.read_exact(&mut bytes[done..done + now])?;
            self.at += now as u64;
            done += now;
        }
        Ok(())
    }
}

fn bits_of(data_type: &RecordDataType) -> u64 {
    let range = match data_type {
        RecordDataType::Single { .. } => return 32,
        RecordDataType::Double { .. } => return 64,
        RecordDataType::ScaledInteger { min, max, .. } | RecordDataType::Integer { min, max } => {
            *max as i128 - *min as i128
        }
    };
    if range > 0 {
        u64::from(range.ilog2()) + 1
    } else {
        0
    }
}

/// Checks before anything is kept that the packets of the scan hold all of its records. No stream
/// may be far ahead of the others, as its values wait in memory.
fn check_packets(cloud: &PointCloud, descriptor: i32) -> Outcome<()> {
    let bits: Vec<u64> = cloud.prototype.iter().map(|record| bits_of(&record.data_type)).collect();
    if bits.iter().all(|b| *b == 0) {
        return Err(refused("all of its points are equal"));
    }
    let mut pages = Pages { file: file_of(descriptor)?, at: 0 };
    pages.seek_physical(cloud.file_offset)?;
    let mut section = [0; 32];
    let begin = pages.at;
    pages.read(&mut section)?;
    let number = |at: usize| {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&section[at..at + 8]);
        u64::from_le_bytes(bytes)
    };
    let end = begin.saturating_add(number(8));
    pages.seek_physical(number(16))?;

    let mut received = vec![0_u64; bits.len()];
    loop {
        let values = || {
            let of = received.iter().zip(&bits).filter(|(_, b)| **b > 0);
            of.map(|(r, b)| *r / *b)
        };
        let least = values().min().unwrap_or(0);
        if least >= cloud.records {
            return Ok(());
        }
        if values().max().unwrap_or(0) - least > MOST_AHEAD {
            return Err(refused("its packets hold far more of one field than of another"));
        }
        if pages.at >= end {
            return Err(refused(format!(
                "the header promises {} points, {least} follow",
                cloud.records
            )));
        }
        let begin = pages.at;
        let mut header = [0; 4];
        pages.read(&mut header)?;
        if header[0] == 1 {
            let mut count = [0; 2];
            pages.read(&mut count)?;
            if usize::from(u16::from_le_bytes(count)) != bits.len() {
                return Err(refused("a packet has other fields than the header promises"));
            }
            for sum in &mut received {
                let mut size = [0; 2];
                pages.read(&mut size)?;
                *sum += 8 * u64::from(u16::from_le_bytes(size));
            }
        } else if header[0] > 2 {
            return Err(refused(format!("a packet of the unknown kind {}", header[0])));
        }
        pages.at = begin + u64::from(u16::from_le_bytes([header[2], header[3]])) + 1;
    }
}

fn number(value: &RecordValue, data_type: &RecordDataType) -> Outcome<f64> {
    value.to_f64(data_type).map_err(|e| refusal(&e))
}

fn state_of(value: &RecordValue) -> Outcome<u8> {
    match value {
        RecordValue::Integer(state @ 0..=2) | RecordValue::ScaledInteger(state @ 0..=2) => {
            Ok(*state as u8)
        }
        other => Err(refused(format!("a point has the unknown state {other}"))),
    }
}

fn read_points(
    file: &mut E57File,
    descriptor: i32,
    index: usize,
    take: TakePoints,
    user: *mut c_void,
) -> Outcome<()> {
    let cloud = &file.clouds[index];
    let fields = fields(cloud)?;
    check_packets(cloud, descriptor)?;
    let mut points = Vec::with_capacity(3 * BATCH);
    let mut states = Vec::with_capacity(BATCH);
    let hand_on = |points: &mut Vec<f64>, states: &mut Vec<u8>| {
        let goes_on = take(user, points.as_ptr(), states.as_ptr(), states.len());
        points.clear();
        states.clear();
        if goes_on {
            Ok(())
        } else {
            Err(Failure::Stopped)
        }
    };
    for values in file.reader.pointcloud_raw(cloud).map_err(|e| refusal(&e))? {
        let values = values.map_err(|e| refusal(&e))?;
        for place in fields.places {
            points.push(number(&values[place], &cloud.prototype[place].data_type)?);
        }
        states.push(fields.state.map_or(Ok(0), |place| state_of(&values[place]))?);
        if states.len() == BATCH {
            hand_on(&mut points, &mut states)?;
        }
    }
    hand_on(&mut points, &mut states)
}

/// Gives an open file in `opened`, for scan_crates_e57_close.
#[no_mangle]
pub extern "C" fn scan_crates_e57_open(
    descriptor: i32,
    opened: &mut *mut E57File,
    scans: &mut usize,
    why: &mut Text,
) -> i32 {
    guarded(why, || {
        let file = open(descriptor)?;
        *scans = file.clouds.len();
        *opened = Box::into_raw(Box::new(file));
        Ok(())
    })
}

#[no_mangle]
pub extern "C" fn scan_crates_e57_scan(
    file: &E57File,
    index: usize,
    scan: &mut E57Scan,
    why: &mut Text,
) -> i32 {
    guarded(why, || describe(&file.clouds[index], scan))
}

/// `descriptor` is that of the open file.
#[no_mangle]
pub extern "C" fn scan_crates_e57_points(
    file: &mut E57File,
    descriptor: i32,
    index: usize,
    take: TakePoints,
    user: *mut c_void,
    why: &mut Text,
) -> i32 {
    guarded(why, || read_points(file, descriptor, index, take, user))
}

/// # Safety
/// `file` is from scan_crates_e57_open and not used again.
#[no_mangle]
pub unsafe extern "C" fn scan_crates_e57_close(file: *mut E57File) {
    drop(Box::from_raw(file));
}

//! The C interface of `c_interface.h`, over the crates `e57` and `laz`.
//!
//! Nothing unwinds out of it: an error and a panic of a crate become a text of one line.

mod e57_scans;
mod laz_points;

use std::ffi::c_char;
use std::fs::File;
use std::os::fd::{BorrowedFd, RawFd};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::Once;

/// Why a call gave no result.
pub(crate) enum Failure {
    /// The text ends an error message "<file>: <text>".
    Refused(String),
    /// The callback asked to stop.
    Stopped,
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::UnexpectedEof {
            return refused("the file ends before its data");
        }
        Failure::Refused(error.to_string())
    }
}

pub(crate) fn refused(text: impl Into<String>) -> Failure {
    Failure::Refused(text.into())
}

pub(crate) type Outcome<T> = Result<T, Failure>;

pub(crate) const TEXT_BYTES: usize = 256;

/// A text that ends with a zero byte, in printable ASCII.
#[repr(C)]
pub struct Text {
    bytes: [c_char; TEXT_BYTES],
}

impl Text {
    pub(crate) fn set(&mut self, text: &str) {
        self.bytes = [0; TEXT_BYTES];
        for (to, from) in self.bytes[..TEXT_BYTES - 1].iter_mut().zip(text.chars()) {
            *to = if (' '..='~').contains(&from) { from as c_char } else { b'?' as c_char };
        }
    }
}

pub const DONE: i32 = 0;
pub const REFUSED: i32 = 1;
pub const STOPPED: i32 = 2;

/// Runs `work`. An error or a panic is described in `why`.
pub(crate) fn guarded(why: &mut Text, work: impl FnOnce() -> Outcome<()>) -> i32 {
    static SILENCE: Once = Once::new();
    // The message of a panic goes to `why`, not to standard error.
    SILENCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(())) => DONE,
        Ok(Err(Failure::Stopped)) => STOPPED,
        Ok(Err(Failure::Refused(text))) => {
            why.set(&text);
            REFUSED
        }
        Err(_) => {
            why.set("its content is contradictory");
            REFUSED
        }
    }
}

/// The caller's file, which stays the caller's to close.
pub(crate) fn file_of(descriptor: RawFd) -> Outcome<File> {
    // SAFETY: the caller keeps the descriptor open during the call.
    let borrowed = unsafe { BorrowedFd::borrow_raw(descriptor) };
    Ok(File::from(borrowed.try_clone_to_owned()?))
}

/// Panics, to show that a panic becomes an error.
#[no_mangle]
pub extern "C" fn scan_crates_panic(why: &mut Text) -> i32 {
    guarded(why, || panic!("as asked"))
}

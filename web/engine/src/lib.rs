//! The engine of the page: a request goes in as JSON, the answer comes out as JSON.
//!
//! Nothing is decided here: [`answer_to`] passes a request on to the program (the documents of `--json`, byte for byte) or to the
//! functions that pictures are made of. What leaves this crate beside those documents is floating point for pictures, and words.
//!
//! The page talks to it through three functions of plain numbers, so that no glue has to be generated: [`request`] gives room for
//! the text, [`answer`] the place of the answer (its length in four bytes before it), [`last_words`] the message of a panic, after
//! which the instance is thrown away. Where there is WebAssembly there is one thread, so statics are nobody else's.

#![deny(unsafe_code, missing_docs)]

mod command;
mod describe;
mod map;
mod model;
mod pictures;
mod proof;
mod reply;
mod told;

use reply::Reply;
use serde::Deserialize;
use std::sync::Mutex;

/// What the page asks.
#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
enum Request {
    /// A command of the program; `-` as MODEL is the text.
    Program { model: Option<String>, arguments: Vec<String> },
    /// What a text says: every remark with its place, parameters, blocks.
    Describe { model: String },
    /// The roots and the time response at a point, the polynomial's coefficients.
    Point(pictures::PointRequest),
    /// The map of two parameters as lines and areas.
    Map(map::MapRequest),
    /// A certificate of the verdict, or of the stable set of one parameter.
    Certificate(proof::CertificateRequest),
    /// Whether a certificate proves its statement about a model, by the checker's own code.
    Check { model: String, certificate: String },
}

/// The answer to a request, both JSON; a request that is not understood is answered too.
///
/// Cost: that of what is asked for.
pub fn answer_to(request: &str) -> String {
    let reply = match serde_json::from_str(request) {
        Ok(request) => dispatch(request),
        Err(error) => Reply::defect(format!("the request is not understood: {error}")),
    };
    reply.to_text()
}

fn dispatch(request: Request) -> Reply {
    match request {
        Request::Program { model, arguments } => command::run(model.as_deref(), arguments),
        Request::Describe { model } => describe::describe(&model),
        Request::Point(request) => Reply::of(pictures::point(&request)),
        Request::Map(request) => Reply::of(map::map(&request)),
        Request::Certificate(request) => Reply::of(proof::certificate(&request)),
        Request::Check { model, certificate } => proof::check(&model, &certificate),
    }
}

/// The text that goes in.
static REQUEST: Mutex<Vec<u8>> = Mutex::new(Vec::new());
/// The text that comes out, its length in four bytes before it.
static ANSWER: Mutex<Vec<u8>> = Mutex::new(Vec::new());
/// The message of a panic, likewise.
static LAST_WORDS: Mutex<Vec<u8>> = Mutex::new(Vec::new());

/// Room for a request of so many bytes of UTF-8.
#[allow(unsafe_code, reason = "the name is what the page calls")]
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    let Ok(mut bytes) = REQUEST.lock() else { return std::ptr::null_mut() };
    *bytes = vec![0; length];
    bytes.as_mut_ptr()
}

/// The answer to the request that was written there: its length in four bytes, little end first, and its UTF-8.
#[allow(unsafe_code, reason = "the name is what the page calls")]
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    std::panic::set_hook(Box::new(|info| {
        let what = info.payload_as_str().unwrap_or("no message");
        let place = info.location().map(|l| format!(" ({}:{})", l.file(), l.line())).unwrap_or_default();
        store(&LAST_WORDS, &format!("{what}{place}"));
    }));
    let bytes = REQUEST.lock().map(|mut bytes| std::mem::take(&mut *bytes)).unwrap_or_default();
    store(&ANSWER, &answer_to(&String::from_utf8_lossy(&bytes)))
}

/// What a panic said, in the same form; empty where there was none.
#[allow(unsafe_code, reason = "the name is what the page calls")]
#[unsafe(no_mangle)]
pub extern "C" fn last_words() -> *const u8 {
    let empty = LAST_WORDS.lock().is_ok_and(|words| words.is_empty());
    if empty { store(&LAST_WORDS, "") } else { LAST_WORDS.lock().map_or(std::ptr::null(), |words| words.as_ptr()) }
}

fn store(place: &Mutex<Vec<u8>>, text: &str) -> *const u8 {
    let Ok(mut bytes) = place.lock() else { return std::ptr::null() };
    *bytes = (text.len() as u32).to_le_bytes().to_vec();
    bytes.extend_from_slice(text.as_bytes());
    bytes.as_ptr()
}

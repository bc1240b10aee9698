//! `jurist page`: the page for the browser, which computes there, as a folder of files.

use super::{Context, Runs};
use crate::cli::arguments::RunOptions;
use crate::cli::output::{note, plain};
use crate::cli::picture::write;
use crate::cli::status::{Outcome, Status};
use clap::Args;
use jurist_engine::error::{Code, Diagnostic};
use std::ffi::OsString;
use std::path::Path;

/// Options of `jurist page`.
#[derive(Args, Debug)]
pub(in crate::cli) struct Options {
    /// The folder to write into; it is made if it does not exist
    #[arg(short, long, value_name = "DIR", default_value = "jurist-page")]
    pub output: OsString,
    #[command(flatten)]
    pub run: RunOptions,
}

impl Runs for Options {
    fn run(&self, context: &Context) -> Outcome {
        let Some(files) = packed::files() else {
            let help = "in the sources, 'web/build' makes it, and 'web/build --program' a program that has it inside";
            return Err(Diagnostic::error(Code::NoPage, "this program was built without the page").help(help).into());
        };
        let folder = Path::new(&self.output);
        std::fs::create_dir_all(folder).map_err(|e| {
            Diagnostic::error(Code::Write, format!("cannot make the folder {}: {}", folder.display(), plain(&e)))
        })?;
        for (name, content) in &files {
            write(&folder.join(name), content)?;
        }
        if !context.quiet {
            note(&format!("wrote {}: open it in a browser", folder.join("index.html").display()));
        }
        Ok(Status::Holds)
    }

    fn writes_a_folder(&self) -> bool {
        true
    }
}

#[cfg(not(feature = "page"))]
mod packed {
    pub(super) fn files() -> Option<Vec<(String, Vec<u8>)>> {
        None
    }
}

#[cfg(feature = "page")]
mod packed {
    /// A line `name length` for each file, an empty line, and what is in the files; all of it packed.
    static PACKED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/page.lzma"));

    /// Every file with its content; nothing where the page was not there when the program was built.
    pub(super) fn files() -> Option<Vec<(String, Vec<u8>)>> {
        let mut all = Vec::new();
        lzma_rs::lzma_decompress(&mut &PACKED[..], &mut all).ok()?;
        let mut files = separated(&all)?;
        let scripts = files
            .iter()
            .filter_map(|(name, content)| Some((format!("{}.js", name.strip_suffix(".wasm")?), script(content))));
        let scripts: Vec<_> = scripts.collect();
        files.extend(scripts);
        Some(files)
    }

    fn separated(all: &[u8]) -> Option<Vec<(String, Vec<u8>)>> {
        let end = all.windows(2).position(|two| two == b"\n\n")?;
        let mut rest = &all[end + 2..];
        let head = std::str::from_utf8(&all[..end]).ok()?;
        head.lines()
            .map(|line| {
                let (name, length) = line.rsplit_once(' ')?;
                let (content, after) = rest.split_at_checked(length.parse().ok()?)?;
                rest = after;
                Some((name.to_owned(), content.to_vec()))
            })
            .collect()
    }

    /// The script that holds a module, for a page that is opened from a file, where nothing can be fetched.
    fn script(module: &[u8]) -> Vec<u8> {
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(module, 6);
        format!("globalThis.juristEngine=\"{}\";", base64(&packed)).into_bytes()
    }

    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    fn base64(bytes: &[u8]) -> String {
        let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
        for three in bytes.chunks(3) {
            let bits = (0..3).fold(0, |bits, k| bits << 8 | usize::from(three.get(k).copied().unwrap_or(0)));
            for k in 0..4 {
                let letter = char::from(LETTERS[bits >> (18 - 6 * k) & 63]);
                text.push(if k <= three.len() { letter } else { '=' });
            }
        }
        text
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn base64_is_that_of_the_standard() {
            // RFC 4648, section 10.
            let cases = ["", "f", "fo", "foo", "foob", "fooba", "foobar"];
            let texts = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
            for (case, text) in cases.into_iter().zip(texts) {
                assert_eq!(base64(case.as_bytes()), text);
            }
        }

        #[test]
        fn what_is_cut_off_is_no_page() {
            let all = b"a 3\nb c 0\nd 2\n\nxyz\n\n";
            let files = [("a", "xyz"), ("b c", ""), ("d", "\n\n")].map(|(n, c)| (n.to_owned(), c.as_bytes().to_vec()));
            assert_eq!(separated(all), Some(files.to_vec()));
            for end in 0..all.len() {
                assert_eq!(separated(&all[..end]), None, "{end}");
            }
        }

        #[test]
        fn scripts_hold_their_module() {
            let module: Vec<u8> = (0..100_000_u32).map(|k| (k.wrapping_mul(k) >> 7) as u8).collect();
            let text = String::from_utf8(script(&module)).unwrap();
            let held = text.strip_prefix("globalThis.juristEngine=\"").and_then(|t| t.strip_suffix("\";")).unwrap();
            let digit = |letter: u8| LETTERS.iter().position(|l| *l == letter).unwrap();
            let digits: Vec<usize> = held.trim_end_matches('=').bytes().map(digit).collect();
            let bytes: Vec<u8> = digits
                .chunks(4)
                .flat_map(|four| {
                    let bits = (0..4).fold(0, |bits, k| bits << 6 | four.get(k).copied().unwrap_or(0));
                    (0..four.len() - 1).map(move |k| (bits >> (16 - 8 * k)) as u8)
                })
                .collect();
            assert_eq!(miniz_oxide::inflate::decompress_to_vec_zlib(&bytes).ok(), Some(module));
        }
    }
}

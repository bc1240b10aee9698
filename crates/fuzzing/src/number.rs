//! The number parser and printer.

use jurist_algebra::number::{parse_decimal_literal, parse_number, scan_decimal_literal};

/// Longer inputs might print to more than the parser admits.
const LONGEST_ROUND_TRIP: usize = 1_000_000;

/// Any text either is refused at a place inside it or has a value that, printed in full, parses to
/// itself; the scanner finds literals that the parser of literals does not call malformed.
///
/// # Panics
/// When one of this does not hold.
pub fn number_parser(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match parse_number(text) {
        Ok(value) if text.len() <= LONGEST_ROUND_TRIP => {
            assert_eq!(parse_number(&value.to_string()), Ok(value), "a number printed in full parses to itself");
        }
        Ok(_) => {}
        Err(error) => assert!(error.offset <= text.len(), "an error lies in the text"),
    }
    let length = scan_decimal_literal(text);
    assert!(text.is_char_boundary(length), "a literal ends between characters");
    if length > 0 {
        use jurist_algebra::number::ParseNumberErrorKind::{ExponentTooLarge, TooLong};
        if let Err(error) = parse_decimal_literal(&text[..length]) {
            assert!(matches!(error.kind, ExponentTooLarge | TooLong), "a scanned literal is only refused for its size");
        }
    }
    assert!(length == text.len() || parse_decimal_literal(text).is_err(), "a literal ends where it is scanned to end");
}

#[cfg(test)]
mod tests {
    use super::number_parser;

    #[test]
    fn texts_that_look_like_numbers() {
        for text in [
            "",
            " ",
            "-",
            "+-1",
            "0.046",
            "46e-3",
            ".5",
            "5.",
            ".",
            "..",
            "0..1",
            "1e",
            "1e+",
            "1e+-",
            "1e_5",
            "1_",
            "_1",
            "1__0",
            "1_.5",
            "1._5",
            "1.5e+3/7",
            "1/0",
            "1//2",
            "/",
            "-1/-3",
            "1e100000",
            "1e-100000",
            "1e100001",
            "1e100000/1e-100000",
            "1e99999999999999999999999",
            "é",
            "1é",
            "1e\u{e9}",
            "\u{a0}1\u{2003}/\u{3000}2",
            "\u{661}",
            "inf",
            "NaN",
            "0x10",
            "1e0000000000000000000000000001",
        ] {
            number_parser(text.as_bytes());
        }
        number_parser(b"1\xff");
    }
}

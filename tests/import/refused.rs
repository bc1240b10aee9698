//! What is refused: in words, at its place, and never by a panic.

use super::file;
use crate::helpers::program::{jurist_with_input, refused};
use crate::helpers::random::Random;

#[test]
fn files_that_are_no_systems() {
    let cases = [
        ("level-4.mat", "perhaps one of level 4", "save -v7"),
        ("sparse.mat", "A is sparse", "full(..)"),
        ("complex.mat", "A is complex", "real(..)"),
        ("nan.mat", "row 2, column 1 of A is NaN or infinite: not a finite number", ""),
        ("not-square.mat", "not-square.mat: A is 2 by 3, not square", ""),
        ("wrong-b.mat", "B is 3 by 1, but A is 2 by 2", "a row for each state"),
        ("empty.mat", "A is empty (0 by 0)", "without states"),
        ("delayed.mat", "InputDelay makes it a system with dead time", "delay"),
        ("two-systems.mat", "several systems, such as 'p' and 'q'", ""),
    ];
    for (name, message, help) in cases {
        let run = refused(&["import", &file(name)], "E-import");
        assert!(run.stderr.contains(message) && run.stderr.contains(help), "{name}: {}", run.stderr);
    }
    refused(&["import", &file("is-not-there.mat")], "E-read");
}

/// What is said of bytes on standard input.
fn said(bytes: &[u8]) -> String {
    let run = jurist_with_input(&["import", "-"], bytes);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{}", run.stderr);
    assert!(!run.stderr.contains("E-internal"), "{}", run.stderr);
    run.stderr
}

#[test]
fn texts_that_are_no_systems() {
    let cases = [
        ("A\r\n1,2\r\n3,x\r\n", "<stdin>:3:3"),
        ("A\n1,2\n3\n", "row 2 of A has 1 numbers, but the rows above have 2"),
        ("A\n1,2\n3,Inf\n", "row 2, column 2 of A is Inf: not a finite number"),
        ("B\n1\n", "there is no matrix A"),
        ("A\n1\nB\n1\nD\n1,2\n", "D is 1 by 2, but there are 1 outputs and 1 inputs"),
        ("A\n1\nD\n1\n", "there is no B"),
        ("A\n1\nTs\n-0.5\n", "the sample time Ts is -0.5"),
        ("{\"A\": [[1, 2], [3, \"4\"]]}", "row 2, column 2 of A"),
        ("{\"A\": 1, \"E\": 2}", "the matrix E makes it a descriptor system"),
        ("{\"A\": [[NaN]]}", "NaN and Infinity are no numbers of JSON"),
        ("{\"A\": [1, 2]}", "A is a vector of 2, not square"),
        ("model M\n  parameter Real x = 1;\nend M;\n", "no linear model of OpenModelica"),
        ("model M\n  parameter Integer n = 99999;\nend M;\n", "is no size of a system"),
        ("", "of no format that can be imported"),
    ];
    for (text, message) in cases {
        let stderr = said(text.as_bytes());
        assert!(stderr.contains("error[E-import]") && stderr.contains(message), "{text}: {stderr}");
    }
    assert!(said(b"MATLAB 7.3 MAT-file").contains("version 7.3 (HDF5)"));
    assert!(said(b"\x93NUMPY\x01\x00").contains("a single array"));
    assert!(said(b"A\n\xff\n").contains("of no format"));
}

/// What unpacks to much, elements that say they are long, deep nesting, long lines.
#[test]
#[ignore = "long: CI runs it"]
fn sizes_are_limited() {
    let mut bytes = std::fs::read(file("servo.mat")).unwrap()[..128].to_vec();
    let zeros = packed_zeros(66 << 20);
    bytes.extend(15u32.to_le_bytes());
    bytes.extend((zeros.len() as u32).to_le_bytes());
    bytes.extend(zeros);
    assert!(said(&bytes).contains("unpacks to more than 64 megabytes"));
    let mut bytes = std::fs::read(file("servo.mat")).unwrap()[..128].to_vec();
    bytes.extend([14, 0, 0, 0, 0xff, 0xff, 0xff, 0x7f]);
    assert!(said(&bytes).contains("cut off or damaged"));
    let deep = format!("{{\"A\": {}", "[".repeat(1 << 20));
    assert!(said(deep.as_bytes()).contains("E-import"));
    let long = format!("A\n{}\n", "1,".repeat(1 << 20));
    assert!(said(long.as_bytes()).contains("cells"));
    assert!(said(&vec![b'1'; 9 << 20]).contains("longer than 8 megabytes"));
}

/// So many zeros, packed as zlib packs them: blocks of one distance and the longest length, written bit by bit.
fn packed_zeros(count: usize) -> Vec<u8> {
    let mut bits = Vec::<u8>::new();
    let mut used = 8;
    let mut push = |value: u32, width: u32| {
        for k in 0..width {
            if used == 8 {
                bits.push(0);
                used = 0;
            }
            let last = bits.len() - 1;
            bits[last] |= ((value >> k & 1) as u8) << used;
            used += 1;
        }
    };
    // The last block, with the fixed code; a zero; then copies of 258 bytes from one byte before.
    push(0b011, 3);
    push(0b0000_1100, 8);
    for _ in 0..count / 258 {
        push(0b1010_0011, 8);
        push(0, 5);
    }
    push(0, 7);
    [&[0x78, 0x01][..], &bits].concat()
}

#[test]
#[ignore = "long: CI runs it"]
fn damaged_files_are_refused_or_read_but_never_a_panic() {
    let names =
        ["servo.mat", "servo-packed.mat", "sampled-struct.mat", "servo.npz", "sampled.npz", "linearized_model.mo"];
    let mut random = Random::new(11);
    for name in names {
        let whole = std::fs::read(file(name)).unwrap();
        for _ in 0..12 {
            let mut bytes = whole.clone();
            let at = random.below(bytes.len());
            match random.below(3) {
                0 => bytes.truncate(at),
                1 => bytes[at] ^= 1 << random.below(8),
                _ => drop(bytes.drain(at..(at + 8).min(whole.len()))),
            }
            let run = jurist_with_input(&["import", "-"], &bytes);
            assert!(run.status == 0 || run.status == 2, "{name}: {at}: {}", run.stderr);
        }
    }
}

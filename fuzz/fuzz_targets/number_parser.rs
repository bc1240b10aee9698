#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| jurist_fuzzing::number_parser(data));

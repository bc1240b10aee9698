#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| jurist::fuzzing::interval_answer(data));

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| jurist::fuzzing::certificate_check(data));

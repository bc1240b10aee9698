#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| jurist_fuzzing::sampled_against_float_roots(data));

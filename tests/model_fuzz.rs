//! The fuzz harness of models over damaged copies of the examples.

use jurist_fuzzing::model_parser;

#[test]
fn damaged_examples() {
    for text in [jurist_engine::model::DRIVE, include_str!("../examples/drive-blocks.toml")] {
        let bytes = text.as_bytes();
        let mut state = 12345u64;
        for _ in 0..120 {
            let mut next = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 33) as usize
            };
            let mut damaged = bytes.to_vec();
            for _ in 0..1 + next() % 3 {
                let at = next() % damaged.len();
                match next() % 3 {
                    0 => damaged[at] = b"()[]{}\"'=^*/-+.,z0 \n#\\\xff"[next() % 23],
                    1 => drop(damaged.remove(at)),
                    _ => damaged.truncate(at.max(1)),
                }
            }
            model_parser(&damaged);
        }
    }
}

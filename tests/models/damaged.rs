//! The fuzz harness of models over damaged copies of the examples.

use crate::helpers::random::Random;
use jurist_fuzzing::model_parser;

#[test]
fn damaged_examples() {
    for text in [jurist_engine::model::DRIVE, include_str!("../../examples/drive-blocks.toml")] {
        let bytes = text.as_bytes();
        let mut random = Random::new(12345);
        for _ in 0..120 {
            let mut next = |bound| random.below(bound);
            let mut damaged = bytes.to_vec();
            for _ in 0..1 + next(3) {
                let at = next(damaged.len());
                match next(3) {
                    0 => damaged[at] = b"()[]{}\"'=^*/-+.,z0 \n#\\\xff"[next(23)],
                    1 => drop(damaged.remove(at)),
                    _ => damaged.truncate(at.max(1)),
                }
            }
            model_parser(&damaged);
        }
    }
}

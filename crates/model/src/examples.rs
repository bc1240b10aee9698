#![doc = include_str!("examples.md")]

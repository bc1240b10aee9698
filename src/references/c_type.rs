//! What a constant of C holds, by the words of its declaration.

use jurist_algebra::number::BinaryFormat;

/// What a constant holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Type {
    /// What its literal is.
    OfLiteral,
    /// With the values that it has at least, whatever compiler there is; `int` is taken for 32 bits.
    Integer {
        low: i64,
        high: i64,
    },
    Binary(BinaryFormat),
}

/// The type of a declaration without storage and qualifiers.
pub(super) fn type_of(words: &[&str]) -> Result<Type, String> {
    let is = |names: &[&str]| words.iter().any(|word| names.contains(word));
    if is(&["long"]) && is(&["double"]) {
        return Err("a long double is held differently by compilers; as = \"decimal\" takes it as written".to_owned());
    }
    match words {
        ["auto"] => return Ok(Type::OfLiteral),
        ["float" | "float32_t" | "real32_T"] => return Ok(Type::Binary(BinaryFormat::Single)),
        ["double" | "float64_t" | "real_T" | "real64_T"] => return Ok(Type::Binary(BinaryFormat::Double)),
        _ => {}
    }
    let Some((is_unsigned, bits)) = integer(words) else {
        let shown = words.join(" ");
        return Err(format!("the type '{shown}' is not known here; as = \"decimal\" takes the literal as written"));
    };
    let most = i64::try_from((1_i128 << (bits - 1)) - 1).unwrap_or(i64::MAX);
    // Whether a plain char has a sign is the compiler's choice.
    let has_no_sign = is_unsigned || words == ["char"];
    let low = if has_no_sign { 0 } else { -most - 1 };
    let high = if is_unsigned && bits < 64 { 2 * most + 1 } else { most };
    Ok(Type::Integer { low, high })
}

/// Whether an integer type is unsigned, and how many bits it has at least.
fn integer(words: &[&str]) -> Option<(bool, u32)> {
    if let [word] = words
        && let Some(rest) = word.strip_suffix("_t")
    {
        let (is_unsigned, rest) = rest.strip_prefix('u').map_or((false, rest), |rest| (true, rest));
        let bits = match rest {
            "size" => return Some((true, 32)),
            _ => rest.strip_prefix("int")?.trim_start_matches("_least").trim_start_matches("_fast"),
        };
        return bits.parse().ok().filter(|bits| [8, 16, 32, 64].contains(bits)).map(|bits| (is_unsigned, bits));
    }
    const WORDS: [&str; 6] = ["int", "long", "short", "char", "unsigned", "signed"];
    let has = |name: &str| words.contains(&name);
    let is_whole = !words.is_empty() && words.iter().all(|word| WORDS.contains(word));
    let bits = if has("char") {
        8
    } else if has("short") {
        16
    } else {
        32
    };
    is_whole.then(|| (has("unsigned"), bits))
}

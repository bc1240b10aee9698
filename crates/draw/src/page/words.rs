//! Plain text such as `K_pwm*T^2 < 1.5e-3` taken apart, to be set as mathematics.

/// A piece of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Token {
    /// A word or a name, `class-C` included.
    Word(String),
    /// Digits, and a power of ten where `e` names one.
    Number(String, Option<String>),
    /// What stands behind `^`.
    Power(String),
    /// Any other character.
    Sign(char),
}

/// The pieces of a text, in order; together they are the whole text.
///
/// ```
/// use jurist_draw::page::words::{Token, tokens};
/// assert_eq!(tokens("T^2"), [Token::Word("T".into()), Token::Power("2".into())]);
/// ```
pub fn tokens(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let while_ = |from: usize, test: &dyn Fn(char) -> bool| {
        (from..chars.len()).find(|k| !test(chars[*k])).unwrap_or(chars.len())
    };
    let part = |from: usize, to: usize| chars[from..to].iter().collect::<String>();
    let mut out = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let begin = i;
        if chars[i].is_alphabetic() {
            i = while_(i, &|c| c.is_alphanumeric() || c == '_');
            // A hyphen between words is no minus.
            while i > begin + 1 && !chars[begin..i].contains(&'_') && chars.get(i) == Some(&'-') {
                match chars.get(i + 1) {
                    Some(c) if c.is_alphabetic() => i = while_(i + 1, &|c| c.is_alphanumeric()),
                    _ => break,
                }
            }
            out.push(Token::Word(part(begin, i)));
        } else if chars[i].is_ascii_digit() {
            i = while_(i, &|c| c.is_ascii_digit() || c == '.');
            let digits = part(begin, i);
            let sign = usize::from(chars.get(i + 1).is_some_and(|c| *c == '-'));
            let power = (chars.get(i) == Some(&'e') && chars.get(i + 1 + sign).is_some_and(char::is_ascii_digit))
                .then(|| part(i + 1, while_(i + 1 + sign, &|c| c.is_ascii_digit())));
            i += power.as_ref().map_or(0, |p| p.len() + 1);
            out.push(Token::Number(digits, power));
        } else if chars[i] == '^' {
            i = while_(i + 1, &|c| c.is_ascii_digit());
            out.push(Token::Power(part(begin + 1, i)));
        } else {
            out.push(Token::Sign(chars[i]));
            i += 1;
        }
    }
    out
}

/// Whether a word without an index is a variable. The article and units are not.
///
/// ```
/// use jurist_draw::page::words::is_variable;
/// assert!(is_variable("T") && !is_variable("V"));
/// ```
pub fn is_variable(word: &str) -> bool {
    word == "omega" || word.chars().count() == 1 && !["a", "s", "m", "A", "H", "N", "V"].contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces() {
        let word = |w: &str| Token::Word(w.into());
        let expected = vec![
            word("K_pwm"),
            Token::Sign('*'),
            word("T"),
            Token::Power("2".into()),
            Token::Sign(' '),
            Token::Sign('<'),
            Token::Sign(' '),
            Token::Number("1.5".into(), Some("-3".into())),
        ];
        assert_eq!(tokens("K_pwm*T^2 < 1.5e-3"), expected);
        assert_eq!(tokens("class-C"), vec![word("class-C")]);
        assert_eq!(tokens("R_a-T"), vec![word("R_a"), Token::Sign('-'), word("T")]);
        assert_eq!(tokens("2e"), vec![Token::Number("2".into(), None), word("e")]);
    }
}

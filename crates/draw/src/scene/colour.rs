//! Colours.

/// An opaque colour: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Colour(pub u8, pub u8, pub u8);

impl Colour {
    /// Black.
    pub const BLACK: Colour = Colour(0, 0, 0);
    /// White.
    pub const WHITE: Colour = Colour(255, 255, 255);

    /// The colour that CSS calls `#rrggbb`, `#rgb`, `white` or `black`; black for all else.
    ///
    /// ```
    /// use jurist_draw::scene::Colour;
    /// assert_eq!(Colour::css("#0072B2"), Colour(0, 0x72, 0xb2));
    /// assert_eq!(Colour::css("#fff"), Colour::WHITE);
    /// ```
    pub const fn css(text: &str) -> Colour {
        const fn digit(c: u8) -> u8 {
            match c {
                b'0'..=b'9' => c - b'0',
                b'a'..=b'f' => c - b'a' + 10,
                b'A'..=b'F' => c - b'A' + 10,
                _ => 0,
            }
        }
        match text.as_bytes() {
            [b'#', a, b, c, d, e, f] => {
                Colour(16 * digit(*a) + digit(*b), 16 * digit(*c) + digit(*d), 16 * digit(*e) + digit(*f))
            }
            [b'#', r, g, b] => Colour(17 * digit(*r), 17 * digit(*g), 17 * digit(*b)),
            [b'w', b'h', b'i', b't', b'e'] => Colour::WHITE,
            _ => Colour::BLACK,
        }
    }
}

impl std::fmt::Display for Colour {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

//! What the paper prints, digit for digit, as its machine-read text has it.

/// A printed coefficient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Printed {
    /// Where it stands.
    pub place: &'static str,
    /// Coefficient of this power of z.
    pub power_of_z: usize,
    /// Times this power of the parameter.
    pub power_of_parameter: usize,
    /// The digits, with the sign.
    pub digits: &'static str,
}

const fn p(place: &'static str, power_of_z: usize, power_of_parameter: usize, digits: &'static str) -> Printed {
    Printed { place, power_of_z, power_of_parameter, digits }
}

/// Eq. 23, in K_pwm.
pub const EQUATION_23: &[Printed] = &[
    p("Eq. 23", 5, 0, "-3.99781748481"),
    p("Eq. 23", 4, 0, "5.99345318022"),
    p("Eq. 23", 3, 0, "-3.99345390603"),
    p("Eq. 23", 2, 0, "0.997818210612"),
    p("Eq. 23", 4, 1, "1.81612318841e-3"),
    p("Eq. 23", 3, 1, "-5.43929597164e-3"),
    p("Eq. 23", 2, 1, "5.43129677584e-3"),
    p("Eq. 23", 1, 1, "-1.80919241724e-3"),
    p("Eq. 23", 0, 1, "1.06842730978e-6"),
];

/// The list of coefficients after Eq. 36, in K_pwm.
pub const LIST_AFTER_36: &[Printed] = &[
    p("list after Eq. 36", 0, 1, "1.06842730978e-6"),
    p("list after Eq. 36", 1, 1, "1.80919241724e-3"),
    p("list after Eq. 36", 2, 0, "0.997818210612"),
    p("list after Eq. 36", 2, 1, "5.43129677584e-3"),
    p("list after Eq. 36", 3, 0, "-3.99345390603"),
    p("list after Eq. 36", 3, 1, "-5.43929597164e-3"),
    p("list after Eq. 36", 4, 0, "5.99345318022"),
    p("list after Eq. 36", 4, 1, "1.81612318841e-3"),
    p("list after Eq. 36", 5, 0, "-3.99781748481"),
];

/// Eq. 37, in T.
pub const EQUATION_37: &[Printed] = &[
    p("Eq. 37", 0, 3, "-324090.307"),
    p("Eq. 37", 0, 2, "11785.102"),
    p("Eq. 37", 0, 4, "736568.879"),
    p("Eq. 37", 1, 1, "-1992.75362"),
    p("Eq. 37", 1, 4, "1473137.76"),
    p("Eq. 37", 1, 2, "26420.0562"),
    p("Eq. 37", 1, 3, "-4285.49167"),
    p("Eq. 37", 2, 0, "1"),
    p("Eq. 37", 2, 1, "5956.43571"),
    p("Eq. 37", 2, 4, "736568.879"),
    p("Eq. 37", 2, 3, "324090.307"),
    p("Eq. 37", 2, 2, "-38303.9972"),
    p("Eq. 37", 3, 0, "-4"),
    p("Eq. 37", 3, 1, "-5912.7854"),
    p("Eq. 37", 3, 2, "-49792.5822"),
    p("Eq. 37", 3, 3, "4285.49167"),
    p("Eq. 37", 4, 0, "6"),
    p("Eq. 37", 4, 1, "1927.27816"),
    p("Eq. 37", 4, 2, "49891.4212"),
    p("Eq. 37", 5, 0, "-4"),
    p("Eq. 37", 5, 1, "21.8251519"),
];

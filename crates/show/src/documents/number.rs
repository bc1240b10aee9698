//! Numbers and names with values.

use super::over::Over;
use crate::real;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::UniPoly;
use jurist_algebra::real::Real;
use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// An exact rational number as text: `p/q` in lowest terms with `q` above 1, or an integer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(extend("pattern" = "^-?[0-9]+(/[0-9]+)?$")))]
#[serde(transparent)]
pub struct Exact(String);

impl Exact {
    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Integer coefficients, from the constant term up.
    pub fn coefficients(p: &UniPoly) -> Vec<Exact> {
        p.coeffs().iter().map(Exact::from).collect()
    }
}

impl From<&Rational> for Exact {
    fn from(value: &Rational) -> Self {
        Exact(value.to_string())
    }
}

impl From<&Integer> for Exact {
    fn from(value: &Integer) -> Self {
        Exact(value.to_string())
    }
}

/// Lower and upper bound of a real number, both included; equal where the number is rational and known.
pub type Enclosure = [Exact; 2];

/// Both bounds as texts.
pub(super) fn enclosure(lower: &Rational, upper: &Rational) -> Enclosure {
    [lower.into(), upper.into()]
}

/// Whether a number is algebraic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum NumberKind {
    /// A root of a polynomial over the integers.
    Algebraic,
    /// Known by enclosures of any width, and not rational.
    Transcendental,
}

/// A real number.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Number {
    /// Correctly rounded to the digits asked for, ties to even; plain notation for 1e-6 <= |v| < 1e15, else `d.ddde-7`.
    pub decimal: String,
    /// Whether the number is a root of a polynomial over the integers.
    pub kind: NumberKind,
    /// The number itself where it is rational, else `null`.
    pub exact: Option<Exact>,
    /// Lower and upper bound, equal exactly when the number is rational; no other root of `polynomial` lies between.
    pub enclosure: Enclosure,
    /// A square-free primitive integer polynomial that has the number as a root, coefficients from the constant term up;
    /// `null` for a transcendental number.
    pub polynomial: Option<Vec<Exact>>,
    /// What a transcendental number is a root of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<Over>,
}

impl Number {
    /// With so many digits of its decimal.
    pub fn new(value: &Real, digits: usize) -> Self {
        let rounded = real::rounded(value, digits);
        Number {
            decimal: rounded.decimal,
            kind: if value.algebraic().is_some() { NumberKind::Algebraic } else { NumberKind::Transcendental },
            exact: value.exact().as_ref().map(Exact::from),
            enclosure: enclosure(&rounded.enclosure.0, &rounded.enclosure.1),
            polynomial: value.algebraic().map(|x| Exact::coefficients(x.polynomial())),
            over: Over::of(value),
        }
    }
}

/// Values by name, in the order of the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<T>(Vec<(String, T)>);

impl<T> Named<T> {
    /// Names with their values.
    pub fn entries(&self) -> &[(String, T)] {
        &self.0
    }
}

impl<T> FromIterator<(String, T)> for Named<T> {
    /// Of values with the same name the last one stays, in the first one's place.
    fn from_iter<I: IntoIterator<Item = (String, T)>>(entries: I) -> Self {
        let mut out: Vec<(String, T)> = Vec::new();
        for (name, value) in entries {
            match out.iter_mut().find(|(known, _)| *known == name) {
                Some(entry) => entry.1 = value,
                None => out.push((name, value)),
            }
        }
        Named(out)
    }
}

impl From<&[(String, Rational)]> for Named<Exact> {
    fn from(values: &[(String, Rational)]) -> Self {
        values.iter().map(|(name, value)| (name.clone(), Exact::from(value))).collect()
    }
}

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
                let mut out = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    out.push(entry);
                }
                Ok(out.into_iter().collect())
            }
        }

        deserializer.deserialize_map(Entries(PhantomData))
    }
}

#[cfg(feature = "schema")]
impl<T: schemars::JsonSchema> schemars::JsonSchema for Named<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("{}ByName", T::schema_name()).into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "object", "additionalProperties": generator.subschema_for::<T>() })
    }
}

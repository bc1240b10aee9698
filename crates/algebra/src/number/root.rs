//! Roots that are rational.

use super::Rational;

impl Rational {
    /// The square root that is not negative; `None` where it is not rational.
    ///
    /// Cost: two integer square roots.
    ///
    /// ```
    /// use jurist_algebra::number::Rational;
    /// let root = |n: i64, d: i64| Rational::new(n.into(), d.into()).checked_sqrt();
    /// assert_eq!(root(4, 9), Some(Rational::new(2.into(), 3.into())));
    /// assert_eq!((root(2, 9), root(-4, 9)), (None, None));
    /// ```
    pub fn checked_sqrt(&self) -> Option<Rational> {
        if self.is_negative() {
            return None;
        }
        let root = Rational::new(self.numerator().sqrt_floor(), self.denominator().sqrt_floor());
        (&root * &root == *self).then_some(root)
    }
}

//! Monomials in several variables up to a total degree.

/// By total degree, then by the degree in all variables but the first, in all but the first two, and so on. A monomial is known by its place in
/// this order.
#[derive(Clone, Debug)]
pub(super) struct Monomials {
    variables: usize,
    /// Of each monomial the degrees in all variables from each of them on.
    tails: Vec<u8>,
    /// How many monomials in so many last variables are below a degree: by variable, then by degree.
    below: Vec<Vec<usize>>,
    degrees: Vec<u8>,
}

impl Monomials {
    pub fn new(variables: usize, order: usize) -> Self {
        // C(degree + m - 1, m) of m variables, by Pascal's rule.
        let mut below = vec![vec![0; order + 2]; variables];
        for variable in (0..variables).rev() {
            for degree in 1..=order + 1 {
                let others = if variable + 1 < variables { below[variable + 1][degree] } else { 1 };
                below[variable][degree] = below[variable][degree - 1] + others;
            }
        }
        let mut found = Monomials { variables, tails: Vec::new(), below, degrees: Vec::new() };
        for degree in 0..=if variables == 0 { 0 } else { order } {
            let mut tail = vec![0; variables];
            tail.iter_mut().take(1).for_each(|first| *first = degree as u8);
            loop {
                found.tails.extend(&tail);
                found.degrees.push(degree as u8);
                // The last one that may grow; those behind it begin again.
                let Some(k) = (1..variables).rev().find(|&k| tail[k] < tail[k - 1]) else { break };
                tail[k] += 1;
                tail[k + 1..].fill(0);
            }
        }
        found
    }

    pub fn variables(&self) -> usize {
        self.variables
    }

    pub fn len(&self) -> usize {
        self.degrees.len()
    }

    pub fn degree(&self, place: usize) -> usize {
        self.degrees[place].into()
    }

    fn tail(&self, place: usize) -> &[u8] {
        &self.tails[place * self.variables..(place + 1) * self.variables]
    }

    /// Of a variable in a monomial.
    pub fn exponent(&self, place: usize, variable: usize) -> usize {
        let tail = self.tail(place);
        usize::from(tail[variable] - tail.get(variable + 1).copied().unwrap_or(0))
    }

    /// The place of a product, whose degree is at most the order.
    pub fn product(&self, a: usize, b: usize) -> usize {
        let both = self.tail(a).iter().zip(self.tail(b));
        both.zip(&self.below).map(|((a, b), below)| below[usize::from(a + b)]).sum()
    }

    /// The place of a monomial divided by a power of a variable that is in it.
    pub fn lowered(&self, place: usize, variable: usize, power: usize) -> usize {
        let own = self.tail(place).iter().zip(&self.below).enumerate();
        own.map(|(i, (tail, below))| below[usize::from(*tail) - if i <= variable { power } else { 0 }]).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_list() {
        for (variables, order) in [(0, 3), (1, 8), (2, 6), (3, 5), (5, 3), (8, 2)] {
            let all = Monomials::new(variables, order);
            let exponents = |place: usize| (0..variables).map(|v| all.exponent(place, v)).collect::<Vec<_>>();
            let lists: Vec<Vec<usize>> = (0..all.len()).map(exponents).collect();
            let binomial = (1..=order).fold(1, |c, k| c * (variables + k) / k);
            assert_eq!(all.len(), binomial, "all of them");
            for (i, own) in lists.iter().enumerate() {
                assert_eq!(all.degree(i), own.iter().sum::<usize>());
                assert!(i == 0 || all.degree(i - 1) <= all.degree(i));
                assert_eq!(lists.iter().position(|other| other == own), Some(i));
                for (k, other) in lists.iter().enumerate().filter(|(k, _)| all.degree(i) + all.degree(*k) <= order) {
                    let sum: Vec<usize> = own.iter().zip(other).map(|(a, b)| a + b).collect();
                    assert_eq!(lists[all.product(i, k)], sum);
                }
                for v in 0..variables {
                    for power in 0..=own[v] {
                        let mut lower = own.clone();
                        lower[v] -= power;
                        assert_eq!(lists[all.lowered(i, v, power)], lower);
                    }
                }
            }
        }
    }

    #[test]
    fn the_linear_ones_follow_the_constant() {
        let all = Monomials::new(4, 2);
        for v in 0..4 {
            assert_eq!((all.degree(1 + v), all.exponent(1 + v, v)), (1, 1));
        }
    }
}

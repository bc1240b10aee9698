//! Boxes in which every boundary polynomial keeps its sign.

use super::levels::{Seen, by_levels};
use super::patch::{Patch, PatchSign, Rows};
use super::place::Place;
use super::{BoxMap, BoxVerdict, Window};
use crate::plane::curves::{PlanePolynomial, X, Y, boundary_curves};
use crate::subdivision::Halves;
use crate::{AtPoint, Shape};
use jurist_algebra::limits::{Budget, Exhausted};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

/// No more boxes are undecided at a time: some 10 kB each for loops of order 20.
const MOST_UNDECIDED: usize = 1 << 16;

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1).
///
/// A box is decided when every boundary polynomial keeps its sign in it, by the Bernstein coefficients
/// ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998), [Farouki2012](jurist_algebra::bibliography#farouki2012)): then the number of roots outside is the same at
/// all its points, and one exact count tells it. Where a necessary condition fails throughout (`D(1)` or
/// `D(-1)` of the wrong sign, `|d_0| > |d_n|`, a coefficient of the wrong sign) there is no stable point,
/// whatever the boundary polynomials do. A budget that runs out leaves more of the window undecided.
///
/// Near a curve there are about `1/h` boxes of side `h`; halving one costs the product of the degrees times
/// their sum, in words of 128 bits.
///
/// # Errors
/// [`Exhausted`] when the budget runs out before there are boundary polynomials.
pub fn stability_boxes(
    p: &PlanePolynomial,
    window: &Window,
    region: Shape,
    goal: &Rational,
    budget: &Budget,
) -> Result<BoxMap, Exhausted> {
    budget.step("boundary curves");
    let Some(curves) = boundary_curves(p, region, budget)? else {
        return Ok(BoxMap::nowhere_stable(window));
    };
    budget.step("subdividing the window");
    let inside = |f: &MultiPoly| without_edges(f, window);
    let polynomials: Vec<MultiPoly> = curves.iter().map(|c| inside(&c.polynomial)).collect();
    let necessary = necessary_conditions(p, region);
    let family = ByCurves {
        p,
        region,
        window,
        rows: polynomials.iter().chain(&necessary).map(Rows::new).collect(),
        curves: polynomials.len(),
    };
    let whole = family.rows.iter().map(|rows| rows.patch(&window.x, &window.y)).enumerate().collect();
    let look = |place: &Place, open: &mut OpenPatches| Ok(family.look(place, open));
    let whole = vec![(Place::whole(), OpenPatches(whole))];
    Ok(BoxMap { curves, ..by_levels(whole, goal, MOST_UNDECIDED, budget, look).into_map(window) })
}

/// Polynomials of which none is negative where the loop is stable.
fn necessary_conditions(p: &PlanePolynomial, region: Shape) -> Vec<MultiPoly> {
    let d: &Poly<MultiPoly> = p.cleared();
    let n = p.formal_degree();
    let lead = d.coeff(n);
    let mut out = Vec::new();
    match region {
        Shape::UnitDisc => {
            let value = |z: i64| d.eval(&MultiPoly::constant(Integer::from(z))).times(&lead);
            out.push(value(1));
            out.push(if n % 2 == 1 { value(-1).negated() } else { value(-1) });
            let last = d.coeff(0);
            out.push(lead.times(&lead).minus(&last.times(&last)));
        }
        Shape::LeftHalfPlane => out.extend((0..n).map(|k| d.coeff(k).times(&lead))),
    }
    out.retain(|f| !f.is_constant());
    out
}

/// The polynomial without linear factors that vanish on an edge of the window: they keep their sign inside.
/// The sign of the result may differ from that of the polynomial by one that is the same everywhere.
fn without_edges(f: &MultiPoly, window: &Window) -> MultiPoly {
    let mut rest = f.clone();
    for (variable, ends) in [(X, &window.x), (Y, &window.y)] {
        for end in ends {
            let scaled = MultiPoly::variable(variable).times(&MultiPoly::constant(end.denominator()));
            let factor = scaled.minus(&MultiPoly::constant(end.numerator()));
            while !rest.is_constant()
                && let Some(quotient) = rest.div_exact(&factor)
            {
                rest = quotient;
            }
        }
    }
    rest
}

/// The patches of the polynomials whose sign is not known in a box, with their numbers.
struct OpenPatches(Vec<(usize, Patch)>);

impl Halves for OpenPatches {
    fn halves(self, axis: usize) -> [OpenPatches; 2] {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for (k, patch) in &self.0 {
            let [low, high] = patch.halves(axis);
            lower.push((*k, low));
            upper.push((*k, high));
        }
        [OpenPatches(lower), OpenPatches(upper)]
    }
}

/// A loop whose boundary polynomials keep their sign in a box, or a necessary condition fails in it.
struct ByCurves<'a> {
    p: &'a PlanePolynomial,
    region: Shape,
    window: &'a Window,
    /// Of the boundary polynomials, then of the necessary conditions.
    rows: Vec<Rows>,
    /// The number of boundary polynomials.
    curves: usize,
}

impl ByCurves<'_> {
    /// What is seen of a box; the patches whose sign is known leave the list.
    fn look(&self, place: &Place, patches: &mut OpenPatches) -> Seen {
        let mut open = Vec::new();
        for (k, mut patch) in patches.0.drain(..) {
            let mut sign = patch.sign();
            if sign == PatchSign::Blurred {
                let window = place.window(self.window);
                patch = self.rows[k].patch(&window.x, &window.y);
                sign = patch.sign();
            }
            match sign {
                PatchSign::Negative if k >= self.curves => {
                    return Seen::Decided(BoxVerdict::Unstable { outside: None });
                }
                PatchSign::Positive | PatchSign::Negative => {}
                PatchSign::Mixed | PatchSign::Blurred => open.push((k, patch)),
            }
        }
        if open.iter().any(|(k, _)| *k < self.curves) {
            patches.0 = open;
            return Seen::Cut(self.steepest_axis(patches));
        }
        let window = place.window(self.window);
        let (x, y) = (window.x[0].midpoint(&window.x[1]), window.y[0].midpoint(&window.y[1]));
        Seen::Decided(match self.p.at(&x, &y, self.region) {
            AtPoint::Defined { count, infinite: 0 } if count.inside == self.p.formal_degree() => BoxVerdict::Stable,
            AtPoint::Defined { count, infinite } => BoxVerdict::Unstable { outside: Some(count.outside + infinite) },
            AtPoint::Undefined | AtPoint::Zero | AtPoint::Delayed { .. } => BoxVerdict::Unstable { outside: None },
        })
    }

    /// The axis on which the boundary polynomials change most.
    fn steepest_axis(&self, patches: &OpenPatches) -> usize {
        let own = patches.0.iter().filter(|(k, _)| *k < self.curves).map(|(_, patch)| patch.slopes());
        let [x, y] = own.fold([0i128; 2], |sum, slopes| [sum[0] + slopes[0], sum[1] + slopes[1]]);
        usize::from(x < y)
    }
}

//! Halving boxes until nearly all are decided.

use super::patch::{Patch, PatchSign, Rows};
use super::{Areas, Axis, BoxMap, BoxVerdict, PlaneBox, Window};
use crate::plane::curves::{PlanePolynomial, X, Y, boundary_curves};
use crate::{AtPoint, Shape};
use jurist_algebra::limits::{Budget, Exhausted, Stop, parallel_map};
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::poly::{Domain, MultiPoly, Poly};

/// Boxes are halved together in groups of this size; between groups the budget is asked.
const GROUP: usize = 64;

/// No more boxes are undecided at a time: some 10 kB each for loops of order 20.
const MAX_UNDECIDED: usize = 1 << 16;

/// No box is halved more often.
const MAX_HALVINGS: u32 = 80;

/// Cuts a window into boxes until the share of the undecided area is at most `goal` (0 to 1).
///
/// A box is decided when every boundary polynomial keeps its sign in it, by the Bernstein coefficients
/// ([ZettlerGarloff1998](jurist_algebra::bibliography#zettlergarloff1998), [Farouki2012](jurist_algebra::bibliography#farouki2012)): then the number of roots outside is the same at
/// all its points, and one exact count tells it. Where a necessary condition fails throughout (`D(1)` or
/// `D(-1)` of the wrong sign, `|d_0| > |d_n|`, a coefficient of the wrong sign) there is no stable point,
/// whatever the boundary polynomials do. All boxes of one size are halved before the next: the answer
/// does not depend on the number of threads. A budget that runs out leaves more of the window undecided.
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
        let whole = PlaneBox { window: window.clone(), verdict: BoxVerdict::Unstable { outside: None } };
        return Ok(finished(window.clone(), Vec::new(), vec![whole], None));
    };
    budget.step("subdividing the window");
    let inside = |f: &MultiPoly| without_edges(f, window);
    let polynomials: Vec<MultiPoly> = curves.iter().map(|c| inside(&c.polynomial)).collect();
    let necessary = necessary_conditions(p, region);
    let search = Search {
        p,
        region,
        window,
        rows: polynomials.iter().chain(&necessary).map(Rows::new).collect(),
        curves: polynomials.len(),
    };
    let (mut decided, mut frontier, mut stopped) = (Vec::new(), Vec::new(), None);
    search.sort_out(search.whole(), &mut decided, &mut frontier);
    let mut level = 0;
    while stopped.is_none() && !is_enough(frontier.len(), level, goal) {
        if frontier.len() > MAX_UNDECIDED || level >= MAX_HALVINGS {
            stopped = Some(Stop::Boxes { undecided: frontier.len() as u64, halvings: Some(level) });
            break;
        }
        (frontier, stopped) = search.next_level(frontier, &mut decided, budget);
        level += 1;
    }
    let undecided = |n: Node| PlaneBox { window: n.place.window(window), verdict: BoxVerdict::Undecided };
    decided.extend(frontier.into_iter().map(undecided));
    Ok(finished(window.clone(), curves, decided, stopped))
}

/// Whether `boxes` of the size of `2^-level` of the window are at most the share that may stay undecided.
fn is_enough(boxes: usize, level: u32, goal: &Rational) -> bool {
    Rational::dyadic(&Integer::from(boxes as u64), u64::from(level)) <= *goal
}

/// The map of boxes that tile a window.
pub(super) fn finished(
    window: Window,
    curves: Vec<crate::plane::Curve>,
    mut boxes: Vec<PlaneBox>,
    stopped: Option<Stop>,
) -> BoxMap {
    let corner = |b: &PlaneBox| (b.window.x[0].clone(), b.window.y[0].clone());
    boxes.sort_by_cached_key(corner);
    let mut areas = Areas { stable: Rational::ZERO, unstable: Rational::ZERO, undecided: Rational::ZERO };
    for b in &boxes {
        let sum = match b.verdict {
            BoxVerdict::Stable => &mut areas.stable,
            BoxVerdict::Unstable { .. } => &mut areas.unstable,
            BoxVerdict::Undecided => &mut areas.undecided,
        };
        *sum += &b.window.area();
    }
    BoxMap { window, curves, boxes, areas, stopped }
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

/// Where a box is: the `at`-th of `2^halvings` equal parts on either axis.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [u128; 2],
    halvings: [u32; 2],
}

impl Place {
    fn window(&self, whole: &Window) -> Window {
        let side = |axis: usize, [low, high]: &[Rational; 2]| {
            let length = high - low;
            let end = |k: u128| {
                let share = Rational::dyadic(&Integer::from(k), u64::from(self.halvings[axis]));
                low + &(&length * &share)
            };
            [end(self.at[axis]), end(self.at[axis] + 1)]
        };
        Window { x: side(0, &whole.x), y: side(1, &whole.y) }
    }

    fn half(&self, axis: Axis, upper: bool) -> Place {
        let mut out = *self;
        let k = axis as usize;
        out.halvings[k] += 1;
        out.at[k] = 2 * out.at[k] + u128::from(upper);
        out
    }
}

/// An undecided box with the patches of the polynomials whose sign is not known in it.
struct Node {
    place: Place,
    patches: Vec<(usize, Patch)>,
}

/// A box after its test.
enum Tested {
    Decided(Place, BoxVerdict),
    Open(Node),
}

struct Search<'a> {
    p: &'a PlanePolynomial,
    region: Shape,
    window: &'a Window,
    /// Of the boundary polynomials, then of the necessary conditions.
    rows: Vec<Rows>,
    /// The number of boundary polynomials.
    curves: usize,
}

impl Search<'_> {
    fn whole(&self) -> Tested {
        let patches = self.rows.iter().map(|r| r.patch(&self.window.x, &self.window.y)).enumerate().collect();
        self.tested(Place { at: [0; 2], halvings: [0; 2] }, patches)
    }

    fn sort_out(&self, tested: Tested, decided: &mut Vec<PlaneBox>, open: &mut Vec<Node>) {
        match tested {
            Tested::Decided(place, verdict) => decided.push(PlaneBox { window: place.window(self.window), verdict }),
            Tested::Open(node) => open.push(node),
        }
    }

    /// The open boxes after each has been halved, or some of them and the budget that ran out.
    fn next_level(
        &self,
        frontier: Vec<Node>,
        decided: &mut Vec<PlaneBox>,
        budget: &Budget,
    ) -> (Vec<Node>, Option<Stop>) {
        let (mut next, mut stopped) = (Vec::new(), None);
        let mut rest = frontier.into_iter();
        // A box whose turn comes too late stays as it is.
        let halve = |node: Node| match budget.check() {
            Ok(()) => Ok(self.halves(&node)),
            Err(exhausted) => Err((node, exhausted)),
        };
        while stopped.is_none() && rest.len() > 0 {
            let group: Vec<Node> = rest.by_ref().take(GROUP).collect();
            let halves: Vec<Result<[Tested; 2], (Node, Exhausted)>> = parallel_map(group, halve);
            for result in halves {
                match result {
                    Ok(tested) => tested.into_iter().for_each(|t| self.sort_out(t, decided, &mut next)),
                    Err((node, exhausted)) => {
                        next.push(node);
                        stopped = Some(exhausted.stop);
                    }
                }
            }
            budget.advance(decided.len() as u64, (decided.len() + next.len() + rest.len()) as u64);
        }
        next.extend(rest);
        (next, stopped)
    }

    /// Both halves along the axis on which the open polynomials change most.
    fn halves(&self, node: &Node) -> [Tested; 2] {
        let mut slopes = [0i128; 2];
        for (_, patch) in node.patches.iter().filter(|(k, _)| *k < self.curves) {
            let own = patch.slopes();
            slopes = [slopes[0] + own[0], slopes[1] + own[1]];
        }
        let axis = if slopes[0] >= slopes[1] { Axis::X } else { Axis::Y };
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for (k, patch) in &node.patches {
            let [low, high] = patch.halves(axis);
            lower.push((*k, low));
            upper.push((*k, high));
        }
        let half = |is_upper: bool, patches| self.tested(node.place.half(axis, is_upper), patches);
        [half(false, lower), half(true, upper)]
    }

    fn tested(&self, place: Place, patches: Vec<(usize, Patch)>) -> Tested {
        let mut open = Vec::new();
        for (k, mut patch) in patches {
            let mut sign = patch.sign();
            if sign == PatchSign::Blurred {
                let window = place.window(self.window);
                patch = self.rows[k].patch(&window.x, &window.y);
                sign = patch.sign();
            }
            match sign {
                PatchSign::Negative if k >= self.curves => {
                    return Tested::Decided(place, BoxVerdict::Unstable { outside: None });
                }
                PatchSign::Positive | PatchSign::Negative => {}
                PatchSign::Mixed | PatchSign::Blurred => open.push((k, patch)),
            }
        }
        if open.iter().any(|(k, _)| *k < self.curves) {
            return Tested::Open(Node { place, patches: open });
        }
        let window = place.window(self.window);
        let (x, y) = (window.x[0].midpoint(&window.x[1]), window.y[0].midpoint(&window.y[1]));
        let verdict = match self.p.at(&x, &y, self.region) {
            AtPoint::Defined { count, infinite: 0 } if count.inside == self.p.formal_degree() => BoxVerdict::Stable,
            AtPoint::Defined { count, infinite } => BoxVerdict::Unstable { outside: Some(count.outside + infinite) },
            AtPoint::Undefined | AtPoint::Zero | AtPoint::Delayed { .. } => BoxVerdict::Unstable { outside: None },
        };
        Tested::Decided(place, verdict)
    }
}

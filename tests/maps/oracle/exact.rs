//! Exact maps against stable sets on lines: cells, regions, extents, causes; and against the map with the axes exchanged.

use super::lines::{Line, between};
use super::loops::Loop;
use crate::helpers::random::Random;
use jurist::Ask;
use jurist_algebra::limits::Budget;
use jurist_algebra::number::{Integer, Rational};
use jurist_algebra::real::Real;
use jurist_engine::answer::{Answer, Map, MapLimit};
use jurist_engine::error::Error;
use jurist_engine::model::Model;
use jurist_engine::stability::{Cause, End, Range, RealInterval, StableInterval, StableSet};
use std::collections::BTreeSet;

/// How often the space between two lines is halved where it is not seen that they connect.
const DEPTH: usize = 7;

/// What was compared.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    pub maps: usize,
    pub regions: usize,
    pub lines: usize,
    pub points: usize,
    pub ends: usize,
    /// Regions that the lines did not connect.
    pub unconnected: usize,
    /// Maps or lines that ended with an error.
    pub stopped: usize,
}

/// A piece of a line that is stable, and the region that it belongs to.
struct Piece {
    line: usize,
    interval: StableInterval,
    region: usize,
}

/// A map, the one with the axes exchanged, and what the lines so far said.
pub struct Checked<'a> {
    of: &'a Loop,
    plane: Model,
    domain: [Range; 2],
    map: Answer<Map>,
    budget: &'a Budget,
    lines: Vec<Line>,
    pieces: Vec<Piece>,
    /// The piece that each one is known to be connected with, as a forest.
    parent: Vec<usize>,
    seen: Seen,
}

/// Compares all that a map says with stable sets.
pub fn check(of: &Loop, domain: &[Range; 2], random: &mut Random, budget: &Budget) -> Result<Seen, Error> {
    let plane = of.plane();
    let ask = |x: &str, y: &str| {
        let question = plane.ask().domain("x", domain[0].clone()).domain("y", domain[1].clone());
        question.free(x).free(y).map(10, budget)
    };
    let (map, exchanged) = (ask("x", "y")?, ask("y", "x")?);
    for answer in [&map, &exchanged] {
        if let Err(stopped) = &answer.value().limits {
            return Err(stopped.clone().into());
        }
    }
    same_in_either_order(map.value(), exchanged.value());
    let mut checked = Checked {
        of,
        plane,
        domain: domain.clone(),
        map,
        budget,
        lines: Vec::new(),
        pieces: Vec::new(),
        parent: Vec::new(),
        seen: Seen { maps: 1, ..Seen::default() },
    };
    checked.run(random)?;
    Ok(checked.seen)
}

/// What one end of a region's extent is, in words.
fn said(value: &Option<Real>, limit: &Option<MapLimit>) -> String {
    let limit = limit.as_ref().map(|l| (l.limit.causes.to_string(), l.limit.along_line, l.limit.value.decimal(12)));
    format!("{:?} {limit:?}", value.as_ref().map(|v| v.decimal(12)))
}

fn same_in_either_order(one: &Map, other: &Map) {
    assert_eq!(one.decomposition.never_stable, other.decomposition.never_stable);
    let described = |map: &Map, turned: bool| {
        let regions = map.decomposition.regions.iter().zip(map.limits());
        let mut all: Vec<[String; 4]> = regions
            .map(|(region, limits)| {
                let of = |interval: &RealInterval, ends: &[Option<MapLimit>; 2]| {
                    [said(&interval.lower, &ends[0]), said(&interval.upper, &ends[1])]
                };
                let [x, y] = [of(&region.x, &limits.ends[0]), of(&region.y, &limits.ends[1])];
                let [[a, b], [c, d]] = if turned { [y, x] } else { [x, y] };
                [a, b, c, d]
            })
            .collect();
        all.sort();
        all
    };
    assert_eq!(one.decomposition.regions.len(), one.limits().len());
    assert_eq!(described(one, false), described(other, true));
}

impl Checked<'_> {
    fn run(&mut self, random: &mut Random) -> Result<(), Error> {
        let map = &self.map.value().decomposition;
        self.seen.regions = map.regions.len();
        let mut wanted = Vec::new();
        let any = |random: &mut Random| {
            Rational::new((random.below(801) as i64 - 400).into(), (97 + random.below(90) as i64).into())
        };
        wanted.push(Line::Vertical(any(random)));
        wanted.push(Line::Horizontal(any(random)));
        wanted.push(Line::Slanted(any(random), any(random)));
        // Lines through the strips of either decomposition.
        let stable = |strips: &[jurist_engine::stability::plane::Strip]| -> Vec<Rational> {
            strips.iter().filter(|s| s.cells.iter().any(|c| c.stable)).map(|s| s.sample.clone()).collect()
        };
        wanted.extend(stable(&map.strips).into_iter().map(Line::Vertical));
        wanted.extend(stable(&map.exchanged).into_iter().map(Line::Horizontal));
        for line in wanted {
            // Lines at random are asked from the model; with the others the polynomial of the map is known.
            let set = if self.lines.len() < 3 {
                line.stable_set(self.of, &self.plane, &self.domain, self.budget)?
            } else {
                self.slice(&line)?
            };
            self.add(line, &set)?;
        }
        self.extents()?;
        self.connected()?;
        self.causes()
    }

    /// Whether the line has a point in the domain.
    fn is_inside(&self, line: &Line) -> bool {
        match line {
            Line::Vertical(x) => self.domain[0].contains(x),
            Line::Horizontal(y) => self.domain[1].contains(y),
            Line::Slanted(..) => true,
        }
    }

    /// The region of a point; `None` where the map says that it is not stable, or nothing.
    fn region_at(&self, [x, y]: &[Rational; 2]) -> Result<Option<Option<usize>>, Error> {
        let map = &self.map.value().decomposition;
        if map.never_stable {
            return Ok(Some(None));
        }
        if !self.domain[0].contains(x) {
            return Ok(None);
        }
        let Some((strip, cell)) = map.locate(x, y, &self.domain[1], self.budget)? else { return Ok(None) };
        let region = map.regions.iter().position(|r| r.cells.contains(&(strip, cell)));
        assert_eq!(region.is_some(), map.strips[strip].cells[cell].stable);
        Ok(Some(region))
    }

    /// The stable set on a line along an axis.
    fn slice(&self, line: &Line) -> Result<StableSet, Error> {
        let (fixed, value) = match line {
            Line::Vertical(x) => (0, x),
            Line::Horizontal(y) => (1, y),
            Line::Slanted(..) => panic!("a line along an axis"),
        };
        Ok(self.map.slice(fixed, value, self.budget)?.into_value())
    }

    /// Asks for a line along an axis.
    fn ask(&mut self, line: Line) -> Result<Vec<usize>, Error> {
        let set = self.slice(&line)?;
        self.add(line, &set)
    }

    /// The stable set on a line: its pieces are in one region each, what is beside them is in none. The regions of the pieces.
    fn add(&mut self, line: Line, set: &StableSet) -> Result<Vec<usize>, Error> {
        if !self.is_inside(&line) {
            return Ok(Vec::new());
        }
        assert!(set.undecided().is_empty(), "{line:?}");
        self.seen.lines += 1;
        let mut regions = Vec::new();
        let value = |end: &Option<End>| end.as_ref().map(|end| end.value.clone());
        let mut below: Option<Real> = None;
        for interval in set.intervals() {
            let [lower, upper] = [value(&interval.lower), value(&interval.upper)];
            if let Some(lower) = &lower
                && below.as_ref().is_none_or(|below| !below.is_same(lower))
            {
                self.is_not_stable(&line, below.as_ref(), Some(lower))?;
            }
            let found = self.piece(&line, interval, [lower.as_ref(), upper.as_ref()])?;
            regions.extend(found);
            below = upper;
        }
        if below.is_some() || set.intervals().is_empty() {
            self.is_not_stable(&line, below.as_ref(), None)?;
        }
        self.lines.push(line);
        Ok(regions)
    }

    fn is_not_stable(&mut self, line: &Line, lower: Option<&Real>, upper: Option<&Real>) -> Result<(), Error> {
        for t in between(lower, upper) {
            if let Some(found) = self.region_at(&line.point(&t))? {
                assert_eq!(found, None, "not stable: {line:?} at {t}");
                self.seen.points += 1;
            }
        }
        Ok(())
    }

    /// A stable piece of a line: its points are in one region, whose extent holds them.
    fn piece(
        &mut self,
        line: &Line,
        interval: &StableInterval,
        [lower, upper]: [Option<&Real>; 2],
    ) -> Result<Option<usize>, Error> {
        let mut region = None;
        for t in between(lower, upper) {
            let point = line.point(&t);
            let Some(found) = self.region_at(&point)? else { continue };
            let found = found.unwrap_or_else(|| panic!("stable: {line:?} at {t}"));
            assert_eq!(*region.get_or_insert(found), found, "one piece is in one region: {line:?} at {t}");
            let extent = &self.map.value().decomposition.regions[found];
            assert!(extent.x.contains(&point[0]) && extent.y.contains(&point[1]), "the extent holds {point:?}");
            self.seen.points += 1;
        }
        let Some(region) = region else { return Ok(None) };
        let own = self.pieces.len();
        self.parent.push(own);
        for k in 0..own {
            let other = &self.pieces[k];
            let Some([t, u]) = self.lines.get(other.line).and_then(|other| line.meeting(other)) else { continue };
            if interval.contains(&t) && other.interval.contains(&u) {
                assert_eq!(other.region, region, "pieces that meet: {line:?} {:?}", self.lines[other.line]);
                let (a, b) = (self.root(k), self.root(own));
                self.parent[a] = b;
            }
        }
        self.pieces.push(Piece { line: self.lines.len(), interval: interval.clone(), region });
        Ok(Some(region))
    }

    fn root(&self, mut k: usize) -> usize {
        while self.parent[k] != k {
            k = self.parent[k];
        }
        k
    }

    /// A region has points on every line that its extent says, up to its very ends.
    fn extents(&mut self) -> Result<(), Error> {
        for region in 0..self.seen.regions {
            let extents = {
                let region = &self.map.value().decomposition.regions[region];
                [region.x.clone(), region.y.clone()]
            };
            for (axis, extent) in extents.iter().enumerate() {
                for t in ends_of(extent) {
                    let line = if axis == 0 { Line::Vertical(t) } else { Line::Horizontal(t) };
                    let found = self.ask(line.clone())?;
                    assert!(found.contains(&region), "region {region} has a point on {line:?}");
                    self.seen.ends += 1;
                }
            }
        }
        Ok(())
    }

    /// Pieces of lines connect each region, from the sample of a strip to that of the next one.
    fn connected(&mut self) -> Result<(), Error> {
        for region in 0..self.seen.regions {
            let map = &self.map.value().decomposition;
            let strips: BTreeSet<usize> = map.regions[region].cells.iter().map(|cell| cell.0).collect();
            let samples: Vec<Rational> = strips.iter().map(|strip| map.strips[*strip].sample.clone()).collect();
            for pair in samples.windows(2) {
                if self.parts(region, &samples).len() > 1 {
                    self.connect(region, [&pair[0], &pair[1]], DEPTH)?;
                }
            }
            self.seen.unconnected += usize::from(self.parts(region, &samples).len() > 1);
        }
        Ok(())
    }

    /// The parts in which the pieces of a region on some vertical lines are, by a piece of each.
    fn parts(&self, region: usize, at: &[Rational]) -> BTreeSet<usize> {
        let is_there = |line: &Line| matches!(line, Line::Vertical(x) if at.contains(x));
        let on_lines = |piece: &&Piece| piece.region == region && is_there(&self.lines[piece.line]);
        self.pieces.iter().enumerate().filter(|(_, piece)| on_lines(piece)).map(|(k, _)| self.root(k)).collect()
    }

    /// Tries to connect a region between two vertical lines by horizontal ones through its pieces there, halving what is between.
    fn connect(&mut self, region: usize, [left, right]: [&Rational; 2], depth: usize) -> Result<(), Error> {
        let value = |end: &Option<End>| end.as_ref().map(|end| end.value.clone());
        let middle = |piece: &Piece| {
            between(value(&piece.interval.lower).as_ref(), value(&piece.interval.upper).as_ref()).swap_remove(1)
        };
        let is_there = |line: &Line| matches!(line, Line::Vertical(x) if x == left || x == right);
        let there = self.pieces.iter().filter(|p| p.region == region && is_there(&self.lines[p.line]));
        let heights: BTreeSet<Rational> = there.map(middle).collect();
        for y in heights {
            self.ask(Line::Horizontal(y))?;
        }
        let sides = [left, right].map(|x| self.parts(region, std::slice::from_ref(x)));
        if depth == 0 || sides[0] == sides[1] {
            return Ok(());
        }
        let between = left.midpoint(right);
        self.ask(Line::Vertical(between.clone()))?;
        self.connect(region, [left, &between], depth - 1)?;
        self.connect(region, [&between, right], depth - 1)
    }

    /// Where a region ends at a point with rational coordinates, a line through that point ends there, for the same causes. In a corner
    /// the map names the complex pair of a wall also where it becomes a double real root, and the roots of walls where the loop is undefined.
    fn causes(&mut self) -> Result<(), Error> {
        let map = self.map.value();
        for (axis, end, limit) in map.limits().iter().flat_map(|extent| {
            let sides = extent.ends.iter().enumerate();
            sides
                .flat_map(|(axis, ends)| ends.iter().enumerate().filter_map(move |(k, l)| Some((axis, k, l.as_ref()?))))
        }) {
            let (limit, Some(value)) = (&limit.limit, limit.limit.value.exact()) else { continue };
            let [at] = limit.at.as_slice() else { continue };
            let place = &at[1 - axis];
            let Some(place) = jurist_algebra::poly::simplest_between(place.lower(), place.upper()) else { continue };
            let line = if axis == 0 { Line::Horizontal(place) } else { Line::Vertical(place) };
            if !self.is_inside(&line) {
                continue;
            }
            let set = self.slice(&line)?;
            let ends = set.intervals().iter().filter_map(|i| [&i.lower, &i.upper][end].as_ref());
            for found in ends.filter(|e| e.value.exact().as_ref() == Some(&value)) {
                let of_walls = |cause: Cause| cause == Cause::ComplexPair || found.causes.contains(Cause::Pole);
                let is_missing = found.causes.iter().any(|cause| !limit.causes.contains(cause));
                let is_wrong = limit.causes.iter().any(|cause| !found.causes.contains(cause) && !of_walls(cause));
                assert!(!is_missing && !is_wrong, "{line:?} ends at {value}: {} {}", found.causes, limit.causes);
                self.seen.ends += 1;
            }
        }
        Ok(())
    }
}

/// Numbers just inside of both ends of an extent; far away where it has none.
fn ends_of(extent: &RealInterval) -> Vec<Rational> {
    let width = Rational::dyadic(&Integer::ONE, 24);
    let far = Rational::from(1000);
    let place = |end: &Option<Real>| end.as_ref().map(|end| end.refined(&width).enclosure());
    let (low, high) = (place(&extent.lower), place(&extent.upper));
    let room = match (&low, &high) {
        (Some((_, low)), Some((high, _))) => (&(high - low) * &Rational::dyadic(&Integer::ONE, 3)).min(width),
        _ => width,
    };
    let lower = match (&low, &high) {
        (Some((_, low)), _) => low + &room,
        (None, Some((high, _))) => high - &far,
        (None, None) => -&far,
    };
    let upper = match (&high, &low) {
        (Some((high, _)), _) => high - &room,
        (None, Some((_, low))) => low + &far,
        (None, None) => far,
    };
    vec![lower, upper]
}

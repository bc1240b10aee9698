'use strict';
(() => {
  // One map, or slices of which one is shown; a slice without a map is null.
  const whole = JSON.parse(document.getElementById('data').textContent);
  const slices = whole.slices || [whole];
  let data = slices[0], now = 0;
  const $ = id => document.getElementById(id);
  const abs = a => a < 0n ? -a : a;
  const gcd = (a, b) => { a = abs(a); b = abs(b); while (b) [a, b] = [b, a % b]; return a; };

  // Exact rationals [numerator, denominator], denominator positive.
  function rational(text) {
    const m = /^\s*([+-]?)(\d+)(?:\.(\d*))?(?:e([+-]?\d{1,4}))?(?:\/(\d+))?\s*$/i.exec(text)
      || /^\s*([+-]?)()\.(\d+)(?:e([+-]?\d{1,4}))?()\s*$/i.exec(text);
    if (!m) return null;
    let n = BigInt((m[2] || '0') + (m[3] || '')), d = m[5] ? BigInt(m[5]) : 1n;
    const e = Number(m[4] || 0) - (m[3] || '').length;
    if (e >= 0) n *= 10n ** BigInt(e); else d *= 10n ** BigInt(-e);
    if (d === 0n) return null;
    if (m[1] === '-') n = -n;
    const g = gcd(n, d) || 1n;
    return [n / g, d / g];
  }
  const number = q => {
    const shift = BigInt(Math.max(0, q[1].toString(2).length - q[0].toString(2).length + 64));
    return Number((q[0] << shift) / q[1]) / 2 ** Number(shift);
  };
  const compare = (a, b) => { const d = a[0] * b[1] - b[0] * a[1]; return d > 0n ? 1 : d < 0n ? -1 : 0; };
  const sign = a => a > 0n ? 1 : a < 0n ? -1 : 0;
  // The sign of sum c_k q^k, c from the constant term up.
  function signAt(c, q) {
    let s = 0n, p = 1n;
    for (let k = c.length - 1; k >= 0; k--) { s = s * q[0] + c[k] * p; p *= q[1]; }
    return sign(s);
  }
  const end = e => e && { lo: rational(e.enclosure[0]), hi: rational(e.enclosure[1]), poly: e.polynomial && e.polynomial.map(BigInt) };
  let strips = [], curves = [];
  function load(k) {
    [now, data] = [k, slices[k]];
    strips = data ? data.strips.map(s => ({ lower: end(s.lower), upper: end(s.upper), cells: s.cells, wall: s.wall })) : [];
    curves = data ? data.curves.map(c => c.terms.map(t => [t[0], t[1], BigInt(t[2])])) : [];
    cache = { key: '', chains: [] };
  }
  const domain = whole.axes.map(a => ({ lower: a.lower && rational(a.lower), upper: a.upper && rational(a.upper) }));

  // An algebraic number against a rational: its enclosure, and inside that the sign of its polynomial.
  function compareEnd(e, q) {
    if (compare(e.lo, e.hi) === 0) return compare(e.lo, q);
    if (compare(q, e.lo) <= 0) return 1;
    if (compare(q, e.hi) >= 0) return -1;
    // A number without a polynomial is known as narrowly as the page needs.
    if (!e.poly) return 0;
    const s = signAt(e.poly, q);
    return s === 0 ? 0 : s === signAt(e.poly, e.hi) ? -1 : 1;
  }
  // A curve over a rational x as a polynomial in y with integer coefficients.
  function over(terms, x) {
    let dx = 0, dy = 0;
    for (const t of terms) { dx = Math.max(dx, t[0]); dy = Math.max(dy, t[1]); }
    const n = [1n], d = [1n];
    for (let k = 1; k <= dx; k++) { n.push(n[k - 1] * x[0]); d.push(d[k - 1] * x[1]); }
    const c = Array(dy + 1).fill(0n);
    for (const t of terms) c[t[1]] += t[2] * n[t[0]] * d[dx - t[0]];
    return primitive(c);
  }
  function primitive(c) {
    while (c.length && c[c.length - 1] === 0n) c.pop();
    const g = c.reduce((g, a) => gcd(g, a), 0n);
    return g > 1n ? c.map(a => a / g) : c;
  }
  // Sturm's sequence by pseudo-remainders with their signs kept.
  function sturm(f) {
    const chain = [f];
    let next = primitive(f.slice(1).map((a, k) => a * BigInt(k + 1)));
    while (next.length) {
      chain.push(next);
      let r = chain[chain.length - 2].slice();
      const g = next, lead = g[g.length - 1];
      while (r.length >= g.length) {
        const top = r[r.length - 1], shift = r.length - g.length;
        const m = abs(lead), q = lead < 0n ? -top : top;
        r = r.map(a => a * m);
        for (let k = 0; k < g.length; k++) r[k + shift] -= q * g[k];
        while (r.length && r[r.length - 1] === 0n) r.pop();
      }
      next = primitive(r.map(a => -a));
    }
    return chain;
  }
  const variations = signs => {
    let last = 0, count = 0;
    for (const s of signs) if (s) { if (last && s !== last) count++; last = s; }
    return count;
  };
  const atMinusInfinity = c => sign(c[c.length - 1]) * (c.length % 2 ? 1 : -1);
  let cache = { key: '', chains: [] };
  // The cell that holds an exact point, as far as there is one.
  function locate(x, y) {
    const inside = (q, d) => (!d.lower || compare(d.lower, q) < 0) && (!d.upper || compare(q, d.upper) < 0);
    if (!inside(x, domain[0]) || !inside(y, domain[1])) return { kind: 'domain' };
    if (!data) return { kind: 'open' };
    if (data.never) return { kind: 'never' };
    let strip = -1, wall = false;
    for (let k = 0; k < strips.length && strip < 0; k++) {
      const upper = strips[k].upper ? compareEnd(strips[k].upper, x) : 1;
      if (upper >= 0) { strip = k; wall = upper === 0; }
    }
    if (strip < 0) return { kind: 'domain' };
    if (wall) return onWall(strip, x, y);
    const key = x.join('/');
    if (cache.key !== key) cache = { key, chains: curves.map(c => { const f = over(c, x); return f.length > 1 ? sturm(f) : null; }) };
    let below = 0;
    for (let k = 0; k < curves.length; k++) {
      const chain = cache.chains[k];
      if (!chain) continue;
      if (signAt(chain[0], y) === 0) return { kind: 'curve', curve: k };
      const low = domain[1].lower;
      const from = variations(chain.map(c => low ? signAt(c, low) : atMinusInfinity(c)));
      below += from - variations(chain.map(c => signAt(c, y)));
    }
    const cell = strips[strip].cells[below];
    return { kind: 'cell', strip, cell: below, stable: cell[0] === 1, outside: cell[1] };
  }

  // On a wall between strips curves may meet: the distinct roots of all of them are counted together.
  function onWall(strip, x, y) {
    let product = [1n];
    for (let k = 0; k < curves.length; k++) {
      const f = over(curves[k], x);
      if (!f.length || signAt(f, y) === 0) return { kind: 'curve', curve: k };
      const p = Array(product.length + f.length - 1).fill(0n);
      product.forEach((a, i) => f.forEach((b, j) => { p[i + j] += a * b; }));
      product = p;
    }
    const cells = strips[strip].wall;
    if (!cells) return { kind: 'wall' };
    let below = 0;
    if (product.length > 1) {
      const chain = sturm(product), low = domain[1].lower;
      below = variations(chain.map(c => low ? signAt(c, low) : atMinusInfinity(c))) - variations(chain.map(c => signAt(c, y)));
    }
    return { kind: 'cell', wall: strip, cell: below, stable: cells[below][0] === 1, outside: cells[below][1] };
  }

  // Places in the picture, in floating point.
  const place = (k, value) => {
    const w = whole.axes[k];
    return w.log ? (value > 0 ? Math.log(value / w.from) / Math.log(w.to / w.from) : -Infinity) : (value - w.from) / (w.to - w.from);
  };
  const value = (k, at) => {
    const w = whole.axes[k];
    return w.log ? w.from * (w.to / w.from) ** at : w.from + (w.to - w.from) * at;
  };
  // A short decimal near a place: what is shown is what is looked up.
  function decimal(k, at) {
    const v = value(k, at), step = Math.abs(value(k, at + 1e-3) - v);
    if (v === 0 || !step) return '0';
    const digits = Math.min(15, Math.max(1, Math.ceil(Math.log10(Math.abs(v) / step)) + 1));
    if (Math.abs(v) < step / 2) return '0';
    return String(Number(v.toPrecision(digits)));
  }
  const boxes = [...document.querySelectorAll('.slice')];
  const figures = boxes.map((slice, n) => [...slice.querySelectorAll('.figure')].map((box, k) => {
    const svg = box.querySelector('svg'), plot = slices[n].plots[k];
    const make = (tag, attributes) => {
      const e = document.createElementNS('http://www.w3.org/2000/svg', tag);
      for (const a in attributes) e.setAttribute(a, attributes[a]);
      return e;
    };
    const group = make('g', { class: 'pointer', 'pointer-events': 'none', visibility: 'hidden' });
    const parts = { h: make('line', {}), v: make('line', {}), link: make('line', { class: 'link' }), dot: make('circle', { r: 5 }) };
    for (const p in parts) group.appendChild(parts[p]);
    svg.appendChild(group);
    svg.setAttribute('tabindex', '0');
    svg.setAttribute('role', 'img');
    svg.setAttribute('aria-label', slices[n].label);
    return { box, svg, plot, group, parts };
  }));
  const pixel = (f, p) => [f.plot[0] + p[0] * f.plot[2], f.plot[1] + (1 - p[1]) * f.plot[3]];

  // Where the verdict changes as one parameter goes up or down from a point and the other stays: which values these
  // are is decided by exact counts of roots; the value is rounded for the eye only.
  const half = (a, b) => { const n = a[0] * b[1] + b[0] * a[1], d = 2n * a[1] * b[1], g = gcd(n, d) || 1n; return [n / g, d / g]; };
  const distance = (a, b) => Math.abs(number(a) - number(b));
  function change(k, point, direction, here) {
    const at = point[k], with_ = value => k === 0 ? locate(value, point[1]) : locate(point[0], value);
    const polys = curves.map(c => over(k === 1 ? c : c.map(t => [t[1], t[0], t[2]]), point[1 - k]));
    const chains = polys.map(f => f.length > 1 ? sturm(f) : null);
    const count = (a, b) => chains.map(c => c ? variations(c.map(p => signAt(p, a))) - variations(c.map(p => signAt(p, b))) : 0);
    const between = (a, b) => (direction > 0 ? count(a, b) : count(b, a)).reduce((n, m) => n + m, 0);
    const edge = direction > 0 ? domain[k].upper : domain[k].lower;
    let far = edge;
    if (!far) {
      // Beyond all roots (Cauchy's bound).
      let bound = 1n;
      for (const f of polys.filter(f => f.length)) for (const c of f) { const q = abs(c) / abs(f[f.length - 1]) + 2n; if (q > bound) bound = q; }
      far = [BigInt(direction) * bound, 1n];
      if ((compare(far, at) > 0 ? 1 : -1) !== direction) return null;
    }
    let from = at;
    for (let tries = 0; tries < 40; tries++) {
      if (!between(from, far)) {
        return edge ? { value: edge, curve: -1 } : null;
      }
      let lo = from, hi = far;
      while (distance(lo, hi) > 2e-6 * Math.abs(number(hi)) && distance(lo, hi) > 1e-30) {
        const middle = half(lo, hi);
        if (between(lo, middle)) hi = middle; else lo = middle;
      }
      const roots = direction > 0 ? count(lo, hi) : count(hi, lo);
      // A little further on, to the nearest point that lies on no curve.
      let next = hi, found = with_(next);
      for (let n = 0; n < 8 && found.kind !== 'cell' && found.kind !== 'domain'; n++) {
        const width = [hi[0] * lo[1] - lo[0] * hi[1], hi[1] * lo[1]];
        next = [next[0] * width[1] + width[0] * next[1], next[1] * width[1]];
        found = with_(next);
      }
      // Digits of a bracket around an end at 0 mean nothing.
      const atZero = lo[0] > 0n !== hi[0] > 0n && polys.some(f => f.length > 1 && f[0] === 0n);
      if (found.kind !== 'cell' || found.stable !== here.stable) return { value: atZero ? [0n, 1n] : hi, curve: roots.findIndex(n => n !== 0) };
      from = next;
    }
    return null;
  }
  // The four ways along the axes, the smallest relative change first; for a value of 0 that is its share of the window.
  function changes(point, here) {
    const out = [];
    for (const k of [0, 1]) for (const direction of [-1, 1]) {
      const found = change(k, point, direction, here);
      if (!found) continue;
      const from = number(point[k]), to = number(found.value);
      const ratio = from > 0 && to > 0 || from < 0 && to < 0 ? to / from : null;
      const relative = ratio !== null ? Math.abs(Math.log(ratio)) : from !== 0 ? Math.abs(to - from) / Math.abs(from) + 1 : Math.abs(to) / (whole.axes[k].to - whole.axes[k].from);
      out.push({ k, direction, to, ratio, relative, curve: found.curve, at: [0, 1].map(j => place(j, j === k ? to : number(point[j]))) });
    }
    return out.sort((a, b) => a.relative - b.relative);
  }
  // The frequency where a drawn wall of that curve passes a place.
  function frequencyAt(curve, at) {
    let best = null;
    data.walls.filter(w => w.curve === curve && w.frequencies.length).forEach(w => {
      for (let i = 0; i + 3 < w.points.length; i += 2) {
        const dx = w.points[i + 2] - w.points[i], dy = w.points[i + 3] - w.points[i + 1], l = dx * dx + dy * dy;
        const t = l ? Math.max(0, Math.min(1, ((at[0] - w.points[i]) * dx + (at[1] - w.points[i + 1]) * dy) / l)) : 0;
        const d = Math.hypot(at[0] - w.points[i] - t * dx, at[1] - w.points[i + 1] - t * dy);
        if (!best || d < best.d) best = { d, w, index: i / 2 + t };
      }
    });
    return best && best.d < 0.01 ? ', about ' + frequency(best.w.frequencies, best.index) : '';
  }
  // Between two known frequencies, geometrically.
  function frequency(known, index) {
    let k = known.findIndex(f => f[0] >= index);
    if (k < 0) k = known.length - 1;
    const b = known[k], a = known[Math.max(0, k - 1)];
    const t = b[0] > a[0] ? Math.max(0, Math.min(1, (index - a[0]) / (b[0] - a[0]))) : 0;
    const f = a[1] > 0 && b[1] > 0 ? a[1] * (b[1] / a[1]) ** t : a[1] + t * (b[1] - a[1]);
    return data.unit === 'Hz' && f >= 1e4 ? `${Number((f / 1000).toPrecision(3))} kHz` : `${Number(f.toPrecision(3))} ${data.unit}`;
  }
  const point = { text: ['', ''], at: [0.5, 0.5] };
  let later = 0;
  function show() {
    const exact = point.text.map(rational);
    ['x', 'y'].forEach((id, k) => $(id).setAttribute('aria-invalid', exact[k] ? 'false' : 'true'));
    if (!exact[0] || !exact[1]) {
      $('verdict').className = '';
      $('verdict').textContent = 'enter numbers such as 110, 1e-4 or 1/3';
      $('roots').textContent = $('near').textContent = '';
      return;
    }
    point.at = exact.map((q, k) => place(k, number(q)));
    const found = locate(exact[0], exact[1]);
    let verdict = '', roots = '', kind = '';
    if (found.kind === 'cell') {
      kind = found.stable ? 'stable' : 'unstable';
      verdict = found.stable ? data.goal : data.goal === 'stable' ? 'unstable' : 'not ' + data.goal;
      const all = data.degree === 1 ? 'the root' : `all ${data.degree} roots`;
      roots = found.stable ? `${all} inside` : found.outside === data.degree ? `${all} outside` : `${found.outside} of ${data.degree} roots outside`;
      roots += found.wall === undefined ? ` (strip ${found.strip}, cell ${found.cell})` : ` (wall after strip ${found.wall}, cell ${found.cell})`;
    } else {
      kind = 'other';
      verdict = { domain: 'outside the domain', open: 'this slice is not decided', never: 'nowhere ' + data?.goal, wall: 'on a wall between strips', curve: 'on a boundary: not ' + data?.goal }[found.kind];
      roots = found.kind === 'curve' ? data.curves[found.curve].words : found.kind === 'wall' ? `${whole.axes[0].name} is a critical value: move it a little` : '';
    }
    $('verdict').textContent = verdict;
    $('verdict').className = kind;
    $('roots').textContent = roots;
    const inside = point.at.every(a => a >= 0 && a <= 1);
    $('near').textContent = inside ? '' : 'the point is outside the picture';
    clearTimeout(later);
    later = setTimeout(() => {
      if (found.kind !== 'cell') return;
      const all = changes(exact, found), name = k => whole.axes[k].name, digits = v => String(Number(v.toPrecision(4)));
      const words = c => {
        const factor = c.ratio === null ? '' : ` (\u00d7 ${digits(c.ratio)})`;
        const why = c.curve < 0 ? 'end of the domain' : data.curves[c.curve].words + frequencyAt(c.curve, c.at);
        return `${name(c.k)} = ${digits(c.to)}${factor}: ${why}`;
      };
      const bounds = [0, 1].map(k => {
        const end = d => all.find(c => c.k === k && c.direction === d);
        const [lo, hi] = [end(-1), end(1)];
        return `${lo ? digits(lo.to) + ' < ' : ''}${name(k)}${hi ? ' < ' + digits(hi.to) : ''}${lo || hi ? '' : ' has any value'}`;
      });
      const outside = inside ? '' : ' The point is outside the picture.';
      $('near').textContent = (all.length ? `The verdict changes first, relatively, at ${words(all[0])}. ` : 'The verdict does not change. ')
        + `One parameter alone: ${bounds.join('; ')}.` + outside;
      for (const g of figures[now]) {
        const n = pixel(g, all.length ? all[0].at.map(a => Math.max(0, Math.min(1, a))) : point.at);
        g.parts.link.setAttribute('x2', n[0].toFixed(1));
        g.parts.link.setAttribute('y2', n[1].toFixed(1));
      }
    }, 120);
    for (const g of figures[now]) {
      g.group.setAttribute('visibility', inside ? 'visible' : 'hidden');
      if (!inside) continue;
      const [x, y] = pixel(g, point.at), [l, t, w, h] = g.plot;
      const set = (e, a) => { for (const k in a) e.setAttribute(k, a[k].toFixed(1)); };
      set(g.parts.h, { x1: l, y1: y, x2: l + w, y2: y });
      set(g.parts.v, { x1: x, y1: t, x2: x, y2: t + h });
      set(g.parts.dot, { cx: x, cy: y });
      set(g.parts.link, { x1: x, y1: y, x2: x, y2: y });
      g.parts.dot.setAttribute('class', kind);
    }
  }
  let waiting = false;
  function update(text) {
    point.text = text;
    ['x', 'y'].forEach((id, k) => { if (document.activeElement !== $(id)) $(id).value = text[k]; });
    if (!waiting) { waiting = true; requestAnimationFrame(() => { waiting = false; show(); }); }
  }
  const clamp = a => Math.max(0, Math.min(1, a));
  const go = at => update([decimal(0, clamp(at[0])), decimal(1, clamp(at[1]))]);
  for (const f of figures.flat()) {
    const track = event => {
      const box = f.svg.getBoundingClientRect(), view = f.svg.viewBox.baseVal;
      const x = (event.clientX - box.left) * view.width / box.width, y = (event.clientY - box.top) * view.height / box.height;
      const at = [(x - f.plot[0]) / f.plot[2], 1 - (y - f.plot[1]) / f.plot[3]];
      if (at.some(a => a < -0.03 || a > 1.03)) return;
      go(at);
    };
    f.svg.addEventListener('pointermove', event => { if (event.pointerType === 'mouse' || event.buttons) track(event); });
    f.svg.addEventListener('pointerdown', event => { f.svg.focus({ preventScroll: true }); track(event); });
    f.svg.addEventListener('keydown', event => {
      const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
      const move = moves[event.key];
      if (!move) return;
      event.preventDefault();
      const step = event.shiftKey ? 0.05 : 0.005;
      go(point.at.map((a, k) => clamp(a) + step * move[k]));
    });
  }
  ['x', 'y'].forEach((id, k) => $(id).addEventListener('input', () => {
    const text = point.text.slice();
    text[k] = $(id).value;
    update(text);
  }));
  addEventListener('resize', show);
  const fragment = new URLSearchParams(location.hash.slice(1));
  load(0);
  const slider = $('slice');
  if (slider) {
    const choose = k => {
      load(k);
      slider.value = k;
      slider.setAttribute('aria-valuetext', whole.shown[k]);
      $('at').textContent = whole.shown[k];
      boxes.forEach((box, n) => { box.hidden = n !== k; });
      document.querySelectorAll('#slices tr').forEach((row, n) => { row.setAttribute('aria-current', n === k + 1); });
    };
    const wanted = rational(fragment.get(whole.name) || '');
    const named = wanted ? whole.values.findIndex(v => compare(rational(v), wanted) === 0) : -1;
    choose(named < 0 ? whole.first : named);
    slider.addEventListener('input', () => { choose(Number(slider.value)); show(); });
  }
  const asked = whole.axes.map(a => fragment.get(a.name));
  const start = whole.axes.map((a, k) => asked[k] || a.nominal || decimal(k, 0.5));
  const fits = start.every((text, k) => { const q = rational(text); const at = q ? place(k, number(q)) : -1; return at >= 0 && at <= 1; });
  update(fits || asked.some(a => a) ? start : [decimal(0, 0.5), decimal(1, 0.5)]);
  show();
})();

"use strict";
// Life for the figures of the report. A figure is complete without it: every value shown here is read back from the SVG,
// whose <g class="axes"> carries the scales (see svg_draw.hpp for what it relies on).
(() => {
  const NS = document.querySelector("svg.figure")?.namespaceURI;
  if (!NS) return;
  const readout = document.body.appendChild(document.createElement("div"));
  readout.id = "readout";

  // ---------------------------------------------------------------- numbers

  const superscript = (n) => (n < 0 ? "⁻" : "") + [...String(Math.abs(n))].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[+c]).join("");
  const power = (e) => "10" + superscript(e);
  const minus = (s) => s.replace(/^-/, "−");
  function show(v, digits = 5) {
    if (!isFinite(v)) return String(v);
    if (v === 0) return "0";
    const e = Math.floor(Math.log10(Math.abs(v)));
    if (e >= -4 && e < 6) return minus(String(+v.toPrecision(digits)));
    const [m, x] = v.toExponential(digits - 1).split("e");
    return minus(String(+m)) + "×" + power(+x);
  }
  const esc = (s) => s.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
  const n2 = (v) => String(Math.round(v * 100) / 100);

  // The same ticks as ticks.cpp.
  function exponentFor(largest) {
    if (!(largest > 0)) return 0;
    const e = Math.floor(Math.log10(largest) + 1e-12);
    return e >= 5 || e <= -3 ? 3 * Math.floor(e / 3) : 0;
  }
  function labelled(major, minor, step) {
    const exponent = exponentFor(Math.max(0, ...major.map(Math.abs))), unit = 10 ** exponent;
    let decimals = 0;
    for (let s = step / unit; decimals < 12 && Math.abs(s - Math.round(s)) > 1e-6 * Math.max(1, Math.abs(s)); s *= 10) ++decimals;
    const labels = major.map((v) => minus((Math.abs(v) < 1e-9 * step ? 0 : v / unit).toFixed(decimals)));
    return { major, minor, labels, exponent };
  }
  const fewest = 2;   // one number does not tell how long an axis is
  function linearTicks(lo, hi, target, steps) {
    let t = linearTicksAbout(lo, hi, target, steps);
    for (let more = 1.5; t.major.length < fewest && more < 8; more *= 1.5) t = linearTicksAbout(lo, hi, more * target, steps);
    return t;
  }
  function linearTicksAbout(lo, hi, target, steps = [[1, 5], [2, 4], [2.5, 5], [5, 5]]) {
    const span = hi - lo, raw = span / Math.max(target, 1), p = 10 ** Math.floor(Math.log10(raw));
    let step = 10 * p, parts = 5;
    for (const [f, m] of steps) if (f * p >= raw * 0.999) { step = f * p; parts = m; break; }
    const major = [], minor = [], eps = 1e-9 * span, small = step / parts;
    for (let k = Math.ceil((lo - eps) / step); k * step <= hi + eps; ++k) major.push(k * step);
    for (let k = Math.ceil((lo - eps) / small); k * small <= hi + eps; ++k) if (k % parts !== 0) minor.push(k * small);
    return labelled(major, minor, step);
  }
  function logTicks(lo, hi, target) {
    const decades = Math.log10(hi / lo);
    if (decades < 0.8) return linearTicks(lo, hi, target);
    const first = Math.floor(Math.log10(lo) + 1e-9), last = Math.ceil(Math.log10(hi) - 1e-9);
    const between = decades < 2.2;
    let skip = Math.max(1, Math.ceil(decades / Math.max(target, 2)));
    const powers = () => {
      let n = 0;
      for (let e = first; e <= last; ++e) if (e % skip === 0 && 10 ** e >= lo * (1 - 1e-9) && 10 ** e <= hi * (1 + 1e-9)) ++n;
      return n;
    };
    while (skip > 1 && powers() < fewest) --skip;
    const t = { major: [], minor: [], labels: [], exponent: 0 };
    for (let e = first; e <= last; ++e)
      for (let m = 1; m < 10; ++m) {
        const v = m * 10 ** e;
        if (v < lo * (1 - 1e-9) || v > hi * (1 + 1e-9)) continue;
        if ((m === 1 && e % skip === 0) || (between && (m === 2 || m === 5))) {
          t.major.push(v);
          t.labels.push(last - first <= 4 && v >= 0.0099 && v < 1.001e5 ? String(+v.toFixed(3)) : m === 1 ? power(e) : m + "·" + power(e));
        } else if (skip === 1 || m === 1) t.minor.push(v);
      }
    return t;
  }
  function title(label, unit, exponent) {
    const u = exponent ? power(exponent) + (unit ? " " + unit : "") : unit || "-";
    return label ? `${label} [${u}]` : `[${u}]`;
  }

  // ---------------------------------------------------------------- reading figures

  const numbers = (s) => s.trim().split(/\s+/).map(Number);
  function scaleOf(g, name) {
    const d = g.dataset[name];
    if (!d) return null;
    const [lo, hi, log] = numbers(d);
    const f = log ? Math.log(hi / lo) : hi - lo;
    return {
      lo, hi, log: log === 1, label: g.dataset[name + "l"], unit: g.dataset[name + "u"],
      at: (t) => (log ? lo * Math.exp(t * f) : lo + t * f),       // fraction of the axis -> value
      of: (v) => (log ? Math.log(v / lo) / f : (v - lo) / f),
    };
  }
  // Points of a path as [x, y, x, y ...], nan between its pieces. Long curves give differences behind an "l".
  const pathNumbers = (s) => (s.match(/-?(?:\d+\.?\d*|\.\d+)/g) || []).map(Number);
  function pointsOf(path) {
    const out = [];
    for (const piece of path.getAttribute("d").replace(/h0|Z/g, "").split("M")) {
      if (!piece) continue;
      if (out.length) out.push(NaN, NaN);
      const [from, steps] = piece.split("l");
      out.push(...pathNumbers(from));
      let [x, y] = out.slice(-2);
      const d = steps ? pathNumbers(steps) : [];
      for (let i = 0; i < d.length; i += 2) out.push((x += d[i]), (y += d[i + 1]));
    }
    return Float32Array.from(out);
  }
  // lists in an attribute: a line each, cells apart by tabs
  const lines = (s) => (s ? s.split("\n") : null);
  const extras = (s) => (s ? lines(s).map((line) => { const [l, u, ...v] = line.split("\t"); return { l, u, v }; }) : null);
  // What the pointer can find: curves and clouds of one <g class="axes">.
  function traces(g) {
    const out = [];
    for (const p of g.querySelectorAll("path[data-s]:not([data-quiet])")) {
      if (p.closest(".legend")) continue;
      out.push({ el: p, s: p.dataset.s, name: p.dataset.name || "", line: true, right: "right" in p.dataset, xy: null,
        base: p.dataset.base ? numbers(p.dataset.base) : null, unit: p.dataset.unit, extra: extras(p.dataset.extra), names: lines(p.dataset.names) });
    }
    for (const p of g.querySelectorAll("g[data-pins]:not([data-quiet]):not([data-legend])")) {
      out.push({ el: p, s: p.dataset.s, name: p.dataset.name || "", line: false, right: "right" in p.dataset, xy: null,
        base: null, extra: extras(p.dataset.extra), names: lines(p.dataset.names) });
    }
    return out;
  }
  function load(t) {
    if (!t.xy) t.xy = t.line ? pointsOf(t.el) : Float32Array.from([...t.el.querySelectorAll("use")].flatMap((u) => [+u.getAttribute("x"), +u.getAttribute("y")]));
    return t.xy;
  }
  // Nearest place of all traces to (x, y) in the figure's own px; sx, sy: present magnification.
  function nearest(list, x, y, sx, sy) {
    let best = null, d2 = 26 * 26;
    for (const t of list) {
      if (t.el.classList.contains("off")) continue;
      const p = load(t);
      let count = 0;   // number of drawn points before i, to find further values
      for (let i = 0; i < p.length; i += 2) {
        if (isNaN(p[i])) continue;
        const dx = (p[i] - x) * sx, dy = (p[i + 1] - y) * sy, r = dx * dx + dy * dy;
        // A point is preferred to the segment beside it: it holds a computed value.
        if (r * 0.6 < d2) { d2 = r * 0.6; best = { t, x: p[i], y: p[i + 1], k: count, exact: true }; }
        if (t.line && i + 3 < p.length && !isNaN(p[i + 2])) {
          const ux = (p[i + 2] - p[i]) * sx, uy = (p[i + 3] - p[i + 1]) * sy, l = ux * ux + uy * uy;
          const f = l > 0 ? Math.max(0, Math.min(1, -(dx * ux + dy * uy) / l)) : 0;
          const ex = dx + f * ux, ey = dy + f * uy, e = ex * ex + ey * ey;
          if (e < d2) { d2 = e; best = { t, x: p[i] + f * (p[i + 2] - p[i]), y: p[i + 1] + f * (p[i + 3] - p[i + 1]), k: count + (f > 0.5 ? 1 : 0), exact: false }; }
        }
        ++count;
      }
    }
    return best;
  }
  function extraLines(hit) {
    let s = "";
    if (hit.t.names?.[hit.k]) s += `<br>${esc(hit.t.names[hit.k])}`;
    for (const e of hit.t.extra || []) if (e.v[hit.k] !== undefined) s += `<br><span>${esc(e.l)}</span> ${e.v[hit.k]} ${esc(e.u)}`;
    return s;
  }
  const box = (name, rows) => ((name ? `<b>${esc(name)}</b>` : "") + rows.replace(/^<br>/, ""));
  const row = (axis, v) => `<br><span>${esc(axis.label)}</span> ${show(v)} ${esc(axis.unit)}`;

  // Indices into the colours of a map, cell by cell, as the browser has drawn its PNG.
  function cellsOf(image, nx, ny) {
    const bin = atob(image.getAttribute("href").split(",")[1]), from = bin.indexOf("PLTE") + 4, index = new Map();
    for (let k = 255; k >= 0; --k) index.set([0, 1, 2].map((c) => bin.charCodeAt(from + 3 * k + c)).join(), k);
    const canvas = Object.assign(document.createElement("canvas"), { width: nx, height: ny });
    const g = canvas.getContext("2d");
    g.imageSmoothingEnabled = false;
    g.drawImage(image, 0, 0, nx, ny);
    const rgba = g.getImageData(0, 0, nx, ny).data;
    if (!rgba[3]) return null;  // not drawn yet
    return Uint8Array.from({ length: nx * ny }, (_, k) => index.get(rgba.slice(4 * k, 4 * k + 3).join()) ?? 0);
  }

  // ---------------------------------------------------------------- axes in a plane

  class PlaneAxes {
    constructor(g) {
      this.g = g;
      [this.bx, this.by, this.bw, this.bh] = numbers(g.dataset.box);
      this.x = scaleOf(g, "x"), this.y = scaleOf(g, "y"), this.r = scaleOf(g, "r");
      this.equal = "equal" in g.dataset, this.share = "share" in g.dataset, this.hideX = "hidex" in g.dataset, this.fixed = "fixed" in g.dataset;
      this.list = traces(g);
      this.reset();
    }
    reset() { this.sx = this.sy = 1; this.tx = this.ty = 0; }
    contains(p, margin = 0) { return p.x >= this.bx - margin && p.x <= this.bx + this.bw + margin && p.y >= this.by - margin && p.y <= this.by + this.bh + margin; }
    // "xy" inside the frame, "x" below it, "y" beside it.
    zone(p) {
      if (this.contains(p)) return "xy";
      if (p.x >= this.bx && p.x <= this.bx + this.bw && p.y > this.by + this.bh && p.y < this.by + this.bh + 44) return "x";
      if (p.y >= this.by && p.y <= this.by + this.bh && ((p.x < this.bx && p.x > this.bx - 60) || (p.x > this.bx + this.bw && p.x < this.bx + this.bw + 60))) return "y";
      return null;
    }
    zoom(p, f, zone) {
      const k = Math.max(1, Math.min(5000, zone === "y" ? this.sy * f : this.sx * f));
      const fx = zone === "y" && !this.equal ? 1 : (this.equal || zone !== "y" ? k / this.sx : 1);
      const ky = Math.max(1, Math.min(5000, this.sy * f)), fy = this.equal ? k / this.sx : zone === "x" ? 1 : ky / this.sy;
      this.sx *= fx, this.tx = p.x - fx * (p.x - this.tx);
      this.sy *= fy, this.ty = p.y - fy * (p.y - this.ty);
      this.clamp();
    }
    pan(dx, dy) { this.tx += dx, this.ty += dy; this.clamp(); }
    // The data stay within the frame.
    clamp() {
      const c = (t, s, b, l) => Math.min(b - s * b, Math.max(b + l - s * (b + l), t));
      this.tx = c(this.tx, this.sx, this.bx, this.bw), this.ty = c(this.ty, this.sy, this.by, this.bh);
    }
    window(a, b) {   // two corners in px
      const x0 = Math.min(a.x, b.x), x1 = Math.max(a.x, b.x), y0 = Math.min(a.y, b.y), y1 = Math.max(a.y, b.y);
      if (x1 - x0 < 6 || y1 - y0 < 6) return;
      let fx = this.bw / (x1 - x0), fy = this.bh / (y1 - y0);
      if (this.equal) fx = fy = Math.min(fx, fy);
      this.tx = this.bx - fx * (x0 - this.tx), this.sx *= fx;
      this.ty = this.by - fy * (y0 - this.ty), this.sy *= fy;
      this.clamp();
    }
    apply() {
      const { sx, sy, tx, ty } = this;
      for (const p of this.g.querySelectorAll(".plot")) p.setAttribute("transform", `matrix(${sx} 0 0 ${sy} ${tx} ${ty})`);
      for (const u of this.g.querySelectorAll(".pins use")) {
        u.b ??= [+u.getAttribute("x"), +u.getAttribute("y")];
        u.setAttribute("x", n2(sx * u.b[0] + tx)), u.setAttribute("y", n2(sy * u.b[1] + ty));
      }
      for (const q of this.g.querySelectorAll(".pin")) {
        q.b ??= numbers(q.dataset.p);
        const lock = q.dataset.lock;
        const dx = lock === "x" ? 0 : sx * q.b[0] + tx - q.b[0], dy = lock === "y" ? 0 : sy * q.b[1] + ty - q.b[1];
        q.setAttribute("transform", `translate(${n2(dx)} ${n2(dy)})`);
      }
      if (!this.fixed) this.ticks();
    }
    // Value at a px position of the figure, present view.
    valueX(px) { return this.x.at(((px - this.tx) / this.sx - this.bx) / this.bw); }
    valueY(py, a = this.y) { return a.at((this.by + this.bh - (py - this.ty) / this.sy) / this.bh); }
    ticks() {
      const pick = (a, lo, hi, length, gap) => {
        const target = Math.max(length >= 140 ? 3 : 2, Math.min(10, length / (this.equal ? 68 : gap)));
        if (a.log) return logTicks(lo, hi, target);
        if (a.unit === "°" && hi - lo > 40) { const s = hi - lo <= 120 ? 15 : hi - lo <= 200 ? 30 : hi - lo <= 400 ? 90 : 180; return linearTicks(lo, hi, (hi - lo) / s, [[s / 10 ** Math.floor(Math.log10(s)), 5]]); }
        return linearTicks(lo, hi, target);
      };
      const { bx, by, bw, bh } = this, R = bx + bw, B = by + bh;
      const line = (x0, y0, x1, y1, c, w) => `<line x1="${n2(x0)}" y1="${n2(y0)}" x2="${n2(x1)}" y2="${n2(y1)}" class="${c}" stroke-width="${w}"/>`;
      const text = (x, y, s, anchor) => `<text x="${n2(x)}" y="${n2(y)}" font-size="11.5" text-anchor="${anchor}" class="fi">${s}</text>`;
      const put = (cls, s) => { const e = this.g.querySelector("." + cls); if (e) e.innerHTML = s; };
      const rename = (which, a, t) => { const e = this.g.querySelector(`[data-label="${which}"]`); if (e) e.textContent = title(a.label, a.unit, t.exponent); };
      const x0 = this.valueX(bx), x1 = this.valueX(R), tx = pick(this.x, x0, x1, bw, 90);
      const px = (v) => this.sx * (bx + bw * this.x.of(v)) + this.tx;
      let s = "", g = "";
      tx.major.forEach((v, k) => {
        g += line(px(v), by, px(v), B, "cg", 0.8);
        s += line(px(v), B, px(v), B + 4, "ci", 0.9) + (this.hideX ? "" : text(px(v), B + 16.5, tx.labels[k], "middle"));
      });
      tx.minor.forEach((v) => (s += line(px(v), B, px(v), B + 2.5, "ci", 0.9)));
      put("gx", g), put("tx", s), rename("x", this.x, tx);
      const ty = pick(this.y, this.valueY(B), this.valueY(by), bh, 48);
      const py = (v, a) => this.sy * (B - bh * a.of(v)) + this.ty;
      s = g = "";
      ty.major.forEach((v, k) => {
        const y = py(v, this.y);
        g += line(bx, y, R, y, "cg", 0.8), s += line(bx - 4, y, bx, y, "ci", 0.9) + text(bx - 7, y + 4, ty.labels[k], "end");
      });
      ty.minor.forEach((v) => (s += line(bx - 2.5, py(v, this.y), bx, py(v, this.y), "ci", 0.9)));
      put("gy", g), put("ty", s), rename("y", this.y, ty);
      if (!this.r) return;
      const tr = pick(this.r, this.valueY(B, this.r), this.valueY(by, this.r), bh, 48);
      s = "";
      tr.major.forEach((v, k) => (s += line(R, py(v, this.r), R + 4, py(v, this.r), "ci", 0.9) + text(R + 7, py(v, this.r) + 4, tr.labels[k], "start")));
      put("tr", s), rename("r", this.r, tr);
    }
    probe(p) {
      if (!this.contains(p, 4)) return null;
      const x = (p.x - this.tx) / this.sx, y = (p.y - this.ty) / this.sy;
      const hit = nearest(this.list, x, y, this.sx, this.sy);
      if (hit) {
        const sx = this.sx * hit.x + this.tx, sy = this.sy * hit.y + this.ty;
        if (!this.contains({ x: sx, y: sy }, 3)) return null;
        const a = hit.t.right ? this.r : this.y, v = this.valueY(sy, a);
        const value = hit.t.base ? row({ label: "amplitude", unit: hit.t.unit }, +((v - hit.t.base[0]) * hit.t.base[1]).toPrecision(3)) : row(a, v);
        return { x: sx, y: sy, html: box(hit.t.name, row(this.x, this.valueX(sx)) + value + extraLines(hit)) };
      }
      const image = this.g.querySelector("image[data-heat]");
      if (!image || !this.contains(p)) return null;
      const [nx, ny, lo, hi, log] = numbers(image.dataset.heat);
      const at = (name) => +image.getAttribute(name);
      const ix = Math.floor(((x - at("x")) / at("width")) * nx), iy = Math.floor(((y - at("y")) / at("height")) * ny);
      if (ix < 0 || iy < 0 || ix >= nx || iy >= ny) return null;
      this.cells ??= cellsOf(image, nx, ny);
      if (!this.cells) return null;
      const f = this.cells[iy * nx + ix] / 255;
      const v = log ? lo * (hi / lo) ** f : lo + f * (hi - lo);
      return { x: p.x, y: p.y, html: box(`${image.dataset.hl} ${show(v, 3)} ${image.dataset.hu}`, row(this.x, this.valueX(p.x)) + row(this.y, this.valueY(p.y))) };
    }
  }

  class PolarAxes {
    constructor(g) {
      this.g = g;
      [this.bx, this.by, this.bw, this.bh] = numbers(g.dataset.box);
      this.x = scaleOf(g, "x"), this.y = scaleOf(g, "y");
      this.zero = +g.dataset.zero, this.cw = g.dataset.cw === "1";
      this.list = traces(g);
    }
    zone() { return null; }
    reset() {}
    apply() {}
    probe(p) {
      const hit = nearest(this.list, p.x, p.y, 1, 1);
      if (!hit) return null;
      const cx = this.bx + this.bw / 2, cy = this.by + this.bh / 2, R = this.bw / 2;
      const dx = hit.x - cx, dy = cy - hit.y, angle = (Math.atan2(dy, dx) * 180) / Math.PI - this.zero;
      const deg = (((this.cw ? -angle : angle) % 360) + 360) % 360;
      return { x: hit.x, y: hit.y, html: box(hit.t.name, row(this.y, (Math.hypot(dx, dy) / R) * this.y.hi) + row({ label: "phase lag", unit: "°" }, +deg.toFixed(1)) + extraLines(hit)) };
    }
  }

  // ---------------------------------------------------------------- axes in space (the projection of svg_space.cpp)

  const spaced = (s, each) => s.trim().split(/\s+/).flatMap((t) => (t === "|" ? Array(each).fill(NaN) : [+t]));

  class SpaceAxes {
    constructor(g) {
      this.g = g;
      [this.bx, this.by, this.bw, this.bh] = numbers(g.dataset.box);
      this.axis = ["x", "y", "z"].map((n) => scaleOf(g, n));
      this.half = numbers(g.dataset.half);
      this.cell = numbers(g.dataset.cell);
      this.home = numbers(g.dataset.view);
      this.items = [...g.querySelectorAll("[data-xyz]")].map((el) => ({
        el, s: el.dataset.s, name: el.dataset.name || "", quiet: "quiet" in el.dataset, pins: "pins" in el.dataset,
        closed: el.tagName === "path" && el.getAttribute("d").endsWith("Z"),
        xyz: spaced(el.dataset.xyz, 3),
        motion: el.dataset.motion ? spaced(el.dataset.motion, 6) : null,
        played: el.dataset.played ? numbers(el.dataset.played) : null,
      }));
      for (const it of this.items) it.home = it.xyz;
      this.reset();
    }
    reset() { this.view = [...this.home]; this.magnify = 1; }
    zone(p) { return p.x >= this.bx - 50 && p.x <= this.bx + this.bw + 50 && p.y >= this.by - 10 && p.y <= this.by + this.bh + 40 ? "space" : null; }
    contains(p) { return this.zone(p) !== null; }
    project() {
      const [a, e] = this.view.map((d) => (d * Math.PI) / 180), ca = Math.cos(a), sa = Math.sin(a), ce = Math.cos(e), se = Math.sin(e);
      const view = (p) => { const f = p[0] * ca + p[1] * sa; return [p[1] * ca - p[0] * sa, p[2] * ce - f * se]; };
      const lo = [Infinity, Infinity], hi = [-Infinity, -Infinity];
      for (let i = 0; i < 8; ++i) {
        const q = view(this.half.map((h, d) => (i & (1 << d) ? h : -h)));
        for (const d of [0, 1]) lo[d] = Math.min(lo[d], q[d]), hi[d] = Math.max(hi[d], q[d]);
      }
      const unit = this.magnify * Math.min(this.bw / (hi[0] - lo[0]), this.bh / (hi[1] - lo[1]));
      const cx = this.bx + this.bw / 2 - (unit * (lo[0] + hi[0])) / 2, cy = this.by + this.bh / 2 + (unit * (lo[1] + hi[1])) / 2;
      return { unit, view, towards: [ca * ce, sa * ce, se], px: (p) => { const q = view(p); return [cx + unit * q[0], cy - unit * q[1]]; } };
    }
    apply() {
      const P = this.project(), H = this.half;
      this.last = P;
      const seg = (p, q, c, w) => { const m = P.px(p), n = P.px(q); return `<line x1="${n2(m[0])}" y1="${n2(m[1])}" x2="${n2(n[0])}" y2="${n2(n[1])}" class="${c}" stroke-width="${w}"/>`; };
      const at = (d, v) => (2 * this.axis[d].of(v) - 1) * H[d];
      const back = P.towards.map((t, d) => (t > 0 ? -H[d] : H[d]));
      const ticks = this.axis.map((a, d) => linearTicks(a.lo, a.hi, Math.max(3, Math.min(6, (P.unit * 2 * H[d]) / 70))));
      let s = "";
      const taken = [];   // by labels and titles
      for (let d = 0; d < 3; ++d)
        for (const [i, j] of [[(d + 1) % 3, (d + 2) % 3], [(d + 2) % 3, (d + 1) % 3]]) {
          const p = [0, 0, 0], q = [0, 0, 0];
          p[d] = q[d] = back[d], p[j] = -H[j], q[j] = H[j];
          for (const v of ticks[i].major) p[i] = q[i] = at(i, v), s += seg(p, q, "cg", 0.8);
          for (const v of [-H[i], H[i]]) p[i] = q[i] = v, s += seg(p, q, "cg", 1.2);
        }
      for (let d = 0; d < 3; ++d) {
        const p = [0, 0, 0];
        if (d < 2) p[1 - d] = -back[1 - d], p[2] = -H[2];
        else {
          let left = Infinity;
          for (const u of [-H[0], H[0]]) for (const v of [-H[1], H[1]]) { const x = P.view([u, v, 0])[0]; if (x < left) left = x, p[0] = u, p[1] = v; }
        }
        const q = [...p];
        p[d] = -H[d], q[d] = H[d];
        s += seg(p, q, "ci", 0.9);
        const m = P.px(p), n = P.px(q), mid = [(m[0] + n[0]) / 2, (m[1] + n[1]) / 2];
        let ox = mid[0] - (this.bx + this.bw / 2), oy = mid[1] - (this.by + this.bh / 2);
        const ex = n[0] - m[0], ey = n[1] - m[1], el = Math.max(1e-9, Math.hypot(ex, ey)), along = (ox * ex + oy * ey) / el;
        ox -= (along * ex) / el, oy -= (along * ey) / el;
        const ol = Math.max(1e-9, Math.hypot(ox, oy));
        ox /= ol, oy /= ol;
        if (el < 12) continue;
        const anchor = ox > 0.35 ? "start" : ox < -0.35 ? "end" : "middle";
        let widest = 0;
        ticks[d].major.forEach((v, k) => {
          const w = [...p];
          w[d] = at(d, v);
          const t = P.px(w);
          s += `<line x1="${n2(t[0])}" y1="${n2(t[1])}" x2="${n2(t[0] + 4 * ox)}" y2="${n2(t[1] + 4 * oy)}" class="ci" stroke-width="0.9"/>`;
          const w6 = 6.4 * ticks[d].labels[k].length, lx = t[0] + 9 * ox, ly = t[1] + 11 * oy + 4;
          const label = { x: lx - w6 * (anchor === "start" ? 0 : anchor === "end" ? 1 : 0.5), y: ly - 10, w: w6, h: 12 };
          if (taken.some((o) => label.x < o.x + o.w && o.x < label.x + label.w && label.y < o.y + o.h && o.y < label.y + label.h)) return;
          taken.push(label);
          s += `<text x="${n2(t[0] + 9 * ox)}" y="${n2(t[1] + 11 * oy + 4)}" font-size="11" text-anchor="${anchor}" class="fi">${ticks[d].labels[k]}</text>`;
          widest = Math.max(widest, 6.4 * ticks[d].labels[k].length);
        });
        const reach = 16 + Math.abs(ox) * widest + 12 * Math.abs(oy), name = esc(title(this.axis[d].label, this.axis[d].unit, ticks[d].exponent));
        const [x, y] = [mid[0] + reach * ox, mid[1] + reach * oy + 6], [left, right, top, bottom] = this.cell;
        if (d === 2) {   // what does not fit between the ends of the cell is set smaller
          const room = 2 * Math.min(mid[1] - top, bottom - mid[1]), size = 12.5 * Math.max(0.5, Math.min(1, room / (7.2 * name.length)));
          s += `<text x="${n2(x - 6)}" y="${n2(mid[1])}" font-size="${n2(size)}" text-anchor="middle" class="fi" transform="rotate(-90 ${n2(x - 6)} ${n2(mid[1])})">${name}</text>`;
          continue;
        }
        // two lines where there is a comma, below the labels that are there
        const lines = name.split(/(?<=,) /).map((text) => {
          const w = 7 * text.length, l = x - w * (anchor === "start" ? 0 : anchor === "end" ? 1 : 0.5);
          return { text, w, x: Math.max(left + 2, Math.min(right - 2 - w, l)) };
        });
        const free = (y0) => lines.every((l, k) => !taken.some((t) => l.x < t.x + t.w && t.x < l.x + l.w && y0 + 15 * k - 10 < t.y + t.h && t.y < y0 + 15 * k + 3));
        let y1 = y;
        for (let k = 0; k < 6 && !free(y1); ++k) y1 += 4;
        lines.forEach((l, k) => {
          taken.push({ x: l.x, y: y1 + 15 * k - 10, w: l.w, h: 13 });
          s += `<text x="${n2(l.x + l.w / 2)}" y="${n2(y1 + 15 * k)}" font-size="12.5" text-anchor="middle" class="fi">${l.text}</text>`;
        });
      }
      this.g.querySelector(".box").innerHTML = s;
      this.draw();
    }
    // The curves alone, in the present view.
    draw() {
      const P = this.last ?? (this.last = this.project());
      for (const it of this.items) {
        const uses = it.pins ? it.el.querySelectorAll("use") : null;
        let path = "", pen = 0, u = 0;
        for (let i = 0; i < it.xyz.length; i += 3) {
          if (isNaN(it.xyz[i])) { pen = 0; continue; }
          const [x, y] = P.px([it.xyz[i], it.xyz[i + 1], it.xyz[i + 2]]);
          if (uses) { const e = uses[u++]; if (e) e.setAttribute("x", n2(x)), e.setAttribute("y", n2(y)); }
          else path += (pen === 0 ? "M" : pen === 1 ? "L" : " ") + n2(x) + " " + n2(y);
          ++pen;
        }
        if (!uses) it.el.setAttribute("d", path + (it.closed ? "Z" : ""));
      }
    }
    get moves() { return this.items.some((it) => it.motion); }
    // A shape at a phase of its motion: rest + Re(motion exp(i phase)); phase 0 is what was printed.
    setPhase(phase) {
      const c = Math.cos(phase) - 1, s = Math.sin(phase);
      for (const it of this.items)
        if (it.motion) it.xyz = it.home.map((x, i) => { const k = 2 * i; return x + it.motion[k] * c - it.motion[k + 1] * s; });
      this.draw();
    }
    turn(dx, dy) {
      this.view[0] -= 0.4 * dx;
      this.view[1] = Math.max(-89, Math.min(89, this.view[1] + 0.4 * dy));
    }
    zoom(p, f) { this.magnify = Math.max(0.3, Math.min(30, this.magnify * f)); }
    probe(p) {
      const P = this.last ?? (this.last = this.project());
      let best = null, d2 = 18 * 18;
      for (const it of this.items) {
        if (it.quiet || it.el.classList.contains("off")) continue;
        for (let i = 0; i < it.xyz.length; i += 3) {
          if (isNaN(it.xyz[i])) continue;
          const q = [it.xyz[i], it.xyz[i + 1], it.xyz[i + 2]], [x, y] = P.px(q), r = (x - p.x) ** 2 + (y - p.y) ** 2;
          if (r < d2) d2 = r, best = { x, y, q, it };
        }
      }
      if (!best) return null;
      const values = this.axis.map((a, d) => row(a, a.at((best.q[d] / this.half[d] + 1) / 2))).join("");
      return { x: best.x, y: best.y, html: box(best.it.name, values) };
    }
  }

  // The curves of a narrow drawing are those of the wide one, repeated: alive it has its own.
  function ownCurves(svg) {
    for (const use of svg.querySelectorAll("use.again")) {
      const [sx, , , sy, tx, ty] = numbers(use.getAttribute("transform").slice(7, -1));
      const X = (v) => n2(sx * v + tx), Y = (v) => n2(sy * v + ty), group = use.parentElement;
      group.innerHTML = document.getElementById(use.getAttribute("href").slice(1)).innerHTML;
      for (const p of group.querySelectorAll("path")) {
        if (p.closest("defs")) continue;
        const d = p.getAttribute("d");
        if (/[HV]/.test(d)) {   // a rule
          p.setAttribute("d", d.replace(/([MHV])([^MHV]*)/g, (all, c, rest) => c + pathNumbers(rest).map((v, i) => (c === "V" || i ? Y(v) : X(v))).join(" ")));
          continue;
        }
        let to = "", pen = 0;
        const q = pointsOf(p);
        for (let i = 0; i < q.length; i += 2) {
          if (isNaN(q[i])) { pen = 0; continue; }
          to += (pen === 0 ? "M" : pen === 1 ? "L" : " ") + X(q[i]) + " " + Y(q[i + 1]);
          if (++pen === 1 && !(i + 3 < q.length && !isNaN(q[i + 2]))) to += "h0";   // a lone point
        }
        p.setAttribute("d", to + (d.endsWith("Z") ? "Z" : ""));
      }
      for (const r of group.querySelectorAll("rect, image, use")) {
        if (r.closest("defs")) continue;
        const g = (k) => +r.getAttribute(k);
        const now = { x: X(g("x")), y: Y(g("y")), width: n2(sx * g("width")), height: n2(sy * g("height")) };
        for (const k in now) if (r.hasAttribute(k)) r.setAttribute(k, now[k]);
      }
    }
  }

  // Takes the zoom out of the transform and into the coordinates: not every program scales strokes apart.
  function flatten(plot) {
    const [sx, , , sy, tx, ty] = plot.getAttribute("transform").match(/-?[\d.]+(?:e-?\d+)?/g).map(Number);
    plot.removeAttribute("transform");
    const X = (v) => n2(sx * v + tx), Y = (v) => n2(sy * v + ty);
    for (const p of plot.querySelectorAll("path"))
      p.setAttribute("d", p.getAttribute("d").replace(/([MLHVlhZ])([^MLHVlhZ]*)/g, (all, c, rest) => {
        if (c === "Z" || c === "h") return all;
        const v = pathNumbers(rest);
        if (c === "l") return c + v.map((u, i) => n2(u * (i % 2 ? sy : sx))).join(" ");
        return c + (c === "H" ? v.map(X) : c === "V" ? v.map(Y) : v.map((u, i) => (i % 2 ? Y(u) : X(u)))).join(" ");
      }));
    for (const r of plot.querySelectorAll("rect, image")) {
      const g = (k) => +r.getAttribute(k);
      const now = { x: X(g("x")), y: Y(g("y")), width: n2(sx * g("width")), height: n2(sy * g("height")) };
      for (const k in now) r.setAttribute(k, now[k]);
    }
  }

  // ---------------------------------------------------------------- what moves

  // Calls draw(seconds since the last call) until told to stop; a button of the figure starts and stops it.
  class Player {
    constructor(bar, title, draw, drawing) {
      this.draw = draw, this.running = false;
      this.button = document.createElement("button");
      this.button.className = drawing;
      this.button.title = title;
      this.button.dataset.do = "play";
      this.button.addEventListener("click", () => this.toggle());
      bar.append(this.button);
      this.show();
    }
    show() { this.button.textContent = this.running ? "pause" : "play"; }
    toggle(on = !this.running) {
      if (on === this.running) return;
      this.running = on;
      this.show();
      if (!on) return;
      let last = null;
      const tick = (now) => {
        if (!this.running) return;
        if (last !== null) this.draw(Math.min(0.1, (now - last) / 1000));
        last = now;
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    }
  }

  // A mode or an operating shape: two seconds a cycle.
  function animate(axes, bar, drawing) {
    let phase = 0;
    const player = new Player(bar, "the shape in motion", (dt) => { phase = (phase + Math.PI * dt) % (2 * Math.PI); for (const a of axes) a.setPhase(phase); }, drawing);
    return { stop() { player.toggle(false), (phase = 0); for (const a of axes) a.setPhase(0); } };
  }

  // A transient, from the moments the run kept: the slider sets the time, and the lines go through a turn at each moment.
  class Replay {
    constructor(axes, data, svg, bar, drawing) {
      Object.assign(this, data);
      this.axes = axes;
      const bin = atob(this.bytes);
      this.values = Int8Array.from(bin, (c) => c.charCodeAt(0));
      this.moment = this.shown, this.sample = 0;
      // box units: of the places at rest, and of a metre of motion
      const unit = (d) => (2 * axes.half[d]) / (axes.axis[d].hi - axes.axis[d].lo);
      this.unit = [0, 1, 2].map(unit);
      this.home = [0, 1, 2].map((d) => axes.axis[d].lo);
      const row = document.createElement("div");
      row.className = "replay-bar " + drawing;
      row.innerHTML = `<input type="range" min="0" max="${this.t.length - 1}" value="${this.moment}" aria-label="time"><output></output>`;
      svg.after(row);
      [this.slider, this.output] = row.children;
      this.slider.addEventListener("input", () => { this.moment = +this.slider.value; this.draw(); });
      let held = 0;
      this.player = new Player(bar, "the run again", (dt) => {
        held += dt / 0.3;   // seconds a moment
        if (held >= 1) held = 0, this.moment = (this.moment + 1) % this.t.length, this.slider.value = this.moment;
        this.sample = Math.min(this.samples - 1, Math.floor(held * this.samples));
        this.draw();
      }, drawing);
      this.draw();
    }
    // Of a point at a sample of the present moment, in box units.
    place(sample, point, out) {
      const i = 2 * ((this.moment * this.samples + sample) * this.points + point), g = this.gain * this.scale[this.moment];
      for (let d = 0; d < 3; ++d) {
        const v = this.rest[3 * point + d] + (d ? g * this.values[i + d - 1] : 0);
        out.push((v - this.home[d]) * this.unit[d] - this.axes.half[d]);
      }
    }
    largest() {
      const each = 2 * this.samples * this.points, from = this.moment * each;
      let most = 0;
      for (let i = from; i < from + each; i += 2) most = Math.max(most, Math.hypot(this.values[i], this.values[i + 1]));
      return most * this.scale[this.moment];
    }
    draw() {
      for (const it of this.axes.items) {
        if (!it.played) continue;
        const [from, to, trails] = it.played, xyz = [];
        for (let p = from; p < to; ++p)
          if (trails) {
            for (let k = 0; k < this.samples; ++k) this.place(k, p, xyz);
            xyz.push(NaN, NaN, NaN);
          } else this.place(this.sample, p, xyz);
        it.xyz = xyz;
      }
      this.axes.draw();
      const m = this.largest(), [f, u] = m < 1e-3 ? [1e6, "µm"] : m < 1 ? [1e3, "mm"] : [1, "m"];
      this.output.textContent = `${show(this.t[this.moment], 4)} s, ${show(this.rpm[this.moment], 4)} rpm, largest ${show(f * m, 3)} ${u}`;
    }
    stop() { this.player.toggle(false), (this.sample = 0), this.draw(); }
  }

  // ---------------------------------------------------------------- a figure

  const onPaper = { 0: "#0072b2", 1: "#d55e00", 2: "#009e73", 3: "#aa4499", 4: "#e69f00", 5: "#56b4e9", 6: "#882255", 7: "#666666", i: "#222222", g: "#d9d9d9" };

  class Figure {
    constructor(svg) {
      this.svg = svg;
      ownCurves(svg);
      const make = { xy: PlaneAxes, polar: PolarAxes, space: SpaceAxes };
      this.axes = [...svg.querySelectorAll("g.axes")].map((g) => new make[g.dataset.kind](g));
      const column = new Map();
      this.axes.forEach((a, k) => {
        if (!(a instanceof PlaneAxes)) return;
        const key = Math.round(a.bx);
        a.chain = a.share && column.has(key) ? column.get(key) : k;
        column.set(key, a.chain);
      });
      this.spot = document.createElementNS(NS, "circle");
      this.spot.setAttribute("class", "spot"), this.spot.setAttribute("r", 4.2), (this.spot.style.display = "none");
      svg.append(this.spot);
      svg.addEventListener("pointermove", (e) => this.move(e));
      svg.addEventListener("pointerleave", () => { this.hide(); svg.classList.remove("active"); });
      svg.addEventListener("pointerdown", (e) => this.down(e));
      svg.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
      svg.addEventListener("dblclick", () => this.reset());
      for (const a of this.axes) for (const entry of a.g.querySelectorAll(".legend .entry")) entry.addEventListener("click", (e) => this.toggle(a, entry, e.shiftKey));
      const bar = svg.closest("figure")?.querySelector(".bar");
      bar?.querySelector("[data-do=reset]")?.addEventListener("click", () => this.reset());
      bar?.querySelector("[data-do=save]")?.addEventListener("click", () => this.shown && this.save());
      const moving = this.axes.filter((a) => a instanceof SpaceAxes && a.moves);
      const drawing = svg.classList.contains("narrow") ? "narrow" : "wide";
      if (drawing === "narrow") for (const a of this.axes) if (a instanceof SpaceAxes) a.apply();   // the other may stand turned
      if (bar && moving.length) this.motion = animate(moving, bar, drawing);
      const replay = svg.parentElement?.querySelector("script.replay");
      if (bar && replay) this.motion = new Replay(this.axes[0], JSON.parse(replay.textContent), svg, bar, drawing);
    }
    get shown() { return this.svg.getClientRects().length > 0; }
    at(e) {
      const m = this.svg.getScreenCTM().inverse();
      return { x: m.a * e.clientX + m.e, y: m.d * e.clientY + m.f };
    }
    // Axes that share their x: a chain down a column.
    linked(a) { return this.axes.filter((b) => b === a || (b.chain !== undefined && b.chain === a.chain)); }
    update(a) {
      for (const b of this.linked(a)) {
        if (b !== a) b.sx = a.sx, b.tx = a.tx;
        b.apply();
      }
    }
    reset() {
      this.motion?.stop();
      for (const a of this.axes) a.reset(), a.apply();
      this.hide();
    }
    hide() { readout.style.display = this.spot.style.display = "none"; }
    move(e) {
      if (this.drag) return this.pull(e);
      const p = this.at(e);
      let hit = null;
      for (const a of this.axes) if ((hit = a.probe(p))) break;
      if (!hit) return this.hide();
      this.spot.setAttribute("cx", hit.x), this.spot.setAttribute("cy", hit.y), (this.spot.style.display = "");
      readout.innerHTML = hit.html;
      readout.style.display = "block";
      const w = readout.offsetWidth, h = readout.offsetHeight;
      readout.style.left = Math.min(e.clientX + 16, innerWidth - w - 8) + "px";
      readout.style.top = (e.clientY + 18 + h > innerHeight ? e.clientY - h - 12 : e.clientY + 18) + "px";
    }
    down(e) {
      if (e.button !== 0 || e.target.closest(".legend")) return;
      this.svg.classList.add("active");
      const p = this.at(e), a = this.axes.find((b) => b.zone(p));
      if (!a || a.fixed || e.pointerType === "touch") return;
      this.drag = { a, zone: a.zone(p), from: p, last: p, box: e.shiftKey && a instanceof PlaneAxes };
      this.svg.setPointerCapture(e.pointerId);
      this.svg.classList.add("dragging");
      const up = () => {
        this.svg.removeEventListener("pointerup", up), this.svg.removeEventListener("pointercancel", up);
        if (this.drag.rubber) this.drag.rubber.remove(), a.window(this.drag.from, this.drag.last), this.update(a);
        this.drag = null;
        this.svg.classList.remove("dragging");
      };
      this.svg.addEventListener("pointerup", up), this.svg.addEventListener("pointercancel", up);
    }
    pull(e) {
      const d = this.drag, p = this.at(e), dx = p.x - d.last.x, dy = p.y - d.last.y;
      d.last = p;
      this.hide();
      if (d.box) {
        d.rubber ??= this.svg.appendChild(Object.assign(document.createElementNS(NS, "rect")));
        d.rubber.setAttribute("class", "rubber");
        for (const [k, v] of [["x", Math.min(p.x, d.from.x)], ["y", Math.min(p.y, d.from.y)], ["width", Math.abs(p.x - d.from.x)], ["height", Math.abs(p.y - d.from.y)]]) d.rubber.setAttribute(k, n2(v));
        return;
      }
      if (d.a instanceof SpaceAxes) d.a.turn(dx, dy);
      else d.a.pan(d.zone === "y" ? 0 : dx, d.zone === "x" ? 0 : dy);
      this.update(d.a);
    }
    // The wheel scrolls the page until the figure was clicked (or Ctrl is held).
    wheel(e) {
      if (!this.svg.classList.contains("active") && !e.ctrlKey) return;
      const p = this.at(e), a = this.axes.find((b) => b.zone(p));
      if (!a || a.fixed) return;
      e.preventDefault();
      a.zoom(p, Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0016)), a.zone(p));
      this.update(a);
      this.hide();
    }
    toggle(a, entry, only) {
      const entries = [...a.g.querySelectorAll(".legend .entry")];
      const set = (en, off) => {
        en.classList.toggle("off", off);
        // Axes without a legend of their own follow (Bode: the phase follows the amplitude).
        for (const b of this.axes)
          if (b === a || !b.g.querySelector(".legend"))
            for (const el of b.g.querySelectorAll(`[data-s="${en.dataset.s}"]:not(.entry):not([data-legend])`)) el.classList.toggle("off", off);
      };
      if (only) {
        const alone = entries.every((en) => en === entry || en.classList.contains("off"));
        for (const en of entries) set(en, alone ? false : en !== entry);
      } else set(entry, !entry.classList.contains("off"));
      this.hide();
    }
    save() {
      const copy = this.svg.cloneNode(true);
      copy.setAttribute("xmlns", NS);
      copy.querySelectorAll(".spot, .rubber").forEach((el) => el.remove());
      copy.querySelectorAll(".off:not(.entry)").forEach((el) => el.remove());
      copy.classList.remove("active");
      const paper = document.createElementNS(NS, "rect");
      for (const [k, v] of [["width", "100%"], ["height", "100%"], ["fill", "#ffffff"]]) paper.setAttribute(k, v);
      copy.prepend(paper);
      // Colours come from the page's style sheet: those of paper go into the file.
      copy.setAttribute("font-family", "Helvetica, Arial, sans-serif");
      copy.querySelectorAll("[class]").forEach((el) => {
        for (const c of el.classList) {
          const color = onPaper[c.slice(1)];
          if (/^c.$/.test(c) && color) el.setAttribute("stroke", color), el.matches(".fp, .hp") || el.setAttribute("fill", "none");
          if (/^f.$/.test(c) && color) el.setAttribute("fill", color);
          if (c === "fp" || c === "hp") el.setAttribute("fill", "#ffffff");
        }
      });
      copy.querySelectorAll(".plot[transform]").forEach(flatten);
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" }));
      link.download = (this.svg.closest("figure")?.id || this.svg.id) + ".svg";
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    }
  }

  // On a narrow screen the contents would come before everything else.
  if (innerWidth < 1080) document.querySelector("nav > details")?.removeAttribute("open");

  // The narrow drawings come alive when the screen first is narrow.
  window.whirlFigures = [...document.querySelectorAll("svg.figure:not(.narrow)")].map((svg) => new Figure(svg));
  const telephone = matchMedia("screen and (max-width: 600px)");
  let alive = false;
  const awake = () => {
    if (!telephone.matches || alive) return;
    alive = true;
    window.whirlFigures.push(...[...document.querySelectorAll("svg.figure.narrow")].map((svg) => new Figure(svg)));
  };
  awake();
  telephone.addEventListener("change", awake);
})();

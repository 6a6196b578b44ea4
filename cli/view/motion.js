"use strict";
// Frames out of the page, and where every particle is between them.

// The bytes of a base64 text that was compressed by zlib.
async function inflated(text) {
  const binary = atob(text.trim()), bytes = new Uint8Array(binary.length);
  for (let k = 0; k < bytes.length; ++k) bytes[k] = binary.charCodeAt(k);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The numbers of all frames: bytes sorted by significance, each number less the one of the frame before.
function unsorted(bytes, first, count, width, row) {
  const words = width === 2 ? new Uint16Array(count) : new Uint32Array(count);
  for (let byte = 0; byte < width; ++byte) {
    const plane = first + byte * count, shift = 8 * byte;
    for (let k = 0; k < count; ++k) words[k] |= bytes[plane + k] << shift;
  }
  for (let k = row; k < count; ++k) words[k] += words[k - row];
  return words;
}

async function decoded(about, text) {
  const bytes = await inflated(text), row = 3 * about.particles, count = row * about.times.length;
  if (about.bytes === 2) return { fractions: unsorted(bytes, 0, count, 2, row) };
  const floats = (first) => new Float32Array(unsorted(bytes, first, count, 4, row).buffer);
  return { positions: floats(0), velocities: about.velocities ? floats(4 * count) : null };
}

// The ellipse through a place with a velocity, and the time on it; null for what comes from infinity.
class Orbit {
  constructor(x, v, mu) {
    const r = Math.hypot(...x), alpha = 2 / r - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / mu;
    this.bound = alpha > 0 && r > 0 && isFinite(alpha);
    if (!this.bound) return;
    this.x = x, this.v = v, this.r = r, this.a = 1 / alpha;
    this.n = Math.sqrt(mu / this.a ** 3);
    this.c = 1 - r / this.a;
    this.s = (x[0] * v[0] + x[1] * v[1] + x[2] * v[2]) / (this.n * this.a * this.a);
  }
  // Where the eccentric anomaly has grown by d. From it, how position and velocity at the start go into the place.
  place(d) {
    const { x, v, c, s, n } = this, cos = Math.cos(d), sin = Math.sin(d);
    const f = 1 - (1 - cos) / (1 - c), g = (sin * (1 - c) + s * (1 - cos)) / n;
    return [f * x[0] + g * v[0], f * x[1] + g * v[1], f * x[2] + g * v[2]];
  }
  velocity(d) {
    const { x, v, a, r, c, s, n } = this, cos = Math.cos(d), sin = Math.sin(d);
    const now = a * (1 - c * cos + s * sin), f = -n * a * a * sin / (r * now), g = 1 - a * (1 - cos) / now;
    return [f * x[0] + g * v[0], f * x[1] + g * v[1], f * x[2] + g * v[2]];
  }
  // The growth of the eccentric anomaly in a time, whole turns left out (Kepler's equation by Newton's method).
  anomaly(time) {
    const turns = this.n * time / (2 * Math.PI), M = (turns - Math.round(turns)) * 2 * Math.PI;
    let d = M;
    for (let k = 0; k < 30; ++k) {
      const cos = Math.cos(d), sin = Math.sin(d);
      const off = d - this.c * sin + this.s * (1 - cos) - M, slope = 1 - this.c * cos + this.s * sin;
      const change = Math.max(-1, Math.min(1, off / Math.max(slope, 1e-3)));
      d -= change;
      if (Math.abs(change) < 1e-12) break;
    }
    return d;
  }
}

// Where particles are at frame number s, a number with a fraction.
class Motion {
  constructor(about, data) {
    Object.assign(this, { about, ...data, n: about.particles, frames: about.times.length });
    this.places = new Float64Array(3 * this.n);  // relative to the center of the moment; in a box from its corner
    this.center = [0, 0, 0];
    this.edges = about.edges ? about.edges.slice(0, 3) : null;
    this.orbits = new Map();  // by body: that on which it is now
    this.fits = new Map();
  }
  path(i) { return this.about.paths[Math.min(i, this.about.paths.length - 1)]; }
  row(rows, k, i) {
    const at = 3 * (k * this.n + i);
    return [rows[at], rows[at + 1], rows[at + 2]];
  }
  go(s) {
    const k = Math.max(0, Math.min(Math.floor(s), this.frames - 2)), u = this.frames < 2 ? 0 : s - k;
    this.k = Math.min(k, this.frames - 1), this.u = u;
    this.time = this.frames < 2 ? this.about.times[0] : this.mixed(this.about.times, 1, 0);
    if (this.fractions) {
      this.go_in_box();
    } else {
      this.center = this.velocities && this.frames > 1 ? this.center_on_cubic() : [0, 1, 2].map((axis) => this.mixed(this.about.centers, 3, axis));
      if (this.velocities) this.go_few();
      else this.go_many();
    }
  }
  mixed(numbers, width, at) {
    const a = numbers[width * this.k + at];
    return this.frames < 2 ? a : a + this.u * (numbers[width * (this.k + 1) + at] - a);
  }
  // The frame that is shown where nothing is known between two of them.
  nearest() { return this.u < 1 ? this.k : this.k + 1; }
  go_in_box() {
    const { fractions, places, n } = this, moves = this.path(0) === "smooth";
    const first = 3 * n * (moves ? this.k : this.nearest()), next = first + (moves && this.frames > 1 ? 3 * n : 0);
    const u = moves ? this.u : 0;
    this.edges = [0, 1, 2].map((axis) => this.mixed(this.about.edges, 3, axis));
    const scale = this.edges.map((edge) => edge / 65536);
    for (let j = 0; j < 3 * n; ++j) {
      const a = fractions[first + j], way = ((fractions[next + j] - a + 32768) & 65535) - 32768;  // the shorter one
      let x = a + u * way;
      if (x < 0) x += 65536;
      if (x >= 65536) x -= 65536;
      places[j] = x * scale[j % 3];
    }
  }
  go_many() {
    const { positions, places, n } = this, moves = this.path(0) === "smooth" && this.frames > 1;
    const first = 3 * n * (moves ? this.k : this.nearest()), next = first + (moves ? 3 * n : 0), u = moves ? this.u : 0;
    for (let j = 0; j < 3 * n; ++j) places[j] = positions[first + j] + u * (positions[next + j] - positions[first + j]);
  }
  go_few() {
    this.orbits.clear();
    for (let i = 0; i < this.n; ++i) {
      const x = this.place_of(i);
      this.places[3 * i] = x[0], this.places[3 * i + 1] = x[1], this.places[3 * i + 2] = x[2];
    }
  }
  place_of(i) {
    const path = this.path(i), mu = this.about.mu[i];
    if (path === "jumps" || path === "ellipse" || this.frames < 2) {
      const k = this.nearest(), x = this.row(this.positions, k, i);
      if (path === "ellipse") this.orbits.set(i, new Orbit(x, this.row(this.velocities, k, i), mu));
      return x;
    }
    return path === "arcs" ? this.on_arc(i, mu) : this.on_cubic(i);
  }
  // The cubic that meets places and velocities at both frames; a velocity that would lead far beyond both is shortened.
  on_cubic(i) { return this.cubic(this.positions, this.velocities, (k) => 3 * (k * this.n + i)); }
  center_on_cubic() { return this.cubic(this.about.centers, this.about.center_velocities, (k) => 3 * k); }
  cubic(places, velocities, first) {
    const { k, u } = this, h = this.about.times[k + 1] - this.about.times[k], w = 1 - u;
    const at_frame = (rows, frame) => [0, 1, 2].map((axis) => rows[first(frame) + axis]);
    const a = at_frame(places, k), b = at_frame(places, k + 1);
    const chord = Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const slope = (at) => {
      const v = at_frame(velocities, at), size = Math.abs(h) * Math.hypot(...v);
      const part = size > 2.5 * chord ? 2.5 * chord / size : 1;
      return v.map((one) => one * h * part);
    };
    const va = slope(k), vb = slope(k + 1);
    const fa = w * w * (1 + 2 * u), fb = u * u * (1 + 2 * w), ga = u * w * w, gb = -u * u * w;
    return [0, 1, 2].map((axis) => fa * a[axis] + fb * b[axis] + ga * va[axis] + gb * vb[axis]);
  }
  // The Kepler arc from the frame before; its time is stretched and its end moved so that it meets the frame after.
  on_arc(i, mu) {
    const { k, u } = this, h = this.about.times[k + 1] - this.about.times[k];
    let fit = this.fits.get(i);
    if (!fit || fit.k !== k) this.fits.set(i, fit = this.fitted(i, k, mu, h));
    if (!fit.orbit.bound) return this.on_cubic(i);
    const d = fit.orbit.anomaly(u * fit.time), arc = fit.orbit.place(d), x = arc.map((one, axis) => one + u * fit.miss[axis]);
    const v = fit.orbit.velocity(d).map((one, axis) => one * fit.time / h + fit.miss[axis] / h);
    this.orbits.set(i, new Orbit(x, v, mu));
    return x;
  }
  fitted(i, k, mu, h) {
    const orbit = new Orbit(this.row(this.positions, k, i), this.row(this.velocities, k, i), mu);
    if (!orbit.bound) return { k, orbit };
    const end = this.row(this.positions, k + 1, i);
    let time = h, x = orbit.x;
    for (let round = 0; round < 4; ++round) {
      const d = orbit.anomaly(time), v = orbit.velocity(d);
      x = orbit.place(d);
      const [r2, L] = [dot(x, x), cross(x, v)], area = Math.hypot(...L);
      if (!(area > 0)) break;
      const turn = Math.atan2(dot(cross(x, end), L) / area, dot(x, end));
      if (round < 3) time += turn * r2 / area;
    }
    return { k, orbit, time, miss: end.map((one, axis) => one - x[axis]) };
  }
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

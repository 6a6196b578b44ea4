// What particles look like: colors, sizes, who belongs together.

const palette = ["#66ccee", "#ee8866", "#7bd389", "#e6c84f", "#c58bea", "#ff7b8a", "#77aaff", "#44bb99", "#ffaabb", "#bbcc33",
  "#b8a48f", "#dddddd"];
const named_colors = { sun: "#ffd35a", mercury: "#b9aca4", venus: "#ecc988", earth: "#5fa8ff", moon: "#cfcfcf", mars: "#ee6b48",
  jupiter: "#e0b184", saturn: "#ecdba6", uranus: "#9be5e8", neptune: "#6b8cff", pluto: "#cdb79e",
  red: "#ff6258", green: "#5fd38a", blue: "#5a8dff", orange: "#ff9f40", yellow: "#f0d94c", purple: "#c58bea", violet: "#c58bea", cyan: "#66ddee",
  pink: "#ffaabb", brown: "#c08a5a", teal: "#44bb99", gray: "#b4b4b4", grey: "#b4b4b4", white: "#f2f2f2" };
const element_colors = { H: "#f2f2f2", He: "#d9ffff", C: "#8c96a3", N: "#6b86ff", O: "#ff5b52", F: "#90e050", Na: "#ab7bf2",
  Mg: "#8aff00", P: "#ff9f40", S: "#f2e14c", Cl: "#5fdc5f", Ar: "#80d1e3", K: "#9f60e0", Ca: "#5fff3d", Fe: "#e08a55", Cu: "#d98a4b",
  Si: "#f0c8a0", Br: "#c0503f", I: "#b060c0", Xe: "#60b8d0", Kr: "#5cb8d1", Ne: "#b3e3f5" };

const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
// From blue over white to orange, for what goes from one end to the other.
const ramp_stops = ["#3d7bff", "#5fc8f0", "#eef3f6", "#ffc46b", "#f2643c"];
function ramp(x) {
  const at = Math.max(0, Math.min(0.9999, x)) * (ramp_stops.length - 1), k = Math.floor(at);
  const [a, b] = [rgb(ramp_stops[k]), rgb(ramp_stops[k + 1])];
  return a.map((one, c) => one + (at - k) * (b[c] - one));
}

// The number of the group of linked particles that each belongs to.
function groups_of(n, links) {
  const parent = Int32Array.from({ length: n }, (_, i) => i);
  const root = (i) => { while (parent[i] !== i) i = parent[i] = parent[parent[i]]; return i; };
  for (let k = 0; k + 1 < links.length; k += 2) parent[root(links[k])] = root(links[k + 1]);
  const numbers = new Map(), groups = new Int32Array(n);
  for (let i = 0; i < n; ++i) {
    const top = root(i);
    if (!numbers.has(top)) numbers.set(top, numbers.size);
    groups[i] = numbers.get(top);
  }
  return { groups, count: numbers.size };
}

class Look {
  constructor(about, motion) {
    this.about = about, this.n = about.particles;
    this.in_pixels = !about.edges && this.n <= 300;
    motion.go(0);
    this.near = this.in_pixels ? 0 : this.neighbor_distance(motion);
    this.radii = this.in_pixels ? this.pixel_radii() : this.sphere_radii();
    this.schemes = this.all_schemes(motion);
    this.use(0);
  }
  use(k) {
    this.scheme = this.schemes[k % this.schemes.length], this.number = k % this.schemes.length;
    this.colors = new Float32Array(3 * this.n);
    for (let i = 0; i < this.n; ++i) this.colors.set(this.scheme.color(i), 3 * i);
  }
  // The distance to the nearest neighbor: the median of some particles.
  neighbor_distance(motion) {
    const { places, edges } = motion, found = [];
    for (let j = 0; j < Math.min(this.n, 60); ++j) {
      const i = Math.floor(j * this.n / Math.min(this.n, 60));
      let least = Infinity;
      for (let k = 0; k < this.n; ++k) {
        if (k === i) continue;
        let r2 = 0;
        for (let axis = 0; axis < 3; ++axis) {
          let d = places[3 * k + axis] - places[3 * i + axis];
          if (edges) d -= edges[axis] * Math.round(d / edges[axis]);
          r2 += d * d;
        }
        if (r2 > 0 && r2 < least) least = r2;
      }
      found.push(Math.sqrt(least));
    }
    found.sort((a, b) => a - b);
    const near = found[Math.floor(found.length / 2)];
    return isFinite(near) && near > 0 ? Math.min(near, 1.05 * this.about.spacing || near) : this.about.spacing || 1;
  }
  // Of few bodies: the logarithm of their mass, so that a star leaves something for its planets.
  pixel_radii() {
    const masses = this.about.masses || [], known = masses.filter((m) => m > 0);
    const low = Math.log(Math.min(...known)), high = Math.log(Math.max(...known));
    const small = this.n > 100 ? 0.45 : this.n > 20 ? 0.6 : 1;
    return Float32Array.from({ length: this.n }, (_, i) => {
      if (!(masses[i] > 0)) return 3 * small;
      const part = high > low ? (Math.log(masses[i]) - low) / (high - low) : 0.6;
      const star = i === this.about.primary ? 0.8 : 1;  // its halo adds to it
      return (3.4 + 6.2 * part) * small * star;
    });
  }
  sphere_radii() {
    const { masses, links } = this.about, heaviest = masses ? masses.reduce((a, b) => Math.max(a, b), 0) : 0;
    const usual = (links.length > 0 ? 0.34 : 0.46) * this.near;
    return Float32Array.from({ length: this.n }, (_, i) =>
      usual * (heaviest > 0 ? Math.max(0.5, Math.min(1, Math.cbrt(masses[i] / heaviest))) : 1));
  }
  type_color(name, k) {
    const element = name.replace(/[^A-Za-z].*$/, "");
    return element_colors[element] || palette[k % palette.length];
  }
  all_schemes(motion) {
    const { about, n } = this, schemes = [], names = about.names, types = about.type_names;
    if (this.in_pixels && (names || n <= palette.length)) {
      const color = (i) => rgb((names && named_colors[names[i].toLowerCase()]) || palette[i % palette.length]);
      schemes.push({ label: "bodies", color, legend: [] });
    }
    if (types.length > 0 && (types.length > 1 || n > 12)) {
      const counts = types.map((_, k) => about.types.reduce((sum, one) => sum + (one === k), 0));
      const legend = types.slice(0, 12).map((name, k) => [this.type_color(name, k), `${name} (${counts[k].toLocaleString("en")})`]);
      schemes.push({ label: "types", color: (i) => rgb(this.type_color(types[about.types[i]], about.types[i])), legend });
    }
    const { groups, count } = groups_of(n, about.links);
    if (about.links.length > 0 && count > 1 && n > 12) {
      const color = (i) => rgb(palette[groups[i] % (palette.length - 1)]);
      schemes.push({ label: "molecules", color, legend: [[null, `each molecule in its own color (${count.toLocaleString("en")})`]] });
    }
    if (n > 12) {
      const linked = about.links.length > 0 && count < 3, start = Float64Array.from(motion.places);
      const axis = about.edges ? about.edges.slice(0, 3).indexOf(Math.max(...about.edges.slice(0, 3))) : 0;
      let low = Infinity, high = -Infinity;
      for (let i = 0; i < n; ++i) low = Math.min(low, start[3 * i + axis]), high = Math.max(high, start[3 * i + axis]);
      const part = (i) => (linked ? i / (n - 1) : (start[3 * i + axis] - low) / (high - low || 1));
      const text = linked ? "by number, first to last" : "by where they were at the first frame, along " + "xyz"[axis];
      schemes.push({ label: linked ? "order" : "start", color: (i) => ramp(part(i)), legend: [["ramp", text]] });
    }
    // One type alone says nothing by its color.
    if (types.length === 1 && schemes.length > 1) schemes.push(schemes.shift());
    return schemes;
  }
}

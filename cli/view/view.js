// The page: camera, trails, labels, clock, controls.

const element = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.max(low, Math.min(high, x));
const multiplied = (a, b) => a.map((row) => [0, 1, 2].map((c) => row[0] * b[0][c] + row[1] * b[1][c] + row[2] * b[2][c]));
const about_x = (angle) => [[1, 0, 0], [0, Math.cos(angle), -Math.sin(angle)], [0, Math.sin(angle), Math.cos(angle)]];
const about_y = (angle) => [[Math.cos(angle), 0, Math.sin(angle)], [0, 1, 0], [-Math.sin(angle), 0, Math.cos(angle)]];
const quantile = (sorted, part) => sorted[clamp(Math.round(part * (sorted.length - 1)), 0, sorted.length - 1)];

const trail_modes = ["none", "short", "long", "all"];
const path_styles = [null, { part: 0.05, floor: 0 }, { part: 0.25, floor: 0.13 }, { part: 1, floor: 0.5 }];
const ellipse_styles = [null, { length: 0.4, floor: 0 }, { length: 1, floor: 0.26 }, { length: 1, floor: 0.7 }];
const speeds = [1 / 256, 1 / 64, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8];

class View {
  constructor(about, data) {
    this.about = about, this.n = about.particles, this.frames = about.times.length;
    this.motion = new Motion(about, data);
    this.picture = new Picture(element("scene"));
    this.look = new Look(about, this.motion);
    this.wish = new URLSearchParams(location.hash.slice(1));
    const times = about.times, gaps = times.slice(1).map((t, k) => Math.abs(t - times[k]));
    const longest = gaps.reduce((a, b) => Math.max(a, b), 0), shortest = gaps.reduce((a, b) => Math.min(a, b), Infinity);
    this.by_frame = gaps.length > 0 && longest > 50 * shortest;  // logarithmic times, stops
    this.span = this.frames > 1 ? times[this.frames - 1] - times[0] : 0;
    this.sign = this.span < 0 ? -1 : 1;  // runs may go back in time
    this.duration = clamp(this.frames / 30, 8, 40);  // seconds at speed 1
    this.part = 0, this.speed = 1, this.playing = this.frames > 1, this.looped = true, this.turning = false;
    this.show = { names: this.wish.get("names") !== "off", box: this.wish.get("box") !== "off" };
    this.trails = !this.with_trails() ? 0 : trail_modes.includes(this.wish.get("trails")) ? trail_modes.indexOf(this.wish.get("trails")) : 2;
    this.paths = [];
    this.follow = this.first_to_follow();
    this.camera = { turn: this.first_turn(), target: [0, 0, 0], distance: 1, reach: 1, shift: [0, 0], lens: 1 / Math.tan(Math.PI / 11.25),
                    dense: this.look.in_pixels ? 0 : 0.82 };
    this.take_colors();
  }
  take_colors() {
    const light = this.wish.has("light");
    document.documentElement.classList.toggle("light", light);
    const style = getComputedStyle(document.documentElement), color = (name) => rgb(style.getPropertyValue(name).trim());
    Object.assign(this.camera, { sky: color("--sky"), deep: color("--deep"), ink: color("--ink") });
    this.camera.haze = this.camera.sky.map((one, c) => 0.5 * (one + this.camera.deep[c]));
  }
  with_trails() {
    if (!this.look.in_pixels || this.n > 60) return false;
    return this.about.links.length < this.n || this.n <= 12;
  }
  // Space as in the file, unless bodies leave it together; the primary where there is one.
  first_to_follow() {
    const { centers, primary } = this.about;
    if (!centers) return "space";
    if (primary >= 0) return primary;
    this.motion.go(0);
    let reach = 0;
    for (let i = 0; i < this.n; ++i) reach = Math.max(reach, Math.hypot(...this.motion.places.slice(3 * i, 3 * i + 3)));
    const last = centers.slice(-3), moved = Math.hypot(...last.map((x, axis) => x - centers[axis]));
    return this.n > 1 && reach > 0 && moved > 2 * reach && this.about.anchors.length === 0 ? "center" : "space";
  }
  offset() {
    const { motion, follow, about } = this;
    if (!about.centers || follow === "center") return [0, 0, 0];
    if (follow === "space") return motion.center.map((x, axis) => x - about.centers[axis]);
    return [0, 1, 2].map((axis) => -motion.places[3 * follow + axis]);
  }
  first_turn() {
    if (this.about.edges) return multiplied(about_x(0.34), about_y(-0.5));
    if (this.about.primary >= 0) return about_x(-0.98);
    const rows = this.extents();
    if (rows.z < 1e-3 * Math.max(rows.x, rows.y) || this.n === 1) return about_x(0);
    return multiplied(about_x(0.3), about_y(-0.45));
  }
  // Places of all bodies at some moments, sorted by axis.
  sampled_places() {
    const axes = [[], [], []], most = clamp(Math.floor(200000 / this.n), 2, 120), step = Math.max(1, (this.frames - 1) / most);
    for (let s = 0; s <= this.frames - 1; s += step) {
      this.motion.go(s);
      const off = this.offset();
      for (let j = 0; j < 3 * this.n; ++j) {
        const x = this.motion.places[j] + off[j % 3];
        if (isFinite(x)) axes[j % 3].push(x);
      }
    }
    const origin = this.follow === "space" ? this.about.centers : [0, 0, 0];
    for (const [, ...point] of this.about.anchors) point.forEach((x, axis) => axes[axis].push(x - origin[axis]));
    return axes.map((all) => Float64Array.from(all).sort());
  }
  extents() {
    const [x, y, z] = this.sampled_places().map((all) => all[all.length - 1] - all[0]);
    return { x, y, z };
  }
  fit() {
    const { camera, about } = this, { clientWidth: width, clientHeight: height } = this.picture.canvas;
    if (about.edges) {
      camera.target = about.edges.slice(0, 3).map((edge) => edge / 2);
      camera.reach = Math.hypot(...camera.target);
    } else {
      const axes = this.sampled_places(), part = about.anchors.length > 0 || this.n === 1 ? 1 : this.n < 30 ? 0.94 : 0.995;
      const middle = typeof this.follow === "number" && this.follow === about.primary;
      camera.target = middle ? [0, 0, 0] : axes.map((all) => (quantile(all, 1 - part) + quantile(all, part)) / 2 || 0);
      const reaches = axes.map((all, axis) => Math.max(quantile(all, part) - camera.target[axis], camera.target[axis] - quantile(all, 1 - part)) || 0);
      camera.reach = middle ? Math.max(...reaches) : Math.hypot(...reaches);
      // All orbits about a primary are in the picture, unless a body is far outside of the others.
      const farthest = Math.max(...axes.map((all) => Math.max(all[all.length - 1], -all[0]) || 0));
      if (middle && farthest < 3 * camera.reach) camera.reach = farthest;
      if (!(camera.reach > 0)) camera.reach = Math.max(1e-6, ...camera.target.map(Math.abs)) || 1;
    }
    // The picture stands between the header and the timeline.
    const below = 110 / height, above = 30 / height;
    camera.shift = [0, below - above];
    const free = Math.min(1 - below - above, width / height);
    camera.distance = (camera.reach * (about.edges ? 0.88 : about.primary >= 0 ? 0.84 : 1.06) * camera.lens) / free + (about.edges ? 0.3 * camera.reach : 0);
    camera.home = camera.distance;
    const zoom = parseFloat(this.wish.get("zoom"));
    if (zoom > 0) camera.distance /= zoom;
  }

  // Time: a part of the run, from 0 to 1, and the number of a frame with its fraction.
  frame_at(part) {
    const { times } = this.about, last = this.frames - 1;
    if (this.by_frame || last < 1) return part * last;
    const time = times[0] + part * this.span;
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.sign * times[middle] <= this.sign * time) low = middle; else high = middle;
    }
    return clamp(low + (time - times[low]) / (times[high] - times[low] || 1), 0, last);
  }
  is_later(a, b) { return this.sign * (a - b) > 0; }
  part_of_time(time) {
    const { times } = this.about, last = this.frames - 1;
    if (last < 1) return 0;
    if (!this.by_frame) return (time - times[0]) / this.span;
    let k = times.findIndex((t) => this.is_later(t, time));
    k = k < 0 ? last : Math.max(1, k);
    return clamp((k - 1 + (time - times[k - 1]) / (times[k] - times[k - 1])) / last, 0, 1);
  }
  go_to_frame(k) {
    const frame = clamp(k, 0, this.frames - 1);
    this.part = this.by_frame ? frame / Math.max(1, this.frames - 1) : this.part_of_time(this.about.times[frame]);
    this.draw();
  }
  time_text(time) {
    const { time_unit, time_length } = this.about, value = time / time_length;
    const span = Math.abs(this.span) / time_length || Math.abs(value) || 1, size = Math.abs(value);  // digits tell moments of the run apart
    const decimals = clamp(3 - Math.ceil(Math.log10(span)), 0, 12), more = clamp(Math.ceil(Math.log10(size / span)), 0, 12);
    const text = span >= 1e7 || (span < 1e-4 && size < 1) ? value.toExponential(3 + more) : value.toFixed(decimals);
    return text + (time_unit ? " " + time_unit : "");
  }

  // The way of bodies that move smoothly, once for each frame of reference.
  make_paths() {
    this.paths.forEach((path) => path && this.picture.forget(path));
    this.paths = [];
    const bodies = [...Array(this.with_trails() ? this.n : 0).keys()].filter((i) => this.motion.path(i) === "smooth" && i !== this.follow);
    if (bodies.length === 0 || this.frames < 2 || !this.motion.velocities) return;
    this.pieces = clamp(Math.floor(600000 / (bodies.length * this.frames)), 1, 10);
    const count = (this.frames - 1) * this.pieces + 1, points = new Map(bodies.map((i) => [i, new Float32Array(4 * count)]));
    for (let k = 0; k < count; ++k) {
      this.motion.go(k / this.pieces);
      const off = this.offset();
      for (const [i, all] of points) {
        for (let axis = 0; axis < 3; ++axis) all[4 * k + axis] = this.motion.places[3 * i + axis] + off[axis];
        all[4 * k + 3] = k / this.pieces;
      }
    }
    for (const [i, all] of points) {
      const still = all.every((x, j) => j % 4 === 3 || Math.abs(x - all[j % 4]) <= 1e-5 * this.camera.reach);
      if (!still) this.paths[i] = this.picture.path(all);
    }
  }
  draw_trails(off) {
    const { picture, camera, motion, look } = this, s = motion.k + motion.u;
    let drawn = 0;
    if (this.trails === 0) return drawn;
    const path = path_styles[this.trails], ellipse = ellipse_styles[this.trails];
    const color = (i) => [...look.colors.slice(3 * i, 3 * i + 3), 0.9];
    this.paths.forEach((one, i) => {
      if (!one) return;
      const length = Math.max(path.part * (this.frames - 1), 1), first = path.floor > 0 ? 0 : Math.max(0, Math.floor((s - length) * this.pieces));
      const end = Math.min(one.pieces, Math.ceil(s * this.pieces));
      picture.draw_path(one, first, end, color(i), camera, { width: 1.7, now: s, length, floor: path.floor });
      ++drawn;
    });
    const primary = this.about.primary;
    for (const [i, orbit] of motion.orbits) {
      if (!orbit.bound || i === this.follow) continue;
      const middle = [0, 1, 2].map((axis) => off[axis] + motion.places[3 * primary + axis]), rows = [];
      const pieces = 240, paint = color(i);
      let last = null;
      for (let k = 0; k <= pieces; ++k) {
        const x = orbit.place(2 * Math.PI * (k / pieces - 1)).map((one, axis) => one + middle[axis]), now = [...x, k / pieces];
        if (last) rows.push(...last, ...now, ...paint, ...paint);
        last = now;
      }
      picture.draw_lines(Float32Array.from(rows), camera, { width: 1.7, now: 1, ...ellipse });
      ++drawn;
    }
    return drawn;
  }
  draw_links(off) {
    const { motion, look, about, picture, camera } = this, { places, edges } = motion, rows = [];
    const shade = look.in_pixels ? 0.75 : 0.8, paint = (i) => [...look.colors.slice(3 * i, 3 * i + 3)].map((x) => x * shade);
    const add = (a, b, i, j) => rows.push(...a, 0, ...b, 0, ...paint(i), 1, ...paint(j), 1);
    const at = (i) => [0, 1, 2].map((axis) => places[3 * i + axis] + off[axis]);
    let crossing = 0;
    for (let k = 0; k + 1 < about.links.length; k += 2) {
      const i = about.links[k], j = about.links[k + 1], a = at(i), b = at(j);
      const way = b.map((x, axis) => x - a[axis] - (edges ? edges[axis] * Math.round((x - a[axis]) / edges[axis]) : 0));
      if (!edges || way.every((x, axis) => Math.abs(x - (b[axis] - a[axis])) < 1e-9 * edges[axis])) {
        add(a, b, i, j);
      } else {  // through the wall of the box: half of it on each side
        ++crossing;
        add(a, a.map((x, axis) => x + way[axis] / 2), i, i);
        add(b.map((x, axis) => x - way[axis] / 2), b, j, j);
      }
    }
    const origin = this.follow === "space" ? about.centers : motion.center;
    for (const [i, ...point] of about.anchors) {
      const a = point.map((x, axis) => x - origin[axis] + (this.follow === "space" ? 0 : off[axis]));
      add(a, at(i), i, i);
    }
    const style = look.in_pixels ? { width: this.n > 20 ? 2.5 : 3.5, round: 1 } : { width: 1.2, thick: 0.3 * look.near, round: 1 };
    picture.draw_lines(Float32Array.from(rows), camera, style);
    return { bonds: about.links.length / 2 + about.anchors.length, crossing };
  }
  draw_box() {
    const { edges } = this.motion, rows = [], paint = [...this.camera.ink, 0.42];
    if (!edges || !this.show.box) return 0;
    const corner = (k) => [0, 1, 2].map((axis) => ((k >> axis) & 1) * edges[axis]);
    for (let k = 0; k < 8; ++k) {
      for (let axis = 0; axis < 3; ++axis) {
        if (!((k >> axis) & 1)) rows.push(...corner(k), 0, ...corner(k | (1 << axis)), 0, ...paint, ...paint);
      }
    }
    this.picture.draw_lines(Float32Array.from(rows), this.camera, { width: 1.4 });
    return rows.length / 16;
  }
  draw() {
    const { motion, camera, look, picture, n } = this, { places } = motion;
    motion.go(this.frame_at(this.part));
    const off = this.offset(), rows = new Float32Array(8 * n), { target } = camera, primary = this.about.primary;
    for (let i = 0; i < n; ++i) {
      for (let axis = 0; axis < 3; ++axis) rows[8 * i + axis] = places[3 * i + axis] + off[axis] - target[axis];
      rows.set(look.colors.subarray(3 * i, 3 * i + 3), 8 * i + 3);
      rows[8 * i + 6] = i === primary ? 1 : 0;
      rows[8 * i + 7] = look.radii[i];
    }
    picture.begin(camera);
    picture.draw_spheres(rows, camera, look.in_pixels ? devicePixelRatio : 0, 0);
    const { bonds, crossing } = this.draw_links(off), trails = this.draw_trails(off), box = this.draw_box();
    if (primary >= 0 && look.in_pixels) picture.draw_spheres(rows, camera, devicePixelRatio, 4.5);
    const labels = this.controls.place_labels(rows);
    this.controls.tell();
    Object.assign(document.body.dataset, { ready: 1, frame: motion.nearest(), step: this.about.steps[motion.nearest()], time: motion.time,
      points: n, bonds, crossing, trails, labels, box, colors: look.scheme.label });
  }
  start() {
    this.controls = new Controls(this);
    this.resize();
    this.fit();
    this.make_paths();
    const frame = parseFloat(this.wish.get("frame"));
    if (this.wish.has("paused")) this.playing = false;
    this.controls.tell_state();
    this.go_to_frame(isFinite(frame) ? frame : 0);
    let last = performance.now();
    const tick = (now) => {
      const passed = Math.min(0.1, (now - last) / 1000);
      last = now;
      if (this.turning) this.camera.turn = multiplied(this.camera.turn, this.about.primary >= 0 ? this.about_z(0.15 * passed) : about_y(0.15 * passed));
      if (this.playing) this.advance(passed);
      if (this.playing || this.turning) this.draw();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
  about_z(angle) { return [[Math.cos(angle), -Math.sin(angle), 0], [Math.sin(angle), Math.cos(angle), 0], [0, 0, 1]]; }
  advance(passed) {
    this.part += passed * this.speed / this.duration;
    if (this.part < 1) return;
    this.part = this.looped ? 0 : 1;
    this.playing = this.looped;
    this.controls.tell_state();
  }
  resize() {
    const { canvas } = this.picture;
    canvas.width = Math.round(canvas.clientWidth * devicePixelRatio), canvas.height = Math.round(canvas.clientHeight * devicePixelRatio);
  }
}

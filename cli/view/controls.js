// What the user touches: buttons, keys, mouse, the timeline, names beside bodies.

class Controls {
  constructor(view) {
    this.view = view;
    const { about } = view;
    element("title").textContent = about.title;
    element("subtitle").textContent = [this.counts(), about.method].filter((one) => one).join(" \u00b7 ");
    element("notes").textContent = this.notes();
    this.labels = (about.names || []).map((name, i) => this.label(name, i));
    this.make_follow();
    this.make_speeds();
    this.buttons();
    this.mouse();
    addEventListener("keydown", (event) => this.key(event));
    addEventListener("resize", () => { view.resize(); this.draw_curve(); view.draw(); });
    if (!about.energy) element("curve").hidden = true, element("curve").style.display = "none";
    element("loop").hidden = element("speed").hidden = element("play").hidden = view.frames < 2;
    element("timeline").style.visibility = view.frames < 2 ? "hidden" : "";
    this.tell_state();
  }
  counts() {
    const { about, frames } = this.view, number = (x) => x.toLocaleString("en");
    const of = (shown, all) => (shown < all ? `${number(shown)} of ${number(all)}` : number(all));
    const things = about.edges || about.particles > 300 ? "particles" : about.particles === 1 ? "body" : "bodies";
    return `${of(about.particles, about.particles_in_file)} ${things}, ${of(frames, about.frames_in_file)} frame${about.frames_in_file === 1 ? "" : "s"}`;
  }
  notes() {
    const paths = new Set(this.view.about.paths), said = [];
    if (this.view.frames < 2) return "";
    if (paths.has("arcs")) said.push("Between frames, bodies move on Kepler arcs about the primary; their trails are their ellipses of the moment.");
    if (paths.has("smooth") && this.view.about.velocities) said.push("Between frames, positions and velocities are joined by cubics.");
    else if (paths.has("smooth")) said.push("Between frames, particles move on straight lines.");
    if (paths.has("ellipse") || paths.has("jumps")) said.push("Frames are too far apart to say what happens between them: there, bodies jump.");
    return said.join(" ");
  }
  label(name, i) {
    const { view } = this, label = document.createElement("span");
    label.textContent = name;
    label.addEventListener("click", () => this.follow(view.follow === i ? (view.about.primary >= 0 ? view.about.primary : "space") : i));
    element("labels").append(label);
    return label;
  }
  make_follow() {
    const { about } = this.view, select = element("follow"), add = (value, text) => select.append(new Option(text, value));
    if (!about.centers) return (select.hidden = true);
    if (about.primary < 0 && about.particles > 1) add("center", "follow the center of mass");
    add("space", "space as in the file");
    if (about.primary >= 0 && !about.names) add(about.primary, "follow the primary");
    (about.names || []).forEach((name, i) => add(i, "follow " + name));
    if (select.options.length < 2) select.hidden = true;
    select.addEventListener("change", () => this.follow(select.value));
  }
  follow(value) {
    const { view } = this;
    view.follow = isNaN(Number(value)) ? value : Number(value);
    // A body that is followed stands in the middle; the size of the picture stays.
    if (typeof view.follow === "number") view.camera.target = [0, 0, 0];
    else { const { distance } = view.camera; view.fit(); view.camera.distance = distance; }
    view.make_paths();
    this.tell_state();
    view.draw();
  }
  make_speeds() {
    const { view } = this, select = element("speed");
    speeds.forEach((speed, k) => select.append(new Option((speed < 1 ? "1/" + 1 / speed : speed) + "\u00d7", k)));
    select.addEventListener("change", () => { view.speed = speeds[select.value]; this.tell(); });
  }
  change_speed(by) {
    const { view } = this;
    view.speed = speeds[clamp(speeds.indexOf(view.speed) + by, 0, speeds.length - 1)];
    this.tell_state();
  }
  buttons() {
    const { view } = this, on = (id, act) => element(id).addEventListener("click", () => { act(); this.tell_state(); view.draw(); });
    on("play", () => this.play());
    on("loop", () => (view.looped = !view.looped));
    on("trails", () => (view.trails = (view.trails + 1) % trail_modes.length));
    on("colors", () => { view.look.use(view.look.number + 1); });
    on("names", () => (view.show.names = !view.show.names));
    on("box", () => (view.show.box = !view.show.box));
    on("home", () => { view.camera.turn = view.first_turn(); view.fit(); });
    on("help", () => (element("keys").hidden = !element("keys").hidden));
    element("trails").hidden = !view.with_trails();
    element("names").hidden = this.labels.length === 0;
    element("box").hidden = !view.about.edges;
    element("colors").hidden = view.look.schemes.length < 2;
    element("slider").addEventListener("input", (event) => { view.part = Number(event.target.value); view.draw(); });
  }
  play() {
    const { view } = this;
    if (!view.playing && view.part >= 1) view.part = 0;
    view.playing = !view.playing && view.frames > 1;
  }
  key(event) {
    const { view } = this, { key } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    const click = { t: "trails", c: "colors", n: "names", b: "box", f: "home", "?": "help", l: "loop", " ": "play" }[key];
    const step = (by) => { view.playing = false; view.go_to_frame(by < 0 ? Math.ceil(view.motion.k + view.motion.u - 1e-9) + by : Math.floor(view.motion.k + view.motion.u + 1e-9) + by); };
    const other = {
      ArrowLeft: () => step(event.shiftKey ? -10 : -1), ArrowRight: () => step(event.shiftKey ? 10 : 1),
      ArrowUp: () => this.turn(0, -20), ArrowDown: () => this.turn(0, 20),
      Home: () => view.go_to_frame(0), End: () => view.go_to_frame(view.frames - 1),
      "<": () => this.change_speed(-1), ",": () => this.change_speed(-1), ">": () => this.change_speed(1), ".": () => this.change_speed(1),
      "+": () => this.zoom(1 / 1.2), "=": () => this.zoom(1 / 1.2), "-": () => this.zoom(1.2), r: () => (view.turning = !view.turning),
      Escape: () => (element("keys").hidden = true),
    }[key];
    if (!click && !other) return;
    event.preventDefault();
    if (click && !element(click).hidden) element(click).click();
    if (other) other();
    this.tell_state();
    view.draw();
  }
  turn(dx, dy) {
    const { camera } = this.view;
    camera.turn = multiplied(multiplied(about_x(dy * 0.006), about_y(dx * 0.006)), camera.turn);
  }
  zoom(factor) {
    const { camera } = this.view;
    camera.distance = clamp(camera.distance * factor, camera.home * 1e-6, camera.home * 1e3);
  }
  move(dx, dy) {
    const { camera, picture } = this.view, scale = (2 * camera.distance) / (camera.lens * picture.canvas.clientHeight);
    camera.target = camera.target.map((x, axis) => x - scale * (dx * camera.turn[0][axis] - dy * camera.turn[1][axis]));
  }
  mouse() {
    const { view } = this, { canvas } = view.picture, fingers = new Map();
    const spread = () => { const [a, b] = [...fingers.values()]; return { size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 }; };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY, moves: event.button !== 0 || event.shiftKey });
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const finger = fingers.get(event.pointerId);
      if (!finger) return;
      const before = fingers.size === 2 ? spread() : null, dx = event.clientX - finger.x, dy = event.clientY - finger.y;
      finger.x = event.clientX, finger.y = event.clientY;
      if (before) {
        const after = spread();
        this.zoom(before.size / Math.max(after.size, 1));
        this.move(after.x - before.x, after.y - before.y);
      } else if (finger.moves) {
        this.move(dx, dy);
      } else {
        this.turn(dx, dy);
      }
      view.draw();
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(clamp(event.deltaY, -200, 200) * 0.0015));
      view.draw();
    }, { passive: false });
  }
  // Names beside their bodies; where two would overlap, that of the heavier body stays. @return how many are shown
  place_labels(rows) {
    const { view } = this, { camera, about, look } = view, { clientWidth: width, clientHeight: height } = view.picture.canvas;
    const order = [...this.labels.keys()].sort((i, j) => (j === view.follow) - (i === view.follow) || (about.masses || [])[j] - (about.masses || [])[i]);
    const taken = [];
    let shown = 0;
    for (const i of order) {
      const label = this.labels[i], p = [0, 1, 2].map((axis) => rows[8 * i + axis]);
      const e = camera.turn.map((row) => dot(row, p)), z = camera.distance - e[2];
      const x = width * (0.5 + 0.5 * ((e[0] * camera.lens * height) / width / z + camera.shift[0]));
      const y = height * (0.5 - 0.5 * ((e[1] * camera.lens) / z + camera.shift[1]));
      const left = x + look.radii[i] + 5, top = y - 11, right = left + 7.4 * about.names[i].length + 4;
      const free = taken.every(([l, t, r]) => right < l || left > r || Math.abs(top - t) > 16);
      const visible = view.show.names && z > 0 && x > -50 && x < width && y > 0 && y < height && free;
      label.style.display = visible ? "" : "none";
      if (!visible) continue;
      ++shown;
      taken.push([left, top, right]);
      label.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
      label.style.color = `rgb(${[0, 1, 2].map((c) => Math.round(255 * (0.35 * camera.ink[c] + 0.65 * look.colors[3 * i + c]))).join(",")})`;
      label.className = i === view.follow && i !== about.primary ? "followed" : "";
    }
    return shown;
  }
  // What changes with every picture.
  tell() {
    const { view } = this;
    element("time").textContent = view.time_text(view.motion.time);
    if (document.activeElement !== element("slider") || view.playing) element("slider").value = view.part;
    this.draw_curve();
  }
  // What changes by a button.
  tell_state() {
    const { view } = this, { look } = view;
    element("play").textContent = view.playing ? "\u275a\u275a" : "\u25b6";
    element("trails").textContent = "trails: " + trail_modes[view.trails];
    element("colors").textContent = "colors: " + look.scheme.label;
    element("loop").classList.toggle("off", !view.looped);
    element("names").classList.toggle("off", !view.show.names);
    element("box").classList.toggle("off", !view.show.box);
    element("follow").value = String(view.follow);
    element("speed").value = speeds.indexOf(view.speed);
    element("legend").replaceChildren(...look.scheme.legend.map(([color, text]) => {
      const row = document.createElement("li"), dot = document.createElement("i");
      if (color === "ramp") dot.className = "wide", dot.style.background = `linear-gradient(90deg, ${ramp_stops.join(", ")})`;
      else if (color) dot.style.background = color;
      row.append(...(color ? [dot, text] : [text]));
      return row;
    }));
  }
  // The energy over the timeline: the logarithm of its error, the part that has been played bright.
  draw_curve() {
    const { view } = this, { energy } = view.about, canvas = element("curve");
    if (!energy || view.frames < 2) return;
    const width = canvas.clientWidth, height = canvas.clientHeight, ratio = devicePixelRatio;
    canvas.width = width * ratio, canvas.height = height * ratio;
    const pen = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
    pen.scale(ratio, ratio);
    const above = energy.sizes.filter((x) => x > 0), most = above.reduce((a, b) => Math.max(a, b), 1e-300);
    const high = Math.log10(most) + 0.3, low = Math.max(Math.log10(above.reduce((a, b) => Math.min(a, b), most)), high - 5) - 0.2;
    const inset = 8, x = (time) => inset + view.part_of_time(time) * (width - 2 * inset);  // the knob of the slider is as wide
    const y = (size) => 20 + (height - 22) * clamp((high - Math.log10(Math.max(size, 1e-300))) / (high - low), 0, 1);
    const now = inset + view.part * (width - 2 * inset);
    const line = (color, from, to) => {
      pen.save();
      pen.beginPath();
      pen.rect(from, 0, to - from, height);
      pen.clip();
      pen.beginPath();
      energy.times.forEach((time, k) => pen.lineTo(x(time), y(energy.sizes[k])));
      pen.strokeStyle = color, pen.lineWidth = 1.3, pen.lineJoin = "round";
      pen.stroke();
      pen.restore();
    };
    const color = (name) => style.getPropertyValue(name).trim();
    line(color("--soft") + "88", now, width);
    line(color("--accent"), 0, now);
    let k = energy.times.findIndex((time) => view.is_later(time, view.motion.time));
    k = k < 0 ? energy.times.length - 1 : Math.max(0, k - 1);
    pen.fillStyle = color("--accent");
    pen.beginPath();
    pen.arc(now, y(energy.sizes[k]), 3.2, 0, 7);
    pen.fill();
    pen.fillStyle = color("--soft"), pen.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    pen.fillText(`${energy.label} ${energy.sizes[k].toExponential(1)}, worst ${most > 1e-300 ? most.toExponential(1) : 0}`, inset, 11);
  }
}

async function open_page() {
  const about = JSON.parse(element("about").textContent), say = (text) => { element("message").textContent = text; element("message").hidden = false; };
  try {
    if (typeof DecompressionStream === "undefined") throw new Error("This browser is too old for the page: it cannot decompress its frames (DecompressionStream).");
    const data = await decoded(about, element("frames").textContent);
    element("frames").remove();  // its text is as large as the frames
    const view = new View(about, data);
    window.noetherView = view;
    view.start();
  } catch (error) {
    element("title").textContent = about.title;
    say(error.message);
    document.body.dataset.failed = error.message;
  }
}
open_page();

"""What stands in a page of `noether view`, decoded by other means than the page's own: zlib, base64 and struct of Python.

    view_page.py frames PAGE RUN.h5   compares every number of the page with the run's; prints the largest differences
    view_page.py shot PAGE FRAGMENT   opens the page in headless Chromium and prints as JSON what it says of its picture
                                      and what the screenshot shows; exit 77 where there is no Chromium
    view_page.py bodies PAGE RUN.h5 FRAGMENT   looks for each body of a frame about a primary in the screenshot: prints how many
                                      spots there are, how many there should be, how far they are from where they should be, in
                                      pixels, and how far their hue is from that of the body's name
    view_page.py atoms PAGE RUN.h5 FRAGMENT    compares the screenshot of a periodic box with where its particles are: prints
                                      which part of the pixels is lit, how well that fits the particles' discs, how far from the
                                      screenshot's edges they reach, and how the colors go with the places at the first frame

What a page says of itself counts for nothing in the last two: their numbers are from the pixels and from the run alone, and only the
distance of the eye and the row of pixels in the middle of the picture are fitted.
"""

import base64
import colorsys
import html.parser
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77


def h5py_or_skip():
    try:
        import h5py
    except ImportError:
        print("there is no Python with h5py")
        sys.exit(SKIPPED)
    return h5py


def parts_of(page):
    text = pathlib.Path(page).read_text(encoding="utf-8")
    found = re.findall(r'<script id="(\w+)" type="[\w/]+">(.*?)</script>', text, re.DOTALL)
    return {name: content for name, content in found}


def unsorted(data, count, width, row):
    """Whole numbers whose bytes stand sorted by significance, each less the one a row before."""
    words = [sum(data[k + byte * count] << (8 * byte) for byte in range(width)) for k in range(count)]
    for k in range(row, count):
        words[k] = (words[k] + words[k - row]) & ((1 << (8 * width)) - 1)
    return words


def frames_of(page):
    parts = parts_of(page)
    about = json.loads(parts["about"])
    data = zlib.decompress(base64.b64decode(parts["frames"], validate=True))
    row, frames = 3 * about["particles"], len(about["times"])
    count = row * frames
    if about["bytes"] == 2:
        assert len(data) == 2 * count, (len(data), count)
        return about, unsorted(data, count, 2, row), None

    def floats(first):
        words = unsorted(data[first:first + 4 * count], count, 4, row)
        return struct.unpack(f"<{count}f", struct.pack(f"<{count}I", *words))

    return about, floats(0), floats(4 * count) if about["velocities"] else None


def compare(page, run):
    h5py = h5py_or_skip()
    about, places, velocities = frames_of(page)
    particles, worst = about["particles"], {"position": 0.0, "velocity": 0.0, "time": 0.0}
    with h5py.File(run) as file:
        system = file["particles/system"]
        steps = list(system["position/step"][:])
        for k, step in enumerate(about["steps"]):
            at = steps.index(step)
            x, v = system["position/value"][at], system["velocity/value"][at]
            worst["time"] = max(worst["time"], abs(system["position/time"][at] - about["times"][k]))
            size = abs(x).max() or 1.0
            for i in range(particles):
                for axis in range(3):
                    j = 3 * (k * particles + i) + axis
                    if about["bytes"] == 2:
                        edge = about["edges"][3 * k + axis]
                        off = places[j] / 65536 - x[i][axis] / edge
                        off, scale = abs(off - round(off)) * 65536, 1.0
                    else:
                        off, scale = abs(places[j] + about["centers"][3 * k + axis] - x[i][axis]), size
                    worst["position"] = max(worst["position"], off / scale)
                    if velocities:
                        speed = velocities[j] + about["center_velocities"][3 * k + axis]
                        worst["velocity"] = max(worst["velocity"], abs(speed - v[i][axis]) / (abs(v).max() or 1.0))
    print(json.dumps({**worst, "frames": len(about["times"]), "particles": particles, "links": len(about["links"]) // 2,
                      "paths": about["paths"], "types": about["type_names"], "energies": len((about["energy"] or {"times": []})["times"])}, separators=(",", ":")))
    return 0


def pixels_of(png):
    """Rows of (r, g, b) of a PNG of 8 bits a channel, as Chromium writes them."""
    at, packed = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", png[at + 8:at + 18])
            assert depth == 8 and color in (2, 6), (depth, color)
        if kind == b"IDAT":
            packed += png[at + 8:at + 8 + size]
        at += size + 12
    channels = 3 if color == 2 else 4
    raw, stride, rows, above = zlib.decompress(packed), width * channels, [], bytes(width * channels)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for k in range(stride):
            left, up = line[k - channels] if k >= channels else 0, above[k]
            corner = above[k - channels] if k >= channels else 0
            if kind == 4:
                guess = left + up - corner
                nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                line[k] = (line[k] + nearest[2]) & 255
            else:
                line[k] = (line[k] + (0, left, up, (left + up) // 2)[kind]) & 255
        rows.append([tuple(line[k:k + 3]) for k in range(0, stride, channels)])
        above = bytes(line)
    return rows


def seen_in(rows):
    """How many pixels of the scene stand out from the sky, how far they reach, and in how many colors."""
    height, width = len(rows), len(rows[0])
    seen, colors = [], {}
    for y in range(int(0.14 * height), int(0.76 * height)):
        for x in range(width):
            r, g, b = rows[y][x]
            if max(r, g, b) > 90:
                seen.append((x, y))
                if max(r, g, b) - min(r, g, b) > 50:
                    hue = (r > 1.25 * b, b > 1.25 * r, g > 1.15 * max(r, b))
                    colors[hue] = colors.get(hue, 0) + 1
    xs, ys = [x for x, _ in seen] or [0], [y for _, y in seen] or [0]
    return {"lit": len(seen), "wide": (max(xs) - min(xs)) / width, "high": (max(ys) - min(ys)) / height,
            "hues": sum(1 for count in colors.values() if count > 5)}


class Body(html.parser.HTMLParser):
    """The attributes of <body>."""
    data = {}

    def handle_starttag(self, tag, attributes):
        if tag == "body":
            self.data = {name.removeprefix("data-"): value for name, value in attributes if name.startswith("data-")}


def run_twice_at_most(command):
    """Runs a browser. On a busy machine one hangs at times, and another does not."""
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    except subprocess.TimeoutExpired:
        return subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)


def screenshot(page, fragment):
    """What the page says of itself, and the rows of its picture; None where there is no Chromium that runs."""
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        print("there is no Chromium")
        return None
    with tempfile.TemporaryDirectory() as folder:
        common = [browser, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--hide-scrollbars",
                  "--enable-unsafe-swiftshader", f"--user-data-dir={folder}/profile", "--window-size=640,480",
                  "--virtual-time-budget=4000", "--host-resolver-rules=MAP * ~NOTFOUND"]
        address = pathlib.Path(page).resolve().as_uri() + "#" + fragment
        picture = f"{folder}/picture.png"
        dom = run_twice_at_most([*common, "--dump-dom", address])
        body = Body()
        body.feed(dom.stdout)
        run_twice_at_most([*common, f"--screenshot={picture}", address])
        if "ready" not in body.data and "failed" not in body.data:
            print(f"Chromium does not run here: {dom.stderr[-300:]}")
            return None
        return body.data, pixels_of(pathlib.Path(picture).read_bytes())


def shot(page, fragment):
    taken = screenshot(page, fragment)
    if taken is None:
        return SKIPPED
    print(json.dumps({**taken[0], **seen_in(taken[1])}, separators=(",", ":")))
    return 0


LENS = 1 / math.tan(math.pi / 11.25)  # of an eye that sees 32 degrees
LIT = 100  # the brightest channel of a pixel that is no sky
HUES = {"Sun": "#ffd35a", "Mercury": "#b9aca4", "Venus": "#ecc988", "Earth": "#5fa8ff", "Mars": "#ee6b48", "Jupiter": "#e0b184",
        "Saturn": "#ecdba6", "Uranus": "#9be5e8", "Neptune": "#6b8cff"}


def rgb_of(text):
    return tuple(int(text[at:at + 2], 16) for at in (1, 3, 5))


def turned(about_x, about_y, point):
    """A place as the eye sees it: turned about y, then about x."""
    x, y, z = point
    x, z = math.cos(about_y) * x + math.sin(about_y) * z, math.cos(about_y) * z - math.sin(about_y) * x
    return x, math.cos(about_x) * y - math.sin(about_x) * z, math.sin(about_x) * y + math.cos(about_x) * z


def on_screen(place, distance, width, height, middle):
    """Pixels from the upper left, and pixels to a unit of length there. @param middle  row where the eye looks"""
    x, y, z = place
    scale = 0.5 * height * LENS / max(distance - z, 1e-9 * distance)
    return 0.5 * width + scale * x, middle - scale * y, scale


def spots_in(rows, top, bottom):
    """Groups of lit pixels that touch: their middles, sizes and brightest colors."""
    width = len(rows[0])
    lit = {(x, y) for y in range(top, bottom) for x in range(width) if max(rows[y][x]) > LIT}
    spots = []
    while lit:
        group, heap = [], [lit.pop()]
        while heap:
            x, y = heap.pop()
            group.append((x, y))
            for near in [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]:
                if near in lit:
                    lit.remove(near)
                    heap.append(near)
        if len(group) < 4:
            continue
        weights = [max(rows[y][x]) for x, y in group]
        middle = [sum(w * p[axis] for w, p in zip(weights, group)) / sum(weights) + 0.5 for axis in (0, 1)]
        colored = max((rows[y][x] for x, y in group), key=lambda c: max(c) - min(c))
        spots.append((middle, len(group), colored))
    return spots


def hue_between(a, b):
    one, other = (colorsys.rgb_to_hsv(*(c / 255 for c in color))[0] for color in (a, b))
    return abs((one - other + 0.5) % 1 - 0.5)


def bodies(page, run, fragment):
    h5py = h5py_or_skip()
    taken = screenshot(page, fragment)
    if taken is None:
        return SKIPPED
    said, rows = taken
    height, width = len(rows), len(rows[0])
    with h5py.File(run) as file:
        system = file["particles/system"]
        at = int(re.search(r"frame=(\d+)", fragment).group(1))
        places = system["position/value"][at]
        names = [name.decode() if isinstance(name, bytes) else name for name in system["name"][:]]
        primary = int(system["mass"][:].argmax())
    seen = [turned(-0.98, 0, place - places[primary]) for place in places]
    top, bottom, beside = int(0.14 * height), int(0.7 * height), 24  # between texts and buttons; of the primary's light
    spots = spots_in(rows, top, bottom)

    def in_picture(distance, middle):
        """Where bodies are that stand in the picture, clear of the primary."""
        places = {}
        for i, place in enumerate(seen):
            x, y, _ = on_screen(place, distance, width, height, middle)
            clear = math.hypot(x - 0.5 * width, y - middle) > beside
            if i != primary and clear and 8 < x < width - 8 and top + 8 < y < bottom - 8:
                places[i] = (x, y)
        return places

    def offs(distance, middle):
        """How far each body is from the spot that is nearest to it, and each spot from the nearest body or the primary."""
        bodies_there = in_picture(distance, middle)
        found = [min([math.hypot(x - s[0][0], y - s[0][1]) for s in spots] or [math.inf]) for x, y in bodies_there.values()]
        for (x, y), _, _ in spots:
            from_primary = max(0, math.hypot(x - 0.5 * width, y - middle) - beside)
            found.append(min([from_primary] + [math.hypot(x - a, y - b) for a, b in bodies_there.values()]))
        return found

    reach = max(max(abs(x) for x in place) for place in seen)
    fits = ((reach * 1.02 ** k, middle) for k in range(-260, 130) for middle in range(int(0.33 * height), int(0.5 * height)))
    distance, middle = min(fits, key=lambda fit: (-len(in_picture(*fit)), 0) if not spots else max(offs(*fit)))
    there, hues, used = in_picture(distance, middle), {}, set()
    for i, (x, y) in there.items():
        nearest = min(range(len(spots)), key=lambda k: math.hypot(x - spots[k][0][0], y - spots[k][0][1]), default=None)
        used.add(nearest)
        if nearest is not None and names[i] in HUES:
            hues[names[i]] = hue_between(spots[nearest][2], rgb_of(HUES[names[i]]))
    light = [s for s in spots if math.hypot(s[0][0] - 0.5 * width, s[0][1] - middle) < beside]
    print(json.dumps({"frame": said.get("frame"), "spots": len(used), "expected": len(there), "primary": len(light),
                      "off": max(offs(distance, middle), default=math.inf), "hue": max(hues.values(), default=1),
                      "names": [names[i] for i in there]}, separators=(",", ":")))
    return 0


def neighbor_distance(places, edges):
    """The distance to the nearest neighbor, the median of some particles."""
    import numpy
    found = []
    for i in range(0, len(places), max(1, len(places) // 60)):
        off = places - places[i]
        off -= edges * numpy.round(off / edges)
        found.append(math.sqrt(sorted((off * off).sum(axis=1))[1]))
    return sorted(found)[len(found) // 2]


def discs_of(seen, distance, radius, width, height, middle):
    """For each pixel the particle that is in front there, -1 for the sky."""
    import numpy
    front = numpy.full((height, width), -1)
    depth = numpy.full((height, width), -math.inf)
    for i, place in enumerate(seen):
        x, y, scale = on_screen(place, distance, width, height, middle)
        r = max(radius * scale, 1.0)
        left, right, top, bottom = (int(math.floor(v)) for v in (x - r, x + r + 1, y - r, y + r + 1))
        if left < 0 or top < 0 or right >= width or bottom >= height:
            continue
        ys, xs = numpy.mgrid[top:bottom, left:right]
        inside = ((xs + 0.5 - x) ** 2 + (ys + 0.5 - y) ** 2 <= r * r) & (depth[top:bottom, left:right] < place[2])
        depth[top:bottom, left:right][inside] = place[2]
        front[top:bottom, left:right][inside] = i
    return front


def atoms(page, run, fragment):
    h5py = h5py_or_skip()
    import numpy
    taken = screenshot(page, fragment)
    if taken is None:
        return SKIPPED
    said, rows = taken
    height, width = len(rows), len(rows[0])
    with h5py.File(run) as file:
        system = file["particles/system"]
        at = int(re.search(r"frame=(\d+)", fragment).group(1))
        first, places = system["position/value"][0], system["position/value"][at]
        edges = system["box/edges/value"][at]
    pixels = numpy.array(rows, dtype=float)
    top, bottom, shaded = int(0.2 * height), int(0.7 * height), 60  # below texts and above buttons; the dark side of a disc
    lit = pixels.max(axis=2) > shaded
    lit[:top], lit[bottom:] = False, False
    seen = [turned(0.34, -0.5, place) for place in places % edges - edges / 2]
    radius = 0.46 * neighbor_distance(first, edges)
    # The eye is as far away as makes the discs as wide as what is lit.
    columns, lines = numpy.flatnonzero(lit.any(axis=0)), numpy.flatnonzero(lit.any(axis=1))
    wide = columns[-1] - columns[0] + 1 if len(columns) else 0
    near, far = 1.2 * numpy.linalg.norm(edges), 40 * numpy.linalg.norm(edges)
    for _ in range(40):
        distance = (near + far) / 2
        ends = [on_screen(place, distance, width, height, 0) for place in seen]
        reach = max(x + radius * s for x, _, s in ends) - min(x - radius * s for x, _, s in ends)
        near, far = (distance, far) if reach > wide else (near, distance)
    # It looks at the row that makes their lower ends the same.
    middle = int(lines[-1]) + 1 - max(y + radius * s for _, y, s in ends) if wide else 0.4 * height
    front = discs_of(seen, distance, radius, width, height, middle)
    front[:top], front[bottom:] = -1, -1
    covered = front >= 0
    fit = (covered & lit).sum() / (covered | lit).sum()
    both = covered & lit
    part = (first[:, int(edges.argmax())] / edges.max())[front[both]]
    warm = pixels[:, :, 0][both] - pixels[:, :, 2][both]
    print(json.dumps({"frame": said.get("frame"), "share": float(lit[top:bottom].mean()), "fit": float(fit), "wide": wide / width,
                      "colors": float(numpy.corrcoef(part, warm)[0, 1]) if both.sum() > 10 else 0,
                      "warm": float((warm > 40).mean()), "cold": float((warm < -40).mean())}, separators=(",", ":")))
    return 0


if __name__ == "__main__":
    sys.exit({"frames": compare, "shot": shot, "bodies": bodies, "atoms": atoms}[sys.argv[1]](*sys.argv[2:]))

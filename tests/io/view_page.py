"""What stands in a page of `noether view`, decoded by other means than the page's own: zlib, base64 and struct of Python.

    view_page.py frames PAGE RUN.h5   compares every number of the page with the run's; prints the largest differences
    view_page.py shot PAGE FRAGMENT   opens the page in headless Chromium and prints as JSON what it says of its picture
                                      and what the screenshot shows; exit 77 where there is no Chromium
"""

import base64
import html.parser
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

SKIPPED = 77


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
    try:
        import h5py
    except ImportError:
        print("there is no Python with h5py")
        return SKIPPED
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


def shot(page, fragment):
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        print("there is no Chromium")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        common = [browser, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--hide-scrollbars",
                  "--enable-unsafe-swiftshader", f"--user-data-dir={folder}/profile", "--window-size=640,480",
                  "--virtual-time-budget=4000", "--host-resolver-rules=MAP * ~NOTFOUND"]
        address = pathlib.Path(page).resolve().as_uri() + "#" + fragment
        picture = f"{folder}/picture.png"
        dom = subprocess.run([*common, "--dump-dom", address], capture_output=True, text=True, timeout=120, check=False)
        body = Body()
        body.feed(dom.stdout)
        subprocess.run([*common, f"--screenshot={picture}", address], capture_output=True, timeout=120, check=False)
        if "ready" not in body.data and "failed" not in body.data:
            print(f"Chromium does not run here: {dom.stderr[-300:]}")
            return SKIPPED
        seen = seen_in(pixels_of(pathlib.Path(picture).read_bytes()))
    print(json.dumps({**body.data, **seen}, separators=(",", ":")))
    return 0


if __name__ == "__main__":
    sys.exit({"frames": compare, "shot": shot}[sys.argv[1]](*sys.argv[2:]))

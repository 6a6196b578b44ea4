#include "study/report.hpp"
#include "study/svg.hpp"

#include <fmt/format.h>

namespace noether {

namespace {

// Colours are those of Paul Tol's bright scheme, told apart by the colour-blind; markers and dashes tell them apart in
// grey.
std::string_view report_style() {
  return R"css(
:root {
  color-scheme: light dark;
  --page: #fff; --ink: #1a1a1a; --soft: #5c5c5c; --faint: #e4e4e4; --panel: #f6f6f4; --front: #00000022;
  --c0: #4477aa; --c1: #ee6677; --c2: #228833; --c3: #b59f1d; --c4: #2ea8c9; --c5: #aa3377; --c6: #777;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #16181b; --ink: #e8e8e6; --soft: #a4a8ad; --faint: #31353a; --panel: #1f2226; --front: #ffffff2e;
    --c0: #77aadd; --c1: #ff8d94; --c2: #5cc06c; --c3: #ddcc55; --c4: #77d5ee; --c5: #e07fb5; --c6: #b4b4b4;
  }
}
* { box-sizing: border-box }
body { margin: 0 auto; padding: 2.2rem 1.4rem 4rem; max-width: 1080px; background: var(--page); color: var(--ink);
  font: 16px/1.5 Georgia, "Times New Roman", serif }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 .3rem; font-weight: 600 }
h2 { font-size: 1.15rem; margin: 2.4rem 0 .4rem; font-weight: 600 }
p { margin: .4rem 0; max-width: 46rem }
.lead { color: var(--soft) }
.plot { width: 100%; height: auto; display: block; font: 13px system-ui, "Helvetica Neue", Arial, sans-serif }
.plot text { fill: var(--ink) }
.plot .tick, .plot .name { fill: var(--soft) }
.plot .grid { stroke: var(--faint); stroke-width: 1 }
.plot .axis { stroke: var(--soft); fill: none }
.plot .front { stroke: var(--front); stroke-width: 9; fill: none; stroke-linejoin: round; stroke-linecap: round }
.plot .ring { fill: none; stroke: var(--ink); stroke-width: 1.3 }
.plot .leader { fill: none; stroke-width: .8; stroke-dasharray: 1 3; opacity: .8 }
.plot .curve, .plot .label, .plot .row { transition: opacity .12s }
.plot .row .note { fill: var(--soft) }
.plot .row.alarm > .series, .plot .row.alarm > .note { fill: var(--c1); font-weight: 600 }
.key { font: 13px system-ui, "Helvetica Neue", Arial, sans-serif; color: var(--soft); max-width: none }
.key span { margin-right: 1.2rem; white-space: nowrap }
.plot .label { cursor: default }
.away { opacity: .12 }
.swatch { width: 14px; height: 14px; vertical-align: -2px; margin-right: .35rem }
.scroll { overflow-x: auto }
table { border-collapse: collapse; font: 13px/1.45 system-ui, "Helvetica Neue", Arial, sans-serif; margin: .6rem 0 }
th { text-align: right; font-weight: 600; border-bottom: 1px solid var(--soft); padding: .25rem .7rem;
  white-space: nowrap }
td { text-align: right; padding: .12rem .7rem; font-variant-numeric: tabular-nums; white-space: nowrap }
th:first-child, td:first-child { text-align: left }
table.words th, table.words td { text-align: left; vertical-align: top }
table.words td:last-child { white-space: normal; min-width: 14rem }
tr.group td { border-top: 1px solid var(--faint) }
tr.front td { font-weight: 600 }
td.bad { color: var(--c1) }
.panel { background: var(--panel); border-radius: 8px; padding: .8rem 1rem; margin: .6rem 0 }
.panel label { display: inline-flex; align-items: center; gap: .6rem; margin-right: 1.6rem;
  font: 14px system-ui, "Helvetica Neue", Arial, sans-serif }
.panel output { min-width: 10.5rem; font-variant-numeric: tabular-nums }
code { font: 13px ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere }
dl { display: grid; grid-template-columns: 9rem 1fr; gap: .15rem 1rem; font-size: 14px }
dt { color: var(--soft) } dd { margin: 0 }
@media print { body { max-width: none } .panel label { display: none } }
)css";
}

std::string_view report_script() {
  return R"js(
"use strict";
// A curve or its name under the pointer: the others of all plots step back.
const named = [...document.querySelectorAll("[data-name]")];
for (const one of named) {
  one.addEventListener("pointerenter", () => {
    for (const other of named) other.classList.toggle("away", other.dataset.name !== one.dataset.name);
  });
  one.addEventListener("pointerleave", () => { for (const other of named) other.classList.remove("away"); });
}

const holder = document.getElementById("solution-data");
if (holder) {
  const data = JSON.parse(holder.textContent);
  const pick = { method: document.getElementById("method"), step: document.getElementById("step"),
                 damping: document.getElementById("damping") };
  const said = { method: document.getElementById("method-said"), step: document.getElementById("step-said"),
                 damping: document.getElementById("damping-said") };
  const width = 1000, left = 74, right = 20;
  const short = (x) => Number(x.toPrecision(3)).toString();
  const point = (x, y) => x.toFixed(1) + " " + y.toFixed(1);
  const path = (ts, ys, X, Y) => ts.map((t, i) => (i ? "L" : "M") + point(X(t), Y(ys[i]))).join("");
  const ticks = (low, high, most) => {
    const rough = (high - low) / most, unit = 10 ** Math.floor(Math.log10(rough));
    const stride = [1, 2, 5, 10].map((f) => f * unit).find((s) => s >= rough);
    const all = [];
    for (let x = Math.ceil(low / stride) * stride; x <= high + 1e-9 * stride; x += stride) {
      all.push(Math.abs(x) < 1e-9 * stride ? 0 : x);
    }
    return all;
  };
  const frame = (top, bottom, X, Y, xs, ys, name) => {
    let out = "";
    for (const t of xs) out += `<line class="grid" x1="${X(t)}" x2="${X(t)}" y1="${top}" y2="${bottom}"/>`;
    for (const y of ys) {
      out += `<line class="grid" x1="${left}" x2="${width - right}" y1="${Y(y)}" y2="${Y(y)}"/>`;
      out += `<text class="tick" x="${left - 7}" y="${Y(y) + 4}" text-anchor="end">${short(y)}</text>`;
    }
    out += `<path class="axis" d="M${left} ${top}V${bottom}H${width - right}"/>`;
    const turned = `transform="translate(18 ${(top + bottom) / 2}) rotate(-90)"`;
    return out + `<text class="name" text-anchor="middle" ${turned}>${name}</text>`;
  };
  const draw = () => {
    const m = +pick.method.value, h = +pick.step.value, d = pick.damping ? +pick.damping.value : 0;
    const run = data.runs.find((r) => r.m === m && r.h === h && r.d === d), exact = data.exact[d];
    said.method.textContent = data.methods[m];
    said.step.textContent = short(data.steps[h]) + data.unit + ", \u03c9h = " + short(data.omega * data.steps[h]);
    if (said.damping) said.damping.textContent = short(data.dampings[d]) + data.per_unit;
    const end = exact.t[exact.t.length - 1], X = (t) => left + (t / end) * (width - left - right);
    const reach = 1.6 * Math.max(...exact.q.map(Math.abs)), xs = ticks(0, end, 10);
    const top = 12, middle = 262, low = 292, bottom = 480;
    const Y = (q) => (top + middle) / 2 - Math.max(-1, Math.min(1, q / reach)) * (middle - top) / 2;
    let out = frame(top, middle, X, Y, xs, ticks(-reach, reach, 6), data.coordinate + data.length_unit);
    const line = (ts, ys, Z, style) => `<path d="${path(ts, ys, X, Z)}" fill="none" ${style}/>`;
    out += line(exact.t, exact.q, Y, 'stroke="var(--soft)" stroke-width="2.6" opacity=".55"');
    out += line(run.t, run.q, Y, 'stroke="var(--c1)" stroke-width="1.3"');
    for (let i = 0; run.t.length < 170 && i < run.t.length; ++i) {
      out += `<circle cx="${X(run.t[i]).toFixed(1)}" cy="${Y(run.q[i]).toFixed(1)}" r="2.6" fill="var(--c1)"/>`;
    }
    const e = run.e;
    const most = e.length ? Math.max(1e-17, Math.min(10, Math.max(...e.map(Math.abs)))) : 1;
    const E = (x) => (low + bottom) / 2 - Math.max(-1, Math.min(1, x / (1.1 * most))) * (bottom - low) / 2;
    out += frame(low, bottom, X, E, xs, e.length ? [-most, 0, most] : [], "energy error");
    if (run.refused) {
      const words = data.methods[m] + " does not support friction";
      out += `<text x="${width / 2}" y="${(top + middle) / 2}" text-anchor="middle">${words}</text>`;
    }
    if (e.length) out += line(run.t.slice(0, e.length), e, E, 'stroke="var(--c0)" stroke-width="1.4"');
    else out += `<text x="${width / 2}" y="${(low + bottom) / 2}" text-anchor="middle">no energy is known here</text>`;
    const under = (kind, x, y, text) => `<text class="${kind}" x="${x}" y="${y}" text-anchor="middle">${text}</text>`;
    for (const t of xs) out += under("tick", X(t), bottom + 17, short(t));
    out += under("name", width / 2, bottom + 38, "time" + data.time_unit);
    document.getElementById("solution").innerHTML = out;
  };
  for (const control of Object.values(pick)) if (control) control.addEventListener("input", draw);
  draw();
}
)js";
}

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}<script>{3}</script>\n</body>\n"
      "</html>\n",
      html_text(title), report_style(), body, report_script());
}

}  // namespace noether

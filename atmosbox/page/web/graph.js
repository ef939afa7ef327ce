// One graph: uPlot gives axes, grid and size; the curves are drawn in the style of the figures of a run.

import { drawAtmosphere } from "./atmosphere.js";
import { curveColour, curveDash, look } from "./colour.js";
import { logTicks, powerText, scaled, tickTexts, ticks } from "./figure.js";
import { drawAreas, drawCurve, hollow, mark, markerSvg } from "./ink.js";
import { drawSkewt, slanted } from "./skewt.js";
import { explained } from "./notes.js";
import { numbers, phrase, word } from "./words.js";

const ORDER = { reference: 0, environment: 1, data: 2, theory: 3, prediction: 4 };
const font = (size) => `${size}px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif`;

export class Graph {
  // `seek` is called with the time at which a graph over time was clicked; `whole` tells that the curves are complete
  // from the start, so that the part after the present time must be veiled.
  constructor(parent, panel, { runs = 1, seek = null, whole = false } = {}) {
    Object.assign(this, { panel, runs, seek, whole, curves: [], fixed: null, time: null, guided: true });
    this.element = document.createElement("figure");
    this.element.className = `graph ${panel.kind}`;
    this.element.innerHTML = "<figcaption><strong></strong><span class='sentences'></span></figcaption>"
      + "<div class='heads'><span class='unit up'></span><span class='key'></span></div><div class='plot'></div>"
      + "<span class='unit along'></span>";
    this.part = (name) => this.element.querySelector(name);
    this.part("strong").textContent = phrase(panel.title);
    this.say(panel.sentences);
    this.overTime = !panel.across && panel.kind === "line" && panel.lines?.every(({ x }) => x.name === "elapsed_time");
    parent.append(this.element);
    this.veil = Object.assign(document.createElement("div"), { className: "veil" });
    this.dots = [];
    this.waiting = Object.assign(document.createElement("p"), { className: "first", textContent: word("first_numbers") });
    this.#begin();
  }

  say(sentences) {
    const line = this.part(".sentences"), said = sentences.join();
    if (said === this.said) return;
    this.said = said;
    line.replaceChildren();
    line.title = sentences.map((sentence) => numbers(phrase(sentence))).join("\n");
    for (const sentence of sentences) {
      const [words, number] = sentence.split(" = "); // the number first, because a narrow graph cuts off the end
      const bold = Object.assign(document.createElement("b"), { textContent: numbers(number ?? "") });
      line.append(bold, ` ${phrase(words)} `);
    }
  }

  #begin() {
    const grown = (axis) => ({
      scale: axis, font: font(scaled(12)), stroke: () => look().faint, gap: 4, size: axis === "x" ? scaled(24) : this.#width.bind(this),
      grid: { stroke: () => look().grid, width: 1, show: this.panel.kind !== "skewt" }, ticks: { stroke: () => look().grid, width: 1, size: 4 },
      splits: (plot) => this.#ticks(axis, plot).map(this.to[axis]),
      values: (plot) => this.#texts(axis, plot),
    });
    this.to = { x: this.#scale(this.panel.x), y: this.#scale(this.panel.y) };
    this.range = { x: [0, 1], y: [0, 1] };
    const plot = this.part(".plot");
    this.plot = new uPlot({
      width: 300, height: 150, legend: { show: false }, padding: [8, 14, 0, 4],
      cursor: { show: true, x: false, y: false, points: { show: false }, drag: { setScale: false, x: false, y: false } },
      scales: Object.fromEntries(["x", "y"].map((axis) => [axis, {
        time: false, auto: true, dir: this.panel[axis].invert ? -1 : 1, range: () => this.range[axis],
      }])),
      axes: [grown("x"), { ...grown("y"), side: 3 }],
      series: [{}, { paths: () => null, points: { show: false } }],
      hooks: { draw: [() => this.#draw()] },
    }, [[0, 1], [0, 1]], plot);
    this.plot.over.append(this.veil);
    plot.append(this.waiting);
    if (this.overTime && this.seek) {
      this.plot.over.style.cursor = "pointer";
      this.plot.over.addEventListener("click", (event) => {
        const place = this.plot.posToVal(event.offsetX, "x");
        this.seek(this.panel.x.log ? 10 ** place : place);
      });
    }
    new ResizeObserver(() => this.resize()).observe(plot);
  }

  #scale({ log }) {
    return log ? Math.log10 : (value) => value;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.part(".plot");
    if (width > 40 && height > 40) this.plot.setSize({ width, height });
    this.at(this.time);
  }

  // The numbers on an axis, as many as there is room for.
  #ticks(axis, plot) {
    if (!this.held) return []; // an axis without curves has no ticks
    const { log } = this.panel[axis];
    const [low, high] = this.range[axis].map((value) => (log ? 10 ** value : value));
    const room = axis === "x" ? (plot.width - scaled(60)) / scaled(52) : (plot.height - scaled(32)) / scaled(30);
    return (log ? logTicks : ticks)(low, high, Math.max(2, room));
  }

  #texts(axis, plot) {
    const { texts, power } = tickTexts(this.#ticks(axis, plot));
    const { label, unit } = this.panel[axis];
    if (axis === "x" && this.panel.kind === "atmosphere") return texts.map(() => ""); // the horizontal axis has no scale
    const words = [powerText(power), unit].filter(Boolean).join(" ");
    const text = words ? `${phrase(label)} (${words})` : phrase(label);
    const spot = this.part(axis === "x" ? ".along" : ".up");
    if (spot.textContent !== text) spot.textContent = text;
    return texts;
  }

  #width(self, texts) {
    return 14 + scaled(7) * Math.max(2, ...(texts ?? []).map((text) => text?.length ?? 0));
  }

  // Set the curves that the graph shows.
  set(curves) {
    this.curves = curves.toSorted((first, second) => ORDER[first.role] - ORDER[second.role]);
    this.#measure();
    this.#key();
    this.plot.setData([this.range.x, this.range.y]);
    this.at(this.time);
  }

  repaint() {
    this.#key();
    this.plot.redraw(false);
  }

  #measure() {
    const known = { x: [], y: [] }, { kind, planned, start, limits, across } = this.panel;
    const inside = (value, [one, other = 1e300] = []) => one === undefined || (value - one) * (value - other) <= 0;
    const add = (x, y) => {
      if (!Number.isFinite(x) || !Number.isFinite(y) || !inside(x, limits?.x) || !inside(y, limits?.y)) return;
      known.x.push(x);
      known.y.push(y);
    };
    const histogram = kind === "histogram"; // its axis ends where data and theory are negligible
    const least = histogram ? 1e-3 * Math.max(0, ...this.curves.flatMap(({ y }) => y.filter(Number.isFinite))) : -Infinity;
    for (const { x, y, error, from } of this.curves) {
      const last = histogram ? y.findLastIndex((value) => value > least) : x.length - 1;
      for (let index = 0; index <= last; index += 1) {
        const spread = Number.isFinite(error?.[index]) ? error[index] : 0;
        for (const sign of spread ? [-1, 1] : [0]) add(x[index] + (across ? sign * spread : 0), y[index] + (across ? 0 : sign * spread));
      }
      if (from) add(...from);
    }
    const measured = known.y.length > 0;
    if (start?.length && kind !== "atmosphere" && (start[0] || !this.panel.x.log)) add(...start);
    planned?.x.forEach((x, place) => add(x, planned.y[place]));
    this.held = measured || known.y.length > 1; // the start alone makes no axes
    this.waiting.hidden = this.held;
    if (kind === "skewt" && known.y.length) {
      this.foot = Math.max(...known.y) * 1.02;
      known.x = known.x.map((value, index) => slanted(value, known.y[index], this.foot));
    }
    for (const axis of ["x", "y"]) {
      const { log } = this.panel[axis];
      const values = known[axis].map(this.to[axis]).filter(Number.isFinite);
      let low = Infinity, high = -Infinity;
      for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
      if (!(high >= low)) [low, high] = [0, 1];
      if (high === low) [low, high] = [low - 0.5, high + 0.5];
      let margin = axis === "y" ? (kind === "line" ? 0.07 : 0.03) : (kind === "profile" ? 0.06 : kind === "skewt" ? 0.1 : 0);
      if (kind === "histogram") [low, margin] = [axis === "y" ? 0 : Math.max(0, low), 0.03];
      const floor = !log && low >= 0 && low < 0.2 * high && (kind === "profile" || (axis === "x" && kind === "line"));
      const span = high - low;
      const [least, most] = limits?.[axis].map(this.to[axis]).toSorted((one, other) => one - other) ?? [];
      const lower = floor || (kind === "histogram" && low === 0) ? Math.min(low, 0) : low - margin * span;
      this.range[axis] = [least ?? lower, most ?? high + margin * span];
    }
    if (this.fixed) Object.assign(this.range, this.fixed);
    if (kind === "atmosphere" && known.y.length) {
      const high = Math.max(...known.y, 1e-3);
      this.range.y = [-0.12 * high, (this.curves.some(({ way }) => way.crosses) ? 1.4 : 1.1) * high];
    }
    if (kind === "skewt" && known.y.length) {
      this.range.y = [Math.log10(Math.min(...known.y) / 1.02), Math.log10(this.foot)];
    }
  }

  // The legend. If there are two runs, the colour tells the run, and the dashes tell the curve.
  #key() {
    const key = this.part(".key"), told = JSON.stringify(this.curves.map((curve) => [curve.label, this.colour(curve), curve.faint]));
    if (told === this.keyed) return;
    this.keyed = told;
    key.replaceChildren();
    const named = new Set();
    for (const curve of this.curves) {
      const dashes = curveDash(curve.role, curve.index).join(" "), name = `${curve.label} ${dashes}`;
      if (named.has(name)) continue;
      named.add(name);
      const item = document.createElement("span");
      const colour = this.runs > 1 ? look().faint : this.colour(curve);
      const wide = curve.role === "reference" ? 5 : 2.2;
      item.innerHTML = `<svg width="24" height="10" aria-hidden="true"><line x1="1" y1="5" x2="23" y2="5" stroke="${colour}" `
        + `stroke-width="${wide}" stroke-dasharray="${dashes}"/>${this.#several(curve) ? markerSvg(curve.index, colour) : ""}</svg>`;
      item.append(explained(curve.label), ...(curve.faint ? [`\u00a0(${word("settling")})`] : []));
      key.append(item);
    }
    if (!this.panel.areas) return;
    ["CAPE", "CIN"].forEach((name, index) => {
      const swatch = Object.assign(document.createElement("i"), { className: "swatch" });
      swatch.style.background = curveColour("reference", index);
      const item = document.createElement("span");
      item.append(swatch, explained(name));
      key.append(item);
    });
  }

  colour({ role, index, run = 0 }) {
    return this.runs > 1 ? curveColour("data", run) : curveColour(role, index);
  }

  #several({ role, run = 0, steps }) {
    return role === "data" && !steps
      && this.curves.filter((curve) => curve.role === "data" && (curve.run ?? 0) === run).length > 1;
  }

  // Position on the canvas [pixel] of a point in the units of the panel.
  #spot(x, y) {
    const along = this.panel.kind === "skewt" ? slanted(x, y, this.foot) : this.to.x(x);
    return [this.plot.valToPos(along, "x", true), this.plot.valToPos(this.to.y(y), "y", true)];
  }

  #draw() {
    const { ctx: context, bbox } = this.plot;
    const unit = uPlot.pxRatio;
    context.save();
    context.beginPath();
    context.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    context.clip();
    context.font = font(scaled(12) * unit);
    if (this.panel.kind === "skewt" && this.foot) {
      drawSkewt(context, this.panel, this.curves, this.foot, 10 ** this.range.y[0], (x, y) => this.#spot(x, y), unit);
    }
    this.#marks(context, bbox, unit);
    if (this.panel.areas && this.curves.length) drawAreas(context, this.curves[0], (x, y) => this.#spot(x, y), bbox);
    if (this.panel.kind === "atmosphere") {
      drawAtmosphere(context, bbox, this.curves, this.time, (height) => this.#spot(0, height)[1], unit);
      context.restore();
      return;
    }
    for (const curve of this.curves) drawCurve(context, curve, {
      spot: (x, y) => this.#spot(x, y), unit, across: this.panel.across, colour: this.colour(curve), several: this.#several(curve),
      floor: this.plot.valToPos(this.range.y[0], "y", true),
    });
    this.#guides(context, bbox, unit);
    context.restore();
    this.#start(context, bbox, unit);
  }

  // Thin lines across the graph, with texts away from the first curve.
  #guides(context, { left, top, width, height }, unit) {
    const curve = this.curves.find(({ role }) => role === "data"), { guides = [] } = this.held ? this.panel : {};
    context.strokeStyle = context.fillStyle = look().faint;
    context.lineWidth = unit;
    const asked = this.curves.every(({ role }) => role === "prediction");
    for (const [axis, value, words] of guides) {
      if (words && (asked || !this.guided)) continue; // it names a result of theory
      const text = phrase(words), gap = 4 * unit, [x, y] = this.#spot(value, value), upright = axis === "x";
      context.beginPath();
      context.moveTo(...(upright ? [x, top] : [left, y]));
      context.lineTo(...(upright ? [x, top + height] : [left + width, y]));
      context.stroke();
      const near = curve ? curve.x[curve.y.reduce((best, each, place) => (Math.abs(each - value) < Math.abs(curve.y[best] - value) ? place : best), 0)] : -Infinity;
      const right = !upright && !(this.#spot(near, value)[0] > left + 0.7 * width);
      context.textAlign = right ? "right" : "left";
      context.fillText(text, upright ? x + gap : right ? left + width - gap : left + gap, upright ? top + height - gap : y - gap);
    }
  }

  // A ring where the curves begin.
  #start(context, { left, top, width }, unit) {
    const { start = [], x: axis } = this.panel;
    const [x, y] = this.curves.find(({ from }) => from)?.from ?? (start[0] || !axis.log ? start : []);
    if (y === undefined || !this.held) return;
    context.save();
    context.font = font(scaled(12) * unit);
    const spot = this.#spot(x, y), before = spot[0] > left + 0.8 * width;
    context.fillStyle = context.strokeStyle = look().ink;
    mark(context, spot, 0, 1.5 * unit);
    hollow(context, unit);
    context.textAlign = before ? "right" : "left";
    context.fillText(word("start"), spot[0] + (before ? -8 : 8) * unit, spot[1] + (spot[1] < top + 16 * unit ? 14 : before ? 0 : -6) * unit);
    context.restore();
  }

  #marks(context, bbox, unit) {
    let above = -Infinity;
    for (const [name, pressure] of Object.entries(this.panel.marks ?? {}).toSorted((one, other) => one[1] - other[1])) {
      const [, y] = this.#spot(0, pressure);
      const under = y - above < 15 * unit; // the lower of two close levels has its name below it
      above = y;
      context.strokeStyle = context.fillStyle = look().ink;
      context.lineWidth = unit;
      context.beginPath();
      context.moveTo(bbox.left + bbox.width - 34 * unit, y);
      context.lineTo(bbox.left + bbox.width, y);
      context.stroke();
      context.textAlign = "right";
      context.fillText(name, bbox.left + bbox.width - 3 * unit , y + (under ? 13 : -4) * unit);
    }
  }

  // Show a time on the graph: the later part is veiled, or a dot moves along the curves.
  at(time) {
    this.time = time;
    if (time === null) return;
    if (this.panel.kind === "atmosphere") this.plot.redraw(false);
    if (this.overTime && this.whole) {
      const place = this.to.x(time), [low, high] = this.range.x;
      const left = this.plot.valToPos(Math.min(Math.max(Number.isFinite(place) ? place : low, low), high), "x");
      this.veil.style.display = "block";
      this.veil.style.left = `${left}px`;
    }
    const followed = this.panel.across ? this.curves.filter(({ role, instants }) => role === "data" && instants) : [];
    followed.forEach((curve, number) => {
      this.dots[number] ??= this.plot.over.appendChild(Object.assign(document.createElement("div"), { className: "dot" }));
      const index = latest(curve.instants, time);
      const [x, y] = this.#spot(curve.x[index], curve.y[index]);
      const unit = uPlot.pxRatio, { left, top } = this.plot.bbox;
      this.dots[number].style.display = Number.isFinite(x) && Number.isFinite(y) ? "block" : "none";
      this.dots[number].style.background = this.colour(curve);
      this.dots[number].style.transform = `translate(${(x - left) / unit}px, ${(y - top) / unit}px)`;
    });
    for (const spare of this.dots.slice(followed.length)) spare.style.display = "none";
  }
}

function latest(instants, time) {
  let low = 0, high = instants.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (instants[middle] <= time) low = middle; else high = middle - 1;
  }
  return low;
}

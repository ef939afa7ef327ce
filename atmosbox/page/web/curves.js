// From the values of a run, in SI, to the curves of a graph in the units that are shown.

import { wayOf } from "./atmosphere.js";

const WALLS = ["x_low", "x_high", "y_low", "y_high", "z_low", "z_high"];

// The values of a run by name. Those that are functions of time may grow while the page is open.
export class Numbers {
  constructor({ values = {}, timed = [] } = {}) {
    this.values = { ...values };
    this.timed = new Set(timed);
    this.settling = new Set();
  }

  get(name) {
    return this.values[name];
  }

  // The temperatures of the six walls at a time, by default the latest; null where they are not known.
  walls(time = Infinity) {
    const times = this.values.elapsed_time ?? [];
    let index = times.findIndex((each) => each > time);
    index = Math.max(0, (index < 0 ? times.length : index) - 1);
    return WALLS.map((wall) => this.values[`wall_temperature[${wall}]`]?.[index] ?? null);
  }

  append(times, series) {
    const before = this.values.elapsed_time?.length ?? 0;
    this.values.elapsed_time = (this.values.elapsed_time ?? []).concat(times);
    this.timed.add("elapsed_time");
    for (const [name, added] of Object.entries(series)) {
      if (name === "elapsed_time") continue;
      const old = this.values[name] ?? new Array(before).fill(null);
      this.values[name] = old.concat(added);
      this.timed.add(name);
    }
  }

  // `settling` are the names of those that are averages of a box that is not yet in equilibrium.
  replace(arrays, settling = []) {
    this.settling = new Set(settling);
    for (const [name, values] of Object.entries(arrays)) {
      this.values[name] = Array.isArray(values) ? values : [values];
    }
  }

  clear() {
    this.values = {};
    this.timed.clear();
    this.settling.clear();
  }
}

const shown = (values, way) => values.map((value) => (value === null ? NaN : value * way.factor + way.offset));

// A single number beside a list of values is repeated along the list.
const along = (values, count) => (values.length === 1 && count > 1 ? new Array(count).fill(values[0]) : values);

// The curves of a panel for which the run has values.
export function curvesOf(panel, numbers) {
  if (panel.kind === "atmosphere") return wayOf(panel, numbers);
  const labels = {}; // of each role: curves of one label look alike
  const found = [];
  for (const line of panel.lines) {
    const known = (labels[line.role] ??= []);
    if (!known.includes(line.label)) known.push(line.label);
    const curve = curveOf(panel, line, numbers);
    if (curve) found.push({ ...curve, index: known.indexOf(line.label) });
  }
  return found;
}

function curveOf(panel, line, numbers) {
  if (line.planned) return { label: line.label, role: line.role, ...line.planned, error: null, steps: false, instants: null }; // known from the start
  const [across, up] = [numbers.get(line.x.name), numbers.get(line.y.name)];
  if (!across?.length || !up?.length) return null;
  const count = Math.max(across.length, up.length);
  const x = along(shown(across, line.x), count), y = along(shown(up, line.y), count);
  const faint = numbers.settling.has(line.x.name) || numbers.settling.has(line.y.name);
  const spread = faint || !line.error ? null : numbers.get(line.error.name);
  if (line.worst && spread?.some(Number.isFinite)) { // a temperature that is hardly known is not drawn
    const values = panel.across ? across : up, draw = panel.across ? x : y;
    values.forEach((value, place) => {
      if (spread[place] === null || !(spread[place] <= line.worst * value)) draw[place] = NaN;
    });
  }
  const error = spread?.length ? along(shown(spread, line.error), count) : null;
  const timed = numbers.timed.has(line.x.name) || numbers.timed.has(line.y.name);
  const clean = (values, { log }) => (log ? values.map((value) => (value > 0 ? value : NaN)) : values);
  let curve = { label: line.label, role: line.role, x: clean(x, panel.x), y: clean(y, panel.y), error, faint };
  curve.steps = panel.kind === "histogram" && line.role === "data";
  curve.instants = timed && panel.across ? numbers.get("elapsed_time") : null;
  if (panel.averages && line.role === "data" && !error) curve = { ...curve, ...averaged(curve, panel), whole: { x, y } };
  return { ...curve, from: startOf(curve, panel) };
}

// The point from which a curve is drawn, before the first frame; null if the panel does not know it.
function startOf({ role, x }, { kind, start, x: axis }) {
  const begins = role === "data" || (kind === "profile" && (role === "theory" || role === "environment"));
  if (!start?.length || !begins || !x.length) return null;
  return [start[0] || !axis.log ? start[0] : x.find(Number.isFinite) / 2, start[1]]; // half a frame from the first on a logarithmic axis
}

// Means of x and y over equal parts of the x axis that contain values, and the scatter of y in each.
function averaged({ x, y }, panel) {
  const place = panel.x.log ? Math.log : (value) => value;
  const known = x.map((value, index) => index).filter((index) =>
    Number.isFinite(x[index]) && Number.isFinite(y[index]) && (!panel.x.log || x[index] > 0));
  if (known.length < 2) return { x, y, error: null };
  const low = place(x[known[0]]), span = place(x[known.at(-1)]) - low;
  if (!(span > 0)) return { x, y, error: null };
  const parts = Array.from({ length: panel.averages }, () => [0, 0, 0, 0]);
  for (const index of known) {
    const part = parts[Math.min(Math.floor((place(x[index]) - low) / span * panel.averages), panel.averages - 1)];
    part[0] += 1;
    part[1] += x[index];
    part[2] += y[index];
    part[3] += (y[index] - y[known[0]]) ** 2; // about the first value, so that no digits are lost
  }
  const held = parts.filter(([number]) => number > 0);
  const means = held.map(([number, , sum]) => sum / number);
  const error = held.map(([number, , , sum], place) => Math.sqrt(Math.max(0, sum / number - (means[place] - y[known[0]]) ** 2)));
  return { x: held.map(([number, sum]) => sum / number), y: means, error };
}

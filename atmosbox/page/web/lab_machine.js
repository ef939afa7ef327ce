// The engine of a lab: memory, kernels by name, tables of theory, and time series without a limit of time.

"use strict";

const TYPES = { float64: Float64Array, int64: BigInt64Array, uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array,
  uint64: BigUint64Array, float32: Float32Array, int32: Int32Array };
const MOST = 4000; // points of a series; at more points, every second one is removed

const bytesOf = (text) => Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
const inflated = async (bytes) =>
  new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer());

// The kernels and their memory.
class Machine {
  static async of(module, { plan, stored }) {
    const memory = new WebAssembly.Memory({ initial: Math.ceil(plan.size / 65536) });
    const kernels = (await WebAssembly.instantiate(module, { env: { memory } })).exports;
    return Object.assign(new Machine(), { memory, plan, kernels, view: new DataView(memory.buffer), stored });
  }

  // Set the memory to the state of the box at its start.
  restore() {
    const all = new Uint8Array(this.memory.buffer);
    all.fill(0, this.plan.base);
    let from = 0;
    for (const [place, length] of this.plan.pieces) {
      all.set(this.stored.subarray(from, from + length), place);
      from += length;
    }
  }

  array(name) {
    const [place, length, type] = this.plan.arrays[name];
    return new TYPES[type](this.memory.buffer, place, length);
  }

  set(kernel, argument, value) {
    const place = this.plan.slots[kernel][argument];
    if (typeof value === "bigint") this.view.setBigInt64(place, value, true);
    else this.view.setFloat64(place, value, true);
  }

  get(kernel, argument) {
    return this.view.getFloat64(this.plan.slots[kernel][argument], true);
  }

  // Set a number that is an argument of several kernels.
  setAll(argument, value) {
    for (const [kernel, slots] of Object.entries(this.plan.slots)) if (argument in slots) this.set(kernel, argument, value);
  }

  call(kernel) {
    const block = this.plan.blocks[kernel];
    if (this.kernels[kernel](block)) throw new Error(`${kernel} has failed`);
    return Number(this.view.getBigInt64(block, true));
  }
}

// A plan, completed by the first one; an entry under "=" replaces the entry of the first plan as a whole.
function merged(own, first) {
  if (Array.isArray(own)) return own.length === first?.length ? own.map((each, place) => merged(each, first[place])) : own;
  if (own === null || typeof own !== "object" || first === null || typeof first !== "object") return own;
  if ("=" in own) return own["="];
  const news = Object.entries(own).map(([name, value]) => [name, merged(value, first[name])]);
  return { ...first, ...Object.fromEntries(news) };
}

// The starts of a page, by their settings or by title: the plan and the contents of the memory of each. A plan holds
// only its differences from the first plan. A page that Python serves has one start, and gets others from there.
class Starts {
  static async of({ starts, module, stored }) {
    const all = await inflated(bytesOf(stored)), found = new Map();
    let at = 0;
    const first = () => JSON.parse(new TextDecoder().decode(all.subarray(0, starts[0][1])));
    for (const [key, said, held] of starts) {
      const from = at;
      found.set(key, () => ({ plan: merged(JSON.parse(new TextDecoder().decode(all.subarray(from, from + said))), first()),
        stored: all.subarray(from + said, from + said + held) }));
      at += said + held;
    }
    return Object.assign(new Starts(), { found, first: starts[0][0], values: first().start, module: await WebAssembly.compile(await inflated(bytesOf(module))) });
  }

  has(key) {
    return this.found.has(key);
  }

  // The key of the first start whose plan fits.
  find(fits) {
    return [...this.found.keys()].find((key) => fits(this.found.get(key)().plan));
  }

  async machine(key) {
    return Machine.of(this.module, this.found.get(String(key))());
  }
}

// The values of the curves of a table at a value of its grid, by linear interpolation. If that value is not known at
// present, the result is the table's own entry `otherwise`.
function between({ grid, curves, otherwise }, value) {
  if (otherwise && !Number.isFinite(value)) return { ...otherwise };
  let high = grid.findIndex((each) => each >= value);
  if (high < 0) high = grid.length - 1;
  const low = Math.max(high - 1, 0), share = high > low ? Math.min((value - grid[low]) / (grid[high] - grid[low]), 1) : 0;
  const mix = (a, b) => {
    if (Array.isArray(a)) return a.map((each, place) => mix(each, b[place]));
    return a === null || b === null ? null : a + share * (b - a);
  };
  return Object.fromEntries(Object.entries(curves).map(([name, values]) => [name, mix(values[low], values[high])]));
}

// The curves of a table at the values of a row of measurements: see `tables` in atmosbox/lab/theory_table.py.
function curvesAt({ along, over, times = {}, ...table }, row) {
  const found = between(table, over ? row[along] / row[over] : row[along]);
  for (const [name, variable] of Object.entries(times)) {
    const scaled = (value) => (value === null ? null : value * row[variable]);
    if (name in found) found[name] = Array.isArray(found[name]) ? found[name].map(scaled) : scaled(found[name]);
  }
  return found;
}

const brief = (value) => (Number.isFinite(value) ? Number(value.toPrecision(7)) : null);

// A time series without a limit of time, with at most as many points as a graph can show.
class Trace {
  constructor() {
    Object.assign(this, { rows: [], every: 1, count: 0, sent: 0, reset: true });
  }

  add(row) {
    this.count += 1;
    if (this.count % this.every) return;
    this.rows.push(row);
    if (this.rows.length <= MOST) return;
    this.rows = this.rows.filter((_, place) => place % 2);
    Object.assign(this, { every: 2 * this.every, sent: 0, reset: true });
  }

  column(name, from = 0) {
    return this.rows.slice(from).map((row) => brief(row[name]));
  }
}

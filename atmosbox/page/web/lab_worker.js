// The box in a worker, and its messages to the page. It follows lab_machine.js in the same script.
//
// This file contains no physics. A plan, which Python has written, tells what each kernel returns and where its numbers
// are, and holds the factors from the units of the engine to SI and the tables of the curves of theory.

const PERIOD = 1000 / 60, SHARE = 0.8; // ms between two pictures, and the share of that time for the engine
const MEASURE = 250, STATE = 500; // ms between two messages with measurements, and between two with the state of the box
const EVENTS = 4000; // collisions and other events between two readings of the clock
const FRAMES = 40; // of which a gauge knows the scatter
const WALLS = ["x_low", "x_high", "y_low", "y_high", "z_low", "z_high"];
const DRAG = 1500; // ms within which movements of a slider are one change
const STEP = 0.04; // real time that one step shows [s]
const SLOWEST = 0.25, FASTEST = 16;
const [DONE, BUSY] = [0, 1];
const WHY = { 2: "events pile up without end", 3: "more molecules have come together than its cells have room for",
  4: "the piston would crush the molecules", 5: "a molecule that evaporates finds no free place" };

const say = (message) => postMessage(message);
const refuse = (text) => say({ type: "note", level: "error", text });

class Box {
  // `served` says whether Python serves the page, and makes plans of other boxes.
  constructor(starts, machine, served) {
    Object.assign(this, { starts, served, start: starts.first, past: [], playing: false, pace: 1, watched: true, turned: [], seed: machine.plan.seed });
    this.take(machine);
    this.begin();
    this.greet();
    const beat = () => {
      const begun = performance.now();
      this.beat(begun);
      setTimeout(beat, Math.max(0, PERIOD - (performance.now() - begun)));
    };
    beat();
  }

  // ---------------------------------------------------------------- a box

  take(machine) {
    Object.assign(this, { machine, plan: machine.plan, told: machine.plan.told });
    if (!this.plan.seeded || this.served) this.seed = this.plan.seed;
  }

  begin() {
    const { machine } = this;
    machine.restore();
    if (this.plan.seeded) {
      machine.set("start", "4", BigInt(this.seed));
      if (machine.call("start") !== DONE) throw new Error("the molecules find no room");
    }
    if (machine.call("place") !== DONE) throw new Error("the molecules do not fit into their cells");
    machine.call("begin");
    machine.call("begin_averages_anew");
    Object.assign(this, { now: 0, led: false, frame: 0, sample: 1, since: 0, sequence: 0, finished: false, failed: false, turned: [], pictures: [],
      past: this.past.filter(({ start }) => start !== undefined),
      fastest: this.plan.fastest, trace: new Trace(), drawn: 0, measured: 0, stated: 0, fresh: false, arrays: null });
    this.knobs = Object.fromEntries(this.told.controls.map(({ name, value }) => [name, value]));
  }

  greet() {
    const { stage } = this.told, { seed } = this;
    const settings = stage.settings.map(([name, text]) => [name, name === "seed" ? String(seed) : text]);
    say({ type: "stage", ...this.told, stage: { ...stage, seed, settings }, controls: this.controls(), state: this.state() });
    this.look();
    say(this.state());
  }

  controls() {
    return this.told.controls.map((each) => ({ ...each, value: this.knobs[each.name] }));
  }

  state() {
    const reading = this.machine.array("gauges.reading"), { pictures } = this;
    const rate = pictures.length > 2 ? (pictures.length - 1) / (pictures.at(-1) - pictures[0]) * 1000 : 0;
    return { type: "state", playing: this.playing, pace: this.pace, time: this.now * this.plan.time,
      frame: this.frame, seed: this.seed, seeded: this.plan.seeded, finished: this.finished, ledger: reading[this.plan.ledger],
      molecules: this.plan.present === null ? this.plan.molecules : reading[this.plan.present], rate: Math.round(rate * 10) / 10, busy: null, walls: this.walls(), gauges: this.gauges(),
      undo: this.past.length > 0 };
  }

  // The present temperatures of the walls [K].
  walls() {
    const found = this.trace.rows.at(-1) ?? {};
    return WALLS.map((wall, place) => brief(found[`wall_temperature[${wall}]`] ?? NaN) ?? this.told.stage.box.wall_temperature[place]);
  }

  // The readings of the gauges: those of the latest frame, and by how much they scatter from frame to frame. That is the
  // scatter that theory expects or, without one, the standard deviation of the latest frames; of an ascent there is none.
  gauges() {
    const rows = this.trace.rows.slice(-FRAMES), last = rows.at(-1) ?? {};
    return this.plan.gauges.flatMap(({ name, variable, unit, factor, offset, few }) => {
      const seen = rows.filter((row) => !few || row[few[0]] >= few[1] * row[variable]).map((row) => row[variable]).filter(Number.isFinite);
      if (!seen.length) return [];
      const mean = seen.reduce((sum, value) => sum + value, 0) / seen.length;
      const steady = !this.plan.ends && this.frame - this.since >= FRAMES + this.plan.settle && seen.length === FRAMES;
      const measured = steady ? Math.sqrt(seen.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (FRAMES - 1)) : NaN;
      return [{ name, unit, value: Number((seen.at(-1) * factor + offset).toPrecision(4)), spread: brief((last[`${variable}_noise`] ?? measured) * factor) }];
    });
  }

  // ---------------------------------------------------------------- time

  // The time of the next sample of the present frame.
  moment() {
    const { frame: length, samples } = this.plan;
    return this.sample === samples ? (this.frame + 1) * length : (this.frame + this.sample / samples) * length;
  }

  // Let time pass until `goal`, or until the deadline of the real clock.
  pass(goal, deadline) {
    const { machine } = this;
    while (this.now < goal) {
      const due = this.moment(), until = Math.min(goal, due);
      machine.set("pass_time", "4", until);
      machine.set("pass_time", "5", BigInt(EVENTS));
      const passed = machine.call("pass_time");
      if (passed === BUSY) {
        if (performance.now() > deadline) return;
        continue;
      }
      if (passed !== DONE) {
        this.playing = false;
        this.failed = true;
        refuse(`The box cannot go on: ${WHY[passed]}. Begin again.`);
        return;
      }
      this.now = until;
      if (until === due && !this.measure()) return;
      if (performance.now() > deadline) return;
    }
  }

  // Let the instruments sample the box; return whether to go on.
  measure() {
    const { machine, plan } = this;
    machine.call("sample");
    this.sample += 1;
    if (this.sample <= plan.samples) return true;
    machine.call("end_frame");
    Object.assign(this, { frame: this.frame + 1, sample: 1, fresh: true });
    if (this.frame - this.since > plan.settle) machine.call("note_frame");
    const reading = machine.array("gauges.reading"), row = {};
    for (const [name, place, factor] of plan.readings) row[name] = reading[place] * factor;
    for (const { along, times, ...table } of plan.tables) {
      for (const [name, value] of Object.entries(between(table, row[along]))) {
        if (!Array.isArray(value)) row[name] = times?.[name] ? value * row[times[name]] : value;
      }
    }
    if (this.led) for (const name of plan.planned) if (name in row) row[name] = NaN;
    this.trace.add(row);
    if (!plan.ends || this.frame !== plan.frames) return true;
    Object.assign(this, { playing: false, finished: true });
    say({ type: "note", level: "info", text: "The parcel has reached the end of its path: begin again." });
    return false;
  }

  // ---------------------------------------------------------------- what is shown

  beat(now) {
    const passed = Math.min(now - (this.before ?? now), 100) / 1000;
    this.before = now;
    if (!this.playing || !this.watched) return;
    this.pass(this.now + passed * this.plan.rate * this.pace, now + SHARE * PERIOD);
    this.look();
    this.pictures = this.pictures.filter((time) => time > now - 2000).concat(now);
    if (now - this.measured > MEASURE) {
      this.tell();
      this.measured = now;
    }
    if (now - this.stated > STATE || !this.playing) {
      say(this.state());
      this.stated = now;
    }
  }

  // Let the scale of speeds follow the temperature of gas and walls; it changes only if the box is too warm or too cold.
  rescale() {
    const { machine, plan: { scale } } = this, kelvin = [this.trace.rows.at(-1)?.air_temperature, ...this.walls()].filter(Number.isFinite);
    if (!scale || !kelvin.length) return;
    const wanted = scale.swift * Math.sqrt(Math.max(...kelvin)), power = 10 ** Math.floor(Math.log10(wanted));
    if (!(wanted > this.fastest || wanted < scale.colder * this.fastest)) return;
    this.fastest = Number((scale.round.find((step) => step * power >= wanted) * power).toPrecision(6));
    machine.set("look", "2.highest", this.fastest / scale.unit);
  }

  // Send a frame: see atmosbox/page/frame.py.
  look() {
    const { machine, plan } = this;
    this.rescale();
    machine.call("look");
    const place = machine.array("sight.place"), colour = machine.array("sight.colour"), count = colour.length;
    const drops = machine.array("sight.drops").subarray(0, 4 * Number(machine.array("sight.many")[0]));
    const buffer = new ArrayBuffer(32 + 8 * count + 4 + 4 * drops.length), view = new DataView(buffer);
    view.setUint32(0, (this.sequence += 1), true);
    view.setFloat64(4, this.now * plan.time, true);
    machine.array("sight.length").forEach((side, axis) => view.setFloat32(12 + 4 * axis, side * plan.length, true));
    view.setUint32(24, count, true);
    view.setFloat32(28, this.fastest, true);
    new Uint16Array(buffer, 32, 3 * count).set(place);
    new Uint8Array(buffer, 32 + 6 * count, count).set(colour);
    new Uint8Array(buffer, 32 + 7 * count, count).set(machine.array("sight.state"));
    view.setUint32(32 + 8 * count, drops.length / 4, true);
    drops.forEach((each, place) => view.setFloat32(36 + 8 * count + 4 * place, each, true));
    postMessage(buffer, [buffer]);
  }

  // Send new values for the graphs.
  tell() {
    const { plan, trace, machine } = this;
    if (!this.fresh) return;
    this.fresh = false;
    const values = { ...plan.fixed }, last = trace.rows.at(-1) ?? {};
    for (const [name, array, from, count, factor] of plan.profiles) {
      const shown = Array.from(machine.array(array).subarray(from, from + count), (value) => brief(value * factor));
      if (shown.some((value) => value !== null)) values[name] = shown;
    }
    for (const { along, ...table } of plan.tables) {
      for (const [name, row] of Object.entries(between(table, last[along]))) if (Array.isArray(row)) values[name] = this.led && plan.planned.includes(name) ? [] : row.map(brief);
    }
    if (plan.whole) {
      for (const name of Object.keys(last)) values[name] = trace.column(name);
    } else {
      const told = Object.keys(last).filter((name) => name !== "elapsed_time");
      say({ type: "series", reset: trace.reset, time: trace.column("elapsed_time", trace.sent),
        values: Object.fromEntries(told.map((name) => [name, trace.column(name, trace.sent)])) });
      Object.assign(trace, { sent: trace.rows.length, reset: false });
    }
    if (Object.keys(values).length) say({ type: "arrays", values });
    if (plan.wind) say({ type: "wind", ...plan.wind, values: Array.from(machine.array("gauges.flow.wind"), (value) => value * plan.wind.factor) });
  }

  // ---------------------------------------------------------------- requests of the page

  async obey(message) {
    const { type, value, name } = message;
    if (type === "set" && this.told.controls.some((each) => each.name === name && each.restarts)) await this.choose(name, value);
    else if (type === "preset") await this.try(message.number);
    else if (type === "play") {
      if (this.failed) this.again();
      this.finished = false;
      this.playing = true;
    } else if (type === "pause") this.playing = false;
    else if (type === "step") {
      this.playing = false;
      this.pass(this.now + STEP * this.plan.rate * this.pace, Infinity);
      this.look();
      this.tell();
    } else if (type === "reset") this.reseed(message.seed ?? this.seed);
    else if (type === "pace") this.pace = Math.min(Math.max(Number(value) || 1, SLOWEST), FASTEST);
    else if (type === "set") this.turn(name, value);
    else if (type === "undo") await this.undo();
    else if (type === "save") this.save();
    else if (type === "greet") { // the page was cleared, and asks for all that it showed
      Object.assign(this.trace, { sent: 0, reset: true });
      this.fresh = true;
      this.greet();
      this.tell();
    } else if (type === "watched") this.watched = message.is;
    else if (type === "frames") {
      while (this.frame < value && !this.failed) this.pass(this.moment(), Infinity);
      this.look();
      this.tell();
    } else if (type === "digest") this.digest();
    say(this.state());
  }

  // Begin the box of a start: in a file the start's key, on a page that Python serves all settings. Return whether it begins.
  async change(start) {
    const machine = this.served ? await this.planned(start) : await this.starts.machine(start);
    if (!machine) return false;
    const before = this.served ? this.settings() : this.start;
    this.take(machine);
    this.start = start;
    this.again();
    this.past.push({ start: before });
    return true;
  }

  // The machine of a box with other settings, which Python plans; null if it refuses them.
  async planned(settings) {
    say({ type: "state", busy: "The box is being built." });
    const told = await new Promise((answer) => {
      this.answer = answer;
      say({ type: "plan", settings });
    });
    if (told.refused) {
      refuse(told.refused);
      return null;
    }
    this.starts = await Starts.of(told);
    return this.starts.machine(this.starts.first);
  }

  // The settings of a box that begins with the present seed, and with knobs as they are now.
  settings() {
    const found = { ...this.plan.settings, seed: this.seed };
    for (const { name, value } of this.told.controls) {
      if (name in found && this.knobs[name] !== value) found[name] = this.knobs[name];
    }
    return found;
  }

  // Begin again with another setting that needs another box, such as the number of molecules. A file may not hold the
  // combination of this value with the present others: then the others become those with which the page was written, and
  // the reader is told so.
  async choose(name, value) {
    if (this.served) {
      await this.change({ ...this.settings(), [name]: value });
      return;
    }
    const { choices = [] } = this.told.controls.find((each) => each.name === name);
    if (!choices.includes(String(value))) {
      refuse(`${name} = ${value} is none of ${choices.join(", ")}: give one of these.`);
      return;
    }
    const key = (values) => Object.entries({ ...values, [name]: value }).map((pair) => pair.join("=")).join(", ");
    const [here, written] = [key(this.plan.start), key(this.starts.values)];
    const kept = this.starts.has(here) && !this.told.lesson.presets.includes(this.start);
    await this.change(this.starts.has(here) ? here : written);
    if (!kept) say({ type: "note", level: "info", text: "This page has no box with these settings together: all others are as the page was written." });
  }

  // Begin a preset; the first of the list is the box for which the page was written.
  async try(number) {
    const titles = this.told.lesson.presets;
    if (!(number in titles)) return;
    if (this.served) await this.change(this.plan.presets[number]);
    else await this.change(number === 0 ? this.starts.first : titles[number]);
  }

  // Begin again, with the same seed or with another one.
  reseed(seed) {
    if (this.plan.seeded && !(Number.isSafeInteger(seed) && seed >= 0)) {
      refuse(`seed = ${seed} is no whole number from 0 to ${Number.MAX_SAFE_INTEGER}: give one of these.`);
      return;
    }
    if (this.plan.seeded) this.seed = seed;
    this.again();
  }

  again() {
    this.begin();
    this.greet();
  }

  turn(name, asked) {
    const control = this.told.controls.find((each) => each.name === name);
    const value = typeof asked === "string" && asked.trim() === "" ? NaN : Number(asked);
    if (!control || !(value >= control.low && value <= control.high)) {
      refuse(control ? `${name} = ${asked} is no number from ${control.low} to ${control.high} ${control.unit}: give one of these.`
        : `${name} cannot be changed here.`);
      return;
    }
    const last = this.past.at(-1), now = performance.now();
    if (last?.name === name && now - last.when < DRAG) last.when = now;
    else this.past.push({ name, value: this.knobs[name], when: now });
    if (this.past.length > 200) this.past.shift();
    this.act(control, value);
  }

  // Set a knob to a value, or give it up so that the box is as before its first change.
  act(control, value, leaves = false) {
    const { name, unit } = control, knob = this.plan.knobs[name];
    if (leaves && knob.leave) this.machine.call(knob.leave);
    else {
      const asked = value * knob.factor + knob.offset;
      for (const [argument, wall] of Object.entries(knob.walls ?? {})) this.machine.set(knob.kernel, argument, BigInt(wall));
      this.machine.set(knob.kernel, knob.argument, knob.grid ? between(knob, asked).to : asked);
      this.machine.call(knob.kernel);
    }
    this.machine.call("begin_averages_anew");
    this.since = this.frame + 1;
    this.led = true;
    this.knobs[name] = value;
    if (this.finished) Object.assign(this, { playing: true, finished: false }); // it had stopped only at the end of its ascent
    this.turned.push(`# in frame ${this.frame + 1}, at ${this.now * this.plan.time} ${this.told.stage.time.unit}: ${name} = ${value} ${unit}`);
    if (this.turned.length > 5000) this.turned.shift();
    say({ type: "controls", controls: this.controls() });
  }

  async undo() {
    const last = this.past.at(-1);
    if (!last) return;
    if (last.start !== undefined) {
      if (await this.change(last.start)) this.past.splice(-2);
      return;
    }
    this.past.pop();
    const isFirst = !this.past.some(({ name }) => name === last.name);
    this.act(this.told.controls.find(({ name }) => name === last.name), last.value, isFirst);
  }

  // The command that begins the same run; its last word is the seed.
  command() {
    return this.plan.seeded ? this.plan.command.replace(/\d+$/, this.seed) : this.plan.command;
  }

  save() {
    const { rows, every } = this.trace, { units, frames } = this.plan, command = this.command();
    const names = Object.keys(rows[0] ?? {}).filter((name) => name in units);
    const repeats = this.frame > frames ? `repeats the first ${frames} frames of this run` : "repeats this run";
    const about = [`# ${command}`, ...this.turned.length ? ["# begins like this run; then these changes by hand", ...this.turned] : [`# ${repeats}`]];
    if (every > 1) about.push(`# every ${every}th frame`);
    const lines = [...about, `# units: ${names.map((name) => `${name} [${units[name]}]`).join(", ")}`, names.join(","),
      ...rows.map((row) => names.map((name) => row[name]).join(","))];
    say({ type: "file", name: `${this.told.stage.scene}-lab.csv`, text: `${lines.join("\n")}\n` });
  }

  async digest() {
    const parts = this.plan.state.map((name) => { const a = this.machine.array(name); return new Uint8Array(a.buffer, a.byteOffset, a.byteLength); });
    const found = await crypto.subtle.digest("SHA-256", await new Blob(parts).arrayBuffer());
    say({ type: "digest", sha256: Array.from(new Uint8Array(found), (byte) => byte.toString(16).padStart(2, "0")).join("") });
  }
}

let box = null;

async function hear(data) {
  try {
    if (data.type === "begin") {
      const starts = await Starts.of(data);
      box = new Box(starts, await starts.machine(starts.first), data.served);
    } else await box?.obey(data);
  } catch (error) {
    refuse(`The engine of this page has stopped: ${error.message}`);
    console.error(error);
  }
}

// Messages are handled one after the other, so that a new box is complete before the next request.
let heard = Promise.resolve();
onmessage = ({ data }) => {
  if (data.type === "planned") box.answer(data); // for the request that waits for it
  else heard = heard.then(() => hear(data));
};

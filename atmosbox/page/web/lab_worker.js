// The box in a worker, and its messages to the page. It follows lab_machine.js in the same script.
//
// This file contains no physics. A plan, which Python has written, tells what each kernel returns and where its numbers
// are, and holds the factors from the units of the engine to SI and the tables of the curves of theory.

const PERIOD = 1000 / 60, SHARE = 0.8; // ms between two pictures, and the share of that time for the engine
const MEASURE = 250; // ms between two messages with measurements and the state of the box
const EVENTS = 4000; // collisions and other events between two readings of the clock
const FRAMES = 40; // of which a gauge knows the scatter
const WALLS = ["x_low", "x_high", "y_low", "y_high", "z_low", "z_high"];
const DRAG = 1500; // ms within which movements of a slider are one change
const STEP = 0.04; // real time that one step shows [s]
const SLOWEST = 0.25, FASTEST = 16;
const [DONE, BUSY] = [0, 1];
const MOST_TURNS = 5000, LONGEST = 1_000_000; // turns of knobs, and frames, that a link can hold
const LINK = /^#(atmosbox=([\w.+-]+)&scene=([\w.%~-]+)([\w.%~&=-]*))&seed=(\d{1,16})(?:&turns=([\w:,.+-]+))?(?:&predict=(\w+):([\d.,e+-]+))?&frames=(\d{1,7})&end$/;
const TURN = /^(\d{1,7}):(\w+):(start|-?\d+(?:\.\d+)?(?:e[+-]?\d+)?)$/;
const WHY = { 2: "events pile up without end", 3: "more molecules have come together than its cells have room for",
  4: "the piston would crush the molecules", 5: "a molecule that evaporates finds no free place" };

const say = (message) => postMessage(message);
// A number rounded to 32 binary digits: see atmosbox/scene/rounding.py.
const rounded = (x) => x * (2 ** 21 + 1) - (x * (2 ** 21 + 1) - x);
const decoded = (text) => { try { return decodeURIComponent(text); } catch { return text; } };
const refuse = (text) => say({ type: "note", level: "error", text });

class Box {
  // `served` says whether Python serves the page, and makes plans of other boxes.
  constructor(starts, machine, served) {
    Object.assign(this, { starts, served, start: starts.first, past: [], playing: false, pace: 1, watched: true, prediction: null, pending: new Map(), seed: machine.plan.seed });
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
    if (JSON.stringify(machine.plan.told.lesson.predict?.draw) !== JSON.stringify(this.told?.lesson.predict?.draw)) this.prediction = null;
    Object.assign(this, { machine, plan: machine.plan, told: machine.plan.told });
    if (!this.plan.seeded || this.served) this.seed = this.plan.seed;
  }

  begin() {
    const { machine } = this;
    machine.restore();
    if (this.plan.seeded) {
      machine.set("start", "seed", BigInt(this.seed));
      if (machine.call("start") !== DONE) throw new Error("the molecules find no room");
    }
    if (machine.call("place") !== DONE) throw new Error("the molecules do not fit into their cells");
    machine.call("begin");
    machine.call("begin_averages_anew");
    Object.assign(this, { now: 0, led: false, frame: 0, sample: 1, since: 0, sequence: 0, finished: false, failed: false, turned: [], pictures: [], inside: false, coming: [],
      past: this.past.filter(({ start }) => start !== undefined),
      fastest: this.plan.fastest, trace: new Trace(), drawn: 0, measured: 0, fresh: false, arrays: null });
    this.pending.clear();
    this.knobs = Object.fromEntries(this.told.controls.map(({ name, value }) => [name, value]));
  }

  greet() {
    const { stage } = this.told, { seed } = this;
    say({ type: "stage", ...this.told, stage: { ...stage, seed }, controls: this.controls(), state: this.state(), prediction: this.prediction });
    this.look();
    say(this.state());
  }

  controls() {
    return this.told.controls.map((each) => ({ ...each, start: each.value, value: this.knobs[each.name] }));
  }

  state() {
    const reading = this.machine.array("gauges.reading"), { pictures } = this;
    const rate = pictures.length > 2 ? (pictures.length - 1) / (pictures.at(-1) - pictures[0]) * 1000 : 0;
    return { type: "state", playing: this.playing, pace: this.pace, time: this.now * this.plan.time,
      frame: this.frame, seed: this.seed, seeded: this.plan.seeded, finished: this.finished, ledger: reading[this.plan.ledger],
      molecules: reading[this.plan.present], rate: Math.round(rate * 10) / 10, busy: null, walls: this.walls(), gauges: this.gauges(),
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
      const seen = rows.map((row) => row[variable]).filter(Number.isFinite);
      if (!seen.length || (few && !(last[few[0]] >= few[1] * last[variable]))) return [];
      const mean = seen.reduce((sum, value) => sum + value, 0) / seen.length;
      const steady = !this.plan.ends && this.frame - this.since >= FRAMES + this.plan.settle && seen.length === FRAMES;
      const measured = steady ? Math.sqrt(seen.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (FRAMES - 1)) : NaN;
      return [{ name, unit, value: Number((seen.at(-1) * factor + offset).toPrecision(6)), spread: brief((last[`${variable}_noise`] ?? measured) * factor) }];
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
      if (!this.inside) this.turnKnobs();
      if (this.failed) return;
      const due = this.moment(), until = Math.min(goal, due);
      machine.set("pass_time", "until", until);
      machine.set("pass_time", "most", BigInt(EVENTS));
      const passed = machine.call("pass_time");
      if (passed === BUSY) {
        if (performance.now() > deadline) return;
        continue;
      }
      if (passed !== DONE) {
        this.stop(passed);
        return;
      }
      this.now = until;
      if (until === due && !this.measure()) return;
      if (performance.now() > deadline) return;
    }
  }

  // Stop a box that cannot go on.
  stop(why) {
    Object.assign(this, { playing: false, failed: true });
    refuse(`The box cannot go on: ${WHY[why]}. Begin again.`);
  }

  // Let the instruments sample the box; return whether to go on.
  measure() {
    const { machine, plan } = this;
    machine.call("sample");
    this.sample += 1;
    if (this.sample <= plan.samples) return true;
    machine.call("end_frame");
    Object.assign(this, { frame: this.frame + 1, sample: 1, fresh: true, inside: false });
    const passed = this.frame - this.since; // while the box settles, averages are over the last half of the time
    if (passed <= plan.settle ? Number.isInteger(Math.log2(passed)) : passed === plan.settle + 1) machine.call("begin_averages_anew");
    machine.call("note_frame");
    const reading = machine.array("gauges.reading"), row = {};
    for (const [name, place, factor] of plan.readings) row[name] = reading[place] * factor;
    for (const table of plan.tables) {
      for (const [name, value] of Object.entries(curvesAt(table, row))) if (!Array.isArray(value)) row[name] = value;
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
    if (now - this.measured > MEASURE || !this.playing) {
      this.report();
      this.measured = now;
    }
  }

  // Graphs, gauges and task show the same moment.
  report() {
    this.tell();
    say(this.state());
  }

  // Let the scale of speeds follow the temperature of gas and walls; it changes only if the box is too warm or too cold.
  rescale() {
    const { machine, plan: { scale } } = this, kelvin = [this.trace.rows.at(-1)?.air_temperature, ...this.walls()].filter(Number.isFinite);
    if (!scale || !kelvin.length) return;
    const wanted = scale.swift * Math.sqrt(Math.max(...kelvin)), power = 10 ** Math.floor(Math.log10(wanted));
    if (!(wanted > this.fastest || wanted < scale.colder * this.fastest)) return;
    this.fastest = Number((scale.round.find((step) => step * power >= wanted) * power).toPrecision(6));
    machine.set("look", "picture.highest", this.fastest / scale.unit);
  }

  // Send a frame: see atmosbox/page/frame.py.
  look() {
    const { machine, plan } = this;
    this.rescale();
    machine.call("look");
    const place = machine.array("picture.place"), colour = machine.array("picture.colour"), count = colour.length;
    const drops = machine.array("picture.drops").subarray(0, 4 * Number(machine.array("picture.many")[0]));
    const buffer = new ArrayBuffer(32 + 8 * count + 4 + 4 * drops.length), view = new DataView(buffer);
    view.setUint32(0, (this.sequence += 1), true);
    view.setFloat64(4, this.now * plan.time, true);
    machine.array("picture.length").forEach((side, axis) => view.setFloat32(12 + 4 * axis, side * plan.length, true));
    view.setUint32(24, count, true);
    view.setFloat32(28, this.fastest, true);
    new Uint16Array(buffer, 32, 3 * count).set(place);
    new Uint8Array(buffer, 32 + 6 * count, count).set(colour);
    new Uint8Array(buffer, 32 + 7 * count, count).set(machine.array("picture.state"));
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
    for (const table of plan.tables) {
      for (const [name, row] of Object.entries(curvesAt(table, last))) if (Array.isArray(row)) values[name] = this.led && plan.planned.includes(name) ? [] : row.map(brief);
    }
    if (plan.whole) {
      for (const name of Object.keys(last)) values[name] = trace.column(name);
    } else {
      const told = Object.keys(last).filter((name) => name !== "elapsed_time");
      say({ type: "series", reset: trace.reset, time: trace.column("elapsed_time", trace.sent),
        values: Object.fromEntries(told.map((name) => [name, trace.column(name, trace.sent)])) });
      Object.assign(trace, { sent: trace.rows.length, reset: false });
    }
    const settling = this.frame - this.since <= plan.settle ? plan.profiles.map(([name]) => name) : [];
    if (Object.keys(values).length) say({ type: "arrays", values, settling });
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
    } else if (type === "reset") this.reseed(message.seed ?? this.seed);
    else if (type === "pace") this.pace = Math.min(Math.max(Number(value) || 1, SLOWEST), FASTEST);
    else if (type === "set") this.turn(name, value);
    else if (type === "undo") await this.undo();
    else if (type === "predict") this.prediction = message.values;
    else if (type === "save") this.save();
    else if (type === "link") say({ type, link: this.link() });
    else if (type === "greet") { // the page was cleared, and asks for all that it showed
      Object.assign(this.trace, { sent: 0, reset: true });
      this.fresh = true;
      this.greet();
    } else if (type === "watched") this.watched = message.is;
    else if (type === "frames") {
      while (this.frame < value && !this.failed) this.pass(this.moment(), Infinity);
      this.look();
    } else if (type === "digest") this.digest();
    this.report();
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
    if (!kept) say({ type: "note", level: "info", text: "This page has no box with all these settings: the other settings are back at their first values." });
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
    const control = this.control(name);
    const value = typeof asked === "string" && asked.trim() === "" ? NaN : Number(asked);
    if (!control || !(value >= control.low && value <= control.high)) {
      refuse(control ? `${name} = ${asked} is no number from ${control.low} to ${control.high} ${control.unit}: give one of these.`
        : `${name} cannot be changed here.`);
      return;
    }
    const last = this.past.at(-1), now = performance.now();
    if (last?.name === name && now - last.when < DRAG) last.when = now;
    else this.past.push({ name, value: this.pending.has(name) ? this.pending.get(name) : this.given(name), when: now });
    if (this.past.length > 200) this.past.shift();
    this.ask(name, value);
  }

  // Turn a knob as soon as the next frame begins; `value` is null to restore the state before its first turn.
  ask(name, value) {
    this.pending.delete(name);
    if (value !== null || this.given(name) !== null) this.pending.set(name, value);
    this.knobs[name] = value ?? this.control(name).value;
    this.coming = []; // from now on the reader turns the knobs, and no longer a link
    if (this.finished) Object.assign(this, { playing: true, finished: false }); // it had stopped only at the end of its ascent
    say({ type: "controls", controls: this.controls() });
  }

  // The value to which a knob was last turned; null if it is as at the start.
  given(name) {
    return this.turned.findLast((each) => each.name === name)?.value ?? null;
  }

  control(name) {
    return this.told.controls.find((each) => each.name === name);
  }

  // Before a frame, turn the knobs that a link names for it, and those that the reader has moved.
  turnKnobs() {
    this.inside = true;
    while (this.coming[0]?.frame === this.frame) this.act(this.coming[0].name, this.coming.shift().value);
    for (const [name, value] of this.pending) this.act(name, value);
    this.pending.clear();
  }

  // Set a knob to a value in the units of the engine, by the same operations as Python, to the last bit.
  act(name, value) {
    const { machine, frame } = this, knob = this.plan.knobs[name], asked = value ?? this.control(name).value;
    if (value === null && knob.leave) machine.call(knob.leave);
    else {
      const si = asked * knob.up / knob.down + knob.offset;
      const found = knob.grid ? between(knob, si).to : si * knob.times / knob.over;
      for (const [argument, wall] of Object.entries(knob.walls ?? {})) machine.set(knob.kernel, argument, BigInt(wall));
      machine.set(knob.kernel, knob.argument, (knob.rounds ? rounded(found) : found) * (knob.end ?? 1));
      if (knob.everywhere) this.pull(knob);
      else machine.call(knob.kernel);
    }
    machine.call("begin_averages_anew");
    Object.assign(this, { since: frame, led: true });
    this.knobs[name] = asked;
    if (this.turned.length <= MOST_TURNS) this.turned.push({ frame, name, value });
    say({ type: "controls", controls: this.controls() });
  }

  // Change gravity: the kernel prepares the box, then all kernels have the new gravity, and the molecules are placed.
  pull({ kernel, argument, everywhere }) {
    const { machine } = this, gravity = machine.get(kernel, argument);
    if (gravity === machine.get(kernel, everywhere)) return;
    let done = machine.call(kernel);
    machine.setAll(everywhere, gravity);
    if (done === DONE) done = machine.call("place");
    if (done !== DONE) this.stop(done);
  }

  async undo() {
    const last = this.past.at(-1);
    if (!last) return;
    if (last.start !== undefined) {
      if (await this.change(last.start)) this.past.splice(-2);
      return;
    }
    this.past.pop();
    this.ask(last.name, last.value);
  }

  // The command that begins the same run; its last word is the seed.
  command() {
    return this.plan.seeded ? this.plan.command.replace(/\d+$/, this.seed) : this.plan.command;
  }

  // The text after # in an address that replays this run; null if it has become too long.
  link() {
    const next = this.frame + (this.inside ? 1 : 0), { pending } = this;
    const due = this.coming.filter(({ frame }) => frame <= this.frame); // of another link, before the next frame
    const turned = [...this.turned, ...due, ...Array.from(pending, ([name, value]) => ({ frame: next, name, value }))];
    if (turned.length > MOST_TURNS || this.frame > LONGEST) return null;
    const turns = turned.map(({ frame, name, value }) => `${frame}:${name}:${value ?? "start"}`).join();
    const drawn = this.prediction ? `&predict=${this.told.lesson.predict.draw.measured.name}:${this.prediction}` : "";
    return `#${this.plan.link}&seed=${this.seed}${turns && "&turns="}${turns}${drawn}&frames=${this.frame}&end`;
  }

  // Begin the run of a link, whose knobs turn by themselves.
  async open(link) {
    const [all, own, version, scene, settings, seed, turns, drawn, points, frames] = (link.length < 200_000 && LINK.exec(link)) || [];
    const prediction = points?.split(",").map((each) => (each ? Number(each) : NaN)) ?? null, wanted = this.told.lesson.predict?.draw;
    const unread = prediction && (prediction.length !== wanted?.along.places.length || !prediction.every(Number.isFinite) || drawn !== wanted.measured.name);
    const mine = this.plan.link.split("&"), coming = (turns?.split(",") ?? []).map((each) => TURN.exec(each));
    if (!all || coming.includes(null) || Number(frames) > LONGEST || coming.length > MOST_TURNS || !Number.isSafeInteger(Number(seed))) {
      refuse("This link is damaged: copy it again, as a whole.");
    } else if (mine[0] !== `atmosbox=${version}`) refuse(`This link is of atmosbox ${version}: open it in a page of that version, for another gives other numbers.`);
    else if (mine[1] !== `scene=${scene}`) refuse(`This link is for the scene ${scene}: open it in the page that atmosbox lab ${scene} writes.`);
    else if (unread) refuse("The prediction of this link cannot be read: copy the link again, as a whole.");
    else if (await this.found(own, Number(seed), settings)) {
      this.prediction = this.told.lesson.predict?.draw ? prediction : null;
      this.again();
      const wrong = coming.find(([, frame, name, value], place) => !Object.hasOwn(this.plan.knobs, name) || frame - (coming[place - 1]?.[1] ?? 0) < 0
        || !(value === "start" || (value >= this.control(name).low && value <= this.control(name).high)));
      if (wrong) refuse(`${wrong[2]} = ${wrong[3]} cannot be turned in frame ${wrong[1]}: copy the link again, as a whole.`);
      else this.coming = coming.map(([, frame, name, value]) => ({ frame: Number(frame), name, value: value === "start" ? null : Number(value) }));
    }
  }

  // Take the box of a link; return whether there is one.
  async found(own, seed, settings) {
    const fits = ({ link, ...plan }) => link === own && (plan.seeded || plan.seed === seed);
    let start = this.start, machine = fits(this.plan) ? this.machine : null;
    if (!machine && this.served) {
      start = { ...Object.fromEntries(settings.split("&").slice(1).map((each) => each.split("=").map(decoded))), seed };
      machine = await this.planned(start);
      if (!machine) return false;
    } else if (!machine) {
      start = this.starts.find(fits);
      machine = start === undefined ? null : await this.starts.machine(start);
    }
    if (!machine) {
      refuse(`This page has no box with the settings of the link: type atmosbox run --replay, and the link in quotes.`);
      return false;
    }
    this.take(machine);
    Object.assign(this, { start, seed });
    return true;
  }

  save() {
    const { rows, every } = this.trace, { units, frames, time } = this.plan, command = this.command(), link = this.link();
    const names = Object.keys(rows[0] ?? {}).filter((name) => name in units);
    const repeats = this.frame > frames ? `repeats the first ${frames} frames of this run` : "repeats this run";
    const turned = this.turned.map(({ frame, name, value }) => `# after frame ${frame}, at ${brief(frame * this.plan.frame * time)} ${this.told.stage.time.unit}: `
      + `${name} = ${value ?? "as at the start"} ${value === null ? "" : this.control(name).unit}`.trim());
    const about = [`# ${command}`, ...turned.length ? ["# begins like this run; then these changes by hand", ...turned] : [`# ${repeats}`],
      link ? `# atmosbox run --replay "${link}"\n# repeats all ${this.frame} frames` : "# this run has become too long for a link"];
    if (every > 1) about.push(`# every ${every}th frame`);
    if (this.prediction) {
      const { along, measured } = this.told.lesson.predict.draw, own = (value, { factor, offset }) => brief((value - offset) / factor);
      about.push(`# predicted: ${along.name} [${along.unit}], ${measured.name} [${measured.unit}]`,
        ...this.prediction.map((value, place) => `# ${own(along.places[place], along)}, ${own(value, measured)}`));
    }
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
      if (data.link) await box.open(data.link);
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

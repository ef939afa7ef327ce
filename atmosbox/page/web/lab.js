// The page of a box that runs: frames and numbers come from the engine, and changes of knobs and settings go to it.

import { showCaption } from "./caption.js";
import { Controls } from "./controls.js";
import { Numbers } from "./curves.js";
import { withUnit } from "./figure.js";
import { Engine } from "./engine.js";
import { Film, decode } from "./frames.js";
import { Gauges } from "./gauges.js";
import { Graphs } from "./graphs.js";
import { listen } from "./keys.js";
import { showLegend } from "./legend.js";
import { Lesson } from "./lesson.js";
import { Link, embed } from "./link.js";
import { note } from "./notes.js";
import { Player } from "./player.js";
import { Prediction } from "./prediction.js";
import { Sheet } from "./sheet.js";
import { Stage } from "./stage.js";
import { language, languages, phrase, speak, spell, story } from "./words.js";

const KEPT = 240; // frames, from which the path of a molecule is drawn
const LOOK = 200; // ms between two updates of the graphs
const LEADS = ["altitude", "way"]; // knobs that lead a parcel along its path

const find = (name) => document.getElementById(name);

class Lab {
  constructor() {
    this.engine = new Engine({ hear: (told) => this.hear(told), see: (buffer) => this.see(buffer) });
    const say = (told) => this.engine.say(told);
    const tell = (text) => note(find("notes"), { text });
    this.player = new Player(find("transport"), find("files"), say, tell);
    this.link = new Link(say);
    this.lesson = new Lesson(find("lesson"), find("tries"), say, () => this.prediction.entitle());
    this.prediction = new Prediction(say, () => this.lesson.answer !== null);
    this.gauges = new Gauges(find("gauges"), find("voice"), tell);
    this.controls = new Controls(find("controls"), (name, value) => say({ type: "set", name, value }), tell);
    this.#languages();
    this.beat = { arrived: 0, interval: 50 };
    this.stale = false;
  }

  // The languages to choose from: the box goes on, and all that is written is written again.
  #languages() {
    const list = find("language");
    list.replaceChildren(...languages.map(([value, textContent]) => Object.assign(document.createElement("option"), { value, textContent, lang: value })));
    list.value = language;
    list.hidden = languages.length < 2;
    list.onchange = () => {
      speak(list.value);
      spell();
      this.engine.say({ type: "greet" });
    };
  }

  hear(told) {
    if (told.type === "stage") this.open(told);
    else if (told.type === "series") this.append(told);
    else if (told.type === "arrays") this.numbers?.replace(told.values, told.settling);
    else if (told.type === "wind") this.stage?.blow(told);
    else if (told.type === "state") this.state(told);
    else if (told.type === "link") this.link.show(told.link);
    else if (told.type === "controls") {
      this.control(told.controls);
      this.since = this.numbers?.get("elapsed_time")?.at(-1) ?? 0;
    }
    else if (told.type === "note") {
      note(find("notes"), told);
      if (told.level === "error") this.controls.restore();
    }
    this.stale = true;
  }

  // A new box begins: remove all that was shown of the previous one.
  open({ stage: record, controls, state, lesson, settle, prediction }) {
    if (!this.numbers || state.time === 0) this.since = 0;
    this.settle = settle;
    this.stage?.leave();
    find("boxes").replaceChildren();
    const frame = Object.assign(document.createElement("div"), { className: "box" });
    find("boxes").append(frame);
    find("title").textContent = document.title = phrase(record.title);
    const place = this.stage?.camera.place;
    this.film = new Film([], KEPT);
    this.numbers = new Numbers();
    this.stage = new Stage(frame, record, this.film);
    if (place !== undefined && place !== null) this.stage.camera.place = place;
    this.graphs = new Graphs(find("graphs"), [{ stage: record, film: this.film, numbers: this.numbers }], null);
    this.sheet = new Sheet([this.stage], () => this.graphs.repaint());
    this.walls = state.walls ?? null;
    find("story").textContent = story(record.story);
    find("panel").hidden = !controls?.length && !lesson?.presets.length;
    this.lesson.offer(record.scene, lesson, record.time.unit);
    this.prediction.offer(this.graphs, lesson, prediction);
    const footer = [`atmosbox ${record.version}`.trim(), record.scene, `${record.molecules} ${record.particle}s`,
      record.seed === null ? "" : `seed ${record.seed}`, `${record.engine} engine`].filter(Boolean).join(" · ");
    this.caption = showCaption(find("caption"), [{ stage: record, footer }]);
    this.player.begin(record);
    this.state({ seed: record.seed, ...state });
    this.control(controls ?? []);
    document.body.dataset.ready = true;
    this.start(state);
  }

  // Show the values of the controls. Guides are for those of the start.
  control(controls) {
    this.controls.show(controls);
    this.graphs.guide(controls.every(({ name, value, start }) => value === start || LEADS.includes(name)));
  }

  // Start a box that has not run yet, unless the reader's system asks for reduced motion.
  start({ playing, time }) {
    if (this.started) return;
    this.started = true;
    if (!playing && time === 0 && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.prediction.play();
  }

  // Show the state of the box, which comes four times a second. Gauges are shown with the graphs, see `look`.
  state(told) {
    this.player.show(told);
    this.lesson.show(told);
    if (told.gauges) this.readings = told;
    if (told.walls) {
      this.walls = told.walls;
      this.stage?.warm(told.walls);
    }
  }

  append({ reset, time, values }) {
    if (reset) this.numbers.clear();
    this.numbers.append(time ?? [], values ?? {});
  }

  see(buffer) {
    if (!this.film) return;
    const { frame } = decode(buffer);
    const last = this.film.frames.at(-1);
    if (last && frame.time < last.time) this.film.clear();
    this.film.push(frame);
    if (frame.fastest !== this.stage.record.speed.high) this.rescale(frame.fastest);
    const now = performance.now();
    this.beat = { arrived: now, interval: Math.min(0.8 * this.beat.interval + 0.2 * (now - this.beat.arrived), 400) };
    this.stale = true;
    document.body.dataset.time = frame.time;
    if (last === undefined || !this.player.state.playing) this.player.show({ time: frame.time });
  }

  // The scale of speeds changes with this frame, because the box has become much warmer or colder.
  rescale(fastest) {
    this.stage.record.speed.high = fastest;
    showLegend(find("legend"), this.stage.record, this.stage.mode);
  }

  // Molecules move evenly from one received frame to the next; so the picture is one frame behind.
  draw(now) {
    const { frames } = this.film ?? { frames: [] };
    if (!frames.length) return;
    const second = frames.at(-1), first = frames.at(-2) ?? second;
    const share = Math.min((now - this.beat.arrived) / Math.max(this.beat.interval, 1), 1);
    const time = first.time + (second.time - first.time) * share;
    if (time !== this.drawn || this.stage.dirty) this.stage.show(time);
    this.drawn = time;
    this.stage.render();
  }

  // Update the graphs, which is done less often than the picture.
  look() {
    if (!this.stale || !this.graphs) return;
    this.stale = false;
    if (this.readings) this.gauges.show(this.readings.gauges, this.readings.molecules);
    this.graphs.refresh();
    if (this.film.frames.length) {
      this.graphs.at(Math.max(this.film.end, this.numbers.get("elapsed_time")?.at(-1) ?? 0)); // which is rounded
      find("status").textContent = this.sheet.story();
      this.caption({ walls: this.walls, length: this.film.frames.at(-1).length });
    }
    if (this.settle) this.graphs.compare({ since: this.since + this.settle, changed: this.since > 0 });
    this.lesson.judge(this.numbers);
  }
}

export function begin() {
  spell();
  embed();
  const lab = new Lab();
  const { player } = lab;
  listen({
    " ": () => player.toggle(),
    ArrowRight: () => player.step(),
    ArrowUp: () => player.accelerate(2),
    ArrowDown: () => player.accelerate(0.5),
    ...Object.fromEntries([0, 1, 2, 3].map((place) => [String(place + 1), () => lab.sheet?.look(place)])),
    c: () => lab.sheet?.colour(),
    t: () => lab.sheet?.trace(),
    d: () => lab.sheet?.turnTheme(),
    r: () => player.reset(),
    u: () => lab.lesson.undo(),
    m: () => lab.prediction.draft || lab.gauges.say(withUnit(lab.film?.end, player.unit, 4)),
    "?": () => lab.sheet?.help(),
  });
  setInterval(() => lab.look(), LOOK);
  const beat = (now) => {
    lab.draw(now);
    requestAnimationFrame(beat);
  };
  requestAnimationFrame(beat);
}

// What the reader predicts, as a curve that is drawn before the box is measured: five points on a graph, which are
// dragged, or moved by the arrow keys. While it is drawn, nothing that was measured is shown.

import { curveColour } from "./colour.js";
import { round } from "./figure.js";
import { phrase, word } from "./words.js";

const STEPS = 100; // least number of steps across the range in which a class draws
const PARTS = 16; // of the curve between two points
const MARGIN = { measured: 0.1, along: 0.05 }; // of the axes, in their ranges
const MOVES = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 };

const make = (kind, fields = {}, ...children) => {
  const element = Object.assign(document.createElement(kind), fields);
  element.append(...children);
  return element;
};
const tell = (element, names) => Object.entries(names).forEach(([name, value]) => element.setAttribute(`aria-${name}`, value));
const button = (key, onclick, more = {}) => make("button", { type: "button", textContent: word(key), onclick, ...more });
const told = (value, unit) => `${round(Number(value.toPrecision(4)))} ${unit}`.trim();
const wider = ([low, high], share) => [low - share * (high - low), high + share * (high - low)];

// A smooth curve through points at equal distances, which turns only at points (Fritsch and Butland 1984).
function smooth(points) {
  const rise = (place) => points[place + 1] - points[place], last = points.length - 1;
  const slope = (place) => {
    if (place === 0 || place === last) return rise(Math.min(place, last - 1));
    const [before, after] = [rise(place - 1), rise(place)];
    return before * after > 0 ? 2 * before * after / (before + after) : 0;
  };
  return Array.from({ length: PARTS * last + 1 }, (_, part) => {
    const place = Math.min(Math.floor(part / PARTS), last - 1), way = part / PARTS - place;
    const [up, from, to] = [rise(place), slope(place), slope(place + 1)];
    return points[place] + way * (from + way * (3 * up - 2 * from - to + way * (from + to - 2 * up)));
  });
}

export class Prediction {
  // `say(message)` sends a message to the box, which keeps the five values for its link and its file; `answered` tells
  // whether the question beside the graph has been answered.
  constructor(say, answered) {
    const asked = new URLSearchParams(location.search).has("predict"); // nothing is shown before it is drawn
    Object.assign(this, { say, answered, asked, draft: null, buttons: make("span", { className: "choices" }) });
  }

  // A box begins, or the page is written in another language; `values` is what was drawn before.
  offer(graphs, { predict }, values) {
    const draw = predict?.draw ?? null;
    if (JSON.stringify(draw) !== JSON.stringify(this.draw)) this.draft = null;
    Object.assign(this, { graphs, draw, values, graph: draw && graphs.panels[draw.graph].graph });
    this.telling = predict ? this.graph ?? graphs.panels[0]?.graph : null; // whose title answers the question
    graphs.drawn = (graph, curves) => this.#added(graph, curves);
    document.querySelector("#lesson .predict .choices")?.after(this.buttons);
    this.#show();
  }

  // Let the box run, or as soon as the prediction is drawn.
  play() {
    if (this.draft) this.resumes = true;
    else this.say({ type: "play" });
  }

  #start() {
    this.#begin(this.values ?? this.#middle());
    this.#show();
    this.graph.element.scrollIntoView({ block: "center" });
    this.handles[0].focus({ preventScroll: true });
  }

  // Draw from now on, while the box stands still.
  #begin(draft) {
    if (this.draft) return;
    this.draft = draft;
    if (document.body.dataset.playing !== "true") return;
    this.say({ type: "pause" });
    this.resumes = true;
  }

  #middle() {
    const [low, high] = this.draw.measured.range;
    return this.draw.along.places.map(() => this.#rounded((low + high) / 2));
  }

  #end(values) {
    Object.assign(this, { values, draft: null });
    this.say({ type: "predict", values });
    this.#show();
    if (this.resumes && !this.draft) {
      this.resumes = false;
      this.say({ type: "play" });
    }
  }

  #show() {
    const { draw, graph, values } = this;
    if (this.asked && draw && !values) this.#begin(this.#middle());
    const open = Boolean(this.draft);
    document.body.classList.toggle("drawing", open);
    this.bar?.remove();
    this.layer?.remove();
    this.entitle();
    if (draw) {
      const again = button(values ? "draw_again" : "draw", () => this.#start());
      this.buttons.replaceChildren(again, ...values ? [button("draw_remove", () => this.#end(null))] : []);
      graph.element.classList.toggle("asked", open);
      graph.element.classList.toggle("predicted", !open && Boolean(values));
      graph.fixed = null;
      if (open) this.#open();
    } else this.buttons.replaceChildren();
    this.graphs.refresh();
  }

  // Write the title of the graph, which tells the result, only when the question is answered or the curve is drawn.
  entitle() {
    if (!this.telling) return;
    const { panel, part } = this.telling, measured = this.#named(phrase(panel[panel.across ? "x" : "y"].label));
    if (this.draft) part("strong").textContent = `${word("predict")}: ${measured}`;
    else part("strong").textContent = this.values || this.answered() ? phrase(panel.title) : `${measured[0].toUpperCase()}${measured.slice(1)}`;
  }

  // A name, with that of the curve where there are several.
  #named(text) {
    return this.draw?.label ? `${text} (${phrase(this.draw.label)})` : text;
  }

  // Put five handles on the graph, and over it what to do.
  #open() {
    const { draw: { along }, graph: { panel, part, plot } } = this;
    Object.assign(this, { axis: panel.across ? "x" : "y", other: panel.across ? "y" : "x" });
    this.done = button("draw_done", () => this.#end(this.draft), { className: "main" });
    const cancel = this.asked && !this.values ? [] : [button("cancel", () => this.#end(this.values))];
    this.bar = make("div", { className: "drawing" }, make("span", {}, this.done, ...cancel), make("p", { textContent: word("draw_how") }));
    part("figcaption").append(this.bar);
    this.handles = along.places.map((value, place) => {
      const handle = make("div", { className: "handle", tabIndex: 0, onkeydown: (event) => this.#press(event, place) });
      handle.setAttribute("role", "slider");
      tell(handle, { orientation: panel.across ? "horizontal" : "vertical", label: `${phrase(panel[this.other].label)} ${told(value, panel[this.other].unit)}` });
      return handle;
    });
    this.layer = make("div", { className: "handles" }, ...this.handles);
    this.layer.setAttribute("role", "group");
    tell(this.layer, { label: word("draw") });
    this.layer.onpointerdown = (event) => {
      event.preventDefault();
      this.layer.setPointerCapture(event.pointerId);
      this.handles[this.#drag(event)].focus({ preventScroll: true });
    };
    this.layer.onpointermove = (event) => this.layer.hasPointerCapture(event.pointerId) && this.#drag(event);
    this.layer.onlostpointercapture = () => this.#fit();
    plot.over.append(this.layer);
    this.#fit();
  }

  // Choose the axes so that all points are on the graph.
  #fit() {
    const { draw: { measured: { range }, along: { places } }, draft, graph, axis, other } = this;
    const ends = [places[0], places.at(-1)].map(graph.to[other]).toSorted((one, next) => one - next);
    graph.fixed = {
      [axis]: wider([Math.min(...range, ...draft), Math.max(...range, ...draft)], MARGIN.measured),
      [other]: wider(ends, MARGIN.along),
    };
    this.#place();
  }

  // The place of a value on an axis, from 0 to 1, from the left or from below.
  #share(axis, value) {
    const { graph } = this, [low, high] = graph.fixed[axis], share = (graph.to[axis](value) - low) / (high - low);
    return graph.panel[axis].invert ? 1 - share : share;
  }

  #place() {
    const { draw: { along: { places } }, draft, graph, axis, other } = this, [low, high] = graph.fixed[axis];
    this.layer.style.color = curveColour("prediction", 0);
    this.done.disabled = !this.values && draft.every((value) => value === this.#middle()[0]);
    this.handles.forEach((handle, place) => {
      const at = { [axis]: this.#share(axis, draft[place]), [other]: this.#share(other, places[place]) };
      Object.assign(handle.style, { left: `${100 * at.x}%`, bottom: `${100 * at.y}%` });
      tell(handle, { valuemin: low, valuemax: high, valuenow: draft[place], valuetext: told(draft[place], graph.panel[axis].unit) });
    });
    this.graphs.refresh();
  }

  // Move the point that is nearest to the pointer; return its number.
  #drag({ clientX, clientY }) {
    const { left, bottom, width, height } = this.layer.getBoundingClientRect(), { graph, axis, other } = this;
    const at = { x: (clientX - left) / width, y: (bottom - clientY) / height }, [low, high] = graph.fixed[axis];
    const far = this.draw.along.places.map((value) => Math.abs(this.#share(other, value) - at[other]));
    const place = far.indexOf(Math.min(...far)), share = Math.min(Math.max(at[axis], 0), 1);
    this.#set(place, low + (high - low) * (graph.panel[axis].invert ? 1 - share : share));
    this.#place();
    return place;
  }

  #press(event, place) {
    const by = MOVES[event.key];
    if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation(); // these keys control the player, too
    this.#set(place, this.draft[place] + by * this.#step());
    this.#fit();
  }

  #set(place, value) {
    this.draft = this.draft.with(place, this.#rounded(value));
  }

  // The smallest change of a value: a round number.
  #step() {
    const [low, high] = this.draw.measured.range, least = (high - low) / STEPS, power = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].find((each) => each * power >= 0.999 * least) * power;
  }

  #rounded(value) {
    const step = this.#step();
    return Number((Math.round(value / step) * step).toPrecision(6));
  }

  // The curves of a graph with what was predicted, or this alone while it is drawn.
  #added(graph, curves) {
    const points = this.draft ?? this.values;
    if (graph !== this.graph || !points) return curves;
    const { draw: { along: { places } } } = this, { panel } = graph, log = panel[panel.across ? "y" : "x"].log;
    const ends = log ? places.map(Math.log) : places, last = places.length - 1;
    const way = Array.from({ length: PARTS * last + 1 }, (_, part) => ends[0] + (ends[last] - ends[0]) * part / (PARTS * last));
    const [along, measured] = [log ? way.map(Math.exp) : way, smooth(points)];
    const curve = { label: this.#named(word("your_prediction")), role: "prediction", index: 0, error: null };
    Object.assign(curve, panel.across ? { x: measured, y: along } : { x: along, y: measured });
    return this.draft ? [curve] : [...curves, curve];
  }
}

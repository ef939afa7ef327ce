// The bar of a box that runs: play, step, pace, begin again with a seed, and save the measurements.

import { figure, withUnit } from "./figure.js";
import { icon } from "./transport.js";
import { phrase, word } from "./words.js";

const SLOWEST = 0.25, FASTEST = 16;

export class Player {
  // `say(message)` sends a message to the engine.
  constructor(parent, say) {
    Object.assign(this, { say, state: { playing: false, pace: 1 }, unit: "", particle: "molecule" });
    parent.innerHTML = `
      <button type="button" id="play" class="main" title="${word("play_title")}"></button>
      <button type="button" id="on" title="${word("on_title")}" aria-label="${word("on")}">${icon("on")}</button>
      <span class="group"><button type="button" id="slower" title="${word("slower_title")}" aria-label="${word("slower")}">−</button>
      <output id="pace"></output><button type="button" id="faster" title="${word("faster_title")}" aria-label="${word("faster")}">+</button></span>
      <output id="time" aria-live="off"></output><output id="vitals" aria-live="off"></output>
      <span class="group"><button type="button" id="reset" title="${word("again_title")}">${word("again")}</button></span>
      <label class="seed" title="${word("seed_title")}">${word("seed")} <input type="number" id="seed" min="0" step="1" inputmode="numeric"></label>
      <button type="button" id="save" title="${word("save_title")}">${word("save")}</button>`;
    this.part = (name) => parent.querySelector(`#${name}`);
    this.part("play").onclick = () => this.toggle();
    this.part("on").onclick = () => this.step();
    this.part("slower").onclick = () => this.accelerate(0.5);
    this.part("faster").onclick = () => this.accelerate(2);
    this.part("reset").onclick = () => this.reset();
    this.part("save").onclick = () => this.say({ type: "save" });
    this.show({});
  }

  toggle() {
    this.say({ type: this.state.playing ? "pause" : "play" });
  }

  step() {
    this.say({ type: "step" });
  }

  reset() {
    const seed = this.part("seed").valueAsNumber;
    this.say({ type: "reset", seed: Number.isInteger(seed) && seed >= 0 ? seed : null });
  }

  accelerate(factor) {
    this.say({ type: "pace", value: Math.min(Math.max(this.state.pace * factor, SLOWEST), FASTEST) });
  }

  // A new box begins: set its unit of time, and its word for a molecule.
  begin({ time, particle }) {
    Object.assign(this, { unit: time.unit, particle });
  }

  // Show the state of the box.
  show(told) {
    Object.assign(this.state, told);
    const { playing, pace, time, rate, ledger, molecules, seed, seeded, finished, busy } = this.state;
    this.part("seed").parentElement.hidden = !seeded;
    this.part("play").innerHTML = icon(playing ? "pause" : "play");
    this.part("play").setAttribute("aria-label", word(playing ? "pause" : "play"));
    this.part("pace").textContent = pace < 1 ? `1/${Math.round(1 / pace)}×` : `${pace}×`;
    if (time !== undefined) this.part("time").textContent = withUnit(time, this.unit, 4);
    const vitals = busy ? [phrase(busy)] : [
      molecules !== undefined && word(this.particle === "disc" ? "discs" : "molecules", { number: molecules }),
      Number.isFinite(rate) && playing && word("rate", { number: figure(rate, 2) }),
      Number.isFinite(ledger) && word("energy_off", { number: figure(ledger, 2) }),
      finished && word("over"),
    ];
    this.part("vitals").textContent = vitals.filter(Boolean).join(" · ");
    if (seed !== undefined && seed !== null && document.activeElement !== this.part("seed")) this.part("seed").value = seed;
    document.body.dataset.playing = playing;
  }
}

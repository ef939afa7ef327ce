// The bar of a box that runs: play, step, pace, begin again with a seed, and save the measurements.

import { figure, withUnit } from "./figure.js";
import { icon } from "./transport.js";
import { phrase, spell, word } from "./words.js";

const SLOWEST = 0.25, FASTEST = 16;
const EXACT = 15; // digits of a number of the engine

// How many digits of the energy are those of the start and of what was added, or by how much it is off.
function energy(share) {
  const digits = Math.min(EXACT, Math.floor(-Math.log10(share)));
  return digits > 2 ? word("energy_conserved", { number: digits }) : word("energy_off", { number: figure(100 * share, 2) });
}

export class Player {
  // `files` gets the field of the seed and Save; `say(message)` sends a message to the engine, `tell(text)` one to the reader.
  constructor(parent, files, say, tell) {
    Object.assign(this, { say, tell, state: { playing: false, pace: 1 }, unit: "", particle: "molecule" });
    parent.innerHTML = `
      <button type="button" id="play" class="main" data-word-title="play_title"></button>
      <button type="button" id="on" data-word-title="on_title" data-word-label="on">${icon("on")}</button>
      <span class="group"><button type="button" id="slower" data-word-title="slower_title" data-word-label="slower">−</button>
      <output id="pace" aria-live="off"></output><button type="button" id="faster" data-word-title="faster_title" data-word-label="faster">+</button></span>
      <output id="time" aria-live="off"></output><output id="vitals" aria-live="off"></output>
      <button type="button" id="reset" data-word-title="again_title" data-word="again"></button>`;
    files.innerHTML = `<label class="seed" data-word-title="seed_title"><span data-word="seed"></span>
      <input type="number" id="seed" min="0" step="1" inputmode="numeric"></label>
      <button type="button" id="save" data-word-title="save_title" data-word="save"></button>`;
    spell();
    this.part = (name) => document.getElementById(name);
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
    const field = this.part("seed"), seed = Number(field.value);
    if (this.state.seeded && (field.value === "" || !Number.isSafeInteger(seed) || seed < 0)) {
      field.value = this.state.seed;
      this.tell(word("no_seed", { number: Number.MAX_SAFE_INTEGER }));
    } else this.say({ type: "reset", seed: this.state.seeded ? seed : null });
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
      Number.isFinite(ledger) && energy(ledger),
      finished && word("over"),
    ];
    this.part("vitals").textContent = vitals.filter(Boolean).join(" · ");
    if (seed !== undefined && seed !== null && document.activeElement !== this.part("seed")) this.part("seed").value = seed;
    document.body.dataset.playing = playing;
  }
}

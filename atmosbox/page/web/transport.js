// The bar that plays a run: play, step, the time line, the speed.

import { figure, withUnit } from "./figure.js";
import { word } from "./words.js";

const MARK = { play: "M3 1.5v13l11-6.5z", pause: "M3 2h3.6v12H3zM9.4 2H13v12H9.4z", back: "M12 2v12L4.5 8zM2 2h2v12H2z", on: "M4 2v12l7.5-6zM12 2h2v12h-2z" };

export const icon = (name) => `<svg viewBox="0 0 16 16" aria-hidden="true"><path d="${MARK[name]}"/></svg>`;

export class Transport {
  constructor(parent, clock, unit) {
    Object.assign(this, { clock, unit });
    parent.innerHTML = `
      <button type="button" id="back" title="${word("back_title")}" aria-label="${word("back")}">${icon("back")}</button>
      <button type="button" id="play" class="main" title="${word("play_title")}"></button>
      <button type="button" id="on" title="${word("on_title")}" aria-label="${word("on")}">${icon("on")}</button>
      <input type="range" id="line" min="0" max="1000" step="any" aria-label="${word("time")}">
      <output id="time" aria-live="off"></output>
      <span class="group"><button type="button" id="slower" title="${word("slower_title")}" aria-label="${word("slower")}">−</button>
      <output id="pace"></output><button type="button" id="faster" title="${word("faster_title")}" aria-label="${word("faster")}">+</button></span>`;
    this.part = (name) => parent.querySelector(`#${name}`);
    this.part("play").onclick = () => clock.toggle();
    this.part("back").onclick = () => clock.step(-1);
    this.part("on").onclick = () => clock.step(1);
    this.part("slower").onclick = () => clock.accelerate(0.5);
    this.part("faster").onclick = () => clock.accelerate(2);
    this.part("line").oninput = (event) => clock.seek(clock.start + event.target.value / 1000 * (clock.end - clock.start));
    clock.addEventListener("change", () => this.#change());
    clock.addEventListener("time", () => this.#time());
    this.#change();
    this.#time();
  }

  #change() {
    const { playing, factor, pace } = this.clock;
    this.part("play").innerHTML = icon(playing ? "pause" : "play");
    this.part("play").setAttribute("aria-label", word(playing ? "pause" : "play"));
    this.part("pace").innerHTML = "<b></b><small></small>";
    this.part("pace b").textContent = factor < 1 ? `1/${1 / factor}×` : `${factor}×`;
    this.part("pace small").textContent = word("pace", { time: withUnit(pace * factor, this.unit, 2) });
    document.body.dataset.playing = playing;
  }

  #time() {
    const { time, start, end } = this.clock;
    const share = end > start ? (time - start) / (end - start) : 0;
    this.part("line").value = 1000 * share;
    this.part("line").style.setProperty("--share", `${100 * share}%`);
    const digits = Math.max(3, Math.ceil(Math.log10(Math.max(end, 1e-9) / Math.max(end - start, 1e-9))) + 3);
    this.part("time").textContent = `${figure(time, digits)} ${this.unit}`;
    document.body.dataset.time = time;
  }
}

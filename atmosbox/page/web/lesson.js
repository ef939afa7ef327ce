// Offers for a class: named settings, undo, and challenges.

import { figure, spelled } from "./figure.js";
import { numbers, phrase, word } from "./words.js";

const make = (kind, fields = {}) => Object.assign(document.createElement(kind), fields);

export class Lesson {
  // `say(message)` sends a message to the box.
  constructor(parent, say) {
    Object.assign(this, { parent, say, challenge: null });
  }

  // Show the presets and the challenges of the scene.
  offer({ presets = [], challenges = [] } = {}) {
    const told = JSON.stringify([presets, challenges]);
    if (told === this.told) return;
    this.told = told;
    this.challenge = null;
    this.parent.replaceChildren();
    const bar = make("div", { className: "tries" });
    if (presets.length) bar.append(this.#presets(presets));
    challenges.forEach((challenge, index) => bar.append(this.#opener(challenge, index, challenges.length)));
    this.back = make("button", { type: "button", id: "undo", textContent: `↶ ${word("undo")}`, title: word("undo_title") });
    this.back.onclick = () => this.undo();
    bar.append(this.back);
    this.card = make("section", { className: "challenge", hidden: true });
    this.card.setAttribute("aria-label", word("challenge"));
    this.parent.append(bar, this.card);
    this.parent.hidden = false;
  }

  undo() {
    this.say({ type: "undo" });
  }

  #presets(presets) {
    const list = make("select", { id: "presets", title: word("preset") });
    list.setAttribute("aria-label", word("preset"));
    list.append(make("option", { value: "", textContent: `${word("presets")} …` }));
    presets.forEach((title, number) => list.append(make("option", { value: number, textContent: phrase(title) })));
    list.onchange = () => {
      if (list.value !== "") this.say({ type: "preset", number: Number(list.value) });
      list.blur(); // so that keys control the player again
    };
    return list;
  }

  #opener(challenge, index, count) {
    const text = count > 1 ? `${word("challenge")} ${index + 1}` : word("challenge");
    const button = make("button", { type: "button", className: "opener", textContent: text });
    button.setAttribute("aria-pressed", false);
    button.onclick = () => {
      this.challenge = this.challenge === challenge ? null : challenge;
      for (const each of this.parent.querySelectorAll(".opener")) each.setAttribute("aria-pressed", each === button && this.challenge !== null);
      this.#open();
    };
    return button;
  }

  #open() {
    this.card.hidden = this.challenge === null;
    if (this.challenge === null) return;
    const hint = make("details");
    hint.append(make("summary", { textContent: word("hint") }), make("p", { textContent: phrase(this.challenge.hint) }));
    this.verdict = make("p", { className: "verdict" });
    this.verdict.setAttribute("role", "status");
    this.card.replaceChildren(make("p", { className: "ask", textContent: numbers(phrase(this.challenge.ask)) }), this.verdict, hint);
  }

  // Update the undo button: whether any change can be undone.
  show({ undo }) {
    if (this.back && undo !== undefined) this.back.disabled = !undo;
  }

  // Check whether the measurements have met the challenge at any time.
  judge(values) {
    if (this.challenge === null) return;
    const { reach } = this.challenge;
    const series = reach.map(({ name }) => values.get(name) ?? []);
    const count = Math.min(...series.map(({ length }) => length));
    const met = (place) => reach.every(({ target, within }, goal) => Math.abs(series[goal][place] - target) <= within);
    const first = Array.from({ length: count }, (_, place) => place).find(met);
    const place = first ?? count - 1;
    const told = place < 0 ? "" : reach.map(({ unit, factor, offset }, goal) =>
      `${figure(series[goal][place] * factor + offset)} ${spelled(unit)}`).join(", ");
    const text = told ? word(first === undefined ? "not_yet" : "reached", { values: told }) : "";
    if (this.verdict.textContent !== text) this.verdict.textContent = text;
    this.card.classList.toggle("reached", first !== undefined);
  }
}

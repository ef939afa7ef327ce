// The settings that may be changed while the box runs: a line for each, with its unit.

import { round, spelled } from "./figure.js";
import { language, phrase, word } from "./words.js";

const WIDE = 300; // a slider is logarithmic if its highest value is more than this many times its lowest
const PATIENCE = 120; // ms between two values that a moving slider sends

const brief = (number) => (Number.isInteger(number) ? number : Number(Number(number).toPrecision(4)));

const make = (kind, fields = {}) => Object.assign(document.createElement(kind), fields);

export class Controls {
  // `set(name, value)` is called when a control is changed, `tell(text)` when what was typed is refused.
  constructor(parent, set, tell) {
    Object.assign(this, { parent, set, tell, shown: new Map() });
  }

  // Show the values in force again, because a typed value was refused.
  restore() {
    if (this.told) this.show(this.told);
  }

  // Build the controls again or, if they are the same, only update their values.
  show(controls) {
    this.told = controls;
    const names = [language, ...controls.map(({ name }) => name)].join();
    if (names === this.names) {
      for (const control of controls) this.shown.get(control.name)?.(control.value);
      return;
    }
    this.names = names;
    this.shown.clear();
    this.parent.replaceChildren();
    const now = controls.filter(({ restarts }) => !restarts), later = controls.filter(({ restarts }) => restarts);
    if (now.length) this.parent.append(this.#group(now));
    if (later.length) {
      const more = make("details", { open: now.length === 0 });
      more.append(make("summary", { textContent: word("settings") }), this.#group(later));
      this.parent.append(more);
    }
  }

  #group(controls) {
    const group = make("div", { className: "settings" });
    for (const control of controls) group.append(this.#line(control));
    return group;
  }

  #line(control) {
    const line = make("label", { className: `setting ${control.kind}` });
    line.append(make("span", { className: "name", textContent: phrase(control.label) }));
    if (control.kind === "number") this.#number(line, control);
    else if (control.kind === "switch") this.#switch(line, control);
    else this.#choice(line, control);
    return line;
  }

  #number(line, { name, label, low, high, step, value, unit, restarts }) {
    const bounded = Number.isFinite(low) && Number.isFinite(high);
    const ratios = bounded && low > 0 && high / low > WIDE;
    const place = (number) => (ratios ? Math.log(number) : number);
    const box = make("input", { type: "number", step: "any", value: brief(value) });
    box.setAttribute("aria-label", phrase(label));
    if (bounded) Object.assign(box, { min: low, max: high });
    box.addEventListener("keydown", ({ key }) => key === "Enter" && box.blur()); // so that keys control the player again
    const send = (number) => this.set(name, number);
    const slider = make("input", { type: "range", name, step: ratios ? "any" : step ?? "any" });
    box.addEventListener("change", () => {
      const asked = box.valueAsNumber, outside = bounded && !(asked >= low && asked <= high);
      if (!Number.isFinite(asked) || outside) {
        box.value = brief(this.told.find((each) => each.name === name).value);
        const said = { name: phrase(label), low: round(low), high: round(high), unit: spelled(unit) };
        this.tell(word(Number.isFinite(asked) ? "out_of_range" : "no_number", said));
        return;
      }
      slider.value = place(box.valueAsNumber);
      send(box.valueAsNumber);
    });
    if (bounded) {
      Object.assign(slider, { min: place(low), max: place(high) });
      slider.value = place(value);
      slider.setAttribute("aria-label", phrase(label));
      let waiting = null;
      const moved = () => Number((ratios ? Math.exp(slider.valueAsNumber) : slider.valueAsNumber).toPrecision(ratios ? 3 : 6));
      slider.addEventListener("input", () => {
        box.value = moved();
        if (!restarts) waiting ??= setTimeout(() => { waiting = null; send(moved()); }, PATIENCE);
      });
      slider.addEventListener("change", () => {
        clearTimeout(waiting);
        waiting = null;
        send(moved());
      });
      line.append(slider);
    }
    line.append(box, make("span", { className: "unit", textContent: spelled(unit) }));
    this.shown.set(name, (number) => {
      if (document.activeElement === box || document.activeElement === slider) return;
      box.value = brief(number);
      slider.value = place(number);
    });
  }

  #switch(line, { name, value }) {
    const box = make("input", { type: "checkbox", checked: Boolean(value) });
    box.addEventListener("change", () => this.set(name, box.checked));
    line.append(box);
    this.shown.set(name, (on) => { box.checked = Boolean(on); });
  }

  #choice(line, { name, value, choices }) {
    const list = make("select");
    for (const each of choices ?? []) list.append(make("option", { value: each, textContent: phrase(each) }));
    list.value = value;
    list.addEventListener("change", () => this.set(name, list.value));
    line.append(list);
    this.shown.set(name, (chosen) => { list.value = chosen; });
  }
}

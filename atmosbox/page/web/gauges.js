// Thermometer, barometer and hygrometer above the box, readable from the last row, and read aloud on demand.

import { figure } from "./figure.js";
import { numbers, word } from "./words.js";

const DIGITS = { "°C": 1, hPa: 0, "%": 0 };

// A reading as text: with its scatter it has no more decimals than the scatter allows.
const shown = ({ value, spread, unit }) => {
  const digits = Math.max(0, Math.min(DIGITS[unit] ?? 1, spread ? 1 - Math.floor(Math.log10(spread)) : Infinity));
  return [numbers(value.toFixed(digits).replace("-", "−")), spread ? `±\u00a0${figure(spread, 2)}` : "", unit].filter(Boolean);
};

export class Gauges {
  // `parent` is the visible element; `voice` is read by screen readers, and only when `say` is called; `tell` explains.
  constructor(parent, voice, tell) {
    Object.assign(this, { parent, voice, tell, parts: new Map(), sentence: "" });
    parent.setAttribute("role", "group");
  }

  // Show the latest measurement: name, value, scatter and unit of each gauge, for a number of molecules.
  show(gauges, molecules) {
    this.parent.hidden = gauges.length === 0;
    const names = gauges.map(({ name }) => word(name)).join();
    if (names !== this.names) this.#build(gauges);
    this.names = names;
    for (const gauge of gauges) {
      const [value, ...rest] = shown(gauge), [number, spread, button] = this.parts.get(gauge.name);
      if (number.textContent !== value) number.textContent = value;
      if (spread.textContent !== rest.join(" ")) spread.textContent = rest.join(" ");
      const size = gauge.spread ? `${figure(gauge.spread, 2)} ${gauge.unit.replace("°C", "K")}` : "";
      button.onclick = () => this.tell(word(size ? `why_${gauge.name}` : "why_one", { number: molecules, size }));
    }
    this.sentence = gauges.map((gauge) => `${word(gauge.name)} ${shown(gauge).join(" ")}`).join(", ");
  }

  #build(gauges) {
    this.parts.clear();
    this.parent.replaceChildren();
    this.parent.setAttribute("aria-label", word("measured"));
    for (const { name } of gauges) {
      const button = Object.assign(document.createElement("button"), { type: "button", className: `gauge ${name}`, title: word("why") });
      const [number, spread] = ["value", "spread"].map((className) => Object.assign(document.createElement("output"), { className }));
      // they change several times a second: the key M reads them aloud
      for (const each of [number, spread]) each.setAttribute("aria-live", "off");
      button.append(Object.assign(document.createElement("small"), { textContent: word(name) }), number, spread);
      this.parts.set(name, [number, spread, button]);
      this.parent.append(button);
    }
  }

  say(time) {
    this.voice.textContent = [time, this.sentence].filter(Boolean).join(": ");
  }
}

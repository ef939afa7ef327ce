// Thermometer, barometer and hygrometer beside the box, readable from the last row, and read aloud on demand.

import { numbers, word } from "./words.js";

const DIGITS = { "°C": 1, hPa: 0, "%": 0 };

const shown = (value, unit) => `${numbers(value.toFixed(DIGITS[unit] ?? 1).replace("-", "−"))} ${unit}`;

export class Gauges {
  // `parent` is the visible element; `voice` is read by screen readers, and only when `say` is called.
  constructor(parent, voice) {
    Object.assign(this, { parent, voice, parts: new Map(), sentence: "" });
    parent.setAttribute("role", "group");
    parent.setAttribute("aria-label", word("measured"));
  }

  // Show the latest measurement: name, value and unit of each gauge.
  show(gauges) {
    this.parent.hidden = gauges.length === 0;
    const names = gauges.map(({ name }) => name).join();
    if (names !== this.names) this.#build(gauges);
    this.names = names;
    for (const { name, value, unit } of gauges) {
      const text = shown(value, unit), part = this.parts.get(name);
      if (part.textContent !== text) part.textContent = text;
    }
    this.sentence = gauges.map(({ name, value, unit }) => `${word(name)} ${shown(value, unit)}`).join(", ");
  }

  #build(gauges) {
    this.parts.clear();
    this.parent.replaceChildren();
    for (const { name } of gauges) {
      const line = Object.assign(document.createElement("span"), { className: `gauge ${name}` });
      const number = document.createElement("output");
      number.setAttribute("aria-label", word(name));
      number.setAttribute("aria-live", "off"); // it changes several times a second: the key M reads it aloud
      line.append(Object.assign(document.createElement("small"), { textContent: word(name) }), number);
      this.parts.set(name, number);
      this.parent.append(line);
    }
  }

  say(time) {
    this.voice.textContent = [time, this.sentence].filter(Boolean).join(": ");
  }
}

// The legend of the colours of the molecules.

import { look, speedGradient } from "./colour.js";
import { round } from "./figure.js";
import { phrase, word } from "./words.js";

export function showLegend(parent, stage, mode) {
  parent.replaceChildren();
  if (mode === "speed") {
    const { low, high, unit, counted, bend } = stage.speed;
    const bar = document.createElement("div");
    bar.className = "bar";
    bar.style.background = speedGradient(bend);
    const ends = document.createElement("div");
    ends.className = "ends";
    for (const value of [low, (low + high) / 2, high]) {
      ends.append(Object.assign(document.createElement("span"), { textContent: round(value) }));
    }
    const scale = document.createElement("div");
    scale.className = "scale";
    scale.append(bar, ends);
    parent.append(Object.assign(document.createElement("span"), { textContent: counted ? word("neighbours") : `${word("speed")} (${unit})` }), scale);
    return;
  }
  const largest = Math.max(...stage.species.map(({ drawn }) => drawn));
  for (const { name, drawn } of stage.species) {
    const chip = document.createElement("span");
    chip.className = "chip";
    const ball = document.createElement("i");
    ball.style.background = look().species[name] ?? look().species.molecule;
    ball.style.width = ball.style.height = `${Math.max(7, 16 * drawn / largest)}px`;
    chip.append(ball, phrase(name));
    parent.append(chip);
  }
  if (stage.water) {
    const chip = document.createElement("span");
    chip.className = "chip";
    const ball = Object.assign(document.createElement("i"), { className: "liquid" });
    ball.style.background = look().liquid;
    chip.append(ball, word("liquid_water"));
    parent.append(chip);
  }
}

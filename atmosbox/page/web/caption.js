// The words under the box: what is seen, how it is drawn, and where it comes from.

import { figure } from "./figure.js";
import { numbers, phrase, story, word } from "./words.js";

// The sides of the box and what its walls are, in a sentence.
function boxSentence({ box }) {
  const sides = box.planar ? [box.length[0], box.length[2]] : box.length;
  const size = `${sides.map((side) => figure(side)).join(" × ")} ${box.unit}`;
  const laws = [...new Set(box.walls.filter((_, index) => !(box.planar && index >> 1 === 1)))];
  const warm = [...new Set(box.wall_temperature.filter((kelvin) => kelvin !== null).map((kelvin) => figure(kelvin - 273.15)))];
  const walls = laws.map((law) => (law === "heat_bath" && warm.length === 1 ? word("heat_bath_at", { temperature: `${warm[0]} °C` }) : word(law))).join("; ");
  return word(`${box.planar ? "flat_" : ""}box${box.gravity ? "_gravity" : ""}`, { size, walls });
}

// The first lines are there at once; a button opens the rest.
export function showCaption(parent, runs) {
  parent.replaceChildren();
  const text = document.createElement("div");
  const more = Object.assign(document.createElement("button"), { type: "button", className: "more" });
  const open = (wide) => {
    parent.classList.toggle("open", wide);
    more.textContent = word(wide ? "less" : "more");
    more.setAttribute("aria-expanded", wide);
  };
  more.onclick = () => open(!parent.classList.contains("open"));
  open(false);
  parent.append(text, more);
  const add = (kind, words) => words && text.append(Object.assign(document.createElement("p"), { className: kind, textContent: words }));
  const [{ stage }] = runs;
  add("story", story(stage.story));
  const lines = [...new Set(runs.flatMap(({ stage: each, notes = [] }) => [boxSentence(each), phrase(each.exaggeration), ...notes.map(phrase)]))];
  add("drawn", lines.join(" "));
  const settings = stage.settings.map(([name, value]) => `${name} ${value}`).join(", ");
  add("source", [...new Set(runs.map(({ footer }) => footer))].filter(Boolean).join(" | "));
  if (settings && runs.length === 1) add("source", settings);
}

// The words under the box: what is seen, how it is drawn, and where it comes from.

import { figure } from "./figure.js";

const WALLS = {
  specular: "smooth walls", periodic: "open sides: what leaves on one side comes in on the other",
  heat_bath: "walls kept at a temperature", piston: "a piston for a ceiling", pool: "a pool on the floor",
};

// The sides of the box and what its walls are, in a sentence.
function boxSentence({ box }) {
  const sides = box.planar ? [box.length[0], box.length[2]] : box.length;
  const size = `${sides.map((side) => figure(side)).join(" × ")} ${box.unit}`;
  const laws = [...new Set(box.walls.filter((_, index) => !(box.planar && index >> 1 === 1)))];
  const warm = [...new Set(box.wall_temperature.filter((kelvin) => kelvin !== null).map((kelvin) => figure(kelvin - 273.15)))];
  const walls = laws.map((law) => (law === "heat_bath" && warm.length === 1 ? `walls at ${warm[0]} °C` : WALLS[law])).join("; ");
  return `${box.planar ? "A flat box" : "A box"} of ${size}${box.gravity ? ", with gravity" : ""}: ${walls}.`;
}

// The first lines are there at once; a button opens the rest.
export function showCaption(parent, runs) {
  parent.replaceChildren();
  const text = document.createElement("div");
  const more = Object.assign(document.createElement("button"), { type: "button", className: "more" });
  const open = (wide) => {
    parent.classList.toggle("open", wide);
    more.textContent = wide ? "less" : "more about this picture";
    more.setAttribute("aria-expanded", wide);
  };
  more.onclick = () => open(!parent.classList.contains("open"));
  open(false);
  parent.append(text, more);
  const add = (kind, words) => words && text.append(Object.assign(document.createElement("p"), { className: kind, textContent: words }));
  const [{ stage }] = runs;
  add("story", stage.story);
  const lines = [...new Set(runs.flatMap(({ stage: each, notes = [] }) => [boxSentence(each), each.exaggeration, ...notes]))];
  add("drawn", lines.join(" "));
  const settings = stage.settings.map(([name, value]) => `${name} ${value}`).join(", ");
  add("source", [...new Set(runs.map(({ footer }) => footer))].filter(Boolean).join(" | "));
  if (settings && runs.length === 1) add("source", settings);
}

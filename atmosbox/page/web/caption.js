// The text under the box: what the picture shows, how it is drawn, and the provenance of the run.

import { figure } from "./figure.js";
import { phrase, story, word } from "./words.js";

const HOTTEST = 1e6;

// The sides of the box and the laws of its walls, in a sentence.
function boxSentence({ box }, { walls: kelvins = box.wall_temperature, length = box.length } = {}) {
  const sides = box.planar ? [length[0], length[2]] : length;
  const size = `${sides.map((side) => figure(side)).join(" × ")} ${box.unit}`;
  const baths = kelvins ?? box.wall_temperature;
  // a smooth wall that was given a temperature by hand is a heat bath; the temperature of a table's rim is not shown
  const now = box.walls.map((law, index) => (baths[index] !== null && law === "specular" ? "heat_bath" : law));
  const laws = [...new Set(now.filter((_, index) => !(box.planar && index >> 1 === 1)))];
  const warm = [...new Set(baths.filter((kelvin) => kelvin !== null && kelvin < HOTTEST).map((kelvin) => figure(kelvin - 273.15)))];
  const walls = laws.map((law) => (law === "heat_bath" && warm.length === 1 ? word("heat_bath_at", { temperature: `${warm[0]} °C` }) : word(law))).join("; ");
  return word(`${box.planar ? "flat_" : ""}box${box.gravity ? "_gravity" : ""}`, { size, walls });
}

// The small type; its parts contain numbers, so each part is translated as a phrase.
const named = (footer) => footer.split(" · ").map((part, place) => (place > 1 ? phrase(part) : part)).join(" · ");

const PARTS = ["modelled", "prescribed", "left_out", "exaggerated"];

// Show the first lines; a button opens the rest. Returns a function that takes what has changed in a running box:
// `{ walls, length }`.
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
  const add = (kind, words, name = "") => {
    const line = Object.assign(document.createElement("p"), { className: kind, hidden: !words });
    if (name) line.append(Object.assign(document.createElement("b"), { textContent: `${name}: ` }));
    line.append(words);
    text.append(line);
    return line;
  };
  const [{ stage }] = runs, { card } = stage;
  if (!card) add("story", story(stage.story));
  for (const part of PARTS) {
    if (!card?.[part]) continue;
    const line = add("card", phrase(card[part]), word(part));
    if (phrase(card[part]) === card[part]) line.lang = "en"; // not translated
  }
  const told = (now) => [...new Set(runs.flatMap(({ stage: each, notes = [] }) =>
    [boxSentence(each, now), phrase(each.exaggeration), ...notes.map(phrase)]))].join(" ");
  const drawn = add("drawn", told());
  add("source", [...new Set(runs.map(({ footer }) => footer))].filter(Boolean).map(named).join(" | "));
  if (!card && runs.length === 1) add("source", stage.settings.map((pair) => pair.join(" ")).join(", "));
  return (now) => {
    const words = told(now);
    if (drawn.textContent !== words) drawn.textContent = words;
  };
}

// The tools around the picture on all pages: cameras, colours, theme, tracing, the list of keys.

import { theme } from "./colour.js";
import { PLACES } from "./camera.js";
import { showLegend } from "./legend.js";
import { figure } from "./figure.js";
import { keys } from "./keys.js";
import { phrase, word } from "./words.js";

const find = (name) => document.getElementById(name);

// A group of buttons of which exactly one is pressed.
function choice(parent, names, chosen, choose) {
  parent.replaceChildren();
  names.forEach((name, index) => {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: name });
    button.setAttribute("aria-pressed", index === chosen);
    button.onclick = () => choose(index);
    parent.append(button);
  });
}

export class Sheet {
  // `stages`: the boxes on the page; `repaint` is called when the theme has changed.
  constructor(stages, repaint) {
    Object.assign(this, { stages, repaint });
    find("theme").onclick = () => this.turnTheme();
    find("help").onclick = () => this.help();
    find("trace").onclick = () => this.trace();
    find("menu").onclick = () => find("menu").setAttribute("aria-expanded", find("menu").getAttribute("aria-expanded") !== "true");
    matchMedia("(prefers-color-scheme: dark)").onchange = () => this.paint();
    stages.forEach((stage) => stage.parent.addEventListener("pick", ({ detail }) => this.follow(stage, detail)));
    this.#tools();
    this.follow(null, null); // when a box begins again, no molecule is followed
  }

  #tools() {
    const [{ mode, camera, record }] = this.stages;
    const modes = this.modes = record.species.length > 1 ? ["speed", "species"] : ["speed"];
    choice(find("colours"), modes.map((each) => word(each === "speed" ? "by_speed" : "by_kind")), modes.indexOf(mode), (index) => this.colour(modes[index]));
    find("colours").hidden = modes.length < 2;
    choice(find("cameras"), PLACES.map(({ name }, index) => `${index + 1} ${word(name)}`), camera.place, (index) => this.look(index));
    showLegend(find("legend"), record, mode);
  }

  colour(mode = this.modes[(this.modes.indexOf(this.stages[0].mode) + 1) % this.modes.length]) {
    for (const stage of this.stages) {
      stage.mode = mode;
      stage.tint();
    }
    this.#tools();
  }

  look(place) {
    for (const stage of this.stages) {
      stage.camera.go(place);
      stage.dirty = true;
    }
    this.#tools();
  }

  // Follow a molecule of a box, or no molecule.
  follow(chosen, molecule) {
    for (const stage of this.stages) stage.follow(stage === chosen ? molecule : null);
    find("trace").setAttribute("aria-pressed", molecule !== null && molecule !== undefined);
    document.body.dataset.traced = molecule ?? "";
    this.refresh?.();
  }

  trace() {
    const followed = this.stages.some((stage) => stage.trace.molecule !== null);
    this.follow(this.stages[0], followed ? null : this.stages[0].pick());
  }

  // A text about the molecule that is followed.
  story() {
    const stage = this.stages.find(({ trace }) => trace.molecule !== null);
    if (!stage?.shown) return "";
    const { first } = stage.shown, { molecule } = stage.trace, { record } = stage;
    const name = phrase(record.species[record.kind[molecule]].name.replace("molecule", "gas"));
    if (first.state[molecule]) return word("following_liquid", { name });
    const shown = first.speed[molecule] / 255 * first.fastest;
    const speed = record.speed.counted ? `${Math.round(shown)} ${word("neighbours")}` : `${figure(shown)} ${record.speed.unit}`;
    return word(record.particle === "disc" ? "following_disc" : "following", { name, speed });
  }

  turnTheme() {
    document.documentElement.dataset.theme = theme() === "dark" ? "light" : "dark";
    this.paint();
  }

  paint() {
    for (const stage of this.stages) stage.paint();
    this.#tools();
    this.repaint();
  }

  help() {
    const dialog = find("sheet"), seeks = !document.body.classList.contains("lab");
    dialog.innerHTML = `<h2>${word("keys")}</h2><dl></dl><p>${word("mouse")}${seeks ? ` ${word("mouse_time")}` : ""}</p><p>${word("libraries")}</p>`
      + `<form method='dialog'><button>${word("close")}</button></form>`;
    for (const [key, meaning] of keys().filter(([key]) => key !== "C" || this.modes.length > 1)) {
      dialog.querySelector("dl").append(
        Object.assign(document.createElement("dt"), { textContent: key }),
        Object.assign(document.createElement("dd"), { textContent: meaning }),
      );
    }
    dialog.showModal();
  }
}

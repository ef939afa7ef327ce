// What a scene asks of a class: a question to predict, and a task; besides, named settings to try, and undo.

import { spelled, withUnit } from "./figure.js";
import { language, numbers, phrase, word } from "./words.js";

const make = (kind, fields = {}) => Object.assign(document.createElement(kind), fields);
const written = (text) => numbers(phrase(text)).replace(/(^|[\s(])-(?=\d)/g, "$1−");

// Whether the means over both halves of the last frames before a place are near the goal: what only passes the goal on
// its way is not there. The value is the mean of all these frames, or the last one if it changes steadily.
function stands({ target, within }, series, end, frames, steady) {
  const mean = (from, to) => series.slice(from, to).reduce((sum, value) => sum + value, 0) / (to - from);
  const middle = end - Math.floor(frames / 2), begin = end - frames;
  const halves = frames > 1 ? [mean(begin, middle), mean(middle, end)] : [series[end - 1]];
  return { value: steady ? series[end - 1] : mean(begin, end), near: halves.every((each) => Math.abs(each - target) <= within) };
}

// A value with the decimals that matter for its goal.
function reading(value, { within, factor, offset, unit }) {
  const decimals = Math.max(0, 1 - Math.floor(Math.log10(within * factor)));
  return `${numbers((value * factor + offset).toFixed(Math.min(decimals, 20)).replace("-", "−"))} ${spelled(unit)}`.trim();
}

export class Lesson {
  // `tries` gets undo and the named settings, `parent` question and task; `say(message)` sends a message to the box;
  // `answered` is called when a choice is made.
  constructor(parent, tries, say, answered) {
    Object.assign(this, { parent, tries, say, answered, answer: null, told: "", scene: "" });
  }

  // Show what a scene offers, whose times have some unit. A new box begins: its task has not been done yet.
  offer(scene, { presets = [], predict = null, task = null } = {}, unit = "") {
    if (scene !== this.scene) this.answer = null;
    Object.assign(this, { scene, task, unit, reached: false, judged: 0 });
    const told = JSON.stringify([language, presets, predict, task]);
    if (told !== this.told) {
      this.back = make("button", { type: "button", id: "undo", textContent: `↶ ${word("undo")}`, title: word("undo_title"), onclick: () => this.undo() });
      this.tries.replaceChildren(this.back, ...presets.length ? [this.#presets(presets)] : []);
      this.parent.replaceChildren(...predict ? [this.#question(predict)] : [], ...task ? [this.#card(task)] : []);
      this.parent.hidden = !predict && !task;
    }
    this.told = told;
    if (task) this.#show([]);
  }

  undo() {
    this.say({ type: "undo" });
  }

  #presets(presets) {
    const list = make("select", { id: "presets", title: word("preset") });
    list.setAttribute("aria-label", word("presets"));
    list.append(make("option", { value: "", textContent: `${word("presets")} …` }));
    presets.forEach((title, number) => list.append(make("option", { value: number, textContent: phrase(title) })));
    list.onchange = () => {
      if (list.value !== "") this.say({ type: "preset", number: Number(list.value) });
      list.blur(); // so that keys control the player again
    };
    return list;
  }

  #section(kind, text) {
    const section = make("section", { className: kind });
    section.setAttribute("aria-label", word(kind));
    const ask = make("p", { className: "ask" });
    ask.append(make("b", { textContent: word(kind) }), ` ${written(text)}`);
    section.append(ask);
    return section;
  }

  // The question: its answer is told once the reader has chosen one.
  #question({ ask, choices, right, why }) {
    const section = this.#section("predict", ask), row = make("div", { className: "choices" });
    const said = make("p", { className: "why" });
    said.setAttribute("role", "status");
    const answer = (place) => {
      this.answer = place;
      row.replaceChildren(...choices.map((text, number) => {
        const button = make("button", { type: "button", textContent: written(text), onclick: () => {
          answer(number);
          this.answered();
        } });
        button.setAttribute("aria-pressed", number === place);
        if (place !== null && number === right - 1) button.classList.add("right");
        return button;
      }));
      said.textContent = place === null ? "" : `${word(place === right - 1 ? "predicted" : "not_predicted")} ${written(why)}`;
    };
    section.append(row, said);
    answer(this.answer);
    return section;
  }

  #card({ ask, hint }) {
    const section = this.#section("task", ask), tip = make("details");
    tip.append(make("summary", { textContent: word("hint") }), make("p", { textContent: written(hint) }));
    this.now = make("span", { className: "now" });
    this.done = make("span", { className: "done" });
    this.done.setAttribute("role", "status");
    const verdict = make("p", { className: "verdict" });
    verdict.append(this.done, this.now);
    section.append(verdict, tip);
    return section;
  }

  // Update the undo button: whether any change can be undone.
  show({ undo }) {
    if (this.back && undo !== undefined) this.back.disabled = !undo;
  }

  // Show values, which are means over some time unless it is 0.
  #show(values, time = 0) {
    const { reach } = this.task;
    const now = values.map((value, goal) => reading(value, reach[goal])).join(", ");
    const said = time ? word("mean_of", { values: now, time: withUnit(time, this.unit, 2) }) : now;
    const text = (key) => (said ? word(key, { values: said }) : "");
    this.done.textContent = this.reached ? text("reached") : "";
    this.now.textContent = this.reached ? "" : text("not_yet");
    this.now.closest(".task").classList.toggle("reached", this.reached);
  }

  // Check whether the measurements have come to the goal of the task.
  judge(values) {
    if (!this.task || this.reached) return;
    const { reach, frames, steady } = this.task, times = values.get("elapsed_time");
    const series = reach.map(({ name }) => values.get(name) ?? []);
    const count = Math.min(...series.map(({ length }) => length));
    if (count < this.judged) this.judged = 0;
    for (let end = Math.max(this.judged + 1, frames); end <= count && !this.reached; end += 1) {
      const found = reach.map((goal, place) => stands(goal, series[place], end, frames, steady));
      this.reached = found.every(({ near }) => near);
      if (this.reached || end === count) this.#show(found.map(({ value }) => value), steady || frames === 1 ? 0 : times[end - 1] - (times[end - 1 - frames] ?? 0));
    }
    this.judged = count;
  }
}

// The page of one saved run, or of two: all parts follow one clock.

import { showCaption } from "./caption.js";
import { Clock, naturalPace } from "./clock.js";
import { Numbers } from "./curves.js";
import { Film, unpack } from "./frames.js";
import { Graphs } from "./graphs.js";
import { listen } from "./keys.js";
import { Sheet } from "./sheet.js";
import { Stage } from "./stage.js";
import { Transport } from "./transport.js";
import { phrase, spell } from "./words.js";

const find = (name) => document.getElementById(name);
const letter = (run) => String.fromCharCode(65 + run);

export async function begin() {
  spell();
  const { runs } = JSON.parse(find("told").textContent);
  for (const [number, run] of runs.entries()) {
    run.film = new Film(await unpack(find(`frames-${number}`).textContent));
    run.numbers = new Numbers(run);
    find(`frames-${number}`).remove();
  }
  find("title").textContent = [...new Set(runs.map(({ stage }) => phrase(stage.title)))].join(" · ");
  document.body.dataset.runs = runs.length;
  find("boxes").replaceChildren();
  const stages = runs.map((run, number) => new Stage(frameOf(run, number, runs.length), run.stage, run.film));
  const [{ stage, film }] = runs;
  if (new Set(runs.map((run) => run.stage.box.unit)).size === 1) {
    const rooms = stages.map(({ camera }) => camera.room());
    for (const { camera } of stages) camera.besides = [0, 1, 2].map((axis) => Math.max(...rooms.map((room) => room[axis])));
  }
  const clock = new Clock({
    start: Math.min(...runs.map((run) => run.film.start)),
    end: Math.max(...runs.map((run) => run.film.end)),
    instants: film.frames.map(({ time }) => time),
    pace: naturalPace(film.end - film.start, crossing(stage)),
  });
  const graphs = new Graphs(find("graphs"), runs, (time) => clock.seek(time));
  const sheet = new Sheet(stages, () => graphs.repaint());
  showCaption(find("caption"), runs);
  new Transport(find("transport"), clock, stage.time.unit);
  const show = () => {
    stages.forEach((each, number) => {
      each.warm(runs[number].numbers.walls(clock.time));
      each.show(clock.time);
    });
    graphs.at(clock.time, clock.playing);
    find("status").textContent = sheet.story();
  };
  sheet.refresh = show;
  clock.addEventListener("time", show);
  clock.addEventListener("change", show);
  listen({
    " ": () => clock.toggle(),
    ArrowRight: ({ shiftKey }) => clock.step(shiftKey ? 10 : 1),
    ArrowLeft: ({ shiftKey }) => clock.step(shiftKey ? -10 : -1),
    ArrowUp: () => clock.accelerate(2),
    ArrowDown: () => clock.accelerate(0.5),
    Home: () => clock.seek(clock.start),
    End: () => clock.seek(clock.end),
    ...Object.fromEntries([0, 1, 2, 3].map((place) => [String(place + 1), () => sheet.look(place)])),
    c: () => sheet.colour(),
    t: () => sheet.trace(),
    d: () => sheet.turnTheme(),
    "?": () => sheet.help(),
  });
  show();
  run(stages, clock);
}

// The element of a box on the page, with a heading if there are several boxes.
function frameOf({ heading }, number, count) {
  const frame = document.createElement("div");
  frame.className = "box";
  if (count > 1) {
    const line = Object.assign(document.createElement("h2"), { className: `run-${number}` });
    line.append(Object.assign(document.createElement("b"), { textContent: letter(number) }), heading);
    frame.append(line);
  }
  find("boxes").append(frame);
  return frame;
}

// Time that a molecule of medium speed takes to cross the box, in the unit of the run's time.
function crossing({ box, metre, speed, time }) {
  const second = { s: 1, ns: 1e-9, ps: 1e-12 }[time.unit] ?? 1;
  return Math.max(...box.length) / metre / (0.4 * speed.high) / second;
}

function run(stages, clock) {
  let before = performance.now();
  const beat = (now) => {
    clock.pass(Math.min((now - before) / 1000, 0.1));
    before = now;
    for (const stage of stages) stage.render();
    document.body.dataset.ready = true;
    requestAnimationFrame(beat);
  };
  requestAnimationFrame(beat);
}

// All graphs of the page, of one run or of two together.

import { curvesOf } from "./curves.js";
import { Graph } from "./graph.js";
import { meansOf } from "./means.js";
import { highestShare, speedCurves, speedPanel } from "./speeds.js";

const PATIENCE = 90; // least time between two counts of the speeds [ms]

const letter = (run) => String.fromCharCode(65 + run);

// Panels of two runs are one graph if they show the same variables.
const subject = (panel) => JSON.stringify([panel.kind, panel.lines.map(({ x, y, role }) => [x.name, y.name, role])]);

export class Graphs {
  drawn = (graph, curves) => curves; // what a graph draws, which a prediction changes

  // `runs`: the stage, the film and the numbers of each run.
  constructor(parent, runs, seek) {
    Object.assign(this, { parent, runs, whole: Boolean(seek) });
    this.panels = [];
    parent.replaceChildren();
    runs.forEach(({ stage }, run) => {
      for (const panel of stage.panels) {
        const same = this.panels.find((other) => subject(other.panel) === subject(panel) && !other.members.some((each) => each.run === run));
        if (same) same.members.push({ run, panel });
        else this.panels.push({ panel, members: [{ run, panel }] });
      }
    });
    for (const each of this.panels) {
      each.graph = new Graph(parent, this.#titled(each), { runs: runs.length, seek, whole: Boolean(seek) });
    }
    // if the colours show numbers of neighbours, the frames hold no speeds; and a running box has room for four graphs,
    // of which a skew-T and the picture of a parcel take two
    const rows = this.panels.reduce((sum, { panel }) => sum + (panel.kind === "skewt" || panel.kind === "atmosphere" ? 2 : 1), 0);
    const told = runs.every(({ stage }) => !stage.speed.counted) && (this.whole || rows < 4);
    this.speeds = told ? new Graph(parent, speedPanel(runs[0].stage), { runs: runs.length }) : null;
    this.speeds?.element.classList.add("speeds");
    parent.dataset.count = this.panels.length + (told ? 1 : 0);
    this.refresh();
    this.highest = 0;
  }

  #titled({ panel, members }) {
    if (this.runs.length === 1) return panel;
    const title = members.length > 1 ? panel.title : `${letter(members[0].run)}: ${panel.title}`;
    return { ...panel, title, sentences: members.flatMap(({ run, panel: own }) => own.sentences.map((text) => text.replace(" = ", ` = ${letter(run)} `))) };
  }

  // Draw the curves again, because new values may have come.
  refresh() {
    for (const { graph, members } of this.panels) {
      graph.set(this.drawn(graph, members.flatMap(({ run, panel }) => curvesOf(panel, this.runs[run].numbers).map((curve) => ({ ...curve, run })))));
    }
  }

  // Show a time on all graphs. While the film runs, the speeds need not be counted for every picture.
  at(time, running = false) {
    for (const { graph } of this.panels) graph.at(time);
    if (!this.speeds) return;
    const now = performance.now();
    if (running && now - this.counted < PATIENCE) return;
    this.counted = now;
    const curves = this.runs.flatMap(({ stage, film }, run) => {
      if (!film.frames.length) return [];
      return speedCurves(film.frames[film.before(time)], stage).map((curve) => ({ ...curve, run }));
    });
    this.#rescale(curves);
    this.speeds.fixed = { y: [0, this.highest || 1] };
    this.speeds.set(curves);
  }

  // Set the upper end of the axis of the speeds. For a complete film it is fixed and high enough for all frames; for a
  // running box it changes when the curve comes near the upper end of the graph, or is low in it.
  #rescale(curves) {
    const peak = curves.filter(({ role }) => role === "theory").reduce((most, { y }) => Math.max(most, ...y), 0);
    if (!this.highest) this.highest = Math.max(...this.runs.map(({ stage, film }) => highestShare(film.frames, stage)));
    else if (!this.whole && peak && (peak > 0.9 * this.highest || peak < 0.4 * this.highest)) this.highest = 1.5 * peak;
  }

  // Write the means of what was measured since a moment beside those of theory, unless the curves are means already.
  compare(from) {
    const told = this.panels.filter(({ graph, panel }) => graph.overTime && !panel.lines.some(({ y }) => y.name.startsWith("running_")));
    for (const { graph } of told) graph.say(meansOf(graph.curves, from, graph.panel.y.unit));
  }

  // Show named guides or hide them.
  guide(shown) {
    for (const { graph } of this.panels) graph.guided = shown;
  }

  repaint() {
    for (const { graph } of this.panels) graph.repaint();
    this.speeds?.repaint();
  }
}

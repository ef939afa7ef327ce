// Names, units and numbers at the edges of the box: HTML text over the picture, so that it stays sharp.

import * as THREE from "three";
import { round, scaled, ticks } from "./figure.js";
import { word } from "./words.js";

const GAP = 16, FAR = 44; // pixels between an edge and its numbers, and between an edge and its name
const LOW = 200; // a picture that is lower has no labels [pixel]
const SHORT = 60, END_ON = 0.93; // an edge that looks shorter [pixel], or whose cosine is larger, has no labels

export class Labels {
  constructor(parent, box) {
    this.box = box;
    this.layer = document.createElement("div");
    this.layer.className = "labels";
    parent.append(this.layer);
    this.pool = [];
    this.used = 0;
  }

  // Write the labels for the present view of the box.
  write(length, camera, width, height) {
    this.used = 0;
    this.taken = [];
    const edges = [];
    const project = (point) => {
      const seen = new THREE.Vector3(...point).project(camera);
      return { x: (seen.x + 1) / 2 * width, y: (1 - seen.y) / 2 * height, depth: seen.z };
    };
    const middle = project(length.map((side) => side / 2));
    const [x, y, z] = length.map((side, axis) => camera.position.getComponent(axis) - side / 2);
    this.side = [x, y, z].map((part) => Math.abs(part) / Math.hypot(x, y, z));
    this.level = z > 1.7 * Math.hypot(x, y) ? length[2] : 0; // from above, the ceiling is the nearer edge
    for (const axis of height < scaled(LOW) ? [] : this.box.planar ? [0, 2] : [0, 1, 2]) {
      if (this.side[axis] > END_ON) continue;
      const edge = this.#edge(axis, length, project);
      if (edge) edges.push([axis, edge]);
    }
    for (const named of [true, false]) for (const [axis, edge] of edges) this.#label(axis, length, edge, project, middle, named);
    for (const spare of this.pool.slice(this.used)) spare.style.display = "none";
  }

  // The edge with the labels of an axis: for height the leftmost vertical edge, otherwise the lowest edge in the picture.
  #edge(axis, length, project) {
    const ends = axis === 2 ? [[0, 0], [0, 1], [1, 0], [1, 1]] : [[0, 0], [1, 0]];
    let best = null;
    for (const [first, second] of ends) {
      const at = [0, 1, 2].map((other) => (other === axis ? 0 : (other === (axis === 0 ? 1 : 0) ? first : second) * length[other]));
      if (this.box.planar) at[1] = length[1] / 2;
      if (axis !== 2) at[2] = this.level;
      const low = project(at), high = project(at.map((value, other) => (other === axis ? length[axis] : value)));
      if (Math.hypot(high.x - low.x, high.y - low.y) < scaled(SHORT)) continue;
      const score = axis === 2 ? -(low.x + high.x) : low.y + high.y;
      if (!best || score > best.score) best = { at, low, high, score };
    }
    return best;
  }

  // The name of an edge or, in a second round, its numbers.
  #label(axis, length, { at, low, high }, project, middle, named) {
    const size = Math.hypot(high.x - low.x, high.y - low.y);
    let across = { x: (high.y - low.y) / size, y: -(high.x - low.x) / size };
    const outward = ((low.x + high.x) / 2 - middle.x) * across.x + ((low.y + high.y) / 2 - middle.y) * across.y;
    if (outward < 0) across = { x: -across.x, y: -across.y };
    const flat = axis === 2 && this.box.planar && !this.box.gravity; // a table has no height
    const name = `${flat ? "z" : ["x", "y", word("height_z")][axis]} (${this.box.unit})`;
    const far = scaled(FAR);
    if (named) this.#text(name, (low.x + high.x) / 2 + across.x * far, (low.y + high.y) / 2 + across.y * far, axis === 2 ? "axis up" : "axis");
    if (named) return;
    for (const value of ticks(0, length[axis], Math.max(1, size / scaled(75)))) {
      if (value === 0 && axis !== 2) continue; // the corner has one zero, that of the height
      const spot = project(at.map((old, other) => (other === axis ? value : old)));
      this.#text(round(value), spot.x + across.x * scaled(GAP), spot.y + across.y * scaled(GAP), "tick");
    }
  }

  // Write a text, unless it is a number for which there is no room.
  #text(content, x, y, kind) {
    const half = scaled(4 * content.length), [wide, high] = kind === "axis up" ? [scaled(9), half] : [half, scaled(9)];
    if (kind === "tick" && this.taken.some((other) => Math.abs(x - other.x) < wide + other.wide && Math.abs(y - other.y) < high + other.high)) return;
    this.taken.push({ x, y, wide, high });
    let item = this.pool[this.used];
    if (!item) {
      item = document.createElement("span");
      this.pool.push(item);
      this.layer.append(item);
    }
    this.used += 1;
    if (item.textContent !== content) item.textContent = content;
    item.className = kind;
    item.style.display = "";
    const turn = kind === "axis up" ? " rotate(-90deg)" : "";
    item.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)${turn}`;
  }
}

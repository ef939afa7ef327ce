// A box on the page: the picture in three dimensions and the names at its edges.

import * as THREE from "three";
import { look, parse, speedColour, theme } from "./colour.js";
import { Camera } from "./camera.js";
import { Walls } from "./walls.js";
import { Labels } from "./labels.js";
import { Molecules } from "./molecules.js";
import { Trace } from "./trace.js";
import { Wind } from "./wind.js";
import { phrase, word } from "./words.js";

const SHARPEST = 2; // greatest number of pixels of the screen per pixel of the page
const CATCH = 14; // pixels within which a click finds a molecule

export class Stage {
  constructor(parent, record, film) {
    this.record = record;
    this.film = film;
    this.mode = record.species.length > 1 && record.particle === "molecule" ? "species" : "speed";
    this.table = Array.from({ length: 256 }, (_, share) => speedColour((share / 255) ** record.speed.bend));
    this.wraps = [0, 1, 2].map((axis) => record.box.walls[2 * axis] === "periodic");
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", word("picture", { title: phrase(record.title) }));
    parent.append(this.canvas);
    this.parent = parent;
    this.renderer = this.#rendererOrSentence();
    this.scene = new THREE.Scene();
    const sun = new THREE.DirectionalLight(0xffffff, 2.2);
    sun.position.set(-2, -3, 5);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8896a8, 1.7), sun);
    this.molecules = new Molecules(record.molecules_shown);
    this.walls = new Walls(record.box);
    this.trace = new Trace();
    this.scene.add(this.walls.object, this.molecules.object, this.trace.object);
    this.wind = null;
    this.labels = new Labels(parent, record.box);
    this.camera = new Camera(this.canvas, record.box, () => { this.dirty = true; });
    this.sizes = Float32Array.from(record.kind, (kind, index) => record.size?.[index] ?? record.species[kind].drawn);
    this.shown = null;
    this.dirty = true;
    this.#watch();
    this.paint();
  }

  // The renderer; null, with a sentence in place of the picture, if the browser cannot draw in three dimensions.
  #rendererOrSentence() {
    try {
      return new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, powerPreference: "high-performance" });
    } catch {
      this.canvas.hidden = true;
      const sentence = document.createElement("p");
      sentence.className = "no-picture";
      sentence.textContent = word("no_picture");
      this.parent.append(sentence);
      return null;
    }
  }

  #watch() {
    new ResizeObserver(() => this.resize()).observe(this.parent);
    let down = null;
    this.canvas.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener("click", (event) => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
      const frame = this.canvas.getBoundingClientRect();
      const found = this.pick(event.clientX - frame.left, event.clientY - frame.top);
      this.parent.dispatchEvent(new CustomEvent("pick", { detail: found, bubbles: true }));
    });
  }

  // The colours of the theme.
  paint() {
    const background = parse(look().background);
    this.scene.background = new THREE.Color().setRGB(...background, THREE.SRGBColorSpace);
    this.molecules.light(background, theme() === "dark");
    this.walls.paint();
    this.wind?.paint();
    this.tint();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.parent;
    if (!this.renderer || !width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, SHARPEST));
    this.renderer.setSize(width, height, false);
    for (const { material } of [this.molecules, this.walls.mist]) material.uniforms.height.value = this.renderer.domElement.height;
    this.sized = true;
    this.camera.resize(width, height);
    this.dirty = true;
  }

  // Put all objects to their positions at a time.
  show(time) {
    if (!this.film.frames.length) return;
    const moment = this.film.around(time);
    const turned = !this.shown || this.shown.first !== moment.first;
    this.shown = moment;
    this.molecules.place(moment, this.wraps, this.sizes);
    const { first, second, share } = moment;
    this.length = first.length.map((side, axis) => side + (second.length[axis] - side) * share);
    if (this.length[2] > this.record.box.reach * 1.0001) {
      this.record.box.reach = this.walls.height = this.length[2] * 1.25;
      if (this.camera.place !== null) this.camera.go(this.camera.place);
    }
    this.walls.arrange(this.length, first.drops, second.drops, share);
    if (turned) this.tint();
    this.#follow();
    this.dirty = true;
  }

  // Tint the walls by their temperatures; null for a wall whose temperature is not known.
  warm(temperatures) {
    this.walls.warm(temperatures);
    this.dirty = true;
  }

  // Draw the wind as arrows.
  blow(told) {
    if (!this.length) return;
    if (!this.wind) {
      this.wind = new Wind(this.parent);
      this.scene.add(this.wind.object);
    }
    this.wind.blow(told, this.length);
    this.dirty = true;
  }

  // Colour molecules by speed, or by kind.
  tint() {
    if (!this.shown) return;
    const { speed } = this.shown.first;
    const kinds = this.record.species.map(({ name }) => parse(look().species[name] ?? look().species.molecule));
    const traced = this.#traced(), chosen = this.trace.molecule;
    this.molecules.colour((index, array, at) => {
      const rgb = index === chosen ? traced : this.mode === "speed" ? this.table[speed[index]] : kinds[this.record.kind[index]];
      [array[at], array[at + 1], array[at + 2]] = rgb;
    });
    this.dirty = true;
  }

  // Give the followed molecule a colour that no other molecule has.
  #traced() {
    return parse(this.mode === "speed" ? look().traced : look().ink);
  }

  #follow() {
    const { molecule } = this.trace;
    if (molecule === null) return;
    const { first, index } = this.shown;
    const at = 3 * molecule;
    const now = first.state[molecule] ? null : [...this.molecules.position.array.slice(at, at + 3)];
    this.molecules.size.array[molecule] *= 1.7;
    this.molecules.size.needsUpdate = true;
    this.trace.draw(this.film, index, this.wraps, now, this.#traced());
  }

  follow(molecule) {
    this.trace.molecule = molecule;
    this.trace.object.visible = molecule !== null;
    this.tint();
  }

  // The molecule at a point of the picture, null if there is none; without a point, one near the middle of the box.
  pick(x, y) {
    if (!this.shown) return null;
    const { clientWidth: width, clientHeight: height } = this.parent;
    const point = new THREE.Vector3();
    let best = null, least = Infinity;
    for (let index = 0; index < this.molecules.count; index += 1) {
      if (this.shown.first.state[index]) continue;
      point.fromArray(this.molecules.position.array, 3 * index);
      if (x === undefined) {
        const off = point.distanceTo(new THREE.Vector3(...this.length).multiplyScalar(0.5));
        if (off < least) [best, least] = [index, off];
        continue;
      }
      point.project(this.camera.eye);
      const off = Math.hypot((point.x + 1) / 2 * width - x, (1 - point.y) / 2 * height - y);
      if (off < CATCH && off + 20 * point.z < least) [best, least] = [index, off + 20 * point.z];
    }
    return best;
  }

  // Free the memory of the graphics card.
  leave() {
    this.renderer?.dispose();
    this.renderer?.forceContextLoss();
    this.camera.controls.dispose();
    this.parent.remove();
  }

  // Draw, if anything has changed.
  render() {
    if (!this.dirty || !this.length || !this.sized) return;
    this.dirty = false;
    this.walls.seenFrom(this.camera.eye.position, this.length[2]);
    this.molecules.material.uniforms.depths.value.set(...this.camera.depths());
    this.renderer.render(this.scene, this.camera.eye);
    this.labels.write(this.length, this.camera.eye, this.parent.clientWidth, this.parent.clientHeight);
  }
}

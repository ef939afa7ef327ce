// The path of one molecule that is followed, through the last frames.

import * as THREE from "three";

const FRAMES = 48; // of the path

export class Trace {
  constructor() {
    this.molecule = null;
    const geometry = new THREE.BufferGeometry();
    this.place = new THREE.BufferAttribute(new Float32Array(6 * (FRAMES + 2)), 3);
    this.tint = new THREE.BufferAttribute(new Float32Array(8 * (FRAMES + 2)), 4);
    geometry.setAttribute("position", this.place);
    geometry.setAttribute("color", this.tint);
    this.object = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ vertexColors: true, transparent: true }));
    this.object.frustumCulled = false;
    this.object.visible = false;
  }

  // Draw the path up to the present position of the molecule. The path has gaps where the molecule was in the liquid and
  // where it left through a periodic side and came back through the opposite one.
  draw(film, index, wraps, now, rgb) {
    this.object.visible = this.molecule !== null;
    if (this.molecule === null) return;
    const points = [];
    for (let number = Math.max(0, index - FRAMES); number <= index; number += 1) {
      const frame = film.frames[number];
      const at = 3 * this.molecule;
      points.push(frame.state[this.molecule] ? null
        : [0, 1, 2].map((axis) => (frame.position[at + axis] / 65535) * frame.length[axis]));
    }
    points.push(now);
    const length = film.frames[index].length;
    const colour = new THREE.Color().setRGB(...rgb, THREE.SRGBColorSpace);
    let used = 0;
    for (let number = 1; number < points.length; number += 1) {
      const [from, to] = [points[number - 1], points[number]];
      if (!from || !to || from.some((value, axis) => wraps[axis] && Math.abs(to[axis] - value) > length[axis] / 2)) continue;
      for (const [point, age] of [[from, number - 1], [to, number]]) {
        this.place.array.set(point, 3 * used);
        this.tint.array.set([colour.r, colour.g, colour.b, 0.08 + 0.92 * (age / (points.length - 1)) ** 1.5], 4 * used);
        used += 1;
      }
    }
    this.object.geometry.setDrawRange(0, used);
    this.place.needsUpdate = this.tint.needsUpdate = true;
  }
}

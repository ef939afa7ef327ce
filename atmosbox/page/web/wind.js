// The wind in a plane box: arrows over the molecules, and the speed of the longest one in words.

import * as THREE from "three";
import { look, parse } from "./colour.js";
import { figure } from "./figure.js";
import { word } from "./words.js";

const MOST = 16, NEAR = 36; // arrows along the box, and the least number of pixels of the picture for each
const LONGEST = 1.3, SHAFT = 0.05, HEAD = 0.15, TIP = 0.34, RIM = 0.045; // in distances between two arrows

export class Wind {
  constructor(parent) {
    this.object = new THREE.Group();
    this.layers = [RIM, 0].map((rim, place) => {
      const material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, side: THREE.DoubleSide });
      const mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
      Object.assign(mesh, { renderOrder: 1 + place, frustumCulled: false });
      this.object.add(mesh);
      return { rim, mesh };
    });
    this.words = Object.assign(document.createElement("p"), { className: "wind" });
    parent.append(this.words);
    this.paint();
  }

  paint() {
    const { background, ink } = look();
    [background, ink].forEach((colour, place) => this.layers[place].mesh.material.color.setRGB(...parse(colour), THREE.SRGBColorSpace));
  }

  // Draw the wind of equal cells; `values` are its components along x, then those along z. Arrows stand for the mean of
  // as many cells as make them few enough, and the longest is short if it is slower than `least`.
  blow({ rows, columns, values, least }, length) {
    const most = Math.min(MOST, Math.max(2, this.words.parentElement.clientWidth / NEAR));
    const step = Math.ceil(columns / most), arrows = [];
    for (let row = 0; row < rows; row += step) {
      for (let column = 0; column < columns; column += step) {
        const last = [Math.min(row + step, rows), Math.min(column + step, columns)], mean = [0, 0];
        const share = 1 / ((last[0] - row) * (last[1] - column));
        for (let z = row; z < last[0]; z += 1) {
          for (let x = column; x < last[1]; x += 1) {
            for (const axis of [0, 1]) mean[axis] += share * values[(axis * rows + z) * columns + x];
          }
        }
        arrows.push({ x: (column + last[1]) / 2 / columns * length[0], z: (row + last[0]) / 2 / rows * length[2], mean });
      }
    }
    const fastest = Math.max(...arrows.map(({ mean }) => Math.hypot(...mean))), apart = step * length[0] / columns;
    for (const { rim, mesh } of this.layers) {
      const points = arrows.flatMap((arrow) => this.#shape(arrow, LONGEST / Math.max(fastest, least), rim, apart, length[1] / 2));
      mesh.geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
    }
    this.words.textContent = word("longest_arrow", { speed: `${figure(fastest, 2)} m/s` });
  }

  // The three triangles of an arrow, wider by a rim.
  #shape({ x, z, mean: [along, up] }, scale, rim, apart, y) {
    const speed = Math.hypot(along, up), size = speed * scale;
    if (!(size > 0)) return [];
    const [dx, dz] = [along / speed, up / speed], tip = Math.min(TIP, 0.6 * size), thin = Math.min(1, size / TIP);
    const at = (far, side) => [x + apart * (far * dx - side * dz), y, z + apart * (far * dz + side * dx)];
    const [tail, neck, end] = [-size / 2 - rim, size / 2 - tip, size / 2 + 2 * rim], wide = SHAFT * thin + rim, head = HEAD * thin + 1.6 * rim;
    const [a, b, c, d] = [at(tail, wide), at(tail, -wide), at(neck, wide), at(neck, -wide)];
    return [a, b, c, c, b, d, at(neck - rim, head), at(neck - rim, -head), at(end, 0)].flat();
  }
}

// The camera: four fixed places, and its control by mouse or finger.

import * as THREE from "three";
import { OrbitControls } from "./OrbitControls.js";
import { scaled } from "./figure.js";

const DEGREES = Math.PI / 180;
const MARGIN = [64, 58]; // pixels around the box, for the numbers at its edges
const NARROW = 0.16, LOW = 200; // share of a picture that a margin may take; a picture that is lower has none [pixel]
const FLAT = 0.6, STEEP = 32; // a box that is lower, in widths, is seen from the corner at this elevation [degree]

// Direction of the camera by azimuth and elevation [degree]; `closer` divides the distance from which all of the box is
// seen.
export const PLACES = [
  { name: "corner", azimuth: -58, elevation: 17, closer: 1 },
  { name: "front", azimuth: -90, elevation: 0, closer: 1 },
  { name: "above", azimuth: -90, elevation: 89.9, closer: 1 },
  { name: "close_up", azimuth: -66, elevation: 9, closer: 2.4 },
];

export class Camera {
  constructor(canvas, box, changed) {
    this.box = box;
    this.eye = new THREE.PerspectiveCamera(32, 1, 0.001, 1000);
    this.eye.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.eye, canvas);
    this.controls.enablePan = false;
    this.controls.rotateSpeed = 0.8;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => { this.place = null; });
    this.place = box.planar ? 1 : 0;
    this.free = [1, 1]; // until the size of the picture is known
  }

  // Size of the space that the picture must show: the largest box of the run, with the piston on its ceiling. Two boxes
  // side by side get the same size, so that they are seen from the same distance and can be compared.
  room() {
    const [x, y] = this.box.length;
    const z = this.box.reach * (this.box.walls[5] === "piston" ? 1.18 : 1);
    return [x, y, z].map((side, axis) => Math.max(side, this.besides?.[axis] ?? 0));
  }

  // Move the camera to one of the places, at a distance from which the highest box of the run is in the picture.
  go(place) {
    this.place = place;
    const { azimuth, closer, ...seen } = PLACES[place], [x, y, z] = this.room();
    const elevation = place === 0 && z < FLAT * Math.min(x, y) ? STEEP : seen.elevation;
    const middle = new THREE.Vector3(x / 2, y / 2, z / 2);
    const side = new THREE.Vector3(
      Math.cos(azimuth * DEGREES) * Math.cos(elevation * DEGREES),
      Math.sin(azimuth * DEGREES) * Math.cos(elevation * DEGREES),
      Math.sin(elevation * DEGREES),
    );
    const corners = [];
    for (const cx of [0, x]) for (const cy of [0, y]) for (const cz of [0, z]) corners.push(new THREE.Vector3(cx, cy, cz));
    const radius = middle.length();
    let near = radius * 0.2, far = radius * 60;
    for (let round = 0; round < 40; round += 1) {
      const distance = Math.sqrt(near * far);
      this.#stand(middle, side, distance, radius);
      const reach = Math.max(...corners.map((corner) => {
        const seen = corner.clone().project(this.eye);
        return seen.z > 1 ? Infinity : Math.max(Math.abs(seen.x) / this.free[0], Math.abs(seen.y) / this.free[1]);
      }));
      if (reach > 1) near = distance; else far = distance;
    }
    this.#stand(middle, side, far / closer, radius);
    this.controls.target.copy(middle);
    this.controls.minDistance = radius * 0.05;
    this.controls.maxDistance = radius * 30;
    this.controls.update();
  }

  #stand(middle, side, distance, radius) {
    this.eye.position.copy(middle).addScaledVector(side, distance);
    this.eye.near = radius * 0.01;
    this.eye.far = distance + 30 * radius;
    this.eye.lookAt(middle);
    this.eye.updateProjectionMatrix();
    this.eye.updateMatrixWorld(true);
  }

  resize(width, height) {
    this.eye.aspect = width / height;
    this.free = [width, height].map((size, axis) => 1 - 2 * (height < scaled(LOW) ? 0.02 : Math.min(scaled(MARGIN[axis]) / size, NARROW)));
    this.eye.updateProjectionMatrix();
    if (this.place !== null) this.go(this.place);
  }

  // Least and greatest distance of a point of the box from the camera, for the haze.
  depths() {
    const [x, y, z] = this.room();
    const distance = this.eye.position.distanceTo(new THREE.Vector3(x / 2, y / 2, z / 2));
    const radius = Math.hypot(x, y, z) / 2;
    return [Math.max(distance - radius, 0), distance + radius];
  }
}

// The objects around the molecules: edges, walls tinted by their temperature, the piston, the liquid.

import * as THREE from "three";
import { look, parse, wallColour } from "./colour.js";
import { Mist } from "./mist.js";

const DROPS = 96; // greatest number that is drawn
const POOL = -1; // a drop of negative radius is a layer on the floor: a pool for this value, else rain

const colour = (rgb) => new THREE.Color().setRGB(...rgb, THREE.SRGBColorSpace);

export class Walls {
  constructor(box) {
    this.box = box;
    this.object = new THREE.Group();
    const side = Math.cbrt(box.length[0] * box.length[1] * box.length[2]);
    this.bar = 0.006 * (box.planar ? Math.max(...box.length) : side);
    this.height = box.reach;
    const frame = new THREE.BoxGeometry(1, 1, 1);
    this.edgeMaterial = new THREE.MeshBasicMaterial();
    this.ghostMaterial = new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.28 });
    this.edges = edgesOf(box).map((edge) => this.#mesh(frame, this.edgeMaterial, edge));
    this.ghosts = box.walls[5] === "piston"
      ? [[0, 0], [0, 1], [1, 0], [1, 1]].map((ends) => this.#mesh(frame, this.ghostMaterial, { axis: 2, ends })) : [];
    this.walls = box.walls.map((law, index) => this.#wall(law, index)).filter(Boolean);
    this.#piston();
    this.#liquid();
    this.paint();
  }

  #mesh(geometry, material, data = {}) {
    const mesh = new THREE.Mesh(geometry, material);
    Object.assign(mesh.userData, data);
    this.object.add(mesh);
    return mesh;
  }

  // A wall is seen only from inside: a wall between the camera and the molecules does not hide them.
  #wall(law, index) {
    if (law === "periodic" || law === "piston" || this.box.planar) return null;
    const material = new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false });
    const mesh = this.#mesh(new THREE.PlaneGeometry(1, 1), material, { law, index });
    mesh.renderOrder = -1;
    const axis = index >> 1, inward = index & 1 ? -1 : 1;
    if (axis === 0) mesh.rotation.set(0, inward * Math.PI / 2, 0);
    if (axis === 1) mesh.rotation.set(-inward * Math.PI / 2, 0, 0);
    if (axis === 2 && inward < 0) mesh.rotation.set(Math.PI, 0, 0);
    return mesh;
  }

  #piston() {
    this.plate = null;
    if (this.box.walls[5] !== "piston") return;
    this.metal = new THREE.MeshPhongMaterial({ transparent: true, opacity: 0.9, shininess: 60 });
    this.plate = this.#mesh(new THREE.BoxGeometry(1, 1, 1), this.metal);
    this.rod = this.#mesh(new THREE.CylinderGeometry(1, 1, 1, 28), this.metal);
    this.rod.rotation.x = Math.PI / 2;
  }

  #liquid() {
    this.liquidMaterial = new THREE.MeshPhongMaterial({ shininess: 90, transparent: true, opacity: 0.9 });
    this.layerMaterial = new THREE.MeshPhongMaterial({ shininess: 50, transparent: true, opacity: 0.75 });
    this.drops = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 22, 16), this.liquidMaterial, DROPS);
    this.drops.frustumCulled = false;
    this.drops.count = 0;
    this.drops.renderOrder = 1; // on top of the mist
    this.mist = new Mist(DROPS);
    this.layer = this.#mesh(new THREE.BoxGeometry(1, 1, 1), this.layerMaterial);
    this.layer.visible = false;
    this.object.add(this.drops, this.mist.object);
  }

  // The colours of the theme.
  paint() {
    const now = look();
    this.edgeMaterial.color = colour(parse(now.edge));
    this.ghostMaterial.color = colour(parse(now.edge));
    this.liquidMaterial.color = colour(parse(now.liquid));
    this.layerMaterial.color = colour(parse(now.liquid));
    this.mist.material.uniforms.white.value = colour(parse(now.cloud));
    if (this.metal) this.metal.color = colour(parse(now.metal));
    for (const wall of this.walls) {
      const warm = this.box.wall_temperature[wall.userData.index];
      const heated = warm !== null;  // also a smooth wall that was given a temperature by hand
      const sky = this.box.misty && this.box.walls[5] === "piston"; // a cloud is white, and seen against the sky
      wall.material.color = colour(heated ? wallColour(warm) : parse(sky ? now.sky : now.edge));
      wall.material.opacity = heated ? 0.3 : sky ? 0.75 : 0.06;
    }
  }

  // Take new temperatures of the walls.
  warm(temperatures) {
    if (!temperatures.some((kelvin, index) => kelvin !== null && kelvin !== this.box.wall_temperature[index])) return;
    this.box.wall_temperature = this.box.wall_temperature.map((old, index) => temperatures[index] ?? old);
    this.paint();
  }

  // Draw the box with its present sides, and the liquid.
  arrange(length, drops, sharesDrops, share) {
    const [x, y, z] = length;
    for (const edge of this.edges) stretch(edge, length, this.bar, 0);
    for (const ghost of this.ghosts) {
      ghost.visible = this.height > z * 1.001;
      stretch(ghost, [x, y, this.height], this.bar * 0.6, 0);
    }
    for (const wall of this.walls) {
      const { index } = wall.userData, axis = index >> 1;
      wall.position.set(x / 2, y / 2, z / 2);
      wall.position.setComponent(axis, index & 1 ? length[axis] : 0);
      wall.scale.set(axis === 0 ? z : x, axis === 1 ? z : y, 1);
    }
    if (this.plate) {
      const thick = 6 * this.bar;
      this.plate.position.set(x / 2, y / 2, z + thick / 2);
      this.plate.scale.set(x * 1.02, this.box.planar ? y : y * 1.02, thick);
      const wide = 0.07 * Math.min(x, y), long = 0.16 * Math.max(this.height, z);
      this.rod.position.set(x / 2, y / 2, z + thick + long / 2);
      this.rod.scale.set(wide, long, wide);
    }
    this.#pour(length, drops, sharesDrops, share);
  }

  #pour([x, y, z], drops, next, share) {
    const matrix = new THREE.Matrix4();
    const moves = next && next.length === drops.length;
    let number = 0;
    this.layer.visible = false;
    for (let index = 0; index < drops.length; index += 4) {
      const [px, py, pz, radius] = [0, 1, 2, 3].map((part) =>
        moves ? drops[index + part] + (next[index + part] - drops[index + part]) * share : drops[index + part]);
      if (drops[index + 3] < 0) {
        const deep = (Math.round(drops[index + 3]) === POOL ? 0.16 : 0.05) * Math.min(z, x) * Math.max(pz, 0.02);
        this.layer.visible = true;
        this.layerMaterial.opacity = Math.round(drops[index + 3]) === POOL ? 0.75 : 0.4;
        this.layer.position.set(x / 2, y / 2, -deep / 2);
        this.layer.scale.set(x, y, deep);
      } else if (number < DROPS) {
        matrix.makeScale(radius, radius, radius).setPosition(px, py, pz);
        this.drops.setMatrixAt(number, matrix);
        this.mist.position.array.set([px, py, pz], 3 * number);
        this.mist.radius.array[number] = radius;
        number += 1;
      }
    }
    this.drops.count = number;
    this.drops.instanceMatrix.needsUpdate = true;
    this.mist.show(this.box.misty ? number : 0);
  }

  // From above, the piston is transparent.
  seenFrom(eye, height) {
    if (!this.metal) return;
    const above = eye.z > height;
    Object.assign(this.metal, { opacity: above ? 0.2 : 0.92, depthWrite: !above });
  }
}

// The twelve edges of the box, or the four edges of a planar one.
function edgesOf(box) {
  const found = [];
  for (let axis = 0; axis < 3; axis += 1) {
    for (const first of [0, 1]) {
      for (const second of [0, 1]) found.push({ axis, ends: [first, second] });
    }
  }
  if (!box.planar) return found;
  const flat = found.filter(({ axis, ends }) => axis !== 1 && ends[axis === 0 ? 0 : 1] === 1);
  return flat.map(({ axis, ends: [first, second] }) => ({ axis, ends: axis === 0 ? [0.5, second] : [first, 0.5] }));
}

function stretch(mesh, length, width, start) {
  const { axis, ends } = mesh.userData;
  const others = [0, 1, 2].filter((each) => each !== axis);
  mesh.scale.set(width, width, width);
  mesh.scale.setComponent(axis, length[axis] - start + width);
  mesh.position.setComponent(axis, (start + length[axis]) / 2);
  others.forEach((other, index) => mesh.position.setComponent(other, ends[index] * length[other]));
}

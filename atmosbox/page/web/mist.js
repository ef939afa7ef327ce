// The mist of a cloud: a soft white veil about each droplet, wider than the droplet, so that many together look like a cloud.

import * as THREE from "three";

const WIDTH = 6; // of a veil, in diameters of its droplet

const VERTEX = `
attribute float radius;
uniform float height;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = radius * ${(2 * WIDTH).toFixed(1)} * projectionMatrix[1][1] * 0.5 * height / gl_Position.w;
}`;

const FRAGMENT = `
uniform vec3 white;
void main() {
  vec2 place = gl_PointCoord * 2.0 - 1.0;
  float out2 = dot(place, place);
  if (out2 > 1.0) discard;
  gl_FragColor = vec4(white, 0.7 * (1.0 - out2) * (1.0 - out2));
}`;

export class Mist {
  constructor(most) {
    this.position = new THREE.BufferAttribute(new Float32Array(3 * most), 3);
    this.radius = new THREE.BufferAttribute(new Float32Array(most), 1);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("radius", this.radius);
    this.material = new THREE.ShaderMaterial({
      vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false,
      uniforms: { height: { value: 1 }, white: { value: new THREE.Color() } },
    });
    this.object = new THREE.Points(geometry, this.material);
    this.object.frustumCulled = false;
  }

  // Draw the veils of so many droplets.
  show(count) {
    this.object.geometry.setDrawRange(0, count);
    this.position.needsUpdate = this.radius.needsUpdate = true;
  }
}

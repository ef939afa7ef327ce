// The molecules: one point each, which the graphics card draws as a shaded ball, so that thousands of them are cheap.

import * as THREE from "three";

const VERTEX = `
attribute float size;
attribute vec3 tint;
uniform float height;
uniform vec2 depths;
varying vec3 shade;
varying float far;
varying float pixels;
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  pixels = size * projectionMatrix[1][1] * 0.5 * height / gl_Position.w;
  gl_PointSize = size > 0.0 ? max(pixels, 1.5) : 0.0;
  far = clamp((-seen.z - depths.x) / max(depths.y - depths.x, 1e-9), 0.0, 1.0);
  shade = tint;
  if (size <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const FRAGMENT = `
uniform vec3 background;
uniform float haze;
uniform float ambient;
varying vec3 shade;
varying float far;
varying float pixels;
void main() {
  vec2 place = gl_PointCoord * 2.0 - 1.0;
  float out2 = dot(place, place);
  if (out2 > 1.0) discard;
  vec3 normal = vec3(place.x, -place.y, sqrt(1.0 - out2));
  vec3 light = normalize(vec3(-0.45, 0.75, 0.65));
  float lit = max(dot(normal, light), 0.0);
  float shine = pow(max(dot(reflect(-light, normal), vec3(0.0, 0.0, 1.0)), 0.0), 24.0);
  vec3 colour = shade * (ambient + 0.12 * normal.y + 0.36 * lit) + 0.26 * shine;
  colour *= mix(0.7, 1.0, smoothstep(0.0, 0.5, normal.z));
  colour = mix(colour, background, haze * far * far);
  float soft = pixels < 3.0 ? 1.0 : 1.0 - smoothstep(1.0 - 1.4 / pixels, 1.0, sqrt(out2));
  gl_FragColor = vec4(colour, soft);
}`;

export class Molecules {
  constructor(count) {
    this.count = count;
    this.position = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
    this.size = new THREE.BufferAttribute(new Float32Array(count), 1);
    this.tint = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("size", this.size);
    geometry.setAttribute("tint", this.tint);
    for (const attribute of [this.position, this.size, this.tint]) attribute.setUsage(THREE.DynamicDrawUsage);
    this.material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      // Soft rims that hide objects behind them and need no sorting; the picture itself stays opaque.
      alphaToCoverage: true,
      blending: THREE.CustomBlending,
      blendSrc: THREE.OneFactor, blendDst: THREE.ZeroFactor, blendSrcAlpha: THREE.ZeroFactor, blendDstAlpha: THREE.OneFactor,
      uniforms: {
        height: { value: 1 }, depths: { value: new THREE.Vector2(0, 1) },
        background: { value: new THREE.Color() }, haze: { value: 0.55 }, ambient: { value: 0.66 },
      },
    });
    this.object = new THREE.Points(geometry, this.material);
    this.object.frustumCulled = false;
  }

  // On a dark background molecules need more light and less haze.
  light(background, dark) {
    const { uniforms } = this.material;
    uniforms.background.value.setRGB(...background);
    uniforms.haze.value = dark ? 0.3 : 0.55;
    uniforms.ambient.value = dark ? 0.86 : 0.66;
  }

  // Put each molecule between its positions in two frames. `wraps` tells which axes are periodic: along these a molecule
  // takes the shorter way. A molecule that is in the gas in only one of the frames shrinks or grows at its position there.
  place({ first, second, share }, wraps, sizes) {
    const { array: place } = this.position, { array: size } = this.size;
    for (let index = 0; index < this.count; index += 1) {
      const here = first.state[index] === 0, there = second.state[index] === 0;
      size[index] = sizes[index] * (here ? (there ? 1 : 1 - share) : (there ? share : 0));
      for (let axis = 0; axis < 3; axis += 1) {
        const at = 3 * index + axis;
        const from = (here ? first : second).position[at] / 65535, to = (there ? second : first).position[at] / 65535;
        let way = to - from;
        if (wraps[axis]) way -= Math.round(way);
        let now = from + way * share;
        if (wraps[axis]) now -= Math.floor(now);
        place[at] = now * (first.length[axis] + (second.length[axis] - first.length[axis]) * share);
      }
    }
    this.position.needsUpdate = this.size.needsUpdate = true;
  }

  // Colour the molecules by a function that writes three numbers for each.
  colour(write) {
    for (let index = 0; index < this.count; index += 1) write(index, this.tint.array, 3 * index);
    this.tint.needsUpdate = true;
  }
}

// Frames of a box: read from bytes, and kept in order of time.

const HEAD = 32; // bytes before the positions

// One frame, from a position in a buffer. Its arrays are views of the buffer.
export function decode(buffer, start = 0) {
  const view = new DataView(buffer, start);
  const count = view.getUint32(24, true);
  const drops = view.getUint32(HEAD + 8 * count, true);
  const frame = {
    sequence: view.getUint32(0, true),
    time: view.getFloat64(4, true),
    length: [12, 16, 20].map((place) => view.getFloat32(place, true)),
    count,
    fastest: view.getFloat32(28, true), // the speed that is stored as 255
    position: new Uint16Array(buffer, start + HEAD, 3 * count),
    speed: new Uint8Array(buffer, start + HEAD + 6 * count, count),
    state: new Uint8Array(buffer, start + HEAD + 7 * count, count),
    drops: new Float32Array(buffer, start + HEAD + 8 * count + 4, 4 * drops),
  };
  return { frame, end: start + HEAD + 8 * count + 4 + 16 * drops };
}

// All frames of a run, from the text in the page: compressed, and in base64.
export async function unpack(text) {
  const squeezed = Uint8Array.from(atob(text.trim()), (sign) => sign.charCodeAt(0));
  const stream = new Blob([squeezed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const buffer = await new Response(stream).arrayBuffer();
  const frames = [];
  for (let start = 0; start < buffer.byteLength;) {
    const { frame, end } = decode(buffer, start);
    frames.push(frame);
    start = end;
  }
  return frames;
}

// The frames of one box. A film of limited length drops the oldest.
export class Film {
  constructor(frames = [], limit = Infinity) {
    this.frames = frames;
    this.limit = limit;
  }

  push(frame) {
    this.frames.push(frame);
    if (this.frames.length > this.limit) this.frames.splice(0, this.frames.length - this.limit);
  }

  clear() {
    this.frames = [];
  }

  get start() { return this.frames[0]?.time ?? 0; }

  get end() { return this.frames.at(-1)?.time ?? 0; }

  // Index of the last frame that is not later than a time.
  before(time) {
    let low = 0, high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].time <= time) low = middle; else high = middle - 1;
    }
    return low;
  }

  // The two frames around a time, and the position of the time between them.
  around(time) {
    const index = this.before(time);
    const first = this.frames[index], second = this.frames[index + 1] ?? first;
    const span = second.time - first.time;
    return { index, first, second, share: span > 0 ? Math.min(Math.max((time - first.time) / span, 0), 1) : 0 };
  }
}

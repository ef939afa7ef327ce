// The only clock of the page: the time in the box, and the pace of the film.

const SLOWEST = 1 / 32, FASTEST = 32;

export class Clock extends EventTarget {
  // `pace` is the time in the box that passes in a second of the film.
  constructor({ start, end, pace, instants }) {
    super();
    Object.assign(this, { start, end, pace, instants, time: start, playing: false, factor: 1 });
  }

  tell(what) {
    this.dispatchEvent(new Event(what));
  }

  play() {
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    this.tell("change");
  }

  pause() {
    this.playing = false;
    this.tell("change");
  }

  toggle() {
    if (this.playing) this.pause(); else this.play();
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.tell("time");
  }

  // Move by a number of frames, forward or backward, and pause.
  step(number) {
    this.playing = false;
    const slack = 1e-9 * (this.end - this.start);
    const passed = this.instants.filter((each) => each <= this.time + slack).length - 1;
    const between = this.time > this.instants[Math.max(passed, 0)] + slack;
    const wanted = passed + number + (number < 0 && between ? 1 : 0);
    this.time = this.instants[Math.min(Math.max(wanted, 0), this.instants.length - 1)];
    this.tell("change");
    this.tell("time");
  }

  accelerate(factor) {
    this.factor = Math.min(Math.max(this.factor * factor, SLOWEST), FASTEST);
    this.tell("change");
  }

  // Let some seconds of the film pass.
  pass(seconds) {
    if (!this.playing) return;
    this.time = Math.min(this.time + seconds * this.pace * this.factor, this.end);
    if (this.time >= this.end) {
      this.playing = false;
      this.tell("change");
    }
    this.tell("time");
  }
}

// The pace at first, in time of the box per second of the film: molecules cross the box twice in a second, but the film
// takes at least 12 and at most 90 seconds.
export function naturalPace(duration, crossing) {
  return Math.min(Math.max(2 * crossing, duration / 90), duration / 12);
}

// The one clock of the page: what time it is in the box, and how fast it goes.

const SLOWEST = 1 / 32, FASTEST = 32;

export class Clock extends EventTarget {
  // `pace` is how much time of the box passes in a second of the film.
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

  // Go so many frames on, and stand still there.
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

  // Let so many seconds of the film pass.
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

// How much time of the box a second of the film shows at first: molecules fly twice through the box, but a film is
// neither shorter than 12 seconds nor longer than 90.
export function naturalPace(duration, crossing) {
  return Math.min(Math.max(2 * crossing, duration / 90), duration / 12);
}

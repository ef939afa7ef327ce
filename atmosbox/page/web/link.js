// The connection to the box that runs: it passes on messages, says when it is lost, and reconnects.

const SOONEST = 500, LATEST = 5000; // ms between two attempts

export class Link {
  // `hear(message)` for what is said in words, `see(buffer)` for frames, `state("open" | "lost")`.
  constructor({ hear, see, state }) {
    Object.assign(this, { hear, see, state, wait: SOONEST });
    this.#connect();
  }

  #connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/socket${location.search}`);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.wait = SOONEST;
      this.state("open");
    };
    this.socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.see(data);
      else this.hear(JSON.parse(data));
    };
    this.socket.onclose = () => {
      this.state("lost");
      setTimeout(() => this.#connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LATEST);
    };
  }

  say(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

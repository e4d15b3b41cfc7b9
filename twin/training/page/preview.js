// The way of the program before it is run: asked for while the key is pressed in, drawn by the view.

import { act_on, make, write } from "./parts.js";

const SETTLED_MS = 250;
const OF_PATH = ["program", "searched", "zero", "offsets", "tools", "tool", "block_skip", "running"];
const NUMBER_BYTES = 4, AXES = 3;

export class Preview {
  constructor(view) {
    Object.assign(this, { view, on: false, stale: true, timer: null, asking: false, seen: null });
    this.note = document.getElementById("path-note");
  }

  /** The key among those of the views. */
  button(words) {
    this.words = words;
    this.key = make("button", { type: "button", "data-key": "preview", "aria-pressed": this.on }, words.label("preview"));
    act_on(this.key, () => this.turn());
    this.tell();
    return this.key;
  }

  turn() {
    this.on = !this.on;
    this.key.setAttribute("aria-pressed", this.on);
    this.view.say("preview", this.on ? this.seen : null);
    this.stale = this.stale || this.on;
    this.tell();
    this.ask_soon();
  }

  /** What has changed may have changed the way; while something runs, its way stays as it was. */
  show(now, changed) {
    this.running = now.running;
    if (OF_PATH.some((name) => changed.has(name))) this.stale = true;
    this.ask_soon();
  }

  ask_soon() {
    if (!this.on || !this.stale || this.running || this.timer) return;
    this.timer = setTimeout(() => { this.timer = null; this.ask(); }, SETTLED_MS);
  }

  async ask() {
    if (this.asking || !this.on || this.running) return;
    Object.assign(this, { asking: true, stale: false });
    try {
      const answer = await fetch("path.bin");
      if (!answer.ok) throw new Error(String(answer.status));
      this.seen = read(await answer.arrayBuffer());
      if (this.on) this.view.say("preview", this.seen);
    } catch {
      this.stale = true;
    }
    this.asking = false;
    this.tell();
    this.ask_soon();
  }

  /** In words what is drawn, and why not more of it. */
  tell() {
    const { note, seen, words } = this;
    note.hidden = !this.on || !seen;
    if (note.hidden) return;
    const said = [];
    if (seen.points) {
      const ends = ["X", "Y", "Z"].map((axis, k) => `${axis} ${seen.low[k].toFixed(1)} … ${seen.high[k].toFixed(1)}`).join("  ");
      said.push(`${words.label("preview_lines", { moves: seen.moves })} ${words.label("preview_extent")} ${ends}`);
    }
    if (!seen.complete) said.push(seen.message ? `${seen.line ? `${words.label("line")} ${seen.line}: ` : ""}${words.text(seen.message)}` : words.label("preview_part"));
    note.classList.toggle("refusal", !!seen.message);
    write(note, said.join(" · "));
  }
}

function read(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, NUMBER_BYTES, length)));
  const begin = NUMBER_BYTES + length, count = AXES * head.points;
  const places = new Float32Array(buffer.slice(begin, begin + NUMBER_BYTES * count)), rapid = new Uint8Array(buffer, begin + NUMBER_BYTES * count);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  places.forEach((place, i) => {
    const k = i % AXES, counted = place - head.origin[k];
    low[k] = Math.min(low[k], counted);
    high[k] = Math.max(high[k], counted);
  });
  return { ...head, low, high, ...lines(places, rapid) };
}

/** Lines by pairs of points, those of rapids and those in feed. */
function lines(places, rapid) {
  const fast = [], feed = [];
  for (let i = 1; i < rapid.length; i++) {
    const into = rapid[i] ? fast : feed;
    for (let k = AXES * (i - 1); k < AXES * (i + 1); k++) into.push(places[k]);
  }
  return { fast: new Float32Array(fast), feed: new Float32Array(feed) };
}

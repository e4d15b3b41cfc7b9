// Feed, spindle speed and error of a run over its time: drawn once, with a line at the moment that is shown.

const LANES = [["feeds", "feed", "mm/min", "#74d7f7"], ["speeds", "spindle", "/min", "#a3afba"], ["errors", "error", "µm", "#f2c230"]];
const WORST_COLOUR = "#f2c230", ALARM_COLOUR = "#ff6b57";
const NEAR_PX = 8; // A mark this close to the pointer is meant.
const TOP_PX = 9; // For the marks.

/** The samples with the greatest errors of the worst blocks, worst first. */
export function worst_blocks(errors, starts, most) {
  const found = starts.map((start, block) => {
    const end = starts[block + 1] ?? errors.length;
    let worst = start;
    for (let i = start; i < end; i++) if (errors[i] > errors[worst]) worst = i;
    return worst;
  });
  return found.sort((a, b) => errors[b] - errors[a]).slice(0, most);
}

export class Chart {
  /** canvas; where the values at the pointer are shown; columns of the run, its marks, and what is called. */
  constructor(canvas, pointed, run) {
    Object.assign(this, { canvas, pointed, run, index: 0, picture: null });
    this.has_speed = run.speeds.some((value) => value !== 0);
    this.lanes = LANES.filter(([name]) => run[name] && (name !== "speeds" || this.has_speed));
    new ResizeObserver(() => this.draw()).observe(canvas);
    const follow = (event) => {
      const index = this.at(event);
      this.tell(index, event);
      if (event.buttons) run.jump(index);
    };
    canvas.addEventListener("pointermove", follow);
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      follow(event);
    });
    canvas.addEventListener("pointerleave", () => { pointed.hidden = true; });
  }

  /** The sample at the pointer: that of a mark, where one is close. */
  at(event) {
    const box = this.canvas.getBoundingClientRect(), place = event.clientX - box.left;
    const near = this.marks().filter(([index]) => Math.abs(this.x(index) - place) < NEAR_PX);
    if (near.length) return near.sort((a, b) => Math.abs(this.x(a[0]) - place) - Math.abs(this.x(b[0]) - place))[0][0];
    const { times } = this.run;
    return this.run.sample(times[times.length - 1] * Math.min(1, Math.max(0, place / box.width)));
  }

  marks() {
    return [...this.run.worst.map((index) => [index, WORST_COLOUR]), ...this.run.alarms.map((when) => [this.run.sample(when), ALARM_COLOUR])];
  }

  x(index) {
    const { times } = this.run;
    return this.canvas.clientWidth * times[index] / Math.max(1e-9, times[times.length - 1]);
  }

  tell(index, event) {
    const { pointed, canvas } = this;
    pointed.textContent = this.run.text(index);
    pointed.hidden = false;
    const place = event.clientX - canvas.getBoundingClientRect().left - pointed.offsetWidth / 2;
    pointed.style.left = `${Math.max(0, Math.min(canvas.clientWidth - pointed.offsetWidth, place))}px`;
  }

  /** Show where the run is. */
  point(index) {
    this.index = index;
    if (!this.picture) return;
    const context = this.canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.picture, 0, 0);
    context.fillStyle = "#fff";
    context.fillRect(Math.round(this.x(index) * devicePixelRatio), 0, Math.max(1, Math.round(devicePixelRatio)), this.canvas.height);
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const ratio = devicePixelRatio;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.picture = new OffscreenCanvas(this.canvas.width, this.canvas.height);
    const context = this.picture.getContext("2d");
    context.scale(ratio, ratio);
    context.fillStyle = "#11161b";
    context.fillRect(0, 0, width, height);
    const tall = (height - TOP_PX) / this.lanes.length;
    this.lanes.forEach((lane, number) => this.draw_lane(context, lane, TOP_PX + number * tall, tall, width));
    for (const [index, colour] of this.marks()) {
      const x = this.x(index);
      context.fillStyle = colour;
      context.beginPath();
      context.moveTo(x - 5, 0);
      context.lineTo(x + 5, 0);
      context.lineTo(x, TOP_PX);
      context.fill();
    }
    this.point(this.index);
  }

  /** One figure over time: in every column of dots from its least value to its greatest. */
  draw_lane(context, [name, label, unit, colour], top, tall, width) {
    const values = this.run[name].map(Math.abs), columns = Math.ceil(width), low = Array(columns).fill(Infinity), high = Array(columns).fill(0);
    for (let i = 0; i < values.length; i++) {
      const column = Math.min(columns - 1, Math.floor(this.x(i)));
      low[column] = Math.min(low[column], values[i]);
      high[column] = Math.max(high[column], values[i]);
    }
    const most = Math.max(...high, 1e-9), foot = top + tall - 1, scale = (tall - 4) / most;
    context.fillStyle = colour;
    for (let column = 0, floor = 0, ceiling = 0; column < columns; column++) {
      // A column without a sample goes on as the one before.
      if (low[column] < Infinity) [floor, ceiling] = [low[column], high[column]];
      context.globalAlpha = 0.35;
      context.fillRect(column, foot - floor * scale, 1, floor * scale);
      context.globalAlpha = 1;
      context.fillRect(column, foot - ceiling * scale, 1, Math.max(1, (ceiling - floor) * scale));
    }
    context.fillStyle = "#37424d";
    context.fillRect(0, foot, width, 1);
    const text = `${label} ≤ ${most < 100 ? most.toFixed(1) : most.toFixed(0)} ${unit}`;
    context.font = "11px system-ui, sans-serif";
    const wide = context.measureText(text).width;
    context.fillStyle = "#11161bcc";
    context.fillRect(2, top + 1, wide + 6, 14);
    context.fillStyle = "#e8edf1";
    context.fillText(text, 5, top + 12);
  }
}

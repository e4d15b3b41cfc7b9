// Bars of what the cut asks of spindle and tool; they fall slowly, so that a short peak can be seen.

import { make, write } from "./parts.js";

const FULL_BEND_MM = 0.2;
const FALL_PER_S = 0.8;
const HIGH = 0.66, TOP = 0.9;

const METERS = [
  ["load_spindle", (state) => state.spindle, (state) => `${(100 * state.spindle).toFixed(0)} %`],
  ["load_force", (state) => state.forceShare, (state) => `${state.force.toFixed(0)} N`],
  ["load_bend", (state) => state.bend / FULL_BEND_MM, (state) => `${(1000 * state.bend).toFixed(0)} µm`],
  ["load_chip", (state) => state.chipShare, (state) => `${state.chip.toFixed(3)} mm`],
];

export class Loads {
  constructor(box) {
    Object.assign(this, { box, language: null, simulated: null, meters: [], time: 0 });
  }

  show(state, words) {
    const simulated = !Number.isNaN(state.force);
    if (words.language !== this.language || simulated !== this.simulated) {
      Object.assign(this, { language: words.language, simulated });
      this.build(words);
    }
    const seconds = Math.max(0, state.time - this.time);
    this.time = state.time;
    this.meters.forEach((meter) => {
      const share = meter.share_of(state);
      meter.shown = Math.max(share, meter.shown - FALL_PER_S * seconds, 0);
      const percent = Math.round(100 * Math.min(1, meter.shown));
      if (percent !== meter.percent) {
        meter.percent = percent;
        meter.fill.style.width = `${percent}%`;
        meter.bar.className = meter.shown > TOP ? "bar top" : meter.shown > HIGH ? "bar high" : "bar";
      }
      const text = meter.text_of(state);
      if (text === meter.value.textContent) return;
      write(meter.value, text);
      meter.element.setAttribute("aria-valuenow", Math.round(100 * Math.min(1, share)));
      meter.element.setAttribute("aria-valuetext", text);
    });
  }

  build(words) {
    if (!this.simulated) {
      this.meters = [];
      this.box.replaceChildren(make("span", { class: "quiet" }, words.label("no_force")));
      return;
    }
    this.meters = METERS.map(([name, share_of, text_of]) => {
      const fill = make("i"), bar = make("span", { class: "bar" }, fill), value = make("b");
      const element = make("div", { role: "meter", "aria-label": words.label(name), "aria-valuemin": 0, "aria-valuemax": 100, "data-key": name }, make("span", { class: "caption" }, words.label(name)), value, bar);
      return { element, fill, bar, value, share_of, text_of, shown: 0, percent: 0 };
    });
    this.box.replaceChildren(...this.meters.map(({ element }) => element));
  }
}

// How the part is looked at: what is drawn, a section through it, two places of it measured.

import { make, write } from "./parts.js";
import { TOOL_COLOURS } from "../view/tool_colours.js";

const SHOWN = ["trail", "stock", "by_tool", "collision"];
const AXES = ["X", "Y", "Z"];

export class Looking {
  constructor(view, trouble) {
    Object.assign(this, { view, trouble, shown: { trail: true, stock: true, by_tool: false, collision: false }, section: { axis: null, share: 0.5 }, note: document.getElementById("measure-note"), places: [] });
    view.on_measured = (places) => { this.places = places; this.tell(); };
  }

  /** The sheet of it. */
  sheet(words, now) {
    Object.assign(this, { words, now });
    const box = (name, label, on, act) => {
      const made = make("input", { type: "checkbox", id: `show-${name}`, "data-key": `show ${name}` });
      made.checked = on;
      made.addEventListener("change", () => act(made.checked));
      return make("div", { class: "row" }, make("label", {}, made, words.label(label)));
    };
    const drawn = SHOWN.map((name) => box(name, name, this.shown[name], (on) => {
      this.shown[name] = on;
      this.view.say("show", { [name]: on });
    }));
    const axis = make("select", { "data-key": "section", "aria-label": words.label("section") }, ...[["", words.label("section_none")], ["x", "X"], ["y", "Y"]].map(([value, text]) => make("option", { value }, text)));
    axis.value = this.section.axis ?? "";
    const share = make("input", { type: "range", min: 0, max: 1, step: 0.01, value: this.section.share, "data-key": "section place", "aria-label": words.label("section_place"), disabled: !this.section.axis });
    const cut = () => {
      this.section = { axis: axis.value || null, share: Number(share.value) };
      share.disabled = !this.section.axis;
      this.view.say("section", this.section);
    };
    axis.addEventListener("change", cut);
    share.addEventListener("input", cut);
    return [
      ...drawn,
      box("measure", "measure", this.view.measuring, (on) => {
        this.view.measuring = on;
        if (!on) this.view.say("measure", null);
        this.places = [];
        this.tell();
      }),
      make("h3", {}, words.label("section")), make("div", { class: "row" }, axis, share),
      make("h3", {}, words.label("sound")), box("sound", "sound_on", !this.trouble.muted, (on) => this.trouble.mute(!on)),
    ];
  }

  /** What was measured: where both places are from program zero, and how far they are from each other. */
  tell() {
    const { note, places, words, now } = this;
    note.hidden = !this.view.measuring;
    if (note.hidden) return;
    const at = (place) => AXES.map((axis, i) => `${axis} ${(place[i] - now.origin[i]).toFixed(3)}`).join("  ");
    const said = [places.length < 2 ? words.label("measure_help") : "", ...places.map(at)].filter(Boolean);
    if (places.length === 2) {
      const apart = places[1].map((value, i) => value - places[0][i]);
      said.push(`${apart.map((value, i) => `Δ${AXES[i]} ${value.toFixed(3)}`).join("  ")}  ${words.label("distance")} ${Math.hypot(...apart).toFixed(3)} mm`);
    }
    write(note, said.join("  ·  "));
  }
}

/** The colour that the view gives to what a tool has cut. */
export const tool_colour = (number) => TOOL_COLOURS[(number - 1) % TOOL_COLOURS.length];

// Help on demand: the keys of the keyboard, and a first minute that says what to press for who has never seen a control.

import { act_on, make, reveal, write } from "./parts.js";

/** What is pressed, when it has been done, and what must hold for it: where that is lost, the step before comes again. */
const MINUTE = [
  { key: "cycle_start", say: "guide_start", done: (now) => now.running && !now.held, can: () => true },
  { key: "feed_hold", say: "guide_hold", done: (now) => now.held, can: (now) => now.running },
  { key: "cycle_start", say: "guide_go_on", done: (now) => now.running && !now.held, can: (now) => now.running },
  { key: "emergency", say: "guide_stop", done: (now) => now.pressed, can: () => true },
  { key: "emergency", say: "guide_release", done: (now) => !now.pressed, can: () => true },
  { key: "reset", say: "guide_reset", done: (now) => !now.alarm, can: () => true },
];

export class Help {
  constructor(scene) {
    Object.assign(this, { box: document.getElementById("help"), guide: document.getElementById("guide"), step: -1, shown: "" });
    if (scene.guide && localStorage.getItem("guided") !== "yes") this.step = 0;
    this.opener = document.getElementById("help-key");
    act_on(this.opener, () => this.turn(this.box.hidden));
  }

  turn(open) {
    this.box.hidden = !open;
    if (open) reveal(this.box);
    this.opener.setAttribute("aria-expanded", open);
  }

  show(now, words) {
    Object.assign(this, { now, words });
    if (this.language !== words.language) {
      this.language = words.language;
      const keys = words.label("keys").split(" · ").map((one) => make("li", {}, one));
      this.box.replaceChildren(make("h2", {}, words.label("help")), make("ul", {}, ...keys), make("div", { class: "row" }, this.button("first minute", "first_minute", () => { this.turn(false); this.go(0); }), this.button("close help", "close", () => this.turn(false))));
    }
    if (this.step >= 0 && this.step < MINUTE.length) {
      if (MINUTE[this.step].done(now)) return this.go(this.step + 1);
      while (this.step > 0 && !MINUTE[this.step].can(now)) this.step -= 1;
    }
    return this.draw();
  }

  go(step) {
    this.step = step;
    if (step === MINUTE.length) localStorage.setItem("guided", "yes");
    this.draw();
  }

  end() {
    localStorage.setItem("guided", "yes");
    this.go(-1);
  }

  draw() {
    const { step, words, now, guide } = this, acts = now.has_panel || now.role === "trainer";
    const shown = JSON.stringify([step, words.language, acts]);
    if (shown === this.shown) return;
    this.shown = shown;
    for (const one of document.querySelectorAll(".press-this")) one.classList.remove("press-this");
    guide.hidden = step < 0 || !acts;
    if (guide.hidden) return;
    const over = step === MINUTE.length, { key, say } = over ? { say: "guide_over" } : MINUTE[step];
    const target = key === "emergency" ? document.getElementById("emergency") : document.querySelector(`#control-desk [data-key="${key}"]`);
    target?.classList.add("press-this");
    target?.scrollIntoView({ block: "nearest" });
    const text = make("span", { role: "status" });
    guide.replaceChildren(text, this.button("end guide", over ? "close" : "skip", () => this.end()));
    write(text, over ? words.label(say) : `${step + 1}/${MINUTE.length}: ${words.label(say, { key: words.label(key) })}`);
  }

  button(name, label, act) {
    const made = make("button", { type: "button", "data-key": name }, this.words.label(label));
    act_on(made, act);
    return made;
  }
}

// The control desk: modes, start and stop, jog keys, dials, spindle and coolant, the emergency stop.

import { act_on, key, label_key, light, make, write } from "./parts.js";

const STEPS = [0.01, 0.1, 1, 10, null];
const JOG_FEED = { mm: 2000, deg: 1800 };
const JOG_KEYS = {
  ArrowRight: ["X", 1], ArrowLeft: ["X", -1], ArrowUp: ["Y", 1], ArrowDown: ["Y", -1], PageUp: ["Z", 1], PageDown: ["Z", -1], Home: ["", 1], End: ["", -1], // the rotary axis nearest to the part
};
const UNHEARD_MS = 600;
const WHEEL_MS = 50;
const MOST_CLICKS = 100;

export class ControlDesk {
  constructor(scene, line) {
    Object.assign(this, { scene, line, step: 1, hand: { feed: null, rapid: false, axis: "", jog_step: "0.1" }, keys: {}, turned: {}, pressing: "", pointer: null, clicks: 0, wheel: null, now: null });
    const command = (name) => () => line.say({ do: name });
    const at = (id) => document.getElementById(id);
    const add = (where, name, act, given = {}) => at(where).append(this.keys[name] = key("", act, { name, ...given }));
    for (const mode of scene.modes) add("mode", `mode_${mode}`, () => line.say({ do: "mode", mode }));
    add("cycle", "cycle_start", command("cycle_start"), { lamp: "bright" });
    add("cycle", "feed_hold", command("feed_hold"), { lamp: "yellow", atOnce: true });
    add("cycle", "reset", command("reset"), { lamp: "red", className: "reset" });
    add("supplies", "spindle", () => line.say({ do: "spindle", on: !this.now.spindle.started }), { lamp: "bright" });
    add("supplies", "coolant", () => line.say({ do: "coolant", on: !this.now.coolant }));
    this.emergency = at("emergency");
    act_on(this.emergency, () => line.say({ do: "emergency_stop", pressed: !this.now?.pressed }), true);
    this.dials = Object.fromEntries(["feed", "rapid"].map((name) => [name, this.add_dial(name, ...scene.overrides[name])]));
    addEventListener("keydown", (event) => this.key_down(event), true);
    addEventListener("keyup", (event) => { if (this.pressing === event.code) this.release(); }, true);
    for (const end of ["blur", "pagehide"]) addEventListener(end, () => this.release());
    document.addEventListener("visibilitychange", () => this.release());
  }

  add_dial(name, low, high) {
    const range = make("input", { type: "range", min: low, max: high, step: 10, "data-key": `${name}_override`, "data-name": `${name}_override` });
    const shown = make("output");
    range.addEventListener("input", () => this.turn(name, Number(range.value)));
    const nudge = (by, name_of) => {
      const button = make("button", { type: "button", "data-key": `${name}_${name_of}` }, by > 0 ? "+" : "−");
      act_on(button, () => this.turn(name, Math.min(high, Math.max(low, this.stands(name) + by))), true);
      return button;
    };
    const [less, more] = [nudge(-10, "less"), nudge(10, "more")];
    const caption = make("span", { "data-word": `${name}_override` });
    document.getElementById("override").append(make("div", { class: "dial" }, make("span", {}, caption, shown), make("div", {}, less, range, more)));
    return { range, shown, less, more };
  }

  /** Where a dial stands: what the machine shows may be older than the last turn. */
  stands(name) {
    const turned = this.turned[name];
    const shown = this.now[`${name}_override`];
    if (turned && turned.percent !== shown && performance.now() < turned.until) return turned.percent;
    delete this.turned[name];
    return shown;
  }

  turn(name, percent) {
    if (percent === this.stands(name) || this.dials[name].range.matches(":disabled")) return;
    this.turned[name] = { percent, until: performance.now() + UNHEARD_MS };
    this.line.say({ do: "override", dial: name, percent });
    this.show_dials();
  }

  show_dials() {
    for (const [name, { range, shown }] of Object.entries(this.dials)) {
      const percent = this.stands(name);
      range.value = percent;
      range.setAttribute("aria-valuetext", `${percent} %`);
      write(shown, `${percent} %`);
    }
  }

  add_axes(axes, words) {
    const box = document.getElementById("jog");
    box.replaceChildren(box.querySelector("legend"));
    box.style.setProperty("--axes", axes.length);
    for (const [direction, sign] of [[1, "+"], [-1, "−"]]) {
      for (const axis of axes) {
        const button = key(`${axis}${sign}`, (event) => { if (event.detail === 0) this.jog(axis, direction, true); }, { name: `jog ${axis}${direction > 0 ? "+" : "-"}` });
        button.setAttribute("aria-label", `${words.label("jog")} ${axis}${sign}`);
        button.addEventListener("pointerdown", (event) => {
          if (event.button !== 0 || button.matches(":disabled")) return;
          // A second finger on the keys is no intention: everything stops until the first one is off.
          if (this.pointer !== null) return this.line.let_go();
          this.pointer = event.pointerId;
          button.setPointerCapture(event.pointerId);
          this.jog(axis, direction);
        });
        for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(end, (event) => {
          if (event.pointerId === this.pointer) this.release();
        });
        button.addEventListener("contextmenu", (event) => event.preventDefault());
        box.append(button);
      }
    }
    this.steps = STEPS.map((step) => {
      const button = make("button", { type: "button", "data-key": `step ${step ?? "held"}` }, step === null ? words.label("continuous") : String(step));
      act_on(button, () => this.choose_step(step));
      return button;
    });
    box.append(make("div", { id: "steps", role: "group", "aria-label": words.label("jog_step") }, ...this.steps));
    this.choose_step(this.step);
  }

  choose_step(step) {
    this.step = step;
    this.steps.forEach((button, number) => button.setAttribute("aria-pressed", STEPS[number] === step));
  }

  /** Jog by the chosen step, or for as long as the key is held; a click without a pointer is a short touch. */
  jog(axis, direction, touched = false) {
    const unit = this.now.units[this.now.axes.indexOf(axis)];
    const feed = this.hand.rapid ? this.scene.fastest[axis] : this.hand.feed ?? JOG_FEED[unit];
    const command = { do: "jog", axis, direction, feed };
    if (this.step !== null || touched) this.line.say({ ...command, step: this.step ?? 0.1 });
    else this.line.hold(command);
  }

  /** The clicks of the handwheel go out together, so that no turning is too much for the line. */
  turn_wheel(clicks) {
    this.clicks += clicks;
    this.wheel ??= setTimeout(() => this.send_wheel(), WHEEL_MS);
  }

  send_wheel() {
    clearTimeout(this.wheel);
    const clicks = Math.max(-MOST_CLICKS, Math.min(MOST_CLICKS, this.clicks));
    this.clicks -= clicks;
    if (clicks) this.line.say({ do: "handwheel", axis: this.hand.axis, clicks, step: Number(this.hand.jog_step) });
    this.wheel = this.clicks ? setTimeout(() => this.send_wheel(), WHEEL_MS) : null;
  }

  release() {
    this.pressing = "";
    this.pointer = null;
    this.line.let_go();
  }

  key_down(event) {
    if (event.code === "Escape") {
      event.preventDefault();
      return this.line.say({ do: "emergency_stop" });
    }
    const target = event.target;
    const typing = target.matches("input:not([type=range]), select, textarea");
    if (typing || event.ctrlKey || event.altKey || event.metaKey || !this.now) return undefined;
    if (target.matches("button, [role=tab], #program, #wheel, input") && ["Space", "Enter", ...Object.keys(JOG_KEYS)].includes(event.code)) return undefined;
    const click = (name) => () => this.keys[name].disabled || this.keys[name].matches(":disabled") || this.line.say({ do: name });
    const dial = (name, by) => () => this.turn(name, Math.min(this.scene.overrides[name][1], Math.max(0, this.stands(name) + by)));
    const jog = JOG_KEYS[event.code];
    const acts = {
      Space: click("cycle_start"), KeyH: click("feed_hold"), KeyR: click("reset"), KeyS: () => this.keys.spindle.click(), KeyC: () => this.keys.coolant.click(),
      Equal: dial("feed", 10), NumpadAdd: dial("feed", 10), Minus: dial("feed", -10), NumpadSubtract: dial("feed", -10), Period: dial("rapid", 10), Comma: dial("rapid", -10),
      KeyT: () => document.dispatchEvent(new Event("next-sheet")), KeyM: () => document.dispatchEvent(new Event("measure-tool")),
      Enter: () => document.querySelector("#entry input")?.focus(),
    };
    this.scene.modes.forEach((mode, number) => { acts[`F${number + 1}`] = () => this.keys[`mode_${mode}`].click(); });
    STEPS.forEach((step, number) => { acts[`Digit${number + 1}`] = () => this.choose_step(step); });
    const axis = jog && (jog[0] || this.now.axes.slice(3).at(-1));
    if (jog && this.now.mode === "jog" && this.now.axes.includes(axis)) acts[event.code] = () => {
      this.pressing = event.code;
      this.jog(axis, jog[1]);
    };
    if (!acts[event.code]) return undefined;
    event.preventDefault();
    if (!event.repeat) acts[event.code]();
    return undefined;
  }

  show(now, words) {
    const axes = JSON.stringify([now.axes, words.language]);
    this.now = now;
    if (axes !== this.axes) {
      this.axes = axes;
      this.add_axes(now.axes, words);
      for (const [name, button] of Object.entries(this.keys)) label_key(button, words.label(name));
      for (const [name, { less, more }] of Object.entries(this.dials)) {
        less.setAttribute("aria-label", `${words.label(`${name}_override`)} −`);
        more.setAttribute("aria-label", `${words.label(`${name}_override`)} +`);
      }
    }
    for (const mode of this.scene.modes) light(this.keys[`mode_${mode}`], mode === now.mode);
    light(this.keys.cycle_start, !!now.running && !now.held);
    light(this.keys.feed_hold, now.held);
    light(this.keys.reset, now.alarm !== null);
    light(this.keys.spindle, now.spindle.started);
    light(this.keys.coolant, now.coolant);
    this.show_dials();
    const acts = now.role === "trainer" || now.has_panel;
    for (const box of document.querySelectorAll("#control-desk fieldset")) box.disabled = !acts;
    this.emergency.disabled = now.role === "watcher";
    this.emergency.classList.toggle("pressed", now.pressed);
    this.emergency.setAttribute("aria-pressed", now.pressed);
    write(this.emergency.firstElementChild, words.label(now.pressed ? "release" : "emergency"));
  }
}

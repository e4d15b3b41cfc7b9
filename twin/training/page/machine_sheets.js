// Sheets of the machine: what is done by hand, how programs run, the alarms that came.

import { act_on, make, number, write } from "./parts.js";

const WHEEL_STEPS = [0.001, 0.01, 0.1, 1];
const SPINDLE_STEP = 10;

export function manual_sheet(sheets) {
  const { now, words, line, scene, desk } = sheets, hand = desk.hand;
  const speed = make("input", { id: "spindle-speed", "data-key": "spindle speed", inputmode: "decimal", value: now.spindle.speed ?? now.spindle.tool_speed ?? "", "aria-label": words.label("spindle_speed") });
  const turn = (name, counter_clockwise) => sheets.button(name, words.label(name), () => line.say({ do: "spindle", on: true, counter_clockwise, ...(speed.value.trim() ? { speed: number(speed.value) } : {}) }));
  const [low, high] = scene.overrides.spindle;
  const nudge = (by, sign) => {
    const made = sheets.button(`spindle_override ${sign}`, sign, () => line.say({ do: "override", dial: "spindle", percent: Math.min(high, Math.max(low, now.spindle_override + by)) }));
    made.setAttribute("aria-label", `${words.label("spindle_override")} ${sign}`);
    return made;
  };
  const feed = make("input", { id: "jog-feed", "data-key": "jog feed", inputmode: "decimal", value: hand.feed ?? "", placeholder: "2000", "aria-label": words.label("jog_feed") });
  feed.addEventListener("input", () => { hand.feed = feed.value.trim() ? number(feed.value) : null; });
  const rapid = make("input", { type: "checkbox", id: "jog-rapid", "data-key": "jog rapid" });
  rapid.checked = hand.rapid;
  rapid.addEventListener("change", () => { hand.rapid = rapid.checked; });
  const ask = (name) => sheets.button(name, words.label(name), () => line.say({ do: name }));
  return [
    make("h3", {}, words.label("spindle")),
    make("div", { class: "row" }, make("label", {}, words.label("spindle_speed"), speed)),
    make("div", { class: "row" }, turn("clockwise", false), turn("counter_clockwise", true), sheets.button("spindle stop", words.label("stop"), () => line.say({ do: "spindle", on: false }))),
    make("div", { class: "row" }, words.label("spindle_override")), make("div", { class: "row" }, nudge(-SPINDLE_STEP, "−"), make("output", { id: "spindle-override" }, `${now.spindle_override} %`), nudge(SPINDLE_STEP, "+")),
    make("h3", {}, words.label("jog")),
    make("div", { class: "row" }, make("label", {}, words.label("jog_feed"), feed), make("label", {}, rapid, words.label("jog_rapid"))),
    ...handwheel(sheets),
    make("div", { class: "row" }, ask("reference"), ...(now.suspended ? [ask("return_to_path")] : []), ask("new_blank")),
  ];
}

/** A pad that follows the mouse wheel and the arrow keys. */
function handwheel({ now, words, desk }) {
  const { hand } = desk;
  const choose = (id, values, name) => {
    const made = make("select", { id, "data-key": id, "aria-label": `${words.label("handwheel")}: ${words.label(name)}` }, ...values.map((value) => make("option", { value }, String(value))));
    made.value = hand[name];
    made.addEventListener("change", () => {
      desk.send_wheel();
      hand[name] = made.value;
    });
    return made;
  };
  hand.axis ||= now.axes[0];
  const pad = make("div", { id: "wheel", "data-key": "handwheel", tabindex: 0, role: "group", "aria-label": `${words.label("handwheel")}. ${words.label("handwheel_help")}` }, words.label("handwheel_help"));
  pad.addEventListener("wheel", (event) => { event.preventDefault(); if (event.deltaY) desk.turn_wheel(event.deltaY < 0 ? 1 : -1); }, { passive: false });
  pad.addEventListener("keydown", (event) => {
    const clicks = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!clicks) return;
    event.preventDefault();
    desk.turn_wheel(clicks);
  });
  return [make("h3", {}, words.label("handwheel")), make("div", { class: "row" }, choose("wheel-axis", now.axes, "axis"), choose("wheel-step", WHEEL_STEPS, "jog_step")), pad];
}

export function run_sheet(sheets) {
  const { now, words, line, screen } = sheets;
  const box = (name) => {
    const made = make("input", { type: "checkbox", id: `switch-${name}`, "data-key": `switch ${name}` });
    made.checked = now[name];
    made.addEventListener("change", () => line.say({ do: "switch", name, on: made.checked }));
    return make("div", { class: "row" }, make("label", {}, made, words.label(name)));
  };
  const ask = (name) => sheets.button(name, words.label(name), () => line.say({ do: name }));
  const search = screen.chosen ? sheets.button("search", words.label("search", { line: screen.chosen }), () => line.say({ do: "search", line: screen.chosen })) : null;
  const cancel = now.searched ? sheets.button("search cancel", words.label("search_cancel"), () => line.say({ do: "search", line: 0 })) : null;
  return [
    ...["optional_stop", "block_skip", "dry_run"].map(box),
    make("h3", {}, words.label("block_search")), make("p", { class: "quiet" }, words.label("search_help")), ...finder(sheets),
    now.searched ? make("p", { class: "hint" }, words.label("search_set", { line: now.searched })) : null,
    make("div", { class: "row" }, search, cancel),
    make("h3", {}, words.label("program")),
    make("div", { class: "row" }, sheets.button("edit program", words.label("edit_program"), () => sheets.editor.open()), now.changed ? ask("undo") : null, ask("reload")),
  ].filter(Boolean);
}

/** Finds blocks by what stands in them; the one that is chosen is where the program would begin. */
function finder({ now, words, screen }) {
  const text = make("input", { type: "search", "data-key": "find block", "aria-label": words.label("find_block"), placeholder: words.label("find_block"), value: screen.sought ?? "" });
  const found = make("span", { role: "status", class: "quiet" });
  const find = (step) => {
    screen.sought = text.value;
    const sought = text.value.trim().toLowerCase();
    const lines = sought ? now.program.flatMap((one, index) => (one.toLowerCase().includes(sought) ? [index + 1] : [])) : [];
    if (!lines.length) return write(found, sought ? words.label("not_found") : "");
    const next = step > 0 ? lines.find((one) => one > screen.chosen) ?? lines[0] : lines.findLast((one) => one < screen.chosen) ?? lines.at(-1);
    return screen.choose(next);
  };
  text.addEventListener("keydown", (event) => { if (event.key === "Enter") find(event.shiftKey ? -1 : 1); });
  const button = (name, label, step) => {
    const made = make("button", { type: "button", "data-key": name, "aria-label": words.label(label) }, step < 0 ? "▲" : "▼");
    act_on(made, () => find(step));
    return made;
  };
  const chosen = screen.chosen ? make("p", {}, make("b", {}, `${screen.chosen}: `), make("code", {}, now.program[screen.chosen - 1] ?? "")) : null;
  return [make("div", { class: "row name" }, text, button("find before", "find_before", -1), button("find next", "find_next", 1)), found, chosen];
}

export function alarm_sheet({ now, words }) {
  if (!now.alarms.length) return [make("p", { class: "quiet" }, words.label("no_alarms"))];
  return [make("ul", {}, ...now.alarms.toReversed().map((alarm) => make("li", {}, make("b", { class: "failed" }, words.alarm(alarm.code).name), ` ${alarm.time_s.toFixed(1)} ${words.label("seconds")}${words.place(alarm)}: ${words.text(alarm.message)}`)))];
}

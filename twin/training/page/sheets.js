// The sheets beside the view: tasks, what is done by hand, how programs run, tables, alarms, view, trainer.

import { alarm_sheet, manual_sheet, run_sheet } from "./machine_sheets.js";
import { tool_colour } from "./looking.js";
import { act_on, field, make, number, put_back, typing } from "./parts.js";

/** In what colour the view shows what a tool has cut; set by its style, as pages here may hold no styles of their own. */
function colour_of(number) {
  const made = make("span", { class: "swatch", "aria-hidden": "true" });
  made.style.background = tool_colour(number);
  return made;
}

const MARKS = { open: "○", done: "●", failed: "×" };
const BACK_S = [10, 60];
const NEW_KINDS = ["flat", "ball", "drill", "chamfer"];

export class Sheets {
  constructor(scene, line, looking, desk, screen, score, editor) {
    Object.assign(this, { scene, line, looking, desk, screen, score, editor, asking: "", sheet: "tasks", drawn: "", state: null });
    document.addEventListener("next-sheet", () => {
      const names = this.names();
      this.choose(names[(names.indexOf(this.sheet) + 1) % names.length]);
    });
    document.addEventListener("measure-tool", () => this.measure());
  }

  names() {
    return ["tasks", "manual", "run", "offsets", "tools", "history", "display", ...(this.now.role === "trainer" ? ["trainer"] : [])];
  }

  choose(sheet) {
    this.sheet = sheet;
    this.asking = "";
    this.show(this.now, this.words);
  }

  show(now, words) {
    Object.assign(this, { now, words });
    const tabs = document.getElementById("tabs"), sheet = document.getElementById("sheet");
    const names = this.names();
    const key = JSON.stringify([names, words.language]);
    if (key !== this.tabs) {
      this.tabs = key;
      tabs.replaceChildren(...names.map((name) => {
        const tab = make("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": "sheet", "data-key": `tab ${name}` }, words.label(name));
        act_on(tab, () => this.choose(name));
        return tab;
      }));
    }
    for (const tab of tabs.children) tab.setAttribute("aria-selected", tab.id === `tab-${this.sheet}`);
    sheet.setAttribute("aria-labelledby", `tab-${this.sheet}`);
    const acts = now.role === "trainer" || now.has_panel;
    const what = { tasks: [now.verdicts, now.answers, now.hints, now.score, now.over, now.signature, this.asking], manual: [now.spindle, now.counter_clockwise, now.spindle_override, now.suspended, this.desk.hand], run: [now.optional_stop, now.block_skip, now.dry_run, now.searched, now.changed, this.screen.chosen], offsets: [now.zero, now.offsets, now.tool, now.tools, now.broken], tools: [now.tools, now.tool, now.broken], history: [now.alarms], display: [], trainer: [now.faults, now.frozen, now.replaying, now.made] };
    const drawn = JSON.stringify([this.sheet, words.language, acts, now.refusals, what[this.sheet]]);
    if (drawn === this.drawn) return;
    // What is being typed stays; what has been sent is shown as the machine has it.
    const same = this.drawn && JSON.parse(this.drawn)[0] === this.sheet, before = typing(sheet);
    this.drawn = drawn;
    const heading = this.sheet === "tasks" ? [] : [make("h2", { class: "unseen" }, words.label(this.sheet))];
    sheet.replaceChildren(...heading, ...this[this.sheet]());
    if (!acts) for (const one of sheet.querySelectorAll("button, input, select")) one.disabled = this.sheet !== "display";
    put_back(sheet, same ? before : { ...before, values: [] });
  }

  button(name, text, act) {
    const made = make("button", { type: "button", "data-key": name }, text);
    act_on(made, act);
    return made;
  }

  tasks() {
    const { scene, now, words, line } = this, answers = new Map(now.answers);
    const tasks = scene.tasks.map((task, index) => {
      const { state } = now.verdicts[index], number = index + 1;
      const choices = task.choices && !answers.has(number) && !now.over
        ? task.choices.map((choice) => this.button(`answer ${number} ${choice}`, choice, () => line.say({ do: "answer", task: number, choice }))) : [];
      return make("li", { class: state }, make("span", { "aria-hidden": "true" }, `${MARKS[state]} `), `${words.text(task.text)} (${task.points}) `, make("span", { class: "sr", hidden: true }, state), ...choices);
    });
    const hints = scene.hints.slice(0, now.hints).map((hint) => make("p", { class: "hint" }, words.text(hint)));
    const more = now.hints < scene.hints.length
      ? this.asked("hint", `${words.label("hint")} (${words.label("hint_cost", { cost: scene.hint_cost })})`, scene.hint_cost > 0) : [];
    const closing = now.over
      ? [make("b", { class: "done" }, words.label("over")), this.button("score sheet", words.label("score_sheet"), () => this.score.open())]
      : this.asking ? this.asked(this.asking, "", true) : [...more, ...this.asked("finish", words.label("finish"), true)];
    return [
      make("h2", {}, words.text(scene.title)), make("p", { class: "quiet" }, words.text(scene.story)), make("ul", {}, ...tasks), ...hints,
      this.signature(), make("p", { class: "points" }, `${words.label("score")}: ${now.score} / ${scene.points}`), make("div", { class: "row", role: this.asking ? "alert" : null }, ...closing),
    ];
  }

  /** What cannot be taken back asks once before it is done. */
  asked(name, text, asks) {
    const { words, line, scene } = this;
    const turn = (asking) => {
      this.asking = asking;
      this.show(this.now, words);
      document.querySelector("#sheet [role=alert]")?.scrollIntoView({ block: "nearest" });
    };
    const send = () => { turn(""); line.say({ do: name }); };
    if (this.asking !== name) return [this.button(name, text, () => (asks ? turn(name) : send()))];
    return [
      make("b", { class: "hint" }, words.label(`ask_${name}`, { cost: scene.hint_cost })),
      this.button(`${name} yes`, words.label("yes"), send), this.button(`${name} no`, words.label("no"), () => turn("")),
    ];
  }

  /** Who is at the panel: it stands on the score sheet. */
  signature() {
    const { now, words, line } = this;
    const name = field({ "data-key": "name", maxlength: 80, value: now.signature, "aria-label": words.label("name") }, (text) => line.say({ do: "sign", name: text }));
    return make("div", { class: "row name" }, make("label", {}, words.label("name"), name));
  }

  offsets() {
    const { now, words, line } = this;
    const rows = now.axes.map((axis, index) => {
      const reading = make("input", { id: `reading-${axis}`, "data-key": `reading ${axis}`, inputmode: "decimal", value: "0", "aria-label": `${words.label("preset_help")} ${axis}` });
      const set = () => line.say({ do: "set_zero", axis, reading: number(reading.value) });
      reading.addEventListener("keydown", (event) => { if (event.key === "Enter") set(); });
      const row = make("div", { class: "row tight" }, make("b", {}, axis), make("span", { class: "number" }, now.zero[index].toFixed(3)), reading, this.button(`preset ${axis}`, words.label("preset"), set));
      return ["X", "Y"].includes(axis) ? [row, this.touched(axis)] : [row];
    }).flat();
    const table = now.offsets.length ? [make("h3", {}, words.label("work_offsets")), ...now.offsets.flatMap((row) => this.offset_row(...row))] : [];
    return [...this.finder(), make("p", { class: "quiet" }, words.label("preset_help")), ...rows, ...table];
  }

  /** The edge finder, and how it is used. */
  finder() {
    const { now, words, line } = this, finder = now.tools.find(({ kind }) => kind === "edge_finder");
    if (!finder) return [];
    const here = finder.number === now.tool;
    const put = here && !now.broken ? [] : [make("div", { class: "row" }, this.button("edge finder", words.label(here ? "new_finder" : "finder_in"), () => line.say({ do: "change_tool", number: finder.number })))];
    return [make("p", { class: here ? "" : "quiet" }, words.label(here ? "finder_help" : "finder_hint")), ...put];
  }

  /** An edge that the tool touches is zero: its middle stands off it by its radius. */
  touched(axis) {
    const { now, words, line } = this, radius = now.tools.find(({ number: one }) => one === now.tool).radius;
    const edge = (sign, name) => this.button(`touched ${axis}${sign < 0 ? "-" : "+"}`, words.label(name, { axis }), () => line.say({ do: "set_zero", axis, reading: sign * radius }));
    return make("div", { class: "row" }, edge(-1, "touched_from_below"), edge(1, "touched_from_above"));
  }

  /** A work offset: a field for each axis, written by Enter. */
  offset_row(name, values) {
    const { now, words, line } = this;
    const fields = now.axes.map((axis, index) => {
      const given = { inputmode: "decimal", "data-key": `offset ${name} ${axis}`, value: values[index].toFixed(3), "aria-label": `${name} ${axis}` };
      return make("label", {}, axis, field(given, (text) => line.say({ do: "set_offset", name, axis, value: number(text) })));
    });
    return [make("div", { class: "row offset" }, make("b", {}, name), ...fields)];
  }

  manual() { return manual_sheet(this); }

  run() { return run_sheet(this); }

  history() { return alarm_sheet(this); }

  tools() {
    const { now, words } = this;
    return now.tools.flatMap((tool) => {
      const here = tool.number === now.tool;
      const entry = (name, value) => {
        const given = { inputmode: "decimal", "data-key": `${name} ${tool.number}`, value: value.toFixed(3), "aria-label": `T${tool.number} ${words.label(name)}` };
        return make("label", {}, words.label(name), field(given, (text) => this.line.say({ do: "set_tool", number: tool.number, [name]: number(text) })));
      };
      return [
        make("h3", {}, colour_of(tool.number), `T${tool.number}${here ? " ◂" : ""}  ${words.label(`tool_${tool.kind}`)}`),
        make("div", { class: "row" }, `${words.label("diameter")} ${tool.diameter}`),
        make("div", { class: "row" }, entry("length", tool.length), entry("radius", tool.radius)),
        here && !now.broken ? null : make("div", { class: "row" }, this.button(`change tool ${tool.number}`, words.label(here ? "new_tool" : "change_tool"), () => this.line.say({ do: "change_tool", number: tool.number }))),
        here ? make("div", { class: "row" }, this.button("touch off", words.label("touch_off"), () => this.measure())) : null,
      ].filter(Boolean);
    }).concat(this.new_tool());
  }

  /** A row for a tool that the table lacks. */
  new_tool() {
    const { now, words, line } = this;
    const value = (name, label, given) => make("input", { id: `new-tool-${name}`, "data-key": `new tool ${name}`, inputmode: "decimal", value: given, "aria-label": `${words.label("new_row")}: ${words.label(label)}` });
    const free = Math.max(...now.tools.map((tool) => tool.number)) + 1;
    const rows = { number: value("number", "number", free), diameter: value("diameter", "diameter", 6), length: value("length", "length", 60) };
    const kind = make("select", { id: "new-tool-kind", "data-key": "new tool kind", "aria-label": `${words.label("new_row")}: ${words.label("tool")}` }, ...NEW_KINDS.map((one) => make("option", { value: one }, words.label(`tool_${one}`))));
    const add = () => line.say({ do: "add_tool", kind: kind.value, number: Math.round(number(rows.number.value)), diameter: number(rows.diameter.value), length: number(rows.length.value) });
    return [
      make("h3", {}, words.label("new_row")),
      make("div", { class: "row" }, make("label", {}, "T", rows.number), kind),
      make("div", { class: "row" }, make("label", {}, words.label("diameter"), rows.diameter), make("label", {}, words.label("length"), rows.length)),
      make("div", { class: "row" }, this.button("add tool", words.label("add_row"), add)),
    ];
  }

  /** The tool in the spindle is as long as it must be for its tip to stand on Z0. */
  measure() {
    const { now, line, state } = this, tool = now.tools.find(({ number: one }) => one === now.tool);
    if (tool && state) line.say({ do: "set_tool", number: tool.number, length: Math.round(1e4 * (tool.length + state.position[now.axes.indexOf("Z")])) / 1e4 });
  }

  display() { return this.looking.sheet(this.words, this.now); }

  /** Writes what stands here down as a scene. */
  make_scene() {
    const { words, line, now } = this;
    const title = make("input", { "data-key": "scene title", maxlength: 80, "aria-label": words.label("scene_title") });
    const story = make("textarea", { "data-key": "scene story", maxlength: 2000, rows: 3, "aria-label": words.label("scene_story") });
    const made = now.made && make("p", { class: now.made.path ? "done" : "hint", role: "status" }, now.made.path ? words.label("scene_made", { path: now.made.path }) : words.text(now.made.refused));
    return [
      make("h3", {}, words.label("make_scene")), make("p", { class: "quiet" }, words.label("make_scene_help")),
      make("div", { class: "row name" }, make("label", {}, words.label("scene_title"), title)), make("div", { class: "row name" }, make("label", {}, words.label("scene_story"), story)),
      make("div", { class: "row" }, this.button("make scene", words.label("make_scene"), () => line.say({ make_scene: { title: title.value, story: story.value } }))), made,
    ].filter(Boolean);
  }

  trainer() {
    const { now, words, line, scene } = this;
    const ask = (name, given = {}, label = name, values = {}) => this.button(label === "rewind" ? `rewind ${given.seconds}` : name, words.label(label, values), () => line.say({ do: name, ...given }));
    const time = [
      now.frozen ? ask("go_on") : ask("freeze"), ...BACK_S.map((seconds) => ask("rewind", { seconds }, "rewind", { seconds })),
      now.replaying ? ask("end_replay") : ask("replay"),
    ];
    const kinds = Object.keys(scene.faults);
    const kind = make("select", { id: "fault-kind", "data-key": "fault kind", "aria-label": words.label("inject") }, ...kinds.map((name) => make("option", { value: name }, words.label(`fault_${name}`))));
    const axis = make("select", { id: "fault-axis", "data-key": "fault axis", "aria-label": words.label("axis") }, ...now.axes.map((name) => make("option", {}, name)));
    const value = make("input", { id: "fault-value", inputmode: "decimal", "data-key": "fault value", "aria-label": words.label("value") });
    const unit = make("span");
    const unit_of = (fault) => scene.faults[fault.kind][now.units[now.axes.indexOf(fault.axis)] === "deg" ? 2 : 1];
    const fit = () => {
      unit.textContent = unit_of({ kind: kind.value, axis: axis.value });
      for (const part of [axis, value, unit]) part.hidden = kind.value === "alarm";
    };
    const begin = () => {
      [value.value] = scene.faults[kind.value];
      fit();
    };
    kind.addEventListener("change", begin);
    for (const event of ["change", "restored"]) axis.addEventListener(event, fit);
    begin();
    const inject = this.button("inject", words.label("inject"), () => line.say({
      do: "inject", fault: kind.value === "alarm" ? { kind: "alarm" } : { kind: kind.value, axis: axis.value, value: number(value.value) },
    }));
    const active = now.faults.map((fault) => make("li", { class: "failed" }, `● ${words.label(`fault_${fault.kind}`)} ${fault.axis} ${fault.value} ${unit_of(fault)}`));
    return [
      make("div", { class: "row" }, ...time), make("h3", {}, words.label("inject")), make("div", { class: "row" }, kind), make("div", { class: "row" }, axis, value, unit), make("div", { class: "row" }, inject),
      ...this.make_scene(),
      make("h3", {}, words.label("active_faults")), active.length ? make("ul", {}, ...active) : make("p", { class: "quiet" }, words.label("no_faults")), make("div", { class: "row" }, ask("repair")),
    ];
  }
}

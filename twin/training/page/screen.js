// The control's screen: head, axes, speeds, the program with its running block, MDI and line editor.

import { Loads } from "./loads.js";
import { act_on, make, write } from "./parts.js";

const LAG_SHOWN = 1.0;
const SECONDS_PER_MINUTE = 60;
const THOUSANDTH = { mm: "µm", deg: "m°" };

const figure = (value, digits = 3) => (Math.round(value * 1000) / 1000 + 0).toFixed(digits).replace(/^-(0\.0*)$/, "$1");

export class Screen {
  constructor(scene, line) {
    Object.assign(this, { scene, line, chosen: 0, shown: "", on_choice: () => {}, rows: [], lines: [], entry: "" });
    this.at = (id) => document.getElementById(id);
    this.loads = new Loads(this.at("loads"));
    this.at("program").addEventListener("click", (event) => this.choose([...this.at("program").children].indexOf(event.target.closest("li")) + 1));
    this.at("program").addEventListener("keydown", (event) => {
      const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (way) { event.preventDefault(); this.choose(Math.min(this.lines.length, Math.max(1, (this.chosen || this.now.line) + way))); }
      if (event.key === "Enter") this.at("entry").querySelector("input")?.focus();
    });
    this.at("entry").addEventListener("submit", (event) => event.preventDefault());
  }

  choose(line) {
    if (!line || this.now.mode === "mdi") return;
    this.chosen = line;
    this.show_program();
    this.show_entry(true);
    this.on_choice();
  }

  show(now, words, changed) {
    Object.assign(this, { now, words });
    this.show_head();
    if (this.axes !== now.axes.join() + words.language) this.add_axes();
    if (changed.has("program") || changed.has("line") || changed.has("running")) this.show_program();
    if (["mode", "program", "role", "has_panel"].some((name) => changed.has(name)) || this.language !== words.language) this.show_entry(false);
    this.language = words.language;
    const sent = this.at("entry").querySelector("[data-key=enter]");
    if (sent) sent.classList.toggle("sent", this.at("entry").querySelector("input").value === now.entered && now.entered !== "");
    const { modal } = now;
    write(this.at("codes"), modal ? modal.codes.join("  ") : "");
  }

  show_head() {
    const { now, words } = this;
    write(this.at("control"), words.label("title"));
    write(this.at("mode-chip"), words.label(`mode_${now.mode}`));
    const freed = now.alarm?.code === "emergency-stop" && !now.pressed;
    const [name, colour] = now.replaying ? ["replaying", "blue"] : now.frozen ? ["frozen", "blue"]
      : freed ? ["reset_needed", "red"] : now.alarm ? [now.alarm.code === "program" ? "error" : "alarm", "red"] : now.held ? ["held", "yellow"] : now.running ? ["running", "green"] : ["ready", ""];
    write(this.at("state-chip"), words.label(name));
    this.at("state-chip").className = `chip ${colour}`;
    const message = this.at("message");
    const key = JSON.stringify([now.alarm, freed, now.refusal, now.broken, now.trouble, words.language]);
    if (key !== this.message) {
      this.message = key;
      message.className = "";
      const told = now.alarm ?? (now.refusal ? null : now.broken);
      if (told) {
        const alarm = words.alarm(told.code), where = words.place(told);
        const refused = now.refusal ? make("span", { class: "refusal" }, `${words.label("refused")}: ${words.text(now.refusal)} `) : null;
        message.replaceChildren(...[refused, make("b", {}, `${alarm.name}${where}: `), words.text(told.message), " ", make("span", { class: "advice" }, freed ? words.label("reset_advice") : alarm.advice)].filter(Boolean));
      } else if (now.refusal) {
        message.className = "refusal";
        message.replaceChildren(`${words.label("refused")}: ${words.text(now.refusal)}`);
      } else if (now.trouble) {
        message.className = "refusal";
        message.replaceChildren(`${words.label("not_written")}: ${now.trouble}`);
      } else {
        message.replaceChildren();
      }
    }
    const others = now.pages ?? {};
    write(this.at("pages"), `${words.label(now.role)}${now.role === "operator" && !now.has_panel ? " ◌" : ""}${others.watcher ? ` · ${words.label("watchers", { count: others.watcher })}` : ""}`);
  }

  add_axes() {
    const { now, words } = this;
    this.axes = now.axes.join() + words.language;
    const heads = ["", "position", "to_go", "machine", "following_error", "load"];
    this.at("axes").tHead.replaceChildren(make("tr", {}, ...heads.map((name) => make("th", { scope: "col", title: words.label(name || "axis"), class: name ? null : "narrow" }, words.label(name || "axis")))));
    this.rows = now.axes.map((axis) => {
      const bar = () => make("span", { class: "bar" }, make("i"), make("span"));
      const cells = [make("td", { class: "position" }), make("td"), make("td", { class: "machine" }), make("td", {}, bar()), make("td", {}, bar())];
      return { cells, row: make("tr", { "data-axis": axis }, make("th", { scope: "row" }, axis), ...cells) };
    });
    this.at("axes").tBodies[0].replaceChildren(...this.rows.map(({ row }) => row));
  }

  /** The numbers that change all the time. */
  show_state(state) {
    const { now, words } = this;
    if (!now || this.rows.length !== state.position.length) return;
    this.rows.forEach(({ cells }, i) => {
      write(cells[0], figure(state.position[i]));
      write(cells[1], figure(state.toGo[i]));
      write(cells[2], figure(state.machine[i]));
      gauge(cells[3].firstChild, Math.abs(state.lag[i]) / LAG_SHOWN, `${Math.abs(1000 * state.lag[i]).toFixed(0)} ${THOUSANDTH[now.units[i]]}`);
      gauge(cells[4].firstChild, state.load[i], `${(100 * state.load[i]).toFixed(0)} %`);
    });
    const feed = now.modal?.feed == null ? "" : String(Math.round(1000 * now.modal.feed) / 1000);
    const per_second = now.modal?.per_minute === SECONDS_PER_MINUTE;
    const unit = words.label(per_second ? "per_second" : "per_minute"), shown = per_second ? (state.feed / SECONDS_PER_MINUTE).toFixed(1) : state.feed.toFixed(0);
    const turns = now.counter_clockwise ? "↺" : "↻";
    const spindle = now.spindle_turning === null ? "-" : Math.abs(0.01 * now.spindle_override * now.spindle_turning).toFixed(0);
    const real = Number.isNaN(state.spindleSpeed) || Math.abs(state.spindleSpeed - Number(spindle)) < 0.01 * Number(spindle) + 1 ? "" : `${state.spindleSpeed.toFixed(0)} → `;
    const speeds = [["", `F ${shown}`], ["quiet", feed ? `(${feed}) ${unit}` : unit, feed && words.label("feed_now", { feed, unit })], [state.turns ? "on" : "quiet", `S ${real}${spindle}${state.turns ? ` ${turns}` : ""}`], [now.broken ? "broken" : "", `T ${now.tool}${now.broken ? " ✕" : ""}`]];
    if (now.searched) speeds.push(["contact", `▶ ${now.searched}`]);
    for (const [name, mark] of [["optional_stop", "M01"], ["block_skip", "/"], ["dry_run", words.label("dry_run")]]) if (now[name]) speeds.push(["coolant", mark]);
    if (state.coolant) speeds.push(["coolant", words.label("coolant")]);
    if (state.touches) speeds.push(["contact", words.label("contact")]);
    this.loads.show(state, words);
    const key = JSON.stringify(speeds);
    if (key !== this.speeds) {
      this.speeds = key;
      this.at("speeds").replaceChildren(...speeds.map(([name, text, title]) => make("span", { class: name, title: title || null }, text)));
    }
    const lost = now.lost_s ? ` · ${words.label("lost", { seconds: now.lost_s })}` : "";
    write(this.at("clock"), `${state.time.toFixed(1)} ${words.label("seconds")} · ×${state.speed.toFixed(2)}${lost}`);
  }

  show_program() {
    const { now } = this, list = this.at("program");
    if (this.lines !== now.program) {
      this.lines = now.program;
      if (this.chosen > this.lines.length) this.chosen = 0;
      list.replaceChildren(...this.lines.map((text, index) => make("li", { role: "option", id: `line${index + 1}` }, make("i", {}, String(index + 1)), text)));
    }
    for (const old of list.querySelectorAll(".runs, .chosen")) { old.classList.remove("runs", "chosen"); old.removeAttribute("aria-selected"); }
    const runs = list.children[now.line - 1], chosen = list.children[this.chosen - 1];
    runs?.classList.add("runs");
    chosen?.classList.add("chosen");
    (chosen ?? runs)?.setAttribute("aria-selected", "true");
    if (runs && this.last !== now.line) runs.scrollIntoView({ block: "center" });
    this.last = now.line;
  }

  /** The MDI line, or in the other modes the editor of the chosen line. */
  show_entry(chosen_now) {
    const { now, words, line } = this, form = this.at("entry");
    const acts = now.role === "trainer" || now.has_panel;
    const before = form.querySelector("input");
    const text = now.mode === "mdi" ? (this.mode === "mdi" && before ? before.value : this.entry) : this.lines[this.chosen - 1] ?? "";
    if (this.mode === "mdi" && before) this.entry = before.value;
    this.mode = now.mode;
    const button = (name, act) => {
      const made = make("button", { type: "button", "data-key": name, disabled: !acts }, words.label(name));
      act_on(made, act);
      return made;
    };
    if (now.mode === "mdi") {
      const input = make("input", { "data-key": "mdi", placeholder: this.scene.example, "aria-label": words.label("mode_mdi"), maxlength: 2000, disabled: !acts, spellcheck: "false" });
      input.value = text;
      const enter = () => { line.say({ do: "mdi", text: input.value }); input.blur(); };
      input.addEventListener("keydown", (event) => { if (event.key === "Enter") enter(); });
      form.replaceChildren(input, button("enter", enter));
    } else if (this.chosen && acts) {
      const input = make("input", { "data-key": "edited", "aria-label": `${words.label("program")} ${this.chosen}`, maxlength: 2000, spellcheck: "false" });
      input.value = chosen_now || !before ? text : before.value;
      const edit = (given) => line.say({ do: "edit", line: this.chosen, ...given });
      const set = () => { edit({ text: input.value }); input.blur(); };
      input.addEventListener("keydown", (event) => { if (event.key === "Enter") set(); });
      form.replaceChildren(
        input, button("edit", set), button("insert", () => edit({ text: `${this.lines[this.chosen - 1]}\n${input.value}` })),
        button("delete", () => { edit({}); this.chosen = 0; form.replaceChildren(); }),
      );
    } else form.replaceChildren();
  }
}

function gauge(bar, share, text) {
  write(bar.lastChild, text);
  const width = `${Math.round(100 * Math.min(1, share))}%`;
  if (bar.firstChild.style.width !== width) bar.firstChild.style.width = width;
  bar.className = share > 0.9 ? "bar top" : share > 0.66 ? "bar high" : "bar";
}

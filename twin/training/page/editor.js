// The program as a whole: typed, opened from a file, saved to one; what the control says of it stands below.

import { act_on, make, reveal, write } from "./parts.js";

const TYPED_MS = 350;
const LONGEST = 60000;

export class Editor {
  constructor(line) {
    Object.assign(this, { line, box: document.getElementById("editor"), timer: null, checked: null });
  }

  /** What is shown changes with the language, and with what the control says. */
  show(now, words, changed) {
    Object.assign(this, { now, words });
    if (changed.has("checked") && !this.box.hidden) this.tell(now.checked);
  }

  open() {
    const { words, now, line } = this;
    const button = (name, act) => {
      const made = make("button", { type: "button", "data-key": name }, words.label(name));
      act_on(made, act);
      return made;
    };
    const acts = now.role === "trainer" || now.has_panel;
    this.text = make("textarea", { "data-key": "program text", "aria-label": words.label("program"), spellcheck: "false", maxlength: LONGEST, wrap: "off" });
    this.text.value = now.program.join("\n");
    this.text.addEventListener("input", () => this.check_soon());
    const file = make("input", { type: "file", "data-key": "program file", "aria-label": words.label("open_file"), hidden: true });
    file.addEventListener("change", async () => {
      this.text.value = (await file.files[0].text()).slice(0, LONGEST);
      this.check_soon();
    });
    const load = button("load_program", () => { line.say({ do: "load", text: this.text.value }); this.close(); });
    load.disabled = !acts;
    this.said = make("button", { type: "button", class: "said", "data-key": "finding", hidden: true });
    act_on(this.said, () => this.go_there());
    this.box.replaceChildren(
      make("div", { class: "row" }, load, button("open_file", () => file.click()), button("save_file", () => this.save()), button("close", () => this.close()), file),
      this.text, make("div", { role: "status" }, this.said),
    );
    this.box.hidden = false;
    reveal(this.box);
    this.text.focus({ preventScroll: true });
    this.check_soon();
  }

  close() {
    this.box.hidden = true;
    this.box.replaceChildren();
  }

  check_soon() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.line.say({ check: this.text.value }), TYPED_MS);
  }

  tell(checked) {
    const { said, words } = this;
    this.checked = checked;
    said.hidden = false;
    said.classList.toggle("wrong", checked.moves === undefined);
    said.disabled = !checked.line;
    write(said, checked.moves === undefined ? `${checked.line ? `${words.label("line")} ${checked.line}: ` : ""}${words.text(checked.message)}` : words.label("program_right", { moves: checked.moves }));
  }

  /** Mark what the control means. */
  go_there() {
    const { line, column, width } = this.checked, lines = this.text.value.split("\n");
    const begin = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0) + Math.max(0, column - 1);
    this.text.focus();
    this.text.setSelectionRange(begin, begin + Math.max(1, width));
  }

  save() {
    const address = URL.createObjectURL(new Blob([`${this.text.value.trimEnd()}\n`], { type: "text/plain" }));
    make("a", { href: address, download: "program.nc" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }
}

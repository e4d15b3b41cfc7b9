// Small parts: elements, keys that act when they are pressed, the words of a language.

export const LANGUAGE_NAMES = { en: "English", ru: "Русский", it: "Italiano", cs: "Čeština" };

/** Make an element; attributes that begin with "on" are listeners. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** A key of the control desk. It keeps the focus where it is, so that the keyboard stays the machine's. */
export function key(label, act, { lamp = "cyan", atOnce = false, name = null, className = "" } = {}) {
  const button = make("button", { type: "button", class: `key ${className}`, "data-key": name }, label);
  button.style.setProperty("--lamp", `var(--${lamp})`);
  act_on(button, act, atOnce);
  return button;
}

/** Put a word on a key, in smaller letters where its longest part is too long for the key. */
export function label_key(button, text) {
  const span = make("span", {}, text);
  span.style.setProperty("--longest", Math.max(...text.split(/[\s-]/).map((part) => part.length)));
  button.replaceChildren(span);
}

/** Let a button act: when it is let go, or at once; by the keyboard too. */
export function act_on(button, act, atOnce = false) {
  button.addEventListener("mousedown", (event) => event.preventDefault());
  if (!atOnce) return button.addEventListener("click", act);
  button.addEventListener("pointerdown", (event) => { if (event.button === 0 && !button.disabled) act(event); });
  // A click without a pointer is the keyboard's.
  return button.addEventListener("click", (event) => { if (event.detail === 0) act(event); });
}

export function light(button, on) {
  button.classList.toggle("lit", on);
  button.setAttribute("aria-pressed", on);
}

/** Scroll to a box over the view, where a small screen has it out of sight. */
export function reveal(box) {
  box.closest("#view").scrollIntoView({ block: "nearest" });
}

/** Set a text only where it changes: what is read aloud or laid out need not be done again. */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export class Words {
  constructor(language, { labels, alarms }) {
    Object.assign(this, { language, labels, alarms });
  }

  label(name, values = {}) {
    return (this.labels[name] ?? name).replace(/\{(\w+)\}/g, (_, key) => values[key] ?? "");
  }

  /** A text of a scene or of the machine, in this language or the nearest that there is. */
  text(texts) {
    return typeof texts === "string" ? texts : texts[this.language] ?? texts.en ?? Object.values(texts)[0] ?? "";
  }

  alarm(code) {
    return this.alarms[code] ?? { name: code, advice: "" };
  }

  /** Where an alarm came: its block's number, else its line. */
  place(alarm) {
    if (alarm.block) return ` ${alarm.block}`;
    return alarm.line ? ` ${this.label("line")} ${alarm.line}` : "";
  }

  fill(root) {
    for (const element of root.querySelectorAll("[data-word]")) write(element, this.label(element.dataset.word));
    for (const element of root.querySelectorAll("[data-name]")) element.setAttribute("aria-label", this.label(element.dataset.name));
  }
}

/** A number as it is typed, with a point or a comma; what is none stays a text, which the machine refuses in words. */
export function number(text) {
  return /^\s*[+-]?(\d+[.,]?\d*|[.,]\d+)\s*$/.test(text) ? Number(text.replace(",", ".")) : text;
}

/**
 * A field whose value goes to the machine when it is entered; where it is refused, the sheet shows the machine's own again.
 * What is typed is marked as such: a browser tells of no change where a sheet was drawn anew under the typing hand.
 */
export function field(attributes, send) {
  const made = make("input", { autocomplete: "off", "data-hand": "shown", ...attributes });
  const enter = () => {
    if (made.dataset.hand !== "typed" || !made.isConnected) return;
    made.dataset.hand = "sent";
    send(made.value);
  };
  made.addEventListener("input", () => { made.dataset.hand = "typed"; });
  made.addEventListener("keydown", (event) => { if (event.key === "Enter") enter(); });
  made.addEventListener("change", enter);
  // A window that loses the focus is no field that is left.
  made.addEventListener("blur", () => { if (document.activeElement !== made) enter(); });
  return made;
}

/** What is selected in a field: a whole text stays selected whole, though the text drawn anew is longer. */
function selection(one) {
  const whole = one.selectionStart === 0 && one.selectionEnd === one.value.length && one.value !== "";
  return whole ? [0, Number.MAX_SAFE_INTEGER] : [one.selectionStart, one.selectionEnd];
}

/** What stands in the fields of a part of the page, of which hand, and where the hand is: to be put back when it has been drawn anew. */
export function typing(part) {
  const fields = [...part.querySelectorAll("input:not([type=checkbox]):not([data-hand=shown]):not([data-hand=sent]), select")];
  const here = part.contains(document.activeElement) ? document.activeElement : null;
  const found = { values: fields.map((one) => [one.dataset.key, one.value, one.dataset.hand]), focus: here?.dataset.key, caret: here?.type === "text" ? selection(here) : null };
  // They are taken away, which is no leaving of a field.
  for (const one of fields) delete one.dataset.hand;
  return found;
}

/** Put back what ``typing`` found; without values, the focus alone. */
export function put_back(part, { values, focus, caret }) {
  const fields = new Map([...part.querySelectorAll("[data-key]")].map((one) => [one.dataset.key, one]));
  for (const [name, value, hand] of values) {
    const one = fields.get(name);
    if (!one) continue;
    one.value = value;
    if (hand) one.dataset.hand = hand;
    one.dispatchEvent(new Event("restored"));
  }
  fields.get(focus)?.focus();
  if (caret && fields.get(focus)?.type === "text") fields.get(focus).setSelectionRange(...caret);
}

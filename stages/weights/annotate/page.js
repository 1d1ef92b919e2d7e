// The page: pointers and keys turn the mesh and choose points; points are listed, undone, removed and saved.
import { View } from "./view.js";

const ask = (id) => document.getElementById(id);
const canvas = ask("canvas");
const STILL = { mouse: 4, pen: 6, touch: 10 }; // pixels a press may wander and still be a click
const ON_DOT = 12; // pixels from a dot's middle within which a click chooses the dot

let about, view;
let annotator = "";
let marks = []; // { time, vertex } in the order of the numbers; never changed in place
let saved = []; // as they are on disk
let history = []; // earlier values of marks
let chosen = -1; // place in marks
let dots = []; // { left, top, hidden } of each mark
let saving = false;

const key = (list) => list.map((mark) => `${mark.time} ${mark.vertex}`).join();
const unsaved = () => key(marks) !== key(saved);
const counted = (count) => (count === 1 ? "1 point" : `${count} points`);
const joined = (list, more) => [...list, ...more.filter((one) => !list.some((other) => other.vertex === one.vertex))];

function say(text) {
  ask("message").textContent = text;
  ask("error").textContent = "";
}

function complain(text) {
  ask("error").textContent = text;
}

async function fetched(address, options) {
  const answer = await fetch(address, options).catch(() => {
    throw new Error("The program in the terminal does not answer. The points stay on this page: start it again, then save.");
  });
  if (!answer.ok) throw Object.assign(new Error((await answer.json()).error), { status: answer.status });
  return answer;
}

const stored = async (name) => (await fetched(`/marks?annotator=${encodeURIComponent(name)}`)).json();

// ---- points

function change(next, text) {
  history.push(marks);
  marks = next;
  chosen = -1;
  say(text);
  list();
}

function mark(left, top) {
  view.paintPending();
  const near = dots.findIndex((dot) => !dot.hidden && Math.hypot(dot.left - left, dot.top - top) < ON_DOT);
  if (near >= 0) return choose(near);
  const vertex = view.pick(left, top);
  if (vertex < 0) return say("No point there: click on the object.");
  const marked = marks.findIndex((one) => one.vertex === vertex);
  if (marked >= 0) return choose(marked);
  change([...marks, { time: new Date().toISOString(), vertex }], `Point ${marks.length + 1} marked.`);
  scrollTo(marks.length - 1);
}

function undo() {
  if (!history.length) return say("Nothing to undo.");
  marks = history.pop();
  chosen = -1;
  say(`Undone. ${counted(marks.length)}.`);
  list();
}

function remove(which) {
  if (which < 0) return say("Choose a point first: click its number.");
  change(marks.filter((_, k) => k !== which), `Point ${which + 1} removed; undo brings it back.`);
}

function choose(which) {
  chosen = chosen === which ? -1 : which;
  say(chosen < 0 ? "" : `Point ${which + 1} chosen: Delete removes it.`);
  list();
  scrollTo(which);
}

// Scrolls the list alone: on a narrow window, where the list has no scroll bar of its own, the page stays where it is.
function scrollTo(which) {
  const [all, row] = [ask("points"), ask("points").children[which]];
  const [above, below] = [row.offsetTop - all.offsetTop, row.offsetTop + row.offsetHeight - all.offsetTop - all.clientHeight];
  all.scrollTop = Math.max(below, Math.min(above, all.scrollTop));
}

function button(text, label, work) {
  const made = Object.assign(document.createElement("button"), { type: "button", textContent: text });
  made.setAttribute("aria-label", label);
  made.addEventListener("click", work);
  return made;
}

function list() {
  const scrolled = ask("points").scrollTop;
  const held = [...ask("points").children].findIndex((row) => row.contains(document.activeElement));
  ask("points").replaceChildren(...marks.map((one, k) => {
    const row = document.createElement("li");
    row.dataset.vertex = one.vertex;
    const time = new Date(one.time);
    const name = button(String(k + 1), `Point ${k + 1}`, () => { choose(k); if (chosen === k) view.face(one.vertex); });
    name.setAttribute("aria-pressed", chosen === k);
    const when = Object.assign(document.createElement("time"), { dateTime: one.time, textContent: time.toLocaleTimeString() });
    when.title = time.toLocaleString();
    row.append(name, when, button("Remove", `Remove point ${k + 1}`, () => remove(k)));
    return row;
  }));
  ask("points").scrollTop = scrolled;
  if (held >= 0) (ask("points").children[Math.min(held, marks.length - 1)]?.firstChild || canvas).focus();
  ask("dots").replaceChildren(...marks.map((_, k) => Object.assign(document.createElement("span"), { textContent: k + 1 })));
  ask("none").hidden = marks.length > 0;
  ask("state").textContent = unsaved() ? `${counted(marks.length)}, not saved` : marks.length ? `${counted(marks.length)}, all saved` : "";
  ask("state").classList.toggle("unsaved", unsaved());
  document.title = `${unsaved() ? "* " : ""}${about.name}: mark points`;
  if (view) view.draw();
}

function placeDots() {
  dots = view.places(marks.map((one) => one.vertex));
  dots.forEach((dot, k) => {
    const span = ask("dots").children[k];
    span.style.transform = `translate(${dot.left.toFixed(1)}px, ${dot.top.toFixed(1)}px) translate(-50%, -50%)`;
    span.className = (dot.hidden ? "hidden" : "") + (k === chosen ? " chosen" : "");
  });
}

// ---- the annotator, loading and saving

async function become(name) {
  const own = annotator ? [] : marks; // points placed before a name was given are that person's
  const found = await stored(name);
  annotator = found.annotator;
  [saved, history, chosen] = [found.marks, [], -1];
  marks = joined(saved, own);
  ask("who").textContent = annotator;
  say(saved.length ? `${counted(saved.length)} of ${annotator} loaded.` : `Nothing saved yet by ${annotator}.`);
  list();
}

// Resolves to whether there is a name now.
function askName() {
  const dialog = ask("name-dialog");
  ask("name").value = annotator;
  ask("name-error").textContent = "";
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => dialog.addEventListener("close", () => resolve(annotator !== ""), { once: true }));
}

async function save() {
  if (saving || (!annotator && !(await askName()))) return;
  if (!unsaved()) return say(`Nothing to save: ${about.file} holds all ${counted(marks.length)}.`);
  saving = true;
  const sent = marks;
  const body = JSON.stringify({ annotator, mesh: about.mesh, marks: sent, seen: saved });
  try {
    const answer = await (await fetched("/marks", { method: "PUT", body })).json();
    saved = answer.marks;
    say(`Saved ${counted(sent.length)} to ${answer.file}.`);
  } catch (error) {
    if (error.status === 409) await meet();
    else complain(`Not saved: ${error.message}`);
  }
  saving = false;
  list();
}

// Another window, or another program, wrote points under this name meanwhile.
async function meet() {
  try {
    saved = (await stored(annotator)).marks;
    change(joined(saved, marks), "");
    complain(`Not saved: other points of ${annotator} were saved meanwhile. Both are shown now; check them and save again.`);
  } catch (error) {
    complain(`Not saved: ${error.message}`);
  }
}

// ---- pointers and keys

const fingers = new Map();
let press = null; // where a press began, while it may still be a click
const middle = () => {
  const all = [...fingers.values()];
  return [all.reduce((sum, one) => sum + one.left, 0) / all.length, all.reduce((sum, one) => sum + one.top, 0) / all.length];
};
const spread = () => {
  const [a, b] = [...fingers.values()];
  return Math.hypot(a.left - b.left, a.top - b.top);
};
const inside = (event) => {
  const box = canvas.getBoundingClientRect();
  return { left: event.clientX - box.left - canvas.clientLeft, top: event.clientY - box.top - canvas.clientTop };
};

canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  const at = inside(event);
  fingers.set(event.pointerId, at);
  press = fingers.size === 1 && event.button === 0 && !event.shiftKey ? at : null;
});
canvas.addEventListener("pointermove", (event) => {
  const last = fingers.get(event.pointerId);
  if (!last) return;
  const at = inside(event);
  if (press) {
    if (Math.hypot(at.left - press.left, at.top - press.top) < STILL[event.pointerType]) return;
    press = null; // the turn begins where the press did, so that none of the drag is lost
  }
  const before = fingers.size === 2 ? [...middle(), spread()] : null;
  fingers.set(event.pointerId, at);
  if (before) {
    const [left, top] = middle();
    view.shift(left - before[0], top - before[1]);
    view.zoom(spread() / Math.max(before[2], 1), left, top);
  } else if (fingers.size === 1) {
    const [right, down] = [at.left - last.left, at.top - last.top];
    if (event.shiftKey || event.buttons & 2) view.shift(right, down);
    else view.turn(-0.4 * right, 0.4 * down);
  }
});
canvas.addEventListener("pointerup", (event) => {
  if (press) mark(press.left, press.top);
  press = null;
  fingers.delete(event.pointerId);
});
canvas.addEventListener("pointercancel", (event) => {
  press = null;
  fingers.delete(event.pointerId);
});
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  const { left, top } = inside(event);
  const pixels = event.deltaY * (event.deltaMode ? 30 : 1); // some browsers count lines
  view.zoom(Math.exp(-0.0015 * pixels), left, top);
}, { passive: false });

const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
canvas.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const arrow = arrows[event.key];
  if (arrow && event.shiftKey) view.shift(-20 * arrow[0], -20 * arrow[1]);
  else if (arrow) view.turn(-8 * arrow[0], 8 * arrow[1]);
  else if (event.key === "+" || event.key === "=") view.zoom(1.15);
  else if (event.key === "-") view.zoom(1 / 1.15);
  else if (event.key === "0") view.reset();
  else if (event.key === "Enter" || event.key === " ") mark(canvas.clientWidth / 2, canvas.clientHeight / 2);
  else return;
  event.preventDefault();
});
document.addEventListener("keydown", (event) => {
  if (ask("name-dialog").open) return;
  const letter = event.ctrlKey || event.metaKey ? event.key.toLowerCase() : "";
  if (letter === "s") save();
  else if (letter === "z" && !event.shiftKey) undo();
  else if (event.key === "Delete" || event.key === "Backspace") remove(chosen);
  else return;
  event.preventDefault();
});
window.addEventListener("beforeunload", (event) => {
  if (about && unsaved()) event.preventDefault();
});

ask("undo").addEventListener("click", undo);
ask("save").addEventListener("click", save);
ask("reset").addEventListener("click", () => view.reset());
ask("zoom-in").addEventListener("click", () => view.zoom(1.3));
ask("zoom-out").addEventListener("click", () => view.zoom(1 / 1.3));
ask("change").addEventListener("click", () => {
  if (saving) return;
  if (annotator && unsaved() && !confirm(`The latest changes of ${annotator} are not saved and would be lost. Go on?`)) return;
  askName();
});
ask("name-cancel").addEventListener("click", () => ask("name-dialog").close());
ask("name-form").addEventListener("submit", async (event) => {
  event.preventDefault();
  try {
    await become(ask("name").value);
    ask("name-dialog").close();
  } catch (error) {
    ask("name-error").textContent = error.message;
  }
});

async function start() {
  about = await (await fetched("/about")).json();
  const content = await (await fetched("/mesh")).arrayBuffer();
  const positions = new Float32Array(content, 0, 3 * about.vertices);
  view = new View(canvas, positions, new Uint32Array(content, 12 * about.vertices), placeDots);
  ask("object").textContent = about.name;
  canvas.setAttribute("aria-label", `Turnable ${about.name}, ${about.faces.toLocaleString("en")} faces`);
  list();
  if (about.annotator) await become(about.annotator);
  if (about.warning) complain(about.warning);
  if (!about.annotator) await askName();
}
start().catch((error) => complain(error.message));

// Plays the page of `phase export --to page` without a browser, and prints what its script decodes.
//
// Usage: node read_page.js PAGE
// A line of JSON per state: its time, the spheres that are in, their coordinates (m). Fails if the
// script fails, asks for anything beside the page, or does not do what its keys and buttons promise.
"use strict";

const assert = require("assert");
const fs = require("fs");
const vm = require("vm");

const page = fs.readFileSync(process.argv[2], "utf8");
assert(!/\b(src|href)\s*=|https?:\/\/|@import|fetch\(|XMLHttpRequest/.test(page), "a resource outside");
const json = page.match(/<script type="application\/json" id="run">(.*)<\/script>/)[1];
const script = page.match(/<script>\n([\s\S]*)<\/script>/)[1];

// Elements that remember what was done to them.
const drawn = { discs: [] };
const context = new Proxy({ arc: (x, y, radius) => drawn.discs.push([x, y, radius, context.fillStyle]) }, {
  get: (object, name) => object[name] ?? (() => {}),
});
function element(tagName, id) {
  const listeners = {};
  return {
    tagName, id, listeners, style: {}, attributes: {}, children: [], value: "1", textContent: "",
    addEventListener: (name, listener) => { listeners[name] = listener; },
    setAttribute(name, value) { this.attributes[name] = value; },
    append(...children) { this.children.push(...children); },
    getContext: () => context,
  };
}
const ids = { run: "SCRIPT", picture: "CANVAS", time: "INPUT", clock: "OUTPUT", counts: "SPAN",
  play: "BUTTON", speed: "SELECT", milestones: "P" };
const elements = {};
for (const [id, tag] of Object.entries(ids)) {
  assert(page.includes(`id="${id}"`), `no element ${id}`);
  elements[id] = element(tag, id);
}
elements.run.textContent = json;
let frame = null;
const world = {
  JSON, Math, Number, String, Array, Uint8Array, Uint32Array, Float64Array, atob,
  performance: { now: () => 0 },
  requestAnimationFrame: (next) => { frame = next; },
  document: Object.assign(element("DOCUMENT", ""), {
    getElementById: (id) => elements[id],
    createElement: (tag) => element(tag.toUpperCase(), ""),
    body: { clientWidth: 800 },
  }),
  window: Object.assign(element("WINDOW", ""), { innerHeight: 900, devicePixelRatio: 2 }),
};
vm.createContext(world);
vm.runInContext(`${script}\nthis.decode = decode; this.stateAt = stateAt;`, world);

const run = JSON.parse(json);
const states = world.decode(run);
const last = states.length - 1;
assert.strictEqual(states.length, run.times.length);

// The first state is drawn at once, to scale.
function redraw(act) {
  drawn.discs = [];
  act();
  const count = (color) => drawn.discs.filter((disc) => disc[3] === color).length;
  return [run.colors.wall, run.colors.door, run.colors.grain].map(count);
}
function press(key, target = { id: "", tagName: "BODY" }) {
  let prevented = false;
  const event = { key, target, preventDefault: () => { prevented = true; } };
  return [redraw(() => world.document.listeners.keydown(event)), prevented];
}
function expected(index) {
  const closed = run.opened === null || run.times[index] < run.opened;
  return [run.walls.length, closed ? run.door.length : 0, states[index].index.length];
}
const scale = elements.picture.width / (run.window[2] - run.window[0]);
for (let index = 0; index <= last; index++) {
  elements.time.value = String(index);
  assert.deepStrictEqual(redraw(() => elements.time.listeners.input()), expected(index));
  assert(elements.picture.attributes["aria-label"].includes(elements.clock.textContent));
  const discs = drawn.discs.filter((disc) => disc[3] === run.colors.grain);
  if (discs.length > 0 && run.axes === 2) {
    const [x, y, radius] = discs[0];
    const { index: spheres, place } = states[index];
    assert(Math.abs(x - (place[0] - run.window[0]) * scale) < 1e-6);
    assert(Math.abs(y - (run.window[3] - place[1]) * scale) < 1e-6);
    assert(Math.abs(radius - run.radius[spheres[0]] * scale) < 1e-6);
  }
}
const [, prevented] = press("Home");
assert(prevented);
assert.strictEqual(elements.time.value, "0");
assert.deepStrictEqual(press("ArrowRight"), [expected(1), true]);
assert.deepStrictEqual(press("End"), [expected(last), true]);
press("ArrowLeft");
assert.strictEqual(elements.time.value, String(last - 1));
// Keys of the slider and of buttons stay theirs.
assert(!press("ArrowRight", elements.time)[1] && !press(" ", elements.play)[1]);

// It plays in real time, and stops at the end.
press("Home");
press(" ");
assert.strictEqual(elements.play.textContent, "Pause");
frame(1000 * (run.times[1] - run.times[0]) + 1e-3);
assert.strictEqual(elements.time.value, "1");
elements.speed.value = "10";
frame(1e9);
assert.strictEqual(elements.time.value, String(last));
assert.strictEqual(elements.play.textContent, "Play");
const buttons = elements.milestones.children.filter((child) => child.tagName === "BUTTON");
assert.strictEqual(buttons.length, run.milestones.length);
buttons.forEach((button, index) => {
  button.listeners.click();
  const shown = Number(elements.time.value);
  const when = run.milestones[index][1];
  assert(run.times[shown] > when - 1e-9 || shown === last);
  assert(shown === 0 || run.times[shown - 1] <= when - 1e-9);
});

states.forEach((state, index) => {
  const line = { time: run.times[index], index: [...state.index], place: [...state.place] };
  console.log(JSON.stringify(line));
});

"use strict";

// The states of a run: for each the indices of the spheres that are in, and their coordinates (m),
// `run.axes` numbers each. The bytes are described in bytes.rs.
function decode(run) {
  const bytes = Uint8Array.from(atob(run.positions), (letter) => letter.charCodeAt(0));
  let at = 0;
  function number() {
    let value = 0;
    let factor = 1;
    for (;;) {
      const byte = bytes[at++];
      value += (byte & 0x7f) * factor;
      if (byte < 0x80) return value;
      factor *= 128;
    }
  }
  function indices() {
    const found = [];
    let sphere = 0;
    for (let count = number(); count > 0; count--) {
      sphere += number();
      found.push(sphere);
    }
    return found;
  }
  let zeros = 0;
  function difference() {
    if (zeros > 0) {
      zeros--;
      return 0;
    }
    const value = number();
    if (value === 0) zeros = number();
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }

  const spheres = run.radius.length;
  const isIn = new Array(spheres).fill(false);
  const quanta = new Float64Array(spheres * run.axes);
  return run.times.map(() => {
    for (const sphere of indices()) {
      isIn[sphere] = true;
      quanta.fill(0, sphere * run.axes, (sphere + 1) * run.axes);
    }
    for (const sphere of indices()) isIn[sphere] = false;
    const index = [];
    const place = [];
    for (let sphere = 0; sphere < spheres; sphere++) {
      if (!isIn[sphere]) continue;
      index.push(sphere);
      for (let axis = 0; axis < run.axes; axis++) {
        quanta[sphere * run.axes + axis] += difference();
        place.push(quanta[sphere * run.axes + axis] * run.quantum);
      }
    }
    return { index: Uint32Array.from(index), place: Float64Array.from(place) };
  });
}

// Where in the state each sphere stands, in the order in which they are drawn: the viewer is where
// y is low.
function order(state, axes) {
  const all = Array.from(state.index.keys());
  if (axes === 3) all.sort((a, b) => state.place[3 * b + 2] - state.place[3 * a + 2]);
  return all;
}

// Index of the last state that is not after a time.
function stateAt(times, time) {
  let low = 0;
  let high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle;
  }
  return low;
}

// Draws one state onto a canvas whose pixels are `scale` to a metre.
function draw(context, run, state, time, scale) {
  const [left, low, right, high] = run.window;
  const width = (right - left) * scale;
  const height = (high - low) * scale;
  context.fillStyle = "#fff";
  context.fillRect(0, 0, width, height);
  const x = (value) => (value - left) * scale;
  const y = (value) => (high - value) * scale;
  function disc(across, up, radius) {
    context.beginPath();
    context.arc(x(across), y(up), radius * scale, 0, 2 * Math.PI);
    context.fill();
  }
  context.strokeStyle = run.colors.wall;
  context.lineWidth = 0.006 * width;
  for (const [fromX, fromZ, toX, toZ] of run.lines) {
    context.beginPath();
    context.moveTo(x(fromX), y(fromZ));
    context.lineTo(x(toX), y(toZ));
    context.stroke();
  }
  context.fillStyle = run.colors.wall;
  for (const [across, up, radius] of run.walls) disc(across, up, radius);
  context.fillStyle = run.colors.door;
  const closed = run.opened === null || time < run.opened;
  if (closed) for (const [across, up, radius] of run.door) disc(across, up, radius);
  context.fillStyle = run.colors.grain;
  context.strokeStyle = "#fff";
  for (const at of order(state, run.axes)) {
    const radius = run.radius[state.index[at]];
    context.lineWidth = 0.06 * radius * scale;
    disc(state.place[at * run.axes], state.place[at * run.axes + 1], radius);
    context.stroke();
  }
}

// How many are where, in words.
function counts(run, state, shown) {
  const inside = state.index.length;
  if (!run.flows) return `${inside} spheres`;
  const released = run.released[shown];
  return `${inside} grains in, ${released - inside} have left, ` +
    `${run.radius.length - released} still to come`;
}

function start() {
  const element = (id) => document.getElementById(id);
  const run = JSON.parse(element("run").textContent);
  const states = decode(run);
  const canvas = element("picture");
  const context = canvas.getContext("2d");
  const slider = element("time");
  const last = states.length - 1;
  // As many digits as tell neighbouring states apart.
  const gaps = run.times.slice(1).map((time, index) => time - run.times[index]);
  const least = gaps.reduce((one, other) => Math.min(one, other), 1);
  const digits = Math.min(6, Math.ceil(-Math.log10(least) - 1e-9));
  let shown = 0;
  let playing = false;
  // Time of the run, and of the clock when it was that (ms).
  let time = run.times[0];
  let then = 0;

  function show(index) {
    shown = Math.max(0, Math.min(last, index));
    const clock = `t = ${run.times[shown].toFixed(digits)} s`;
    const words = counts(run, states[shown], shown);
    draw(context, run, states[shown], run.times[shown], canvas.width / (run.window[2] - run.window[0]));
    slider.value = String(shown);
    slider.setAttribute("aria-valuetext", clock);
    element("clock").textContent = clock;
    element("counts").textContent = words;
    canvas.setAttribute("aria-label", `${run.title}, ${clock}: ${words}`);
  }

  // Goes to a state, and on from there if it plays.
  function go(index) {
    show(index);
    time = run.times[shown];
  }

  function fit() {
    const [left, low, right, high] = run.window;
    const ratio = window.devicePixelRatio || 1;
    const room = [document.body.clientWidth, Math.max(200, window.innerHeight - 220)];
    const scale = Math.min(room[0] / (right - left), room[1] / (high - low));
    const size = [(right - left) * scale, (high - low) * scale];
    canvas.style.width = `${size[0]}px`;
    canvas.style.height = `${size[1]}px`;
    canvas.width = Math.round(size[0] * ratio);
    canvas.height = Math.round(size[1] * ratio);
    show(shown);
  }

  function play(on) {
    playing = on;
    element("play").textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (shown === last) go(0);
    then = performance.now();
    requestAnimationFrame(tick);
  }

  function tick(now) {
    if (!playing) return;
    time += (Math.max(0, now - then) / 1000) * Number(element("speed").value);
    then = now;
    const index = stateAt(run.times, time);
    if (index !== shown) show(index);
    if (index === last) play(false);
    else requestAnimationFrame(tick);
  }

  function key(event) {
    const target = event.target.id;
    const steps = { ArrowLeft: -1, ArrowRight: 1, Home: -last, End: last };
    if (event.key === " " && event.target.tagName !== "BUTTON") play(!playing);
    else if (event.key in steps && target !== "speed" && target !== "time") go(shown + steps[event.key]);
    else return;
    event.preventDefault();
  }

  for (const [name, when] of run.milestones) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = `${name}: ${when} s`;
    const index = run.times.findIndex((time) => time > when - 1e-9);
    button.addEventListener("click", () => go(index < 0 ? last : index));
    element("milestones").append(button, " ");
  }
  slider.max = String(last);
  slider.addEventListener("input", () => go(Number(slider.value)));
  element("play").addEventListener("click", () => play(!playing));
  document.addEventListener("keydown", key);
  window.addEventListener("resize", fit);
  fit();
}

start();

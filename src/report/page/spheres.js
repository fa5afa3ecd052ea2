/** The animation of the spheres of a run: from the side and from above. */
report.spheres = (() => {
  const { create } = report.dom;

  /** At least so many milliseconds from a state to the next, and from the first to the last. */
  const SHORTEST_PAUSE = 1000 / 6;
  const SHORTEST_PLAY = 3000;

  /** Sprites of shaded spheres by radius in pixels, drawn once. */
  function sprites(color) {
    const known = new Map();
    return (radius) => {
      const size = Math.max(1, Math.round(radius * 4) / 4);
      if (!known.has(size)) {
        known.set(size, sprite(size, color));
      }
      return known.get(size);
    };
  }

  function sprite(radius, color) {
    const side = Math.ceil(2 * radius + 2);
    const canvas = create("canvas", { width: side, height: side });
    const context = canvas.getContext("2d");
    const middle = side / 2;
    const shade = context.createRadialGradient(
      middle - 0.35 * radius,
      middle - 0.4 * radius,
      0.1 * radius,
      middle,
      middle,
      radius,
    );
    shade.addColorStop(0, report.colors.mix(color, "#ffffff", 0.45));
    shade.addColorStop(0.6, color);
    shade.addColorStop(1, report.colors.mix(color, "#000000", 0.4));
    context.fillStyle = shade;
    context.beginPath();
    context.arc(middle, middle, radius, 0, 2 * Math.PI);
    context.fill();
    return canvas;
  }

  /** What a view looks along, across and up: indices of x, y, z and the sign of what is nearer. */
  const VIEWS = {
    side: { name: "from the side", axes: [0, 2], depth: 1, nearer: -1 },
    above: { name: "from above", axes: [0, 1], depth: 2, nearer: 1 },
  };

  /** The box in metres that a view shows. A start from high above would leave a small picture. */
  function extent(states, at, view) {
    const margin = Math.max(...[states.radii].flat());
    const { walls } = states;
    const [across, up] = view.axes.map((axis) => [
      Math.min(states.low[axis] - margin, ...ends(walls, axis)),
      Math.max(states.high[axis] + margin, ...ends(walls, axis)),
    ]);
    if (view.axes[1] === 2 && !states.is_flat) {
      const highest =
        Math.max(...states.times.slice(1).map((_, frame) => highestAt(states, at, frame + 1))) +
        2 * margin;
      const least = up[0] + 0.5 * (across[1] - across[0]);
      up[1] = Math.min(up[1], Math.max(highest, least), up[0] + 1.4 * (across[1] - across[0]));
    }
    return [across, up];
  }

  function highestAt(states, at, frame) {
    const heights = Array.from(
      { length: states.count },
      (_, sphere) => at(frame, sphere)?.[2] ?? -Infinity,
    );
    return Math.max(...heights);
  }

  function ends(walls, axis) {
    if (walls?.kind === "tank") {
      return axis === 2 ? [walls.floor] : [-walls.radius, walls.radius];
    }
    if (walls?.kind === "segments") {
      return walls.segments.flatMap(([x0, z0, x1, z1]) => (axis === 0 ? [x0, x1] : [z0, z1]));
    }
    return [];
  }

  function drawWalls(context, walls, name, to, scale, ink) {
    context.strokeStyle = ink;
    context.lineWidth = 1;
    context.beginPath();
    if (walls?.kind === "tank" && name === "above") {
      context.arc(...to(0, 0), walls.radius * scale, 0, 2 * Math.PI);
    } else if (walls?.kind === "tank") {
      const [left, floor] = to(-walls.radius, walls.floor);
      const [right] = to(walls.radius, walls.floor);
      context.moveTo(left, 0);
      context.lineTo(left, floor);
      context.lineTo(right, floor);
      context.lineTo(right, 0);
    }
    if (walls?.kind === "segments") {
      walls.segments.forEach(([x0, z0, x1, z1]) => {
        context.moveTo(...to(x0, z0));
        context.lineTo(...to(x1, z1));
      });
    }
    context.stroke();
  }

  /** A canvas of one view; `draw(frame)` draws it. */
  function canvasOf(states, at, name, color) {
    const view = VIEWS[name];
    const canvas = create("canvas", {
      class: "spheres",
      role: "img",
      "aria-label": `Spheres ${view.name}`,
    });
    const [across, up] = extent(states, at, view);
    const caption = create("figcaption", {});
    const radius = (sphere) => (Array.isArray(states.radii) ? states.radii[sphere] : states.radii);
    let spriteOf = null;
    let scale = 1;
    let frame = 0;
    const size = (width) => {
      const ratio = window.devicePixelRatio || 1;
      const height = Math.min(420, (width * (up[1] - up[0])) / (across[1] - across[0]));
      scale = Math.min(width / (across[1] - across[0]), height / (up[1] - up[0])) * ratio;
      Object.assign(canvas, { width: width * ratio, height: Math.ceil(height * ratio) });
      spriteOf = sprites(color);
      paint(frame);
    };
    const paint = (index) => {
      frame = index;
      if (spriteOf === null) {
        return;
      }
      const context = canvas.getContext("2d");
      const left = (canvas.width - (across[1] - across[0]) * scale) / 2;
      const to = (x, y) => [left + (x - across[0]) * scale, canvas.height - (y - up[0]) * scale];
      context.clearRect(0, 0, canvas.width, canvas.height);
      drawWalls(context, states.walls, name, to, scale, getComputedStyle(canvas).color);
      const places = Array.from({ length: states.count }, (_, sphere) => [
        sphere,
        at(index, sphere),
      ]).filter(([, place]) => place);
      const hidden = places.filter(([, place]) => place[view.axes[1]] > up[1]).length;
      caption.textContent = `${states.is_flat ? "discs" : view.name}${hidden > 0 ? `, ${hidden} above the picture` : ""}`;
      places.sort((one, other) => view.nearer * (one[1][view.depth] - other[1][view.depth]));
      places.forEach(([sphere, place]) => {
        const image = spriteOf(radius(sphere) * scale);
        const [x, y] = to(place[view.axes[0]], place[view.axes[1]]);
        context.drawImage(image, x - image.width / 2, y - image.height / 2);
      });
    };
    const figure = create("figure", {}, canvas, caption);
    report.dom.responsive(figure, size);
    return { figure, paint };
  }

  /** The player of the states of a run. */
  async function player(states, color) {
    const at = await report.packed.statesOf(states);
    const names = states.is_flat ? ["side"] : ["side", "above"];
    const views = names.map((name) => canvasOf(states, at, name, color));
    const last = states.times.length - 1;
    const slider = create("input", {
      type: "range",
      min: 0,
      max: last,
      step: 1,
      value: last,
      "aria-label": "Time",
    });
    const time = create("output", { class: "value" });
    const show = (frame) => {
      slider.value = String(frame);
      const words = `t = ${report.numbers.format(states.times[frame])} s`;
      slider.setAttribute("aria-valuetext", words);
      time.textContent = words;
      views.forEach((view) => view.paint(frame));
    };
    const { buttons, stop } = transport(() => Number(slider.value), last, show);
    slider.addEventListener("input", () => {
      stop();
      show(Number(slider.value));
    });
    show(last);
    return create(
      "div",
      { class: "player" },
      create(
        "div",
        { class: "views" },
        views.map((view) => view.figure),
      ),
      create("div", { class: "transport" }, buttons, slider, time),
    );
  }

  /** Buttons to play and step. Nothing plays by itself. */
  function transport(current, last, show) {
    let timer = null;
    const play = create("button", { type: "button", class: "button", name: "play" }, "Play");
    const stop = () => {
      clearInterval(timer);
      timer = null;
      play.textContent = "Play";
    };
    const step = (by) => {
      stop();
      show(Math.min(last, Math.max(0, current() + by)));
    };
    const advance = () => {
      if (!play.isConnected || current() >= last) {
        stop();
      } else {
        show(current() + 1);
      }
    };
    play.addEventListener("click", () => {
      if (timer !== null) {
        stop();
        return;
      }
      show(current() >= last ? 0 : current());
      play.textContent = "Pause";
      timer = setInterval(advance, Math.max(SHORTEST_PAUSE, SHORTEST_PLAY / last));
    });
    const button = (words, name, by) =>
      create(
        "button",
        { type: "button", class: "button", "aria-label": name, on: { click: () => step(by) } },
        words,
      );
    return {
      buttons: [button("‹", "One state back", -1), play, button("›", "One state on", 1)],
      stop,
    };
  }

  return { player };
})();

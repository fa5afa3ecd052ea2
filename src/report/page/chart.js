/** Charts: a frame with axes, and what is drawn in it. */
report.chart = (() => {
  const { draw } = report.dom;
  const { spans, plain } = report.markup;
  const { format } = report.numbers;

  const LETTER = 6.6;
  const TOP = 10;

  /** Room under the plot: for ticks, and for a label if there is one. */
  function roomBelow(axis) {
    return axis.label ? 46 : 26;
  }

  /** The frame of a chart; `x` and `y` are {kind, ends, label, ticks?: [[value, text]]}. */
  function frame({ width, height, x, y, name, least = 0 }) {
    const below = roomBelow(x);
    const yTicks = labels(y, height - TOP - below, 34);
    const letters = Math.min(24, Math.max(...yTicks.map(([, text]) => text.length), 1));
    const left = Math.max(least, Math.min(0.4 * width, letters * LETTER + (y.label ? 34 : 14)));
    const plot = { left, right: width - 14, top: TOP, bottom: height - below };
    const across = report.scales.scale(
      x.kind ?? "linear",
      x.ends,
      [plot.left, plot.right],
      x.values,
    );
    const up = report.scales.scale(y.kind ?? "linear", y.ends, [plot.bottom, plot.top], y.values);
    const svg = draw("svg", {
      class: "chart",
      viewBox: `0 0 ${width} ${height}`,
      width,
      height,
      role: "img",
      "aria-label": plain(name),
    });
    const body = draw("g");
    const xTicks = labels(x, plot.right - plot.left, 70);
    const area = {
      x: plot.left,
      y: plot.top,
      width: plot.right - plot.left,
      height: plot.bottom - plot.top,
    };
    svg.append(
      draw("rect", { class: "ground", ...area }),
      axisX(plot, across, xTicks, x.label),
      axisY(plot, up, yTicks, y.label),
      body,
    );
    svg.append(draw("rect", { class: "frame", ...area }));
    return { svg, body, x: across, y: up, plot };
  }

  /** Ticks with their texts. */
  function labels(axis, room, distance) {
    if (axis.ticks) {
      return axis.ticks;
    }
    const scale = {
      kind: axis.kind ?? "linear",
      low: axis.ends[0],
      high: axis.ends[1],
      from: 0,
      to: room,
    };
    return report.scales.ticks(scale, distance).map((value) => [value, format(value)]);
  }

  function axisX(plot, scale, ticks, label) {
    const marks = ticks.map(([value, text]) => {
      const at = scale.at(value);
      return [
        draw("line", { class: "grid", x1: at, x2: at, y1: plot.top, y2: plot.bottom }),
        draw("line", { class: "tick", x1: at, x2: at, y1: plot.bottom, y2: plot.bottom + 4 }),
        draw(
          "text",
          { class: "tick-label", x: at, y: plot.bottom + 17, "text-anchor": "middle" },
          text,
        ),
      ];
    });
    const middle = (plot.left + plot.right) / 2;
    const words = draw("text", {
      class: "axis-label",
      x: middle,
      y: plot.bottom + 37,
      "text-anchor": "middle",
    });
    words.append(...spans(label ?? "", plot.right - plot.left));
    return draw("g", {}, marks, words);
  }

  function axisY(plot, scale, ticks, label) {
    const marks = ticks.map(([value, text]) => {
      const at = scale.at(value);
      return [
        draw("line", { class: "grid", x1: plot.left, x2: plot.right, y1: at, y2: at }),
        draw("line", { class: "tick", x1: plot.left - 4, x2: plot.left, y1: at, y2: at }),
        draw(
          "text",
          { class: "tick-label", x: plot.left - 7, y: at + 4, "text-anchor": "end" },
          text,
        ),
      ];
    });
    const words = draw("text", {
      class: "axis-label",
      "text-anchor": "middle",
      transform: `translate(13 ${(plot.top + plot.bottom) / 2}) rotate(-90)`,
    });
    words.append(...spans(label ?? "", plot.bottom - plot.top));
    return draw("g", {}, marks, words);
  }

  /** Path through points [x, y] in values; a gap where one is not a number. */
  function path(points, x, y) {
    let pen = "M";
    const parts = [];
    for (const [across, up] of points) {
      if (Number.isFinite(across) && Number.isFinite(up)) {
        parts.push(`${pen}${x.at(across).toFixed(1)} ${y.at(up).toFixed(1)}`);
        pen = "L";
      } else {
        pen = "M";
      }
    }
    return parts.join("");
  }

  /** Path of dots, to be drawn with round caps. */
  function dots(places) {
    return places.map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`).join("");
  }

  /**
   * Tells about the nearest of some places {at: [x, y], tell, say} under the pointer, or chosen with
   * the arrow keys; `pick` is called for a click or Enter.
   */
  function attachPlaces({ svg, body }, places, pick) {
    const ring = draw("circle", { class: "ring", r: 7 });
    let chosen = -1;
    const show = (index, anchor) => {
      chosen = index;
      if (index < 0) {
        ring.remove();
        report.tooltip.hide();
        return;
      }
      const place = places[index];
      report.dom.assign(ring, { cx: place.at[0], cy: place.at[1] });
      body.append(ring);
      report.tooltip.show(place.tell(), anchor ?? onScreen(svg, place.at));
    };
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("pointermove", (event) => {
      show(nearest(places, local(svg, event)), [event.clientX, event.clientY]);
    });
    svg.addEventListener("pointerleave", () => show(-1));
    svg.addEventListener("blur", () => show(-1));
    svg.addEventListener("click", (event) => {
      const index = nearest(places, local(svg, event));
      if (index >= 0 && pick) {
        pick(places[index]);
      }
    });
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step && places.length > 0) {
        event.preventDefault();
        show((chosen + step + places.length) % places.length);
        report.tooltip.say(places[chosen].say);
      } else if (event.key === "Enter" && pick && chosen >= 0) {
        pick(places[chosen]);
      }
    });
  }

  /** The nearest place within reach, or -1. */
  function nearest(places, [x, y], reach = 24) {
    let [found, least] = [-1, reach * reach];
    places.forEach((place, index) => {
      const distance = (place.at[0] - x) ** 2 + (place.at[1] - y) ** 2;
      if (distance < least) {
        [found, least] = [index, distance];
      }
    });
    return found;
  }

  /** The place of an event in the units of a drawing. */
  function local(svg, event) {
    const box = svg.getBoundingClientRect();
    const view = svg.viewBox.baseVal;
    return [
      ((event.clientX - box.left) / box.width) * view.width,
      ((event.clientY - box.top) / box.height) * view.height,
    ];
  }

  /** The place on the screen of a place in a drawing. */
  function onScreen(svg, [x, y]) {
    const box = svg.getBoundingClientRect();
    const view = svg.viewBox.baseVal;
    return [box.left + (x / view.width) * box.width, box.top + (y / view.height) * box.height];
  }

  return { frame, path, dots, attachPlaces, nearest, local, onScreen };
})();

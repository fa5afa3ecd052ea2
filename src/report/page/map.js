/** The map: the cells of a slice, with what lies over them. */
report.map = (() => {
  const { create, draw } = report.dom;
  const { shown, label: axisLabel } = report.data;
  const { edges, ticks } = report.scales;

  /** Ticks of an axis in values, with texts as shown. */
  function ticksOf(axis, ends, room, distance) {
    const factor = axis.shown?.factor ?? 1;
    const steps = axis.values.length - 1;
    if (axis.spacing === "even" || (steps < 9 && isRoomy(axis, ends, room, distance))) {
      const every = Math.max(1, Math.ceil(((steps + 1) * distance) / room));
      const indices = axis.values.map((_, index) => index).filter((index) => index % every === 0);
      return indices.map((index) => [
        axis.values[index],
        shorten(shown(axis, index), room / (steps + 1)),
      ]);
    }
    const scale = {
      kind: axis.spacing,
      low: ends[0] * factor,
      high: ends[1] * factor,
      from: 0,
      to: room,
    };
    return ticks(scale, distance * 1.3).map((value) => [
      value / factor,
      report.numbers.format(value),
    ]);
  }

  function isRoomy(axis, ends, room, distance) {
    const scale = report.scales.scale(axis.spacing, ends, [0, room], axis.values);
    const places = axis.values.map(scale.at);
    const isShort = axis.values.every((_, index) => shown(axis, index).length <= 6);
    return (
      isShort && places.slice(1).every((place, index) => place - places[index] >= distance * 0.8)
    );
  }

  function shorten(text, room) {
    return report.markup.shortened(text, Math.max(8, Math.floor(room / 6.5)));
  }

  function chartAxis(axis, room, distance) {
    if (axis === undefined) {
      return { ends: [0, 1], ticks: [], label: "" };
    }
    const borders = edges(axis.spacing, axis.values);
    const ends = [borders[0], borders[borders.length - 1]];
    return {
      kind: axis.spacing,
      ends,
      values: axis.values,
      ticks: ticksOf(axis, ends, room, distance),
      label: axisLabel(axis),
    };
  }

  /** The places of the borders of cells in whole pixels, so that no seams show. */
  function borders(axis, scale) {
    return axis === undefined
      ? [Math.round(scale.from), Math.round(scale.to)]
      : edges(axis.spacing, axis.values).map(scale.at).map(Math.round);
  }

  function layout(model, state, width, share) {
    const [x, y] = [model.axes[state.x], model.axes[state.y]];
    const height = y === undefined ? 120 : Math.round(Math.min(Math.max(300, width * share), 620));
    const axes = [chartAxis(x, width - 80, 58), chartAxis(y, height - 56, 30)];
    const frame = report.chart.frame({ width, height, x: axes[0], y: axes[1], name: "" });
    return { ...frame, across: borders(x, frame.x), up: borders(y, frame.y), width, height };
  }

  function box(place, { column, row }) {
    const [x0, x1] = [place.across[column], place.across[column + 1]];
    const [y0, y1] = [place.up[row], place.up[row + 1]];
    return {
      x: Math.min(x0, x1),
      y: Math.min(y0, y1),
      width: Math.abs(x1 - x0),
      height: Math.abs(y1 - y0),
    };
  }

  function boxPath(place, cell) {
    const { x, y, width, height } = box(place, cell);
    return `M${x} ${y}h${width}v${height}h${-width}z`;
  }

  /** Paths of cells, one for each value of `key`; cells of key null are left out. */
  function grouped(place, cells, key) {
    const groups = new Map();
    for (const cell of cells) {
      const name = key(cell);
      if (name !== null && name !== undefined) {
        groups.set(name, (groups.get(name) ?? "") + boxPath(place, cell));
      }
    }
    return groups;
  }

  function fills(place, grid) {
    const groups = grouped(place, grid.cells, (cell) => cell.fill);
    return [...groups].map(([fill, d]) =>
      draw("path", { fill, d, "shape-rendering": "crispEdges" }),
    );
  }

  function patterns(model, place, grid, isOn) {
    const ofLabels = isOn
      ? grouped(place, grid.cells, (cell) =>
          cell.label === null || model.labels[cell.label].hatched
            ? null
            : report.patterns.labelUrl(model.labels, cell.label),
        )
      : new Map();
    const unsteady = grouped(place, grid.cells, (cell) =>
      cell.isUnsteady ? report.patterns.cellUrl("unsteady") : null,
    );
    return [...ofLabels, ...unsteady].map(([fill, d]) => draw("path", { fill, d }));
  }

  /** Lines between neighbours of different labels. */
  function labelBorders(place, grid) {
    const at = (column, row) => grid.cells[row * grid.columns + column].group;
    const parts = [];
    for (let row = 0; row < grid.rows; row += 1) {
      for (let column = 0; column < grid.columns; column += 1) {
        const own = at(column, row);
        const [right, top] = [place.across[column + 1], place.up[row + 1]];
        if (column + 1 < grid.columns && at(column + 1, row) !== own) {
          parts.push(`M${right} ${place.up[row]}V${top}`);
        }
        if (row + 1 < grid.rows && at(column, row + 1) !== own) {
          parts.push(`M${place.across[column]} ${top}H${right}`);
        }
      }
    }
    return draw("path", { class: "cell-border", d: parts.join("") });
  }

  /** Whether a curve belongs to this slice, and whether its axes are swapped in it. */
  function fit(curve, state) {
    const isSwapped = curve.x === state.y && curve.y === state.x;
    const isHere = isSwapped || (curve.x === state.x && curve.y === state.y);
    const slice = Object.entries(curve.slice ?? {});
    return {
      isHere: isHere && slice.every(([axis, index]) => state.slice[axis] === index),
      isSwapped,
    };
  }

  /** Curves of some kinds, as paths of a class for each. */
  function curves(model, state, place, classes) {
    return (model.section.curves ?? []).flatMap((curve) => {
      const { isHere, isSwapped } = fit(curve, state);
      if (!(curve.kind in classes) || !isHere) {
        return [];
      }
      const end = curve.kind === "band" ? "Z" : "";
      const d = curve.pieces
        .map((piece) => {
          const points = pairs(piece).map(([x, y]) => (isSwapped ? [y, x] : [x, y]));
          return report.chart.path(points, place.x, place.y) + end;
        })
        .join("");
      return classes[curve.kind].map((name) =>
        draw("path", { class: name, d, "data-level": curve.level ?? null }),
      );
    });
  }

  function pairs(flat) {
    return Array.from({ length: flat.length / 2 }, (_, index) => [
      flat[2 * index],
      flat[2 * index + 1],
    ]);
  }

  /** Marks in the middle of cells: dots of runs, discs where seeds disagree. */
  function marks(place, grid) {
    const discs = grid.cells.filter((cell) => cell.agreement < 1);
    const dots = grid.cells.filter((cell) => cell.dot);
    return [...discs.map((cell) => disc(place, cell)), ...dots.map((cell) => dot(place, cell))];
  }

  function middle(place, cell) {
    const { x, y, width, height } = box(place, cell);
    return { cx: x + width / 2, cy: y + height / 2, side: Math.min(18, width, height) };
  }

  function disc(place, cell) {
    const { cx, cy, side } = middle(place, cell);
    return draw("circle", {
      class: "disagreement",
      cx,
      cy,
      r: 0.5 * side * (0.2 + 0.8 * (1 - cell.agreement)),
    });
  }

  function dot(place, cell) {
    const { cx, cy } = middle(place, cell);
    const isOther = cell.dot !== "#000000";
    return draw("circle", {
      class: isOther ? "run other" : "run",
      cx,
      cy,
      r: isOther ? 4 : 2.2,
      fill: cell.dot,
    });
  }

  /** Cells that are not selected, or not changed, under a veil. */
  function veil(place, cells) {
    return draw("path", { class: "veil", d: cells.map((cell) => boxPath(place, cell)).join("") });
  }

  /** Keeps curves inside the frame. */
  function clipped(place, ...children) {
    const id = report.dom.uniqueId("clip");
    const { left, top, right, bottom } = place.plot;
    return [
      draw(
        "clipPath",
        { id },
        draw("rect", { x: left, y: top, width: right - left, height: bottom - top }),
      ),
      draw("g", { "clip-path": `url(#${id})` }, ...children),
    ];
  }

  /** Outlines of the cells that are under the cursor and pinned. */
  function outline(place, cell, name) {
    return cell ? draw("rect", { class: name, ...box(place, cell) }) : null;
  }

  /**
   * A map that follows a store. `look(state)` gives the grid of cells, `changed` the places with
   * another label than stored.
   */
  function follow({ model, store, name, look, share = 0.82, changed = () => null }) {
    const element = create("div", {
      class: "map",
      tabindex: 0,
      role: "application",
      "aria-roledescription": "map",
      "aria-label": name,
    });
    const map = { element, model, store, id: report.dom.uniqueId("map"), place: null, grid: null };
    const overlay = draw("g");
    let known = 0;

    const render = (width = known) => {
      known = width;
      if (width === 0) {
        return;
      }
      const { state } = store;
      map.grid = look(state);
      map.place = layout(model, state, width, share);
      map.place.body.append(...layers(map, changed()), overlay);
      map.place.svg.setAttribute("aria-hidden", "true");
      element.replaceChildren(map.place.svg);
      point();
    };
    const point = () => {
      const { cursor, pin, brush } = store.state;
      const find = (place) => map.grid.cells.find((cell) => cell.place === place);
      overlay.replaceChildren(
        ...[
          outline(map.place, pin === null ? null : find(pin), "pin"),
          outline(map.place, cursor === null ? null : find(cursor), "cursor"),
          brush?.map === map.id ? draw("rect", { class: "brush", ...brush.box }) : null,
        ].filter(Boolean),
      );
    };
    store.listen(["x", "y", "slice", "layers", "selection", "map"], () => render());
    store.listen(["cursor", "pin", "brush"], () => {
      if (map.place) {
        point();
      }
    });
    report.dom.responsive(element, render);
    return Object.assign(map, { render });
  }

  function layers(map, changed) {
    const { model, grid, place } = map;
    const { layers: on, selection } = map.store.state;
    const isLabels = grid.measure === null;
    const chosen = report.looks.selected(model, selection);
    const unselected =
      chosen === null
        ? []
        : grid.cells.filter((cell) => cell.runs === null || !cell.runs.some((run) => chosen[run]));
    return [
      ...fills(place, grid),
      ...patterns(model, place, grid, on.patterns && isLabels),
      ...(unselected.length > 0 ? [veil(place, unselected)] : []),
      ...(on.borders && !grid.hasCurves ? [labelBorders(place, grid)] : []),
      ...clipped(
        place,
        on.bands ? curves(model, map.store.state, place, { band: ["band"] }) : [],
        on.borders
          ? curves(model, map.store.state, place, { border: ["border-halo", "border"] })
          : [],
        on.theory
          ? curves(model, map.store.state, place, {
              advice: ["theory-halo", "advice"],
              theory: ["theory-halo", "theory"],
            })
          : [],
      ),
      ...(on.marks && isLabels ? marks(place, grid) : []),
      ...(changed ? [changes(place, grid, changed)] : []),
    ];
  }

  function changes(place, grid, changed) {
    const cells = grid.cells.filter((cell) => changed.has(cell.place));
    return draw("path", {
      class: "changed",
      d: cells.map((cell) => boxPath(place, cell)).join(""),
    });
  }

  /** The cell under a place of the drawing; null outside. */
  function cellAt(map, [x, y]) {
    const column = between(map.place.across, x);
    const row = between(map.place.up, y);
    return column < 0 || row < 0 ? null : map.grid.cells[row * map.grid.columns + column];
  }

  function between(borders, at) {
    return borders.findIndex((border, index) => {
      const next = borders[index + 1];
      return next !== undefined && Math.min(border, next) <= at && at < Math.max(border, next);
    });
  }

  return { follow, cellAt, box };
})();

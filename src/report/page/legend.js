/** What colours and lines mean; labels select their runs, lines can be switched off. */
report.legend = (() => {
  const { create, draw } = report.dom;
  const { labelName } = report.data;
  const { format, counted } = report.numbers;

  const LAYERS = [
    ["borders", "borders of labels", (model) => model.section.axes.length > 0],
    ["bands", "bands of the borders", (model) => hasCurve(model, "band")],
    ["theory", null, (model) => hasCurve(model, "theory") || hasCurve(model, "advice")],
    [
      "marks",
      "marks of runs",
      (model) => Boolean(model.section.lattice) || model.points.size < model.count,
    ],
    ["patterns", "patterns beside colours", () => true],
  ];

  function hasCurve(model, kind) {
    return (model.section.curves ?? []).some((curve) => curve.kind === kind);
  }

  /** The small picture of a label. */
  function swatch(model, label, isPatterned = false) {
    const { color, hatched } = model.labels[label];
    const fill = hatched ? report.patterns.cellUrl("hatched") : report.colors.safe(color);
    const pattern = isPatterned && !hatched ? report.patterns.labelUrl(model.labels, label) : null;
    return picture([
      draw("rect", { width: 22, height: 14, fill }),
      pattern ? draw("rect", { width: 22, height: 14, fill: pattern }) : null,
    ]);
  }

  function picture(children) {
    return draw(
      "svg",
      { class: "swatch", width: 22, height: 14, viewBox: "0 0 22 14", "aria-hidden": "true" },
      children,
    );
  }

  function cellSwatch(name) {
    return picture([draw("rect", { width: 22, height: 14, fill: report.patterns.cellUrl(name) })]);
  }

  /** A label with its picture, in a line of text. */
  function chip(model, label) {
    return create("span", { class: "chip" }, swatch(model, label), labelName(model.labels[label]));
  }

  /** Pictures of lines for the switches. */
  const LINES = {
    borders: () => picture([draw("path", { class: "cell-border", d: "M0 10H9V4H22" })]),
    bands: () => picture([draw("path", { class: "band", d: "M0 12L22 7V1L0 5Z" })]),
    theory: () =>
      picture([
        draw("path", { class: "theory-halo", d: "M0 11L22 3" }),
        draw("path", { class: "theory", d: "M0 11L22 3" }),
      ]),
    marks: () => picture([draw("circle", { class: "disagreement", cx: 11, cy: 7, r: 4 })]),
    patterns: () =>
      picture([
        draw("rect", { width: 22, height: 14, fill: "none" }),
        draw("path", { class: "cell-border", d: "M0 14L14 0M8 14L22 0M-8 14L6 0" }),
      ]),
  };

  function labelButton(model, store, label, count) {
    const { selection, layers } = store.state;
    const isOn = selection?.labels?.includes(label) ?? false;
    const toggle = () => {
      const chosen = store.state.selection?.labels ?? [];
      const labels = isOn ? chosen.filter((it) => it !== label) : [...chosen, label];
      store.set({ selection: labels.length > 0 ? { labels } : null });
    };
    return create(
      "button",
      {
        type: "button",
        class: "legend-entry",
        "aria-pressed": String(isOn),
        "data-label": label,
        title: isOn ? "Show all runs again" : "Select the runs of this label",
        on: { click: toggle },
      },
      swatch(model, label, layers.patterns),
      create("span", { class: "name" }, labelName(model.labels[label])),
      create("span", { class: "count" }, String(count)),
    );
  }

  /** The labels that runs have, with their numbers. */
  function labels(model, store) {
    const counts = new Map();
    model.stored.forEach((label) => counts.set(label, (counts.get(label) ?? 0) + 1));
    const present = model.labels.map((_, label) => label).filter((label) => counts.has(label));
    return create(
      "div",
      { class: "legend-labels", role: "group", "aria-label": "Labels and their runs" },
      present.map((label) => labelButton(model, store, label, counts.get(label))),
    );
  }

  /** What cells without a plain label look like, if the slice has any. */
  function states(model, grid) {
    const some = (test) => grid.cells.some(test);
    const entries = [
      [some((cell) => cell.isDivided), "divided", "no majority of seeds"],
      [some((cell) => cell.isUnsteady), "unsteady", "a run was not steady"],
      [
        some((cell) => isEmpty(cell) && !model.failed.has(cell.place)),
        "missing",
        grid.measure ? "no value" : "not run",
      ],
      [some((cell) => isEmpty(cell) && model.failed.has(cell.place)), "failed", "failed"],
    ];
    return entries
      .filter(([isThere]) => isThere)
      .map(([, name, words]) => create("span", { class: "legend-note" }, cellSwatch(name), words));
  }

  function isEmpty(cell) {
    return cell.fill.startsWith("url") && !cell.isDivided && cell.label === null;
  }

  function bandNotes(grid) {
    const isIn = (low, high) =>
      grid.cells.some((cell) => cell.certainty >= low && cell.certainty < high);
    const words = [
      [isIn(0, 0.84), "palest: in the 68 % band of a border"],
      [isIn(0.84, 0.975), "paler: in its 95 % band"],
    ];
    return words
      .filter(([isThere]) => isThere)
      .map(([, text]) => create("span", { class: "legend-note" }, text));
  }

  /** The bar of a measure's colours. */
  function bar({ ramp, measure }) {
    if (ramp === null) {
      return create("p", { class: "muted" }, "No point has a value.");
    }
    const steps = Array.from({ length: 64 }, (_, index) => {
      const value = ramp.low + ((index + 0.5) / 64) * (ramp.high - ramp.low);
      return draw("rect", {
        x: index * 4,
        width: 4.2,
        height: 14,
        fill: ramp.color(value),
        "shape-rendering": "crispEdges",
      });
    });
    const ticks = [ramp.low, 0.5 * (ramp.low + ramp.high), ramp.high].map((value) =>
      create("span", {}, format(value, 3)),
    );
    return create(
      "div",
      { class: "color-bar" },
      draw(
        "svg",
        { viewBox: "0 0 256 14", preserveAspectRatio: "none", "aria-hidden": "true" },
        steps,
      ),
      create("div", { class: "color-bar-ticks" }, ticks),
      create(
        "p",
        { class: "color-bar-label" },
        report.markup.nodes(report.markup.labelled(measure.quantity, measure.unit)),
      ),
    );
  }

  function theoryName(model) {
    const names = (model.section.curves ?? []).filter((curve) =>
      ["theory", "advice"].includes(curve.kind),
    );
    return [...new Set(names.map((curve) => curve.name))].join(", ") || "theory";
  }

  function switches(model, store) {
    return create(
      "div",
      { class: "switches", role: "group", "aria-label": "Layers of the map" },
      LAYERS.filter(([, , isThere]) => isThere(model)).map(([name, words]) => {
        const box = create("input", { type: "checkbox", name: `layer-${name}` });
        box.checked = store.state.layers[name];
        box.addEventListener("change", () => {
          store.set({ layers: { ...store.state.layers, [name]: box.checked } });
        });
        return create(
          "label",
          { class: "switch" },
          box,
          LINES[name](),
          create("span", {}, report.markup.nodes(words ?? theoryName(model))),
        );
      }),
    );
  }

  /** The legend of a map, which follows the store. */
  function follow(model, store, map) {
    const element = create("div", { class: "legend" });
    const render = () => {
      const focused =
        document.activeElement?.getAttribute("data-label") ?? document.activeElement?.name;
      const grid = report.looks.of(model, store.state, model.stored);
      const notes = [...states(model, grid), ...bandNotes(grid)];
      element.replaceChildren(
        grid.measure ? bar(grid) : labels(model, store),
        notes.length > 0 ? create("div", { class: "legend-notes" }, notes) : "",
        switches(model, store),
        selectionNote(model, store),
      );
      if (focused) {
        element
          .querySelector(`[data-label="${CSS.escape(focused)}"], [name="${CSS.escape(focused)}"]`)
          ?.focus();
      }
    };
    store.listen(["x", "y", "slice", "map", "layers", "selection"], render);
    render();
    return element;
  }

  function selectionNote(model, store) {
    const chosen = report.looks.selected(model, store.state.selection);
    if (chosen === null) {
      return "";
    }
    const count = chosen.filter(Boolean).length;
    const clear = create(
      "button",
      { type: "button", class: "button", on: { click: () => store.set({ selection: null }) } },
      "Clear",
    );
    return create(
      "p",
      { class: "selection-note" },
      `${counted(count, "run")} of ${model.count} selected `,
      clear,
    );
  }

  return { follow, chip, swatch };
})();

/** Two measures of all runs against each other, which select runs and show the selected ones. */
report.measures = (() => {
  const { create, draw, select } = report.dom;
  const { nodes, plain, labelled } = report.markup;
  const { format } = report.numbers;

  function described(model, name) {
    const axis = model.axes.find((it) => name === `axis:${it.name}`);
    return axis
      ? { quantity: axis.quantity ?? axis.name, unit: axis.unit }
      : model.measures.get(name);
  }

  function choice(model, store, index, words) {
    const options = model.scatterNames.map((name) => [
      name,
      report.data.measureWords(described(model, name)),
    ]);
    const element = select({ name: `measure-${index}` }, options, store.state.scatter[index]);
    element.addEventListener("change", () => {
      store.set({
        scatter: store.state.scatter.map((old, at) => (at === index ? element.value : old)),
      });
    });
    store.listen(["scatter"], () => {
      element.value = store.state.scatter[index];
    });
    return report.controls.field(words, element);
  }

  /** Logarithmic if all values are positive and span three decades. */
  function kindOf(values) {
    const finite = values.filter(Number.isFinite);
    const [low, high] = [Math.min(...finite), Math.max(...finite)];
    return low > 0 && high / low > 1e3 ? "logarithmic" : "linear";
  }

  function chartAxis(model, name, values) {
    const { quantity, unit } = described(model, name);
    const kind = kindOf(values);
    return { kind, ends: report.scales.ends(values, kind), label: labelled(quantity, unit) };
  }

  /** Places of the runs that have both values: {run, at}. */
  function placed(model, state, frame) {
    const [across, up] = state.scatter.map((name) => report.looks.valuesOf(model, name));
    return across
      .map((value, run) => ({
        run,
        at: [frame.x.at(value), frame.y.at(up[run])],
        has: Number.isFinite(value) && Number.isFinite(up[run]),
      }))
      .filter((place) => place.has && place.at.every(Number.isFinite));
  }

  function dots(model, places, chosen) {
    const groups = new Map();
    for (const place of places) {
      const key = `${chosen === null || chosen[place.run] ? 1 : 0},${model.stored[place.run]}`;
      groups.set(key, [...(groups.get(key) ?? []), place.at]);
    }
    const sorted = [...groups].sort(([one], [other]) => one.localeCompare(other));
    return sorted.flatMap(([key, ats]) => {
      const [isChosen, label] = key.split(",").map(Number);
      const d = report.chart.dots(ats);
      const color = model.labels[label].hatched
        ? "#000000"
        : report.colors.safe(model.labels[label].color);
      return [
        draw("path", { class: isChosen ? "dot-rim" : "dot-rim unselected", d }),
        draw("path", { class: isChosen ? "dot" : "dot unselected", d, stroke: color }),
      ];
    });
  }

  function tell(model, run, names) {
    const rows = names.map((name) => {
      const { quantity, unit } = described(model, name);
      return [
        nodes(quantity),
        report.numbers.withUnit(report.looks.valuesOf(model, name)[run], unit),
      ];
    });
    return [
      create(
        "p",
        { class: "tooltip-place" },
        nodes(report.data.placeWords(model, model.placeOfRun.get(run))),
      ),
      create(
        "p",
        { class: "tooltip-label" },
        report.legend.chip(model, model.stored[run]),
        model.runs.seed ? ` seed ${model.runs.seed[run]}` : "",
      ),
      report.tooltip.rows(rows),
    ];
  }

  function say(model, run, names) {
    const values = names.map(
      (name) =>
        `${plain(described(model, name).quantity)} ${format(report.looks.valuesOf(model, name)[run])}`,
    );
    return `${plain(report.data.placeWords(model, model.placeOfRun.get(run)))}: ${report.data.labelName(model.labels[model.stored[run]])}, ${values.join(", ")}`;
  }

  /** A rectangle that is dragged selects the runs in it. */
  function attachBrush(frame, store) {
    let from = null;
    const shade = draw("rect", { class: "brush" });
    const { svg, plot } = frame;
    const at = (event) => {
      const [x, y] = report.chart.local(svg, event);
      return [
        Math.min(plot.right, Math.max(plot.left, x)),
        Math.min(plot.bottom, Math.max(plot.top, y)),
      ];
    };
    svg.addEventListener("pointerdown", (event) => {
      from = event.button === 0 ? at(event) : null;
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => {
      if (from !== null) {
        const to = at(event);
        report.dom.assign(shade, {
          x: Math.min(from[0], to[0]),
          y: Math.min(from[1], to[1]),
          width: Math.abs(to[0] - from[0]),
          height: Math.abs(to[1] - from[1]),
        });
        frame.body.append(shade);
      }
    });
    svg.addEventListener("pointerup", (event) => {
      const to = at(event);
      const isDrag = from !== null && Math.hypot(to[0] - from[0], to[1] - from[1]) > 6;
      shade.remove();
      if (isDrag) {
        svg.dataset.dragged = "true";
        const range = (scale, one, other) =>
          [scale.value(one), scale.value(other)].sort((low, high) => low - high);
        const [x, y] = store.state.scatter;
        const ranges =
          x === y
            ? { [x]: range(frame.x, from[0], to[0]) }
            : { [x]: range(frame.x, from[0], to[0]), [y]: range(frame.y, from[1], to[1]) };
        store.set({ selection: { measures: ranges } });
      } else {
        svg.dataset.dragged = "false";
      }
      from = null;
    });
  }

  function follow(model, store) {
    if (model.measures.size === 0) {
      return create("div", {}, create("p", { class: "muted" }, "The runs have no measures."));
    }
    const host = create("div", { class: "scatter" });
    const note = create("p", { class: "muted" });
    let known = 0;
    const render = (width = known) => {
      known = width;
      if (width === 0) {
        return;
      }
      const { state } = store;
      const columns = state.scatter.map((name) => report.looks.valuesOf(model, name));
      const [x, y] = state.scatter.map((name, index) => chartAxis(model, name, columns[index]));
      const frame = report.chart.frame({
        width,
        height: Math.min(480, Math.max(280, width * 0.7)),
        x,
        y,
        name: `${y.label} against ${x.label}`,
      });
      const places = placed(model, state, frame).map((place) => ({
        ...place,
        tell: () => tell(model, place.run, state.scatter),
        say: say(model, place.run, state.scatter),
      }));
      frame.body.append(...dots(model, places, report.looks.selected(model, state.selection)));
      const missing = model.count - places.length;
      note.textContent = `Drag to select runs; the map shows where they are, and a selection on the map shows here. ${missing > 0 ? `${missing} of ${model.count} runs lack one of the two values.` : ""}`;
      report.chart.attachPlaces(
        frame,
        [...places].sort((one, other) => one.at[0] - other.at[0]),
        (place) => {
          if (frame.svg.dataset.dragged !== "true") {
            model.pinRun(place.run);
          }
        },
      );
      attachBrush(frame, store);
      host.replaceChildren(frame.svg);
    };
    store.listen(["scatter", "selection"], () => render());
    report.dom.responsive(host, render);
    return create(
      "div",
      {},
      create(
        "div",
        { class: "controls" },
        choice(model, store, 0, "Across"),
        choice(model, store, 1, "Up"),
      ),
      host,
      note,
    );
  }

  return { follow };
})();

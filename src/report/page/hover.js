/** The pointer over maps: what a cell holds, a click that pins it, a drag that selects. */
report.hover = (() => {
  const { create } = report.dom;
  const { placeWords, labelName, majority, mean } = report.data;
  const { nodes, plain, labelled } = report.markup;
  const { format, counted } = report.numbers;
  const MOST_ROWS = 10;

  /** The votes of the seeds: "pinned 2, fluid 1". */
  function votes(model, runs, labels) {
    const counts = new Map();
    runs.forEach((run) => counts.set(labels[run], (counts.get(labels[run]) ?? 0) + 1));
    return [...counts].sort((one, other) => other[1] - one[1]);
  }

  /** The evidence of a point: the mean over its runs, and the range if they differ. */
  function evidence(measures, runs) {
    const rows = measures
      .map((measure) => [measure, mean(measure, runs)])
      .filter(([, value]) => Number.isFinite(value));
    return rows.slice(0, MOST_ROWS).map(([measure, value]) => {
      const values = runs.map((run) => measure.values[run]).filter(Number.isFinite);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const range =
        high > low
          ? create("span", { class: "muted" }, ` ${format(low, 3)} to ${format(high, 3)}`)
          : "";
      const isMargin = measure.range === "signed";
      const sign = isMargin ? (value >= 0 ? "holds" : "fails") : "";
      return [
        nodes(measure.quantity),
        [create("span", { class: sign }, report.numbers.withUnit(value, measure.unit, 3)), range],
      ];
    });
  }

  /** Evidence as stored, and what thresholds, where they are moved, read in its place. */
  function evidenceRows(model, runs, isMoved, thresholds) {
    const found = isMoved ? report.rules.replaced(model.rules, model.measures, thresholds) : [];
    const replaced = found.map((it) => ({
      quantity: it.name,
      ...model.measures.get(it.name),
      ...it,
    }));
    const kept = [...model.measures.values()].filter(
      (measure) => measure.is_evidence && !found.some((it) => it.name === measure.name),
    );
    return [
      report.tooltip.rows(evidence(replaced, runs)),
      isMoved ? create("p", { class: "muted" }, "as stored:") : "",
      report.tooltip.rows(evidence(kept, runs)),
    ];
  }

  function heading(model, cell, labels) {
    if (cell.runs === null) {
      const failed = model.failed.get(cell.place);
      const words = failed ? `failed: ${failed[0].message}` : "not run";
      const likely =
        cell.label === null
          ? []
          : [
              report.legend.chip(model, cell.label),
              ` ${report.numbers.percent(cell.certainty ?? 1)} likely, `,
            ];
      return [...likely, words];
    }
    const found = votes(model, cell.runs, labels);
    return found.map(([label, count]) =>
      create(
        "span",
        { class: "vote" },
        report.legend.chip(model, label),
        cell.runs.length > 1 ? ` ${count} of ${counted(cell.runs.length, "seed")}` : "",
      ),
    );
  }

  /** What a cell of a map tells. */
  function tell(map, cell, labels) {
    const { model, store } = map;
    const { thresholds } = store.state;
    const isMoved =
      labels !== model.stored && report.rules.moved(model.rules, thresholds).length > 0;
    const runs = cell.runs;
    const seeds =
      runs === null
        ? null
        : runs.map((run) => model.runs.seed?.[run]).filter((seed) => seed !== undefined);
    const { measure } = map.grid;
    return [
      create("p", { class: "tooltip-place" }, nodes(placeWords(model, cell.place))),
      create("p", { class: "tooltip-label" }, heading(model, cell, labels)),
      isMoved && runs !== null ? wasNode(model, runs, labels) : "",
      measure && runs !== null
        ? report.tooltip.rows([
            [nodes(measure.quantity), report.numbers.withUnit(cell.value, measure.unit)],
          ])
        : "",
      ...(runs === null ? [] : evidenceRows(model, runs, isMoved, thresholds)),
      seeds && seeds.length > 0
        ? create(
            "p",
            { class: "muted" },
            `${seeds.length === 1 ? "seed" : "seeds"} ${seeds.join(", ")}`,
          )
        : "",
      cell.isUnsteady
        ? create("p", { class: "warning" }, "A run was not steady when its time was up.")
        : "",
    ];
  }

  function wasNode(model, runs, labels) {
    const [was, is] = [majority(runs, model.stored).label, majority(runs, labels).label];
    return was === is
      ? ""
      : create("p", { class: "tooltip-label" }, "stored: ", report.legend.chip(model, was));
  }

  /** The same in words. */
  function say(model, cell, labels, grid) {
    const where = plain(placeWords(model, cell.place));
    if (cell.runs === null) {
      return `${where}: ${model.failed.has(cell.place) ? "failed" : "not run"}`;
    }
    const found = votes(model, cell.runs, labels).map(([label, count]) =>
      cell.runs.length > 1
        ? `${labelName(model.labels[label])}, ${count} of ${cell.runs.length} seeds`
        : labelName(model.labels[label]),
    );
    const value = grid.measure
      ? `, ${plain(labelled(grid.measure.quantity, grid.measure.unit))} ${format(cell.value)}`
      : "";
    return `${where}: ${found.join("; ")}${value}${cell.isUnsteady ? ", not steady" : ""}`;
  }

  /** Makes a map follow the pointer. `labels()` are those it shows. */
  function attach(map, labels) {
    const { element, model, store } = map;
    let start = null;
    const at = (event) => report.chart.local(map.place.svg, event);
    const over = (event) => {
      const cell = report.map.cellAt(map, at(event));
      store.set({ cursor: cell?.place ?? null });
      if (cell === null || start?.isDrag) {
        report.tooltip.hide();
      } else if (event.pointerType !== "touch") {
        report.tooltip.show(tell(map, cell, labels()), [event.clientX, event.clientY]);
      }
    };
    const drag = (event) => {
      const [x, y] = at(event);
      start.isDrag = start.isDrag || Math.hypot(x - start.at[0], y - start.at[1]) > 6;
      if (start.isDrag) {
        store.set({ brush: { map: map.id, box: boxOf(start.at, [x, y]) } });
      }
    };
    element.addEventListener("pointermove", (event) => {
      if (map.place === null) {
        return;
      }
      if (start !== null) {
        drag(event);
      }
      over(event);
    });
    element.addEventListener("pointerdown", (event) => {
      if (event.button === 0 && map.place !== null && event.pointerType !== "touch") {
        start = { at: at(event), isDrag: false };
        element.setPointerCapture(event.pointerId);
      }
    });
    element.addEventListener("pointerup", (event) => {
      const isDrag = start?.isDrag ?? false;
      const from = start?.at;
      start = null;
      if (isDrag) {
        store.set({ brush: null, selection: between(map, from, at(event)) });
      }
      element.dataset.dragged = String(isDrag);
    });
    element.addEventListener("click", (event) => {
      const cell = element.dataset.dragged === "true" ? null : report.map.cellAt(map, at(event));
      if (cell !== null) {
        model.pin(cell.place);
      }
    });
    element.addEventListener("pointerleave", () => {
      store.set({ cursor: null });
      report.tooltip.hide();
    });
  }

  function boxOf([x0, y0], [x1, y1]) {
    return {
      x: Math.min(x0, x1),
      y: Math.min(y0, y1),
      width: Math.abs(x1 - x0),
      height: Math.abs(y1 - y0),
    };
  }

  /** The cells whose middles lie between two places, as ranges of two axes. */
  function between(map, one, other) {
    const { x, y, width, height } = boxOf(one, other);
    const inside = map.grid.cells.filter((cell) => {
      const box = report.map.box(map.place, cell);
      const middle = [box.x + box.width / 2, box.y + box.height / 2];
      return middle[0] >= x && middle[0] <= x + width && middle[1] >= y && middle[1] <= y + height;
    });
    return cellsSelection(map.store.state, inside);
  }

  /** A selection of the smallest rectangle that holds some cells; null for none. */
  function cellsSelection(state, cells) {
    if (cells.length === 0) {
      return null;
    }
    const range = (name) => {
      const values = cells.map((cell) => cell[name]);
      return [Math.min(...values), Math.max(...values)];
    };
    const ranges = { [state.x]: range("column") };
    if (state.y >= 0) {
      ranges[state.y] = range("row");
    }
    return { cells: ranges };
  }

  return { attach, tell, say, cellsSelection };
})();

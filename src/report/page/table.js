/** Tables: the map with its rows and columns, and the runs. */
report.table = (() => {
  const { create } = report.dom;
  const { shown, labelName, placeWords, majority } = report.data;
  const { nodes, plain, labelled } = report.markup;
  const { format, counted } = report.numbers;
  const PAGE = 100;

  function cellText(model, cell, grid) {
    if (grid.measure) {
      return format(cell.value);
    }
    if (cell.runs === null) {
      return model.failed.has(cell.place)
        ? "failed"
        : cell.label === null || cell.label === undefined
          ? "not run"
          : `${labelName(model.labels[cell.label])} (not run)`;
    }
    const { label, agreement } = majority(cell.runs, model.stored);
    const share =
      cell.runs.length > 1
        ? ` ${Math.round(agreement * cell.runs.length)}/${cell.runs.length}`
        : "";
    return `${labelName(model.labels[label])}${share}${cell.isUnsteady ? ", not steady" : ""}`;
  }

  /** The map as a table, its rows from above. */
  function ofMap(model, state) {
    const grid = report.looks.of(model, state, model.stored);
    const [x, y] = [model.axes[state.x], model.axes[state.y]];
    const rows = Array.from({ length: grid.rows }, (_, row) => grid.rows - 1 - row);
    const heads = x.values.map((_, column) => create("th", { scope: "col" }, shown(x, column)));
    const caption = `${grid.measure ? plain(labelled(grid.measure.quantity, grid.measure.unit)) : "Labels"}: columns ${plain(report.data.label(x))}${y ? `, rows ${plain(report.data.label(y))}` : ""}`;
    return create(
      "table",
      { class: "map-table" },
      create("caption", {}, caption),
      create("thead", {}, create("tr", {}, create("td", {}), heads)),
      create(
        "tbody",
        {},
        rows.map((row) =>
          create(
            "tr",
            {},
            create("th", { scope: "row" }, y ? shown(y, row) : ""),
            grid.cells
              .slice(row * grid.columns, (row + 1) * grid.columns)
              .map((cell) => create("td", {}, cellText(model, cell, grid))),
          ),
        ),
      ),
    );
  }

  function runRow(model, run, pin) {
    const measures = [...model.measures.values()];
    return create(
      "tr",
      {},
      create(
        "th",
        { scope: "row" },
        create(
          "button",
          { type: "button", class: "button link", on: { click: () => pin(run) } },
          nodes(placeWords(model, model.placeOfRun.get(run))),
        ),
      ),
      create("td", {}, String(model.runs.seed?.[run] ?? "")),
      create("td", {}, report.legend.chip(model, model.stored[run])),
      measures.map((measure) => create("td", {}, format(measure.values[run]))),
    );
  }

  /** The selected runs, or all, some at a time. */
  function ofRuns(model, state, pin) {
    const chosen = report.looks.selected(model, state.selection);
    const runs = Array.from({ length: model.count }, (_, run) => run).filter(
      (run) => chosen === null || chosen[run],
    );
    const body = create("tbody", {});
    const more = create("button", { type: "button", class: "button" });
    let count = 0;
    const extend = () => {
      body.append(...runs.slice(count, count + PAGE).map((run) => runRow(model, run, pin)));
      count = Math.min(runs.length, count + PAGE);
      more.textContent = `Show more (${count} of ${runs.length})`;
      more.hidden = count >= runs.length;
    };
    more.addEventListener("click", extend);
    extend();
    const heads = ["point", "seed", "label"].map((text) => create("th", { scope: "col" }, text));
    const measures = [...model.measures.values()].map((measure) =>
      create(
        "th",
        { scope: "col", title: measure.description ?? null },
        report.data.measureNodes(measure),
      ),
    );
    return [
      create(
        "div",
        { class: "scroll tall" },
        create(
          "table",
          { class: "numbers" },
          create(
            "caption",
            {},
            chosen === null
              ? `All ${counted(model.count, "run")}`
              : `${counted(runs.length, "selected run")}`,
          ),
          create("thead", {}, create("tr", {}, heads, measures)),
          body,
        ),
      ),
      more,
    ];
  }

  /** The panel, made when it is looked at. */
  function follow(model, store) {
    const element = create("div", { class: "tables" });
    const render = () => {
      if (store.state.tab !== "table") {
        return;
      }
      element.replaceChildren(
        create(
          "div",
          { class: "scroll tall", tabindex: 0, role: "region", "aria-label": "Map as a table" },
          ofMap(model, store.state),
        ),
        ...ofRuns(model, store.state, (run) => model.pinRun(run)),
      );
    };
    store.listen(["tab", "x", "y", "slice", "map", "selection"], render);
    render();
    return element;
  }

  return { follow };
})();

/** What to look at while no point is pinned: runs close to a threshold, runs with an animation. */
report.overview = (() => {
  const { create } = report.dom;
  const { placeWords } = report.data;
  const { nodes, plain } = report.markup;
  const { format } = report.numbers;

  /** Runs whose margin of a rule is the smallest: some for which it holds, some for which it fails. */
  function nearest(model, { values }) {
    const sorted = (runs) =>
      runs.sort((one, other) => Math.abs(values[one]) - Math.abs(values[other])).slice(0, 2);
    const known = values.map((_, run) => run).filter((run) => Number.isFinite(values[run]));
    return [
      ...sorted(known.filter((run) => values[run] >= 0)),
      ...sorted(known.filter((run) => values[run] < 0)),
    ];
  }

  /** A button that pins a run. */
  function runLink(model, run, more = "") {
    return create(
      "button",
      { type: "button", class: "button link", on: { click: () => model.pinRun(run) } },
      report.legend.swatch(model, model.stored[run]),
      " ",
      plain(placeWords(model, model.placeOfRun.get(run))),
      more,
    );
  }

  /** Which runs decide the borders: those closest to the threshold of each rule. */
  function closest(model) {
    const margins = [...model.measures.values()].filter(
      (measure) => measure.is_evidence && measure.range === "signed",
    );
    return margins.length === 0
      ? ""
      : report.details.block(
          "Runs closest to a threshold",
          create(
            "div",
            { class: "closest" },
            margins.map((measure) =>
              create(
                "div",
                {},
                create("p", { class: "muted" }, nodes(measure.quantity)),
                create(
                  "div",
                  { class: "links" },
                  nearest(model, measure).map((run) =>
                    runLink(model, run, ` (${format(measure.values[run], 2)})`),
                  ),
                ),
              ),
            ),
          ),
        );
  }

  function hint(model) {
    const all = model.section.states ?? [];
    return [
      create(
        "p",
        {},
        "Click a cell of the map to see its runs, why they have their label, and the command that makes them again. Drag over cells to select them; a label of the legend selects its runs.",
      ),
      create(
        "p",
        { class: "muted" },
        "On the keyboard: arrows move over the map, Enter pins a cell, Shift and arrows select, Escape lets go.",
      ),
      (model.section.notes ?? []).map((note) => create("p", { class: "note" }, note)),
      closest(model),
      all.length > 0 ? report.details.block("Runs with an animation", animated(model, all)) : "",
    ];
  }

  /** Links to the runs that have an animation. */
  function animated(model, all) {
    return create(
      "div",
      { class: "links" },
      all.slice(0, 8).map((states) => runLink(model, states.run)),
    );
  }

  return { hint, animated, runLink };
})();

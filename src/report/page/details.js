/** The pinned point: its runs, why they have their labels, columns over time, spheres, scene, command. */
report.details = (() => {
  const { create, copyButton } = report.dom;
  const { placeWords } = report.data;
  const { nodes } = report.markup;
  const { format, counted } = report.numbers;

  function block(title, ...children) {
    return create("section", { class: "block" }, create("h4", {}, title), ...children);
  }

  /** The label of a run as stored, and, where thresholds are moved, the one they give. */
  function labelNodes(model, run, labels) {
    const [stored, moved] = [model.stored, labels].map((it) => report.legend.chip(model, it[run]));
    return labels === model.stored
      ? stored
      : create("span", {}, "stored: ", stored, ", by the moved thresholds: ", moved);
  }

  /** The seeds of the point with their labels; one of them is looked at. */
  function seeds(model, runs, chosen, put, labels) {
    const steady = model.runs.steady;
    const entry = (run, index) =>
      create(
        "button",
        {
          type: "button",
          class: "seed",
          "aria-pressed": String(index === chosen),
          on: { click: () => put(index) },
        },
        `${nameOf(model, run)} `,
        labelNodes(model, run, labels),
        steady?.[run] === 0 ? create("span", { class: "warning" }, " not steady") : "",
      );
    return create(
      "div",
      { class: "seeds", role: "group", "aria-label": "Runs of this point" },
      runs.map(entry),
    );
  }

  /** The measures of the runs of a point: a column for each seed. */
  function measuresTable(model, runs) {
    const heads = () => runs.map((run) => create("th", { scope: "col" }, nameOf(model, run)));
    const row = (measure) =>
      create(
        "tr",
        {},
        create(
          "th",
          { scope: "row", title: measure.description ?? null },
          report.data.measureNodes(measure),
        ),
        runs.map((run) => create("td", {}, format(measure.values[run]))),
      );
    const all = [...model.measures.values()].filter((measure) =>
      runs.some((run) => Number.isFinite(measure.values[run])),
    );
    const part = (words, measures) =>
      measures.length === 0
        ? ""
        : create(
            "table",
            { class: "numbers" },
            create("caption", {}, words),
            create("thead", {}, create("tr", {}, create("td", {}), heads())),
            create("tbody", {}, measures.map(row)),
          );
    return all.length === 0
      ? ""
      : block(
          "Measures",
          create(
            "div",
            { class: "scroll measure-tables" },
            part(
              "how clearly the rules decide",
              all.filter((it) => it.is_evidence),
            ),
            part(
              "what the run did",
              all.filter((it) => !it.is_evidence),
            ),
          ),
        );
  }

  /** What tells a run from others of its point. */
  function nameOf(model, run) {
    const seed = model.runs.seed?.[run];
    return seed === null || seed === undefined ? "run" : `seed ${seed}`;
  }

  /** Columns over time of all runs of the point. */
  function seriesBlock(model, runs, store) {
    const { series } = model.section;
    if (!series) {
      return block(
        "Over time",
        create(
          "p",
          { class: "muted" },
          model.section.absent?.series ??
            "This page holds no columns over time: the folder has labels, but no records. The command below makes the run again.",
        ),
      );
    }
    const chooser = report.series.chooser(
      series.columns,
      () => store.state.columns,
      (columns) => store.set({ columns }),
    );
    const charts = create("div", {}, create("p", { class: "muted" }, "Unpacking…"));
    const unpacked = Promise.all(runs.map((run) => report.packed.seriesOf(series, run)));
    const render = async () => {
      const found = await unpacked;
      const drawn = runs
        .map((run, index) => ({
          name: nameOf(model, run),
          color: runs.length > 1 ? lineColor(index) : labelColor(model, run),
          settled: settledOf(model, run),
          ...found[index],
        }))
        .filter((run) => run.time);
      chooser.update();
      chooser.element.hidden = drawn.length === 0;
      charts.replaceChildren(
        ...(drawn.length === 0
          ? [create("p", { class: "muted" }, "No run of this point has columns over time here.")]
          : [
              report.series.keys(drawn),
              report.series.charts(series.columns, drawn, store.state.columns),
              thinned(series, drawn[0]),
            ]),
      );
    };
    render();
    return { element: block("Over time", chooser.element, charts), render };
  }

  function thinned(series, { frames }) {
    return frames
      ? create(
          "p",
          { class: "muted" },
          `${series.points} of ${format(frames, 6)} frames are drawn.`,
        )
      : "";
  }

  function lineColor(index) {
    return index === 0 ? "var(--line)" : report.colors.distinct(index);
  }

  /** The colour of a run's label for lines: with some ink, so that any is seen on any paper. */
  function labelColor(model, run) {
    const color = report.colors.safe(model.labels[model.stored[run]].color);
    return `color-mix(in srgb, ${color} 55%, var(--ink))`;
  }

  /** From when on a run is settled (s); NaN if that is not known. */
  function settledOf(model, run) {
    const { unit, values } = model.measures.get("settle_time") ?? {};
    return unit === "s" ? (values[run] ?? NaN) : NaN;
  }

  function spheresBlock(model, run) {
    const all = model.section.states ?? [];
    const states = all.find((it) => it.run === run);
    if (!states) {
      const size =
        all.length > 0
          ? ` ${counted(all.length, "run")} of this sweep ${all.length === 1 ? "has" : "have"} one: `
          : "";
      return block(
        "Spheres",
        create(
          "p",
          { class: "muted" },
          model.section.absent?.states ?? "This page holds no animation of this run.",
          size,
        ),
        report.overview.animated(model, all),
      );
    }
    const host = create("div", {});
    const { color } = model.labels[model.stored[run]];
    report.spheres
      .player(states, report.colors.safe(color))
      .then((player) => host.replaceChildren(player));
    const bytes = all.reduce((sum, it) => sum + it.data.length, 0);
    return block(
      "Spheres",
      host,
      create(
        "p",
        { class: "muted" },
        `${counted(states.times.length, "stored state")}. The animations of ${counted(all.length, "run")} add ${report.numbers.bytes(bytes)} to this page.`,
      ),
    );
  }

  function sceneBlock(model, run) {
    const text = model.section.scene?.text;
    if (!text) {
      return block(
        "Scene file",
        create(
          "p",
          { class: "muted" },
          model.section.absent?.scene ?? "This page holds no scene file.",
        ),
      );
    }
    const lines = report.scene.lines(text, report.scene.changesOf(model, run));
    const kept = lines
      .filter((line) => line.state !== "removed")
      .map((line) => line.text)
      .join("\n");
    const marked = lines.filter((line) => line.key).length;
    return block(
      "Scene file",
      create(
        "p",
        { class: "muted" },
        `${counted(marked, "line")} differ${marked === 1 ? "s" : ""} from the scene of the sweep.`,
        " ",
        copyButton("Copy scene", () => `${kept}\n`),
      ),
      report.scene.differing(lines),
      report.scene.box(lines),
    );
  }

  function commandBlock(model, run) {
    if (!model.section.command) {
      return "";
    }
    const command = report.scene.command(model, run);
    return block(
      "Make this run again",
      create(
        "div",
        { class: "command" },
        create("code", {}, command),
        copyButton("Copy", () => command, "the command of this run"),
      ),
      model.runs.id?.[run]
        ? create("p", { class: "muted" }, "Record ", create("code", {}, String(model.runs.id[run])))
        : "",
    );
  }

  function failedBlock(model, place) {
    const found = model.failed.get(place);
    return found
      ? block(
          "Failed",
          create(
            "ul",
            {},
            found.map(({ seed, message }) =>
              create("li", {}, seed === null ? "" : `seed ${seed}: `, message),
            ),
          ),
        )
      : "";
  }

  function head(model, store) {
    const { pin } = store.state;
    const unpin = () => {
      store.set({ pin: null });
      model.focusTab();
    };
    return create(
      "header",
      { class: "point-head" },
      create("h3", { tabindex: -1 }, nodes(placeWords(model, pin))),
      create(
        "div",
        { class: "buttons" },
        copyButton("Copy link", () => {
          report.main.address.write();
          return location.href;
        }),
        create("button", { type: "button", class: "button", on: { click: unpin } }, "Unpin"),
      ),
    );
  }

  /** The panel of the pinned point. */
  function follow(model, store) {
    const element = create("div", { class: "details" });
    const [chips, why] = [create("div", {}), create("div", {})];
    let charts = null;
    let shown = null;
    const choose = (index) => {
      store.set({ run: index });
      chips.querySelector("[aria-pressed=true]").focus();
    };
    const explain = () => {
      if (shown === null) {
        return;
      }
      const { runs, index } = shown;
      const { rules, measures, stored } = model;
      const { thresholds } = store.state;
      const isMoved = rules && report.rules.moved(rules, thresholds).length > 0;
      const labels = isMoved ? report.rules.relabel(rules, measures, stored, thresholds) : stored;
      chips.replaceChildren(seeds(model, runs, index, choose, labels));
      why.hidden = !rules;
      why.replaceChildren(
        ...(rules ? [report.why.explanation(model, runs[index], thresholds)] : []),
      );
    };
    const render = () => {
      const { pin } = store.state;
      charts = null;
      shown = null;
      if (pin === null) {
        element.replaceChildren(...report.overview.hint(model).flat());
        return;
      }
      const runs = model.points.get(pin) ?? [];
      const index = Math.min(store.state.run, runs.length - 1);
      const run = runs[index];
      if (run === undefined) {
        element.replaceChildren(
          head(model, store),
          failedBlock(model, pin),
          create("p", { class: "muted" }, "No run was made at this point."),
        );
        return;
      }
      const series = seriesBlock(model, runs, store);
      charts = series.render ?? null;
      shown = { runs, index };
      explain();
      element.replaceChildren(
        ...[
          head(model, store),
          failedBlock(model, pin),
          chips,
          why,
          series.element ?? series,
          spheresBlock(model, run),
          measuresTable(model, runs),
          sceneBlock(model, run),
          commandBlock(model, run),
        ].filter(Boolean),
      );
    };
    store.listen(["pin", "run"], render);
    store.listen(["thresholds"], explain);
    store.listen(["columns"], () => charts?.());
    render();
    return element;
  }

  return { follow, block, lineColor };
})();

/** The pinned point: its runs, why they have their labels, columns over time, spheres, scene, command. */
report.details = (() => {
  const { create, copyButton } = report.dom;
  const { placeWords, labelName } = report.data;
  const { nodes, labelled, plain } = report.markup;
  const { format, counted } = report.numbers;

  function block(title, ...children) {
    return create("section", { class: "block" }, create("h4", {}, title), ...children);
  }

  /** The seeds of the point with their labels; one of them is looked at. */
  function seeds(model, runs, chosen, put) {
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
        report.legend.chip(model, model.stored[run]),
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
          nodes(labelled(measure.quantity, measure.unit)),
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
          color: lineColor(index),
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
    const marked = lines.filter((line) => line.state !== "same").length;
    const rows = lines.map((line) =>
      create(
        "span",
        { class: `scene-line ${line.state}` },
        line.state === "same" ? line.text : create("mark", {}, line.text),
        "\n",
      ),
    );
    return block(
      "Scene file",
      create(
        "p",
        { class: "muted" },
        `${counted(marked, "line")} differ${marked === 1 ? "s" : ""} from the scene of the sweep.`,
        " ",
        copyButton("Copy scene", () => `${kept}\n`),
      ),
      create("pre", { class: "scene", tabindex: 0, "aria-label": "Scene file" }, rows),
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
        copyButton("Copy", () => command),
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
    return create(
      "header",
      { class: "point-head" },
      create("h3", {}, nodes(placeWords(model, pin))),
      create(
        "div",
        { class: "buttons" },
        copyButton("Copy link", () => {
          report.main.address.write();
          return location.href;
        }),
        create(
          "button",
          { type: "button", class: "button", on: { click: () => store.set({ pin: null }) } },
          "Unpin",
        ),
      ),
    );
  }

  /** The panel of the pinned point. */
  function follow(model, store) {
    const element = create("div", { class: "details" });
    const why = create("div", {});
    let charts = null;
    let explained = null;
    const explain = () => {
      const isMade = explained !== null && model.rules;
      why.replaceChildren(
        ...(isMade ? [report.why.explanation(model, explained, store.state.thresholds)] : []),
      );
      why.hidden = !isMade;
    };
    const render = () => {
      const { pin, run: index } = store.state;
      charts = null;
      explained = null;
      if (pin === null) {
        element.replaceChildren(...report.overview.hint(model).flat());
        return;
      }
      const runs = model.points.get(pin) ?? [];
      const run = runs[Math.min(index, runs.length - 1)];
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
      explained = run;
      explain();
      element.replaceChildren(
        ...[
          head(model, store),
          failedBlock(model, pin),
          seeds(model, runs, Math.min(index, runs.length - 1), (chosen) =>
            store.set({ run: chosen }),
          ),
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

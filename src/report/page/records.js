/** A section on records: one, or several beside each other. */
report.records = (() => {
  const { create, copyButton } = report.dom;
  const { nodes, plain } = report.markup;
  const { format } = report.numbers;

  /** Quantities of the records with their half widths: {rows: [{quantity, unit, values, half_widths}]}. */
  function quantities(section) {
    const rows = section.quantities ?? [];
    if (rows.length === 0) {
      return "";
    }
    const cell = (row, index) => {
      const half = row.half_widths?.[index];
      return create(
        "td",
        {},
        format(row.values[index]),
        Number.isFinite(half) ? create("span", { class: "muted" }, ` ± ${format(half, 2)}`) : "",
      );
    };
    return create(
      "div",
      { class: "scroll" },
      create(
        "table",
        { class: "numbers" },
        create("caption", {}, "Quantities"),
        create(
          "thead",
          {},
          create(
            "tr",
            {},
            create("td", {}),
            section.records.map((record) => create("th", { scope: "col" }, nodes(record.name))),
          ),
        ),
        create(
          "tbody",
          {},
          rows.map((row) =>
            create(
              "tr",
              {},
              create("th", { scope: "row" }, nodes(report.markup.labelled(row.quantity, row.unit))),
              section.records.map((_, index) => cell(row, index)),
            ),
          ),
        ),
      ),
    );
  }

  function seriesOf(section) {
    const { series, records } = section;
    const host = create("div", {});
    if (!series) {
      return create(
        "p",
        { class: "muted" },
        section.absent?.series ?? "This page holds no columns over time.",
      );
    }
    const usual = series.columns.filter((column) => column.is_usual).map((column) => column.name);
    let chosen = usual.length > 0 ? usual : series.columns.slice(0, 3).map((column) => column.name);
    const chooser = report.series.chooser(
      series.columns,
      () => chosen,
      (columns) => {
        chosen = columns;
        render();
      },
    );
    const unpacked = Promise.all(records.map((_, index) => report.packed.seriesOf(series, index)));
    const render = async () => {
      const found = await unpacked;
      const runs = found
        .map((run, index) => ({
          name: records[index].name,
          color: report.details.lineColor(index),
          ...run,
        }))
        .filter((run) => run.time);
      host.replaceChildren(
        report.series.keys(runs),
        report.series.charts(series.columns, runs, chosen),
      );
    };
    render();
    return create("div", {}, chooser.element, host);
  }

  function recordPanel(section, record, index) {
    const states = (section.states ?? []).find((it) => it.run === index);
    const player = create("div", {});
    if (states) {
      report.spheres
        .player(states, report.colors.safe(record.color ?? "#58a6e0"))
        .then((made) => player.replaceChildren(made));
    }
    const lines = section.scene ? report.scene.lines(section.scene.text, record.changes ?? []) : [];
    return create(
      "article",
      { class: "record" },
      create("h3", { dir: "auto" }, nodes(record.name)),
      (record.notes ?? []).map((note) => create("p", { class: "muted" }, note)),
      player,
      record.command
        ? create(
            "div",
            { class: "command" },
            create("code", {}, record.command),
            copyButton("Copy", () => record.command, `the command of ${plain(record.name)}`),
          )
        : "",
      lines.length > 0
        ? create(
            "details",
            { class: "fold" },
            create("summary", {}, "Scene file"),
            report.scene.box(lines),
          )
        : "",
    );
  }

  /** The records that have more to show than a name, which tables and charts tell. */
  function panels(section) {
    const has = (record, index) =>
      record.notes ||
      record.command ||
      section.scene ||
      section.states?.some((it) => it.run === index);
    return section.records
      .map((record, index) => [record, index])
      .filter(([record, index]) => has(record, index))
      .map(([record, index]) => recordPanel(section, record, index));
  }

  function follow(section) {
    return create(
      "section",
      { class: "records" },
      (section.notes ?? []).map((note) => create("p", { class: "note" }, note)),
      create("div", { class: "record-list" }, panels(section)),
      quantities(section),
      (section.charts ?? []).map((chart) => report.studies.lines(chart)),
      section.series ? create("h3", {}, "Over time") : "",
      seriesOf(section),
    );
  }

  return { follow };
})();

/** The data of the page as files, and what the page is made of. */
report.download = (() => {
  const { create, copyButton } = report.dom;

  /** A button that saves a file which `content` makes. */
  function button(words, name, type, content) {
    return create(
      "button",
      { type: "button", class: "button", on: { click: () => save(name, type, content()) } },
      words,
    );
  }

  function save(name, type, content) {
    const address = URL.createObjectURL(new Blob([content], { type }));
    const link = create("a", { href: address, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  }

  function quoted(value) {
    const text = value === null || value === undefined ? "" : String(value);
    return /[",\r\n]/.test(text) ? `"${text.split('"').join('""')}"` : text;
  }

  /** A row for each run, as in labels.csv. */
  function csv(model) {
    const measures = [...model.measures.values()];
    const { id, seed, steady } = model.runs;
    const columns = [
      ...(id ? [["id", (run) => id[run]]] : []),
      ...model.axes.map((axis, at) => [
        axis.name,
        (run) => report.data.written(axis, model.runs.places[at][run]),
      ]),
      ...(seed ? [["seed", (run) => seed[run]]] : []),
      ["label", (run) => model.labels[model.stored[run]].name],
      ["code", (run) => model.labels[model.stored[run]].code],
      ...(steady ? [["steady", (run) => ({ 1: "true", 0: "false" })[steady[run]] ?? ""]] : []),
      ...measures.map((measure) => [measure.name, (run) => measure.values[run]]),
    ];
    const rows = Array.from({ length: model.count }, (_, run) =>
      columns.map(([, value]) => quoted(value(run))).join(","),
    );
    return `${[columns.map(([name]) => quoted(name)).join(","), ...rows].join("\n")}\n`;
  }

  /** Definitions of the measures. */
  function definitions(model) {
    const found = [...model.measures.values()].filter((measure) => measure.description);
    return found.length === 0
      ? ""
      : create(
          "details",
          { class: "fold" },
          create("summary", {}, "What the measures mean"),
          create(
            "dl",
            { class: "definitions" },
            found.map((measure) => [
              create("dt", {}, report.data.measureNodes(measure)),
              create("dd", {}, measure.description.trim()),
            ]),
          ),
        );
  }

  /** The panel of a sweep. */
  function panel(model, stem) {
    return create(
      "div",
      { class: "data" },
      create("h4", {}, "Download"),
      create(
        "div",
        { class: "buttons" },
        button("Runs as CSV", `${stem}-labels.csv`, "text/csv", () => csv(model)),
        button(
          "All data as JSON",
          `${stem}.json`,
          "application/json",
          () => document.getElementById("data").textContent,
        ),
      ),
      create("p", { class: "muted" }, "Both are in this page; nothing is loaded."),
      definitions(model),
    );
  }

  /** Commands, versions and licences, at the end of the page. */
  function colophon(document_) {
    const commands = (document_.commands ?? []).map(({ purpose, line }) =>
      create(
        "div",
        { class: "command-row" },
        create("span", { class: "muted" }, purpose),
        create(
          "div",
          { class: "command" },
          create("code", {}, line),
          copyButton("Copy", () => line, `the command: ${purpose}`),
        ),
      ),
    );
    const { name = "phase", version = "", commit = "" } = document_.program ?? {};
    const licences = (document_.licences ?? []).map(({ name: title, text }) =>
      create("details", { class: "fold" }, create("summary", {}, title), create("pre", {}, text)),
    );
    return create(
      "footer",
      { class: "colophon" },
      commands,
      licences,
      create(
        "p",
        { class: "muted" },
        `Made by ${[name, version].filter(Boolean).join(" ")}${commit ? ` (${commit})` : ""}. This page is one file that loads nothing.`,
      ),
      create(
        "p",
        { class: "muted" },
        "Colours of values: viridis (van der Walt and Smith, CC0); RdBu, from the color specifications and designs developed by Cynthia Brewer (colorbrewer.org, Apache License 2.0).",
      ),
    );
  }

  return { panel, colophon, csv, save };
})();

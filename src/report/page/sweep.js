/** A section on a sweep: the map on one side, panels about it on the other. */
report.sweep = (() => {
  const { create, uniqueId } = report.dom;
  const { counted } = report.numbers;

  const TABS = [
    ["point", "Point"],
    ["thresholds", "Thresholds"],
    ["measures", "Measures"],
    ["table", "Table"],
    ["data", "Data"],
  ];

  /** The state of a sweep at first. */
  function initial(model) {
    const { view = {}, series } = model.section;
    const last = model.axes.length - 1;
    const x = view.x ?? 0;
    const y = view.y ?? (last >= 1 ? 1 : -1);
    const names = (series?.columns ?? []).map((column) => column.name);
    const usual = (series?.columns ?? [])
      .filter((column) => column.is_usual)
      .map((column) => column.name);
    return {
      x,
      y,
      slice: view.slice ?? model.axes.map(() => 0),
      map: "label",
      tab: "point",
      pin: null,
      run: 0,
      cursor: null,
      brush: null,
      layers: { borders: true, bands: false, theory: true, marks: true, patterns: false },
      thresholds: model.rules ? report.rules.stored(model.rules) : {},
      columns: usual.length > 0 ? usual : names.slice(0, 2),
      scatter: view.scatter ?? usualScatter(model),
      selection: null,
    };
  }

  function usualScatter(model) {
    const measures = [...model.measures.values()];
    const done = measures.filter((measure) => !measure.is_evidence);
    const found = (done.length > 1 ? done : measures).slice(0, 2).map((measure) => measure.name);
    return found.length === 2 ? found : [...found, ...model.scatterNames].slice(0, 2);
  }

  function scatterNames(model) {
    return [
      ...model.measures.keys(),
      ...model.axes.filter((axis) => !axis.words).map((axis) => `axis:${axis.name}`),
    ];
  }

  /** Tabs with panels; all panels exist, so that they can be printed. */
  function tabs(store, first, panels) {
    const stem = uniqueId("tab");
    const list = create("div", { class: "tabs", role: "tablist", "aria-label": "About the sweep" });
    const found = TABS.map(([name, words]) => {
      const tab = create(
        "button",
        {
          type: "button",
          role: "tab",
          id: `${stem}-${name}`,
          "aria-controls": `${stem}-${name}-panel`,
          name: `tab-${name}`,
        },
        words,
      );
      const panel = create(
        "div",
        {
          class: `panel panel-${name}`,
          role: "tabpanel",
          id: `${stem}-${name}-panel`,
          "aria-labelledby": `${stem}-${name}`,
        },
        create("h3", { class: "print-only" }, words),
        panels[name],
      );
      tab.addEventListener("click", () => store.set({ tab: name }));
      return { name, tab, panel };
    });
    list.append(...found.map(({ tab }) => tab));
    list.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step) {
        const at = found.findIndex(({ tab }) => tab === document.activeElement);
        const next = found[(at + step + found.length) % found.length];
        store.set({ tab: next.name });
        next.tab.focus();
        event.preventDefault();
      }
    });
    const prints = {
      point: () => store.state.pin !== null,
      thresholds: () =>
        Object.entries(store.state.thresholds).some(
          ([key, value]) => first.thresholds[key] !== value,
        ),
      measures: () => store.state.selection !== null,
    };
    const update = () =>
      found.forEach(({ name, tab, panel }) => {
        const isOn = name === store.state.tab;
        tab.setAttribute("aria-selected", String(isOn));
        tab.tabIndex = isOn ? 0 : -1;
        panel.hidden = !isOn;
        panel.dataset.prints = String(prints[name]?.() ?? false);
      });
    store.listen(["tab", "pin", "thresholds", "selection"], update);
    update();
    return create(
      "div",
      { class: "side" },
      list,
      found.map(({ panel }) => panel),
    );
  }

  /** Says that the thresholds are moved while their panel is not seen. */
  function movedNotice(model, store) {
    const element = create("p", { class: "notice", hidden: true });
    const update = () => {
      const moved = model.rules
        ? report.rules.moved(model.rules, store.state.thresholds).length
        : 0;
      element.hidden = moved === 0 || store.state.tab === "thresholds";
      element.replaceChildren(
        `${counted(moved, "threshold")} moved; this map shows the stored labels. `,
        create(
          "button",
          {
            type: "button",
            class: "button small",
            on: { click: () => store.set({ tab: "thresholds" }) },
          },
          "Show",
        ),
      );
    };
    store.listen(["thresholds", "tab"], update);
    update();
    return element;
  }

  function facts(model) {
    const seeds = new Set(model.runs.seed ?? []).size;
    const parts = [counted(model.count, "run"), counted(model.points.size, "point")];
    if (seeds > 0) {
      parts.push(counted(seeds, "seed"));
    }
    const failed = [...model.failed.values()].flat().length;
    if (failed > 0) {
      parts.push(`${failed} failed`);
    }
    const unsteady = (model.runs.steady ?? []).filter((steady) => steady === 0).length;
    if (unsteady > 0) {
      parts.push(`${unsteady} not steady`);
    }
    return parts.join(" · ");
  }

  /** A section with its store. */
  function follow(section, stem) {
    const model = report.data.sweep(section);
    model.scatterNames = scatterNames(model);
    const first = initial(model);
    const store = report.store.create(first);
    model.pin = (place) => {
      store.set({
        pin: place,
        run: 0,
        cursor: place,
        tab: store.state.tab === "thresholds" ? "thresholds" : "point",
      });
    };
    model.pinRun = (run) => {
      const place = model.placeOfRun.get(run);
      store.set({
        pin: place,
        run: model.points.get(place).indexOf(run),
        slice: report.data.indices(model, place),
        tab: "point",
      });
      element.querySelector(".point-head h3").focus();
    };
    model.focusTab = () => element.querySelector("[role=tab][aria-selected=true]").focus();
    const map = report.map.follow({
      model,
      store,
      name: `Map of ${report.markup.plain(section.title ?? "the sweep")}. Arrow keys move over its cells, Enter pins one.`,
      look: (state) => report.looks.of(model, state, model.stored),
    });
    report.hover.attach(map, () => model.stored);
    report.keyboard.attach(map, () => model.stored);
    const panels = {
      point: report.details.follow(model, store),
      thresholds: report.thresholds.follow(model, store),
      measures: report.measures.follow(model, store),
      table: report.table.follow(model, store),
      data: report.download.panel(model, stem),
    };
    const element = create(
      "section",
      { class: "sweep" },
      create(
        "div",
        { class: "main" },
        create("p", { class: "facts" }, facts(model)),
        report.controls.follow(model, store),
        movedNotice(model, store),
        map.element,
        report.legend.follow(model, store),
      ),
      tabs(store, first, panels),
    );
    return { element, model, store, initial: first };
  }

  return { follow };
})();

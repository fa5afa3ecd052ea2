/** Sliders of thresholds, and the map that follows from them beside the stored one. */
report.thresholds = (() => {
  const { create, copyButton } = report.dom;
  const { nodes, labelled } = report.markup;
  const { format, counted } = report.numbers;

  const MOST_LINKS = 10;

  /** A round step, about 1/200 of the range. */
  function stepOf({ low, high, step, is_whole: isWhole }) {
    if (step || isWhole) {
      return step ?? 1;
    }
    const raw = (high - low) / 200;
    const power = 10 ** Math.floor(Math.log10(raw));
    return [1, 2, 5, 10]
      .map((factor) => Number((factor * power).toPrecision(1)))
      .find((it) => it >= raw * 0.999);
  }

  /** A slider with a field, or one that snaps to the stops whose evidence is stored. */
  function control(threshold, store) {
    const { key, stops } = threshold;
    const put = (value) => store.set({ thresholds: { ...store.state.thresholds, [key]: value } });
    const putBack = () => {
      put(threshold.value);
      slider.focus();
    };
    const id = report.dom.uniqueId("threshold");
    const slider = stops
      ? create("input", { type: "range", id, name: key, min: 0, max: stops.length - 1, step: 1 })
      : create("input", {
          type: "range",
          id,
          name: key,
          min: threshold.low,
          max: threshold.high,
          step: stepOf(threshold),
        });
    const named = { name: `${key}-value`, "aria-label": `${key}, exact` };
    const number = stops
      ? report.dom.select(
          named,
          stops.map((stop) => [String(stop), format(stop)]),
        )
      : create("input", {
          ...named,
          type: "number",
          min: threshold.low,
          max: threshold.high,
          step: "any",
        });
    const reset = create(
      "button",
      {
        type: "button",
        class: "button small",
        "aria-label": `Reset ${key}`,
        on: { click: putBack },
      },
      "Reset",
    );
    slider.addEventListener("input", () =>
      put(stops ? stops[Number(slider.value)] : Number(slider.value)),
    );
    number.addEventListener("change", () => {
      const value = Number(number.value);
      const isAllowed = number.value !== "" && value >= threshold.low && value <= threshold.high;
      put(isAllowed ? value : store.state.thresholds[key]);
      update();
    });
    const stored = create("span", {});
    const update = () => {
      const value = store.state.thresholds[key];
      slider.value = String(stops ? stops.indexOf(value) : value);
      slider.setAttribute("aria-valuetext", report.numbers.withUnit(value, threshold.unit));
      number.value = String(value);
      element.classList.toggle("moved", value !== threshold.value);
      stored.textContent =
        value === threshold.value ? "as stored" : `stored: ${format(threshold.value, 6)}`;
      reset.disabled = value === threshold.value;
    };
    const element = create(
      "div",
      { class: "threshold" },
      create(
        "label",
        { for: id, title: threshold.description ?? null },
        nodes(labelled(threshold.quantity, threshold.unit)),
      ),
      create("div", { class: "threshold-row" }, slider, number, reset),
      create("p", { class: "muted" }, create("code", {}, key), " · ", stored),
    );
    store.listen(["thresholds"], update);
    update();
    return element;
  }

  /** The labels by the thresholds as they are, and the places that they change; computed once. */
  function labelling(model, store) {
    let known = null;
    let found = null;
    return () => {
      if (known !== store.state.thresholds) {
        known = store.state.thresholds;
        const labels = report.rules.relabel(model.rules, model.measures, model.stored, known);
        found = { labels, changed: changedPlaces(model, labels) };
      }
      return found;
    };
  }

  /** The places whose majority label is another than stored. */
  function changedPlaces(model, labels) {
    const changed = new Set();
    for (const [place, runs] of model.points) {
      const [was, is] = [
        report.data.majority(runs, model.stored),
        report.data.majority(runs, labels),
      ];
      if (was.label !== is.label) {
        changed.add(place);
      }
    }
    return changed;
  }

  /** Links to runs, at most some of them. */
  function runLinks(model, runs) {
    const hasSeeds = model.runs.seed && model.points.size < model.count;
    const more = runs.length - MOST_LINKS;
    return create(
      "div",
      { class: "links" },
      runs
        .slice(0, MOST_LINKS)
        .map((run) =>
          report.overview.runLink(model, run, hasSeeds ? `, seed ${model.runs.seed[run]}` : ""),
        ),
      more > 0 ? create("span", { class: "muted" }, `and ${more} more`) : "",
    );
  }

  /** From which label to which, and which runs. */
  function transitions(model, labels) {
    const groups = new Map();
    labels.forEach((label, run) => {
      if (label !== model.stored[run]) {
        const key = `${model.stored[run]},${label}`;
        groups
          .set(key, groups.get(key) ?? [])
          .get(key)
          .push(run);
      }
    });
    const found = [...groups].sort((one, other) => other[1].length - one[1].length);
    return create(
      "ul",
      { class: "transitions" },
      found.map(([key, runs]) => {
        const [was, is] = key.split(",").map(Number);
        return create(
          "li",
          {},
          report.legend.chip(model, was),
          " → ",
          report.legend.chip(model, is),
          ` ${counted(runs.length, "run")}`,
          runLinks(model, runs),
        );
      }),
    );
  }

  function changesCount(model, store, { labels, changed }) {
    if (report.rules.moved(model.rules, store.state.thresholds).length === 0) {
      return ["The thresholds are as stored. Move one to label all runs again."];
    }
    const runs = labels.reduce((sum, label, run) => sum + Number(label !== model.stored[run]), 0);
    const places = `${counted(changed.size, "point")} of ${model.points.size}`;
    return [
      create("strong", {}, `${counted(runs, "label")} changed`),
      ` of ${counted(model.count, "run")}`,
      model.points.size < model.count ? `; ${places} with another majority` : "",
    ];
  }

  /** How to keep the moved thresholds. */
  function keeping(model, thresholds) {
    const keys = report.rules
      .moved(model.rules, thresholds)
      .filter(({ toml, key }) => !toml && key.includes("."))
      .map(({ key }) => key.split(".").slice(0, -1).join("."));
    const tables = [...new Set(keys)].map((key) => `[${key}]`);
    const folder = /^phase run --from ((?:'[^']*'|\\'|[^\s'])+) /.exec(model.section.command ?? "");
    return create(
      "p",
      { class: "muted" },
      "To keep these thresholds, set these keys in a copy of the sweep file",
      tables.length > 0 ? ` (in its table ${tables.join(" or ")}, if it has one)` : "",
      ", then: ",
      create("code", {}, `phase classify ${folder?.[1] ?? "FOLDER"} --sweep FILE`),
    );
  }

  function summary(model, store, labels) {
    if (report.rules.moved(model.rules, store.state.thresholds).length === 0) {
      return [];
    }
    const toml = report.rules.toml(model.rules, store.state.thresholds);
    return [
      transitions(model, labels),
      keeping(model, store.state.thresholds),
      create(
        "div",
        { class: "command" },
        create("pre", { class: "toml" }, toml),
        copyButton("Copy", () => `${toml}\n`, "the moved thresholds"),
      ),
    ];
  }

  function fixedNote(rules) {
    const fixed = rules.not_movable ?? [];
    return fixed.length === 0
      ? ""
      : create(
          "details",
          { class: "fold" },
          create("summary", {}, "Thresholds that cannot move here"),
          create(
            "ul",
            {},
            fixed.map(({ key, value, why }) =>
              create("li", {}, create("code", {}, `${key} = ${value}`), ` ${why}`),
            ),
          ),
        );
  }

  /** The panel; null if no stored evidence decides. */
  function follow(model, store) {
    if (!model.rules || model.rules.thresholds.length === 0) {
      return create(
        "div",
        {},
        create(
          "p",
          { class: "muted" },
          model.section.absent?.thresholds ??
            "The stored evidence alone does not decide any label of this sweep, so no threshold can move here. Change the sweep file and run phase classify.",
        ),
      );
    }
    const found = labelling(model, store);
    const labels = () => found().labels;
    const map = report.map.follow({
      model,
      store,
      name: "Map of the labels by these thresholds",
      share: 0.72,
      look: (state) =>
        report.looks.of(model, state, labels(), { usesLattice: false, map: "label" }),
      changed: () => found().changed,
    });
    report.hover.attach(map, labels);
    report.keyboard.attach(map, labels);
    const told = create("div", { class: "changes" });
    const count = create("p", { class: "count-changed", "aria-live": "polite" });
    const update = () => {
      map.render();
      tell();
    };
    const tell = () => {
      count.replaceChildren(...changesCount(model, store, found()));
      told.replaceChildren(...summary(model, store, labels()));
    };
    store.listen(["thresholds"], update);
    tell();
    const resetAll = create(
      "button",
      {
        type: "button",
        class: "button",
        on: { click: () => store.set({ thresholds: report.rules.stored(model.rules) }) },
      },
      "Reset all",
    );
    return create(
      "div",
      { class: "thresholds" },
      create(
        "div",
        { class: "relabelled" },
        create("h4", {}, "Labels by these thresholds"),
        count,
        model.section.lattice
          ? create(
              "p",
              { class: "muted" },
              "Only runs are labelled again; the map between them needs phase classify.",
            )
          : "",
        map.element,
      ),
      create(
        "div",
        { class: "threshold-list" },
        model.rules.thresholds.map((threshold) => control(threshold, store)),
      ),
      told,
      create("div", { class: "buttons" }, resetAll),
      fixedNote(model.rules),
    );
  }

  return { follow };
})();

/** The state in the address, so that what is seen can be sent. */
report.address = (() => {
  const { written, indices, placeOf } = report.data;
  const LAYERS = ["borders", "bands", "theory", "marks", "patterns"];

  const TABS = ["point", "thresholds", "measures", "table", "data"];

  /** Encodes what has a meaning in lists; most names stay readable. */
  const part = encodeURIComponent;

  /** The opposite; a text that nothing encodes to stays as it is. */
  function unpart(text) {
    try {
      return decodeURIComponent(text);
    } catch {
      return text;
    }
  }

  /** An address may hold these signs as they are. */
  function readable(text) {
    return encodeURIComponent(text).replace(/%3A/g, ":").replace(/%3B/g, ";").replace(/%2C/g, ",");
  }

  /** Parts [name, value] of what differs from the initial state of a sweep. */
  function encode(model, state, initial) {
    const parts = [];
    const add = (name, value, usual) => {
      if (value !== null && value !== undefined && value !== usual) {
        parts.push([name, String(value)]);
      }
    };
    add("at", state.pin === null ? null : placeText(model, state.pin));
    add("run", state.pin !== null && state.run !== 0 ? state.run : null);
    add("x", model.axes[state.x]?.name, model.axes[initial.x]?.name);
    add("y", model.axes[state.y]?.name, model.axes[initial.y]?.name);
    add("slice", sliceText(model, state), sliceText(model, initial));
    add("map", state.map, initial.map);
    add("tab", state.tab, initial.tab);
    add(
      "on",
      LAYERS.filter((name) => state.layers[name] && !initial.layers[name]).join(",") || null,
    );
    add(
      "off",
      LAYERS.filter((name) => !state.layers[name] && initial.layers[name]).join(",") || null,
    );
    add("columns", state.columns.map(part).join(","), initial.columns.map(part).join(","));
    add("measures", state.scatter.map(part).join(","), initial.scatter.map(part).join(","));
    add("select", state.selection === null ? null : JSON.stringify(state.selection));
    (model.rules ? report.rules.moved(model.rules, state.thresholds) : []).forEach(({ key }) => {
      add(key, state.thresholds[key]);
    });
    return parts;
  }

  function placeText(model, place) {
    return indices(model, place)
      .map((index, at) => `${part(model.axes[at].name)}:${part(written(model.axes[at], index))}`)
      .join(";");
  }

  function sliceText(model, state) {
    const others = model.axes.map((_, at) => at).filter((at) => at !== state.x && at !== state.y);
    return (
      others
        .map(
          (at) => `${part(model.axes[at].name)}:${part(written(model.axes[at], state.slice[at]))}`,
        )
        .join(";") || null
    );
  }

  /** The index of the value of an axis that a text means; -1 if it means none. */
  function indexOf(axis, text) {
    const exact = axis.values.findIndex((_, index) => written(axis, index) === text);
    const number = Number(text);
    if (exact >= 0 || axis.words || text === "" || !Number.isFinite(number)) {
      return exact;
    }
    const distances = axis.values.map((value) => Math.abs(value - number));
    return distances.indexOf(Math.min(...distances));
  }

  /** Indices of the axes that a text "radius:0.003;omega:6" names. */
  function namedIndices(model, text) {
    const found = new Map();
    for (const pair of text.split(";")) {
      const [name, value = ""] = pair.split(":").map(unpart);
      const axis = model.axes.findIndex((it) => it.name === name);
      const index = axis < 0 ? -1 : indexOf(model.axes[axis], value);
      if (index >= 0) {
        found.set(axis, index);
      }
    }
    return found;
  }

  /** The state that parts mean; what makes no sense is left out. */
  function decode(model, parts, initial) {
    const get = (name) => parts.get(name);
    const state = { ...initial, layers: { ...initial.layers }, slice: [...initial.slice] };
    const axis = (name) => model.axes.findIndex((it) => it.name === get(name));
    [
      ["x", axis("x")],
      ["y", axis("y")],
    ].forEach(([name, at]) => {
      state[name] = at >= 0 ? at : initial[name];
    });
    if (state.x === state.y) {
      [state.x, state.y] = [initial.x, initial.y];
    }
    namedIndices(model, get("slice") ?? "").forEach((index, at) => {
      state.slice[at] = index;
    });
    const place = namedIndices(model, get("at") ?? "");
    if (place.size === model.axes.length) {
      const all = model.axes.map((_, at) => place.get(at));
      Object.assign(state, { pin: placeOf(model, all), slice: all });
      state.run = Number.parseInt(get("run") ?? "0", 10) || 0;
    }
    state.map = model.measures.has(get("map")) ? get("map") : initial.map;
    state.tab = TABS.includes(get("tab")) ? get("tab") : initial.tab;
    const names = (name) => (get(name) ?? "").split(",").map(unpart);
    names("on")
      .concat(names("off"))
      .filter((name) => LAYERS.includes(name))
      .forEach((name) => {
        state.layers[name] = names("on").includes(name);
      });
    const known = (model.section.series?.columns ?? []).map((column) => column.name);
    const columns = names("columns").filter((name) => known.includes(name));
    state.columns = columns.length > 0 ? columns : initial.columns;
    const scatter = names("measures");
    const isScatter =
      scatter.length === 2 && scatter.every((name) => model.scatterNames.includes(name));
    state.scatter = isScatter ? scatter : initial.scatter;
    state.selection = selectionOf(model, get("select"));
    state.thresholds = thresholdsOf(model, parts, initial);
    return state;
  }

  function selectionOf(model, text) {
    try {
      const found = JSON.parse(text ?? "null");
      return report.looks.isSelection(model, found) ? found : null;
    } catch {
      return null;
    }
  }

  function thresholdsOf(model, parts, initial) {
    const found = { ...initial.thresholds };
    for (const { key, low, high, stops } of model.rules?.thresholds ?? []) {
      const value = parts.has(key) ? Number(parts.get(key)) : NaN;
      const isAllowed = stops ? stops.includes(value) : value >= low && value <= high;
      if (isAllowed) {
        found[key] = value;
      }
    }
    return found;
  }

  /** Keeps the address and the states of all sweeps of a page equal. */
  function bind(views) {
    const prefix = (index) => (index === 0 ? "" : `${index + 1}.`);
    let written = null;
    const write = () => {
      const parts = views.flatMap(({ model, store, initial }, index) =>
        encode(model, store.state, initial).map(([name, value]) => [prefix(index) + name, value]),
      );
      const text = parts.map((pair) => pair.map(readable).join("=")).join("&");
      written = text === "" ? "" : `#${text}`;
      if (written !== location.hash) {
        history.replaceState(null, "", text === "" ? location.pathname + location.search : written);
      }
    };
    const read = () => {
      if (location.hash === written) {
        return;
      }
      const all = new URLSearchParams(location.hash.slice(1));
      views.forEach(({ model, store, initial }, index) => {
        const own = [...all].filter(([name]) => name.startsWith(prefix(index)));
        const parts = new Map(
          own.map(([name, value]) => [name.slice(prefix(index).length), value]),
        );
        store.set(decode(model, parts, initial));
      });
    };
    let waiting = null;
    views.forEach(({ store }) =>
      store.listen(null, () => {
        clearTimeout(waiting);
        waiting = setTimeout(write, 120);
      }),
    );
    window.addEventListener("hashchange", read);
    read();
    return { write };
  }

  return { bind, encode, decode };
})();

/** What a map shows: which quantity, over which axes, in which slice. */
report.controls = (() => {
  const { create, select } = report.dom;
  const { nodes } = report.markup;

  function field(words, control) {
    return create("label", { class: "field" }, create("span", {}, words), control);
  }

  /** Groups of maps: the label, margins and evidence, measures. */
  function mapSelect(model, store) {
    const option = (measure) =>
      create("option", { value: measure.name }, report.data.measureWords(measure));
    const measures = [...model.measures.values()];
    const group = (words, found) =>
      found.length > 0 ? [create("optgroup", { label: words }, found.map(option))] : [];
    const element = create(
      "select",
      { name: "map" },
      create("option", { value: "label" }, "label"),
      group(
        "How clearly the rules decide",
        measures.filter((it) => it.is_evidence),
      ),
      group(
        "What the runs did",
        measures.filter((it) => !it.is_evidence),
      ),
    );
    element.value = store.state.map;
    element.addEventListener("change", () => store.set({ map: element.value }));
    return field("Map of", element);
  }

  function axisSelect(model, store, name) {
    const options = model.axes.map((axis, at) => [String(at), axis.name]);
    const element = select({ name: `axis-${name}` }, options, String(store.state[name]));
    element.addEventListener("change", () => {
      const at = Number(element.value);
      const other = name === "x" ? "y" : "x";
      const swap = store.state[other] === at ? { [other]: store.state[name] } : {};
      store.set({ [name]: at, ...swap });
    });
    return field(name === "x" ? "Across" : "Up", element);
  }

  /** A slider, or a list for names, over the values of an axis that is not shown. */
  function sliceControl(model, store, at) {
    const axis = model.axes[at];
    if (axis.values.length === 1) {
      return create(
        "p",
        { class: "muted" },
        nodes(
          `${axis.quantity ?? axis.name} = ${axis.words?.[0] ?? report.numbers.withUnit(axis.values[0], axis.unit)}`,
        ),
      );
    }
    const put = (index) =>
      store.set({ slice: store.state.slice.map((old, other) => (other === at ? index : old)) });
    if (axis.words) {
      const element = select(
        { name: `slice-${axis.name}` },
        axis.words.map((word, index) => [String(index), word]),
        String(store.state.slice[at]),
      );
      element.addEventListener("change", () => put(Number(element.value)));
      return field(axis.name, element);
    }
    const slider = create("input", {
      type: "range",
      name: `slice-${axis.name}`,
      min: 0,
      max: axis.values.length - 1,
      step: 1,
    });
    const value = create("output", { class: "value" });
    const say = () => {
      const index = store.state.slice[at];
      const text = report.numbers.withUnit(axis.values[index], axis.unit);
      slider.value = String(index);
      slider.setAttribute("aria-valuetext", text);
      value.textContent = text;
    };
    slider.addEventListener("input", () => {
      put(Number(slider.value));
      say();
    });
    store.listen(["slice"], say);
    say();
    return create(
      "label",
      { class: "field slice" },
      create("span", {}, nodes(axis.quantity ?? axis.name)),
      slider,
      value,
    );
  }

  function follow(model, store) {
    const element = create("div", { class: "controls" });
    const render = () => {
      const { x, y } = store.state;
      const others = model.axes.map((_, at) => at).filter((at) => at !== x && at !== y);
      element.replaceChildren(
        mapSelect(model, store),
        ...(model.axes.length > 2
          ? [
              create(
                "div",
                { class: "pair" },
                axisSelect(model, store, "x"),
                axisSelect(model, store, "y"),
              ),
            ]
          : []),
        ...(others.length > 0
          ? [
              create(
                "div",
                { class: "slices" },
                others.map((at) => sliceControl(model, store, at)),
              ),
            ]
          : []),
      );
    };
    store.listen(["x", "y"], render);
    store.listen(["map"], () => {
      const list = element.querySelector("select[name=map]");
      list.value = store.state.map;
    });
    render();
    return element;
  }

  return { follow, field };
})();

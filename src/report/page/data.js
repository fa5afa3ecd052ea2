/** The document, and what follows from the columns of a sweep. */
report.data = (() => {
  function read() {
    return JSON.parse(document.getElementById("data").textContent);
  }

  /** How a value of an axis is written in commands, scenes and addresses. */
  function written(axis, index) {
    return axis.texts?.[index] ?? axis.words?.[index] ?? String(axis.values[index]);
  }

  /** A value of an axis for people, as shown. */
  function shown(axis, index) {
    if (axis.words) {
      return axis.words[index];
    }
    return report.numbers.format(axis.values[index] * (axis.shown?.factor ?? 1));
  }

  /** Symbol and unit of an axis as shown. */
  function label(axis) {
    const { quantity, unit } = axis.shown ?? axis;
    return report.markup.labelled(quantity ?? axis.name, unit);
  }

  /** A measure in a list: quantity, unit and its column of `labels.csv`. */
  function measureWords({ quantity, unit, name }) {
    const words = report.markup.plain(report.markup.labelled(quantity, unit));
    return name ? `${words} · ${name}` : words;
  }

  /** The same for a table. */
  function measureNodes({ quantity, unit, name }) {
    const words = report.markup.nodes(report.markup.labelled(quantity, unit));
    return [words, " ", report.dom.create("code", {}, name)];
  }

  /** "r = 0.003 m, Ω = 6 rad/s" as markup. */
  function placeWords(model, place) {
    return indices(model, place)
      .map((index, at) => {
        const axis = model.axes[at];
        if (axis.words) {
          return axis.words[index];
        }
        const value = report.numbers.withUnit(axis.values[index], axis.unit);
        return `${axis.quantity ?? axis.name} = ${value}`;
      })
      .join(", ");
  }

  function completed(axis) {
    const values = axis.values ?? axis.words.map((_, index) => index);
    const spacing = axis.words ? "even" : (axis.spacing ?? "linear");
    return { ...axis, values, spacing };
  }

  function strides(axes) {
    const found = new Array(axes.length);
    let stride = 1;
    for (let at = axes.length - 1; at >= 0; at -= 1) {
      found[at] = stride;
      stride *= axes[at].values.length;
    }
    return found;
  }

  function placeOf(model, wanted) {
    return wanted.reduce((sum, index, at) => sum + index * model.strides[at], 0);
  }

  function indices(model, place) {
    return model.axes.map((axis, at) => Math.floor(place / model.strides[at]) % axis.values.length);
  }

  /** A sweep ready to be looked at: axes, points with their runs, measures by name. */
  function sweep(section) {
    const axes = section.axes.map(completed);
    const model = { section, axes, strides: strides(axes), labels: section.labels };
    model.runs = section.runs;
    model.count = section.runs.label.length;
    model.measures = new Map((section.measures ?? []).map((measure) => [measure.name, measure]));
    model.points = new Map();
    for (let run = 0; run < model.count; run += 1) {
      const place = placeOf(
        model,
        section.runs.places.map((column) => column[run]),
      );
      if (!model.points.has(place)) {
        model.points.set(place, []);
      }
      model.points.get(place).push(run);
    }
    model.placeOfRun = new Map(
      [...model.points].flatMap(([place, runs]) => runs.map((run) => [run, place])),
    );
    model.failed = failures(model, section.failed);
    model.stored = Int16Array.from(section.runs.label);
    model.rules = section.rules ?? null;
    return model;
  }

  function failures(model, failed) {
    const found = new Map();
    (failed?.message ?? []).forEach((message, index) => {
      const place = placeOf(
        model,
        failed.places.map((column) => column[index]),
      );
      const entry = { seed: failed.seed?.[index] ?? null, message };
      found.set(place, [...(found.get(place) ?? []), entry]);
    });
    return found;
  }

  /**
   * The label of most runs of a point and their share; of equally frequent ones the first in the
   * list of labels.
   */
  function majority(runs, labels) {
    const votes = new Map();
    runs.forEach((run) => votes.set(labels[run], (votes.get(labels[run]) ?? 0) + 1));
    let best = [Infinity, 0];
    for (const [label, count] of votes) {
      if (count > best[1] || (count === best[1] && label < best[0])) {
        best = [label, count];
      }
    }
    return { label: best[0], agreement: best[1] / runs.length };
  }

  /** The mean of a measure, or other values of runs, over the runs that have it. */
  function mean(measure, runs) {
    const values = runs.map((run) => measure.values[run]).filter((value) => Number.isFinite(value));
    return values.length === 0
      ? NaN
      : values.reduce((sum, value) => sum + value, 0) / values.length;
  }

  /** A label's name as figures write it. */
  function labelName(label) {
    return label.name.replace(/-/g, " ");
  }

  return {
    read,
    written,
    shown,
    label,
    measureWords,
    measureNodes,
    placeWords,
    placeOf,
    indices,
    sweep,
    majority,
    mean,
    labelName,
  };
})();

/** How the cells of a slice look, and which runs are selected. */
report.looks = (() => {
  const { placeOf, majority, mean } = report.data;
  const { safe, faded } = report.colors;

  /** Certainty below which a place is in the bands of 68 and 95 %, and what is left of its colour. */
  const BANDS = [
    [0.84, 0.45],
    [0.975, 0.75],
  ];

  /** The places of a slice: [column][row], each with its runs, from the lower left corner. */
  function slice(model, state) {
    const columns = model.axes[state.x].values.length;
    const rows = state.y < 0 ? 1 : model.axes[state.y].values.length;
    const wanted = [...state.slice];
    const cells = [];
    for (let row = 0; row < rows; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        wanted[state.x] = column;
        if (state.y >= 0) {
          wanted[state.y] = row;
        }
        const place = placeOf(model, wanted);
        cells.push({ place, column, row, runs: model.points.get(place) ?? null });
      }
    }
    return { columns, rows, cells };
  }

  /** The ground of a cell without runs. */
  function empty(model, cell) {
    return {
      fill: report.patterns.cellUrl(model.failed.has(cell.place) ? "failed" : "missing"),
      label: null,
      group: null,
    };
  }

  /** A cell of the map of labels. */
  function ofLabel(model, cell, labels, usesLattice) {
    const lattice = usesLattice ? model.section.lattice : null;
    if (lattice) {
      return ofLattice(model, cell, labels, lattice);
    }
    if (cell.runs === null) {
      return empty(model, cell);
    }
    const { label, agreement } = majority(cell.runs, labels);
    if (agreement <= 0.5 && cell.runs.length > 1) {
      return {
        fill: report.patterns.cellUrl("divided"),
        label: null,
        group: null,
        isDivided: true,
      };
    }
    return { ...ofColor(model, label, agreement), agreement };
  }

  function ofColor(model, label, agreement) {
    const { color, hatched } = model.labels[label];
    return {
      label,
      group: label,
      fill: hatched ? report.patterns.cellUrl("hatched") : faded(safe(color), agreement),
    };
  }

  /** A place of a refined sweep: its most probable label, paler near a border. */
  function ofLattice(model, cell, labels, lattice) {
    const label = lattice.label[cell.place];
    const certainty = lattice.certainty[cell.place];
    const band = BANDS.find(([bound]) => certainty < bound);
    const look = { ...ofColor(model, label, band ? band[1] : 1), certainty };
    if (cell.runs === null) {
      return look;
    }
    const own = majority(cell.runs, labels).label;
    return { ...look, dot: own === label ? "#000000" : safe(model.labels[own].color) };
  }

  /** A cell of the map of a measure. */
  function ofMeasure(model, cell, labels, measure, ramp) {
    const { group } = ofLabel(model, cell, labels, true);
    const value = cell.runs === null ? NaN : mean(measure, cell.runs);
    if (!Number.isFinite(value) || ramp === null) {
      return { ...empty(model, cell), group, value };
    }
    return { fill: ramp.color(value), label: null, group, value };
  }

  /** The colours of a measure over all points of the sweep, so that slices compare. */
  function rampOf(model, measure) {
    const values = [...model.points.values()].map((runs) => mean(measure, runs));
    return report.colors.ramp(values, measure.range === "signed");
  }

  /** The cells of a slice with their looks. */
  function of(model, state, labels, { usesLattice = true, map = state.map } = {}) {
    const grid = slice(model, state);
    const measure = map === "label" ? null : model.measures.get(map);
    const ramp = measure ? rampOf(model, measure) : null;
    const cells = grid.cells.map((cell) => ({
      ...cell,
      ...(measure
        ? ofMeasure(model, cell, labels, measure, ramp)
        : ofLabel(model, cell, labels, usesLattice)),
      isUnsteady: isUnsteady(model, cell),
    }));
    const hasCurves = usesLattice && Boolean(model.section.lattice);
    return { ...grid, cells, ramp, measure, hasCurves };
  }

  function isUnsteady(model, cell) {
    const steady = model.runs.steady;
    return steady && cell.runs !== null && cell.runs.some((run) => steady[run] === 0);
  }

  /** The values of what a scatter can show: a measure, or an axis by "axis:NAME". */
  function valuesOf(model, name) {
    const axis = model.axes.findIndex((it) => name === `axis:${it.name}`);
    if (axis >= 0) {
      return model.runs.places[axis].map((index) => model.axes[axis].values[index]);
    }
    return model.measures.get(name).values;
  }

  function isRange(range) {
    return Array.isArray(range) && range.length === 2 && range.every(Number.isFinite);
  }

  /** Whether something read from an address is a selection of this sweep. */
  function isSelection(model, found) {
    if (found === null || typeof found !== "object") {
      return false;
    }
    if (Array.isArray(found.labels)) {
      return found.labels.every((label) => Number.isInteger(label) && label in model.labels);
    }
    const ranges = Object.entries(found.cells ?? found.measures ?? {});
    const isKnown = (name) =>
      found.cells ? Number(name) in model.axes : model.scatterNames.includes(name);
    return ranges.length > 0 && ranges.every(([name, range]) => isKnown(name) && isRange(range));
  }

  /** Whether each run is selected; null if there is no selection. */
  function selected(model, selection) {
    if (selection === null) {
      return null;
    }
    if (selection.labels) {
      return Array.from(model.stored, (label) => selection.labels.includes(label));
    }
    const ranges = Object.entries(selection.cells ?? selection.measures).map(
      ([name, [low, high]]) => [
        selection.cells ? model.runs.places[name] : valuesOf(model, name),
        low,
        high,
      ],
    );
    return Array.from({ length: model.count }, (_, run) =>
      ranges.every(
        ([values, low, high]) => values[run] !== null && values[run] >= low && values[run] <= high,
      ),
    );
  }

  return { slice, of, valuesOf, isSelection, selected };
})();

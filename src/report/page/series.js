/** Columns over time: a chart for each chosen column, a line for each run. */
report.series = (() => {
  const { create, draw } = report.dom;
  const { nodes, labelled } = report.markup;
  const { format, withUnit } = report.numbers;

  /** Switches for the columns; `chosen` gives the names. `update` follows what was chosen elsewhere. */
  function chooser(columns, chosen, put) {
    const box = (column) => {
      const input = create("input", { type: "checkbox", name: `column-${column.name}` });
      input.checked = chosen().includes(column.name);
      input.addEventListener("change", () => {
        const names = columns.map((it) => it.name);
        const wanted = input.checked
          ? [...chosen(), column.name]
          : chosen().filter((name) => name !== column.name);
        put(names.filter((name) => wanted.includes(name)));
      });
      return create(
        "label",
        { class: "pill", title: column.description ?? null },
        input,
        create("span", {}, nodes(column.quantity)),
      );
    };
    const element = create(
      "div",
      { class: "pills", role: "group", "aria-label": "Columns over time" },
      columns.map(box),
    );
    const update = () =>
      element.querySelectorAll("input").forEach((input) => {
        input.checked = chosen().includes(input.name.slice("column-".length));
      });
    return { element, update };
  }

  /** The index of the time nearest to one. */
  function nearestTime(time, wanted) {
    let [low, high] = [0, time.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      [low, high] = time[middle] < wanted ? [middle, high] : [low, middle];
    }
    return wanted - time[low] < time[high] - wanted ? low : high;
  }

  /** A chart of a column of some runs: [{name, color, time, values}]. */
  function chart(width, column, runs, isLast, least) {
    const height = isLast ? 196 : 176;
    const frame = report.chart.frame({
      width,
      height,
      least,
      name: `${column.quantity} over time`,
      x: {
        ends: ends(runs.flatMap((run) => [run.time[0], run.time[run.time.length - 1]])),
        label: isLast ? "time (s)" : "",
      },
      y: {
        ends: report.scales.ends(runs.flatMap((run) => Array.from(run.values))),
        label: labelled(column.quantity, column.unit),
      },
    });
    frame.body.append(
      ...runs.map((run) =>
        draw("path", {
          class: "line",
          stroke: run.color,
          d: report.chart.path(
            Array.from(run.time, (time, index) => [time, run.values[index]]),
            frame.x,
            frame.y,
          ),
        }),
      ),
      ...settled(frame, runs),
    );
    return { ...frame, column, runs };
  }

  /** Lines where runs settled, with the word at the last of them. */
  function settled({ x, plot }, runs) {
    const found = runs.filter((run) => run.settled >= x.low && run.settled <= x.high);
    if (found.length === 0) {
      return [];
    }
    const last = x.at(Math.max(...found.map((run) => run.settled)));
    const isLeft = last > plot.right - 56;
    const lines = found.map((run) =>
      draw("path", {
        class: "settled",
        stroke: run.color,
        d: `M${x.at(run.settled)} ${plot.top}V${plot.bottom}`,
      }),
    );
    const word = draw(
      "text",
      {
        class: "settled-word",
        x: last + (isLeft ? -4 : 4),
        y: plot.top + 13,
        "text-anchor": isLeft ? "end" : "start",
      },
      "settled",
    );
    return [...lines, word];
  }

  function ends(values) {
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return low < high ? [low, high] : [low - 0.5, high + 0.5];
  }

  /** A line through all charts at one time, with the values there. */
  function attachCrosshair(charts) {
    const lines = charts.map(({ body }) => body.appendChild(draw("path", { class: "crosshair" })));
    const put = (at, chart, anchor) => {
      const time = chart.x.value(at);
      charts.forEach((other, index) => {
        const place = other.x.at(time);
        const isInside = place >= other.plot.left && place <= other.plot.right;
        lines[index].setAttribute(
          "d",
          isInside ? `M${place} ${other.plot.top}V${other.plot.bottom}` : "",
        );
      });
      const rows = charts.flatMap((other) =>
        other.runs.map((run) => {
          const index = nearestTime(run.time, time);
          return [
            create(
              "span",
              {},
              key(run.color),
              nodes(other.column.quantity),
              other.runs.length > 1 ? [" (", nodes(run.name), ")"] : "",
            ),
            withUnit(run.values[index], other.column.unit),
          ];
        }),
      );
      report.tooltip.show(
        [
          create("p", { class: "tooltip-place" }, `t = ${format(time)} s`),
          report.tooltip.rows(rows),
        ],
        anchor,
      );
      return `time ${format(time)} s: ${rows.map((row) => row[1]).join(", ")}`;
    };
    const leave = () => {
      lines.forEach((line) => line.setAttribute("d", ""));
      report.tooltip.hide();
    };
    charts.forEach((chart) => {
      let at = chart.plot.left;
      chart.svg.setAttribute("tabindex", "0");
      chart.svg.addEventListener("pointermove", (event) => {
        at = report.chart.local(chart.svg, event)[0];
        put(Math.min(chart.plot.right, Math.max(chart.plot.left, at)), chart, [
          event.clientX,
          event.clientY,
        ]);
      });
      chart.svg.addEventListener("pointerleave", leave);
      chart.svg.addEventListener("blur", leave);
      chart.svg.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (step) {
          event.preventDefault();
          const width = (chart.plot.right - chart.plot.left) / 50;
          at = Math.min(chart.plot.right, Math.max(chart.plot.left, at + step * width));
          const words = put(at, chart, report.chart.onScreen(chart.svg, [at, chart.plot.top + 20]));
          report.tooltip.say(words);
        }
      });
    });
  }

  function key(color) {
    return draw(
      "svg",
      { class: "line-key", width: 14, height: 8, "aria-hidden": "true" },
      draw("path", { class: "line", stroke: color, d: "M0 4H14" }),
    );
  }

  /**
   * Charts of the chosen columns. `runs` are {name, color, settled?, time, columns}, with columns
   * in the order of the list.
   */
  function charts(columns, runs, chosen) {
    const element = create("div", { class: "charts" });
    const shown = columns
      .map((column, index) => [column, index])
      .filter(([column]) => chosen.includes(column.name));
    report.dom.responsive(element, (width) => {
      const make = (least) =>
        shown.map(([column, index], place) =>
          chart(
            width,
            column,
            runs.map((run) => ({ ...run, values: run.columns[index] })),
            place === shown.length - 1,
            least,
          ),
        );
      const widest = Math.max(0, ...make(0).map(({ plot }) => plot.left));
      const drawn = make(widest);
      element.replaceChildren(...drawn.map(({ svg }) => svg));
      attachCrosshair(drawn);
    });
    return element;
  }

  /** Which line is which run. */
  function keys(runs) {
    return runs.length < 2
      ? ""
      : create(
          "p",
          { class: "keys" },
          runs.map((run) =>
            create("span", {}, key(run.color), create("span", { dir: "auto" }, nodes(run.name))),
          ),
        );
  }

  return { chooser, charts, keys };
})();

/** Sections on studies: work and precision, ablation; and charts of lines. */
report.studies = (() => {
  const { create, draw } = report.dom;
  const { nodes, labelled, plain } = report.markup;
  const { format, withUnit, percent } = report.numbers;

  function cells(values) {
    return values.map((value) =>
      create("td", {}, typeof value === "number" ? format(value) : (value ?? "–")),
    );
  }

  /** A table of rows under heads; the first cell of each row is its name. */
  function table(caption, heads, rows) {
    return create(
      "div",
      { class: "scroll" },
      create(
        "table",
        { class: "numbers" },
        create("caption", {}, caption),
        create(
          "thead",
          {},
          create(
            "tr",
            {},
            heads.map((head) => create("th", { scope: "col" }, nodes(head))),
          ),
        ),
        create(
          "tbody",
          {},
          rows.map(([name, ...values]) =>
            create("tr", {}, create("th", { scope: "row" }, name), cells(values)),
          ),
        ),
      ),
    );
  }

  function notes(section) {
    return (section.notes ?? []).map((note) => create("p", { class: "note" }, note));
  }

  function keys(entries) {
    return create(
      "p",
      { class: "keys" },
      entries.map(([name, color, isDashed]) =>
        create(
          "span",
          {},
          draw(
            "svg",
            { class: "line-key", width: 20, height: 8, "aria-hidden": "true" },
            draw("path", { class: isDashed ? "line dashed" : "line", stroke: color, d: "M0 4H20" }),
          ),
          create("span", { dir: "auto" }, nodes(name)),
        ),
      ),
    );
  }

  function color(index) {
    return index === 0 ? "var(--line)" : report.colors.distinct(index);
  }

  /** Error against processor time of settings, in lines of one method. */
  function accuracy(section) {
    const { settings, work, error } = section;
    const methods = [...new Set(settings.map((it) => it.method).filter(Boolean))];
    const host = create("div", { class: "scatter" });
    report.dom.responsive(host, (width) => {
      const drawn = settings.filter((it) => it.work > 0 && it.error > 0);
      const limits = section.allowed ? [section.allowed] : [];
      const frame = report.chart.frame({
        width,
        height: Math.min(520, Math.max(300, width * 0.62)),
        name: `${error.quantity} against ${work.quantity}`,
        x: {
          kind: "logarithmic",
          ends: report.scales.ends(
            drawn.map((it) => it.work),
            "logarithmic",
          ),
          label: labelled(work.quantity, work.unit),
        },
        y: {
          kind: "logarithmic",
          ends: report.scales.ends([...drawn.map((it) => it.error), ...limits], "logarithmic"),
          label: labelled(error.quantity, error.unit),
        },
      });
      frame.body.append(
        ...limits.map((limit) =>
          draw("path", {
            class: "line dashed",
            stroke: "currentColor",
            d: `M${frame.plot.left} ${frame.y.at(limit)}H${frame.plot.right}`,
          }),
        ),
      );
      methods.forEach((method, index) => {
        const own = drawn
          .filter((it) => it.method === method)
          .sort((one, other) => one.work - other.work);
        const points = own.map((it) => [it.work, it.error]);
        frame.body.append(
          draw("path", {
            class: "line",
            stroke: color(index),
            d: report.chart.path(points, frame.x, frame.y),
          }),
          ...own.map((it) => intervalMark(frame, it, color(index))),
        );
      });
      const bases = drawn.filter((it) => it.is_base);
      frame.body.append(
        ...bases.map((it) =>
          draw("circle", {
            class: "base",
            cx: frame.x.at(it.work),
            cy: frame.y.at(it.error),
            r: 8,
          }),
        ),
      );
      report.chart.attachPlaces(
        frame,
        drawn
          .map((it) => settingPlace(frame, it, section))
          .sort((one, other) => one.at[0] - other.at[0]),
      );
      host.replaceChildren(frame.svg);
    });
    const heads = [
      "setting",
      labelled(work.quantity, work.unit),
      labelled(error.quantity, error.unit),
      ...(section.columns ?? []).map((it) => labelled(it.quantity, it.unit)),
    ];
    return create(
      "section",
      { class: "study" },
      notes(section),
      host,
      keys([
        ...methods.map((method, index) => [method, color(index)]),
        ...(section.allowed ? [["allowed error", "currentColor", true]] : []),
      ]),
      settings.some((it) => it.is_base)
        ? create("p", { class: "muted" }, "The ring is the scene as it is.")
        : "",
      table(
        "Settings",
        heads,
        settings.map((it, index) => [
          it.name,
          it.work,
          it.error,
          ...(section.columns ?? []).map((column) => column.values[index]),
        ]),
      ),
    );
  }

  function intervalMark(frame, { work, error, low, high }, stroke) {
    const x = frame.x.at(work);
    const bar =
      low > 0 && high > 0
        ? draw("path", { class: "line", stroke, d: `M${x} ${frame.y.at(low)}V${frame.y.at(high)}` })
        : "";
    return draw("g", {}, bar, draw("circle", { cx: x, cy: frame.y.at(error), r: 4, fill: stroke }));
  }

  function settingPlace(frame, setting, { work, error }) {
    const rows = [
      [nodes(work.quantity), withUnit(setting.work, work.unit)],
      [nodes(error.quantity), withUnit(setting.error, error.unit)],
    ];
    return {
      at: [frame.x.at(setting.work), frame.y.at(setting.error)],
      tell: () => [
        create("p", { class: "tooltip-place" }, setting.name),
        report.tooltip.rows(rows),
      ],
      say: `${setting.name}: ${plain(work.quantity)} ${withUnit(setting.work, work.unit)}, ${plain(error.quantity)} ${withUnit(setting.error, error.unit)}`,
    };
  }

  const VERDICTS = { needed: "var(--line)", undecided: "#e69f00", "not needed": "#009e73" };

  /** Effects with the share of labels that change without them, and what they cost. */
  function ablation(section) {
    const host = create("div", { class: "scatter" });
    const { effects } = section;
    report.dom.responsive(host, (width) => host.replaceChildren(ablationChart(effects, width)));
    const verdicts = [...new Set(effects.map((it) => it.verdict))];
    return create(
      "section",
      { class: "study" },
      notes(section),
      host,
      keys(verdicts.map((verdict) => [verdict, VERDICTS[verdict] ?? report.colors.distinct(3)])),
      table(
        "Effects",
        [
          "without",
          "verdict",
          "labels changed beyond the noise of seeds",
          "from",
          "to",
          "processor time / that of the scene as it is",
        ],
        effects.map((it) => [
          it.name,
          it.verdict,
          percentOf(it.changed),
          percentOf(it.low),
          percentOf(it.high),
          it.time_ratio,
        ]),
      ),
    );
  }

  function percentOf(share) {
    return Number.isFinite(share) ? percent(share).replace("-", "−") : "–";
  }

  function ablationChart(effects, width) {
    const isNarrow = width < 560;
    const step = isNarrow ? 44 : 30;
    const left = isNarrow
      ? 14
      : Math.min(0.45 * width, 16 + 6.8 * Math.max(...effects.map((it) => it.name.length)));
    const [low, high] = report.scales.ends(
      effects.flatMap((it) => [100 * it.low, 100 * it.high, 0]).filter(Number.isFinite),
    );
    const scale = report.scales.scale("linear", [low, high], [left, width - 16]);
    const bottom = 12 + step * effects.length;
    const svg = draw("svg", {
      class: "chart",
      viewBox: `0 0 ${width} ${bottom + 48}`,
      width,
      height: bottom + 48,
      role: "img",
      "aria-label": "Labels changed beyond the noise of seeds, by effect left out",
    });
    report.scales.ticks(scale).forEach((tick) =>
      svg.append(
        draw("line", {
          class: tick === 0 ? "zero" : "grid",
          x1: scale.at(tick),
          x2: scale.at(tick),
          y1: 8,
          y2: bottom,
        }),
        draw(
          "text",
          { class: "tick-label", x: scale.at(tick), y: bottom + 16, "text-anchor": "middle" },
          format(tick),
        ),
      ),
    );
    svg.append(
      draw(
        "text",
        { class: "axis-label", x: (left + width) / 2, y: bottom + 38, "text-anchor": "middle" },
        "labels changed beyond the noise of seeds (%)",
      ),
    );
    const places = effects.map((effect, index) => {
      const y = 12 + step * (index + (isNarrow ? 0.72 : 0.5));
      const stroke = VERDICTS[effect.verdict] ?? report.colors.distinct(3);
      const at = [scale.at(100 * effect.changed), y];
      svg.append(
        draw(
          "text",
          {
            class: "row-label",
            x: isNarrow ? left : left - 12,
            y: isNarrow ? y - 14 : y + 4,
            "text-anchor": isNarrow ? "start" : "end",
          },
          report.markup.shortened(
            effect.name,
            Math.floor((isNarrow ? width - 28 : left - 16) / 6.6),
          ),
        ),
        draw("path", {
          class: "line",
          stroke,
          d: `M${scale.at(100 * effect.low)} ${y}H${scale.at(100 * effect.high)}`,
        }),
        draw("circle", { cx: at[0], cy: y, r: 5, fill: stroke }),
      );
      const words = `${percentOf(effect.changed)}, from ${percentOf(effect.low)} to ${percentOf(effect.high)}`;
      return {
        at,
        say: `without ${effect.name}: ${effect.verdict}, ${words}`,
        tell: () => [
          create("p", { class: "tooltip-place" }, `without: ${effect.name}`),
          report.tooltip.rows([
            ["verdict", effect.verdict],
            ["labels changed", words],
            ["time ratio", format(effect.time_ratio)],
          ]),
        ],
      };
    });
    const body = draw("g");
    svg.append(body);
    report.chart.attachPlaces({ svg, body }, places);
    return svg;
  }

  /** A chart of lines: {title, x, y, lines: [{name, x, y}]}. */
  function lines({ title, x, y, lines: all }) {
    const host = create("div", { class: "scatter" });
    const axis = (it, values) => ({
      kind: it.scale ?? "linear",
      ends: report.scales.ends(values, it.scale ?? "linear"),
      label: labelled(it.quantity, it.unit),
    });
    report.dom.responsive(host, (width) => {
      const frame = report.chart.frame({
        width,
        height: Math.min(400, Math.max(240, width * 0.55)),
        name: title,
        x: axis(
          x,
          all.flatMap((line) => line.x),
        ),
        y: axis(
          y,
          all.flatMap((line) => line.y),
        ),
      });
      frame.body.append(
        ...all.map((line, index) =>
          draw("path", {
            class: "line",
            stroke: color(index),
            d: report.chart.path(
              line.x.map((value, at) => [value, line.y[at]]),
              frame.x,
              frame.y,
            ),
          }),
        ),
      );
      report.chart.attachPlaces(
        frame,
        all.flatMap((line) => linePlaces(frame, line, x, y)),
      );
      host.replaceChildren(frame.svg);
    });
    return create(
      "section",
      { class: "block" },
      create("h4", {}, nodes(title)),
      host,
      keys(all.map((line, index) => [line.name, color(index)])),
    );
  }

  function linePlaces(frame, line, x, y) {
    return line.x
      .map((value, at) => ({
        at: [frame.x.at(value), frame.y.at(line.y[at])],
        say: `${line.name}: ${format(value)}, ${format(line.y[at])}`,
        tell: () => [
          create("p", { class: "tooltip-place" }, line.name),
          report.tooltip.rows([
            [nodes(x.quantity), withUnit(value, x.unit)],
            [nodes(y.quantity), withUnit(line.y[at], y.unit)],
          ]),
        ],
      }))
      .filter((place) => place.at.every(Number.isFinite));
  }

  return { accuracy, ablation, lines };
})();

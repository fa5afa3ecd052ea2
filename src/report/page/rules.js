/** Labels from stored evidence and thresholds. */
report.rules = (() => {
  const COMPARE = {
    ">=": (value, threshold) => value >= threshold,
    ">": (value, threshold) => value > threshold,
    "<=": (value, threshold) => value <= threshold,
    "<": (value, threshold) => value < threshold,
  };

  /** The thresholds as they are stored. */
  function stored(rules) {
    return Object.fromEntries(rules.thresholds.map(({ key, value }) => [key, value]));
  }

  /** The values that a comparison looks at, which may depend on another threshold. */
  function column(comparison, measures, rules, thresholds) {
    if (comparison.measure) {
      return measures.get(comparison.measure)?.values ?? [];
    }
    if (comparison.values) {
      return comparison.values;
    }
    const { key, columns } = comparison.by;
    const { stops } = rules.thresholds.find((threshold) => threshold.key === key);
    return columns[Math.max(0, stops.indexOf(thresholds[key]))];
  }

  function limit(comparison, thresholds) {
    return typeof comparison.threshold === "string"
      ? thresholds[comparison.threshold]
      : comparison.threshold;
  }

  /** A rule ready to be asked for each run. */
  function prepare(rule, measures, rules, thresholds) {
    const comparisons = (rule.comparisons ?? []).map((comparison) => ({
      values: column(comparison, measures, rules, thresholds),
      limit: limit(comparison, thresholds),
      holds: COMPARE[comparison.order],
    }));
    const verdict = rule.stored ?? null;
    return {
      label: rule.label,
      holds: (run) =>
        (verdict === null || verdict[run] === 1) &&
        comparisons.every((comparison) => {
          const value = comparison.values[run];
          return value !== null && value !== undefined && comparison.holds(value, comparison.limit);
        }),
    };
  }

  /** The label of every run: that of the first rule that holds; fixed labels stay. */
  function relabel(rules, measures, labels, thresholds) {
    const ready = rules.list.map((rule) => prepare(rule, measures, rules, thresholds));
    const fixed = new Set(rules.fixed ?? []);
    return Int16Array.from(labels, (label, run) => {
      if (fixed.has(label)) {
        return label;
      }
      const first = ready.find((rule) => rule.holds(run));
      return first ? first.label : rules.otherwise;
    });
  }

  /** How a run gets its label, rule by rule: {label, holds, comparisons: [{rule, value, limit, holds}]}. */
  function explain(rules, measures, thresholds, run) {
    return rules.list.map((rule) => {
      const comparisons = (rule.comparisons ?? []).map((comparison) => {
        const value = column(comparison, measures, rules, thresholds)[run] ?? null;
        const against = limit(comparison, thresholds);
        const holds = value !== null && COMPARE[comparison.order](value, against);
        return { comparison, value, limit: against, holds };
      });
      const stored = rule.stored ? rule.stored[run] === 1 : null;
      const holds = stored !== false && comparisons.every((it) => it.holds);
      return { rule, stored, comparisons, holds };
    });
  }

  /** What comparisons read in place of stored evidence, as its threshold moved: {name, values}. */
  function replaced(rules, measures, thresholds) {
    const keys = new Set(moved(rules, thresholds).map(({ key }) => key));
    return rules.list
      .flatMap((rule) => rule.comparisons ?? [])
      .filter(({ by }) => by && keys.has(by.key))
      .map((it) => ({ name: it.name, values: column(it, measures, rules, thresholds) }));
  }

  /** The thresholds that differ from the stored ones. */
  function moved(rules, thresholds) {
    return rules.thresholds.filter(({ key, value }) => thresholds[key] !== value);
  }

  function tomlNumber(value, isWhole) {
    const text = String(value);
    return isWhole || /[.e]/.test(text) ? text : `${text}.0`;
  }

  /** What to write into the sweep file, table by table. */
  function toml(rules, thresholds) {
    const tables = new Map();
    const snippets = [];
    for (const threshold of moved(rules, thresholds)) {
      const value = tomlNumber(thresholds[threshold.key], threshold.is_whole);
      if (threshold.toml) {
        snippets.push(threshold.toml.split("{value}").join(value));
        continue;
      }
      const parts = threshold.key.split(".");
      const leaf = parts.pop();
      const table = parts.join(".");
      tables.set(table, [...(tables.get(table) ?? []), `${leaf} = ${value}`]);
    }
    const written = [...tables].map(([table, lines]) =>
      [table && `[${table}]`, ...lines].filter(Boolean).join("\n"),
    );
    return [...written, ...snippets].join("\n\n");
  }

  return { stored, relabel, explain, replaced, moved, toml };
})();

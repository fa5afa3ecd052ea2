/** The scene file of a run: the base text with what differs put in and marked. */
report.scene = (() => {
  const { create } = report.dom;

  /**
   * Lines {text, state, key, was}: state is "same", "changed", "added" or "removed", `was` the
   * value of the base that is changed.
   */
  function lines(text, changes) {
    const found = text
      .replace(/\n+$/, "")
      .split("\n")
      .map((line) => ({ text: line, state: "same" }));
    changes.forEach(([key, value]) => change(found, key, value));
    return found;
  }

  function change(found, key, value) {
    const { at, end } = find(found, key);
    if (at >= 0 && value === null) {
      Object.assign(found[at], { state: "removed", key });
    } else if (at >= 0) {
      replace(found[at], key, value);
    } else if (value !== null) {
      insert(found, key, value, end);
    }
  }

  /** The line of a key, and the end of its table; -1 for what is not there. */
  function find(found, key) {
    const table = key.split(".").slice(0, -1).join(".");
    const leaf = key.split(".").pop();
    let current = "";
    let end = table === "" ? 0 : -1;
    for (const [index, { text }] of found.entries()) {
      const header = /^\s*\[+([^\]]+)\]+/.exec(text);
      current = header ? header[1].trim() : current;
      if (current === table) {
        end = text.trim() === "" ? end : index + 1;
        const assigned = /^\s*([\w-]+)\s*=/.exec(text);
        if (!header && assigned && assigned[1] === leaf) {
          return { at: index, end };
        }
      }
    }
    return { at: -1, end };
  }

  function replace(line, key, value) {
    const end = line.text.indexOf("=") + 1;
    const text = `${line.text.slice(0, end)} ${value}`;
    if (text !== line.text) {
      const was = line.text.slice(end).trim();
      Object.assign(line, { text, state: "changed", key, was });
    }
  }

  function insert(found, key, value, end) {
    const leaf = key.split(".").pop();
    const line = { text: `${leaf} = ${value}`, state: "added", key };
    if (end >= 0) {
      found.splice(end, 0, line);
      return;
    }
    const table = key.split(".").slice(0, -1).join(".");
    found.push({ text: "", state: "same" }, { text: `[${table}]`, state: "added" }, line);
  }

  /** A line with what the base has in its place. */
  function lineNodes(line, text = line.text) {
    return [
      line.state === "same" ? text : create("mark", {}, text),
      line.was ? create("span", { class: "was" }, `   # sweep: ${line.was}`) : "",
    ];
  }

  /** The whole file. */
  function box(lines) {
    const rows = lines.map((line) =>
      create("span", { class: `scene-line ${line.state}` }, lineNodes(line), "\n"),
    );
    return create("pre", { class: "scene", tabindex: 0, "aria-label": "Scene file" }, rows);
  }

  /** The lines that differ, each with the table of its key. */
  function differing(lines) {
    const rows = lines
      .filter((line) => line.key)
      .map((line) => {
        const table = line.key.split(".").slice(0, -1);
        const text = [...table, line.text.trim()].join(".");
        return create("li", { class: `scene-line ${line.state}` }, lineNodes(line, text));
      });
    return create("ul", { class: "differing" }, rows);
  }

  /** The keys in which a run differs from the base, with their values as TOML. */
  function changesOf(model, run) {
    const own = model.runs.changes?.[run];
    if (own) {
      return own;
    }
    const ofAxes = model.axes.flatMap((axis, at) => {
      const index = model.runs.places[at][run];
      if (axis.changes) {
        return axis.changes[index];
      }
      return axis.key ? [[axis.key, report.data.written(axis, index)]] : [];
    });
    const seed = model.runs.seed?.[run];
    return seed === null || seed === undefined ? ofAxes : [...ofAxes, ["seed", String(seed)]];
  }

  /** A word for a shell, in quotes unless it is harmless. */
  function quoted(word) {
    return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.split("'").join("'\\''")}'`;
  }

  /** The command that makes a run again. */
  function command(model, run) {
    const parts = model.axes.map(
      (axis, at) => `${axis.name}=${report.data.written(axis, model.runs.places[at][run])}`,
    );
    const seed = model.runs.seed?.[run];
    const point = [...parts, ...(seed === null || seed === undefined ? [] : [`seed=${seed}`])].join(
      ",",
    );
    const words = {
      point: quoted(point),
      id: quoted(String(model.runs.id?.[run] ?? "run")),
      seed: quoted(String(seed)),
    };
    return model.section.command.replace(/\{(point|id|seed)\}/g, (_, name) => words[name]);
  }

  return { lines, box, differing, changesOf, command };
})();

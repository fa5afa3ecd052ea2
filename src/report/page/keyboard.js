/** Keys on maps: arrows move, Enter pins, Escape lets go, Shift and arrows select. */
report.keyboard = (() => {
  const STEPS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

  function attach(map, labels) {
    const { element, model, store } = map;
    let anchor = null;
    const current = () => {
      const place = store.state.cursor ?? store.state.pin;
      return map.grid.cells.find((cell) => cell.place === place) ?? null;
    };
    const tell = (cell) => {
      const { x, y, width, height } = report.map.box(map.place, cell);
      const at = report.chart.onScreen(map.place.svg, [x + width, y + height / 2]);
      report.tooltip.show(report.hover.tell(map, cell, labels()), at);
      report.tooltip.say(report.hover.say(model, cell, labels(), map.grid));
    };
    const move = (event, [right, up]) => {
      const from = current();
      const { columns, rows, cells } = map.grid;
      const column = from ? clamp(from.column + right, columns) : 0;
      const row = from ? clamp(from.row + up, rows) : 0;
      const cell = cells[row * columns + column];
      store.set({ cursor: cell.place });
      tell(cell);
      anchor = event.shiftKey ? (anchor ?? from ?? cell) : null;
      if (event.shiftKey) {
        store.set({ selection: report.hover.cellsSelection(store.state, [anchor, cell]) });
      }
    };
    const end = (event) => {
      const from = current();
      const column = event.key === "Home" ? 0 : map.grid.columns - 1;
      const cell = map.grid.cells[(from?.row ?? 0) * map.grid.columns + column];
      store.set({ cursor: cell.place });
      tell(cell);
    };
    const pin = () => {
      const cell = current();
      if (cell) {
        model.pin(cell.place);
        report.tooltip.say(`Pinned. ${report.hover.say(model, cell, labels(), map.grid)}`);
      }
    };
    element.addEventListener("keydown", (event) => {
      const action = actionOf(event, { move, end, pin, release });
      if (action && map.place !== null) {
        event.preventDefault();
        action();
      }
    });
    const release = () => {
      report.tooltip.hide();
      store.set(store.state.selection === null ? { pin: null, cursor: null } : { selection: null });
      report.tooltip.say("Released.");
    };
    element.addEventListener("focus", () => {
      const cell = element.matches(":focus-visible") ? (current() ?? map.grid?.cells[0]) : null;
      if (cell) {
        store.set({ cursor: cell.place });
        tell(cell);
      }
    });
    element.addEventListener("blur", report.tooltip.hide);
  }

  function actionOf(event, { move, end, pin, release }) {
    if (event.ctrlKey || event.metaKey || event.altKey) {
      return null;
    }
    if (event.key in STEPS) {
      return () => move(event, STEPS[event.key]);
    }
    const actions = {
      Home: () => end(event),
      End: () => end(event),
      Enter: pin,
      " ": pin,
      Escape: release,
    };
    return actions[event.key] ?? null;
  }

  function clamp(index, count) {
    return Math.min(count - 1, Math.max(0, index));
  }

  return { attach };
})();

/** The note beside the pointer, and what is said to those who cannot see it. */
report.tooltip = (() => {
  const { create } = report.dom;
  const note = create("div", { class: "tooltip", role: "presentation", hidden: true });
  const live = create("div", { class: "off-screen", "aria-live": "polite", role: "status" });

  function attach() {
    document.body.append(note, live);
    window.addEventListener("scroll", hide, { passive: true });
  }

  /** Shows nodes beside a place on the screen, where there is room. */
  function show(nodes, [x, y]) {
    note.replaceChildren(...[nodes].flat());
    note.hidden = false;
    const { width, height } = note.getBoundingClientRect();
    const left = x + 18 + width < window.innerWidth ? x + 18 : Math.max(6, x - 18 - width);
    const top = Math.min(Math.max(6, y - height / 2), Math.max(6, window.innerHeight - height - 6));
    note.style.setProperty("transform", `translate(${Math.round(left)}px, ${Math.round(top)}px)`);
  }

  function hide() {
    note.hidden = true;
  }

  /** Says a text through screen readers, also if it is the one that was said last. */
  function say(text) {
    live.textContent = live.textContent === text ? `${text}\u00a0` : text;
  }

  /** Rows of names and values. */
  function rows(pairs) {
    return create(
      "dl",
      { class: "pairs" },
      pairs.map(([name, value]) =>
        create("div", {}, create("dt", {}, name), create("dd", {}, value)),
      ),
    );
  }

  return { attach, show, hide, say, rows };
})();

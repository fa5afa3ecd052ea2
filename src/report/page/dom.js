/** Elements. Text from the data becomes text nodes and attributes, never markup. */
report.dom = (() => {
  const SVG = "http://www.w3.org/2000/svg";

  function assign(element, attributes) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === null || value === undefined || value === false) {
        continue;
      }
      if (name === "on") {
        Object.entries(value).forEach(([event, listener]) =>
          element.addEventListener(event, listener),
        );
      } else {
        element.setAttribute(name, value === true ? "" : value);
      }
    }
    return element;
  }

  /** An element with attributes, listeners (`on`) and children, which may be texts or lists. */
  function create(tag, attributes = {}, ...children) {
    const element = assign(document.createElement(tag), attributes);
    element.append(...children.flat(2).filter((child) => child !== null && child !== undefined));
    return element;
  }

  /** The same in a drawing. */
  function draw(tag, attributes = {}, ...children) {
    const element = assign(document.createElementNS(SVG, tag), attributes);
    element.append(...children.flat(2).filter((child) => child !== null && child !== undefined));
    return element;
  }

  const updates = [];

  /** Draws what was hidden until now, before the browser measures it itself. */
  function refresh() {
    updates.forEach((update) => update());
  }

  /** Calls `render(width)` now and whenever the width of the element changes. */
  function responsive(element, render) {
    let known = 0;
    const update = () => {
      const width = Math.floor(element.clientWidth);
      if (width > 0 && width !== known) {
        known = width;
        render(width);
      }
    };
    new ResizeObserver(update).observe(element);
    updates.push(update);
    update();
  }

  /** A button that copies what `text` returns, and says so; `what` tells those who only hear it. */
  function copyButton(words, text, what) {
    const button = create(
      "button",
      { type: "button", class: "button copy", "aria-label": what ? `${words} ${what}` : null },
      words,
    );
    button.addEventListener("click", async () => {
      const done = await copy(text());
      button.textContent = done ? "Copied" : "Copying failed";
      report.tooltip.say(button.textContent);
      setTimeout(() => {
        button.textContent = words;
      }, 1500);
    });
    return button;
  }

  async function copy(text) {
    try {
      await navigator.clipboard.writeText(text);
      return true;
    } catch {
      return copyBySelection(text);
    }
  }

  /** For pages opened as files, where some browsers have no clipboard. */
  function copyBySelection(text) {
    const area = create("textarea", { class: "off-screen", "aria-hidden": "true" });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }

  /** A select with options [value, text]. */
  function select(attributes, options, value) {
    const element = create(
      "select",
      attributes,
      options.map(([key, text]) => create("option", { value: key, selected: key === value }, text)),
    );
    element.value = value;
    return element;
  }

  let identifiers = 0;

  function uniqueId(stem) {
    identifiers += 1;
    return `${stem}-${identifiers}`;
  }

  return { create, draw, assign, responsive, refresh, copyButton, select, uniqueId };
})();

/** Patterns, shared by all drawings of the page: of labels for the colour-blind, and of states of cells. */
report.patterns = (() => {
  const { draw } = report.dom;
  const SIZE = 8;

  /** What is drawn in a tile, by name: lines [x1, y1, x2, y2] and dots [x, y, r]. */
  const SHAPES = {
    none: {},
    rising: {
      lines: [
        [-1, 9, 9, -1],
        [-5, 5, 5, -5],
        [3, 13, 13, 3],
      ],
    },
    falling: {
      lines: [
        [-1, -1, 9, 9],
        [3, -5, 13, 5],
        [-5, 3, 5, 13],
      ],
    },
    dots: {
      dots: [
        [2, 2, 1.2],
        [6, 6, 1.2],
      ],
    },
    horizontal: { lines: [[0, 4, 8, 4]] },
    vertical: { lines: [[4, 0, 4, 8]] },
    grid: {
      lines: [
        [0, 4, 8, 4],
        [4, 0, 4, 8],
      ],
    },
    crossing: {
      lines: [
        [-1, -1, 9, 9],
        [-1, 9, 9, -1],
      ],
    },
    rings: { rings: [[4, 4, 2.2]] },
    dashes: {
      lines: [
        [0, 2, 4, 2],
        [4, 6, 8, 6],
      ],
    },
  };
  const ORDER = [
    "none",
    "rising",
    "dots",
    "horizontal",
    "crossing",
    "vertical",
    "rings",
    "falling",
    "grid",
    "dashes",
  ];

  /** Patterns of cells that have no plain label. */
  const CELLS = {
    unsteady: { shape: "falling", ink: "#000000", opacity: 0.6, ground: null },
    missing: { shape: "rising", ink: "#a8a8a8", opacity: 1, ground: "#f4f4f4" },
    failed: { shape: "grid", ink: "#b3261e", opacity: 0.8, ground: "#ffffff" },
    hatched: { shape: "crossing", ink: "#000000", opacity: 0.75, ground: "#ffffff" },
    divided: { shape: "dots", ink: "#000000", opacity: 1, ground: "#ffffff" },
  };

  function tile(id, { shape, ink, opacity, ground }) {
    const { lines = [], dots = [], rings = [] } = SHAPES[shape] ?? {};
    return draw(
      "pattern",
      { id, width: SIZE, height: SIZE, patternUnits: "userSpaceOnUse" },
      ground ? draw("rect", { width: SIZE, height: SIZE, fill: ground }) : null,
      lines.map(([x1, y1, x2, y2]) =>
        draw("line", {
          x1,
          y1,
          x2,
          y2,
          stroke: ink,
          "stroke-opacity": opacity,
          "stroke-width": 1.2,
        }),
      ),
      dots.map(([cx, cy, r]) => draw("circle", { cx, cy, r, fill: ink, "fill-opacity": opacity })),
      rings.map(([cx, cy, r]) =>
        draw("circle", { cx, cy, r, fill: "none", stroke: ink, "stroke-opacity": opacity }),
      ),
    );
  }

  function id(name) {
    return `pattern-${name}`;
  }

  /** The names of shapes for labels, those that the data names first. */
  function shapeOf(labels, index) {
    const named = labels[index].pattern;
    return named in SHAPES ? named : ORDER[index % ORDER.length];
  }

  /** Adds the patterns of these labels to the page; `url` finds them by label and ground. */
  function attach() {
    const cells = Object.entries(CELLS).map(([name, look]) => tile(id(name), look));
    const inks = [
      ["light", "#ffffff", 0.6],
      ["dark", "#000000", 0.5],
    ];
    const ofLabels = Object.keys(SHAPES)
      .filter((shape) => shape !== "none")
      .flatMap((shape) =>
        inks.map(([ink, color, opacity]) =>
          tile(id(`${shape}-${ink}`), { shape, ink: color, opacity }),
        ),
      );
    document.body.append(
      draw(
        "svg",
        { class: "off-screen", width: 0, height: 0, "aria-hidden": "true" },
        draw("defs", {}, cells, ofLabels),
      ),
    );
  }

  function cellUrl(name) {
    return `url(#${id(name)})`;
  }

  /** The pattern of a label on its own colour; null for none. */
  function labelUrl(labels, index) {
    const shape = shapeOf(labels, index);
    const ink = report.colors.isDark(report.colors.safe(labels[index].color)) ? "light" : "dark";
    return shape === "none" ? null : `url(#${id(`${shape}-${ink}`)})`;
  }

  return { attach, cellUrl, labelUrl };
})();

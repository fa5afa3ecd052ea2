/** The markup of figures: `$...$` is mathematics, oblique; within it `_x` and `_{xyz}` are subscripts. */
report.markup = (() => {
  const { create, draw } = report.dom;

  /** Mean width of a letter of a drawing in pixels. */
  const LETTER = 7;

  /** Pieces {text, oblique, subscript}. An odd number of `$` is taken literally. */
  function pieces(text) {
    const parts = String(text).split("$");
    if (parts.length % 2 === 0) {
      return [{ text: String(text), oblique: false, subscript: false }];
    }
    return parts
      .flatMap((part, index) =>
        index % 2 === 0 ? [{ text: part, oblique: false, subscript: false }] : mathematics(part),
      )
      .filter((piece) => piece.text !== "");
  }

  function mathematics(text) {
    const found = [];
    let rest = text;
    while (rest !== "") {
      const match = /_(?:\{([^}]*)\}|(.))/u.exec(rest);
      const end = match ? match.index : rest.length;
      found.push({ text: rest.slice(0, end), oblique: true, subscript: false });
      if (match) {
        found.push({ text: match[1] ?? match[2], oblique: false, subscript: true });
      }
      rest = match ? rest.slice(end + match[0].length) : "";
    }
    return found;
  }

  /** Nodes for a page. */
  function nodes(text) {
    return pieces(text).map((piece) => {
      if (piece.subscript) {
        return create("sub", {}, piece.text);
      }
      return piece.oblique ? create("i", { class: "symbol" }, piece.text) : piece.text;
    });
  }

  /** Spans for a text of a drawing, cut where the room in pixels ends. */
  function spans(text, room = Infinity) {
    let lowered = false;
    const most = Math.max(6, Math.floor(room / LETTER));
    const all =
      plain(text).length > most
        ? [{ text: shortened(plain(text), most), oblique: false, subscript: false }]
        : pieces(text);
    return all.map((piece) => {
      const shift = Number(piece.subscript) - Number(lowered);
      lowered = piece.subscript;
      return draw(
        "tspan",
        {
          dy: shift === 0 ? null : `${0.25 * shift}em`,
          "font-size": piece.subscript ? "75%" : null,
          "font-style": piece.oblique ? "italic" : null,
        },
        piece.text,
      );
    });
  }

  /** At most so many letters. */
  function shortened(text, most) {
    return text.length > most ? `${text.slice(0, most - 1)}…` : text;
  }

  /** The text without markup. */
  function plain(text) {
    return pieces(text)
      .map((piece) => piece.text)
      .join("");
  }

  /** A quantity with its unit. */
  function labelled(quantity, unit) {
    return unit ? `${quantity} (${unit})` : quantity;
  }

  return { nodes, spans, shortened, plain, labelled };
})();

/** Why a run has its label: the rules in their order, up to the one that decides. */
report.why = (() => {
  const { create } = report.dom;
  const { labelName } = report.data;
  const { nodes } = report.markup;
  const { format } = report.numbers;

  /** How the rules decide, in their order. */
  function explanation(model, run, thresholds) {
    if (model.rules.fixed?.includes(model.stored[run])) {
      return report.details.block(
        "Why this label",
        create("p", { class: "muted" }, "The run ended this way; no threshold changes it."),
      );
    }
    const steps = report.rules.explain(model.rules, model.measures, thresholds, run);
    const decided = steps.findIndex((step) => step.holds);
    const shown = decided < 0 ? steps : steps.slice(0, decided + 1);
    const isMoved = report.rules.moved(model.rules, thresholds).length > 0;
    const items = shown.map((step) =>
      create(
        "li",
        { class: step.holds ? "holds" : "fails" },
        create(
          "span",
          { class: "rule-name" },
          labelName(model.labels[step.rule.label]),
          step.holds ? ": yes" : ": no",
        ),
        step.comparisons.map((it) => comparison(model, it)),
        step.comparisons.length === 0 || step.stored === false
          ? create(
              "span",
              { class: "muted" },
              step.stored ? " stored with the run" : " not found in the run",
            )
          : "",
      ),
    );
    const otherwise =
      decided < 0
        ? [
            create(
              "li",
              { class: "holds" },
              create(
                "span",
                { class: "rule-name" },
                labelName(model.labels[model.rules.otherwise]),
              ),
              " otherwise",
            ),
          ]
        : [];
    return report.details.block(
      isMoved ? "Why this label, with the thresholds as moved" : "Why this label",
      create("p", { class: "muted" }, "The first rule that holds decides."),
      create("ol", { class: "why" }, items, otherwise),
    );
  }

  function comparison(model, { comparison: { measure, name, order }, value, limit, holds }) {
    const known = model.measures.get(measure ?? name);
    const words = `${holds ? "" : "is not "}${{ ">=": "≥", "<=": "≤" }[order] ?? order}`;
    const told = value === null ? " has no value" : ` ${format(value)} ${words} ${format(limit)}`;
    return create(
      "span",
      { class: "comparison" },
      " ",
      nodes(known?.quantity ?? name ?? "value"),
      told,
    );
  }

  return { explanation };
})();

/** Makes the page from its document. */
report.main = (() => {
  const { create } = report.dom;

  const KINDS = {
    sweep: report.sweep.follow,
    records: (section) => ({ element: report.records.follow(section) }),
    accuracy: (section) => ({ element: report.studies.accuracy(section) }),
    ablation: (section) => ({ element: report.studies.ablation(section) }),
  };

  /** A name for files from the title: letters and digits of any script, and dashes. */
  function stemOf(title) {
    return (
      title
        .normalize("NFKC")
        .toLowerCase()
        .replace(/[^\p{L}\p{N}]+/gu, "-")
        .replace(/^-+|-+$/g, "")
        .slice(0, 60) || "phase"
    );
  }

  function head(content) {
    return create(
      "header",
      { class: "page-head" },
      create("h1", { dir: "auto" }, report.markup.nodes(content.title)),
      (content.notes ?? []).map((note) => create("p", { class: "note" }, note)),
    );
  }

  function sectionOf(section, content, isOnly) {
    const make = KINDS[section.kind];
    const made = make
      ? make(section, stemOf(content.title))
      : {
          element: create(
            "p",
            { class: "muted" },
            `This page cannot show a section of the kind ${section.kind}.`,
          ),
        };
    const title =
      section.title && (!isOnly || section.title !== content.title)
        ? create("h2", { dir: "auto" }, report.markup.nodes(section.title))
        : "";
    return { ...made, whole: create("div", { class: "section" }, title, made.element) };
  }

  /** Printed pages also show the panels that have something to tell. */
  function attachPrint(root) {
    let shown = [];
    window.addEventListener("beforeprint", () => {
      shown = [...root.querySelectorAll(".panel[hidden][data-prints=true]")];
      shown.forEach((panel) => {
        panel.hidden = false;
      });
      report.dom.refresh();
    });
    window.addEventListener("afterprint", () =>
      shown.forEach((panel) => {
        panel.hidden = true;
      }),
    );
  }

  function start() {
    const content = report.data.read();
    document.title = report.markup.plain(content.title);
    report.patterns.attach();
    report.tooltip.attach();
    const sections = content.sections.map((section) =>
      sectionOf(section, content, content.sections.length === 1),
    );
    const root = document.getElementById("page");
    root.replaceWith(
      create(
        "main",
        { id: "page" },
        head(content),
        sections.map(({ whole }) => whole),
        report.download.colophon(content),
      ),
    );
    attachPrint(document.getElementById("page"));
    const views = sections.filter(({ store }) => store);
    return { views, address: report.address.bind(views) };
  }

  return { start };
})();

Object.assign(report.main, report.main.start());

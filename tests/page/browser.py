"""Tries a page of `phase report` in a browser.

    python3 tests/page/browser.py PAGE... [--most BYTES] [--chromium PATH] [--thresholds N]

Opens each page as a file, does what a reader does, and fails with the name of the case. What a page
does not have, such as thresholds, is not asked for. Needs Playwright and a Chromium.
"""

import argparse
import json
import pathlib
import random
import re
import statistics
import sys
import time

from playwright.sync_api import sync_playwright

MOST_MILLISECONDS = 50

# Longest wait for anything, for machines that are busy (ms).
PATIENCE = 120_000
ORDERS = {
    ">=": lambda value, limit: value >= limit,
    ">": lambda value, limit: value > limit,
    "<=": lambda value, limit: value <= limit,
    "<": lambda value, limit: value < limit,
}


def relabel(section, thresholds):
    """The labels of all runs by thresholds, from the document alone."""
    rules, runs = section["rules"], section["runs"]
    measures = {measure["name"]: measure["values"] for measure in section["measures"]}

    def values(comparison):
        if "measure" in comparison:
            return measures[comparison["measure"]]
        if "values" in comparison:
            return comparison["values"]
        key = comparison["by"]["key"]
        stops = next(it["stops"] for it in rules["thresholds"] if it["key"] == key)
        return comparison["by"]["columns"][stops.index(thresholds[key])]

    def holds(rule, run):
        if "stored" in rule and rule["stored"][run] != 1:
            return False
        for comparison in rule.get("comparisons", []):
            value, limit = values(comparison)[run], comparison["threshold"]
            limit = thresholds[limit] if isinstance(limit, str) else limit
            if value is None or not ORDERS[comparison["order"]](value, limit):
                return False
        return True

    def label(run):
        if runs["label"][run] in rules.get("fixed", []):
            return runs["label"][run]
        found = (rule["label"] for rule in rules["list"] if holds(rule, run))
        return next(found, rules["otherwise"])

    return [label(run) for run in range(len(runs["label"]))]


def random_thresholds(section, generator):
    """Thresholds anywhere in their ranges, often exactly at a stored value."""
    found = {}
    columns = [it["values"] for it in section["measures"]]
    for threshold in section["rules"]["thresholds"]:
        low, high = threshold["low"], threshold["high"]
        if "stops" in threshold:
            found[threshold["key"]] = generator.choice(threshold["stops"])
            continue
        value = generator.uniform(low, high)
        stored = [it for it in generator.choice(columns) if it is not None and low <= it <= high]
        if stored and generator.random() < 0.5:
            value = generator.choice(stored)
        found[threshold["key"]] = round(value) if threshold.get("is_whole") else value
    return found


class Visit:
    """A page that is open, and what it did that it should not."""

    def __init__(self, browser, path, fragment="", **options):
        self.context = browser.new_context(viewport={"width": 1300, "height": 900}, accept_downloads=True, **options)
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.faults = []
        self.url = path.resolve().as_uri()
        self.page.on("console", lambda message: self.faults.append(f"console: {message.text}"))
        self.page.on("pageerror", lambda error: self.faults.append(f"error: {error}"))
        self.page.on("dialog", lambda dialog: (self.faults.append(f"dialog: {dialog.message}"), dialog.dismiss()))
        self.page.on("request", self.note_request)
        self.page.goto(self.url + fragment)
        self.page.wait_for_selector("main .colophon")

    def note_request(self, request):
        if not request.url.startswith((self.url, "blob:", "data:")):
            self.faults.append(f"request: {request.url}")

    def state(self):
        """The state of the first sweep."""
        return self.page.evaluate("(({ brush, ...state }) => state)(report.main.views[0].store.state)")

    def address(self):
        """The address once it is written, which it is after a pause."""
        self.page.wait_for_timeout(150)
        self.page.evaluate("report.main.address.write()")
        return self.page.evaluate("location.hash")

    def middle(self, selector, across=0.5, up=0.5):
        """A place in an element: shares of its width and height, from the lower left corner."""
        frame = self.page.locator(selector).first.bounding_box()
        return frame["x"] + across * frame["width"], frame["y"] + (1 - up) * frame["height"]

    def cell(self, column, row):
        """The middle of a cell of the first map on the screen."""
        self.page.evaluate("window.scrollTo(0, 0)")
        return self.page.evaluate(
            """([column, row]) => {
                const svg = document.querySelector(".main .map svg");
                const frame = svg.querySelector(".frame").getBBox();
                const { model, store } = report.main.views[0];
                const edges = (at, from, to) => at < 0 ? [from, to] : (() => {
                    const axis = model.axes[at];
                    const borders = report.scales.edges(axis.spacing, axis.values);
                    const scale = report.scales.scale(axis.spacing, [borders[0], borders[borders.length - 1]], [from, to], axis.values);
                    return borders.map(scale.at);
                })();
                const x = edges(store.state.x, frame.x, frame.x + frame.width);
                const y = edges(store.state.y, frame.y + frame.height, frame.y);
                const place = [(x[column] + x[column + 1]) / 2, (y[row] + y[row + 1]) / 2];
                return report.chart.onScreen(svg, place);
            }""",
            [column, row],
        )

    def close(self):
        self.context.close()


def expect(condition, words):
    if not condition:
        raise AssertionError(words)


# The cases: each gets a visit to the page and its first section.


def structure(visit, section):
    """Nothing in the page runs or loads but its own script and style."""
    found = visit.page.evaluate(
        """() => ({
            scripts: [...document.scripts].map((it) => [it.type, it.src]),
            styles: document.querySelectorAll("[style]").length - document.querySelectorAll("canvas[style], .tooltip[style]").length,
            handlers: [...document.querySelectorAll("*")].flatMap((it) => [...it.attributes]).filter((it) => it.name.startsWith("on")).length,
            foreign: document.querySelectorAll("img, iframe, object, embed, base, form, link:not([rel=icon]), a[href], audio, video, svg script, foreignObject").length,
            policy: document.querySelector("meta[http-equiv]").content,
            title: document.title,
        })"""
    )
    expect(found["scripts"] == [["application/json", ""], ["", ""]], f"scripts: {found['scripts']}")
    expect(found["styles"] == 0 and found["handlers"] == 0 and found["foreign"] == 0, f"inline or foreign: {found}")
    expect(found["policy"].startswith("default-src 'none'; script-src 'sha256-"), found["policy"])
    expect(found["title"].strip() != "", "the page has no title")


def injected(visit, section):
    """A script or style that gets into the page is refused by its policy."""
    faults = len(visit.faults)
    visit.page.evaluate("document.body.append(Object.assign(document.createElement('script'), { textContent: 'window.injected = true' }))")
    expect(not visit.page.evaluate("window.injected === true"), "an injected script ran")
    expect(len(visit.faults) > faults, "the policy did not complain about an injected script")
    del visit.faults[faults:]


def narrow(visit, section):
    """No panel is wider than a narrow screen."""
    visit.page.set_viewport_size({"width": 320, "height": 640})
    for tab in visit.page.locator("[role=tab]").all() or [None]:
        if tab:
            tab.click()
        visit.page.wait_for_timeout(150)
        width = visit.page.evaluate("document.documentElement.scrollWidth")
        expect(width <= 320, f"{width} px wide at {tab.inner_text() if tab else 'first'}")


def hover(visit, section):
    """The pointer over a cell tells its labels and its evidence."""
    column, row = (places[0] for places in two_axes(visit, section))
    visit.page.mouse.move(*visit.cell(column, row))
    text = " ".join(visit.page.locator(".tooltip").inner_text().split())
    label = " ".join(section["labels"][section["runs"]["label"][0]]["name"].replace("-", " ").split())
    expect(label in text, f"{label!r} not in {text!r}")


def two_axes(visit, section):
    """The places of all runs on the two axes of the map."""
    state = visit.state()
    places = section["runs"]["places"]
    zeros = [0] * len(places[0])
    return places[state["x"]], places[state["y"]] if state["y"] >= 0 else zeros


def slice_of(section, run):
    """A fragment that shows the slice of a run."""
    return [places[run] for places in section["runs"]["places"]]


def click(visit, section):
    """A click pins a cell, the address has it, and Unpin lets go."""
    column, row = (places[0] for places in two_axes(visit, section))
    visit.page.mouse.click(*visit.cell(column, row))
    expect(visit.state()["pin"] is not None, "nothing is pinned")
    expect(visit.page.locator(".point-head h3").is_visible(), "no details")
    expect("at=" in visit.address(), visit.address())
    visit.page.click("text=Unpin")
    expect(visit.state()["pin"] is None and "at=" not in visit.address(), "still pinned")


def keyboard(visit, section):
    """Arrows move, Enter pins, Escape lets go, Shift selects; what happens is said."""
    page = visit.page
    page.locator(".main .map").first.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    first = visit.state()["cursor"]
    page.keyboard.press("ArrowLeft")
    expect(visit.state()["cursor"] != first or len(section["axes"][0].get("values", "ab")) == 1, "arrows do not move")
    expect(page.locator("[aria-live][role=status]").inner_text() != "", "nothing is said")
    page.keyboard.press("Enter")
    expect(visit.state()["pin"] is not None, "Enter does not pin")
    page.keyboard.press("Escape")
    expect(visit.state()["pin"] is None, "Escape does not let go")
    page.keyboard.press("Shift+ArrowRight")
    expect("cells" in (visit.state()["selection"] or {}), "Shift does not select")
    page.keyboard.press("Escape")
    expect(visit.state()["selection"] is None, "Escape keeps the selection")
    page.locator("[role=tab]").first.focus()
    page.keyboard.press("ArrowRight")
    expect(visit.state()["tab"] == "thresholds", "arrows do not change the tab")
    outline = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    expect(outline != "none", "focus is not seen")


def other_maps(visit, section):
    """Every measure is a map with a bar of colours or says that it has no values."""
    for measure in section["measures"]:
        visit.page.select_option("select[name=map]", measure["name"])
        expect(visit.page.locator(".color-bar, .legend > .muted").count() > 0, measure["name"])
    expect("map=" in visit.address(), visit.address())


def slices(visit, section):
    """A slider over a third axis shows another slice."""
    before = visit.state()["slice"]
    control = visit.page.locator("[name^=slice-]").first
    if control.evaluate("it => it.tagName") == "SELECT":
        control.select_option(index=1)
    else:
        control.focus()
        visit.page.keyboard.press("ArrowRight")
    expect(visit.state()["slice"] != before, "the slice stays")
    expect("slice=" in visit.address(), visit.address())


def legend(visit, section):
    """A label of the legend selects its runs; layers switch."""
    visit.page.locator(".legend-entry").first.click()
    expect(visit.page.locator(".selection-note").first.is_visible(), "no note of the selection")
    label = visit.state()["selection"]["labels"][0]
    count = section["runs"]["label"].count(label)
    expect(visit.page.locator(".selection-note").inner_text().startswith(f"{count} "), visit.page.locator(".selection-note").inner_text())
    visit.page.locator(".selection-note button").click()
    visit.page.locator("input[name=layer-patterns]").first.check()
    expect(visit.page.locator(".main .map path[fill*=pattern]").count() > 0, "no patterns")
    expect("on=patterns" in visit.address(), visit.address())


def brushing(visit, section):
    """A rectangle in the measures selects runs on the map, one on the map selects in the measures."""
    page = visit.page
    page.click("button[name=tab-measures]")
    page.wait_for_timeout(150)
    drag(page, visit.middle(".panel-measures .scatter .frame", 0.02, 0.02), visit.middle(".panel-measures .scatter .frame", 0.6, 0.98))
    selection = visit.state()["selection"]
    expect("measures" in (selection or {}), f"selection: {selection}")
    expect("select=" in visit.address(), visit.address())
    visit.page.evaluate("window.scrollTo(0, 0)")
    drag(page, visit.middle(".main .map .frame", 0.02, 0.02), visit.middle(".main .map .frame", 0.98, 0.98))
    expect("cells" in (visit.state()["selection"] or {}), "the map selects nothing")
    expect(visit.state()["pin"] is None, "a drag pins")


def drag(page, start, end):
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*[(a + b) / 2 for a, b in zip(start, end)])
    page.mouse.move(*end)
    page.mouse.up()


def sliders(visit, section):
    """A slider labels again, counts what changed, and gives TOML to copy; Reset takes it back."""
    page = visit.page
    page.click("button[name=tab-thresholds]")
    at, threshold = next((at, it) for at, it in enumerate(section["rules"]["thresholds"]) if "stops" not in it)
    page.locator(".threshold input[type=range]").nth(at).focus()
    page.keyboard.press("End")
    moved = {it["key"]: it["value"] for it in section["rules"]["thresholds"]}
    moved[threshold["key"]] = visit.state()["thresholds"][threshold["key"]]
    labels = relabel(section, moved)
    count = sum(a != b for a, b in zip(labels, section["runs"]["label"]))
    expect(page.locator(".count-changed").first.inner_text().startswith(f"{count:,}".replace(",", "\u202f")), page.locator(".count-changed").first.inner_text())
    written = threshold.get("toml", f'{threshold["key"].rsplit(".", 1)[-1]} = {{value}}').split("{value}")[0]
    expect(written in page.locator(".toml").text_content(), page.locator(".toml").inner_text())
    page.locator("text=Reset all").first.click()
    expect("as stored" in page.locator(".count-changed").first.inner_text(), "not reset")


def relabelling(visit, section):
    """Labels by random thresholds are those of another implementation."""
    stored = {it["key"]: it["value"] for it in section["rules"]["thresholds"]}
    expect(relabel(section, stored) == section["runs"]["label"], "the rules at the stored thresholds do not give the stored labels")
    generator = random.Random(1)
    for _ in range(visit.thresholds):
        thresholds = random_thresholds(section, generator)
        found = visit.page.evaluate(
            "(it) => { const { model } = report.main.views[0]; return [...report.rules.relabel(model.rules, model.measures, model.stored, it)]; }", thresholds
        )
        expect(found == relabel(section, thresholds), f"labels differ at {thresholds}")


def speed(visit, section):
    """All cells are labelled and drawn again within the time."""
    visit.page.click("button[name=tab-thresholds]")
    visit.page.wait_for_timeout(200)
    generator = random.Random(2)
    all_thresholds = [random_thresholds(section, generator) for _ in range(30)]
    times = visit.page.evaluate(
        """(all) => all.map((thresholds) => {
            const start = performance.now();
            report.main.views[0].store.set({ thresholds });
            document.querySelector(".relabelled").getBoundingClientRect();
            return performance.now() - start;
        })""",
        all_thresholds,
    )
    visit.notes.append(f"{len(section['runs']['label'])} runs labelled again in {statistics.median(times):.1f} ms (most {max(times):.1f} ms)")
    expect(statistics.median(times) < MOST_MILLISECONDS, f"{statistics.median(times):.1f} ms")


def restore(visit, section):
    """An address restores all that it holds, at the start and when it changes."""
    page = visit.page
    changes = {"tab": "measures", "layers": {**visit.state()["layers"], "patterns": True, "borders": False}}
    if section.get("measures"):
        changes["map"] = section["measures"][-1]["name"]
    if section.get("rules"):
        changes["thresholds"] = random_thresholds(section, random.Random(3))
    page.evaluate("(changes) => { const { store, model } = report.main.views[0]; model.pinRun(model.count - 1); store.set(changes); store.set({ selection: { labels: [0] } }); }", changes)
    address, state = visit.address(), visit.state()
    other = Visit(visit.browser, visit.path, address)
    for name in ("pin", "run", "map", "tab", "layers", "thresholds", "selection", "slice", "x", "y"):
        expect(other.state()[name] == state[name], f"{name}: {other.state()[name]} instead of {state[name]}")
    other.page.evaluate("location.hash = ''")
    other.page.wait_for_timeout(100)
    expect(other.state()["pin"] is None and other.state()["map"] == "label", "an empty address keeps the state")
    other.page.evaluate("location.hash = 'at=nonsense&map=%3Cimg%3E&select=%7B&x=y&slice=a:b;c&columns=,'")
    other.page.wait_for_timeout(100)
    expect(other.state()["pin"] is None, "nonsense pins")
    visit.faults += other.faults
    other.close()


def downloads(visit, section):
    """The data can be saved, as tables and as it is."""
    page = visit.page
    page.click("button[name=tab-data]")
    with page.expect_download() as saved:
        page.click("text=Runs as CSV")
    rows = pathlib.Path(saved.value.path()).read_text().rstrip("\n").split("\n")
    expect(len(rows) >= len(section["runs"]["label"]) + 1, f"{len(rows)} rows")
    with page.expect_download() as saved:
        page.click("text=All data as JSON")
    document = json.loads(pathlib.Path(saved.value.path()).read_text())
    expect(document["sections"][0] == section, "the saved data differ")


def table(visit, section):
    """The map is also a table, with heads."""
    visit.page.click("button[name=tab-table]")
    found = visit.page.evaluate("() => [...document.querySelectorAll('.map-table tbody tr')].map((row) => [row.querySelectorAll('th[scope=row]').length, row.querySelectorAll('td').length])")
    state = visit.state()
    rows = 1 if state["y"] < 0 else len(axis_values(section, state["y"]))
    expect(found == [[1, len(axis_values(section, state["x"]))]] * rows, f"{len(found)} rows")


def axis_values(section, at):
    axis = section["axes"][at]
    return axis.get("values") or axis["words"]


def series(visit, section):
    """A pinned run has its columns over time, which tell values under the pointer."""
    visit.page.evaluate("report.main.views[0].model.pinRun(0)")
    visit.page.wait_for_selector(".details .charts svg")
    visit.page.locator(".details .charts svg").first.scroll_into_view_if_needed()
    visit.page.mouse.move(*visit.middle(".details .charts svg .frame", 0.5, 0.5))
    expect("t = " in visit.page.locator(".tooltip").inner_text(), "no value under the pointer")
    before = visit.page.locator(".details .charts svg").count()
    visit.page.locator(".details .pill input:not(:checked)").first.check()
    visit.page.locator(".details .charts svg").nth(before).wait_for()


def spheres(visit, section):
    """A run with states has an animation that plays to its end."""
    run = section["states"][0]["run"]
    visit.page.evaluate("(run) => report.main.views[0].model.pinRun(run)", run)
    visit.page.wait_for_selector(".details canvas")
    painted = "document.querySelector('.details canvas').toDataURL()"
    visit.page.click("button[name=play]")
    early = visit.page.evaluate(painted)
    visit.page.locator("button[name=play]:text-is('Play')").wait_for(timeout=20000)
    expect(early != visit.page.evaluate(painted), "the picture does not change")


def scene(visit, section):
    """The scene of a run has its differing lines marked, and a command makes it again."""
    run = len(section["runs"]["label"]) - 1
    visit.page.evaluate("(run) => report.main.views[0].model.pinRun(run)", run)
    expect(visit.page.locator(".details pre.scene").count() == 1, "no scene")
    differing = visit.page.evaluate("(run) => { const { model } = report.main.views[0]; return report.scene.changesOf(model, run); }", run)
    text = visit.page.locator(".details pre.scene").inner_text()
    for key, value in differing:
        expect(value is None or f"{key.rsplit('.', 1)[-1]} = {value}" in text, f"{key} = {value} not in the scene")
    if section.get("command"):
        expect("phase run" in visit.page.locator(".details .command code").last.inner_text() or section["command"][:5] in text, "no command")


def printing(visit, section):
    """The page prints, and looks as before afterwards."""
    tab = visit.page.locator(".panel:not([hidden])").count()
    expect(len(visit.page.pdf()) > 5000, "an empty print")
    expect(visit.page.locator(".panel:not([hidden])").count() == tab, "panels stay open")


def places(visit, section):
    """A chart of a study tells the setting under the pointer and to the keyboard."""
    chart = visit.page.locator(".study svg.chart").first
    chart.focus()
    visit.page.keyboard.press("ArrowRight")
    name = visit.page.locator(".tooltip .tooltip-place").inner_text()
    names = [it["name"] for it in section.get("settings", section.get("effects", []))]
    expect(any(it in name for it in names), name)


def is_sweep(section):
    return section["kind"] == "sweep"


def has(*names):
    return lambda section: is_sweep(section) and all(section.get(name) for name in names)


def always(section):
    return True


CASES = [
    (structure, always),
    (injected, always),
    (narrow, always),
    (printing, always),
    (hover, is_sweep),
    (click, is_sweep),
    (keyboard, is_sweep),
    (other_maps, has("measures")),
    (slices, lambda section: is_sweep(section) and any(len(axis_values(section, at)) > 1 for at in range(2, len(section["axes"])))),
    (legend, is_sweep),
    (brushing, has("measures")),
    (sliders, has("rules")),
    (relabelling, has("rules")),
    (speed, has("rules")),
    (restore, is_sweep),
    (downloads, is_sweep),
    (table, is_sweep),
    (series, has("series")),
    (spheres, has("states")),
    (scene, has("scene")),
    (places, lambda section: section["kind"] in ("accuracy", "ablation")),
]


def document_of(path):
    text = path.read_text()
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])


def examine(browser, path, arguments):
    """The faults of a page, as lines."""
    size = path.stat().st_size
    section = next(iter(document_of(path)["sections"]), {"kind": None})
    faults, notes = [], [f"{size / 1e3:.0f} kB"]
    if size > arguments.most:
        faults.append(f"{size} bytes, more than {arguments.most}")
    for case, is_meant in CASES:
        if not is_meant(section):
            continue
        visit = Visit(browser, path)
        visit.browser, visit.path, visit.notes, visit.thresholds = browser, path, notes, arguments.thresholds
        try:
            case(visit, section)
        except Exception as error:  # A timeout of the browser is a fault of the page, too.
            faults.append(f"{case.__name__}: {error}")
        faults += [f"{case.__name__}: {fault}" for fault in visit.faults]
        visit.close()
    print(f"{path.name}: {', '.join(notes)}: {'; '.join(faults) if faults else 'good'}", flush=True)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--most", type=int, default=3_000_000, help="most bytes of a page")
    parser.add_argument("--chromium", default="/usr/bin/chromium")
    parser.add_argument("--thresholds", type=int, default=50, help="random thresholds to compare")
    arguments = parser.parse_args()
    started = time.monotonic()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=arguments.chromium, args=["--no-sandbox"])
        faults = [fault for page in arguments.pages for fault in examine(browser, page, arguments)]
        browser.close()
    print(f"{len(faults)} faults in {time.monotonic() - started:.0f} s")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()

"""Moves the thresholds of a page at random, and labels its folder again by the same thresholds.

    python3 tests/page/classify.py PAGE FOLDER SWEEP.toml --phase PHASE [--trials N] [--chromium PATH]

The page, in a browser, and `phase classify` must give each run the same label. The sweep file must
have no `[sieves]`; the tables that the page offers to copy are added to it.
"""

import argparse
import csv
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from playwright.sync_api import sync_playwright

# What the page knows: thresholds, and the label of each run by its identity.
RELABEL = """(thresholds) => {
  const [section] = JSON.parse(document.getElementById("data").textContent).sections;
  const measures = new Map(section.measures.map((measure) => [measure.name, measure]));
  const labels = report.rules.relabel(section.rules, measures, section.runs.label, thresholds);
  return Object.fromEntries(
    section.runs.id.map((id, run) => [id, section.labels[labels[run]].name]));
}"""
THRESHOLDS = """() =>
  JSON.parse(document.getElementById("data").textContent).sections[0].rules.thresholds"""


def drawn(thresholds, generator):
    """A value of each threshold: one of its stops, or one between its ends."""
    values = {}
    for it in thresholds:
        if "stops" in it:
            values[it["key"]] = generator.choice(it["stops"])
        else:
            value = generator.uniform(it["low"], it["high"])
            values[it["key"]] = round(value) if it.get("is_whole") else value
    return values


def tables(values):
    """The tables of a sweep file with these thresholds."""
    of_table = {}
    for key, value in values.items():
        table, name = key.rsplit(".", 1)
        of_table.setdefault(table, []).append(f"{name} = {value!r}")
    return "".join(f"\n[{table}]\n" + "\n".join(lines) + "\n" for table, lines in of_table.items())


def in_table(folder):
    with open(folder / "labels.csv", newline="") as file:
        return {row["id"]: row["label"] for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("sweep", type=pathlib.Path)
    parser.add_argument("--phase", default="phase")
    parser.add_argument("--trials", type=int, default=8)
    parser.add_argument("--chromium", default="/usr/bin/chromium")
    arguments = parser.parse_args()
    generator = random.Random(49)
    stored = in_table(arguments.folder)
    moved = 0
    with tempfile.TemporaryDirectory() as work, sync_playwright() as playwright:
        folder = pathlib.Path(work) / "folder"
        shutil.copytree(arguments.folder, folder)
        browser = playwright.chromium.launch(executable_path=arguments.chromium, args=["--no-sandbox"])
        page = browser.new_page()
        page.goto(arguments.page.resolve().as_uri())
        thresholds = page.evaluate(THRESHOLDS)
        for _ in range(arguments.trials):
            values = drawn(thresholds, generator)
            # Beside the sweep file, so that paths in it hold.
            edited = arguments.sweep.with_name(f".{arguments.sweep.stem}-edited.toml")
            try:
                edited.write_text(arguments.sweep.read_text() + tables(values))
                subprocess.run(
                    [arguments.phase, "classify", folder, "--sweep", edited], check=True, capture_output=True
                )
            finally:
                edited.unlink(missing_ok=True)
            expected, found = in_table(folder), page.evaluate(RELABEL, values)
            differing = [run for run in expected if expected[run] != found[run]]
            if differing:
                sys.exit(f"{len(differing)} labels differ at {values}")
            moved += sum(expected[run] != stored[run] for run in expected)
        browser.close()
    if moved == 0:
        sys.exit("no threshold changed a label")
    print(f"{arguments.page.name}: {len(stored)} labels agree at {arguments.trials} thresholds; {moved} moved")


if __name__ == "__main__":
    main()

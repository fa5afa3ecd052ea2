"""Makes documents that are unusual but right: python3 tests/page/odd.py FOLDER

Seeds that disagree, runs that were not steady, unstable ones, points that failed or were not run, one
axis, an axis of words, four axes, two sweeps in one page, a sweep of one run, nothing but labels.
"""

import json
import pathlib
import random
import sys


def labels():
    names = [("unstable", "#000000"), ("unsettled", "#e6e2f7"), ("settled", "#e2bd6c"), ("fluid", "#58a6e0"), ("pinned", "#2a8a5c")]
    return [{"code": code, "name": name, "color": color, **({"hatched": True} if code < 0 else {})} for code, (name, color) in enumerate(names, -1)]


def sweep(sizes, seeds, generator, words=False, is_bare=False):
    """A sweep whose label follows a value that follows the first two axes, with noise."""
    axes = [{"name": f"axis_{at}", "key": f"table.axis_{at}", "quantity": f"$a_{at}$", "unit": "m", "values": [round(0.1 * (index + 1), 3) for index in range(size)]} for at, size in enumerate(sizes)]
    if words:
        axes[-1] = {"name": "variant", "words": [f"variant {index}" for index in range(sizes[-1])], "changes": [[["table.kind", json.dumps(f"kind {index}")], ["gone.key", None]] for index in range(sizes[-1])]}
    places, label, seed, steady, values = [[] for _ in sizes], [], [], [], []
    failed = {"places": [[] for _ in sizes], "seed": [], "message": []}
    total = 1
    for size in sizes:
        total *= size
    for place in range(total):
        indices, rest = [], place
        for size in reversed(sizes):
            indices.insert(0, rest % size)
            rest //= size
        if place % 11 == 7 and total > 20:
            continue
        if place % 17 == 3 and total > 20:
            for column, index in zip(failed["places"], indices):
                column.append(index)
            failed["seed"].append(1)
            failed["message"].append("the disk is full")
            continue
        for number in range(1, seeds + 1):
            value = sum(indices) / (sum(sizes) - len(sizes) or 1) + generator.gauss(0, 0.12)
            is_unstable = place % 23 == 5 and number == 1
            for column, index in zip(places, indices):
                column.append(index)
            values.append(None if is_unstable else value)
            label.append(0 if is_unstable else 4 if value >= 0.66 else 3 if value >= 0.33 else 2)
            seed.append(number)
            steady.append(None if is_unstable else int(generator.random() > 0.06))
    section = {"kind": "sweep", "title": f"{len(sizes)} axes", "axes": axes, "labels": labels(), "runs": {"places": places, "label": label}}
    if is_bare:
        return section
    section["runs"] |= {"seed": seed, "steady": steady, "id": [f"{index:016x}" for index in range(len(label))]}
    section["failed"] = failed
    section["measures"] = [
        {"name": "value", "quantity": "value $v$", "unit": "m", "range": "any", "is_evidence": False, "values": values},
        {"name": "margin", "quantity": "margin", "unit": "", "range": "signed", "is_evidence": True, "values": [None if it is None else it - 0.66 for it in values]},
    ]
    section["rules"] = {
        "list": [
            {"label": 4, "comparisons": [{"measure": "value", "order": ">=", "threshold": "rules.high"}]},
            {"label": 3, "comparisons": [{"values": values, "name": "value again", "order": ">=", "threshold": "rules.low"}]},
            {"label": 2, "stored": [None if it is None else 1 for it in values]},
        ],
        "otherwise": 1,
        "fixed": [0],
        "thresholds": [
            {"key": "rules.high", "quantity": "high", "unit": "m", "value": 0.66, "low": 0, "high": 1},
            {"key": "rules.low", "quantity": "low", "unit": "m", "value": 0.33, "low": 0, "high": 1},
        ],
    }
    section["scene"] = {"text": 'title = "odd"\nseed = 1\n\n[table]\nkind = "none"\naxis_0 = 1.0\n\n[gone]\nkey = 3\n'}
    section["command"] = "phase run --from results/odd --point {point} --out {id}.h5"
    return section


def main():
    folder = pathlib.Path(sys.argv[1])
    generator = random.Random(4)
    made = {
        "seeds": [sweep([12, 9], 3, generator)],
        "ties": [sweep([8, 8], 2, generator)],
        "line": [sweep([25], 3, generator)],
        "words": [sweep([6, 5, 3], 1, generator, words=True)],
        "words-across": [sweep([9, 4], 2, generator, words=True)],
        "four": [sweep([5, 4, 3, 3], 1, generator)],
        "two": [sweep([6, 6], 1, generator), sweep([5, 7], 2, generator)],
        "single": [sweep([1], 1, generator)],
        "bare": [sweep([6, 6], 1, generator, is_bare=True)],
        "none": [],
    }
    for name, sections in made.items():
        document = {"format": "phase report", "format_version": 1, "title": f"Odd: {name}", "sections": sections}
        (folder / f"odd-{name}.json").write_text(json.dumps(document))


if __name__ == "__main__":
    main()

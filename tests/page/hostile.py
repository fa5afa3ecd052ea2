"""Makes a document whose texts are hostile: python3 tests/page/hostile.py DOCUMENT.json HOSTILE.json

Every text of the document that a user, a file or a program may choose becomes one that tries to
leave its place. The page of the document must pass all cases of browser.py.
"""

import itertools
import json
import pathlib
import sys

TEXTS = [
    "</script><script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "\"'><svg onload=alert(1)>",
    "<!--<script>alert(1)//",
    "javascript:alert(1)",
    "</title></style><style>*{display:none}</style>",
    "name with \u2028 and \u2029 and \u0000\u0007 and {{data}} and ${1+1}",
    "$x_{<b>$ $ _y",
    "$r_{\u202e}$ \u202eright to left\u202c اتجاه עברית",
    "a-very-long-name-" * 30,
    "'; rm -rf / #",
    "=HYPERLINK(\"x\",\"y\"),\r\n1",
    "__proto__",
    "constructor",
    "url(#x);background:url(https://example.com/)",
]

# Texts that programs read: a hostile one would make another document, not a hostile page.
KEPT = {"kind", "spacing", "range", "order", "data", "pattern", "format", "measure", "threshold", "scale"}


def hostile(document):
    texts = itertools.cycle(TEXTS)
    names = {}

    def renamed(text):
        """A name that is referred to stays the same wherever it stands."""
        return names.setdefault(text, f"{next(texts)} {len(names)}")

    def walk(value, key):
        if isinstance(value, dict):
            return {name: walk(it, name) for name, it in value.items()}
        if isinstance(value, list):
            return [walk(it, key) for it in value]
        if not isinstance(value, str) or key in KEPT:
            return value
        if key == "color":
            return "red;background:url(https://example.com/)"
        if key in ("texts", "id", "command"):
            return value + next(texts)
        return renamed(value) if key == "name" else next(texts)

    made = walk(document, "")
    for section, original in zip(made["sections"], document["sections"]):
        repair(section, original, names)
    return made


def repair(section, original, names):
    """References between parts of a section hold again."""
    rules = section.get("rules")
    if rules:
        old_rules = original["rules"]
        keys = {old["key"]: f"{new['key']} {index}" for index, (old, new) in enumerate(zip(old_rules["thresholds"], rules["thresholds"]))}
        for old, new in zip(old_rules["thresholds"], rules["thresholds"]):
            new["key"] = keys[old["key"]]
        for old_rule, rule in zip(old_rules["list"], rules["list"]):
            for old, new in zip(old_rule.get("comparisons", []), rule.get("comparisons", [])):
                if isinstance(old["threshold"], str):
                    new["threshold"] = keys[old["threshold"]]
                if "measure" in old:
                    new["measure"] = names[old["measure"]]
                if "by" in old:
                    new["by"]["key"] = keys[old["by"]["key"]]
    if "scatter" in original.get("view", {}):
        section["view"]["scatter"] = [names[it] for it in original["view"]["scatter"]]
    for axis in section.get("axes", []):
        axis.pop("changes", None)


if __name__ == "__main__":
    source, target = sys.argv[1:]
    document = hostile(json.loads(pathlib.Path(source).read_text()))
    pathlib.Path(target).write_text(json.dumps(document, ensure_ascii=False))

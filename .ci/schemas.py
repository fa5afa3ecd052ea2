#!/usr/bin/env python3
"""Validates TOML files against docs/schema with a validator we did not write: the shipped and the
good ones pass, and those that are wrong in a single key do not."""

import json
import sys
import tomllib
from pathlib import Path

import jsonschema

# Bad for what a schema can know: names, types and ranges of single keys.
BAD_KEYS = """choice-misspelt key-missing key-of-another-law law-missing out-of-range
radius-of-wrong-kind radius-share-misspelt several-problems start-position-incomplete
start-sphere-misspelt""".split()

validators = {}
for kind in "scene", "sweep", "stability", "accuracy":
    schema = json.loads(Path(f"docs/schema/{kind}.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validators[kind] = jsonschema.Draft7Validator(schema)


def complaints(path):
    content = tomllib.loads(path.read_text())
    is_sweep = bool(content.keys() & {"axis", "scene", "seeds", "sieves", "plot"})
    study = content.get("study", "ablation")  # an ablation's file is a sweep's
    kind = study if study != "ablation" else "sweep" if is_sweep else "scene"
    return [error.message for error in validators[kind].iter_errors(content)]


good = [*Path("sweeps").rglob("*.toml"), *Path("tests/good").glob("*.toml")]
wrong = {str(path): found for path in good if (found := complaints(path))}
wrong |= {name: "is accepted" for name in BAD_KEYS if not complaints(Path(f"tests/bad/{name}.toml"))}
if wrong or len(good) < 10:
    sys.exit(f"{wrong} of {len(good)} files")
print(len(good), "good files,", len(BAD_KEYS), "bad ones")

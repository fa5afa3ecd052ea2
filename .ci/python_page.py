#!/usr/bin/env python3
"""Runs the Python blocks of a page one after the other, as a reader would in one session.

    .ci/python_page.py docs/python.md
"""

import pathlib
import re
import sys

text = pathlib.Path(sys.argv[1]).read_text()
names = {}
for block in re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S):
    # Lines of tracebacks are those of the page.
    code = "\n" * text[: block.start(1)].count("\n") + block[1]
    exec(compile(code, sys.argv[1], "exec"), names)

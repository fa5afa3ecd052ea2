"""Puts another document into a page: python3 tests/page/assemble.py PAGE DOCUMENT.json OUT.html"""

import json
import pathlib
import re
import sys

DATA = re.compile(r'(<script type="application/json" id="data">).*?(</script>)', re.DOTALL)


def assembled(page, document):
    """The page with this document, escaped as the program does."""
    data = json.dumps(document, ensure_ascii=False).replace("<", "\\u003c")
    data = data.replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")
    made, count = DATA.subn(lambda found: found[1] + data + found[2], page)
    assert count == 1, "no page of `phase report`"
    return made


if __name__ == "__main__":
    page, document, target = map(pathlib.Path, sys.argv[1:])
    document = json.loads(document.read_text())
    target.write_text(assembled(page.read_text(), document))

#!/usr/bin/env python3
"""Does what docs/tutorial.md says, in the current folder: writes its files, runs its commands, and
compares what they print with what it shows, where `...` stands for anything.

    .ci/tutorial.py docs/tutorial.md
"""

import re
import subprocess
import sys


def pattern(shown):
    parts = shown.strip().split("...")
    return re.compile(".*".join(re.escape(part) for part in parts), re.DOTALL)


printed = ""
for info, text in re.findall(r"^```(.*?)\n(.*?)^```$", open(sys.argv[1]).read(), re.M | re.S):
    match info.split():
        case ["toml", name]:
            open(name, "w").write(text)
        case ["sh"]:
            for command in text.splitlines():
                print("$", command, flush=True)
                done = subprocess.run(command, shell=True, stdout=subprocess.PIPE, text=True)
                printed = done.stdout
                print(printed, end="", flush=True)
                if done.returncode != 0:
                    sys.exit(f"`{command}` ends with {done.returncode}")
        case ["text"]:
            if not pattern(text).fullmatch(printed.strip()):
                sys.exit(f"the tutorial shows\n{text}but this is printed:\n{printed}")
        case _:
            sys.exit(f"a block of the tutorial is neither sh, text nor `toml NAME`: {info}")

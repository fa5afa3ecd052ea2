"""Checks that every dependency may be used under a permissive licence."""

import json
import subprocess
import sys

ALLOWED = {
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "MIT",
    "Unicode-3.0",
    "Zlib",
}


def allowed(expression):
    """Whether an SPDX expression holds; older packages write `/` for OR."""
    expression = expression.replace("/", " OR ").replace("(", "").replace(")", "")
    every = expression.split(" AND ")
    return all(any(one.strip() in ALLOWED for one in part.split(" OR ")) for part in every)


command = ["cargo", "metadata", "--format-version", "1", "--locked"]
packages = json.loads(subprocess.check_output(command))["packages"]
refused = [it for it in packages if not it["license"] or not allowed(it["license"])]
for package in refused:
    print(f"{package['name']} {package['version']}: licence `{package['license']}` is not allowed")
print(f"{len(packages) - len(refused)} of {len(packages)} licences are permissive")
sys.exit(1 if refused else 0)

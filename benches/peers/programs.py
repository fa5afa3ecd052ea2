"""Programs of others: where they are, and how LAMMPS's inputs are run."""

import os
import re
import shutil
import subprocess
import sys

from common import output


class Missing(Exception):
    """A peer that cannot be had."""


def find(name, package, may_install):
    """The program of a Debian package, installed if need be."""
    if not shutil.which(name) and may_install and shutil.which("apt-get") and os.geteuid() == 0:
        print(f"installing {package} ...", file=sys.stderr)
        for command in ["apt-get update -qq", f"apt-get install -y -qq --no-install-recommends {package}"]:
            subprocess.run(command.split(), capture_output=True)
    if not shutil.which(name):
        raise Missing(f"{name} is not there and cannot be installed; it is left out")
    return name


class Lammps:
    name = "LAMMPS"

    def __init__(self, may_install, core):
        self.program, self.pin = find("lmp", "lammps", may_install), ["taskset", "-c", core]
        self.version = re.search(r"Simulator - (.*)", output([self.program, "-h"]))[1]

    def run(self, script, variables):
        """What it prints while it runs an input with these variables."""
        options = [word for name, value in variables.items() for word in ("-var", name, value)]
        command = self.pin + [self.program, "-in", script, "-log", "none", *options]
        return output(command, env=os.environ | {"OMP_NUM_THREADS": "1"})

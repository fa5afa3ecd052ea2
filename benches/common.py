"""What the scripts of this folder share: names of machine, date, program, and of tables."""

import datetime
import platform
import re
import subprocess
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def output(command, **more):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **more)
    if done.returncode:
        tail = (done.stdout + done.stderr).strip().splitlines()[-8:]
        raise RuntimeError(f"{command[0]} failed:\n" + "\n".join(tail))
    return done.stdout


def today():
    return datetime.date.today().isoformat()


def machine():
    """The processor's name."""
    try:
        names = re.findall(r"model name\s*:\s*(.*)", Path("/proc/cpuinfo").read_text())
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def version(program):
    """Version and commit of the program."""
    return subprocess.run([program, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.split(maxsplit=1)[1].strip()


def commit():
    """The commit that is checked out, with a mark if files differ from it."""
    command = ["git", "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*"]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True).stdout.strip() or "unknown"


def results(kind):
    """The table of a kind of benchmark, of today and this machine."""
    label = re.sub(r"[^a-z0-9]+", "-", machine().lower()).strip("-")
    return FOLDER / "results" / f"{kind}-{today()}-{label}.csv"

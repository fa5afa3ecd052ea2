"""Ctrl-C, and other threads of Python."""

from __future__ import annotations

import pathlib
import signal
import subprocess
import sys
import threading
import time
from typing import Any

import phase
from phase import _lib
from phase.types import Manner, Wishes

Table = dict[str, Any]

# What is started in the background ignores Ctrl-C, which Python then does too.
CHILD = """
import signal, time, phase
signal.signal(signal.SIGINT, signal.default_int_handler)
print("begins", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def interrupt(call: str, pause: float) -> float:
    """Interrupts a call in another process, and gives the seconds that it takes to end."""
    command = [sys.executable, "-P", "-c", CHILD.format(call=call)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None
        end = threading.Timer(120.0, child.kill)
        end.daemon = True
        end.start()
        assert child.stdout.readline() == "begins\n"
        time.sleep(pause)
        child.send_signal(signal.SIGINT)
        begin = time.monotonic()
        assert child.stdout.readline() == "interrupted\n"
        took = time.monotonic() - begin
        assert child.wait(timeout=20) == 0
        end.cancel()
        return took


def test_an_interrupted_run_leaves_a_checkpoint(scene: Table, tmp_path: pathlib.Path) -> None:
    scene["time"]["duration"] = 5000.0
    file, record = tmp_path / "long.toml", tmp_path / "long.h5"
    file.write_text(_lib.to_toml(scene))
    call = f"phase.run({str(file)!r}, out={str(record)!r}, progress=False)"
    assert interrupt(call, 1.0) < 3.0
    assert record.with_suffix(".checkpoint").is_file() and not record.exists()


def test_a_run_goes_on_from_its_checkpoint(scene: Table, tmp_path: pathlib.Path) -> None:
    scene["time"]["duration"] = 60.0
    file, record = tmp_path / "run.toml", tmp_path / "run.h5"
    file.write_text(_lib.to_toml(scene))
    call = f"phase.run({str(file)!r}, out={str(record)!r}, progress=False)"
    # A call that is over before it is interrupted says so.
    interrupt(f"{call}; time.sleep(60)", 0.5)
    resumed = phase.run(file, out=record, resume=True)
    assert resumed.drop_attrs().identical(phase.run(scene).drop_attrs())


def test_an_interrupted_sweep_continues(sweep: Table, tmp_path: pathlib.Path) -> None:
    sweep["scene"]["time"]["duration"] = 5000.0
    file = tmp_path / "long.toml"
    file.write_text(_lib.to_toml(sweep))
    call = f"phase.sweep({str(file)!r}, out={str(tmp_path / 'out')!r}, progress=False)"
    assert interrupt(call, 2.0) < 3.0
    assert list((tmp_path / "out" / "records").glob("*.checkpoint"))
    assert not list((tmp_path / "out" / "records").glob("*.h5"))


def test_other_threads_go_on(scene: Table) -> None:
    scene["time"]["duration"] = 100.0
    counts: list[int] = []
    done = threading.Event()

    def count() -> None:
        number = 0
        while not done.is_set():
            number += 1
            time.sleep(0.001)
        counts.append(number)

    counter = threading.Thread(target=count)
    begin = time.monotonic()
    counter.start()
    phase.run(scene)
    took = time.monotonic() - begin
    done.set()
    counter.join()
    # Held up by the run, it would not come to one count.
    assert counts[0] > 20 * took


def test_progress_is_told(scene: Table, tmp_path: pathlib.Path) -> None:
    told: list[tuple[float, str]] = []
    scene["time"]["duration"] = 100.0
    wishes: Wishes = {
        "seed": None,
        "trajectory": False,
        "ledger": False,
        "snapshot_interval": None,
    }
    manner: Manner = {"out": None, "resume": False, "threads": 1}
    _lib.run(scene, wishes, manner, lambda share, text: told.append((share, text)))
    shares = [share for share, _ in told]
    assert shares == sorted(shares) and 0.0 < shares[0] <= shares[-1] <= 1.0
    assert "of 10000" in told[0][1]

"""A progress bar, if tqdm is there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Show = Callable[[float, str], None]
"""Shows how far work is: the part that is done, from 0 to 1, and what is done in words."""


@contextmanager
def bar(wanted: bool, title: str) -> Iterator[Show | None]:
    """A bar for work that takes a while; None if it is not wanted, or if tqdm is not installed."""
    tqdm = _tqdm() if wanted else None
    if tqdm is None:
        yield None
        return
    shape = "{l_bar}{bar}| {elapsed}, {remaining} left{postfix}"
    with tqdm(total=100.0, desc=title, bar_format=shape) as shown:

        def show(share: float, text: str) -> None:
            shown.set_postfix_str(text, refresh=False)
            shown.update(100.0 * share - shown.n)

        yield show


def _tqdm() -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm

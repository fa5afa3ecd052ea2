"""Errors of the package."""

from __future__ import annotations


class Error(Exception):
    """Why a request of the package ended early.

    Attributes
    ----------
    file : str or None
        The file or folder that the error is about; ``<dict>`` for the text of a dict.
    line, column : int or None
        Place in the file, from 1.
    help : str or None
        What to do about it.
    """

    def __init__(
        self,
        message: str,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        help: str | None = None,
    ) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column
        self.help = help

    def __reduce__(self) -> tuple[type[Error], tuple[object, ...]]:
        return type(self), (*self.args, self.file, self.line, self.column, self.help)


class RefusalError(Error):
    """The request was at fault, and nothing was begun."""


class FailureError(Error):
    """Something failed, such as a run or the disk."""

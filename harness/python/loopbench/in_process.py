"""Python functions of this process as methods and metrics of a sweep: a small program connects them to it."""

from __future__ import annotations

import socket
import sys
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Callable, Iterator, Mapping

from .serving import answer_all

#: The program that a sweep starts: copies its standard streams from and to a socket.
_CONNECT = """
import os, socket, sys, threading
peer = socket.socket(socket.AF_UNIX)
peer.connect(sys.argv[1])
def copy(source, target):
    while block := os.read(source, 1 << 20):
        while block:
            block = block[os.write(target, block):]
def send():
    copy(0, peer.fileno())
    peer.shutdown(socket.SHUT_WR)
threading.Thread(target=send, daemon=True).start()
copy(peer.fileno(), 1)
"""


def _answer(kind: str, function: Callable[..., Any], peer: socket.socket) -> None:
    method, metric = (function, None) if kind == "method" else (None, function)
    with peer, peer.makefile("rb") as questions, peer.makefile("wb") as answers:
        try:
            answer_all(method, questions, answers, metric)
        except (EOFError, OSError):  # the cell was ended
            pass


def _listen(kind: str, function: Callable[..., Any], listener: socket.socket) -> None:
    while True:
        try:
            peer, _ = listener.accept()
        except OSError:  # closed
            return
        threading.Thread(target=_answer, args=(kind, function, peer), daemon=True).start()


class _Listeners:
    """Threads that answer for functions, each at an address in a folder."""

    def __init__(self, folder: str) -> None:
        self._folder = Path(folder)
        self._program = self._folder / "connect.py"
        self._program.write_text(_CONNECT)
        self._open: list[socket.socket] = []

    def entry(self, kind: str, given: Any) -> Any:
        """An entry of the config; that of a function becomes one of a program."""
        options = dict(given) if isinstance(given, Mapping) else {kind: given}
        function = options.get(kind)
        if not callable(function):
            return given
        # The address is new in every call, so that cells of earlier runs are not reused.
        address = str(self._folder / str(len(self._open)))
        listener = socket.socket(socket.AF_UNIX)
        self._open.append(listener)
        listener.bind(address)
        listener.listen()
        threading.Thread(target=_listen, args=(kind, function, listener), daemon=True).start()
        label = getattr(function, "__name__", type(function).__name__)
        serve = f"'{sys.executable}' '{self._program}' '{address}'"
        return {"label": label, **options, kind: "command", "serve": serve}

    def close(self) -> None:
        for listener in self._open:
            listener.shutdown(socket.SHUT_RDWR)  # wakes the thread that accepts
            listener.close()


@contextmanager
def served(config: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """The config with the functions among its methods and metrics replaced by programs that ask them.

    Both may contain a function, or a dictionary with `method: function` (`metric: function`) and
    options such as `label`. Functions of one name need labels. While the context lasts, threads of
    this process answer; the functions may be called by several threads at a time if the sweep has
    several jobs.
    """
    with tempfile.TemporaryDirectory(prefix="loopbench-functions-") as folder:
        listeners = _Listeners(folder)
        try:
            replaced = {
                key: [listeners.entry(key[:-1], each) for each in config[key]]
                for key in ("methods", "metrics")
                if isinstance(config.get(key), (list, tuple))
            }
            yield {**config, **replaced}
        finally:
            listeners.close()

"""Python functions of this process as methods of a sweep: a small program connects them to it."""

from __future__ import annotations

import socket
import sys
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Iterator, Mapping

from .serving import Method, answer_all

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


def _answer(function: Method, peer: socket.socket) -> None:
    with peer, peer.makefile("rb") as questions, peer.makefile("wb") as answers:
        try:
            answer_all(function, questions, answers)
        except (EOFError, OSError):  # the cell was ended
            pass


def _listen(function: Method, listener: socket.socket) -> None:
    while True:
        try:
            peer, _ = listener.accept()
        except OSError:  # closed
            return
        threading.Thread(target=_answer, args=(function, peer), daemon=True).start()


def _label(function: Method) -> str:
    return getattr(function, "__name__", type(function).__name__)


@contextmanager
def served(config: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """The config with the functions among its methods replaced by programs that ask them.

    `methods` may contain a function, or a dictionary with `method: function` and options such as
    `label`. Functions of one name need labels. While the context lasts, threads of this process
    answer; the functions may be called by several threads at a time if the sweep has several jobs.
    """
    methods = []
    listeners = []
    with tempfile.TemporaryDirectory(prefix="loopbench-functions-") as folder:
        program = Path(folder) / "connect.py"
        program.write_text(_CONNECT)
        try:
            for number, entry in enumerate(config.get("methods", [])):
                options = dict(entry) if isinstance(entry, Mapping) else {"method": entry}
                function = options.get("method")
                if not callable(function):
                    methods.append(entry)
                    continue
                address = str(Path(folder) / str(number))
                listener = socket.socket(socket.AF_UNIX)
                listeners.append(listener)
                listener.bind(address)
                listener.listen()
                threading.Thread(target=_listen, args=(function, listener), daemon=True).start()
                options = {"label": _label(function), **options, "method": "command"}
                # The address is new in every call, so that cells of earlier runs are not reused.
                methods.append({**options, "serve": f"'{sys.executable}' '{program}' '{address}'"})
            yield {**config, "methods": methods}
        finally:
            for listener in listeners:
                listener.shutdown(socket.SHUT_RDWR)  # wakes the thread that accepts
                listener.close()

"""Calls of compiled functions that Ctrl-C interrupts."""

from __future__ import annotations

import threading
from typing import Any, Callable


def interruptible(function: Callable[..., Any], *arguments: Any) -> Any:
    """Calls a function that does not hold the interpreter's lock.

    In the main thread, another thread computes, so that KeyboardInterrupt is raised at once; what was
    computing ends later, and its result is dropped.

    >>> interruptible(divmod, 7, 2)
    (3, 1)
    >>> interruptible(divmod, 7, 0)
    Traceback (most recent call last):
    ZeroDivisionError: integer division or modulo by zero
    """
    if threading.current_thread() is not threading.main_thread():
        return function(*arguments)
    done: list[Any] = []
    failed: list[BaseException] = []

    def call() -> None:
        try:
            done.append(function(*arguments))
        except BaseException as error:  # noqa: BLE001: raised in the caller's thread
            failed.append(error)

    thread = threading.Thread(target=call, daemon=True)
    thread.start()
    thread.join()
    if failed:
        raise failed[0]
    return done[0]

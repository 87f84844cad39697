# SPDX-License-Identifier: BSD-2-Clause
"""Contexts of the library: one for each thread, made when it is first needed."""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Callable
from typing import Any

from ._native import ffi, lib
from .errors import OptionError, as_bytes, error, text

log = logging.getLogger("asj")
_LEVELS = {
    lib.ASJ_LOG_ERROR: logging.DEBUG,  # an error is raised as an exception too
    lib.ASJ_LOG_WARNING: logging.WARNING,
    lib.ASJ_LOG_INFO: logging.INFO,
    lib.ASJ_LOG_DEBUG: logging.DEBUG,
}
_BACKENDS = {"auto": lib.ASJ_BACKEND_AUTO, "cpu": lib.ASJ_BACKEND_CPU, "opencl": lib.ASJ_BACKEND_OPENCL}

Progress = Callable[[str, float], Any]


class Context:
    """Threads, device and scratch memory of the library. One thread at a time uses it.

    threads   of the CPU path; 0 = as many as processors. Results do not depend on it
    backend   "auto" (a GPU through OpenCL where there is one), "cpu", "opencl"; None = "opencl" with a device, else "cpu"
    device    which OpenCL device: its number, "gpu", "cpu", or a part of its name
    progress  called with the name of the stage and how much is done (0 to 1); a result that is true stops the call, which then
              raises Cancelled, and so does an exception, which is passed on

    >>> Context(threads=1).backend
    'cpu'
    """

    def __init__(self, threads: int = 0, backend: str | None = None, device: str | int | None = None,
                 progress: Progress | None = None) -> None:  # fmt: skip
        if backend is None:
            backend = "cpu" if device is None else "opencl"
        if backend == "cpu" and device is not None:
            raise OptionError(f"device {device!r} changes nothing with backend='cpu'")
        if backend not in _BACKENDS:
            raise OptionError(f"backend is {backend!r}: one of {', '.join(_BACKENDS)}")
        self.progress = progress
        self._messages: list[str] = []
        self._exception: BaseException | None = None
        self._handle = ffi.new_handle(self)
        options = ffi.new("asj_context_options *")
        lib.asj_context_options_init(options)
        try:
            options.threads = threads
        except OverflowError:
            raise OptionError(f"threads is {threads}: 0 or as many as there should be") from None
        options.backend = _BACKENDS[backend]
        name = ffi.new("char[]", as_bytes(str(device), "device")) if device is not None else ffi.NULL
        options.device = name
        options.log = lib.asj_python_log
        options.log_user = self._handle
        options.log_level = lib.ASJ_LOG_WARNING
        options.progress = lib.asj_python_progress
        options.progress_user = self._handle
        place = ffi.new("asj_context **")
        status = lib.asj_context_create(options, place)
        if status != lib.ASJ_OK:
            raise error(status, "\n".join(self._messages))
        self._pointer = ffi.gc(place[0], _free)
        self._lock = threading.RLock()  # a callback that calls the context once more: the library refuses that

    @property
    def threads(self) -> int:
        """Threads of the CPU path."""
        return int(lib.asj_context_threads(self._pointer))

    @property
    def backend(self) -> str:
        """Where the data-parallel steps run: "cpu" or "opencl"."""
        return "opencl" if lib.asj_context_backend(self._pointer) == lib.ASJ_BACKEND_OPENCL else "cpu"

    @property
    def device(self) -> str | None:
        """Name of the OpenCL device; None on the CPU."""
        name = lib.asj_context_device(self._pointer)
        return None if name == ffi.NULL else text(name)

    def call(self, function: Any, *arguments: Any) -> None:
        """Calls a function of the library with this context in front; raises what it reports, or what a callback raised.

        The interpreter lock is released meanwhile. An interrupt (Ctrl-C) stops the call at its next report of progress.
        """
        with self._lock:
            self._messages.clear()
            self._exception = None
            status = function(self._pointer, *arguments)
            raised, self._exception = self._exception, None
            if raised is not None:
                raise raised
            if status != lib.ASJ_OK:
                raise error(status, text(lib.asj_context_message(self._pointer)))


def _free(pointer: Any) -> None:
    place = ffi.new("asj_context **", pointer)
    lib.asj_context_free(place)


def _stop(kind: type[BaseException], value: BaseException | None, traceback: Any) -> int:
    """An exception of the callback, or an interrupt at any place in it: the call stops, and passes it on."""
    context: Context = ffi.from_handle(traceback.tb_frame.f_locals["user"])
    context._exception = value or kind()
    return 1


@ffi.def_extern(name="asj_python_progress", error=1, onerror=_stop)  # type: ignore[untyped-decorator]
def _progress(user: Any, stage: int, done: float) -> int:
    context: Context = ffi.from_handle(user)
    return 1 if context.progress is not None and context.progress(text(lib.asj_stage_name(stage)), done) else 0


@ffi.def_extern(name="asj_python_log")  # type: ignore[untyped-decorator]
def _log(user: Any, level: int, message: Any) -> None:
    context: Context = ffi.from_handle(user)
    line = text(message)
    context._messages.append(line)
    log.log(_LEVELS.get(level, logging.DEBUG), "%s", line)


_local = threading.local()


def current() -> Context:
    """The context of this thread, made when first asked for. A process that was forked makes its own."""
    context: Context | None = getattr(_local, "context", None)
    if context is None or _local.process != os.getpid():
        context = Context()
        _local.context = context
        _local.process = os.getpid()
    return context


def given(context: Context | None) -> Context:
    """A function's argument, or the context of this thread."""
    return current() if context is None else _expect(context)


def _expect(context: object) -> Context:
    if not isinstance(context, Context):
        raise TypeError(f"an asj.Context is wanted, not {context!r:.60}")
    return context


def set_current(context: Context) -> None:
    """Lets the functions of this package use that context in this thread, when they are given none."""
    _expect(context)
    _local.context = context
    _local.process = os.getpid()

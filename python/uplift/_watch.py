"""How an analysis is followed and stopped."""

from __future__ import annotations

import atexit
import ctypes
import signal
import sys
import threading
import time
from typing import Any, Callable, Optional, Set, Union

from . import _library
from ._results import array_of

StepCallback = Callable[["StepView"], Any]


class StepView:
    """A step of a run, as the function that `step` of :meth:`Case.run` names sees it. Arrays are copies."""

    def __init__(self, given: _library.Step) -> None:
        self.time: float = given.time
        self.number: int = given.number
        self.stage: int = given.stage
        self.displacement = array_of(given.displacement, given.unknowns).copy()
        self.velocity = array_of(given.velocity, given.unknowns).copy() if given.velocity else None
        self.opening = array_of(given.opening, given.rows).copy()
        self.force = array_of(given.force, given.rows).copy()


_running: Set["Watcher"] = set()


@atexit.register
def _stop_all() -> None:
    """Ends the runs of threads that nobody waits for, before the interpreter goes."""
    for watcher in list(_running):
        watcher.on_interrupt()
    limit = time.monotonic() + 2
    while _running and time.monotonic() < limit:
        time.sleep(0.005)


class Watcher:
    """Progress bar, step function and Ctrl-C of one analysis."""

    def __init__(self, progress: Union[bool, None], step: Optional[StepCallback], step_check: bool, fields: Optional[str]) -> None:
        self.options = _library.Options()
        _library.library().uplift_options_init(ctypes.byref(self.options))
        self.options.step_check = int(step_check)
        self._cancel = ctypes.c_int(0)
        self.options.cancel = ctypes.pointer(self._cancel)
        self._fields = fields.encode() if fields else None
        self.options.fields_folder = self._fields
        self._bar = sys.stderr.isatty() if progress is None else progress
        self._drawn = 0.0
        self._step = step
        self.raised: Optional[BaseException] = None
        self._caught = False
        self._progress_function = _library.ProgressFunction(self._on_progress)
        self._step_function = _library.StepFunction(self._on_step)
        self.options.progress = self._progress_function
        if step is not None:
            self.options.step = self._step_function

    def __enter__(self) -> None:
        _running.add(self)
        in_main = threading.current_thread() is threading.main_thread()
        if in_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self.on_interrupt)
            self._caught = True

    def __exit__(self, *_: Any) -> None:
        _running.discard(self)
        if self._caught:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def on_interrupt(self, *_: Any) -> None:
        self._cancel.value = 1

    def _on_progress(self, user: Any, given: Any) -> int:
        try:
            now = time.monotonic()
            if self._bar and now - self._drawn > 0.1:
                self._drawn = now
                state = given.contents
                done = int(30 * state.fraction)
                label = (state.label or b"").decode()
                sys.stderr.write(f"\r{label:<28.28} [{'#' * done}{'.' * (30 - done)}] t = {state.time:.3f} s, {100 * state.uplifted:.0f} % uplifted ")
                sys.stderr.flush()
            return 0
        except BaseException as error:
            return self._stop(error)

    def _on_step(self, user: Any, given: Any) -> int:
        try:
            assert self._step is not None
            answer = self._step(StepView(given.contents))
            return 0 if answer is None or answer else 1
        except BaseException as error:
            return self._stop(error)

    def _stop(self, error: BaseException) -> int:
        self._cancel.value = 1
        if self.raised is None:
            self.raised = error
        return 1

    def finish(self) -> None:
        """Clears the bar; raises what a function of the caller raised."""
        if self._drawn:
            sys.stderr.write("\r" + " " * 100 + "\r")
            sys.stderr.flush()
        if self.raised is not None:
            raise self.raised

"""Runs that are made step by step."""

from __future__ import annotations

import threading
from typing import Any, Optional, Sequence

from ._case import Case
from ._motion import Motion
from ._results import Run
from ._watch import StepView


class _MarchState:
    """What the thread of a march and its owner share. The thread does not know the owner, so that a march that is left can be collected."""

    def __init__(self) -> None:
        self.go = threading.Semaphore(0)
        self.ready = threading.Semaphore(0)
        self.step: Optional[StepView] = None
        self.stopping = False
        self.done = False
        self.run: Optional[Run] = None
        self.error: Optional[BaseException] = None

    def work(self, case: Case, motions: Sequence[Motion]) -> None:
        try:
            self.go.acquire()
            if not self.stopping:
                self.run = case.run(*motions, progress=False, step_check=False, step=self.see)
        except BaseException as error:
            self.error = error
        self.done = True
        self.ready.release()

    def see(self, step: StepView) -> bool:
        self.step = step
        self.ready.release()
        self.go.acquire()
        return not self.stopping

    def stop(self) -> None:
        if not self.done and not self.stopping:
            self.stopping = True
            self.go.release()


class March:
    """A run that is made step by step: `for step in march: ...`. `stop`, `results` or the end of a `with` block ends the run."""

    def __init__(self, case: Case, *motions: Motion) -> None:
        self._state = _MarchState()
        self._thread = threading.Thread(target=self._state.work, args=(case, motions), daemon=True)
        self._thread.start()

    def __iter__(self) -> "March":
        return self

    def __next__(self) -> StepView:
        state = self._state
        if state.done or state.stopping:
            raise StopIteration
        state.go.release()
        state.ready.acquire()
        if state.done:
            if state.error is not None:
                raise state.error
            raise StopIteration
        assert state.step is not None
        return state.step

    def stop(self) -> None:
        """Ends the run in order."""
        self._state.stop()
        self._thread.join()

    @property
    def results(self) -> Run:
        """The results up to here. Ends the run when it is still going."""
        self.stop()
        if self._state.error is not None:
            raise self._state.error
        if self._state.run is None:
            raise RuntimeError("the march has no step yet")
        return self._state.run

    def __enter__(self) -> "March":
        return self

    def __exit__(self, *_: Any) -> None:
        self.stop()

    def __del__(self) -> None:
        if hasattr(self, "_state"):
            self._state.stop()


def march(case: Case, *motions: Motion) -> March:
    """Runs a case step by step; see :class:`March`."""
    return March(case, *motions)

"""Interface laws that are written in Python."""

from __future__ import annotations

import ctypes
import itertools
import sys
from typing import Any, Callable, Dict, Optional

from . import _library
from ._parts import Quantity

_numbers = itertools.count(1)


class ExternalLaw:
    """A law that is a function; made by :func:`law`."""

    def __init__(self, function: Callable[..., Any], name: str, K_n: Quantity, K_t: Quantity, memory: int) -> None:
        self.function, self.name, self.K_n, self.K_t, self.memory = function, name, K_n, K_t, memory
        self.raised: Optional[BaseException] = None  # the first exception of the function in a run
        self._callback = _library.LawFunction(self._call)

    def __deepcopy__(self, _: Any) -> "ExternalLaw":
        return self  # a function

    def table(self) -> Dict[str, Any]:
        """The table of the case that stands for this law."""
        return {"type": "external", "name": self.name, "K_n": self.K_n, "K_t": self.K_t, "memory": self.memory}

    def connect(self, case: _library.Handle) -> None:
        """Connects the function to a case of the library."""
        _library.call("uplift_case_set_law", case.pointer, self.name.encode(), self._callback, None)
        case.laws = getattr(case, "laws", []) + [self]  # type: ignore[attr-defined]

    def _call(self, user: Any, points: int, components: int, step: float, *pointers: Any) -> int:
        try:
            import numpy as np

            def view(pointer: Any, *shape: int) -> Any:
                size = int(np.prod(shape))
                if size == 0:
                    return np.empty(shape)
                return np.ctypeslib.as_array(pointer, (size,)).reshape(shape)

            def copied(pointer: Any, *shape: int) -> Any:
                return view(pointer, *shape).copy()  # the function may keep or change what it is given

            def checked(value: Any, what: str, *shape: int) -> Any:
                made = np.asarray(value, dtype=float)
                if made.shape != shape:
                    raise ValueError(f"the law {self.name!r} returned {what} of the shape {made.shape}, expected {shape}")
                return made

            start, end, old, traction, slope, memory, stored, dissipated = pointers
            given = (copied(start, components, points), copied(end, components, points), copied(old, self.memory, points))
            result = self.function(*given, step)
            view(traction, components, points)[...] = checked(result[0], "a traction", components, points)
            made_slope = np.asarray(result[1], dtype=float)
            into = view(slope, components, components, points)
            if made_slope.ndim == 2:  # one slope per component: no coupling
                made_slope = checked(made_slope, "a slope", components, points)
                into[...] = 0
                for component in range(components):
                    into[component, component] = made_slope[component]
            else:
                into[...] = checked(made_slope, "a slope", components, components, points)
            if self.memory:
                view(memory, self.memory, points)[...] = checked(result[2], "a memory", self.memory, points)
            view(stored, points)[...] = checked(result[3], "a stored energy", points)
            view(dissipated, points)[...] = checked(result[4], "a dissipated energy", points) if len(result) > 4 else 0.0
            return 0
        except BaseException as error:
            if self.raised is None:
                self.raised = error
            return 1


def law(
    function: Callable[..., Any], *, K_n: Quantity, K_t: Quantity = 0.0, memory: int = 0, name: str = ""
) -> ExternalLaw:
    """An interface law of one's own.

    `function(start, end, memory, step)` is called with all points of an interface: `start` and `end`, the openings [m] at the beginning and
    at the end of the step, have the shape (components, points), the normal component last, opening > 0; `memory` has the shape
    (memory, points); `step` is the length of the step [s], 0 in statics. It returns

        traction    (components, points) [Pa], tension > 0, at the end of the step
        slope       (components, components, points) [Pa/m], or one per component without coupling
        memory      (memory, points) at the end of the step
        stored      (points) [J/m2]: stored energy at the end of the step
        dissipated  (points) [J/m2]: energy dissipated since the beginning of the analysis; may be left out

    The sum of the energies must be the work of the traction along the path. With `start` equal to `end` the memory must stay.

    Parameters:
        K_n: normal stiffness of the closed joint [Pa/m], for the bonded run and the static stages.
        K_t: shear stiffness of the closed joint [Pa/m].
        memory: memory variables of a point.
        name: name in messages and in the case.
    """
    return ExternalLaw(function, name or f"{getattr(function, '__name__', 'law')} {next(_numbers)}", K_n, K_t, memory)

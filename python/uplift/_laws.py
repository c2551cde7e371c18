"""Interface laws that are written in Python."""

from __future__ import annotations

import ctypes
import itertools
from typing import TYPE_CHECKING, Any, Callable, Dict, Optional

from . import _library
from ._parts import Quantity

if TYPE_CHECKING:
    from ._results import Array

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
            start, end, old, traction, slope, memory, stored, dissipated = pointers
            # copies: the function may keep or change what it is given
            given = [_view(start, components, points).copy(), _view(end, components, points).copy(), _view(old, self.memory, points).copy()]
            result = self.function(*given, step)
            _check_result(result, self.name)
            _fill(_view(traction, components, points), result[0], f"the law {self.name!r} returned a traction")
            _fill_slope(_view(slope, components, components, points), result[1], f"the law {self.name!r} returned a slope")
            if self.memory:
                _fill(_view(memory, self.memory, points), result[2], f"the law {self.name!r} returned a memory")
            _fill(_view(stored, points), result[3], f"the law {self.name!r} returned a stored energy")
            lost = result[4] if len(result) > 4 else [0.0] * points
            _fill(_view(dissipated, points), lost, f"the law {self.name!r} returned a dissipated energy")
            return 0
        except BaseException as error:
            if self.raised is None:
                self.raised = error
            return 1


def _check_result(result: Any, name: str) -> None:
    wanted = "expected (traction, slope, memory, stored) or (traction, slope, memory, stored, dissipated)"
    if not isinstance(result, (tuple, list)):
        raise TypeError(f"the law {name!r} returned {type(result).__name__}, {wanted}")
    if len(result) not in (4, 5):
        raise ValueError(f"the law {name!r} returned {len(result)} values, {wanted}")


def _view(pointer: Any, *shape: int) -> "Array":
    """The library's numbers as an array, without a copy."""
    import numpy as np

    size = int(np.prod(shape))
    if size == 0:
        return np.empty(shape)
    made: Array = np.ctypeslib.as_array(pointer, (size,)).reshape(shape)
    return made


def _fill(into: "Array", value: Any, what: str) -> None:
    import numpy as np

    made = np.asarray(value, dtype=float)
    if made.shape != into.shape:
        raise ValueError(f"{what} of the shape {made.shape}, expected {into.shape}")
    into[...] = made


def _fill_slope(into: "Array", value: Any, what: str) -> None:
    """A full slope, or one number per component: no coupling."""
    import numpy as np

    made = np.asarray(value, dtype=float)
    if made.ndim == 2 and made.shape == into.shape[1:]:
        diagonal = np.zeros(into.shape)
        for component in range(len(made)):
            diagonal[component, component] = made[component]
        made = diagonal
    _fill(into, made, what)


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

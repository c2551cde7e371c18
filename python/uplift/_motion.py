"""Ground motions of a run."""

from __future__ import annotations

import os
from typing import Any, Dict, Mapping, Optional, Sequence, Union

from ._parts import Quantity


class Motion(Dict[str, Any]):
    """A recorded or generated ground motion for one direction; see :func:`motion`."""


def motion(
    file: Union[str, "os.PathLike[str]", None] = None,
    *,
    direction: Optional[Sequence[float]] = None,
    pga: Optional[Quantity] = None,
    factor: Optional[Quantity] = None,
    process: Sequence[Mapping[str, Any]] = (),
    generate: Optional[Mapping[str, Any]] = None,
    amplitude: Optional[Quantity] = None,
    **record: Any,
) -> Motion:
    """A ground acceleration for :meth:`Case.run`.

    Parameters:
        file: record in any format that `uplift motion` reads.
        direction: direction of the acceleration; default: the x axis.
        pga: peak acceleration to which the record is scaled ("0.4 g_n").
        factor: factor instead of `pga`.
        process: processing steps (:mod:`uplift.processes`), in order, before the scaling.
        generate: instead of a file, a motion that fits a target spectrum (:mod:`uplift.targets`).
        amplitude: factor of the acceleration; default 1.
        record: other keys of the table [[record]]: format, unit, step, column, component.
    """
    if (file is None) == (generate is None):
        raise TypeError("motion() takes a file or `generate`, and not both")
    if file is not None and not isinstance(file, (str, os.PathLike)):
        raise TypeError(
            "motion() takes the name of a file; for an array: case.function(name, up.functions.table(times=t, values=a)), "
            "then case.ground_acceleration([1, 0], function=name)"
        )
    steps = [{"do": step} for step in process]
    if pga is not None or factor is not None:
        steps.append({"do": {"type": "scale", "pga": pga, "factor": factor}})
    table = {"file": None if file is None else os.path.abspath(os.fspath(file)), "generate": generate, "process": steps or None, **record}
    return Motion({"record": table, "direction": direction, "amplitude": amplitude})

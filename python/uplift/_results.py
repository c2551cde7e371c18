"""Results of an analysis."""

from __future__ import annotations

import ctypes
import html
import json
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _library

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


def array_of(pointer: Any, count: int, owner: Any = None) -> "Array":
    """A NumPy view of numbers of the library, which keeps their owner alive. It cannot be written to."""
    import numpy as np

    if count == 0 or not pointer:
        return np.empty(0)
    buffer = (ctypes.c_double * count).from_address(ctypes.addressof(pointer.contents))
    buffer._owner = owner  # type: ignore[attr-defined]
    made: Array = np.frombuffer(memoryview(buffer), dtype=np.float64)
    made.flags.writeable = False
    return made


class Record(Mapping[str, Any]):
    """A table of the results document: `record["max_moment"]` or `record.max_moment`."""

    def __init__(self, table: Mapping[str, Any]) -> None:
        self._table = table

    def __getitem__(self, key: str) -> Any:
        return _wrapped(self._table[key])

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f"no {key!r}; there are {', '.join(self._table)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._table)

    def __len__(self) -> int:
        return len(self._table)

    def __dir__(self) -> List[str]:
        return list(self._table) + list(super().__dir__())

    def __repr__(self) -> str:
        return f"{type(self).__name__}({dict(self._table)!r})"


def _wrapped(value: Any) -> Any:
    if isinstance(value, Mapping):
        return Record(value)
    if isinstance(value, list):
        return [_wrapped(each) for each in value]
    return value


class VerdictNumber(float):
    """A number of the verdict, in SI units: a float with `unit`, `time` [s] and what is known of its error.

    `step_change_percent` is its change with twice the step (None: not examined), `bonded` the value of the bonded model.
    """

    unit: str
    time: Optional[float]
    bonded: Optional[float]
    step_change_percent: Optional[float]

    def __new__(cls, value: float, unit: str = "1", **known: Any) -> "VerdictNumber":
        made = super().__new__(cls, value)
        made.unit = unit
        made.time = known.get("time")
        made.bonded = known.get("bonded")
        made.step_change_percent = known.get("step_change_percent")
        return made

    def __reduce__(self) -> Any:
        return _number, (dict(self.__dict__, value=float(self)),)

    def __repr__(self) -> str:
        return f"{float(self):.6g} {self.unit}" if self.unit != "1" else f"{float(self):.6g}"


def _number(table: Mapping[str, Any]) -> VerdictNumber:
    return VerdictNumber(**table)


def _numbers(numbers: Mapping[str, Any]) -> Dict[str, Any]:
    return {name: _number(table) if isinstance(table, Mapping) and table.get("value") is not None else None for name, table in numbers.items()}


class Verdict(Record):
    """The verdict: `headline`, `level`, `converged`, `uplift` and the numbers of every base."""

    @property
    def converged(self) -> Optional[bool]:
        """Whether no number moves by more than 5 %, no force on a base by more than 3 %, with twice the step; None: not examined."""
        result = self._table["step_check"]["result"]
        return {"converged": True, "not converged": False}.get(result)

    @property
    def bases(self) -> Dict[str, Dict[str, Any]]:
        """Numbers of every interface by their names, as :class:`VerdictNumber`."""
        return {each["name"]: _numbers(each["numbers"]) for each in self._table["interfaces"]}

    @property
    def structure(self) -> Dict[str, Any]:
        """Numbers of the structure as a whole."""
        return _numbers(self._table["numbers"])

    @property
    def uplift(self) -> float:
        """Largest uplifted share of the area of any base."""
        shares = [each.get("max_uplifted_ratio") for each in self.bases.values()]
        return max((float(each) for each in shares if each is not None), default=0.0)

    def __repr__(self) -> str:
        return f"<Verdict: {self._table['headline']}>"


class Floor:
    """Absolute acceleration of a floor at every step of the dynamic stages."""

    def __init__(self, name: str, step: float, acceleration: "Array") -> None:
        self.name, self.step, self.acceleration = name, step, acceleration

    @property
    def time(self) -> "Array":
        """Instants [s] from the beginning of the dynamic stages."""
        import numpy as np

        made: Array = self.step * np.arange(len(self.acceleration))
        return made

    def psa(self, damping: float = 0.05, frequencies: Optional[Sequence[float]] = None) -> Tuple["Array", "Array"]:
        """Frequencies [Hz] and pseudo-accelerations [m/s2] of the floor response spectrum."""
        return psa(self.acceleration, self.step, damping=damping, frequencies=frequencies)


def psa(
    acceleration: Any, step: float, *, damping: float = 0.05, frequencies: Optional[Sequence[float]] = None
) -> Tuple["Array", "Array"]:
    """Pseudo-acceleration response spectrum: frequencies [Hz], by default 200 from 0.1 to 50 Hz, and values [m/s2].

    Exact for an acceleration [m/s2] that varies linearly between its points at equal steps [s]; peaks between the points are found within
    1e-4, as in floor_spectra.csv.
    """
    import numpy as np

    values = np.ascontiguousarray(acceleration, dtype=np.float64)
    if values.ndim != 1:
        raise ValueError(f"an acceleration history has one dimension, found an array of the shape {values.shape}")
    at = np.ascontiguousarray(np.geomspace(0.1, 50, 200) if frequencies is None else frequencies, dtype=np.float64)
    made = np.empty_like(at)
    pointer = ctypes.POINTER(ctypes.c_double)
    _library.call(
        "uplift_spectrum",
        values.ctypes.data_as(pointer),
        values.size,
        step,
        damping,
        at.ctypes.data_as(pointer),
        at.size,
        made.ctypes.data_as(pointer),
    )
    return at, made


def solve_problem(problem: Union[str, Mapping[str, Any]], method: Optional[str] = None) -> List[Record]:
    """Solves the interface problem of one step alone, by one contact method or by all of them.

    `problem` is the content of a file `problem_NAME.json`, as text or as tables, or a problem of one's own in this format (guide, "C and
    C++"). Each answer has `method`, `converged`, `iterations`, `residual`, `opening` [m], `force` [N] and `why`. Raises InputError.
    """
    text = problem if isinstance(problem, str) else json.dumps(problem)
    given = None if method is None else method.encode()
    answers = json.loads(_library.text_of("uplift_problem_solve", text.encode(), given))["methods"]
    return [Record(each) for each in answers]


def framed(page: str) -> str:
    """An HTML page as part of a notebook."""
    return f'<iframe srcdoc="{html.escape(page, quote=True)}" style="width: 100%; height: 800px; border: 0"></iframe>'


class Histories(Mapping[str, "Array"]):
    """Histories of one run by name, as NumPy views; `time` is their common abscissa."""

    def __init__(self, handle: _library.Handle, index: int) -> None:
        self._handle, self._index = handle, index
        name = _library.library().uplift_results_run_name(handle.pointer, index)
        if name is None:
            raise IndexError(f"no run {index}")
        self.name: str = name.decode()
        self.units: Dict[str, str] = {}
        self._columns: Dict[str, Any] = {}
        column = _library.Column()
        for k in range(_library.library().uplift_results_columns(handle.pointer, index)):
            _library.library().uplift_results_column(handle.pointer, index, k, ctypes.byref(column))
            key = column.name.decode()
            self.units[key] = column.unit.decode()
            self._columns[key] = (ctypes.cast(column.values, ctypes.POINTER(ctypes.c_double)), column.count)

    def __getitem__(self, name: str) -> "Array":
        if name not in self._columns:
            import difflib

            near = difflib.get_close_matches(name, self._columns, 1)
            raise KeyError(f"no history {name!r}" + (f"; did you mean {near[0]!r}?" if near else f"; there are {', '.join(self._columns)}"))
        return array_of(self._columns[name][0], self._columns[name][1], self._handle)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def time(self) -> "Array":
        """Instants [s]; load factors of static cases."""
        if not self._columns:
            import numpy as np

            return np.empty(0)  # a run that failed before its first instant
        return self[next(iter(self._columns))]

    def frame(self) -> Any:
        """All histories as a pandas DataFrame over the time."""
        import pandas

        if not self._columns:
            return pandas.DataFrame()
        first = next(iter(self._columns))
        return pandas.DataFrame({name: self[name] for name in self if name != first}, index=pandas.Index(self.time, name=first))


class Results:
    """What an analysis computed."""

    def __init__(self, handle: _library.Handle) -> None:
        self._handle = handle
        self._summary: Optional[Dict[str, Any]] = None
        count = _library.library().uplift_results_runs(handle.pointer)
        self.runs: List[Histories] = [Histories(handle, index) for index in range(count)]

    @property
    def summary(self) -> Dict[str, Any]:
        """The results document: the content of summary.json."""
        if self._summary is None:
            self._summary = json.loads(_library.lent_text("uplift_results_json", self._handle.pointer))
        return self._summary

    @property
    def verdict(self) -> Verdict:
        """The verdict on the first run."""
        return Verdict(self.summary["verdict"])

    @property
    def report(self) -> str:
        """The report as one HTML page."""
        return _library.lent_text("uplift_results_report", self._handle.pointer)

    def write(self, folder: Union[str, "os.PathLike[str]"]) -> None:
        """Writes report.html, histories.csv, summary.json and case.resolved.toml. Earlier results are moved aside.

        Fields are written during the run: `fields` of :meth:`Case.run` names a folder for them and for all of this.
        """
        pointer = ctypes.c_void_p()
        _library.call("uplift_results_write", self._handle.pointer, os.fspath(folder).encode(), ctypes.byref(pointer))
        _library.library().uplift_text_free(pointer)

    def _repr_html_(self) -> str:
        return framed(self.report)


class Run(Results):
    """A run of a case: histories by name (`run["underside.moment"]`), verdict, energies, floors, report."""

    def __init__(self, handle: _library.Handle, floor_at: Optional[Callable[[str], Optional["Run"]]] = None) -> None:
        super().__init__(handle)
        self._floor_at = floor_at
        self._floors: Dict[str, Floor] = {}

    def __getitem__(self, name: str) -> "Array":
        return self.runs[0][name]

    @property
    def time(self) -> "Array":
        """Instants of the histories [s]; load factors of static cases."""
        return self.runs[0].time

    @property
    def names(self) -> List[str]:
        """Names of the histories."""
        return list(self.runs[0])

    @property
    def units(self) -> Dict[str, str]:
        """Units of the histories."""
        return self.runs[0].units

    @property
    def bonded(self) -> Optional[Histories]:
        """Histories of the bonded model; None without a bonded run."""
        return self.runs[1] if len(self.runs) > 1 else None

    @property
    def status(self) -> str:
        """"completed", "failed", "overturned", "separated" or "interrupted" (also where only the bonded run was)."""
        return str(self._decisive["status"])

    @property
    def reason(self) -> str:
        """Why the run failed or ended early."""
        return str(self._decisive["reason"])

    @property
    def _decisive(self) -> Dict[str, Any]:
        runs: List[Dict[str, Any]] = self.summary["runs"]
        if runs[0]["status"] != "completed":
            return runs[0]
        return next((run for run in runs if run["status"] == "interrupted"), runs[0])

    @property
    def energy(self) -> Record:
        """Energies at the end [J], with `residual`, `created`, `lost` and `scale`."""
        run = self.summary["runs"][0]
        table = dict(run["final_energy"])
        table.update(created=run["energy_created"]["value"], lost=run["energy_lost"]["value"], scale=run["energy_scale"])
        return Record(table)

    def floor(self, name: str) -> Floor:
        """A floor of the case (a floor_spectrum of the output) by its name, or in direction x at a node by the name of the node.

        A floor that the case has not asked for is computed by a second run of the same case, which gives the same numbers: of long runs ask
        for it before. Raises KeyError.
        """
        asked = self._asked_floors()
        if name in asked:
            return asked[name]
        if name not in self._floors:
            again = self._floor_at(name) if self._floor_at is not None and self.status not in ("interrupted", "failed") else None
            if again is None:
                raise KeyError(f"no floor {name!r}; the floors of the case are {', '.join(asked) or 'none'} (case.floor_spectrum(...) asks for one before the run)")
            self._floors[name] = again._asked_floors()[name]
        return self._floors[name]

    def _asked_floors(self) -> Dict[str, Floor]:
        step, column = ctypes.c_double(), _library.Column()
        floors: Dict[str, Floor] = {}
        while _library.library().uplift_results_floor(self._handle.pointer, 0, len(floors), ctypes.byref(step), ctypes.byref(column)):
            pointer = ctypes.cast(column.values, ctypes.POINTER(ctypes.c_double))
            floor = Floor(column.name.decode(), step.value, array_of(pointer, column.count, self._handle))
            floors[floor.name] = floor
        return floors

    def to_frame(self) -> Any:
        """All histories as a pandas DataFrame."""
        return self.runs[0].frame()

    def plot(self, *names: str, axes: Any = None) -> Any:
        """Plots histories, by default the uplifted ratio of the first base, compared with the bonded model. Returns the axes (matplotlib)."""
        import matplotlib.pyplot as pyplot

        wanted = names or tuple(name for name in self.names if name.endswith(".uplifted_ratio"))[:1]
        axes = axes if axes is not None else pyplot.subplots()[1]
        for name in wanted:
            axes.plot(self.time, self[name], label=name)
            if self.bonded is not None and name in self.bonded and not name.endswith("ratio"):
                axes.plot(self.bonded.time, self.bonded[name], "--", label=name + ", bonded")
        axes.set_xlabel("time [s]")
        axes.set_ylabel(", ".join(sorted({self.units[name] for name in wanted})))
        axes.legend()
        return axes

    def __repr__(self) -> str:
        return f"<Run: {self.status}; {self.summary['verdict']['headline']}>"


class Comparison(Results):
    """Variants side by side."""

    @property
    def table(self) -> List[Dict[str, Any]]:
        """A row for each run: name, status, peaks and agreement."""
        rows = []
        for run in self.summary["runs"]:
            row = {key: run[key] for key in ("name", "label", "group", "status")}
            row.update(
                uplifted_ratio=run["max_uplifted_ratio"]["value"],
                max_opening=run["max_opening"]["value"],
                max_base_moment=run["max_base_moment"]["value"],
                max_base_shear=run["max_base_shear"]["value"],
                max_pressure=run.get("max_pressure", {}).get("value"),
                energy_created_share=run["energy_created_share"],
            )
            if "agreement" in run:
                row.update(agreement=run["agreement"], deviation=run.get("deviation"))
            rows.append(row)
        return rows

    def to_frame(self) -> Any:
        """The table as a pandas DataFrame with the names of the runs as index."""
        import pandas

        return pandas.DataFrame(self.table).set_index("name")

    def __getitem__(self, name: str) -> Histories:
        for run in self.runs:
            if run.name == name:
                return run
        raise KeyError(f"no run {name!r}; there are {', '.join(run.name for run in self.runs)}")

    def __repr__(self) -> str:
        return f"<Comparison of {len(self.runs)} runs: {', '.join(run.name for run in self.runs)}>"


class Trust(Results):
    """A run with every choice of the computation changed, one at a time."""

    @property
    def bands(self) -> Record:
        """The bands of all numbers and floor spectra: the content of trust.json."""
        return Record(json.loads(_library.text_of("uplift_results_trust", self._handle.pointer)))

"""Studies: a case under many motions, computed by the program in processes of its own."""

from __future__ import annotations

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from . import _toml
from ._motion import Motion
from ._parts import Part
from ._program import error_of, output_of, program
from ._results import Record, framed

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]

PathLike = Union[str, "os.PathLike[str]"]
Table = Mapping[str, Any]
HEAD = "# Written by the Python package of uplift, which replaces it.\n"


class Study:
    """A study: a folder with plan.toml, whose runs the program computes. `up.load_study` opens one, :meth:`Case.study` makes one."""

    def __init__(self, folder: PathLike) -> None:
        self.folder = pathlib.Path(folder)
        self._interrupted = False

    def check(self) -> Record:
        """What the study will take: runs, time (from one run) [s], memory and disk [bytes], and warnings. Raises InputError."""
        return Record(json.loads(output_of("study", "check", str(self.folder), "--json")))

    def run(self, *, progress: Optional[bool] = None, workers: Optional[int] = None, retry: bool = False) -> Record:
        """Computes what is missing, in processes of the program, and returns `status`.

        Parameters:
            progress: show how far it is, every two seconds; by default on a terminal.
            workers: processes at the same time; by default as in the plan, else one for every core.
            retry: also compute again what failed or ran out of time or memory.

        Ctrl-C ends it in order: every result is kept, `status.interrupted` is True, and `run` again goes on from there.
        Raises InputError, and OutputError where results could not be written.
        """
        words = [program(), "study", "run", str(self.folder), "--json"]
        words += ["--workers", str(workers)] if workers is not None else []
        words += ["--retry"] if retry else []
        self._interrupted = False
        # a group of its own: Ctrl-C is passed on once, on a terminal as in a notebook
        process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", start_new_session=True
        )
        line = _StatusLine(self.folder, sys.stderr.isatty() if progress is None else progress)
        made = said = ""
        try:
            while True:
                try:
                    made, said = process.communicate(timeout=0.2)
                    break
                except subprocess.TimeoutExpired:
                    line.draw()
                except KeyboardInterrupt:
                    self._interrupted = True
                    process.send_signal(signal.SIGINT)
        finally:
            line.clear()
            if process.poll() is None:
                process.terminate()
                process.wait()
        if process.returncode not in ((0, 130, -signal.SIGINT) if self._interrupted else (0,)):
            raise error_of(process.returncode, said)
        return self._record(made) if made else self.status

    @property
    def status(self) -> Record:
        """Numbers of runs and curves, `complete` curves, `running`, `outcomes`; `interrupted`: whether Ctrl-C ended the last `run`."""
        return self._record(output_of("study", "status", str(self.folder), "--json"))

    def _record(self, text: str) -> Record:
        return Record({**json.loads(text), "interrupted": self._interrupted})

    def fit(self) -> "StudyFit":
        """Fragility curves of what has been computed so far; writes study.json and fits.csv in the folder. Raises InputError."""
        return StudyFit(json.loads(output_of("study", "fit", str(self.folder), "--json")))

    def report(self) -> str:
        """The report of what has been computed so far, as one HTML page; writes report.html, study.json and fits.csv. A notebook shows it."""
        output_of("study", "report", str(self.folder), "--quiet")
        return (self.folder / "report.html").read_text(encoding="utf-8")

    def runs(self) -> List[Dict[str, str]]:
        """The rows of runs.csv, which it writes: every run with its numbers. `pandas.DataFrame(study.runs())` is a table of texts."""
        output_of("study", "export", str(self.folder), "--quiet")
        with open(self.folder / "runs.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def tasks(self, count: int = 100) -> List[List[str]]:
        """Argument lists of at most `count` commands that compute the study together, on machines that share the folder.

        Each may be repeated, and any executor may map over them: `list(executor.map(subprocess.check_call, study.tasks(8)))`.
        """
        shards = len(output_of("study", "tasks", str(self.folder), "--count", str(count)).splitlines())
        folder = str(self.folder.resolve())
        return [[program(), "study", "work", folder, "--shard", f"{number}/{shards}", "--quiet"] for number in range(1, shards + 1)]

    def _repr_html_(self) -> Optional[str]:
        return framed(self.report()) if self.status.runs > 0 else None

    def __repr__(self) -> str:
        return f"Study({str(self.folder)!r})"


class _StatusLine:
    """Shows the line that the program keeps in status.txt while it computes."""

    def __init__(self, folder: pathlib.Path, shown: bool) -> None:
        self._file, self._shown, self._drawn = folder / "status.txt", shown, 0.0
        self._text = self._before = self._read()  # left by a process that was killed

    def _read(self) -> str:
        try:
            return self._file.read_text(encoding="utf-8").strip()
        except OSError:
            return ""

    def draw(self) -> None:
        if not self._shown or time.monotonic() - self._drawn < 0.5:
            return
        self._drawn = time.monotonic()
        text = self._read()
        if text and text != self._text:
            sys.stderr.write("\r" + text.ljust(len(self._text)))
            sys.stderr.flush()
            self._text = text

    def clear(self) -> None:
        if self._text != self._before:
            sys.stderr.write("\r" + " " * len(self._text) + "\r")
            sys.stderr.flush()


class LimitFit(Record):
    """What a study says of a limit state: its table of study.json, with `capacities`, `stripes`, `dispersion`, `capacity`, `tornado`, and, where the
    plan or the method gives them, `performance` (design motion), `risk` (hazard curve), `bootstrap` and `fractiles` (curves of a search).

    Intensities are in the unit of the study's intensity. The figures are those without the runs of unknown outcome; the attributes
    `unknown_survived` and `unknown_exceeded` are the fits with these runs counted one way and the other.
    """

    @property
    def fitted(self) -> bool:
        """Whether there is a curve; `reason` says why not."""
        return bool(self._table["fit"]["fitted"])

    @property
    def reason(self) -> str:
        """Why there is no curve; empty: there is one."""
        return str(self._table["fit"]["reason"])

    @property
    def theta(self) -> Optional[float]:
        """Median of the fragility curve; None: not fitted."""
        return self._number("theta")

    @property
    def beta(self) -> Optional[float]:
        """Standard deviation of the logarithm; None: not fitted."""
        return self._number("beta")

    @property
    def theta_interval(self) -> Tuple[Optional[float], Optional[float]]:
        """Interval of theta with the confidence `confidence`; None: not bounded, or not fitted."""
        return self._interval("theta_interval")

    @property
    def beta_interval(self) -> Tuple[Optional[float], Optional[float]]:
        """Interval of beta."""
        return self._interval("beta_interval")

    def curve(self) -> Dict[str, "Array"]:
        """The fragility curve: arrays `intensity`, `probability`, `lower` and `upper` (nan: not bounded), empty where nothing is fitted."""
        import numpy as np

        table = self._table["fit"].get("curve") or {}
        return {name: np.array(table.get(name, []), dtype=np.float64) for name in ("intensity", "probability", "lower", "upper")}

    def to_frame(self) -> Any:
        """The fragility curve as a pandas DataFrame."""
        import pandas

        return pandas.DataFrame(self.curve()).set_index("intensity")

    def _number(self, name: str) -> Optional[float]:
        value = self._table["fit"].get(name)
        return None if value is None else float(value)

    def _interval(self, name: str) -> Tuple[Optional[float], Optional[float]]:
        table = self._table["fit"].get(name) or {}
        return table.get("lower"), table.get("upper")

    def __repr__(self) -> str:
        said = f"theta {self.theta:.4g}, beta {self.beta:.3g}" if self.theta is not None and self.beta is not None else self.reason
        return f"<LimitFit {self._table['name']!r}: {said}>"


class StudyFit(Mapping[str, LimitFit]):
    """Limit states of a study by name: `fit["uplift"].theta`. `document` is study.json."""

    def __init__(self, document: Table) -> None:
        self.document = Record(document)
        self._limits = {str(each["name"]): LimitFit(each) for each in document["limits"]}

    def __getitem__(self, name: str) -> LimitFit:
        return self._limits[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._limits)

    def __len__(self) -> int:
        return len(self._limits)

    @property
    def complete(self) -> bool:
        """Whether no run is missing."""
        return bool(self.document["complete"])

    def ida(self, limit: str) -> List[Tuple["Array", "Array"]]:
        """Intensities and demands of every curve, that is of every motion and sample, for a limit; demands in SI units, nan: none."""
        import numpy as np

        number = list(self._limits).index(limit)
        made: List[Tuple[Array, Array]] = []
        for curve in self.document["curves"]:
            runs = curve["runs"]
            made.append((np.array([run["intensity"] for run in runs]), np.array([run["demands"][number] for run in runs], dtype=np.float64)))
        return made

    def to_frame(self) -> Any:
        """The fits as a pandas DataFrame: a row for every limit."""
        import pandas

        rows = []
        for name, each in self.items():
            row = {"limit": name, "theta": each.theta, "beta": each.beta}
            row.update({f"{key}_{end}": value for key in ("theta", "beta") for end, value in zip(("lower", "upper"), getattr(each, f"{key}_interval"))})
            row.update({f"theta_{key}": each[key].get("theta") for key in ("unknown_survived", "unknown_exceeded")})
            rows.append({**row, **{key: each[key] for key in ("survived", "exceeded", "unknown")}})
        return pandas.DataFrame(rows).set_index("limit")

    def __repr__(self) -> str:
        return f"<StudyFit: {', '.join(repr(each) for each in self.values())}>"


def load_study(path: PathLike) -> Study:
    """A study of a folder. Raises InputError for what is no study."""
    study = Study(path)
    study.status
    return study


# ---- the plan ----


def driving(document: Table) -> List[str]:
    """Names of the records or functions that move the ground of a case."""
    names = [str(table["function"]) for table in document.get("ground_acceleration", []) if table.get("function")]
    return list(dict.fromkeys(names))


def _absolute(value: Any) -> Any:
    if isinstance(value, list):
        return [_absolute(each) for each in value]
    return os.path.abspath(value)


def _motions(motions: Sequence[Union[PathLike, Motion, Table]], replace: Sequence[str]) -> Tuple[List[Table], List[Table], List[Table]]:
    """Tables [[motion]], [[motions]] and [[record]] of a plan."""
    single: List[Table] = []
    many: List[Table] = []
    records: List[Table] = []
    for number, given in enumerate(motions, 1):
        if isinstance(given, Mapping) and not isinstance(given, Motion):
            table = {"name": f"m{number}", "replace": list(replace), **_toml.plain(given)}
            many.append({**table, "files": _absolute(table["files"])} if "files" in table else table)
            continue
        if not isinstance(given, (str, bytes, os.PathLike, Motion)):
            raise TypeError(f"a motion of a study is a file, uplift.motion(...) or a table, found {type(given).__name__}")
        record = dict(given["record"]) if isinstance(given, Motion) else {"file": os.path.abspath(os.fspath(given))}
        if isinstance(given, Motion) and (given["direction"] is not None or given["amplitude"] is not None):
            raise ValueError("the motions of a study take the direction and the amplitude of the ground acceleration that they replace")
        name = f"motion {number}"
        records.append({"name": name, **{key: value for key, value in record.items() if value is not None}})
        label = pathlib.Path(str(record["file"])).name if record.get("file") else name
        single.append({"name": name, "label": label, "replace": list(replace), "by": [name]})
    return single, many, records


def plan_of(
    case: str,
    document: Table,
    motions: Sequence[Union[PathLike, Motion, Table]],
    replace: Optional[Sequence[str]],
    intensity: Union[str, Table],
    method: Union[Part, Table],
    tables: Table,
) -> str:
    """The text of plan.toml."""
    names = list(replace) if replace is not None else driving(document)
    if len(names) != 1 and replace is None and motions:
        raise ValueError(f"the ground of the case is moved by {', '.join(names) or 'nothing'}: name with `replace` what the motions take the place of")
    single, many, records = _motions(motions, names)
    plan: Dict[str, Any] = {"case": case, **{key: value for key, value in tables.items() if value not in (None, [], {}, ())}}
    plan["intensity"] = {"measure": intensity} if isinstance(intensity, str) else dict(intensity)
    plan["method"] = dict(method)
    plan.update({key: value for key, value in (("motion", single), ("motions", many), ("record", records)) if value})
    return HEAD + _toml.dumps(plan)


def prepared_folder(folder: PathLike) -> None:
    """Makes the folder of a study. Raises ValueError for a study whose plan is not of this package."""
    file = pathlib.Path(folder) / "plan.toml"
    if file.exists() and not file.read_text(encoding="utf-8", errors="replace").startswith(HEAD):
        raise ValueError(f"{file} was not written by this package: open it with up.load_study, or name another folder")
    file.parent.mkdir(parents=True, exist_ok=True)


def written_study(folder: PathLike, plan: str) -> Study:
    """Writes the plan of a study. Raises InputError for what is wrong with it."""
    made = pathlib.Path(folder)
    file = made / "plan.toml"
    working = file.with_name(f"plan.toml.part-{os.getpid()}")
    working.write_text(plan, encoding="utf-8")
    working.replace(file)
    return load_study(made)

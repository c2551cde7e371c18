"""The case: what is to be computed."""

from __future__ import annotations

import atexit
import copy
import ctypes
import json
import os
import pathlib
import signal
import sys
import threading
import time
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Set, Tuple, Union

from . import _library, _toml
from ._laws import ExternalLaw
from ._parts import Part, Quantity
from ._results import Comparison, Run, Trust
from ._tables import Tables

StepCallback = Callable[["StepView"], Any]


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
        direction: direction of the acceleration; default (1, 0), in space (1, 0, 0).
        pga: peak acceleration to which the record is scaled ("0.4 g_n").
        factor: factor instead of `pga`.
        process: processing steps (:mod:`uplift.processes`), in order, before the scaling.
        generate: instead of a file, a motion that fits a target spectrum (:mod:`uplift.targets`).
        amplitude: factor of the acceleration; default 1.
        record: other keys of the table [[record]]: format, unit, step, column, component.
    """
    if (file is None) == (generate is None):
        raise TypeError("motion() takes a file or `generate`, and not both")
    steps = [{"do": step} for step in process]
    if pga is not None or factor is not None:
        steps.append({"do": {"type": "scale", "pga": pga, "factor": factor}})
    table = {"file": None if file is None else os.path.abspath(os.fspath(file)), "generate": generate, "process": steps or None, **record}
    return Motion({"record": table, "direction": direction, "amplitude": amplitude})


class StepView:
    """A step of a run, as the function that `step` of :meth:`Case.run` names sees it. Arrays are copies."""

    def __init__(self, given: _library.Step) -> None:
        from ._results import array_of

        self.time: float = given.time
        self.number: int = given.number
        self.stage: int = given.stage
        self.displacement = array_of(given.displacement, given.unknowns).copy()
        self.velocity = array_of(given.velocity, given.unknowns).copy() if given.velocity else None
        self.opening = array_of(given.opening, given.rows).copy()
        self.force = array_of(given.force, given.rows).copy()


_running: Set["_Watcher"] = set()


@atexit.register
def _stop_all() -> None:
    """Ends the runs of threads that nobody waits for, before the interpreter goes."""
    for watcher in list(_running):
        watcher._on_interrupt()
    limit = time.monotonic() + 2
    while _running and time.monotonic() < limit:
        time.sleep(0.005)


class _Watcher:
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
            signal.signal(signal.SIGINT, self._on_interrupt)
            self._caught = True

    def __exit__(self, *_: Any) -> None:
        _running.discard(self)
        if self._caught:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _on_interrupt(self, *_: Any) -> None:
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


class Case(Tables):
    """A case: structure, interfaces, loads and analysis. Its methods add tables; `run`, `compare` and `trust` compute.

    Numbers are in SI units, texts may carry units ("30 GPa"). In the plane x points to the right and y up; in space z points up.
    """

    def __init__(self, title: str, description: Optional[str] = None) -> None:
        self._document: Dict[str, Any] = {"title": title}
        if description is not None:
            self._document["description"] = description
        self._text: Optional[str] = None  # of the file, as long as nothing was changed
        self._file = os.path.join(os.getcwd(), "case.toml")
        self._laws: Dict[str, ExternalLaw] = {}

    # ---- building ----

    @property
    def document(self) -> Dict[str, Any]:
        """The case as nested tables, which may be changed."""
        self._text = None
        return self._document

    def _add(self, name: str, table: Mapping[str, Any]) -> None:
        entry = {key: copy.deepcopy(value) for key, value in table.items() if value is not None}
        self._connect(entry)
        self.document.setdefault(name, []).append(entry)

    def _set(self, name: str, table: Mapping[str, Any]) -> None:
        entry = self.document.setdefault(name, {})
        entry.update({key: value for key, value in table.items() if value is not None})

    def _add_output(self, name: str, table: Mapping[str, Any]) -> None:
        entry = {key: value for key, value in table.items() if value is not None}
        self.document.setdefault("output", {}).setdefault(name, []).append(entry)

    def _interface(self, own: Mapping[str, Any], kind: str, table: Mapping[str, Any]) -> None:
        inner = {key: value for key, value in table.items() if value is not None}
        self._add("interface", {**own, kind: inner})

    def _connect(self, table: Dict[str, Any]) -> None:
        given = table.get("law")
        if isinstance(given, ExternalLaw):
            if self._laws.get(given.name, given) is not given:
                raise ValueError(f"the case has another law of the name {given.name!r}")
            self._laws[given.name] = given
            table["law"] = given.table()

    def node(self, name: str, *position: Quantity) -> None:
        """A node at [x, y], or at [x, y, z] in space [m]."""
        self.document.setdefault("nodes", {})[name] = list(position)

    def gravity(self, *acceleration: Quantity) -> None:
        """Weight of all masses. The default is 9.81 m/s2 downwards."""
        nodes = self._document.get("nodes", {})
        in_space = any(len(position) == 3 for position in nodes.values())
        default: Tuple[Quantity, ...] = (0, 0, -9.81) if in_space else (0, -9.81)
        self.document["gravity"] = {"acceleration": list(acceleration or default)}

    def damping(
        self,
        *,
        rayleigh: Optional[Sequence[Union[Mapping[str, Any], Tuple[Quantity, Quantity]]]] = None,
        alpha: Optional[Quantity] = None,
        beta: Optional[Quantity] = None,
        modal: Optional[Sequence[Quantity]] = None,
        modes: Optional[int] = None,
    ) -> None:
        """Damping of the structure.

        Parameters:
            rayleigh: pairs (frequency [Hz], damping ratio).
            alpha: factor of the mass matrix [1/s].
            beta: factor of the stiffness matrix [s].
            modal: damping ratios of the modes of the bonded structure.
            modes: number of modes to which the last ratio applies.
        """
        pairs = None
        if rayleigh is not None:
            pairs = [each if isinstance(each, Mapping) else {"frequency": each[0], "ratio": each[1]} for each in rayleigh]
        given = {"rayleigh": pairs, "alpha": alpha, "beta": beta, "modal": modal, "modes": modes}
        self.document["damping"] = {key: value for key, value in given.items() if value is not None}

    def method(self, part: Union[Part, str]) -> None:
        """The contact method (:mod:`uplift.methods`)."""
        self.document["method"] = part

    def impact(self, part: Union[Part, str]) -> None:
        """The velocity correction on impact (:mod:`uplift.impacts`)."""
        self.document["impact"] = part

    def static(self, *, steps: Optional[int] = None, **keys: Any) -> None:
        """A static stage: the dead loads in equal steps."""
        self._add("stage", {"type": "static", "steps": steps, **keys})

    def dynamic(self, duration: Quantity, *, step: Quantity, scheme: Union[Part, str, None] = None, **keys: Any) -> None:
        """A dynamic stage.

        Parameters:
            duration: s.
            step: time step [s].
            scheme: time integration (:mod:`uplift.schemes`).
            keys: other keys of the table [[stage]]: traction, p_delta, halvings.
        """
        self._add("stage", {"type": "dynamic", "duration": duration, "step": step, "scheme": scheme, **keys})

    # ---- text ----

    def to_toml(self) -> str:
        """The case as TOML: the text of the file when it was loaded and not changed."""
        return self._text if self._text is not None else _toml.dumps(self._document)

    def resolved(self) -> str:
        """The case with all default values, as TOML. Raises InputError."""
        case = self._handle()
        return _library.text_of("uplift_case_toml", case.pointer)

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the case as a file, which the program reads. An existing file is replaced when the new one is complete."""
        target = pathlib.Path(path)
        if os.path.abspath(target.parent) != os.path.dirname(self._file) and self._has_relative_files():
            raise ValueError("the case names files relative to " + os.path.dirname(self._file) + "; save it there or make the names absolute")
        working = target.with_name(target.name + f".part-{os.getpid()}")
        working.write_text(self.to_toml(), encoding="utf-8")
        working.replace(target)

    def _has_relative_files(self) -> bool:
        def relative(value: Any) -> bool:
            if isinstance(value, Mapping):
                file = value.get("file")
                return (isinstance(file, str) and not os.path.isabs(file)) or any(relative(each) for each in value.values())
            return isinstance(value, list) and any(relative(each) for each in value)

        return relative(self._document)

    def copy(self) -> "Case":
        """An independent copy."""
        made = copy.copy(self)
        made._document = copy.deepcopy(self._document)
        made._laws = dict(self._laws)
        return made

    def __repr__(self) -> str:
        return f"Case({self._document.get('title', '')!r})"

    # ---- computing ----

    def _handle(self) -> _library.Handle:
        text, file = self.to_toml().encode(), self._file.encode()
        made = _library.Handle("uplift_case_parse", "uplift_case_free", text, file)
        for law in self._laws.values():
            law.connect(made)
        return made

    def check(self) -> Dict[str, Any]:
        """What a run would compute: unknowns, frequencies, suggested step, time, memory, warnings. Raises InputError."""
        case = self._handle()
        made: Dict[str, Any] = json.loads(_library.text_of("uplift_case_check", case.pointer))
        return made

    def modes(self, count: int = 6) -> Dict[str, Any]:
        """Natural modes with the base bonded and with the base free."""
        case = self._handle()
        made: Dict[str, Any] = json.loads(_library.text_of("uplift_case_modes", case.pointer, count))
        return made

    def _with_motions(self, motions: Sequence[Motion]) -> "Case":
        if not motions:
            return self
        case = self.copy()
        document = case.document
        in_space = any(len(position) == 3 for position in document.get("nodes", {}).values())
        document["ground_acceleration"] = []
        for number, given in enumerate(motions, 1):
            name = f"motion {number} of the run"
            direction = given["direction"] if given["direction"] is not None else ((1, 0, 0) if in_space else (1, 0))
            document.setdefault("record", []).append({"name": name, **{k: v for k, v in given["record"].items() if v is not None}})
            table = {"name": name, "direction": list(direction), "amplitude": given["amplitude"], "function": name}
            document["ground_acceleration"].append({key: value for key, value in table.items() if value is not None})
        return case

    def _analyse(self, function: str, watcher: _Watcher) -> _library.Handle:
        case = self._handle()
        for law in self._laws.values():
            law.raised = None
        with watcher:
            results = _library.Handle(function, "uplift_results_free", case.pointer, ctypes.byref(watcher.options))
        results.case = case  # type: ignore[attr-defined]  # with the laws that the model refers to
        watcher.finish()
        for law in self._laws.values():
            if law.raised is not None:
                raise law.raised
        return results

    def run(
        self,
        *motions: Motion,
        progress: Optional[bool] = None,
        step_check: bool = True,
        step: Optional[StepCallback] = None,
        fields: Union[str, "os.PathLike[str]", None] = None,
    ) -> Run:
        """Runs the case, the bonded model, and both with twice the step. Other Python threads go on meanwhile.

        Parameters:
            motions: ground motions that take the place of the ground accelerations of the case.
            progress: show a progress bar; by default on a terminal.
            step_check: estimate the error of the time step by a run with twice the step.
            step: called after every step of the case's own run with a :class:`StepView`; returning False ends the run.
            fields: folder for the fields that the case asks for.

        Ctrl-C ends the run in order: its results are complete up to that instant and `run.status` is "interrupted".
        Raises InputError.
        """
        watcher = _Watcher(progress, step, step_check, None if fields is None else os.fspath(fields))
        return Run(self._with_motions(motions)._analyse("uplift_run", watcher))

    def compare(self, *variants: str, progress: Optional[bool] = None) -> Comparison:
        """Runs the variants of the case side by side: all of them, or those of these names.

        Raises InputError when the case has no variants, and ValueError for an unknown name.
        """
        case = self
        if variants:
            case = self.copy()
            known = [each["name"] for each in case._document.get("variant", [])]
            for name in variants:
                if name not in known:
                    raise ValueError(f"unknown variant {name!r}; the variants of the case are {', '.join(known) or 'none'}")
            case.document["variant"] = [each for each in case._document["variant"] if each["name"] in variants]
        return Comparison(case._analyse("uplift_compare", _Watcher(progress, None, True, None)))

    def trust(self, *, progress: Optional[bool] = None) -> Trust:
        """Repeats the run with every choice of the computation changed, one at a time."""
        return Trust(self._analyse("uplift_trust", _Watcher(progress, None, True, None)))


def load(path: Union[str, "os.PathLike[str]"]) -> Case:
    """A case of a file, or of the case.toml of a folder. Raises InputError for what is no case."""
    file = pathlib.Path(path)
    if file.is_dir():
        file = file / "case.toml"
    try:
        text = file.read_bytes().decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise _library.InputError(f"{file}: {error}", str(file)) from error
    return parse(text, str(file))


def parse(text: str, file: str = "case.toml") -> Case:
    """A case of a TOML text; relative paths start from the folder of `file`. Raises InputError."""
    case = Case("")
    case._file = os.path.abspath(file)
    case._document = json.loads(_library.text_of("uplift_toml_to_json", text.encode(), case._file.encode()))
    case._text = text
    return case


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


__all__: List[str] = ["Case", "March", "Motion", "StepView", "load", "march", "motion", "parse"]

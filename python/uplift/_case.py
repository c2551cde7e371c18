"""The case: what is to be computed."""

from __future__ import annotations

import copy
import ctypes
import json
import os
import pathlib
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _library, _toml
from ._interface_tables import InterfaceTables
from ._laws import ExternalLaw
from ._motion import Motion
from ._motion_tables import MotionTables
from ._parts import Part, Quantity
from ._program import output_of
from ._result_tables import ResultTables
from ._results import Comparison, Run, Trust
from ._structure_tables import StructureTables
from ._study import Study, plan_of, prepared_folder, written_study
from ._variants import variant
from ._watch import StepCallback, Watcher


class Case(InterfaceTables, StructureTables, MotionTables, ResultTables):
    """A case: structure, interfaces, loads and analysis. Its methods add tables; `run`, `compare`, `trust`, `study` and `reduce` compute.

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
        """A node at [x, y], or at [x, y, z] in space [m]. Its name must be new."""
        nodes = self.document.setdefault("nodes", {})
        if name in nodes:
            raise ValueError(f"the case has a node {name!r} already, at {nodes[name]}; move it with case.document[\"nodes\"][{name!r}] = [...]")
        nodes[name] = list(position)

    def gravity(self, *acceleration: Quantity) -> None:
        """Weight of all masses. The default is 9.81 m/s2 downwards."""
        self.document["gravity"] = {"acceleration": list(acceleration)} if acceleration else {}

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
                files = [value.get("file"), value.get("reduced_model")]
                return any(isinstance(file, str) and not os.path.isabs(file) for file in files) or any(relative(each) for each in value.values())
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
        for given in motions:
            if not isinstance(given, Motion):
                raise TypeError(f"a motion is made by uplift.motion(...), found {type(given).__name__}")
        case = self.copy()
        document = case.document
        document["ground_acceleration"] = []
        for number, given in enumerate(motions, 1):
            name = f"motion {number} of the run"
            document.setdefault("record", []).append({"name": name, **{k: v for k, v in given["record"].items() if v is not None}})
            table = {"name": name, "direction": given["direction"] and list(given["direction"]), "amplitude": given["amplitude"], "function": name}
            document["ground_acceleration"].append({key: value for key, value in table.items() if value is not None})
        return case

    def _analyse(self, function: str, watcher: Watcher) -> _library.Handle:
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
            fields: results folder for the fields that the case asks for; everything that :meth:`Run.write` writes stands beside them. Earlier
                results are moved aside.

        Ctrl-C ends the run in order: its results are complete up to that instant and `run.status` is "interrupted".
        Raises InputError.
        """
        watcher = Watcher(progress, step, step_check, None if fields is None else os.fspath(fields))
        case = self._with_motions(motions)
        return Run(case._analyse("uplift_run", watcher), case.copy()._floor_at)

    def _floor_at(self, node: str) -> Optional[Run]:
        """The run alone, with the floor at a node; None without such a node."""
        case = self.copy()
        place = case.document.get("nodes", {}).get(node)
        if place is None:
            return None
        axes = len(place["value"] if isinstance(place, Mapping) else place)
        case.floor_spectrum(node, node, direction=[1, 0, 0][:axes])
        return Run(case._analyse("uplift_run", Watcher(None, None, False, None)))

    def compare(self, *names: str, progress: Optional[bool] = None, **variants: Union[Part, ExternalLaw, Mapping[str, Any]]) -> Comparison:
        """Runs variants of the case side by side: without arguments all that the case has.

        Parameters:
            names: variants of the case, or "springs", "sdm", "lagrange", "augmented_lagrangian", "penalty": this case with its joint in
                another formulation, made from the stiffness and the friction of its law. The SDM joint has no tensile strength then and a
                closure stress of -500 Pa.
            variants: variants by name: a law (`stiff=up.springs(K_n="8 GPa/m")`) or a table of its changes (`fine={"step": "1 ms"}`).

        Raises InputError when there is nothing to compare, and ValueError for an unknown name or a law from which another one cannot be made.
        """
        case = self
        if names or variants:
            case = self.copy()
            chosen = [variant(name, self._document) for name in names]
            chosen += [{"name": name, **({"law": given} if not isinstance(given, Mapping) or "type" in given else given)} for name, given in variants.items()]
            case.document["variant"] = []
            for table in chosen:
                case._add("variant", table)
        return Comparison(case._analyse("uplift_compare", Watcher(progress, None, True, None)))

    def trust(self, *, progress: Optional[bool] = None) -> Trust:
        """Repeats the run with every choice of the computation changed, one at a time."""
        return Trust(self._analyse("uplift_trust", Watcher(progress, None, True, None)))

    def study(
        self,
        folder: Union[str, "os.PathLike[str]"],
        *,
        intensity: Union[str, Mapping[str, Any]],
        method: Union[Part, Mapping[str, Any]],
        motions: Sequence[Union[str, "os.PathLike[str]", Motion, Mapping[str, Any]]] = (),
        replace: Optional[Sequence[str]] = None,
        limits: Sequence[Mapping[str, Any]] = (),
        variables: Sequence[Mapping[str, Any]] = (),
        correlations: Sequence[Mapping[str, Any]] = (),
        samples: Optional[int] = None,
        pairing: Optional[str] = None,
        seed: Optional[int] = None,
        floor_spectra: Optional[bool] = None,
        design: Optional[Mapping[str, Any]] = None,
        hazard: Optional[Mapping[str, Any]] = None,
        factors: Sequence[Mapping[str, Any]] = (),
        bootstrap: Optional[int] = None,
        reduced_model: Optional[Union[str, "os.PathLike[str]"]] = None,
        run: Optional[Mapping[str, Any]] = None,
    ) -> Study:
        """A study of the case: writes FOLDER/plan.toml, which the program computes (:meth:`Study.run`). Keys as in the plan (guide, "Studies").

        Parameters:
            folder: folder of the study ("pier.study"). What it has computed is used again, also after a change of the plan.
            intensity: measure of the motions ("factor", "pga", "pgv" in SI units), or its table with `measure`, `unit`, `period`, `damping`, `of`.
            method: {"type": "ida", "start": 0.1, "largest": 2}, or truncated_ida, stripes (`levels`), cloud (`factors`).
            motions: files of records, :func:`uplift.motion`, or tables [[motions]] with `files`, or `count` and `generate`. Without them the
                motions of the case.
            replace: names of records or functions of the case that the motions take the place of; default: the only one that moves the ground.
            limits: limit states, tables with `name`, `quantity`, `limit`, `of` and `source`.
            variables: uncertain numbers, tables with `name`, `paths`, `distribution` and `meaning`.
            correlations: rank correlations, tables with `variables` (two names) and `value`.
            samples: number of samples of the variables.
            pairing: "crossed" or "paired".
            seed: of the samples.
            floor_spectra: keep the floor spectra of every run.
            design: design motion of the site, a table with `intensity` and `source`.
            hazard: hazard curve of the site, a table with `intensities`, `rates` (a year) and `source`.
            factors: factors of safety that the runs do not vary, tables with `name`, `median`, `beta_r`, `beta_u` and `source`.
            bootstrap: draws of a parametric bootstrap of every fit, at least 200.
            reduced_model: file of a reduced model of the case (:meth:`reduce`), with which the runs are computed.
            run: limits of a run, a table with `workers`, `timeout`, `memory` and `attempts`.

        The plan names the file of a loaded case that was not changed; any other case is written into the folder. A plan that this package
        has not written is not replaced (ValueError). Raises InputError for what the case or the plan has wrong.
        """
        if self._laws:
            raise ValueError("a law in Python cannot be used by a study, which the program computes")
        tables: Dict[str, Any] = {"seed": seed, "samples": samples, "pairing": pairing, "floor_spectra": floor_spectra, "limit": list(limits)}
        tables.update({"variable": list(variables), "correlation": list(correlations), "design": design, "hazard": hazard, "run": run})
        tables.update({"factor": list(factors), "bootstrap": bootstrap, "reduced_model": reduced_model and os.path.abspath(os.fspath(reduced_model))})
        own = os.path.join(os.fspath(folder), "case.toml")
        used = self._is_its_file()
        file = os.path.relpath(self._file, os.fspath(folder)) if used else "case.toml"
        plan = plan_of(file, self._document, motions, replace, intensity, method, tables)
        prepared_folder(folder)
        if not used:
            self.save(own)
        return written_study(folder, plan)

    def reduce(
        self,
        file: Union[str, "os.PathLike[str]"],
        *,
        frequency: Optional[float] = None,
        size: Optional[int] = None,
        target: Optional[float] = None,
        controls: int = 0,
        scale: Optional[Tuple[float, float]] = None,
        seed: Optional[int] = None,
        model: Optional[Union[str, "os.PathLike[str]"]] = None,
    ) -> str:
        """Makes a reduced model of the case, by the program (guide, "Reduced models"), and returns its size and its error in sentences.

        Parameters:
            file: file to be written ("tower.rom"), which a case then names as `reduced_model`; an earlier one is moved to FILE.1, FILE.2, ...
            frequency: motions up to about this frequency [Hz] are represented; default 25.
            size: number of coordinates; default: as many as the target asks for.
            target: largest transfer error [1] where no size is given; default 2e-4.
            controls: control runs, whole and reduced, that state the error (59: 95 % of all runs with 95 % confidence).
            scale: the motions of the control runs are multiplied by factors between these two; default 0.5, 1.5.
            seed: of the random numbers of the control runs.
            model: a reduced model of the same structure, for which control runs are made instead of a new one.

        Raises InputError for a case that a reduced model does not represent, OutputError where the file could not be written, and ValueError
        for a law in Python.
        """
        if self._laws:
            raise ValueError("a law in Python cannot be used for a reduced model, which the program makes")
        given = {"--frequency": frequency, "--size": size, "--target": target, "--controls": controls, "--seed": seed}
        words = [word for name, value in given.items() if value is not None for word in (name, str(value))]
        words += ["--scale", f"{scale[0]},{scale[1]}"] if scale is not None else []
        words += ["--model", os.path.abspath(os.fspath(model))] if model is not None else []
        with tempfile.TemporaryDirectory() as folder:
            case = self._file
            if not self._is_its_file():
                case = os.path.join(folder, "case.toml")
                self.save(case)
            return output_of("reduce", case, "--out", os.path.abspath(os.fspath(file)), *words)

    def _is_its_file(self) -> bool:
        """Whether the case was loaded from a file and not changed."""
        return self._text is not None and os.path.isfile(self._file) and pathlib.Path(self._file).read_bytes() == self._text.encode()


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

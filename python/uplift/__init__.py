"""uplift: uplift of foundations in earthquakes and its consequences for structure, equipment and soil.

    import uplift as up
    case = up.load("examples/05_bridge_pier")
    run = case.run()
    print(run.verdict.headline)
    print(run["underside.moment"].max(), run.time)

All quantities are in SI units; an opening > 0 separates the faces of an interface, a traction > 0 is tension.
"""

from __future__ import annotations

from . import bulk_laws, foundations, functions, impacts, laws, methods, processes, schemes, targets
from ._case import Case, load, parse
from ._laws import ExternalLaw, law
from ._library import InputError, OutputError, UpliftError, library
from ._march import March, march
from ._motion import Motion, motion
from ._parts import Part
from ._results import Comparison, Floor, Histories, Run, Trust, Verdict, VerdictNumber, psa, solve_problem
from ._study import LimitFit, Study, StudyFit, load_study
from ._watch import StepView
from .laws import bilinear, coulomb, elastic, exponential, sdm, springs, unilateral

__all__ = [
    "Case", "Comparison", "ExternalLaw", "Floor", "Histories", "InputError", "LimitFit", "March", "Motion", "OutputError", "Part", "Run",
    "StepView", "Study", "StudyFit", "Trust", "UpliftError", "Verdict", "VerdictNumber", "bilinear", "bulk_laws", "coulomb", "elastic", "exponential",
    "foundations", "functions", "impacts", "law", "laws", "load", "load_study", "march", "methods", "motion", "parse", "processes", "psa", "schemes",
    "sdm", "springs", "targets", "unilateral", "version",
]


def version() -> str:
    """Version of the library."""
    text: bytes = library().uplift_version()
    return text.decode()

"""The C interface of the library (include/uplift.h), by ctypes. Loaded at its first use."""

from __future__ import annotations

import ctypes
import os
import pathlib
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char_p, c_double, c_int, c_long, c_size_t, c_void_p
from typing import Any, Callable, List, Optional, Tuple

from . import _blas_kernels

ABI_VERSION = 1


class UpliftError(Exception):
    """A refusal or failure of the library."""


class InputError(UpliftError, ValueError):
    """Bad input, found before the first step.

    Attributes: ``file``, ``line`` and ``column`` (from 1; 0 where they are not known) and ``path``, the key as in
    ``interface[0].law.K_n``.
    """

    def __init__(self, message: str, file: str = "", line: int = 0, column: int = 0, path: str = "") -> None:
        super().__init__(message)
        self.file, self.line, self.column, self.path = file, line, column, path


class OutputError(UpliftError, OSError):
    """Results that could not be written; what was written is kept."""


class _Error(Structure):
    _fields_ = [
        ("status", c_int),
        ("line", c_int),
        ("column", c_int),
        ("file", c_char_p),
        ("path", c_char_p),
        ("message", c_char_p),
    ]


class Progress(Structure):
    _fields_ = [("label", c_char_p), ("fraction", c_double), ("time", c_double), ("uplifted", c_double)]


class Step(Structure):
    _fields_ = [
        ("time", c_double),
        ("number", c_long),
        ("stage", c_int),
        ("unknowns", c_size_t),
        ("rows", c_size_t),
        ("displacement", POINTER(c_double)),
        ("velocity", POINTER(c_double)),
        ("opening", POINTER(c_double)),
        ("force", POINTER(c_double)),
    ]


class Column(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("values", POINTER(c_double)), ("count", c_size_t)]


ProgressFunction = CFUNCTYPE(c_int, c_void_p, POINTER(Progress))
StepFunction = CFUNCTYPE(c_int, c_void_p, POINTER(Step))
_numbers = POINTER(c_double)
LawFunction = CFUNCTYPE(
    c_int, c_void_p, c_int, c_int, c_double, _numbers, _numbers, _numbers, _numbers, _numbers, _numbers, _numbers, _numbers
)


class Options(Structure):
    _fields_ = [
        ("size", c_size_t),
        ("step_check", c_int),
        ("fields_folder", c_char_p),
        ("progress", ProgressFunction),
        ("step", StepFunction),
        ("user", c_void_p),
        ("cancel", POINTER(c_int)),
    ]


_handle = c_void_p
_text = POINTER(c_char_p)  # of texts that are only lent
_own_text = POINTER(c_void_p)  # of texts that have to be freed
_error = POINTER(_Error)

_signatures: List[Tuple[str, Any, List[Any]]] = [
    ("uplift_error_clear", None, [_error]),
    ("uplift_text_free", None, [c_void_p]),
    ("uplift_version", c_char_p, []),
    ("uplift_abi_version", c_int, []),
    ("uplift_schema", c_int, [_own_text, _error]),
    ("uplift_toml_to_json", c_int, [c_char_p, c_char_p, _own_text, _error]),
    ("uplift_case_load", c_int, [c_char_p, POINTER(_handle), _error]),
    ("uplift_case_parse", c_int, [c_char_p, c_char_p, POINTER(_handle), _error]),
    ("uplift_case_free", None, [_handle]),
    ("uplift_case_toml", c_int, [_handle, _own_text, _error]),
    ("uplift_case_check", c_int, [_handle, _own_text, _error]),
    ("uplift_case_modes", c_int, [_handle, c_int, _own_text, _error]),
    ("uplift_case_set_law", c_int, [_handle, c_char_p, LawFunction, c_void_p, _error]),
    ("uplift_options_init", None, [POINTER(Options)]),
    ("uplift_run", c_int, [_handle, POINTER(Options), POINTER(_handle), _error]),
    ("uplift_compare", c_int, [_handle, POINTER(Options), POINTER(_handle), _error]),
    ("uplift_trust", c_int, [_handle, POINTER(Options), POINTER(_handle), _error]),
    ("uplift_results_free", None, [_handle]),
    ("uplift_results_json", c_int, [_handle, _text, _error]),
    ("uplift_results_trust", c_int, [_handle, _own_text, _error]),
    ("uplift_results_report", c_int, [_handle, _text, _error]),
    ("uplift_results_write", c_int, [_handle, c_char_p, _own_text, _error]),
    ("uplift_results_runs", c_size_t, [_handle]),
    ("uplift_results_run_name", c_char_p, [_handle, c_size_t]),
    ("uplift_results_columns", c_size_t, [_handle, c_size_t]),
    ("uplift_results_column", c_int, [_handle, c_size_t, c_size_t, POINTER(Column)]),
    ("uplift_results_floor", c_int, [_handle, c_size_t, c_size_t, _numbers, POINTER(Column)]),
    ("uplift_results_frame", c_int, [_handle, c_size_t, c_size_t, _numbers, POINTER(Column)]),
    ("uplift_problem_solve", c_int, [c_char_p, c_char_p, _own_text, _error]),
    ("uplift_spectrum", c_int, [_numbers, c_size_t, c_double, c_double, _numbers, c_size_t, _numbers, _error]),
]

_loaded: Optional[ctypes.CDLL] = None


def _candidates() -> List[str]:
    here = pathlib.Path(__file__).resolve().parent
    given = os.environ.get("UPLIFT_LIBRARY")
    if given:
        return [given]
    found = []
    for folder in (here, here / "lib", here.parents[1] / "build" / "release"):
        found += [str(path) for path in sorted(folder.glob("libuplift.so*"))[:1]]
    return found + ["libuplift.so.0"]


def library() -> ctypes.CDLL:
    """The loaded library. Raises ImportError when there is none or when it has another version."""
    global _loaded
    if _loaded is not None:
        return _loaded
    tried = []
    for name in _candidates():
        try:
            with _blas_kernels.chosen_by_instructions():
                made = ctypes.CDLL(name)
        except OSError as error:
            tried.append(f"{name}: {error}")
            continue
        for function, result, arguments in _signatures:
            declared = getattr(made, function)
            declared.restype, declared.argtypes = result, arguments
        if made.uplift_abi_version() != ABI_VERSION:
            raise ImportError(f"{name} has interface version {made.uplift_abi_version()}, expected {ABI_VERSION}")
        _loaded = made
        return made
    raise ImportError("libuplift was not found; set UPLIFT_LIBRARY to its path. Tried: " + "; ".join(tried))


def call(name: str, *arguments: Any) -> None:
    """Calls a function that returns a status, and raises its error."""
    for argument in arguments:
        if isinstance(argument, bytes) and b"\0" in argument:
            position = argument.index(b"\0")
            raise InputError("a text with a zero character cannot be passed", line=1 + argument.count(b"\n", 0, position))
    made = library()
    error = _Error()
    status = getattr(made, name)(*arguments, byref(error))
    if status == 0:
        return
    message = (error.message or b"unknown error").decode("utf-8", "replace")
    file, path = ((text or b"").decode("utf-8", "replace") for text in (error.file, error.path))
    line, column = error.line, error.column
    made.uplift_error_clear(byref(error))
    if status == 2:
        raise InputError(message, file, line, column, path)
    if status == 3:
        raise MemoryError(message)
    if status == 4:
        raise OutputError(message)
    raise UpliftError("internal error: " + message)


def text_of(name: str, *arguments: Any) -> str:
    """The text that a function returns through its last argument before the error."""
    pointer = c_void_p()
    call(name, *arguments, byref(pointer))
    try:
        return ctypes.string_at(pointer.value).decode() if pointer.value else ""
    finally:
        library().uplift_text_free(pointer)


def lent_text(name: str, handle: Any) -> str:
    """A text that belongs to the handle."""
    text = c_char_p()
    call(name, handle, byref(text))
    return (text.value or b"").decode()


class Handle:
    """An object of the library, freed with this object."""

    def __init__(self, maker: str, freer: str, *arguments: Any) -> None:
        self._free: Callable[[Any], None] = getattr(library(), freer)
        self.pointer = c_void_p()
        call(maker, *arguments, byref(self.pointer))

    def __del__(self) -> None:
        if getattr(self, "pointer", None):
            self._free(self.pointer)
            self.pointer = c_void_p()

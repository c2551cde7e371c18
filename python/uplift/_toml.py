"""Writes a case as TOML."""

from __future__ import annotations

import math
import numbers
import re
from typing import Any, List, Mapping

Table = Mapping[str, Any]


def plain(value: Any) -> Any:
    """The value with NumPy numbers and arrays, tuples and paths as plain Python."""
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items() if entry is not None}
    if isinstance(value, bool) or type(value) in (int, float, str):
        return value
    if hasattr(value, "tolist") and type(listed := value.tolist()) is not type(value):
        return plain(listed)
    if isinstance(value, (int, str)):
        return int(value) if isinstance(value, int) else str(value)
    if isinstance(value, numbers.Real):  # also numpy.longdouble, which tolist() leaves as it is
        return float(value)
    if hasattr(value, "__fspath__"):
        return str(value)
    if isinstance(value, (list, tuple, range)):
        return [plain(entry) for entry in value]
    raise TypeError(f"a case cannot contain {value!r} (expected a number, a text, True or False, a list or a table)")


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _value(name)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        return repr(value) if math.isfinite(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, str):
        named = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
        return '"' + "".join(named.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04X}") for c in value) + '"'
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(entry)}" for key, entry in value.items()) + " }" if value else "{}"
    return "[" + ", ".join(_value(entry) for entry in value) + "]"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(entry, Mapping) for entry in value)


def _write(lines: List[str], table: Table, name: str) -> None:
    for key, value in table.items():
        if not isinstance(value, Mapping) and not _is_tables(value):
            lines.append(f"{_key(key)} = {_value(value)}")
    for key, value in table.items():
        path = f"{name}.{_key(key)}" if name else _key(key)
        if isinstance(value, Mapping):
            lines += ["", f"[{path}]"]
            _write(lines, value, path)
        elif _is_tables(value):
            for entry in value:
                lines += ["", f"[[{path}]]"]
                _write(lines, entry, path)


def dumps(table: Table) -> str:
    """The table as TOML text. Raises TypeError for values that a case cannot contain."""
    lines: List[str] = []
    _write(lines, plain(table), "")
    return "\n".join(lines).lstrip("\n") + "\n"

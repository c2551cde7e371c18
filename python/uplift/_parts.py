"""A part of a case: a law, a method, a scheme, a function of time."""

from __future__ import annotations

from typing import Any, Dict, Union

Quantity = Union[float, int, str]
"""A number in SI units, or a text with a unit ("80 MPa/m")."""


class Part(Dict[str, Any]):
    """A part with its type and parameters, as a table of the case."""

    def __repr__(self) -> str:
        given = ", ".join(f"{key}={value!r}" for key, value in self.items() if key != "type")
        return f"{self.get('type', '?')}({given})"


def part(type_name: str, **parameters: Any) -> Part:
    """A part with the parameters that are not None."""
    return Part({"type": type_name, **{key: value for key, value in parameters.items() if value is not None}})

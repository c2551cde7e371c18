"""What the generated methods for tables write to."""

from __future__ import annotations

from typing import Any, Mapping


class TableStore:
    """Takes tables of a case; keys without a value are left out."""

    def _add(self, name: str, table: Mapping[str, Any]) -> None:
        """One more table of an array."""
        raise NotImplementedError

    def _set(self, name: str, table: Mapping[str, Any]) -> None:
        """The only table of its kind."""
        raise NotImplementedError

    def _add_output(self, name: str, table: Mapping[str, Any]) -> None:
        """One more table of an array of the output."""
        raise NotImplementedError

    def _interface(self, own: Mapping[str, Any], kind: str, table: Mapping[str, Any]) -> None:
        """An interface: its own keys, and the table of its kind."""
        raise NotImplementedError

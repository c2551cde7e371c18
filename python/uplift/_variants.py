"""Variants of a case: another formulation of its joint, made from the law that it has."""

from __future__ import annotations

import difflib
from typing import Any, Dict, Mapping

CONSTRAINTS = ("lagrange", "augmented_lagrangian", "penalty")
FORMULATIONS = ("springs", "sdm") + CONSTRAINTS
# without tensile strength the cracking energy has no effect; the closure stress is at most 1 % of a bearing pressure of 50 kPa
SDM = {"F_u": 0.0, "G_f": "0.1 J/m2", "F_c": "-500 Pa"}


def variant(name: str, document: Mapping[str, Any]) -> Dict[str, Any]:
    """The table [[variant]] of this name: of the case, or its joint in the formulation of this name. Raises ValueError."""
    own = {str(each["name"]): each for each in document.get("variant", [])}
    if name in own:
        return dict(own[name])
    if name not in FORMULATIONS:
        near = difflib.get_close_matches(name, [*own, *FORMULATIONS], 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(f"unknown variant {name!r}{hint}; the variants of the case are {', '.join(own) or 'none'}, the formulations {', '.join(FORMULATIONS)}")
    law = _law_of(document)
    if name in CONSTRAINTS:
        return {"name": name, "law": _constraint(name, law), "method": name}
    return {"name": name, "law": _traction_law(name, law), "method": "newton"}


def _law_of(document: Mapping[str, Any]) -> Dict[str, Any]:
    """The law that all interfaces have."""
    laws = [each.get("law") for each in document.get("interface", [])]
    if not laws:
        raise ValueError("the case has no interface whose formulation could be changed")
    if any(each != laws[0] for each in laws):
        raise ValueError("the interfaces of the case have different laws: give the variants as tables with `interface` and `law`")
    return {"type": laws[0]} if isinstance(laws[0], str) else dict(laws[0] or {})


def _traction_law(name: str, law: Mapping[str, Any]) -> Dict[str, Any]:
    if law.get("type") == name:
        return dict(law)
    if "K_n" not in law:
        raise ValueError(f"the law {law.get('type')!r} of the case has no stiffness K_n, which {name!r} needs: give the variant as {name}=up.{name}(...)")
    shared = {key: law[key] for key in ("K_n", "tangential", "K_t", "friction", "cohesion") if key in law}
    if set(shared) == {"K_n"}:  # the laws differ in the shear that they have then
        shared["tangential"] = "none" if law["type"] == "springs" else "bonded"
    return {"type": name, **shared, **(SDM if name == "sdm" else {})}


def _constraint(name: str, law: Mapping[str, Any]) -> Dict[str, Any]:
    if law.get("type") in ("unilateral", "coulomb"):
        return dict(law)
    if law.get("friction") is not None and not law.get("cohesion"):
        return {"type": "coulomb", "friction": law["friction"]}
    if law.get("type") == "springs" and law.get("tangential", "none") == "none" and "K_t" not in law:
        return {"type": "unilateral"}
    raise ValueError(f"the law of the case holds shear without a coefficient of friction or with cohesion, which the constraint {name!r} cannot: give the variant as a table")

"""Models: what is asked of them, and the derived operators."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import cluster as distributed
from ._core import Core, InputError
from .results import (
    Amplitudes,
    Base,
    Certificate,
    Critical,
    Modes,
    Pattern,
    Point,
    Spectrum,
    Sweep,
)

if TYPE_CHECKING:
    from ._core import Assignment

Value = float | int | str


def built() -> list[str]:
    """Names of the models that are built in."""
    return Core.built()


def _near(near: complex | None) -> tuple[float, float] | None:
    return None if near is None else (complex(near).real, complex(near).imag)


def _merged(extra: Mapping[str, Any] | None, parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters of `set` and of the keywords; a name stands in one of the two."""
    for name in parameters:
        if extra and name in extra:
            raise InputError(f"`{name}` is set twice, by set and by a keyword: a parameter accepts one value")
    return {**(extra or {}), **parameters}


def _is_axis(value: Any) -> bool:
    return not isinstance(value, str) and np.ndim(value) == 1


class Operators:
    """The derived operators `base`, `L`, `adjoint` (with its boundary conditions), `N2`, `N3`."""

    names = ("base", "L", "adjoint", "N2", "N3")

    def __init__(self, core: Core) -> None:
        self._core = core

    def text(self, name: str) -> str:
        """Plain text, as `landau explain` prints it."""
        return "\n".join(self._core.operator(name, False))

    def latex(self, name: str) -> list[str]:
        """One formula a row."""
        return self._core.operator(name, True)

    def _repr_latex_(self) -> str:
        return "\n".join(rf"$$ {row} $$" for row in self.latex("L"))


class Model:
    """A model: built in by name, or the spec of a `.model` file, run from its tape.

    Every method takes the model's parameters as keywords (numbers, names of choices, or "auto") and `M`, the Chebyshev
    resolution; `set` takes those whose names are options. Units are the model's.
    """

    def __init__(self, name: str | os.PathLike[str]) -> None:
        self._adopt(Core.open(os.fspath(name)))

    @classmethod
    def from_text(cls, text: str, laws: Mapping[str, str] | None = None) -> Model:
        """A spec from its text; `laws` by name, besides those that are built in."""
        model = cls.__new__(cls)
        model._adopt(Core.from_text(text, dict(laws or {})))
        return model

    def _adopt(self, core: Core) -> None:
        self._core = core
        info = json.loads(core.info())
        self.name: str = info["name"]
        self.title: str = info["title"]
        #: By name: default, doc, choices, whether it takes whole numbers alone, and whether "auto" is accepted.
        self.parameters: dict[str, dict[str, Any]] = dict(info["parameters"])
        #: Documentation by name.
        self.fields: dict[str, str] = dict(info["fields"])
        #: What A = 1 means.
        self.normalization: str = info["normalization"]
        self.coordinate: str | None = info["coordinate"]
        self.periodic: str = info["periodic"]
        self._typical = info["typical_k"], info["typical_near"]
        self.operators = Operators(core)

    @property
    def text(self) -> str:
        """The spec."""
        return self._core.texts()[0]

    @property
    def laws(self) -> dict[str, str]:
        """Texts of the law files at hand, by name."""
        return self._core.texts()[1]

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, self._core.texts()

    def __repr__(self) -> str:
        return f"<Model {self.name}: {self.title}>"

    # What is asked of it

    def base(self, *, points: int = 201, M: int = 50, set: Mapping[str, Value] | None = None, **parameters: Value) -> Base:
        """The base state at `points` evenly spaced heights."""
        return Base(self, json.loads(self._core.base(self._set(set, parameters), M, points)), M)

    def spectrum(
        self, k: float | None = None, *, M: int = 50, set: Mapping[str, Value] | None = None, **parameters: Value
    ) -> Spectrum:
        """Eigenvalues of L and of the separately discretised L†, by decreasing growth rate."""
        return Spectrum(self, json.loads(self._core.spectrum(self._set(set, parameters), M, self._k(k))), M)

    def point(
        self,
        k: float | None = None,
        *,
        order: int = 3,
        near: complex | None = None,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Point:
        """Landau coefficients to an odd order, with errors and everything that they rest on."""
        k, near = self._mode(k, near)
        found = self._core.point(self._set(set, parameters), M, k, _near(near), order)
        return Point(self, json.loads(found), M)

    def modes(
        self,
        k: float | None = None,
        *,
        near: complex | None = None,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Modes:
        """X[1;1], X[0;2], X[2;2], X[1;3], X[3;3] and X† as profiles."""
        k, near = self._mode(k, near)
        return Modes(self, json.loads(self._core.modes(self._set(set, parameters), M, k, _near(near))), M)

    def amplitudes(
        self,
        modes: Iterable[float | tuple[float, complex]],
        *,
        order: int = 3,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Amplitudes:
        """Amplitude equations of several modes, each a wavenumber or (wavenumber, nearby eigenvalue)."""
        chosen = [
            (float(mode[0]), _near(mode[1])) if isinstance(mode, tuple) else (float(mode), None) for mode in modes
        ]
        return Amplitudes(self, json.loads(self._core.amplitudes(self._set(set, parameters), M, chosen, order)), M)

    def critical(
        self,
        vary: str,
        between: tuple[float, float],
        *,
        of: str = "growth",
        k: float | None = None,
        minimize: tuple[float, float] | None = None,
        near: complex | None = None,
        follow: bool = False,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Critical:
        """Where growth or c2 changes sign, or c2 jumps through infinity; `minimize` over a range of k.

        The leading mode at every place; with `follow` one mode by its shape, that which grows fastest on the axis."""
        found = self._core.critical(
            self._set(set, parameters), M, vary, between, of, k, minimize, _near(near), follow
        )
        return Critical(self, json.loads(found), M)

    def sweep(
        self,
        *,
        out: str | os.PathLike[str] | None = None,
        k: float | Sequence[float] | None = None,
        near: complex | None = None,
        follow: bool = False,
        M: int = 50,
        columns: Sequence[str] = (),
        cluster: Any = None,
        tasks: int = 16,
        cpus: int = 1,
        force: bool = False,
        set: Mapping[str, Any] | None = None,
        **parameters: Any,
    ) -> Sweep:
        """Landau points over the product of all keywords that are sequences; the first one varies fastest.

        Each row holds the leading mode of its place, or the one nearest to `near`. With `follow` one mode is followed along the
        first axis, from where the leading growth rate is largest. `leading_re` is the leading growth rate in every row.

        With `out`, a CSV file, an interrupted sweep leaves a journal beside it and goes on from there; a file that is no
        table of this sweep is replaced with `force` alone. With `cluster`, a
        `hyperqueue.Client`, the sweep runs there in `tasks` shares of `cpus` cores, through files beside `out`.
        `columns` are outputs at the equilibrium, and expressions in the base state: `"T at upper"`, `"integral(n)"`.
        """
        every = _merged(set, parameters)
        axes = [(name, [float(x) for x in value]) for name, value in every.items() if _is_axis(value)]
        fixed = {name: value for name, value in every.items() if not _is_axis(value)}
        number = k
        if k is not None and _is_axis(k):
            axes.insert(0, ("k", [float(x) for x in k]))
            number = None
        if not axes:
            raise InputError("nothing varies: give k or a parameter as a sequence")
        target = None if out is None else os.fspath(out)
        assignment: Assignment = {
            "set": self._set(None, fixed),
            "resolution": M,
            "axes": axes,
            "k": number,
            "near": _near(near),
            "follow": follow,
            "columns": list(columns),
        }
        if cluster is not None:
            if target is None:
                raise InputError("a sweep on a cluster needs out, a file that all workers see")
            path = Path(target).resolve()
            distributed.run(cluster, self, assignment, path, tasks, cpus, force)
            rows = distributed.rows(path, len(axes), list(columns))
        else:
            rows = json.loads(self._core.sweep(assignment, target, force))
        varying = [name for name, _ in axes]
        defaults = {name: info["default"] for name, info in self.parameters.items() if name not in varying}
        facts = {"parameters": {**defaults, **fixed}, "k": number}
        return Sweep(self, rows, M, axes, facts, columns)

    def verify(
        self,
        k: float | None = None,
        *,
        order: int = 3,
        near: complex | None = None,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Certificate:
        """The certificate at one wavenumber."""
        k, near = self._mode(k, near)
        found = self._core.verify(self._set(set, parameters), M, k, _near(near), order)
        return Certificate(self, json.loads(found), M)

    def pattern(
        self,
        k: float | None = None,
        *,
        amplitude: float | None = None,
        points: tuple[int, int] = (161, 81),
        wavelengths: float = 2.0,
        near: complex | None = None,
        M: int = 50,
        set: Mapping[str, Value] | None = None,
        **parameters: Value,
    ) -> Pattern:
        """The fields over the plane: base, fundamental alone, through third order."""
        k, near = self._mode(k, near)
        given = self._set(set, parameters)
        found = self._core.pattern(given, M, k, _near(near), amplitude, points, wavelengths)
        return Pattern(self, json.loads(found), M)

    def _set(self, extra: Mapping[str, Value] | None, parameters: Mapping[str, Value]) -> list[str]:
        def shown(value: Value) -> str:
            return value if isinstance(value, str) else repr(float(value))

        return [f"{name}={shown(value)}" for name, value in _merged(extra, parameters).items()]

    def _k(self, k: float | None) -> float:
        if k is not None:
            return float(k)
        if self._typical[0] is None:
            raise InputError(f"give the wavenumber k: the model `{self.name}` names no typical one")
        return self._typical[0]

    def _mode(self, k: float | None, near: complex | None) -> tuple[float, complex | None]:
        own = self._typical[1]
        if k is None and near is None and own:
            near = complex(*own)
        return self._k(k), near


def _restored(text: str, laws: dict[str, str]) -> Model:
    return Model.from_text(text, laws)

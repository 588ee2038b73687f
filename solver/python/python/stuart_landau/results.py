"""Answers: numbers as Python has them, arrays of numpy, pictures and datasets where the packages for them are installed."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Sequence
from typing import Any

import numpy as np


def _complex(pair: list[float | None]) -> complex:
    return complex(*(math.nan if x is None else x for x in pair))


def _array(values: list[float | None]) -> np.ndarray:
    return np.array([math.nan if x is None else x for x in values], dtype=float)


def _latex(value: complex, error: float | None) -> str:
    """A number with seven digits at most, and none beyond its error."""
    error = math.inf if error is None else error

    def number(x: float) -> str:
        if abs(x) <= error:
            return "0"
        known = 7 if error == 0 else math.floor(math.log10(abs(x))) - math.floor(math.log10(error)) + 1
        digits = max(1, min(7, known))
        mantissa, exponent = f"{x:.{digits - 1}e}".split("e")
        if -4 < int(exponent) < digits:
            return f"{x:.{digits - 1 - int(exponent)}f}"
        return rf"{mantissa}\times 10^{{{int(exponent)}}}"

    if abs(value.imag) <= error:
        return number(value.real)
    sign = "-" if value.imag < 0 else "+"
    return rf"\left({number(value.real)} {sign} {number(abs(value.imag))}\,i\right)"


class Result:
    """An answer; `data` is the object that the command line prints with --json."""

    def __init__(self, model: Any, data: Any, resolution: int = 50) -> None:
        self.model = model
        #: What the command line prints, where the library has words for the answer.
        self._text: str | None = data.pop("text", None) if isinstance(data, dict) else None
        self.data = data
        #: M
        self.resolution = resolution

    def _facts(self) -> dict[str, Any]:
        """What the numbers were computed from: `parameters`, `k`, `amplitude`."""
        return self.data

    def _dataset(self, variables: dict[str, Any], axes: dict[str, tuple[np.ndarray, str]]) -> Any:
        """Variables, each dimensions, values and what it is in words, over axes: labelled as the NetCDF files are."""
        facts = self._facts()
        listed = self.model._core.attributes(
            json.dumps(facts["parameters"]), self.resolution, facts.get("k"), facts.get("amplitude")
        )

        def labelled(dims: Any, values: Any, words: str) -> tuple[Any, Any, dict[str, str]]:
            return dims, values, {"units": "1", "long_name": words}

        data = {name: labelled(*variable) for name, variable in variables.items()}
        coordinates = {name: labelled((name,), values, words) for name, (values, words) in axes.items()}
        return _xarray().Dataset(data, coordinates, dict(json.loads(listed)))

    def _vertical(self) -> tuple[str, dict[str, tuple[np.ndarray, str]]]:
        """The cross-stream coordinate's name, and the axis."""
        (name,) = self.model._core.plain([self.model.coordinate or "y"])
        return name, {name: (self.y, "cross-stream coordinate")}

    def _words(self, field: str) -> str:
        return self.model.fields.get(field) or field

    def _rows(self) -> list[tuple[str, str]]:
        return []

    def _heading(self) -> str:
        return self.model.title

    def __repr__(self) -> str:
        if self._text is not None:
            return self._text
        width = max((len(name) for name, _ in self._rows()), default=0)
        lines = [self._heading()]
        lines += [f"  {name:<{width}}  {value}" for name, value in self._rows()]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        if self._text is not None:
            return f"<pre>{html.escape(self._text)}</pre>"
        cells = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in self._rows()
        )
        return f"<p>{html.escape(self._heading())}</p><table>{cells}</table>"


def _axes(ax: Any, count: int = 1) -> Any:
    """Axes of matplotlib to draw into."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("plot() needs matplotlib: pip install stuart-landau[plot]") from error
    if ax is not None:
        return ax
    _, axes = plt.subplots(1, count, figsize=(4.5 * count, 3.6), squeeze=False, layout="constrained")
    return axes[0] if count > 1 else axes[0][0]


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as error:
        raise ImportError("to_xarray() needs xarray: pip install stuart-landau[xarray]") from error
    return xarray


class Base(Result):
    """A base state. `y`: heights, in units of length of the model; `profiles`: values by field."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.parameters: dict[str, Any] = data["parameters"]
        self.y = _array(data[model.coordinate or "y"])
        self.profiles = {name: _array(data["profiles"][name]) for name in model.fields}
        #: Size of the last Chebyshev coefficients over the largest.
        self.tail: float = data["tail"]
        #: What a closed form satisfies but nearly, in words.
        self.notes: list[str] = data["notes"]

    def __getitem__(self, field: str) -> np.ndarray:
        return self.profiles[field]

    def _rows(self) -> list[tuple[str, str]]:
        rows = [(name, f"{v.min():.6g} … {v.max():.6g}") for name, v in self.profiles.items()]
        return rows + [("note", text) for text in self.notes]

    def to_xarray(self) -> Any:
        """Profiles over the cross-stream coordinate."""
        vertical, axes = self._vertical()
        names = self.model._core.plain(list(self.profiles))
        data = {
            plain: ((vertical,), values, f"{self._words(name)}, base state")
            for plain, (name, values) in zip(names, self.profiles.items())
        }
        return self._dataset(data, axes)

    def plot(self, ax: Any = None) -> Any:
        """Every field over the cross-stream coordinate."""
        ax = _axes(ax)
        for name, values in self.profiles.items():
            ax.plot(self.y, values, label=name)
        ax.set_xlabel(self.model.coordinate or "y")
        ax.legend()
        return ax


class Spectrum(Result):
    """`direct`, `adjoint`: eigenvalues in units of 1/time, adjoint ones by their conjugates (None without adjoint
    conditions)."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.k: float = data["k"]
        self.direct = np.array([_complex(c) for c in data["direct"]])
        adjoint = data.get("adjoint")
        self.adjoint = np.array([_complex(c) for c in adjoint]) if isinstance(adjoint, list) else None
        #: Absolute error of the leading eigenvalue, and of every one.
        self.error: float = data["error"]
        self.errors = _array(data["errors"])

    def to_xarray(self) -> Any:
        """Eigenvalues over the number of the mode, by decreasing growth rate; of L† nan where it has fewer."""
        data = {}
        for name, of, values in (("direct", "L", self.direct), ("adjoint", "the adjoint of L", self.adjoint)):
            if values is None:
                continue
            padded = np.full(len(self.direct), complex(math.nan, math.nan))
            padded[: len(values)] = values[: len(padded)]
            data[f"{name}_re"] = (("mode",), padded.real, f"growth rate of the eigenvalues of {of}")
            data[f"{name}_im"] = (("mode",), padded.imag, f"frequency of the eigenvalues of {of}")
        number = np.arange(len(self.direct), dtype=float)
        return self._dataset(data, {"mode": (number, "number of the mode, by decreasing growth rate")})

    def plot(self, ax: Any = None) -> Any:
        """Both in the complex plane."""
        ax = _axes(ax)
        ax.plot(self.direct.real, self.direct.imag, "o", label="L")
        if self.adjoint is not None:
            ax.plot(self.adjoint.real, -self.adjoint.imag, "x", label="L†, conjugate")
        ax.set_xlabel("growth rate")
        ax.set_ylabel("frequency")
        ax.legend()
        return ax


class Point(Result):
    """A Landau point. `c0`, `c2`, … (`coefficients`): dA/dt = a0 A + a2 A³ + …; `error`: absolute, by name."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.k: float = data["k"]
        self.parameters: dict[str, Any] = data["parameters"]
        #: Absolute errors under the names of what they are the errors of.
        self.error: dict[str, Any] = data["error"]
        #: Why a value is None, by the path of its keys: `amplitude`, `envelope.benjamin_feir`.
        self.not_decided: dict[str, str] = data["not_decided"]
        #: c0, c2, c4, …
        names = sorted((n for n in data if n[0] == "c" and n[1:].isdigit()), key=lambda n: int(n[1:]))
        self.coefficients = [_complex(data[name]) for name in names]
        self._errors = [self.error[name] for name in names]
        self.c0, self.c2 = self.coefficients[:2]
        #: A_e at cubic order, where there is one.
        self.amplitude: float | None = data["amplitude"]
        #: A_e by order, and of the Padé approximant.
        self.amplitudes: dict[str, float | None] = data["amplitudes"]
        self.radius: float | None = data["radius"]
        self.bifurcation: str = data["bifurcation"]
        self.resonance: dict[str, float | None] = data["resonance"]
        #: Value at the base state and A² correction, by name.
        self.outputs: dict[str, list[float]] = data["outputs"]
        #: dc0/d(parameter)
        self.dc0 = {name: None if c is None else _complex(c) for name, c in data["dc0"].items()}
        #: dc0_dk, d2c0_dk2, group_velocity, benjamin_feir
        self.envelope: dict[str, Any] = data["envelope"]
        #: Self and cross coefficient of a wave in a mirror-symmetric model, and which wave is stable.
        self.waves: dict[str, Any] | None = data.get("waves")
        #: Whether the state of amplitude A_e attracts; None where there is none or it is not decided.
        self.stable: bool | None = data["stable"]
        self.small_divisors: list[str] = data["small_divisors"]
        #: What the base state satisfies but nearly, in words.
        self.notes: list[str] = data["notes"]
        #: Whether a conserved mean couples to the envelope, whose equation then is not closed.
        self.conserved_mean: bool = data["conserved_mean"]
        #: Integrals that the balances keep and the spec does not name.
        self.undeclared: list[str] = data["undeclared"]

    def __getattr__(self, name: str) -> complex:
        data = self.__dict__.get("data", {})
        if name.startswith("c") and name[1:].isdigit() and name in data:
            return _complex(data[name])
        raise AttributeError(name)

    def _repr_latex_(self) -> str:
        def term(n: int, c: float) -> str:
            power = "A" if n == 0 else rf"A^{{{2 * n + 1}}}"
            return f"{_latex(complex(c), self._errors[n])} {power}"

        terms = " + ".join(term(n, c.real) for n, c in enumerate(self.coefficients))
        return rf"$$ \frac{{dA}}{{dt}} = {terms.replace('+ -', '- ')} $$"


class Modes(Result):
    """Profiles of the modes. `y`: heights; `modes[name][field]`: complex values; of X† by balance."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.y = _array(data["y"])
        self.modes = {
            name: {part: np.array([_complex(v) for v in values]) for part, values in parts}
            for name, parts in data["modes"]
        }

    def __getitem__(self, name: str) -> dict[str, np.ndarray]:
        return self.modes[name]

    def _rows(self) -> list[tuple[str, str]]:
        return [(name, ", ".join(parts)) for name, parts in self.modes.items()]

    def to_xarray(self) -> Any:
        """Real and imaginary parts over the cross-stream coordinate, by the names of the files: `X11_u_re`."""
        vertical, axes = self._vertical()
        data = {}
        for name, parts in self.modes.items():
            stem = "adjoint" if name == "X†" else self.model._core.plain([name])[0]
            for plain, (part, values) in zip(self.model._core.plain(list(parts)), parts.items()):
                for side, of in (("re", values.real), ("im", values.imag)):
                    data[f"{stem}_{plain}_{side}"] = ((vertical,), of, f"{self._words(part)} of {name}, {side}")
        return self._dataset(data, axes)

    def plot(self, name: str = "X[1;1]", ax: Any = None) -> Any:
        """One mode, imaginary parts dashed."""
        ax = _axes(ax)
        for part, values in self.modes[name].items():
            (line,) = ax.plot(self.y, values.real, label=part)
            if np.abs(values.imag).max() > 1e-9 * np.abs(values).max():
                ax.plot(self.y, values.imag, "--", color=line.get_color())
        ax.set_xlabel(self.model.coordinate or "y")
        ax.set_title(name)
        ax.legend()
        return ax


class Amplitudes(Result):
    """dz_j/dt = Σ g z^p z̄^s. `equations[j]`: terms with `z`, `conj`, `g`, `error`; `equilibria`: states up to phase."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.order: int = data["order"]
        #: Wavenumber and eigenvalue of each mode.
        self.modes = [(mode["q"][0], _complex(mode["c"])) for mode in data["modes"]]
        self.equations = [[{**term, "g": _complex(term["g"])} for term in terms] for terms in data["equations"]]
        self.equilibria = [
            {
                **state,
                "z": np.array([_complex(z) for z in state["z"]]),
                "eigenvalues": None
                if state["eigenvalues"] is None
                else np.array([_complex(c) for c in state["eigenvalues"]]),
            }
            for state in data["equilibria"]
        ]
        #: The power of the amplitude by which the defect falls; None where rounding hides it.
        self.residual_order: float | None = data["residual_order"]

    def coefficient(self, j: int, z: list[int], conj: list[int]) -> complex:
        """g of one monomial in the equation of mode j (from 0)."""
        for term in self.equations[j]:
            if term["z"] == list(z) and term["conj"] == list(conj):
                return term["g"]
        raise KeyError((z, conj))

    def _repr_latex_(self) -> str:
        lines = []
        for j, terms in enumerate(self.equations):
            right = " + ".join(f"{_latex(term['g'], term['error'])}\\, {_monomial(term, latex=True)}" for term in terms)
            lines.append(rf"\dot z_{{{j + 1}}} &= {right.replace('+ -', '- ')}")
        joined = " \\\\ ".join(lines)
        return rf"$$ \begin{{aligned}} {joined} \end{{aligned}} $$"


def _monomial(term: dict[str, Any], latex: bool = False) -> str:
    factors = []
    for letter, exponents in (("z", term["z"]), (r"\bar z" if latex else "z̄", term["conj"])):
        for j, exponent in enumerate(exponents):
            if exponent:
                index = f"_{{{j + 1}}}" if latex else str(j + 1)
                power = "" if exponent == 1 else (f"^{{{exponent}}}" if latex else f"^{exponent}")
                factors.append(f"{letter}{index}{power}")
    return " ".join(factors)


class Critical(Result):
    """The first critical point (`value`, `error`, `k`, `c0`); `all` has every one of the interval."""

    def __init__(self, model: Any, data: list[dict[str, Any]], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.all = data
        self.parameter: str = data[0]["parameter"]
        self.value: float = data[0]["value"]
        self.error: float = data[0]["error"]
        self.k: float = data[0]["k"]
        self.k_error: float = data[0]["k_error"]
        self.c0 = _complex(data[0]["c0"])
        self.c0_error: float = data[0]["c0_error"]
        #: The largest growth rate there: that of `c0`, unless a mode is followed.
        self.leading_growth: float = data[0]["leading_growth"]
        #: With `minimize`: epsilon in words, tau0, xi0_squared, g of the envelope equation, what a wave has besides, and the
        #: `error` of each by the same names.
        self.envelope: dict[str, Any] | None = data[0].get("envelope")

    def _rows(self) -> list[tuple[str, str]]:
        rows = [
            (p["parameter"], f"{p['value']:.10g} ± {p['error']:.0e} (of {p['of']}) at k = {p['k']:.10g}")
            for p in self.all
        ]
        envelope = self.envelope or {}
        errors = envelope.get("error", {})
        known = [(name, value) for name, value in envelope.items() if value is not None and name != "error"]
        return rows + [
            (name, value if isinstance(value, str) else f"{value:.9g} ± {errors[name]:.0e}") for name, value in known
        ]


class Certificate(Result):
    """`checks`: part, name, value, bound, verdict, reason, detail of each."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.checks: list[dict[str, Any]] = data["checks"]

    @property
    def holds(self) -> bool:
        """Whether no check failed."""
        return all(check["verdict"] != "failed" for check in self.checks)

    def _rows(self) -> list[tuple[str, str]]:
        def shown(check: dict[str, Any]) -> str:
            value = "" if check["value"] is None else f" {check['value']:.3e}"
            return check["verdict"] + value

        return [(f"{check['part']}. {check['name']}", shown(check)) for check in self.checks]


class Sweep(Result):
    """Landau points over a product of axes. `axes`: values by name; columns as arrays of that shape, the first axis
    first; what has no value is nan, and `status` says why. `derived`: the columns that were asked for, by their text."""

    columns = ("c0", "c0_error", "c2", "c2_error", "amplitude", "mean_flow", "second_harmonic", "leading_re")

    def __init__(
        self,
        model: Any,
        data: list[dict[str, Any]],
        resolution: int,
        axes: list[tuple[str, list[float]]],
        fixed: dict[str, Any],
        derived: Sequence[str] = (),
    ) -> None:
        super().__init__(model, data, resolution)
        #: What does not vary: `parameters`, and `k` where that is one of them.
        self.fixed = fixed
        self.axes = {name: np.array(values) for name, values in axes}
        shape = tuple(len(values) for _, values in axes)

        def placed(values: list[Any], dtype: Any) -> np.ndarray:
            # The first axis varies fastest.
            return np.array(values, dtype=dtype).reshape(shape[::-1]).T

        def column(name: str) -> np.ndarray:
            if name in ("c0", "c2"):
                empty = complex(math.nan, math.nan)
                return placed([empty if r[name] is None else complex(*r[name]) for r in data], complex)
            return placed([math.nan if r[name] is None else r[name] for r in data], float)

        self._columns = {name: column(name) for name in self.columns}
        self.derived = {
            name: placed([math.nan if (x := r["derived"][index]) is None else x for r in data], float)
            for index, name in enumerate(derived)
        }
        self.bifurcation = placed([r["bifurcation"] for r in data], object)
        self.status = placed([r["status"] for r in data], object)

    def __getattr__(self, name: str) -> np.ndarray:
        columns = self.__dict__.get("_columns", {})
        if name in columns:
            return columns[name]
        raise AttributeError(name)

    def __len__(self) -> int:
        return len(self.data)

    def _facts(self) -> dict[str, Any]:
        return self.fixed

    def _rows(self) -> list[tuple[str, str]]:
        rows = [(name, f"{v[0]:.6g} … {v[-1]:.6g}, {len(v)} values") for name, v in self.axes.items()]
        good = int((self.status == "ok").sum())
        return [*rows, ("rows", f"{len(self)}, {good} ok")]

    def to_xarray(self) -> Any:
        """The same as a dataset, real and imaginary parts apart so that it can be written as NetCDF."""
        dims = tuple(self.axes)
        columns: dict[str, np.ndarray] = {}
        for name, values in self._columns.items():
            if np.iscomplexobj(values):
                columns |= {f"{name}_re": values.real, f"{name}_im": values.imag}
            else:
                columns[name] = values
        columns |= self.derived
        columns |= {"bifurcation": self.bifurcation.astype(str), "status": self.status.astype(str)}
        meaning = self.model._core.meaning
        data = {name: (dims, values, meaning(name)) for name, values in columns.items()}
        axes = {name: (values, self.model.parameters.get(name, {}).get("doc") or meaning(name))
                for name, values in self.axes.items()}
        return self._dataset(data, axes)

    def plot(self, ax: Any = None) -> Any:
        """Growth rate, c2 and amplitude over the first axis."""
        panels = _axes(ax, 3)
        name, x = next(iter(self.axes.items()))
        for panel, label, values in (
            (panels[0], "a0", self.c0.real),
            (panels[1], "a2", self.c2.real),
            (panels[2], "A_e", np.where(self.c0.real > 0, self.amplitude, np.nan)),
        ):
            panel.plot(x, values.reshape(len(x), -1))
            panel.set_xlabel(name)
            panel.set_ylabel(label)
        return panels


class Pattern(Result):
    """Fields over the plane. `x`, `y`; `linear[field]`, `nonlinear[field]`: `[y][x]`; `base[field]`: `[y]`."""

    def __init__(self, model: Any, data: dict[str, Any], resolution: int = 50) -> None:
        super().__init__(model, data, resolution)
        self.k: float = data["k"]
        self.amplitude: float = data["amplitude"]
        self.x, self.y = np.array(data["x"]), np.array(data["y"])
        fields = data["fields"]
        self.base = {name: np.array(f["base"]) for name, f in fields}
        self.linear = {name: np.array(f["linear"]) for name, f in fields}
        self.nonlinear = {name: np.array(f["nonlinear"]) for name, f in fields}

    def _rows(self) -> list[tuple[str, str]]:
        return [("k", f"{self.k}"), ("A", f"{self.amplitude:.8g}"), ("points", f"{len(self.x)} × {len(self.y)}")]

    def to_xarray(self) -> Any:
        """Total fields over the cross-stream and the periodic coordinate."""
        vertical, axes = self._vertical()
        (periodic,) = self.model._core.plain([self.model.periodic])
        axes[periodic] = (self.x, "periodic coordinate")
        dims = (vertical, periodic)
        data: dict[str, Any] = {}
        for name, plain in zip(self.base, self.model._core.plain(list(self.base))):
            words = self._words(name)
            data[f"{plain}_base"] = (dims[:1], self.base[name], f"{words}, base state")
            data[f"{plain}_linear"] = (dims, self.linear[name], f"{words}, base and fundamental")
            data[f"{plain}_nonlinear"] = (dims, self.nonlinear[name], f"{words}, through third order")
        return self._dataset(data, axes)

    def plot(self, field: str | None = None, ax: Any = None) -> Any:
        """One field through third order, the first by default."""
        field = next(iter(self.base)) if field is None else field
        ax = _axes(ax)
        if len(self.y) > 1:
            drawn = ax.pcolormesh(self.x, self.y, self.nonlinear[field], shading="gouraud")
            ax.figure.colorbar(drawn, ax=ax, label=field)
            ax.set_ylabel(self.model.coordinate)
        else:
            ax.plot(self.x, self.nonlinear[field][0])
            ax.set_ylabel(field)
        ax.set_xlabel(self.model.periodic)
        return ax

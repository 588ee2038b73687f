"""From balance equations to amplitude equations.

>>> from stuart_landau import Model
>>> Model("swift_hohenberg").point(k=1, r=0.1, b=1).c2
(0.856143856143856+0j)
"""

from ._core import ComputationError, InputError, __version__
from .model import Model, Operators, built
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

__all__ = [
    "Amplitudes",
    "Base",
    "Certificate",
    "ComputationError",
    "Critical",
    "InputError",
    "Model",
    "Modes",
    "Operators",
    "Pattern",
    "Point",
    "Spectrum",
    "Sweep",
    "__version__",
    "built",
]

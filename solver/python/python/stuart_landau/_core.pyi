class InputError(ValueError): ...
class ComputationError(RuntimeError): ...

__version__: str

Near = tuple[float, float] | None

class Core:
    @staticmethod
    def open(name: str) -> Core: ...
    @staticmethod
    def from_text(text: str, laws: dict[str, str]) -> Core: ...
    @staticmethod
    def built() -> list[str]: ...
    def info(self) -> str: ...
    def attributes(self, parameters: str, resolution: int, k: float | None, amplitude: float | None) -> str: ...
    @staticmethod
    def plain(names: list[str]) -> list[str]: ...
    @staticmethod
    def meaning(column: str) -> str: ...
    def texts(self) -> tuple[str, dict[str, str]]: ...
    def operator(self, name: str, latex: bool) -> list[str]: ...
    def base(self, set: list[str], resolution: int, points: int) -> str: ...
    def spectrum(self, set: list[str], resolution: int, k: float) -> str: ...
    def point(self, set: list[str], resolution: int, k: float, near: Near, order: int) -> str: ...
    def modes(self, set: list[str], resolution: int, k: float, near: Near) -> str: ...
    def amplitudes(
        self, set: list[str], resolution: int, modes: list[tuple[float, Near]], order: int
    ) -> str: ...
    def critical(
        self,
        set: list[str],
        resolution: int,
        vary: str,
        between: tuple[float, float],
        of: str,
        k: float | None,
        minimize: tuple[float, float] | None,
        near: Near,
        follow: bool,
    ) -> str: ...
    def sweep(
        self,
        set: list[str],
        resolution: int,
        axes: list[tuple[str, list[float]]],
        k: float | None,
        near: Near,
        follow: bool,
        columns: list[str],
        out: str | None,
        force: bool,
    ) -> str: ...
    def check_table(
        self,
        set: list[str],
        resolution: int,
        axes: list[tuple[str, list[float]]],
        k: float | None,
        near: Near,
        follow: bool,
        columns: list[str],
        out: str,
        force: bool,
    ) -> None: ...
    def sweep_share(
        self,
        set: list[str],
        resolution: int,
        axes: list[tuple[str, list[float]]],
        k: float | None,
        near: Near,
        follow: bool,
        columns: list[str],
        share: tuple[int, int],
        out: str,
    ) -> None: ...
    @staticmethod
    def merge(shards: list[str], out: str, force: bool = False) -> None: ...
    def verify(self, set: list[str], resolution: int, k: float, near: Near, order: int) -> str: ...
    def pattern(
        self,
        set: list[str],
        resolution: int,
        k: float,
        near: Near,
        amplitude: float | None,
        points: tuple[int, int],
        wavelengths: float,
    ) -> str: ...

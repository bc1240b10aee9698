"""Exceptions and warnings, with the program's texts and codes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

_Parts = tuple[str, str, str, list[tuple[int, int, int, int, str]], "str | None"]


class Label(NamedTuple):
    """A place in a text: line and column from 1 (0 where there is no text), bytes, a few words."""

    line: int
    column: int
    start: int
    end: int
    text: str


class Diagnostic(NamedTuple):
    """One thing that is wrong: where, and what to do about it."""

    severity: str
    code: str
    message: str
    labels: tuple[Label, ...]
    help: str | None


class JuristError(Exception):
    """What all errors of this package have in common: the program's text, and the code of the first mistake.

    Examples
    --------
    >>> import jurist
    >>> try:
    ...     jurist.Loop.drive().intervals("K_pmw")
    ... except jurist.JuristError as error:
    ...     print(error.code, "|", error.help)
    E-unknown-parameter | did you mean 'K_pwm'?
    """

    code: str = "E-internal"
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def help(self) -> str | None:
        """What to do."""
        return self.diagnostics[0].help if self.diagnostics else None

    @property
    def labels(self) -> tuple[Label, ...]:
        """The places that the first mistake is about."""
        return self.diagnostics[0].labels if self.diagnostics else ()

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.args, self.__dict__)


class ModelError(JuristError, ValueError):
    """The model is refused; all mistakes are in ``diagnostics``."""


class QuestionError(JuristError, ValueError):
    """The question is refused: an unknown parameter, a value that is missing, an empty domain."""


class Undecided(JuristError, TimeoutError):
    """The budget ran out before the exact answer was reached.

    ``budget`` says which, ``reached`` the last step; ``document`` is what the program would have written, or `None`.
    """

    code = "undecided"
    budget: str = ""
    reached: str = ""
    document: str | None = None


class CertificateRejected(JuristError):
    """A certificate proves nothing; ``step`` is the step of the check that failed."""

    code = "rejected"
    step: str = ""


class InternalError(JuristError, RuntimeError):
    """A defect of this package: please report it with the model."""


class JuristWarning(UserWarning):
    """A remark of the program, with its ``code``."""

    code: str

    def __init__(self, text: str, code: str = "W-jurist") -> None:
        super().__init__(text)
        self.code = code

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.code)


def _again(kind: type[JuristError], arguments: tuple[Any, ...], values: dict[str, Any]) -> JuristError:
    error = kind(*arguments)
    error.__dict__.update(values)
    return error


def refused(about_model: bool, text: str, parts: Iterable[_Parts]) -> JuristError:
    """The exception for diagnostics of the engine."""
    found = tuple(
        Diagnostic(severity, code, message, tuple(Label(*place) for place in places), help)
        for severity, code, message, places, help in parts
    )
    code = found[0].code if found else "E-internal"
    kind: type[JuristError] = ModelError if about_model else QuestionError
    error = (InternalError if code == "E-internal" else kind)(text)
    error.code = code
    error.diagnostics = found
    return error


def undecided(text: str, budget: str, reached: str, document: str | None) -> Undecided:
    """The exception for a budget that ran out."""
    error = Undecided(f"undecided: {text}")
    error.budget, error.reached, error.document = budget, reached, document
    return error


def defect(what: str) -> InternalError:
    """The exception for a panic."""
    return InternalError(f"error[E-internal]: this is a defect of jurist, please report it: {what}")


def rejected(step: str, text: str) -> CertificateRejected:
    """The exception for a certificate that proves nothing."""
    error = CertificateRejected(text)
    error.step = step
    return error

"""Certificates, checked."""

from __future__ import annotations

from . import _jurist
from ._answers import Proved
from ._errors import rejected
from ._loop import Loop


def verify(model: str | Loop, certificate: str, *, timeout: float = 60) -> Proved:
    """Checks a certificate against a model, by code that shares nothing with the engine.

    Parameters
    ----------
    model : str or Loop
        The text of the model file, or a loop.
    certificate : str
    timeout : float
        Seconds, after which the certificate is rejected.

    Returns
    -------
    Proved
        The statement in a sentence or two.

    Raises
    ------
    CertificateRejected
        With the step that failed. That says nothing about the statement.

    Examples
    --------
    >>> import jurist
    >>> loop = jurist.Loop.from_toml("time = 'discrete'\\nparameters.K = {}\\nloop.characteristic = 'z - 1 + K'")
    >>> jurist.verify(loop, loop.intervals("K").certificate()).statement
    'For all real K, the loop is stable exactly for 0 < K < 2.'
    """
    text = model.to_toml() if isinstance(model, Loop) else model
    is_proved, what, statement = _jurist.check(text, certificate, timeout)
    if not is_proved:
        raise rejected(what, statement)
    return Proved(statement, what)

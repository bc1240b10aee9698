"""How a loop asks the engine: questions as texts, commands of the program and their outcomes."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._errors import undecided
from ._exact import Exact, text_of
from ._question import Bounds, Listener, bound, listener, requirement_text, warn
from ._requirements import REQUIREMENTS

if TYPE_CHECKING:
    from . import _jurist


class Asker:
    """What all questions of a loop share."""

    __slots__ = ("_canonical", "_core", "_said")

    _canonical: str | None
    _core: _jurist.Model
    _said: str | None

    def _asked(
        self,
        values: Mapping[str, Exact] | None = None,
        *,
        parameter: str | None = None,
        domain: Any = None,
        radius: Exact | None = None,
        decay: Exact | None = None,
        timeout: float | None = None,
        progress: Listener | bool = False,
        digits: int = 12,
        at: str | None = None,
        set: Mapping[str, Exact] | None = None,
        **require: Exact | None,
    ) -> dict[str, Any]:
        """The question as texts."""
        given = dict(values or {})
        for name, value in (set or {}).items():
            if name in given:
                raise TypeError(f"{name!r} has two values: in 'values' and in 'set'")
            given[name] = value
        if domain is None:
            domains: Mapping[str, Bounds] = {}
        elif isinstance(domain, Mapping):
            domains = domain
        elif parameter is not None:
            domains = {parameter: domain}
        else:
            raise TypeError("which parameter's domain? give a mapping of names to bounds")
        if digits < 1:
            raise ValueError("at least one digit")
        unknown = [name for name in require if name not in REQUIREMENTS]
        if unknown:
            raise TypeError(f"unexpected keyword argument {unknown[0]!r}")
        required = [(name, requirement_text(require[name])) for name in REQUIREMENTS if require.get(name) is not None]
        return {
            "values": [(str(name), text_of(value)) for name, value in given.items()],
            "domains": [(str(name), bound(low), bound(high)) for name, (low, high) in domains.items()],
            "radius": bound(radius),
            "decay": bound(decay),
            "timeout": timeout,
            "progress": listener(progress),
            "digits": digits,
            "require": [*required, *([] if at is None else [("at", at)])],
        }

    def _has_requirements(self, asked: Mapping[str, Any]) -> bool:
        """Whether more than stability may be asked for: by the question, or by a section of the model file."""
        return bool(asked["require"]) or "require" in self._core.text()

    @staticmethod
    def _words(command: str, asked: Mapping[str, Any]) -> list[str]:
        """The question as the program's options."""
        words = [command, "-"]
        for name, value in asked["values"]:
            words += ["--set", f"{name}={value}"]
        for name, low, high in asked["domains"]:
            words += ["--domain", f"{name}={low or ''}..{high or ''}"]
        words += [f"--{key}={asked[key]}" for key in ("radius", "decay") if asked[key] is not None]
        return words + [f"--{name.replace('_', '-')}={text}" for name, text in asked["require"]]

    def _asked_by(self, words: Sequence[str]) -> dict[str, Any]:
        """The question that options say."""
        pairs = [(words[i], words[i + 1]) for i in range(2, len(words) - 1) if words[i] in ("--set", "--domain")]
        values = {name: value for word, text in pairs if word == "--set" for name, _, value in [text.partition("=")]}
        domains = {
            name: tuple(end or None for end in bounds.split(".."))
            for word, text in pairs
            if word == "--domain"
            for name, _, bounds in [text.partition("=")]
        }
        return self._asked(values, domain=domains, **self._region_by(words))

    @staticmethod
    def _region_by(words: Sequence[str]) -> dict[str, Any]:
        """What options say of the region and of requirements, as keywords."""
        known = ("radius", "decay", "at", *REQUIREMENTS)
        found = [w[2:].partition("=") for w in words if w.startswith("--") and "=" in w]
        keyed = [(name.replace("-", "_"), value) for name, _, value in found]
        return {name: value for name, value in keyed if name in known}

    def _command(self, words: Sequence[str], asked: Mapping[str, Any]) -> tuple[str, tuple[str, ...], int]:
        """Runs a command of the program; gives its output, the words and the status."""
        done = self._core.command(list(words), asked["timeout"], asked["progress"])
        status, output, notes, remarks = done
        warn(remarks)
        if status == 3:
            said = next((n for n in notes if n.startswith("undecided: ")), "undecided: the budget ran out: ")
            _, _, why = said.removeprefix("undecided: ").partition(": ")
            budget, _, reached = why.partition("; reached: ")
            raise undecided(said.removeprefix("undecided: "), budget, reached, output or None)
        return output, tuple(words), status

    def _document(self, words: Sequence[str], asked: Mapping[str, Any]) -> str:
        """The JSON document of a command, with the digits that are asked for."""
        return self._command([*words, "--json", "--digits", str(asked["digits"])], asked)[0]

    def _file_of(self, words: Sequence[str], option: str, timeout: float | None) -> str:
        """What a command writes into the file that an option names."""
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "written")
            self._command([*words, option, path, "--quiet"], self._asked(timeout=timeout))
            with open(path, encoding="utf-8") as file:
                return file.read()

    def command(self, name: str, *options: str, timeout: float | None = None) -> str:
        """Runs any command of the program about this loop; gives what it prints.

        Parameters
        ----------
        name : str
            Such as ``"jury"``.
        *options : str
            As on the command line.
        timeout : float, optional
            Seconds.

        Examples
        --------
        >>> import jurist
        >>> print(jurist.Loop.drive().command("charpoly", "--keep", "T", "--format", "csv").splitlines()[0])
        polynomial,z_power,part,T_power,coefficient
        """
        return self._command([name, "-", *options], self._asked(timeout=timeout))[0]

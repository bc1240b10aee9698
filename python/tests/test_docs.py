"""The examples in the documentation are run, and everything public is documented."""

import doctest
import importlib
import inspect
import pkgutil

import jurist
import pytest

FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def documented():
    """Every public object and method that has documentation of its own."""
    found = {"jurist": jurist}
    for name in jurist.__all__:
        thing = getattr(jurist, name)
        found[name] = thing
        if inspect.isclass(thing):
            # Methods of a base class too: a loop has its questions from several.
            for member, value in inspect.getmembers_static(thing):
                if not member.startswith("_") and getattr(value, "__doc__", None):
                    found[f"{name}.{member}"] = value
    for module in pkgutil.iter_modules(jurist.__path__):
        loaded = importlib.import_module(f"jurist.{module.name}")
        for name, value in vars(loaded).items():
            if inspect.isfunction(value) and value.__module__ == loaded.__name__ and value.__doc__:
                found.setdefault(f"{module.name}.{name}", value)
    return found


EXAMPLES = {name: thing for name, thing in documented().items() if ">>>" in (inspect.getdoc(thing) or "")}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_of_the_documentation_run(name):
    text = inspect.getdoc(EXAMPLES[name])
    test = doctest.DocTestParser().get_doctest(text, {}, name, None, 0)
    said = []
    results = doctest.DocTestRunner(optionflags=FLAGS).run(test, out=said.append)
    assert results.attempted > 0
    assert not results.failed, "".join(said)


def test_everything_public_is_documented():
    silent = []
    for name in jurist.__all__:
        thing = getattr(jurist, name)
        if not inspect.getdoc(thing):
            silent.append(name)
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                is_own = callable(value) or isinstance(value, (property, classmethod, staticmethod))
                if is_own and not member.startswith("_") and not inspect.getdoc(value):
                    silent.append(f"{name}.{member}")
    assert silent == []


def test_documentation_of_the_main_questions_follows_numpydoc():
    from numpydoc.docscrape import NumpyDocString

    for thing in (jurist.Loop.intervals, jurist.Loop.margins, jurist.Loop.tolerance, jurist.Loop.ship, jurist.margins, jurist.exact, jurist.sweep, jurist.from_control, jurist.from_sympy, jurist.verify):
        sections = NumpyDocString(inspect.getdoc(thing))
        documented = {p.name for entry in sections["Parameters"] for p in [entry]}
        names = {n.lstrip("*") for joined in documented for n in joined.split(", ")}
        assert names == set(inspect.signature(thing).parameters) - {"self"}, thing


def test_many_examples_are_there():
    assert len(EXAMPLES) > 35

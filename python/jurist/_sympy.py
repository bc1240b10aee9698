"""From SymPy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

from ._exact import Floats, fraction_text, text_of

if TYPE_CHECKING:
    from ._loop import Loop


def expression(expr: Any, floats: Floats = "shortest") -> str:
    """An expression in the program's notation."""
    import sympy
    from sympy.printing.str import StrPrinter

    class Printer(StrPrinter):  # type: ignore[misc]
        def _print_Float(self, x: Any) -> str:
            if floats == "binary":
                value = sympy.Rational(x)
                return f"({value.p}/{value.q})"
            return f"({text_of(float(x), floats)})"

        def _print_Rational(self, x: Any) -> str:
            from fractions import Fraction

            return f"({fraction_text(Fraction(int(x.p), int(x.q)))})"

        def _print_Pow(self, x: Any, rational: bool = False) -> str:
            base, power = x.as_base_exp()
            if not power.is_Integer:
                if power == sympy.Rational(1, 2):
                    return f"sqrt({self._print(base)})"
                raise ValueError(f"'{x}' is not a rational expression")
            if power < 0:
                return f"(1/({self._print(base)})^{-power})"
            return f"({self._print(base)})^{power}"

    return str(Printer().doprint(sympy.sympify(expr)))


def from_sympy(
    expr: Any,
    variable: Any = None,
    *,
    time: Literal["continuous", "discrete"],
    parameters: Mapping[Any, Any] | None = None,
    floats: Floats = "shortest",
) -> Loop:
    """A loop from a SymPy expression, a polynomial, or a transfer function of `sympy.physics.control`.

    Parameters
    ----------
    expr : Expr, Poly or TransferFunction
        The characteristic polynomial; of a transfer function, its denominator.
    variable : Symbol, optional
        The polynomial's variable; that of the polynomial or transfer function, if not given.
    time : {"continuous", "discrete"}
    parameters : mapping, optional
        From symbols to nominal values or pairs of bounds. Other symbols become parameters without either.
    floats : {"shortest", "binary", "refuse"}

    Returns
    -------
    Loop

    Examples
    --------
    >>> import sympy, jurist
    >>> z, k = sympy.symbols("z k")
    >>> jurist.from_sympy(z**2 - z + k/2, z, time="discrete", parameters={k: (0, None)}).intervals("k")
    <StableSet k: (0, 2)>
    """
    import sympy

    from ._loop import Loop

    if all(hasattr(expr, part) for part in ("sys1", "sys2", "sign")):
        # SymPy's own closed loop keeps the plant's poles as well.
        one, two = expr.sys1.doit(), expr.sys2.doit()
        variable, expr = one.var, one.den * two.den - expr.sign * one.num * two.num
    elif hasattr(expr, "doit") and not isinstance(expr, (sympy.Expr, sympy.Poly)) or hasattr(expr, "to_expr"):
        system = expr.doit() if hasattr(expr, "doit") else expr
        if hasattr(system, "den") and hasattr(system, "var"):
            variable, expr = system.var, system.den
    if isinstance(expr, sympy.Poly):
        variable = expr.gens[0] if variable is None else variable
        expr = expr.as_expr()
    if variable is None:
        raise TypeError("which symbol is the polynomial's variable?")
    expr = sympy.sympify(expr)
    own = sympy.Symbol("z" if time == "discrete" else "s")
    given = {str(key): value for key, value in (parameters or {}).items()}
    if variable != own and own in expr.free_symbols:
        raise ValueError(f"'{own}' is the polynomial's variable and cannot be a parameter")
    rest = sorted(str(x) for x in expr.free_symbols if x != variable)
    for name in rest:
        given.setdefault(name, None)
    text = expression(expr.subs(variable, own), floats)
    return Loop.characteristic(text, time=time, parameters=given, floats=floats)

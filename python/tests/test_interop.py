"""Loops from and to other libraries, and loops built in Python."""

import warnings
from fractions import Fraction

import control as ct
import jurist
import numpy as np
import pytest
import scipy.signal
import sympy
from jurist import Real


def limit(loop, name="k"):
    return loop.intervals(name)[-1].upper.value


def test_an_open_loop_is_closed_around_a_gain():
    assert limit(jurist.from_control(ct.tf([1], [1, 2, 3, 0]), gain="k")) == 6
    loop = jurist.from_control(ct.ss([[0, 1, 0], [0, 0, 1], [0, -3, -2]], [[0], [0], [1]], [[1, 0, 0]], 0), gain="k")
    assert limit(loop) == 6


def test_a_system_without_a_gain_is_asked_about_itself():
    assert jurist.from_control(ct.tf([1], [1, 2, 3])).verdict()
    assert not jurist.from_control(ct.tf([1], [1, -2, 3])).verdict()
    assert jurist.from_control(ct.ss([[-1, 5], [0, -2]], [[1], [1]], [[1, 0]], 0)).verdict().inside == 2
    mimo = ct.ss([[-1, 0], [0, -2]], np.eye(2), np.eye(2), np.zeros((2, 2)))
    assert jurist.from_control(mimo).verdict().inside == 2
    with pytest.raises(ValueError, match="one input and one output"):
        jurist.from_control(mimo, gain="k")
    with pytest.raises(ValueError, match="inputs"):
        jurist.from_control(ct.tf([[[1], [1]]], [[[1, 1], [1, 2]]]), gain="k")


def test_margins_of_several_inputs_are_refused_in_words():
    both = ct.append(ct.tf([1], [1, 1]), ct.tf([2], [1, 3]))
    with pytest.raises(ValueError, match="2 inputs and 2 outputs: connect its parts by LoopBuilder"):
        jurist.margins(both)


def test_an_unspecified_time_is_asked_for():
    system = ct.tf([1], [1, 0.5], dt=None)
    with pytest.raises(ValueError, match="dt is None"):
        jurist.from_control(system)
    assert jurist.from_control(system, time="discrete").time == "discrete"
    assert jurist.from_control(ct.tf([1], [1, 0.5], dt=True)).time == "discrete"
    assert jurist.from_control(ct.tf([1], [1, 0.5], dt=0)).time == "continuous"
    loop = jurist.from_control(ct.tf([1], [1, 0.5], dt=0.1), gain="k")
    assert (loop.time, loop.sample_time()) == ("discrete", Fraction(1, 10))


def test_floats_are_read_as_they_are_written_and_computed_ones_are_remarked():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loop = jurist.from_control(ct.tf([0.1], [1, 0.2, 0.3, 0]), gain="k")
    assert limit(loop) == Fraction(6, 10)
    with pytest.warns(jurist.JuristWarning) as caught:
        jurist.from_control(ct.tf([2], [1, 3, 2, 0]).sample(0.01), gain="k")
    assert [w.message.code for w in caught] == ["W-computed-floats"]
    binary = jurist.from_control(ct.tf([0.1], [1, 0.2, 0.3, 0]), gain="k", floats="binary")
    assert limit(binary) == Fraction(0.2) * Fraction(0.3) / Fraction(0.1)
    with pytest.raises(TypeError, match="0.1"):
        jurist.from_control(ct.tf([0.1], [1, 0.2, 0.3, 0]), gain="k", floats="refuse")


def test_limits_beside_those_of_python_control():
    rng = np.random.default_rng(20020326)
    for _ in range(20):
        den = np.poly(-rng.integers(1, 9, size=4))
        system = ct.tf([float(rng.integers(1, 9))], den)
        gm = ct.stability_margins(system)[0]
        assert float(limit(jurist.from_control(system, gain="k"))) == pytest.approx(gm, rel=1e-6)


def test_names_survive_and_come_back():
    system = ct.tf([1], [1, 1, 0], inputs=["torque"], outputs=["angle"], name="arm")
    loop = jurist.from_control(system, gain="k")
    assert (loop.title, loop.inputs, loop.outputs) == ("arm", ("r",), ("angle",))
    back = loop.to_control("r", "angle", {"k": 3})
    assert (back.input_labels, back.output_labels, back.dt) == (["r"], ["angle"], 0)
    want = ct.feedback(3 * ct.tf([1], [1, 1, 0]))
    assert np.allclose(back.num[0][0], want.num[0][0])
    assert np.allclose(back.den[0][0], want.den[0][0])


def test_a_closed_loop_of_a_diagram_goes_to_python_control(drive):
    with pytest.raises(jurist.QuestionError):
        drive.to_control("nothing", "omega")
    system = drive.to_control("omega_ref", "omega")
    assert system.dt == pytest.approx(1e-4)
    response = ct.step_response(system, T=np.arange(0, 0.2, 1e-4))
    ours = drive.simulate(inputs={"omega_ref": 1}, duration="0.1999")["omega"]
    assert np.allclose(np.squeeze(response.outputs)[: len(ours)], ours[: response.outputs.size], atol=1e-6)


def test_scipy_systems():
    loop = jurist.from_control(scipy.signal.TransferFunction([1], [1, 2, 3, 0]), gain="k")
    assert limit(loop) == 6
    assert jurist.from_control(scipy.signal.TransferFunction([1], [1, 0.5], dt=0.1)).time == "discrete"


def test_sympy_expressions_polynomials_and_transfer_functions():
    z, k, s = sympy.symbols("z k s")
    want = jurist.Loop.characteristic("z^2 - z + k/2", time="discrete", parameters={"k": (0, None)}).intervals("k")
    for expr in (z**2 - z + k / 2, sympy.Poly(z**2 - z + k / 2, z), (z - 1) ** 2 + z - 1 + k / 2):
        assert jurist.from_sympy(expr, z, time="discrete", parameters={k: (0, None)}).intervals("k") == want
    w = sympy.symbols("w")
    assert jurist.from_sympy(w**2 - w + k / 2, w, time="discrete", parameters={k: (0, None)}).intervals("k") == want
    from sympy.physics.control.lti import Feedback, TransferFunction

    plant = TransferFunction(k, s * (s + 1) * (s + 2), s)
    assert limit(jurist.from_sympy(Feedback(plant), time="continuous")) == 6
    assert str(jurist.from_sympy(z - sympy.Float(0.1) * k, z, time="discrete").intervals("k")) == "(-10, 10)"
    with pytest.raises(TypeError, match="variable"):
        jurist.from_sympy(z - k, time="discrete")
    with pytest.raises(ValueError, match="parameter"):
        jurist.from_sympy(s * w + k, w, time="continuous")


def test_polynomials_go_to_sympy_and_numpy(drive):
    p = drive.charpoly(["K_pwm"], {"T": "1e-4"})
    q = p.sympy()
    assert q.degree() == p.degree == 6
    at = q.as_expr().subs("K_pwm", 110)
    assert np.allclose([float(c) for c in sympy.Poly(at, sympy.Symbol("z")).all_coeffs()], p.numpy(K_pwm=110))
    assert max(abs(np.roots(p.numpy(K_pwm=110)))) < 1 < max(abs(np.roots(p.numpy(K_pwm=555))))
    assert "\\begin{align" in p.latex()


def test_a_builder_writes_the_model_that_it_means():
    b = jurist.LoopBuilder("continuous", title='quo"ted', floats="shortest")
    K = b.parameter("K", 1, min=0, unit="V")
    b.constant("g", "1/3")
    b.block("controller", "r - y", "u", f"{K}*(s + g)/s").block("plant", "u", "y", ct.tf([1], [1, 2, 3, 4]))
    loop = b.build(inputs=["r"], outputs=["y"])
    assert loop.title == 'quo"ted'
    assert loop.parameters["K"] == jurist.Parameter("K", Fraction(1), Fraction(0), None, "V", None)
    s = sympy.Symbol("s")
    k = sympy.Symbol("K")
    want = sympy.Poly(s * (s**3 + 2 * s**2 + 3 * s + 4) + k * (s + sympy.Rational(1, 3)), s)
    assert sympy.simplify(loop.charpoly().sympy().as_expr() - want.as_expr()) == 0
    again = jurist.Loop.from_toml(loop.to_toml())
    assert again == loop
    assert hash(again) == hash(loop)


def test_systems_with_sample_times_of_their_own():
    slow, lag = ct.tf([1], [1, -1], 0.2), ct.tf([1], [1, 1])
    # From one sample of the slow part to the next: z - 1 and a lag behind a hold of 0.2 s.
    assert limit(jurist.from_control([slow, lag], gain="k", hold="1/10")) == 1
    assert limit(jurist.from_control([slow, ct.tf([1], [1, -0.5], 0.1)], gain="k")) == Fraction(1, 2)
    three = jurist.from_control([ct.tf([1], [1, -1], 0.2), ct.tf([1], [1, 0], 0.3)], gain="k")
    assert three.to_toml().count("every") == 2
    for systems, keys, message in (
        ([lag], {}, "name the gain"),
        ([lag], {"gain": "k"}, "give 'hold'"),
        ([lag, lag], {"gain": "k", "hold": 1}, "one plant"),
        ([ct.tf([1], [1, 0], True)], {"gain": "k"}, "as a number"),
        ([slow, lag], {"gain": "k", "hold": "3/20"}, "no whole multiple"),
    ):
        with pytest.raises(ValueError, match=message):
            jurist.from_control(systems, **keys)
    b = jurist.LoopBuilder("discrete", sample_time="1/10")
    b.block("slow", "r - y", "u", slow, phase=1).block("fast", "u", "y", "1/(2*z - 1)")
    assert "every = 2\nphase = 1" in b.to_toml()
    with pytest.raises(ValueError, match="3/20 of 'other' is no whole multiple"):
        b.block("other", "u", "v", ct.tf([1], [1, 0], 0.15))


def test_blocks_of_every_form():
    b = jurist.LoopBuilder("discrete", sample_time="1/10")
    b.parameter("K", "1/2")
    b.block("gain", "r - y", "e", "K")
    b.block("samples", "e", "d", delay=1)
    b.block("ratio", "d", "v", num=[1], den=[1, "-1/2"])
    b.block("states", "v", "y", A=[["-1"]], B=[["1"]], discretize={"method": "forward", "T": "1/10"})
    loop = b.build(inputs=["r"], outputs=["y"])
    assert loop.charpoly().degree == 3
    assert 0.5 in loop.intervals("K")
    static = jurist.LoopBuilder("continuous").block("a", "r - y", "u", ct.ss([], [], [], [[2.0]])).block("b", "u", "y", "1/(s + 1)")
    assert static.build(inputs=["r"], outputs=["y"]).verdict()
    two = jurist.LoopBuilder("discrete")
    two.parameter("K", 1)
    assert str(two.matrix(np.array([[0.5, 0.25], [0.0, 0.5]])).build().verdict()) == "stable: 2 inside"
    feedback = jurist.LoopBuilder("continuous")
    feedback.parameter("K", 1)
    assert str(feedback.feedback([["0", "1"], ["0", "0"]], [["0"], ["1"]], [["1", "1"]], [["K"]]).build().intervals("K")) == "(0, inf)"
    with pytest.raises(ValueError, match="time is"):
        jurist.LoopBuilder("discreet")
    with pytest.raises(jurist.ModelError, match="<built loop>"):
        jurist.LoopBuilder("discrete").characteristic("z - Q").build()


def test_coefficients_in_a_sequence():
    loop = jurist.Loop.characteristic([1, 2, 3, "K"], time="continuous", parameters=["K"])
    assert str(loop.intervals("K")) == "(0, 6)"
    s = jurist.Loop.characteristic(np.array([1.0, 0.1, 0.2]), time="continuous")
    assert s.verdict().inside == 2


def test_an_answer_goes_on_in_other_libraries(drive):
    upper = drive.intervals("K_pwm")[0].upper.value
    assert abs(upper.sympy().evalf(40) - sympy.Float(upper.decimal(40), 40)) < sympy.Float("1e-36")
    assert np.isclose(float(upper), float(Real(upper)))
    response = drive.simulate(duration="0.01").to_control()
    assert response.outputs.shape[-1] == 101


def test_a_builder_takes_formulas_and_closed_domains():
    b = jurist.LoopBuilder("discrete")
    L = b.constant("L", "1/2")
    K = b.parameter("K", f"3*{L}/2", min="1/2", max=1, closed=True)
    loop = b.characteristic(f"z - 1/2 - {L} + {K}").build()
    parameter = loop.parameters["K"]
    assert (parameter.nominal, parameter.closed) == (Fraction(3, 4), True)
    assert parameter.formula is not None
    stable = loop.intervals("K")
    assert stable.domain_closed == (True, True)
    assert Fraction(1, 2) in stable
    assert 1 in stable
    assert (~stable).intervals == ()


def test_a_response_without_coefficients_is_refused_in_words():
    with pytest.raises(TypeError, match="FrequencyResponseData has no coefficients"):
        jurist.from_control(ct.frd([1, 2], [1, 2]), gain="k")

# %% [markdown]
# # A drive from python-control's blocks
# Blocks may be systems of python-control; the free parameters are written in.

# %%
import control as ct
import matplotlib.pyplot as plt
import jurist

motor = ct.tf([1], [1, 3, 2, 0], name="motor")
b = jurist.LoopBuilder("continuous", title="servo with a PI controller")
K = b.parameter("K", 1, min=0)
a = b.parameter("a", "1/4", min=0)
b.block("controller", "r - y", "u", f"{K}*(s + {a})/s").block("motor", "u", "y", motor)
servo = b.build(inputs=["r"], outputs=["y"])
servo.analyze()

# %% [markdown]
# The exact limit beside the gain margin in floating point.

# %%
L = ct.tf([1, 0.25], [1, 0]) * motor
print("python-control:", ct.stability_margins(L)[0])
print("exact:         ", servo.intervals("K")[0].upper.value.decimal(20))

# %% [markdown]
# All margins, exactly, and the open loop with the crossings marked on it.

# %%
m = jurist.margins(L)
m

# %%
figure = plt.figure(figsize=(11, 5))
left, right = figure.subfigures(1, 2)
servo.bode("u").plot(left.subplots(2, 1, sharex=True))
servo.nyquist("u").plot(right.subplots())

# %% [markdown]
# Back to python-control: the closed loop at a point, with its names.

# %%
T = servo.to_control("r", "y", {"K": "1/2"})
response = ct.step_response(T)
plt.figure()
plt.plot(response.time, response.outputs)
plt.xlabel("time (s)")
plt.ylabel("y")
assert servo.verdict({"K": "1/2"})

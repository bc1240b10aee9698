# %% [markdown]
# # A first limit
# For which gains is this loop stable? One line says the loop, one asks.

# %%
import jurist

loop = jurist.Loop.characteristic("z^2 - z + K/2", time="discrete", parameters={"K": (0, None)})
s = loop.intervals("K")
s

# %% [markdown]
# The end is a number, not a measurement: ask for as many digits as you like, or for the polynomial that it is a root of.

# %%
upper = s[0].upper
print(upper.value, upper.cause, upper.angle)

# %% [markdown]
# The built-in drive is a chopper-fed DC motor with two controllers. Its limit is irrational.

# %%
drive = jurist.Loop.drive()
limit = drive.intervals("K_pwm")
limit

# %%
print(limit[0].upper.value.decimal(60))
print(limit[0].upper.value.polynomial)

# %% [markdown]
# A certificate proves it: the checker shares no code with the engine.

# %%
print(jurist.verify(drive, limit.certificate()).statement)

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots(1, 2, figsize=(11, 4))
limit.plot(axes[0])
drive.locus("K_pwm").plot(axes[1])
figure.tight_layout()

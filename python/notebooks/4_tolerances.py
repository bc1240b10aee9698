# %% [markdown]
# # Tolerances of a design
# How much may each constant of the drive change before the loop is unstable? Each is asked for by itself: a constant that is given
# as a number may be a question, too.

# %%
import matplotlib.pyplot as plt
import jurist

drive = jurist.Loop.drive()
names = [name for name in ("R_a", "L_a", "K_a", "J", "B_v") if name in drive.constants]
sets = {name: drive.intervals(name, domain=(0, None)) for name in names}
for name, s in sets.items():
    end = s.nearest_end()
    print(f"{name:4} nominal {float(s.nominal):<8g} stable on {s}; nearest end {end} ({end.cause})")

# %% [markdown]
# As shares of the nominal values: how far the nearest end is.

# %%
factors = {name: sorted(float(e.value / s.nominal) for i in s for e in (i.lower, i.upper) if e is not None) for name, s in sets.items()}
figure, ax = plt.subplots(figsize=(7, 3))
for k, (name, ends) in enumerate(factors.items()):
    ax.plot(ends, [k] * len(ends), "o")
ax.axvline(1, color="gray")
ax.set_xscale("symlog", linthresh=0.1)
ax.set_xlabel("end / nominal")
ax.set_xlim(left=-0.02)
ax.set_yticks(range(len(factors)), list(factors))
ax.margins(y=0.15)

# %% [markdown]
# All at once: is the drive stable for every combination within 20 %? That is proved over the whole box, or a point is found that is
# not. Which tolerance uses how much of the margin is drawn.

# %%
t = drive.tolerance(tol={name: "20%" for name in names})
print(t)

# %%
figure, ax = plt.subplots(figsize=(7, 3))
t.plot(ax)

# %% [markdown]
# # A region for a requirement
# Stable is not enough: all roots are wanted within a smaller disc, so that every mode decays fast. The set is asked with the
# requirement in it, and sets are combined exactly.

# %%
import matplotlib.pyplot as plt
import jurist

loop = jurist.Loop.characteristic("z^2 - (2 - a)*z + (1 - a + b)", time="discrete", parameters={"a": "1/2", "b": "1/10"})
stable = loop.intervals("b")
fast = loop.intervals("b", radius="9/10")
print("stable:", stable)
print("fast:  ", fast)
print("stable, but not fast:", stable - fast)

# %% [markdown]
# Margins are required in the same way, where the loop is cut at a signal. Ends say which requirement binds.

# %%
servo = jurist.LoopBuilder("continuous")
K = servo.parameter("K", 1, min=0)
servo = servo.block("controller", "r - y", "u", f"{K}*(s + 1/4)/s").block("plant", "u", "y", "1/(s^3 + 3*s^2 + 2*s)").build(inputs=["r"], outputs=["y"])
far = servo.intervals("K", modulus_margin="3/10", at="u")
print("stable:", servo.intervals("K"))
print("modulus margin 3/10:", far, "-", far[0].upper.requirement)

# %%
figure, ax = plt.subplots(figsize=(6, 5))
loop.map("a", "b").plot(ax)
loop.map("a", "b", radius="9/10").plot(ax, facecolor="tab:orange")
ax.set_title("stable; inside it, all |z| < 9/10")

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
# The same for a margin: the open loop, cut at the parameter, is to stay away from -1.

# %%
far = loop.intervals("b", modulus_margin="3/10", at="b")
print("modulus margin 3/10:", far, "-", far[0].upper.requirement or far[0].upper.cause)

# %%
figure, ax = plt.subplots(figsize=(6, 5))
loop.map("a", "b").plot(ax)
loop.map("a", "b", radius="9/10").plot(ax, facecolor="tab:orange")
ax.set_title("stable; inside it, all |z| < 9/10")

# %% [markdown]
# # A sweep on Dask
# The same question at many points, on two local workers. With a folder the run can be interrupted: the same call goes on.

# %%
import tempfile

import matplotlib.pyplot as plt
from distributed import Client, LocalCluster

import jurist

loop = jurist.Loop.drive()
grid = {"T": [f"{k}e-6" for k in range(40, 400, 2)]}
folder = tempfile.mkdtemp()

# %%
with LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster, Client(cluster) as client:
    r = jurist.sweep(loop, "K_pwm", grid, executor=client, out=folder, progress=False)
    again = jurist.sweep(loop, "K_pwm", grid, executor=client, out=folder, progress=False)
print(r, again)
assert again.asked == 0

# %%
frame = r.to_frame()
plt.loglog(frame["p.T"].map(lambda t: float(jurist.exact(t))), frame["upper"])
plt.gca().tick_params(axis="x", which="minor", labelrotation=60)
plt.xlabel("T (s)")
plt.ylabel("largest stable K_pwm (V)")

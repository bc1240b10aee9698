#!/usr/bin/env python3
"""Writes the binary files beside it: pip install numpy scipy; python make.py. SciPy puts the time into its headers: it is taken out."""

from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse

HERE = Path(__file__).parent
SERVO = {
    "A": np.array([[-21.73913043478261, -11.95652173913043, 0], [5.913978494623656, -0.08602150537634409, 0], [0, 1, 0]]),
    "B": np.array([[21.73913043478261], [0], [0]]),
    "C": np.array([[0, 0, 1]], dtype=np.int32),
    "D": np.zeros((1, 1)),
}
SAMPLED = {"A": np.array([[0.5, 1], [0, 0.25]]), "B": np.eye(2), "C": np.eye(2), "D": np.array([[0.1, 0], [0, 0]]), "Ts": 0.1}


def mat(name, variables, **options):
    scipy.io.savemat(HERE / name, variables, **options)
    data = bytearray((HERE / name).read_bytes())
    data[:116] = b"MATLAB 5.0 MAT-file, made by make.py".ljust(116)
    (HERE / name).write_bytes(data)


def main():
    mat("servo.mat", SERVO)
    mat("servo-packed.mat", SERVO, do_compression=True)
    mat("sampled-struct.mat", {"note": "two channels", "sys": SAMPLED}, do_compression=True)
    mat("single.mat", {"A": np.array([[0.1, 0.5], [-0.25, 0.7]], dtype=np.float32), "dt": -1})
    mat("sparse.mat", {"A": scipy.sparse.csc_matrix(np.eye(2))})
    mat("complex.mat", {"A": np.eye(2) * 1j})
    mat("nan.mat", {"A": np.array([[0.0, 1.0], [np.nan, 2.0]])})
    mat("not-square.mat", {"A": np.ones((2, 3))})
    mat("wrong-b.mat", {"A": np.eye(2), "B": np.ones((3, 1))})
    mat("empty.mat", {"A": np.zeros((0, 0)), "D": 1.0})
    mat("delayed.mat", {"sys": {"A": np.eye(2), "B": np.ones((2, 1)), "InputDelay": 0.3}})
    mat("two-systems.mat", {"p": {"A": np.eye(1)}, "q": {"A": np.eye(1)}})
    scipy.io.savemat(HERE / "level-4.mat", {"A": np.eye(2)}, format="4")
    np.savez(HERE / "servo.npz", **{k: np.asfortranarray(v) for k, v in SERVO.items()})
    np.savez_compressed(HERE / "sampled.npz", **{k: np.asarray(v, dtype=">f8") for k, v in SAMPLED.items()})


if __name__ == "__main__":
    main()

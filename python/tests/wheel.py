"""What a wheel has to hold and to weigh: licences, list of parts, types, no dependency; and how long the import takes."""

import re
import subprocess
import sys
import zipfile
from email.parser import Parser

LARGEST = 12 << 20
"""Bytes."""


def main(path, profile="release"):
    with zipfile.ZipFile(path) as wheel:
        names = wheel.namelist()
        info = next(n for n in names if n.endswith(".dist-info/METADATA"))
        metadata = Parser().parsestr(wheel.read(info).decode())
        folder = info.removesuffix("METADATA")
        size = sum(i.compress_size for i in wheel.infolist())
        sbom = next((n for n in names if n.startswith(f"{folder}sboms/")), None)
        parts = wheel.read(sbom).decode() if sbom else ""
        entry = wheel.read(f"{folder}entry_points.txt").decode()
    assert metadata["License-Expression"] == "(MIT OR Apache-2.0) AND LGPL-3.0-only", metadata["License-Expression"]
    for text in ("LICENSE-MIT", "LICENSE-APACHE", "LGPL-3.0.txt", "GPL-3.0.txt", "NOTICE.md"):
        assert any(n.startswith(f"{folder}licenses/") and n.endswith(text) for n in names), text
    required = [r for r in metadata.get_all("Requires-Dist", []) if "extra ==" not in r]
    assert required == [], required
    assert metadata["Requires-Python"] == ">=3.11"
    assert "jurist=jurist.__main__:main" in entry.replace(" ", "")
    assert "malachite-nz" in parts, "no list of parts"
    assert "path+file:/" not in parts, "the list of parts names folders of this machine"
    assert "jurist/py.typed" in names
    assert "jurist/_jurist.pyi" in names
    assert re.search(r"-cp311-abi3-", path), path
    assert size < LARGEST or profile != "release", size
    code = "import time; t = time.perf_counter(); import jurist; print((time.perf_counter() - t) * 1000)"
    times = sorted(float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout) for _ in range(7))
    # How long it takes depends on the machine, so it is said and not held.
    print(f"{path}: {size / 1e6:.1f} MB, import {times[0]:.1f} ms at best, {times[3]:.1f} ms in the middle")


main(*sys.argv[1:])

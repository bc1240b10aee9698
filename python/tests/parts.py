"""Takes the machine out of a wheel's list of parts: python parts.py WHEEL ROOT

maturin writes a CycloneDX list with the folders of the clone in it, a number drawn at random and the time of the build. Folders become relative to the
clone, the number that of the content, the time that of SOURCE_DATE_EPOCH where it is set; what else is in the wheel stays as it is.
"""

import base64
import hashlib
import json
import os
import sys
import uuid
import zipfile
from datetime import UTC, datetime
from pathlib import Path


def plain(text, root):
    """The list without the machine."""
    document = json.loads(text.replace(f"path+file://{root}/", "path+file:").replace(f"path+file://{root}#", "path+file:.#"))
    document.pop("serialNumber", None)
    if "SOURCE_DATE_EPOCH" in os.environ:
        document["metadata"]["timestamp"] = datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), UTC).isoformat()
    number = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(document, sort_keys=True))
    out = json.dumps({"serialNumber": number.urn, **document}, indent=2, ensure_ascii=False) + "\n"
    assert str(root) not in out, "a folder of this machine is in the list of parts"
    return out


def main(wheel, root):
    wheel, root = Path(wheel), Path(root).resolve()
    with zipfile.ZipFile(wheel) as archive:
        entries = [(info, archive.read(info)) for info in archive.infolist()]
    changed = {}
    for k, (info, content) in enumerate(entries):
        if "/sboms/" in info.filename:
            new = plain(content.decode(), root).encode()
            entries[k] = (info, new)
            digest = base64.urlsafe_b64encode(hashlib.sha256(new).digest()).rstrip(b"=").decode()
            changed[info.filename] = f"{info.filename},sha256={digest},{len(new)}"
    assert changed, "no list of parts"
    for k, (info, content) in enumerate(entries):
        if info.filename.endswith(".dist-info/RECORD"):
            lines = [changed.get(line.split(",")[0], line) for line in content.decode().splitlines()]
            entries[k] = (info, ("\n".join(lines) + "\n").encode())
    beside = wheel.with_suffix(".new")
    with zipfile.ZipFile(beside, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for info, content in entries:
            archive.writestr(info, content)
    beside.replace(wheel)


main(*sys.argv[1:])

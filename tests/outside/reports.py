#!/usr/bin/env python3
"""Whether the reports of `jurist test` fit the published schemas.

    tests/outside/reports.py PROGRAM SARIF_SCHEMA JUNIT_SCHEMA

SARIF_SCHEMA is sarif-schema-2.1.0.json (OASIS; the crate serde-sarif carries it as src/schema.json), JUNIT_SCHEMA junit-10.xsd (Jenkins; the sources of pytest
carry it as testing/example_scripts/junit-10.xsd). Needs jsonschema and xmlschema.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import jsonschema
import xmlschema

program, sarif_schema, junit_schema = (pathlib.Path(name).resolve() for name in sys.argv[1:])
examples = pathlib.Path(__file__).resolve().parents[2] / "examples"
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder) / "tests"
    shutil.copytree(examples / "firmware", folder)
    header = folder / "params.h"
    # One that fails, one that is bad, and examples that hold.
    header.write_text(header.read_text().replace("0.35f", "1.6f").replace("0.25f", "0.2f"))
    (folder / "bad.toml").write_text("time = 'discrete'\n[[expect]]\nverdict = 'a < b & \"c\"'\n")
    command = [program, "test", ".", *examples.glob("o*.toml"), "--junit", "junit.xml", "--sarif", "log.sarif", "--quiet"]
    status = subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL).returncode
    log = json.loads((folder / "log.sarif").read_text())
    schema = json.loads(sarif_schema.read_text())
    in_log = list(jsonschema.validators.validator_for(schema)(schema).iter_errors(log))
    in_report = list(xmlschema.XMLSchema(str(junit_schema)).iter_errors(str(folder / "junit.xml")))
for error in in_log + in_report:
    print(str(getattr(error, "reason", None) or error.message)[:300])
print(f"status {status}, {len(log['runs'][0]['results'])} results; errors: SARIF {len(in_log)}, JUnit {len(in_report)}")
sys.exit(1 if in_log or in_report or status != 2 else 0)

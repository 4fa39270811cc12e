"""docs/measurements/speed-against-error.md is what bench/report/page.md and the measurements of bench/results make, and
shows all pictures of bench/results.

    tests/bench/page_test.py SOURCE

Whoever edits the page alone would lose it with the next `make bench`. Exit code 1 if the two differ, with the lines, or
if a picture is missing or shown nowhere.
"""
import difflib
import json
import pathlib
import re
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
sys.dont_write_bytecode = True
sys.path.insert(0, str(source / "bench" / "report"))
import page  # noqa: E402
import run  # noqa: E402

results = source / "bench" / "results"
reports = {name: json.loads((results / f"{name}.json").read_text()) for name in (*run.RUNS, "micro")}
with tempfile.TemporaryDirectory() as folder:
    made = pathlib.Path(folder) / "page.md"
    page.write(source / "bench" / "report" / "page.md", reports, json.loads((results / "machine.json").read_text()),
               "../../bench/results", made)
    kept = source / "docs" / "measurements" / "speed-against-error.md"
    difference = list(difflib.unified_diff(made.read_text().splitlines(), kept.read_text().splitlines(),
                                           "bench/report/page.md, filled in", "docs/measurements/speed-against-error.md", lineterm="", n=0))
shown = set(re.findall(r"!\[[^\]]+\]\(\.\./\.\./bench/results/([^)]*)\)", kept.read_text()))
there = {file.name for file in results.glob("*.svg")}
faults = [f"no such picture: {name}" for name in sorted(shown - there)]
faults += [f"shown nowhere: {name}" for name in sorted(there - shown)]
faults += [f"no picture of a report: {name}" for name in run.RUNS if f"{name}.svg" not in there]
print("\n".join(difference + faults))
sys.exit(1 if difference or faults else 0)

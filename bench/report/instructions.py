#!/usr/bin/python3
"""Instructions of three workloads under callgrind: counts that repeat where seconds do not.

    bench/report/instructions.py PROGRAM bench/results/instructions.json [--write]

Compares with the counts that are kept, and exits with 1 where one has grown by more than 2 %; --write keeps the new ones.
Other compilers and libraries count otherwise: the file names those it was made with.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys

import machine

WORKLOADS = ("kernel", "broad_phase", "exact_decision")
ALLOWED_GROWTH = 0.02  # repeated runs of one build differ by less than 0.01 %


def count(program, workload):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=selvage_counted",
               str(program), workload]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1)), int(run.stdout.split()[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("kept", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    about = machine.describe(options.program.parent.parent)
    counted = {}
    for workload in WORKLOADS:
        instructions, result = count(options.program, workload)
        counted[workload] = {"instructions": instructions, "result": result}
    kept = json.loads(options.kept.read_text()) if options.kept.exists() else {"counts": {}}
    grown = False
    for workload, row in counted.items():
        before = kept["counts"].get(workload)
        ratio = row["instructions"] / before["instructions"] if before else 1
        grown |= ratio > 1 + ALLOWED_GROWTH
        print(f"{workload:16} {row['instructions']:>14,}  {ratio:.4f} of what is kept" if before else
              f"{workload:16} {row['instructions']:>14,}  new")
    if options.write:
        made_with = {key: about[key] for key in ("compiler", "flags", "system", "commit")}
        options.kept.write_text(json.dumps({"schema": "selvage.bench.instructions/1", **made_with, "counts": counted}, indent=2) + "\n")
        return 0
    if kept.get("compiler") not in (None, about["compiler"]):
        print(f"kept counts are of {kept['compiler']}, these of {about['compiler']}", file=sys.stderr)
    return 1 if grown else 0


if __name__ == "__main__":
    sys.exit(main())

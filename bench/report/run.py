#!/usr/bin/python3
"""One run of all benchmarks: JSON, CSV and SVG files in one folder, and the page that shows them.

    bench/report/run.py --build build/release --results bench/results --page docs/measurements/speed-against-error.md [--quick]

Exit code 1 if a benchmark found something wrong: a miss of a method that promises none, two methods that differ.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import time

import machine
import micro
import page
import tables

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent

# name of the report: arguments in full, arguments when quick
RUNS = {
    "cloth": ("methods --sheet 100 --most 40000 --hard 0 --repeat 3", "methods --sheet 40 --most 10000 --hard 0 --repeat 2"),
    "hard": ("methods --sheet 0 --hard 1000 --repeat 3", "methods --sheet 0 --hard 200 --repeat 2"),
    "verify": ("verify --faces 20000,100000,500000 --motion --repeat 3", "verify --faces 5000,20000 --motion --repeat 1"),
    "broad": ("broad --largest 100000 --repeat 3", "broad --largest 20000 --repeat 1"),
    "crumple": ("broad --largest 30000 --pleats 1,0.5,0.2,0.1,0.05 --repeat 3",
                "broad --largest 10000 --pleats 1,0.2,0.05 --repeat 1"),
    "sim": ("sim --solvers explicit,implicit --growth 30,60,120,240,400 --steps 1 --finest-mesh 33 --repeat 3",
            "sim --solvers explicit,implicit --growth 20,40 --finest-mesh 17 --module-nodes 20 --repeat 1"),
}


def public_frames():
    """The cloth frames of the public Scalable-CCD data, where they are."""
    data = pathlib.Path(os.environ.get("SELVAGE_DATA", SOURCE.parent / "shared" / "data"))
    frames = data / "ccd" / "scalable-ccd" / "cloth-ball" / "frames"
    return sorted(str(file) for file in frames.glob("*.ply"))[:2]


def measure(build, name, arguments, results):
    command = [str(build / "cli" / "selvage"), "bench", *arguments.split(), "--json", str(results / f"{name}.json"),
               "--svg", str(results / f"{name}.svg")]
    if name == "cloth":
        command[3:3] = public_frames()
    start = time.monotonic()
    print(f"bench: {name} ...", end="", file=sys.stderr, flush=True)
    with open(build / "bench" / f"{name}.txt", "w") as table:
        code = subprocess.run(command, stdout=table, check=False).returncode
    print(f" {time.monotonic() - start:.0f} s" + (f", exit code {code}" if code else ""), file=sys.stderr)
    return code


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="the release build")
    parser.add_argument("--results", type=pathlib.Path, required=True, help="the folder to write")
    parser.add_argument("--page", type=pathlib.Path, required=True, help="the page to write")
    parser.add_argument("--quick", action="store_true", help="small sizes: two minutes")
    parser.add_argument("--only", nargs="*", choices=list(RUNS), help="run these again, keep the other reports of the folder")
    parser.add_argument("--page-only", action="store_true",
                        help="measure nothing: write the page, and the CSV files, of the reports that the folder holds")
    options = parser.parse_args()
    options.results.mkdir(parents=True, exist_ok=True)
    about_file = options.results / "machine.json"
    codes = []
    if not options.page_only:
        about = machine.describe(options.build)
        about["load_before"], start = machine.load(), time.monotonic()
        for name in options.only or RUNS:
            arguments = RUNS[name][1 if options.quick else 0]
            codes.append(measure(options.build, name, arguments, options.results))
        if not options.only:
            (options.results / "micro.json").write_text(json.dumps(micro.measure(options.build), indent=2) + "\n")
        about["minutes"], about["load_after"] = (time.monotonic() - start) / 60, machine.load()
        about["quick"] = options.quick
        about_file.write_text(json.dumps(about, indent=2) + "\n")
    reports = {name: json.loads((options.results / f"{name}.json").read_text()) for name in (*RUNS, "micro")}
    tables.write_all(reports, options.results)
    options.page.parent.mkdir(parents=True, exist_ok=True)
    page.write(HERE / "page.md", reports, json.loads(about_file.read_text()),
               os.path.relpath(options.results, options.page.parent), options.page)
    print(f"bench: the page is {options.page}", file=sys.stderr)
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main())

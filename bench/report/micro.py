"""The micro level: Google Benchmark's times of the smallest pieces of work, and callgrind's counts of instructions."""
import json
import subprocess

import instructions

# the name in micro/micro.cpp, and the one in micro/instructions.cpp where it is counted
WORKLOADS = {"textbook": None, "kernel_single": "kernel", "kernel_batches": None, "broad_phase": "broad_phase",
             "exact_decision": "exact_decision"}
BASELINE = "textbook"


def measure(build):
    """Ratios and counts alone: the program's own report names the machine and its folders."""
    command = [str(build / "bench" / "selvage_micro"), "--benchmark_format=json", "--benchmark_repetitions=3"]
    report = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    best = {}
    for row in report["benchmarks"]:
        if row["run_type"] == "iteration":
            name = row["name"].removeprefix("run/")
            best[name] = max(best.get(name, 0), row["items_per_second"])
    rows = []
    for name, counted in WORKLOADS.items():
        row = {"name": name, "ns_a_pair": 1e9 / best[name], "ratio": best[BASELINE] / best[name]}
        if counted:
            row["instructions"], _ = instructions.count(build / "bench" / "selvage_instructions", counted)
        rows.append(row)
    return {"schema": "selvage.bench.micro/1", "baseline": BASELINE, "workloads": rows}

"""What a measurement depends on besides the code: machine, compiler, commit, load."""
import os
import pathlib
import re
import subprocess


def output_of(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def load():
    return [round(value, 2) for value in os.getloadavg()]


def describe(build):
    cpu = re.search(r"^model name\s*:\s*(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M)
    memory = re.search(r"^MemTotal:\s*(\d+)", pathlib.Path("/proc/meminfo").read_text(), re.M)
    cache = (build / "CMakeCache.txt").read_text()
    compiler = re.search(r"^CMAKE_CXX_COMPILER:[A-Z]*=(.*)$", cache, re.M)
    flags = re.search(r"^CMAKE_CXX_FLAGS_RELEASE:[A-Z]*=(.*)$", cache, re.M)
    system = re.search(r'^PRETTY_NAME="(.*)"', pathlib.Path("/etc/os-release").read_text(), re.M)
    return {
        "cpu": cpu.group(1) if cpu else "unknown",
        "threads": os.cpu_count(),
        "memory_gib": round(int(memory.group(1)) / 2**20, 1),
        "system": system.group(1) if system else "unknown",
        "compiler": output_of(compiler.group(1), "--version").splitlines()[0] if compiler else "unknown",
        "flags": flags.group(1) if flags else "unknown",
        "commit": output_of("git", "rev-parse", "--short=12", "HEAD"),
        "changed_files": len(output_of("git", "status", "--porcelain", "--untracked-files=no").splitlines()),
    }

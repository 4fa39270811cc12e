"""Flat CSV files of the JSON reports: one row a measurement, one column a figure."""
import csv


def flat(row, prefix=""):
    columns = {}
    for key, value in row.items():
        if isinstance(value, dict):
            columns.update(flat(value, f"{prefix}{key}_"))
        elif not isinstance(value, list):
            columns[prefix + key] = value
    return columns


def nested(parents, key):
    """The rows of the lists under `key`, each with the columns of its parent in front."""
    return [{**flat(parent), **flat(row)} for parent in parents for row in parent[key]]


def write(file, rows):
    columns = list(dict.fromkeys(column for row in rows for column in row))
    with open(file, "w", newline="") as out:
        writer = csv.DictWriter(out, columns)
        writer.writeheader()
        writer.writerows(rows)


def write_all(reports, folder):
    for name in ("cloth", "hard"):
        write(folder / f"{name}.csv", nested(reports[name]["sets"], "settings"))
    write(folder / "verify.csv", nested(reports["verify"]["sheets"], "methods"))
    for name in ("broad", "crumple"):
        write(folder / f"{name}.csv", nested(reports[name]["motions"], "methods"))
    for name in ("time_steps", "meshes", "conservation", "modules", "growth"):
        write(folder / f"sim-{name}.csv", [flat(row) for row in reports["sim"][name]])
    write(folder / "micro.csv", reports["micro"]["workloads"])

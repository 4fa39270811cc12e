"""Writes the page: bench/report/page.md with the tables and the circumstances of the measurements filled in."""
import string

import sentences


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def number(value):
    return "0" if value == 0 else f"{value:.1e}"


def ratio(value):
    return f"{value:.2f}" if value < 100 else f"{value:,.0f}"


def cloth_table(cloth):
    rows = []
    for of in cloth["sets"]:
        for row in of["settings"]:
            has_toi = row["toi_examined"] > 0
            rows.append([of["name"], row["method"], row["setting"], row["misses"], row["false_alarms"],
                         row["late_toi"] if has_toi else "", number(row["early_median"]) if has_toi else "",
                         number(row["early_p99"]) if has_toi else "", ratio(row["ratio"])])
    return table(["set", "method", "setting", "missed", "false alarms", "late", "early, median", "early, 99 %", "time"], rows)


HARD_SETTINGS = [("textbook", "1e-06 m"), ("additive", "0.9"), ("inclusion", "0.0001 of size"), ("kernel", "0 m"), ("exact", "")]


def hard_table(hard):
    rows = []
    for of in hard["sets"]:
        found = {(row["method"], row["setting"]): row for row in of["settings"]}
        cells = [f"{found[key]['misses']} / {found[key]['false_alarms']} / {ratio(found[key]['ratio'])}" for key in HARD_SETTINGS]
        rows.append([f"{of['name']}: {of['what']}", of["vf"] + of["ee"], of["touching"], *cells])
    names = [f"{method} {setting}".strip() for method, setting in HARD_SETTINGS]
    return table(["class", "queries", "touch", *names], rows)


def micro_table(micro):
    return table(["work", "time a candidate pair", "instructions"],
                 [[row["name"], f"{row['ratio']:.3f}", f"{row['instructions']:,}" if "instructions" in row else ""]
                  for row in micro["workloads"]])


def checker_table(verify):
    rows = []
    for sheet in verify["sheets"]:
        one = {method["name"]: method for method in sheet["methods"] if method["threads"] == 1}
        frame = one["frame"]
        for name, method in one.items():
            exact = f"{100 * method['exact'] / method['examined']:.4f} %" if method["examined"] else ""
            rows.append([f"{sheet['faces']:,}", "planted" if sheet["planted"] else "clean", name,
                         ratio(method["check_ns"]["cpu"] / frame["check_ns"]["cpu"]), method["found"],
                         method["missing"] + method["extra"], exact, f"{method['peak_bytes'] / 2**20:.1f}"])
    return table(["triangles", "sheet", "check", "time", "found", "differ", "exact", "MiB"], rows)


def accuracy_table(sim):
    rows = []
    for study, name in (("time_steps", "step"), ("meshes", "mesh and step")):
        for row in sim[study]:
            rows.append([name, row["solver"], row["nodes"], row["substeps"], number(row["distance"]),
                         number(row["energy_drift"]), ratio(row["ratio"])])
    return table(["refined", "solver", "nodes a side", "steps a frame", "distance", "energy drift", "time"], rows)


def conservation_table(sim):
    rows = [[row["solver"], row["scene"], row["contacts"], number(row["momentum_drift"]), number(row["angular_momentum_drift"]),
             number(row["energy_gain"]), f"{max(0, 100 * (row['strain'] - 0.1)):.2f} %", row["fail_safe_vertices"]]
            for row in sim["conservation"]]
    return table(["solver", "scene", "contacts", "momentum", "angular momentum", "energy gained", "strain over 10 %",
                  "fail-safe"], rows)


def circumstances(machine):
    start, end = machine["load_before"], machine["load_after"]
    return (f"Measured on {machine['cpu']}, {machine['threads']} threads, {machine['memory_gib']} GiB, {machine['system']}; "
            f"{machine['compiler']}, `{machine['flags']}`; commit `{machine['commit']}`"
            + (f" with {machine['changed_files']} changed files" if machine["changed_files"] else "")
            + f"; load {start[0]} at the start and {end[0]} at the end of {machine['minutes']:.0f} minutes.")


def take_home(cloth, hard, verify, sim):
    """What a reader takes home, in at most ten lines: from the measurements, so that it is of the same run as all below."""
    frames, hard = cloth["sets"][0], hard["sets"]

    def hard_sum(method, name, key):
        return f"{sum(sentences.settings(of, method, name)[0][key] for of in hard):,}"

    kernel, batches = (sentences.settings(frames, name, "0 m")[0] for name in ("kernel", "kernel in batches"))
    hard_ratios = [sentences.settings(of, "kernel", "0 m")[0]["ratio"] for of in hard]
    sheet = max((sheet for sheet in verify["sheets"] if not sheet["planted"]), key=lambda sheet: sheet["faces"])
    one = {method["name"]: method for method in sheet["methods"] if method["threads"] == 1}
    explicit = min((row for row in sim["time_steps"] if row["solver"] == "explicit"), key=lambda row: row["substeps"])
    implicit = sorted((row for row in sim["time_steps"] if row["solver"] == "implicit"), key=lambda row: row["substeps"])
    lines = [
        f"- On {frames['vf'] + frames['ee']:,} candidate pairs ({frames['name']}), {frames['touching']} of which touch, the kernel misses"
        f" {kernel['misses']}, raises {kernel['false_alarms']} false alarms and is late {kernel['late_toi']}",
        f"  times. In batches it takes {ratio(batches['ratio'])} of the time of the textbook method, one by one {ratio(kernel['ratio'])}.",
        f"- On {sum(of['vf'] + of['ee'] for of in hard):,} hard queries, {sum(of['touching'] for of in hard):,} of which touch, the textbook"
        f" method misses {hard_sum('textbook', '1e-06 m', 'misses')}, the kernel {hard_sum('kernel', '0 m', 'misses')}; false alarms",
        f"  are {hard_sum('textbook', '1e-06 m', 'false_alarms')} and {hard_sum('kernel', '0 m', 'false_alarms')}. By class the kernel"
        f" takes {ratio(min(hard_ratios))} to {ratio(max(hard_ratios))} times as long as the textbook method there.",
    ]
    if "cgal" in one:
        longer = ratio(one["cgal"]["check_ns"]["cpu"] / one["frame"]["check_ns"]["cpu"])
        lines.append(f"- On a clean frame of {sheet['faces']:,} faces CGAL takes {longer} times as long as the exact checker.")
    for row in implicit:
        if row["substeps"] == explicit["substeps"]:
            lines += [
                f"- With {explicit['substeps']} steps a frame the explicit solver is {number(explicit['distance'])} of the sheet's side from a refined"
                f" run, the implicit one {number(row['distance'])} at {ratio(row['ratio'] / explicit['ratio'])}",
                f"  times the time; with {implicit[0]['substeps']} a frame the implicit one is {number(implicit[0]['distance'])} from it, at"
                f" {ratio(implicit[0]['ratio'] / explicit['ratio'])} times the time."]
    return "\n".join(lines)


def write(template, reports, machine, results, page):
    text = string.Template(template.read_text()).substitute(
        machine=circumstances(machine), results=results, **sentences.quoted(reports),
        take_home=take_home(reports["cloth"], reports["hard"], reports["verify"], reports["sim"]),
        cloth_table=cloth_table(reports["cloth"]), hard_table=hard_table(reports["hard"]),
        checker_table=checker_table(reports["verify"]), accuracy_table=accuracy_table(reports["sim"]),
        conservation_table=conservation_table(reports["sim"]), micro_table=micro_table(reports["micro"]))
    page.write_text(text)

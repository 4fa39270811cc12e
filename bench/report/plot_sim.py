"""The simulator: convergence, time against error, growth and phases, and the cost of modules."""
import style
from style import SERIES, plt


def by_solver(rows):
    solvers = list(dict.fromkeys(row["solver"] for row in rows))
    return [(solver, colour, [row for row in rows if row["solver"] == solver]) for solver, colour in zip(solvers, SERIES)]


def plot_accuracy(report, folder):
    figure, axes = plt.subplots(2, 2, figsize=(10.5, 7.2))
    (steps, mesh), (cost, energy) = axes
    baseline = "explicit, 64 steps a frame"
    for solver, colour, rows in by_solver(report["time_steps"]):
        sizes = [1000 / 30 / row["substeps"] for row in rows]
        steps.plot(sizes, [row["distance"] for row in rows], "o-", color=colour, label=solver)
        cost.plot([row["ratio"] for row in rows], [row["distance"] for row in rows], "o-", color=colour, label=solver)
        energy.plot([row["ratio"] for row in rows], [row["energy_drift"] for row in rows], "o-", color=colour, label=solver)
    finest = min(report["time_steps"], key=lambda row: row["distance"])
    size = 1000 / 30 / finest["substeps"]
    steps.plot([size, 4 * size], [finest["distance"] * 1.6, 16 * finest["distance"] * 1.6], ":", color="#888888",
               label="second order")
    for solver, colour, rows in by_solver(report["meshes"]):
        mesh.plot([500 / (row["nodes"] - 1) for row in rows], [row["distance"] for row in rows], "o-", color=colour,
                  label=solver)
    steps.set_xlabel("step of the dynamics, ms")
    mesh.set_xlabel("edge of the mesh, mm (the step shrinks with it)")
    for axis in (steps, mesh):
        axis.set_ylabel("distance to the refined run, share of the side")
    cost.set_xlabel(f"processor time a frame, multiple of {baseline}")
    cost.set_ylabel("distance to the refined run, share of the side")
    energy.set_xlabel(f"processor time a frame, multiple of {baseline}")
    energy.set_ylabel("energy drift, share of the largest kinetic energy")
    for axis in axes.flat:
        style.log(axis, "xy")
        axis.legend(fontsize=8)
    style.save(figure, folder, "sim-accuracy",
               "Left and low is best. See how fast the error falls with the step (top left) and with the mesh (top right), and "
               "what it costs (below).\nThe error of the mesh is far above that of the step: where explicit steps are stable they are "
               "accurate enough, and cheaper on this soft cloth; implicit ones can be sixty times as long.")


def plot_growth(report, folder):
    figure, (times, gain, shares) = plt.subplots(1, 3, figsize=(12, 3.8))
    for solver, colour, rows in by_solver(report["growth"]):
        one = [row for row in rows if row["threads"] == 1]
        first = one[0]["ms_a_step"] / one[0]["vertices"]
        times.plot([row["nodes"] for row in one], [row["ms_a_step"] / row["vertices"] / first for row in one], "o-",
                   color=colour, label=solver)
        pairs = [(row, other) for row in one for other in rows if other["nodes"] == row["nodes"] and other["threads"] == 2]
        gain.plot([row["nodes"] for row, _ in pairs],
                  [row["wall_ms_a_step"] / other["wall_ms_a_step"] for row, other in pairs], "o-", color=colour,
                  label=f"{solver}, wall time")
        gain.plot([row["nodes"] for row, _ in pairs], [row["ms_a_step"] / other["ms_a_step"] for row, other in pairs], "s:",
                  color=colour, label=f"{solver}, processor time")
    solver, _, rows = by_solver(report["growth"])[0]
    rows = [row for row in rows if row["threads"] == 1]
    bottom = [0.0] * len(rows)
    for colour, phase in zip(SERIES, rows[0]["wall_s"]):
        part = [row["wall_s"][phase] / sum(row["wall_s"].values()) for row in rows]
        shares.bar([str(row["nodes"]) for row in rows], part, bottom=bottom, color=colour, label=phase, width=0.6)
        bottom = [a + b for a, b in zip(bottom, part)]
    nodes = [row["nodes"] for row in report["growth"]]
    style.log(times, "x", nodes)
    style.log(times, "y")
    times.set_xlabel("nodes along a side")
    times.set_ylabel("time a step and vertex, multiple of the smallest's")
    times.legend(fontsize=8)
    style.log(gain, "x", nodes)
    gain.set_xlabel("nodes along a side")
    gain.set_ylabel("one thread's time over that of two")
    gain.set_ylim(0, 1.1 * gain.get_ylim()[1])
    gain.axhline(1, color="#bbbbbb", linewidth=0.8)
    gain.legend(fontsize=7)
    shares.set_xlabel(f"nodes along a side ({solver}, one thread)")
    shares.set_ylabel("share of the step")
    shares.legend(fontsize=8, loc="lower left", framealpha=0.9, frameon=True)
    style.save(figure, folder, "sim-growth",
               "See on the left that the time a vertex grows with the nodes along a side, because an explicit step must shrink with "
               "the edge,\nand that an implicit one need not; in the middle what a second thread brings (processor time at 1: it costs nothing; wall time depends on "
               "what else the machine did); on the right which phase takes the time.")


def plot_modules(report, folder):
    rows = report["modules"]
    figure, axis = plt.subplots(figsize=(9, 0.42 * len(rows) + 1.2))
    ratios = [row["ratio"] for row in rows]
    before = [0.0] + ratios[:-1]
    for i, (ratio, earlier) in enumerate(zip(ratios, before)):
        axis.barh(i, ratio, color="#d8e6f0")
        axis.barh(i, ratio - earlier, left=earlier, color=SERIES[0] if ratio >= earlier else SERIES[2])
        axis.annotate(f"{ratio:.2f}  ({rows[i]['steps']} steps)", (max(ratio, earlier), i), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=8)
    axis.set_yticks(range(len(rows)), [("" if i == 0 else "+ ") + row["added"] for i, row in enumerate(rows)])
    axis.invert_yaxis()
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("processor time a frame, multiple of the first row's")
    style.save(figure, folder, "sim-modules",
               "Dark is what the module of this row adds. See that asking for nothing more costs nothing (the second row is the "
               "first one again),\nand that each module is paid only from the row on where it is asked for.")


def plot(report, folder):
    plot_accuracy(report, folder)
    plot_growth(report, folder)
    plot_modules(report, folder)

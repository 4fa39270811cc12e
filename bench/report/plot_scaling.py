"""The exact checker and the broad phase against the size of the mesh, beside CGAL and Embree."""
import style
from style import SERIES, plt


def plot_checker(report, folder):
    sheets = [sheet for sheet in report["sheets"] if not sheet["planted"]]
    names = {"frame": "frame check", "motion": "motion check", "cgal": "CGAL self_intersections"}
    figure, (speed, memory, exact) = plt.subplots(1, 3, figsize=(12, 3.6))
    for colour, (name, label) in zip(SERIES, names.items()):
        rows = [(sheet["faces"], method) for sheet in sheets for method in sheet["methods"]
                if method["name"] == name and method["threads"] == 1]
        if not rows:
            continue
        faces = [count for count, _ in rows]
        speed.plot(faces, [count / (method["check_ns"]["cpu"] * 1e-9) for count, method in rows], "o-", color=colour,
                   label=label)
        memory.plot(faces, [method["peak_bytes"] / count for count, method in rows], "o-", color=colour, label=label)
    planted = [sheet for sheet in report["sheets"] if sheet["planted"]]
    for colour, name in zip(SERIES, ("frame", "motion")):
        rows = [(sheet["faces"], method) for sheet in planted for method in sheet["methods"]
                if method["name"] == name and method["threads"] == 1]
        shares = [method["exact"] / max(1, method["examined"]) for _, method in rows]
        exact.plot([count for count, _ in rows], style.positive_or_floor(shares, 1e-9), "o-", color=colour,
                   label=f"{names[name]}, with 20 planted pokes")
    for axis, label in ((speed, "triangles a second of processor time"), (memory, "peak memory, bytes a triangle"),
                        (exact, "share of decisions by exact arithmetic")):
        style.log(axis, "x", [sheet["faces"] for sheet in sheets])
        axis.set_xlabel("triangles of the layered sheet")
        axis.set_ylabel(label)
        axis.legend(fontsize=8)
    style.log(speed, "y")
    style.log(exact, "y")
    memory.set_ylim(0, 1.1 * memory.get_ylim()[1])
    style.save(figure, folder, "checker",
               "High is best on the left, low in the middle. See that a frame's exact verdict comes several times faster than "
               "CGAL's at every size, in about the same memory,\nand that exact arithmetic decides a share so small "
               "that it costs nothing, even where intersections were planted (on clean sheets none).")


def plot_broad(growth, crumple, folder):
    figure, (pairs, times, crumpled) = plt.subplots(1, 3, figsize=(12, 3.6))
    names = {"automatic": "Selvage", "cgal": "CGAL box_intersection_d", "embree": "Embree rtcCollide"}
    motions = growth["motions"]
    faces = [motion["faces"] for motion in motions]
    pairs.plot(faces, [(motion["vf"] + motion["ee"]) / motion["faces"] for motion in motions], "o-", color=SERIES[0])
    pairs.set_ylabel("candidate pairs a triangle")
    pairs.set_ylim(0, 1.1 * pairs.get_ylim()[1])

    def query(motion, name):
        rows = [method for method in motion["methods"] if method["name"] == name and method["threads"] == 1]
        return rows[0]["query_ns"]["cpu"] + rows[0]["refit_ns"]["cpu"] if rows else None

    for colour, (name, label) in zip(SERIES, names.items()):
        known = [(motion["faces"], query(motion, name) / query(motion, "automatic")) for motion in motions
                 if query(motion, name)]
        if known:
            times.plot(*zip(*known), "o-", color=colour, label=label)
    times.set_ylabel("refit and query, as a multiple of Selvage's")
    style.log(times, "y")
    times.legend(fontsize=8)
    for axis in (pairs, times):
        style.log(axis, "x", faces)
        axis.set_xlabel("triangles of the pleated sheet")
    largest = max(motion["faces"] for motion in crumple["motions"])
    motions = [motion for motion in crumple["motions"] if motion["faces"] == largest]
    layers = [1 / float(motion["motion"].split()[-1]) for motion in motions]
    flattest = motions[layers.index(min(layers))]
    count = lambda motion: motion["vf"] + motion["ee"]
    crumpled.plot(layers, [count(motion) / count(flattest) for motion in motions], "o-", color=SERIES[0], label="pairs")
    crumpled.plot(layers, [query(motion, "automatic") / query(flattest, "automatic") for motion in motions], "s-",
                  color=SERIES[1], label="refit and query")
    style.log(crumpled, "x", layers)
    style.log(crumpled, "y")
    crumpled.set_xlabel(f"layers over each other ({largest} triangles)")
    crumpled.set_ylabel("multiple of the flattest sheet's")
    crumpled.legend(fontsize=8)
    style.save(figure, folder, "broad",
               "Low is best. See that pairs a triangle hardly depend on the size, that the libraries stay nine times and more "
               "behind at every size,\nand that time grows more slowly than the number of pairs as the sheet is crumpled: a pair "
               "costs less where there are many.")

"""Speed against error of collision queries: misses, false alarms and the error of the time of impact, against time."""
from matplotlib.lines import Line2D

import style
from style import METHODS, plt

# (name of the file, axis, value of a row, what stands for zero)
MEASURES = [
    ("misses", "missed,\nshare of the touching pairs", lambda row, of: row["misses"] / max(1, of["touching"]), 1e-5),
    ("alarms", "false alarms,\nshare of the pairs that do not touch",
     lambda row, of: row["false_alarms"] / max(1, of["vf"] + of["ee"] - of["touching"]), 1e-6),
    ("toi", "time of impact off by\n(99th percentile), share of the step", lambda row, of: row["off_p99"], 1e-17),
]


def draw(axis, of_set, measure):
    _, label, value, floor = measure
    for method, (colour, marker) in METHODS.items():
        rows = [row for row in of_set["settings"] if row["method"] == method]
        if measure[0] == "toi":
            rows = [row for row in rows if row["toi_examined"] > 0]
        if not rows:
            continue
        ratios = [row["ratio"] for row in rows]
        errors = style.positive_or_floor([value(row, of_set) for row in rows], floor)
        axis.plot(ratios, errors, color=colour, linewidth=0.8, alpha=0.6)
        axis.scatter(ratios, errors, color=colour, marker=marker, s=70 if marker == "*" else 26, zorder=3)
        if method in ("additive", "inclusion", "textbook"):  # which end of the line is which
            ends = [(rows[0], ratios[0], errors[0]), (rows[-1], ratios[-1], errors[-1])]
            if max(errors[0], errors[-1]) < 3 * min(errors[0], errors[-1]):
                ends = []  # one place, or none: they would cover each other
            for row, ratio, error in ends:
                axis.annotate(row["setting"].replace(" of size", ""), (ratio, error), xytext=(3, 4),
                              textcoords="offset points", fontsize=6, color=colour)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_ylim(floor / 3, 3)
    style.mark_floor(axis, floor)
    axis.axvline(1, color="#bbbbbb", linewidth=0.8)


def legend(figure, with_batches, columns):
    names = [name for name in METHODS if with_batches or name != "kernel in batches"]
    handles = [Line2D([], [], color=METHODS[name][0], marker=METHODS[name][1], linewidth=0.8) for name in names]
    figure.legend(handles, names, loc="upper center", ncol=columns, bbox_to_anchor=(0.5, 1.05), fontsize=9)


def plot(report, folder):
    cloth = [of for of in report["sets"] if len(of["name"]) > 1]
    hard = [of for of in report["sets"] if len(of["name"]) == 1]
    time_label = "time a query, as a multiple of the textbook method's (1e-6 m)"
    if cloth:
        figure, axes = plt.subplots(len(cloth), 3, figsize=(12, 3.6 * len(cloth)), squeeze=False)
        for row, of_set in zip(axes, cloth):
            for axis, measure in zip(row, MEASURES):
                draw(axis, of_set, measure)
                axis.set_ylabel(measure[1], fontsize=8)
                axis.set_xlabel(time_label, fontsize=8)
            row[0].set_title(f"{of_set['name']}: {of_set['what']}, {of_set['touching']} touch", loc="left", fontsize=9)
        legend(figure, True, 6)
        style.save(figure, folder, "methods-cloth",
                   "Left and low is best. See that the kernel in batches takes a sixth of the textbook's time, and one by one up to twice, "
                   "with no miss, no false alarm at tolerance 0,\nand a time of impact right to 1e-13; that additive CCD pays with "
                   "false alarms and early times, and inclusion-based CCD with time.")
    if not hard:
        return
    sentences = {
        "misses": "Low is best. See that kernel, inclusion-based CCD and the exact decision miss nothing in any class, and "
                  "that the textbook method loses up to half of the contacts\nwhatever its tolerance: it is the rounding "
                  "that is not bounded, not the tolerance that is too small.",
        "alarms": "Left and low is best. See that tolerance alone does not make a method exact: the finest inclusion-based "
                  "setting still alarms where coordinates are large beside the query,\nand additive CCD where features are "
                  "near each other. The kernel's alarms (tolerance 0) come within a proved gap.",
        "toi": "Left and low is best. See that the textbook method's time is good where it finds the first touch, and anything where it "
               "takes a later one for it;\nthat the kernel's, never late, is right to 1e-9 of the step or better in all classes but F, "
               "where motions are huge beside the features; and that the others trade it against time.",
    }
    for measure in MEASURES:
        figure, axes = plt.subplots(2, 5, figsize=(15, 6.4), sharex=True, sharey=True)
        for axis, of_set in zip(axes.flat, hard):
            draw(axis, of_set, measure)
            axis.set_title(f"{of_set['name']}: {of_set['what']} ({of_set['touching']} of {of_set['vf'] + of_set['ee']} touch)",
                           loc="left", fontsize=8)
        for axis in axes[:, 0]:
            axis.set_ylabel(measure[1], fontsize=8)
        figure.supxlabel(time_label, fontsize=9)
        legend(figure, False, 6)
        style.save(figure, folder, f"methods-hard-{measure[0]}", sentences[measure[0]])

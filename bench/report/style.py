"""What all plots share: one colour and marker a method, one way to draw zero on a logarithmic axis, one way to save."""
import math

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

plt.rcParams.update({
    "svg.hashsalt": "selvage",  # the same figures make the same file
    "svg.fonttype": "none",  # text, not outlines of its letters: a quarter of the size
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "axes.axisbelow": True,
    "legend.frameon": False,
})

# Colours that differ for colour-blind readers too (Okabe and Ito), and a marker of its own for each.
METHODS = {
    "kernel in batches": ("#0072B2", "*"),
    "kernel": ("#56B4E9", "o"),
    "textbook": ("#D55E00", "s"),
    "additive": ("#E69F00", "^"),
    "inclusion": ("#009E73", "D"),
    "exact": ("#000000", "P"),
}
SERIES = ["#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#000000"]


def positive_or_floor(values, floor):
    return [max(value, floor) for value in values]


def mark_floor(axis, floor, label="none"):
    """The lowest tick of a logarithmic axis up to 1 stands for zero, which such an axis does not have."""
    lowest = round(math.log10(floor)) + 1
    step = 1 if lowest > -8 else 3
    axis.set_yticks([10.0**k for k in range(0, lowest - 1, -step)])
    axis.minorticks_off()
    axis.axhline(floor, color="#bbbbbb", linewidth=0.8, linestyle=":")
    axis.annotate(label, (0, floor), xycoords=("axes fraction", "data"), xytext=(-4, 0), textcoords="offset points",
                  ha="right", va="center", fontsize=8, color="#666666")


def log(axis, which, values=None):
    """A logarithmic axis with plain numbers: at 1, 2 and 5 of each decade, or at `values`."""
    for direction in which:
        of = axis.xaxis if direction == "x" else axis.yaxis
        (axis.set_xscale if direction == "x" else axis.set_yscale)("log")
        low, high = axis.get_xlim() if direction == "x" else axis.get_ylim()
        subs = (1, 2, 5) if high < 300 * low else (1,)
        of.set_major_locator(FixedLocator(sorted(set(values))) if values else LogLocator(subs=subs))
        of.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}" if value >= 10000 else f"{value:g}"))
        of.set_minor_locator(NullLocator())


def save(figure, folder, name, sentence):
    """`sentence` says what to see; it stands under the plot."""
    figure.tight_layout()
    figure.text(0.01, -0.02, sentence, fontsize=8.5, color="#333333", va="top", wrap=False)
    figure.savefig(folder / f"{name}.svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)

#!/usr/bin/python3
"""What an adaptive mesh could save on a recorded sheet: the cells of the coarsest quadtree that still has its shape.

    bench/report/adaptivity.py FOLDER --nodes 150 [--frames 20,60,100] [--tolerance_m 0.0003,0.001,0.003]

A block of cells may be one where none of its nodes is farther than the tolerance from the bilinear patch through its four
corners. This is a lower bound: a conforming mesh needs cells of sizes in between as well. Prints the share of the sheet's
cells, a row a frame; the sheet is the sequence's first cloth.
"""
import argparse
import pathlib
import struct


def read_nodes(file, count):
    """The first `count` rows of an NPY file of doubles."""
    data = file.read_bytes()
    start = 10 + struct.unpack_from("<H", data, 8)[0]
    flat = struct.unpack_from(f"<{3 * count}d", data, start)
    return [flat[3 * i:3 * i + 3] for i in range(count)]


def is_flat(x, n, i0, i1, j0, j1, tolerance):
    corners = x[j0 * n + i0], x[j0 * n + i1], x[j1 * n + i0], x[j1 * n + i1]
    for j in range(j0, j1 + 1):
        t = (j - j0) / (j1 - j0)
        for i in range(i0, i1 + 1):
            s = (i - i0) / (i1 - i0)
            weights = (1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t
            square = sum((x[j * n + i][k] - sum(w * c[k] for w, c in zip(weights, corners))) ** 2 for k in range(3))
            if square > tolerance ** 2:
                return False
    return True


def halves(begin, end):
    middle = (begin + end) // 2
    return [(begin, end)] if end - begin == 1 else [(begin, middle), (middle, end)]


def cells(x, n, i, j, tolerance):
    if (i[1] - i[0] == 1 and j[1] - j[0] == 1) or is_flat(x, n, *i, *j, tolerance):
        return 1
    return sum(cells(x, n, part_i, part_j, tolerance) for part_i in halves(*i) for part_j in halves(*j))


def main():
    numbers = lambda kind: lambda text: [kind(word) for word in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--nodes", type=int, required=True, help="along a side of the sheet")
    parser.add_argument("--frames", type=numbers(int), default=[0])
    parser.add_argument("--tolerance_m", type=numbers(float), default=[0.0003, 0.001, 0.003])
    options = parser.parse_args()
    n, side = options.nodes, (0, options.nodes - 1)
    print("frame", *options.tolerance_m, sep="\t")
    for frame in options.frames:
        x = read_nodes(options.folder / f"frame_{frame:06d}.npy", n * n)
        shares = [cells(x, n, side, side, tolerance) / (n - 1) ** 2 for tolerance in options.tolerance_m]
        print(frame, *(f"{share:.3f}" for share in shares), sep="\t")


if __name__ == "__main__":
    main()

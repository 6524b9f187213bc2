#!/usr/bin/python3
"""Draws learning curves: F1 and agreement of the rollouts against trajectories and against minutes.

Runs with the same name are drawn as one line, their mean, with a band from their minimum to their maximum.
Example: scripts/plot_curves.py --out curves.svg fast=runs/fast1 fast=runs/fast2 paper=runs/paper
"""
import argparse

from figures import draw_mean, pyplot, read_run, save


def smoothed(values, width):
    """The moving average over `width` values."""
    return [sum(values[max(0, i + 1 - width):i + 1]) / min(i + 1, width) for i in range(len(values))]


def draw(axes, runs, across, scale, column, width):
    shortest = min(len(run[column]) for run in runs)
    lines = [smoothed(run[column], width)[:shortest] for run in runs]
    x = [sum(run[across][i] for run in runs) / len(runs) / scale for i in range(shortest)]
    return draw_mean(axes, x, list(zip(*lines)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="NAME=FOLDER", help="a run folder, which holds curve.csv")
    parser.add_argument("--out", required=True, help="the image: .svg or .png")
    parser.add_argument("--smooth", type=int, default=10, help="number of rounds that are averaged for a point [%(default)s]")
    options = parser.parse_args()
    groups = {}
    for argument in options.runs:
        name, columns = read_run(argument, "curve.csv", "no rounds yet")
        groups.setdefault(name, []).append(columns)

    figure, rows = pyplot.subplots(2, 2, figsize=(10, 6.5), sharey="row", layout="constrained")
    for row, (column, title) in zip(rows, [("f1", "F1 of rollouts"), ("agreement", "agreement of rollouts")]):
        for axes, (across, scale, label) in zip(row, [("trajectories", 1, "trajectories"), ("elapsed_sec", 60, "minutes")]):
            lines = [draw(axes, runs, across, scale, column, max(1, options.smooth)) for runs in groups.values()]
            axes.set_xlabel(label)
            axes.grid(alpha=0.3)
            axes.set_xlim(left=0)
        row[0].set_ylabel(title)
    rows[0][0].legend(lines, groups, frameon=False)
    save(figure, options.out)


if __name__ == "__main__":
    main()

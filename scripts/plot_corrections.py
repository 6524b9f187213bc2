#!/usr/bin/python3
"""Draws F1 against the number of presses of the person, for runs of `early_fusion correct`.

Runs with the same name have one colour. Each run is a thin line with a dot at each score. The left axes are the robot's
world, the right ones the rehearsal's.
Example: scripts/plot_corrections.py --out corrections.svg scans=runs/ycb1 scans=runs/ycb2
"""
import argparse

from figures import pyplot, read_run, save


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="NAME=FOLDER", help="a run folder, which holds scores.csv")
    parser.add_argument("--out", required=True, help="the image: .svg or .png")
    options = parser.parse_args()
    figure, columns = pyplot.subplots(1, 2, figsize=(10, 3.8), sharey=True, layout="constrained")
    colors = {}
    for argument in options.runs:
        name, run = read_run(argument, "scores.csv", "no scores yet")
        for axes, column in zip(columns, ["f1", "rehearsal_f1"]):
            style = {"marker": "o", "markersize": 3, "linewidth": 1.1}
            label = None if name in colors else name
            line, = axes.plot(run["presses"], run[column], label=label, color=colors.get(name), **style)
            colors.setdefault(name, line.get_color())
    for axes, title in zip(columns, ["the robot's world", "the rehearsal's world"]):
        axes.set_title(title)
        axes.set_xlabel("presses")
        axes.grid(alpha=0.3)
        axes.set_xlim(left=0)
        axes.set_ylim(0, 1)
    columns[0].set_ylabel("F1 on held-out episodes")
    columns[0].legend(frameon=False, loc="lower right")
    save(figure, options.out)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Draws the scores of an experiment from its results.csv.

Cells that differ only in their seed are one line, their mean, with a band from their minimum to their maximum.

  scripts/plot_experiment.py results.csv --panel task --out curves.svg       F1 over trajectories, a panel for each task
  scripts/plot_experiment.py results.csv --across task --out bars.svg        the final F1 on each task as bars
  scripts/plot_experiment.py results.csv --across channels --out lines.svg   the final F1 by width
"""
import argparse
import csv
import sys

from figures import draw_mean, pyplot, save

MEASURES = ("trajectories", "minutes", "f1", "precision", "recall", "agreement")
LABELS = {"f1": "F1", "channels": "channels C"}


def fail(text):
    sys.exit(f"plot_experiment.py: {text}")


def read_rows(options):
    """The rows of the chosen evaluation and cells, and the grid's columns."""
    try:
        with open(options.results, newline="") as file:
            reader = csv.DictReader(file)
            rows, header = list(reader), list(reader.fieldnames or [])
    except OSError as error:
        fail(f"{options.results}: {error.strerror}")
    if "evaluation" not in header:
        fail(f"{options.results}: no results of an experiment: its first line has no column 'evaluation'")
    grid = header[1:header.index("evaluation")]
    chosen = [condition.partition("=")[::2] for condition in options.where] + [("evaluation", options.evaluation)]
    for column, value in chosen:
        if column not in header:
            fail(f"--where: '{column}' is none of the columns {', '.join(header)}")
        rows = [row for row in rows if row[column] == value]
        if not rows:
            fail(f"{options.results}: no row is left with {column} = '{value}'")
    rows = [row for row in rows if row[options.measure]]
    return rows, grid


def check_columns(options, rows, grid):
    """Seeds are averaged. Every other column that varies must be in the figure."""
    shown = {options.line, options.panel, options.across, "seed"}
    for column in filter(None, (options.line, options.panel)):
        if column not in grid:
            fail(f"'{column}' is none of the grid's columns {', '.join(grid)}")
    for column in grid:
        values = sorted({row[column] for row in rows})
        if column not in shown and len(values) > 1:
            fail(f"the cells also differ in {column} ({', '.join(values)}); choose it as --line, --panel or --across, "
                 f"or one value with --where {column}={values[0]}")


def distinct(rows, column):
    """The values of a column in the order of the file; [None] if there is no column."""
    return list(dict.fromkeys(row[column] for row in rows)) if column else [None]


def select(rows, column, value):
    """The rows with this value; all if there is no column."""
    return [row for row in rows if column is None or row[column] == value]


def final_rows(rows):
    return list({row["cell"]: row for row in rows}.values())


def draw_curves(axes, rows, options):
    """The measure over trajectories or minutes."""
    for name in distinct(rows, options.line):
        groups = {}
        for row in select(rows, options.line, name):
            groups.setdefault(float(row["trajectories"]), []).append(row)
        groups = [groups[key] for key in sorted(groups)]
        x = [sum(float(row[options.across]) for row in group) / len(group) for group in groups]
        draw_mean(axes, x, [[float(row[options.measure]) for row in group] for group in groups], marker="o",
                  markersize=3, color=options.colors[name], label=name)
    axes.set_xlim(left=0)


def values_at(rows, options, name, place):
    chosen = select(select(rows, options.line, name), options.across, place)
    return [float(row[options.measure]) for row in chosen]


def draw_lines(axes, rows, options, places):
    """The final measure over a number, at equal distances."""
    places.sort(key=float)
    for name in distinct(rows, options.line):
        points = {place: values_at(rows, options, name, place) for place in places}
        points = {place: values for place, values in points.items() if values}
        line = draw_mean(axes, [places.index(place) for place in points], list(points.values()), marker="o",
                         color=options.colors[name], label=name)
        if name != options.half:
            continue
        doubled = {place: values for half, values in points.items() for place in places
                   if float(place) == 2 * float(half)}
        draw_mean(axes, [places.index(place) for place in doubled], list(doubled.values()), marker="o", linestyle="--",
                  color=line.get_color(), label=f"{name} at half of it")
    axes.set_xticks(range(len(places)), places)


def draw_bars(axes, rows, options, places):
    """The final measure as groups of bars, with a whisker from the minimum to the maximum."""
    names = distinct(rows, options.line)
    width = 0.8 / len(names)
    for i, name in enumerate(names):
        at = [(x, values) for x, place in enumerate(places) if (values := values_at(rows, options, name, place))]
        x = [place + (i - (len(names) - 1) / 2) * width for place, _ in at]
        means = [sum(values) / len(values) for _, values in at]
        spread = [[mean - min(values) for mean, (_, values) in zip(means, at)],
                  [max(values) - mean for mean, (_, values) in zip(means, at)]]
        axes.bar(x, means, width, yerr=spread, error_kw={"linewidth": 1}, color=options.colors[name],
                 label=name)
    axes.set_xticks(range(len(places)), places)


def is_number(text):
    try:
        return bool(float(text) + 1)
    except ValueError:
        return False


def draw(axes, rows, options):
    if options.across in ("trajectories", "minutes"):
        return draw_curves(axes, rows, options)
    rows = final_rows(rows)
    places = distinct(rows, options.across)
    (draw_lines if all(map(is_number, places)) else draw_bars)(axes, rows, options, places)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="the results.csv of an experiment")
    parser.add_argument("--out", required=True, help="the image: .svg or .png")
    parser.add_argument("--across", default="trajectories",
                        help="the horizontal axis: trajectories, minutes, or a column of the grid [%(default)s]")
    parser.add_argument("--line", default="kind", help="the column with a line or a colour for each value [%(default)s]")
    parser.add_argument("--panel", help="the column with a panel for each value")
    parser.add_argument("--measure", default="f1", choices=MEASURES, help="the vertical axis [%(default)s]")
    parser.add_argument("--evaluation", default="task", help="which of the cells' evaluations [%(default)s]")
    parser.add_argument("--where", action="append", default=[], metavar="COLUMN=VALUE",
                        help="only cells with this value; can be given several times")
    parser.add_argument("--half", metavar="VALUE",
                        help="also draw the line with this value at twice its place, to compare it at half the width")
    options = parser.parse_args()
    rows, grid = read_rows(options)
    check_columns(options, rows, grid)
    if options.across not in grid + ["trajectories", "minutes"]:
        fail(f"--across: '{options.across}' is none of trajectories, minutes, {', '.join(grid)}")

    options.colors = {name: f"C{i}" for i, name in enumerate(distinct(rows, options.line))}  # the same in all panels
    panels = distinct(rows, options.panel)
    figure, axes = pyplot.subplots(1, len(panels), figsize=(1.5 + 4 * len(panels), 3.6), sharey=True, squeeze=False,
                                   layout="constrained")
    for name, panel in zip(panels, axes[0]):
        draw(panel, select(rows, options.panel, name), options)
        panel.set_xlabel(LABELS.get(options.across, options.across))
        panel.grid(alpha=0.3)
        panel.set_title(name and f"{options.panel} {name}", fontsize="medium")
    axes[0][0].set_ylim(bottom=0)
    axes[0][0].set_ylabel(LABELS.get(options.measure, options.measure))
    lines = {}  # by name: a panel may lack some
    for panel in axes[0]:
        for handle, name in zip(*panel.get_legend_handles_labels()):
            lines.setdefault(name, handle)
    axes[0][-1].legend(lines.values(), lines.keys(), frameon=False)
    save(figure, options.out)


if __name__ == "__main__":
    main()

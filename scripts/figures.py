"""What the scripts that draw curves share."""
import csv
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(f"{os.path.basename(sys.argv[0])} needs matplotlib: sudo apt install python3-matplotlib")
matplotlib.use("Agg")
matplotlib.rcParams["svg.hashsalt"] = "early_fusion"  # the same bytes every time
from matplotlib import pyplot  # noqa: E402, F401


def read_run(argument, table, nothing):
    """NAME=FOLDER -> (NAME, columns of the folder's CSV file `table`). `nothing`: the error for a table without rows."""
    program = os.path.basename(sys.argv[0])
    name, equals, folder = argument.partition("=")
    path = os.path.join(folder, table)
    if not equals:
        sys.exit(f"{program}: '{argument}' is not NAME=FOLDER")
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        sys.exit(f"{program}: {path}: {error.strerror}")
    if not rows:
        sys.exit(f"{program}: {path}: {nothing}")
    return name, {key: [float(row[key]) for row in rows] for key in rows[0]}


def draw_mean(axes, x, points, **style):
    """Draws the mean of points[i], a list of values, at x[i], with a band from their minimum to their maximum."""
    line, = axes.plot(x, [sum(values) / len(values) for values in points], **{"linewidth": 1.3, **style})
    if any(len(values) > 1 for values in points):
        axes.fill_between(x, list(map(min, points)), list(map(max, points)), alpha=0.2, color=line.get_color(),
                          linewidth=0)
    return line


def save(figure, path):
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)

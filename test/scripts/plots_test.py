#!/usr/bin/python3
"""The figures of plot_curves.py, plot_experiment.py and plot_corrections.py, and their errors.

Usage: plots_test.py SOURCE
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: needs matplotlib (python3-matplotlib)")
    sys.exit(77)

SOURCE = sys.argv[1]
RESULTS = """\
cell,task,kind,seed,channels,evaluation,trajectories,minutes,f1,precision,recall,agreement
a,hard,early_fusion,1,16,task,10,1.0,0.3,0.3,0.3,0.3
a,hard,early_fusion,1,16,task,20,2.0,0.5,0.3,0.3,0.3
b,hard,early_fusion,2,16,task,10,1.0,0.4,0.3,0.3,0.3
b,hard,early_fusion,2,16,task,20,2.2,0.7,0.3,0.3,0.3
c,hard,late_fusion,1,16,task,10,1.0,0.1,0.3,0.3,0.3
d,simple,early_fusion,1,16,task,20,2.0,0.9,0.3,0.3,0.3
d,simple,early_fusion,1,16,three_items,20,2.0,0.8,0.3,0.3,0.3
e,simple,early_fusion,1,32,task,20,2.0,0.95,0.3,0.3,0.3
f,simple,late_fusion,1,32,task,20,2.0,0.7,0.3,0.3,0.3
"""
CURVE = """\
round,trajectories,loss,learning_rate,f1,agreement,elapsed_sec
1,100,1.1,1.5e-03,0.1,0.2,60
2,200,1.0,1.5e-03,0.3,0.4,120
"""


class Plots(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.results = self.write("results.csv", RESULTS)
        self.figure = os.path.join(self.folder.name, "figure.svg")

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def plot(self, script, *options):
        return subprocess.run([sys.executable, os.path.join(SOURCE, "scripts", script), *options, "--out", self.figure],
                              capture_output=True, text=True)

    def texts(self, script, *options):
        """What stands in the figure: matplotlib leaves each text of an SVG file as a comment."""
        done = self.plot(script, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.figure, encoding="utf-8") as file:
            return re.findall(r"<!-- (.*?) -->", file.read())

    def refused(self, *options):
        done = self.plot("plot_experiment.py", *options)
        self.assertNotEqual(done.returncode, 0)
        self.assertNotIn("Traceback", done.stderr)
        return done.stderr

    def test_a_panel_for_each_task_with_a_curve_for_each_kind(self):
        texts = self.texts("plot_experiment.py", self.results, "--panel", "task", "--where", "channels=16")
        for text in ("task hard", "task simple", "trajectories", "F1", "early_fusion", "late_fusion"):
            self.assertIn(text, texts)

    def test_a_kind_has_the_same_colour_in_every_panel(self):
        rows = RESULTS.splitlines()
        one_each = self.write("one_each.csv", "\n".join(rows[:3] + [rows[9].replace(",32,", ",16,")]) + "\n")
        self.texts("plot_experiment.py", one_each, "--panel", "task", "--where", "evaluation=task")
        with open(self.figure, encoding="utf-8") as file:
            figure = file.read()
        for colour in ("#1f77b4", "#ff7f0e"):  # of early_fusion, alone in its panel, and of late_fusion, alone in its
            self.assertIn(colour, figure)

    def test_bars_across_words_and_a_line_across_numbers(self):
        texts = self.texts("plot_experiment.py", self.results, "--across", "task", "--where", "channels=16")
        self.assertEqual(texts[:2], ["hard", "simple"])
        texts = self.texts("plot_experiment.py", self.results, "--across", "channels", "--where", "task=simple",
                           "--half", "early_fusion", "--measure", "agreement")
        for text in ("16", "32", "channels C", "agreement", "early_fusion at half of it", "late_fusion"):
            self.assertIn(text, texts)

    def test_the_same_rows_give_the_same_bytes(self):
        figures = []
        for _ in range(2):
            self.texts("plot_experiment.py", self.results, "--across", "task", "--where", "channels=16")
            with open(self.figure, "rb") as file:
                figures.append(file.read())
        self.assertEqual(*figures)

    def test_cells_that_differ_in_more_than_the_figure_shows_are_refused(self):
        self.assertIn("differ in task (hard, simple)", self.refused(self.results))
        self.assertIn("differ in channels (16, 32)", self.refused(self.results, "--panel", "task"))

    def test_mistakes_are_named(self):
        self.assertIn("no row is left with task = 'medium'", self.refused(self.results, "--where", "task=medium"))
        self.assertIn("'width' is none of", self.refused(self.results, "--where", "width=16"))
        self.assertIn("'width' is none of", self.refused(self.results, "--panel", "width"))
        self.assertIn("no row is left with evaluation = 'x'", self.refused(self.results, "--evaluation", "x"))
        self.assertIn("none.csv", self.refused("none.csv"))
        self.assertIn("no results", self.refused(self.write("curve.csv", CURVE)))

    def test_curves_of_runs(self):
        for run in ("one", "two"):
            self.write(run + "/curve.csv", CURVE)
        runs = [f"fast={os.path.join(self.folder.name, run)}" for run in ("one", "two")]
        texts = self.texts("plot_curves.py", *runs)
        for text in ("fast", "minutes", "F1 of rollouts"):
            self.assertIn(text, texts)

    def test_corrections_of_runs(self):
        scores = "episodes,presses,labels,f1,rehearsal_f1\n0,0,0,0.2,0.9\n10,80,90,0.4,0.8\n"
        runs = [f"scans={os.path.dirname(self.write(run + '/scores.csv', scores))}" for run in ("one", "two")]
        texts = self.texts("plot_corrections.py", *runs)
        for text in ("presses", "F1 on held-out episodes", "the robot's world", "the rehearsal's world"):
            self.assertIn(text, texts)
        self.assertEqual(texts.count("scans"), 1)
        done = self.plot("plot_corrections.py", "scans=" + os.path.join(self.folder.name, "none"))
        self.assertIn("none", done.stderr)
        self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/python3
"""analyse_trace.py's causes, on steps made up for it and on a policy's trace. Usage: analyse_trace_test.py SOURCE PROGRAM"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE, PROGRAM = sys.argv[1:3]
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(SOURCE, "scripts"))
import analyse_trace  # noqa: E402


def step(action, request, in_cone=(), costs=(20,), pan=0, exposure=1):
    """A step in a scene of an apple (0) and a peach (1)."""
    return {"episode": 0, "action": action, "request": list(request), "in_cone": list(in_cone), "pan_deg": pan,
            "tilt_deg": 0, "expert_costs": [{"instance": 1, "item": "peach", "steps": cost} for cost in costs],
            "scene": [{"instance": i, "item": item, "exposure": exposure} for i, item in enumerate(("apple", "peach"))]}


def moves(**arguments):
    return [step("PAN_LEFT", ["peach"], pan=2 * i, **arguments) for i in range(10)]


class Faults(unittest.TestCase):
    def test_nothing_is_wrong_where_what_was_requested_is_collected_in_the_last_step(self):
        self.assertEqual(analyse_trace.faults(moves() + [step("COLLECT", ["peach"], [1, 0])]), [])

    def test_a_mistake_is_told_by_where_the_requested_object_was(self):
        end = [step("COLLECT", ["peach"], [1])]
        for wrong, cause in ((step("COLLECT", ["peach"], [0, 1], [2]), "in front of"),
                             (step("COLLECT", ["peach"], [0], [3]), "beside a requested"),
                             (step("COLLECT", ["peach"], [0], [4]), "another object"),
                             (step("COLLECT", [], [0], []), "after the request was finished")):
            causes = analyse_trace.faults([wrong] + end if wrong["request"] else end + [wrong])
            self.assertEqual(len(causes), 1)
            self.assertIn(cause, causes[0])

    def test_what_is_left_is_told_by_the_ending(self):
        for steps, cause in ((moves(costs=[9]), "still moving"),
                             (moves(costs=[11]), "out of reach"),
                             (moves(costs=[9], exposure=0), "only REMOVE"),
                             ([step("COLLECT", ["peach"], costs=[2])] * 10, "repeated COLLECT without effect"),
                             ([step("PAN_LEFT", ["peach"], costs=[2], pan=2 * (i % 2)) for i in range(10)],
                              "back and forth")):
            causes = analyse_trace.faults(steps)
            self.assertEqual(len(causes), 1, causes)
            self.assertIn(cause, causes[0])

    def test_what_was_requested_can_be_removed(self):
        steps = [step("REMOVE", ["peach"], [1], [1]), step("IDLE", [])]
        self.assertEqual(analyse_trace.faults(steps), ["removed a requested object"])


class Trace(unittest.TestCase):
    def test_a_file_that_is_no_trace_is_an_error_that_names_it(self):
        with tempfile.NamedTemporaryFile() as trace:
            for contents, message in ((b"", "holds no steps"), (b"\xff\x00", ":1: not a line"), (b"{}\n", ":1: not a line")):
                trace.truncate(0)
                trace.seek(0)
                trace.write(contents)
                trace.flush()
                with self.assertRaises(SystemExit) as caught:
                    analyse_trace.read_episodes(trace.name)
                self.assertIn(trace.name, str(caught.exception))
                self.assertIn(message, str(caught.exception))

    def test_the_scores_are_the_evaluations_and_the_causes_take_all_that_is_lost(self):
        with tempfile.TemporaryDirectory() as folder:
            trace, scores = os.path.join(folder, "trace.json"), os.path.join(folder, "scores.json")
            subprocess.run([PROGRAM, "evaluate", "--policy", os.path.join(SOURCE, "models/simple.safetensors"), "--task",
                            "medium", "--episodes", "12", "--trace", trace, "--json", scores], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(scores) as file:
                expected = [episode["f1"] for episode in json.load(file)["per_episode"]]
            episodes = analyse_trace.read_episodes(trace)
            self.assertEqual(len(episodes), 12)
            self.assertLess(sum(expected), 12)
            for steps, f1 in zip(episodes, expected):
                self.assertAlmostEqual(analyse_trace.f1_score(steps), f1)
                self.assertEqual(f1 < 1, bool(analyse_trace.faults(steps)))
            tables = subprocess.run([os.path.join(SOURCE, "scripts/analyse_trace.py"), trace], check=True,
                                    stdout=subprocess.PIPE, universal_newlines=True).stdout
            lost = [float(line.split("|")[2]) for line in tables[tables.index("F1 lost"):].splitlines()[2:]]
            self.assertAlmostEqual(sum(lost), 1 - sum(expected) / len(expected), delta=1e-4 * len(lost))

    def test_what_is_no_trace_is_named(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write('{"step": 1}\n')
            file.flush()
            run = subprocess.run([os.path.join(SOURCE, "scripts/analyse_trace.py"), file.name], stderr=subprocess.PIPE,
                                 universal_newlines=True)
            self.assertEqual(run.returncode, 1)
            self.assertIn(f"{file.name}:1:", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

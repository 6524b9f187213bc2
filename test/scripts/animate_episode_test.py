#!/usr/bin/python3
"""animate_episode.py's GIF files and errors. Usage: animate_episode_test.py SOURCE PROGRAM"""
import os
import subprocess
import sys
import tempfile
import unittest

try:
    from PIL import Image
except ImportError:
    print("skipped: needs Pillow (python3-pil)")
    sys.exit(77)

SOURCE, PROGRAM = sys.argv[1:3]


class Animation(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.gif = self.path("episode.gif")

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def animate(self, *options, search_path=os.path.dirname(PROGRAM)):
        environment = {**os.environ, "PATH": search_path, "EARLY_FUSION_SHARE": SOURCE}
        return subprocess.run([sys.executable, os.path.join(SOURCE, "scripts/animate_episode.py"), *options],
                              env=environment, capture_output=True, text=True)

    def durations_ms(self):
        with Image.open(self.gif) as gif:
            durations = []
            for i in range(gif.n_frames):
                gif.seek(i)
                durations.append(gif.info["duration"])
            return durations

    def test_every_step_is_shown_and_the_last_one_longer(self):
        with open(self.path("short.yaml"), "w") as task:
            task.write("{instances: 4, requested: 4, steps: 3}")
        done = self.animate("--out", self.gif, "--steps-per-second", "4", "--last-seconds", "2", "--task",
                            self.path("short.yaml"), "--annotate", "--size", "64")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.durations_ms(), [250, 250, 2000])
        with Image.open(self.gif) as gif:
            self.assertEqual(gif.size, (64, 64))

    def test_a_still_end_is_shown_once(self):
        done = self.animate("--out", self.gif, "--policy", "idle", "--size", "32", "--last-seconds", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.durations_ms(), [2000])

    def test_a_mistake_is_an_error_that_names_it(self):
        out = ("--out", self.gif)
        for options, named in (((), "--out"), ((*out, "--colors", "1"), "'1'"), ((*out, "--colors", "many"), "'many'"),
                               ((*out, "--steps-per-second", "0"), "--steps-per-second: '0'"),
                               ((*out, "--last-seconds", "nan"), "'nan'"), ((*out, "--task", "harder"), "harder"),
                               ((*out, "--step", "48"), "--step: 48"),
                               (("--out", self.path("missing/e.gif"), "--size", "32"), self.path("missing/e.gif"))):
            done = self.animate(*options)
            self.assertNotEqual(done.returncode, 0, options)
            self.assertIn(named, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
        self.assertIn("early_fusion is not on the PATH", self.animate(*out, search_path=self.folder.name).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

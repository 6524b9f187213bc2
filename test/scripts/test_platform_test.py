"""Runs scripts/test_platform.sh with arguments and machines that it refuses. It must not change anything then."""
import os
import subprocess
import sys
import tempfile
import unittest

SCRIPT = os.path.join(sys.argv.pop(1), "scripts", "test_platform.sh")


class TestPlatform(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bin, self.platforms = os.path.join(folder.name, "bin"), os.path.join(folder.name, "platforms")
        os.mkdir(self.bin)

    def add_program(self, name, text):
        path = os.path.join(self.bin, name)
        with open(path, "w") as file:
            file.write("#!/bin/bash\n" + text + "\n")
        os.chmod(path, 0o755)

    def refused(self, *arguments, path=os.environ["PATH"]):
        """The message of a run that ends with status 2 before it makes the folder of the chroots."""
        run = subprocess.run(["/bin/bash", SCRIPT, *arguments], capture_output=True, text=True,
                             env={"PATH": path, "HOME": self.bin, "EARLY_FUSION_PLATFORMS": self.platforms})
        self.assertEqual((run.returncode, run.stdout), (2, ""), run.stderr)
        self.assertFalse(os.path.exists(self.platforms))
        return run.stderr

    def test_help_names_every_platform(self):
        run = subprocess.run(["/bin/bash", SCRIPT, "--help"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0)
        for name in ("debian13", "debian11", "noetic", "arm64", "EARLY_FUSION_PLATFORMS"):
            self.assertIn(name, run.stdout)

    def test_needs_a_platform(self):
        self.assertIn("which platform? debian13, debian11, noetic or arm64", self.refused())

    def test_refuses_unknown_platforms(self):
        self.assertIn("unknown platform 'debian12'; use debian13, debian11, noetic or arm64", self.refused("debian12"))

    def test_needs_root(self):
        self.add_program("id", "echo 1000")
        self.assertIn("needs root", self.refused("debian13", path=self.bin + ":" + os.environ["PATH"]))

    def test_names_a_missing_program(self):
        self.add_program("id", "echo 0")
        self.assertIn("apt-get install debootstrap", self.refused("debian13", path=self.bin))


if __name__ == "__main__":
    unittest.main()

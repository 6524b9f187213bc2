"""Installs the package and builds a small catkin package against it, with the compiler's default flags."""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

ROOT, BUILD = sys.argv.pop(1), sys.argv.pop(1)
WEIGHTS = os.path.join(ROOT, "models", "medium_c16.safetensors")


def run(*command, **options):
    """What a command prints. Its whole output if it fails."""
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if result.returncode != 0:
        raise AssertionError(f"{command} ended with {result.returncode}:\n{result.stdout}")
    return result.stdout


class InstalledPackage(unittest.TestCase):
    def test_a_package_with_default_flags_uses_the_libraries(self):
        with tempfile.TemporaryDirectory() as folder:
            install, build = os.path.join(folder, "install"), os.path.join(folder, "build")
            # Configured for another prefix, so catkin's own files are written again for this one.
            run("cmake", "--install", BUILD, "--prefix", install)
            environment = {name: value for name, value in os.environ.items() if name not in ("CXXFLAGS", "CFLAGS")}
            path = environment.get("CMAKE_PREFIX_PATH", "")
            own = os.path.realpath(os.path.join(BUILD, "..", "devel"))
            others = [entry for entry in path.split(":") if entry and os.path.realpath(entry) != own]
            environment["CMAKE_PREFIX_PATH"] = ":".join([install, *others])
            environment["LD_LIBRARY_PATH"] = os.path.join(install, "lib")
            environment.pop("EARLY_FUSION_SHARE", None)
            source = os.path.join(ROOT, "test", "scripts", "library_user")
            run("cmake", "-S", source, "-B", build, "-DCMAKE_BUILD_TYPE=Release", env=environment)
            with open(os.path.join(build, "CMakeCache.txt")) as cache:
                self.assertIn(f"early_fusion_DIR:PATH={install}/share/early_fusion/cmake", cache.read())
            run("cmake", "--build", build, env=environment)
            [program] = [os.path.join(place, "score") for place, _, names in os.walk(build) if "score" in names]
            linked = run("ldd", program, env=environment)
            self.assertRegex(linked, re.escape(f"{install}/lib/libearly_fusion_model.so"))

            scores = json.loads(run(program, WEIGHTS, env=environment))
            tool = os.path.join(install, "lib", "early_fusion", "early_fusion")
            expected = os.path.join(folder, "scores.json")
            run(tool, "evaluate", "--policy", WEIGHTS, "--task", "simple", "--episodes", "3",
                "--json", expected, env=environment)
            with open(expected) as file:
                self.assertEqual(scores["per_episode"], json.load(file)["per_episode"])


if __name__ == "__main__":
    unittest.main()

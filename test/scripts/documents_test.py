#!/usr/bin/python3
"""The paths, links and anchors in the documents exist. Usage: documents_test.py SOURCE"""
import glob
import os
import re
import sys
import unittest

SOURCE = sys.argv[1]
DOCUMENTS = sorted(glob.glob(os.path.join(SOURCE, "*.md")) + glob.glob(os.path.join(SOURCE, "docs/*.md")) +
                   [os.path.join(SOURCE, "models/README.md"), os.path.join(SOURCE, "CHANGELOG.rst")])
FOLDERS = ("action", "bench", "config", "docs", "env-hooks", "include", "launch", "meshes", "models", "msg", "rviz",
           "scripts", "src", "srv", "test", "tools", "urdf")
LAYERS = ("core", "world", "render", "sim", "expert", "nn", "model", "learning", "ros", "cli", "nodes")
EXAMPLE = re.compile(r"(^|/)my_")  # a file that the reader is to write
GENERATED = "meshes/ycb"  # what scripts/download_ycb.sh fetches


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def exists(path):
    """A path of the repository, or, as in #include, of include/early_fusion/ or src/."""
    places = [SOURCE, os.path.join(SOURCE, "include/early_fusion"), os.path.join(SOURCE, "src")]
    return any(glob.glob(os.path.join(place, path)) for place in places)


def paths_in(text):
    for path in re.findall(r"(?<![\w/.$~-])((?:[\w.*-]+/)+[\w.*-]*)", text):
        top = path.split("/")[0]
        if top in FOLDERS + LAYERS and not EXAMPLE.search(path) and not path.startswith(GENERATED):
            yield path.rstrip(".")


def anchors_of(path):
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", read(path), flags=re.M | re.S), flags=re.M)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Documents(unittest.TestCase):
    def test_every_path_exists(self):
        for document in DOCUMENTS:
            for code in re.findall(r"`+([^`]+)`+", read(document)):
                for path in paths_in(code):
                    self.assertTrue(exists(path), f"{document}: {path}")

    def test_every_link_leads_somewhere(self):
        for document in DOCUMENTS:
            for target in re.findall(r"\]\(([^)]+)\)", read(document)):
                if "://" in target:
                    continue
                path, _, anchor = target.partition("#")
                file = os.path.normpath(os.path.join(os.path.dirname(document), path)) if path else document
                self.assertTrue(os.path.exists(file), f"{document}: {target}")
                if anchor:
                    self.assertIn(anchor, anchors_of(file), f"{document}: {target}")

    def test_every_launch_file_is_described(self):
        text = read(os.path.join(SOURCE, "docs/ros.md"))
        for file in glob.glob(os.path.join(SOURCE, "launch/*.launch")):
            self.assertIn(f"`{os.path.basename(file)}", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

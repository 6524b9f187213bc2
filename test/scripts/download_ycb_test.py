"""Runs scripts/download_ycb.sh with a curl that copies prepared archives."""
import io
import os
import stat
import subprocess
import sys
import tarfile
import tempfile
import unittest

SCRIPT = os.path.join(sys.argv.pop(1), "scripts", "download_ycb.sh")
FILES = {"textured.obj": b"v 0 0 0\n", "textured.mtl": b"newmtl a\n", "texture_map.png": b"png"}
CURL = """#!/bin/sh
for last; do :; done
[ "$1" = --fail ] || exit 9
case "$last" in https://*) ;; *) exit 8 ;; esac
while [ "$1" != --output ]; do shift; done
cp "$ARCHIVES/$(basename "$last")" "$2"
"""


class DownloadYcb(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        for name in ("bin", "archives", "to"):
            os.mkdir(self.path(name))
        with open(self.path("bin/curl"), "w") as file:
            file.write(CURL)
        os.chmod(self.path("bin/curl"), 0o755)

    def tearDown(self):
        self.folder.cleanup()

    def path(self, *names):
        return os.path.join(self.folder.name, *names)

    def archive(self, scan, more=()):
        """Writes a scan's archive. `more` are further members, which replace files of the same name."""
        members = {}
        for name, content in FILES.items():
            info = tarfile.TarInfo(f"{scan}/google_16k/{name}")
            info.size, info.mode, info.uid = len(content), 0o4777, 1234
            members[info.name] = (info, io.BytesIO(content))
        for info in more:
            members[info.name] = (info, None)
        with tarfile.open(self.path("archives", scan + "_google_16k.tgz"), "w:gz") as tar:
            for info, content in members.values():
                tar.addfile(info, content)

    def run_script(self, *arguments):
        environment = dict(os.environ, PATH=self.path("bin") + ":" + os.environ["PATH"], ARCHIVES=self.path("archives"))
        return subprocess.run([SCRIPT, "--to", self.path("to"), *arguments], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def read(self, *names):
        with open(self.path("to", *names)) as file:
            return file.read()

    def test_plain_files_of_the_callers_own_and_a_name_for_each_part(self):
        for scan in ("065-a_cups", "065-b_cups", "025_mug"):
            self.archive(scan)
        result = self.run_script("065-a_cups", "065-b_cups", "025_mug")
        self.assertEqual(result.returncode, 0, result.stdout)
        status = os.stat(self.path("to", "025_mug", "google_16k", "textured.obj"))
        self.assertEqual((status.st_uid, stat.S_IMODE(status.st_mode)), (os.getuid(), 0o644))
        for name in ("cups_a", "cups_b", "mug"):
            self.assertEqual(self.read("objects.yaml").count(f"name: {name},"), 1)

    def test_nothing_but_the_expected_files_is_unpacked(self):
        outside = tarfile.TarInfo("../outside")
        device = tarfile.TarInfo("025_mug/google_16k/device")
        device.type = tarfile.CHRTYPE
        self.archive("025_mug", [outside, device])
        self.assertEqual(self.run_script("025_mug").returncode, 0)
        self.assertEqual(sorted(os.listdir(self.path("to", "025_mug", "google_16k"))), sorted(FILES))
        self.assertFalse(os.path.exists(self.path("outside")))

    def test_a_link_in_place_of_a_file_is_refused(self):
        link = tarfile.TarInfo("025_mug/google_16k/textured.mtl")
        link.type, link.linkname = tarfile.SYMTYPE, "/etc/passwd"
        self.archive("025_mug", [link])
        result = self.run_script("025_mug")
        self.assertEqual(result.returncode, 1)
        self.assertIn("025_mug.tgz has links or devices", result.stdout)
        self.assertFalse(os.path.exists(self.path("to", "025_mug")))

    def test_a_changed_archive_is_refused(self):
        self.archive("025_mug")
        self.assertEqual(self.run_script("025_mug").returncode, 0)
        os.rename(self.path("to", "SHA256SUMS"), self.path("sums"))
        os.rename(self.path("to", "025_mug"), self.path("first"))
        result = self.run_script("--checksums", self.path("sums"), "025_mug")
        self.assertEqual(result.returncode, 0, result.stdout)
        os.rename(self.path("to", "025_mug"), self.path("second"))
        self.archive("025_mug", [tarfile.TarInfo("more")])
        self.archive("024_bowl")
        result = self.run_script("--checksums", self.path("sums"), "025_mug")
        self.assertEqual(result.returncode, 1)
        self.assertIn("it was changed or damaged", result.stdout)
        result = self.run_script("--checksums", self.path("sums"), "024_bowl")
        self.assertIn("has no checksum of 024_bowl.tgz", result.stdout)
        self.assertEqual(sorted(os.listdir(self.path("to"))), ["SHA256SUMS", "objects.yaml"])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Draws an episode as an animated GIF. Options that are not listed below go to `early_fusion render`.

Example: export PATH=$PWD/devel/lib/early_fusion:$PATH
         scripts/animate_episode.py --out episode.gif --task hard --policy models/medium.safetensors --annotate
If the last steps all look the same, one of them is shown.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

try:
    from PIL import Image
except ImportError:
    sys.exit("animate_episode.py needs Pillow: sudo apt install python3-pil")


def number(low, high, kind):
    """A parser of the command line's numbers in [low, high]."""
    def parse(text):
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not low <= value <= high:
            raise argparse.ArgumentTypeError(f"'{text}' is not a number in [{low}, {high}]")
        return value
    return parse


def rendered_steps(options):
    """Plays the episode and returns the images of its steps, in order."""
    program = shutil.which("early_fusion")
    if program is None:
        sys.exit("animate_episode.py: early_fusion is not on the PATH: export PATH=$PWD/devel/lib/early_fusion:$PATH")
    with tempfile.TemporaryDirectory() as folder:
        status = subprocess.run([program, "render", *options, "--image", "steps", "--out", folder]).returncode
        if status != 0:
            sys.exit(status)
        return [Image.open(os.path.join(folder, name)).convert("RGB") for name in sorted(os.listdir(folder))]


def without_still_end(images):
    """Without the images at the end that repeat the one before."""
    end = len(images)
    while end > 1 and images[end - 1].tobytes() == images[end - 2].tobytes():
        end -= 1
    return images[:end]


def with_common_palette(images, colors):
    """One palette for all images, and no dithering: colours do not flicker, and the file is small."""
    width, height = images[0].size
    strip = Image.new("RGB", (width, height * len(images)))
    for i, image in enumerate(images):
        strip.paste(image, (0, i * height))
    palette = strip.quantize(colors)
    return [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)  # --step is an option of render
    parser.add_argument("--out", required=True, help="the GIF file to write")
    parser.add_argument("--steps-per-second", type=number(0.5, 50, float), default=5, help="default: %(default)s")
    parser.add_argument("--last-seconds", type=number(0, 60, float), default=3,
                        help="how long the last step is shown; default: %(default)s")
    parser.add_argument("--colors", type=number(2, 256, int), default=256, help="of the GIF; default: %(default)s")
    arguments, render_options = parser.parse_known_args()

    images = with_common_palette(without_still_end(rendered_steps(render_options)), arguments.colors)
    durations_ms = [1000 / arguments.steps_per_second] * (len(images) - 1) + [1000 * arguments.last_seconds]
    try:
        images[0].save(arguments.out, format="GIF", save_all=True, append_images=images[1:], duration=durations_ms,
                       loop=0, optimize=False)
    except OSError as error:
        sys.exit(f"animate_episode.py: {arguments.out}: {error.strerror}")
    print(f"{arguments.out}: {len(images)} steps, {os.path.getsize(arguments.out) / 1e6:.2f} MB")


if __name__ == "__main__":
    main()

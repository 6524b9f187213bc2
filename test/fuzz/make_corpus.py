#!/usr/bin/python3
"""Writes the seed corpus of the fuzz targets: shipped files and small generated ones.

    make_corpus.py PACKAGE_FOLDER CORPUS_FOLDER

The corpus has a folder for each target, and an empty one in found/ for what libFuzzer finds. If
../shared/cases/make_cases.py is there, the corpus has the files that it writes, too.
"""
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

# --- The binary format of fuzz_target.h: values one after the other, little endian ------------------------------------


def text(value):
    return bytes([len(value)]) + value.encode()


def numbers(layout, *values):
    return struct.pack("<" + layout, *values)


def texts(values):
    return bytes([len(values)]) + b"".join(map(text, values))


# --- Images -----------------------------------------------------------------------------------------------------------

def png(width, height, kind=2):
    """@param kind: PNG's colour type. 0: grey, 2: RGB, 6: RGBA."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    channels = {0: 1, 2: 3, 6: 4}[kind]
    rows = b"".join(b"\0" + bytes((x * 40 + y + c) % 256 for x in range(width) for c in range(channels))
                    for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def tga(width, height, run_length):
    """An RGB image, of which each row is one run if run_length is set."""
    header = numbers("BBBHHBHHHHBB", 0, 0, 10 if run_length else 2, 0, 0, 0, 0, 0, width, height, 24, 0x20)
    row = bytes([0x80 | (width - 1), 1, 2, 3]) if run_length else bytes(range(3 * width))
    return header + row * height


def bmp(width, height):
    row = bytes(range(3 * width)) + b"\0" * (-3 * width % 4)
    return (b"BM" + numbers("IHHI", 54 + len(row) * height, 0, 0, 54) +
            numbers("IiiHHIIiiII", 40, width, height, 1, 24, 0, len(row) * height, 2835, 2835, 0, 0) + row * height)


def textures():
    yield "rgb.png", png(5, 4)
    yield "grey.png", png(8, 8, 0)
    yield "rgba.png", png(3, 9, 6)
    yield "huge.png", png(1, 1).replace(struct.pack(">II", 1, 1), struct.pack(">II", 60000, 60000))
    yield "plain.tga", tga(6, 4, False)
    yield "runs.tga", tga(6, 4, True)
    yield "plain.bmp", bmp(5, 3)
    yield "grey.pgm", b"P5 4 3 255\n" + bytes(range(12))
    yield "rgb.ppm", b"P6\n3 2\n255\n" + bytes(range(18))


# --- Meshes: a byte for the format, as in mesh_fuzz.cpp, and the file -------------------------------------------------

CORNERS = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
FORMATS = ["obj", "ply", "stl", "dae", "gltf", "glb", "off", "3ds"]


def obj():
    lines = ["v %g %g %g" % v for v in CORNERS] + ["vt 0 0", "vt 1 0", "vt 0 1", "vn 0 0 1"]
    lines += ["f " + " ".join("%d/%d/1" % (i + 1, k + 1) for k, i in enumerate(f)) for f in FACES]
    return "\n".join(lines) + "\n"


def ply(coloured):
    lines = ["ply", "format ascii 1.0", "element vertex 4"] + ["property float " + c for c in "xyz"]
    lines += ["property uchar " + c for c in ("red", "green", "blue")] if coloured else []
    lines += ["element face 4", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, v + ((255 * (i % 2), 0, 90) if coloured else ()))) for i, v in enumerate(CORNERS)]
    return "\n".join(lines + ["3 %d %d %d" % f for f in FACES]) + "\n"


def binary_ply():
    header = ("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
              "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n")
    return (header.encode() + b"".join(numbers("3f", *v) for v in CORNERS) +
            b"".join(numbers("B3i", 3, *f) for f in FACES))


def text_stl():
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[i] for i in f) +
                     "endloop\nendfacet\n" for f in FACES)
    return "solid s\n" + facets + "endsolid s\n"


def binary_stl():
    return b"\0" * 80 + numbers("I", len(FACES)) + b"".join(
        numbers("12fH", 0, 0, 1, *(x for i in f for x in CORNERS[i]), 0) for f in FACES)


def off():
    return "OFF\n4 4 0\n" + "".join("%g %g %g\n" % v for v in CORNERS) + "".join("3 %d %d %d\n" % f for f in FACES)


def dae():
    positions = " ".join("%g" % x for v in CORNERS for x in v)
    return ("""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">%s</float_array><technique_common>
<accessor source="#a" count="4" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="4">
<input semantic="VERTEX" source="#v" offset="0"/><p>%s</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""" % (positions, " ".join(str(i) for f in FACES for i in f)))


def gltf_document(data, uri):
    buffer = {"byteLength": len(data)}
    if uri:
        buffer["uri"] = uri
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "scale": [0.5, 0.5, 0.5]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.5, 0.1, 1]}, "doubleSided": True}],
            "buffers": [buffer],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
                            {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0],
                           "max": [0.1, 0.1, 0.1]},
                          {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}]}


def gltf_data():
    return b"".join(numbers("3f", *v) for v in CORNERS) + b"".join(numbers("3H", *f) for f in FACES)


def glb():
    data = gltf_data()
    document = json.dumps(gltf_document(data, None)).encode()
    document += b" " * (-len(document) % 4)
    body = numbers("II", len(document), 0x4E4F534A) + document + numbers("II", len(data), 0x004E4942) + data
    return numbers("4sII", b"glTF", 2, 12 + len(body)) + body


def gltf():
    import base64
    data = gltf_data()
    return json.dumps(gltf_document(data, "data:application/octet-stream;base64," + base64.b64encode(data).decode()))


def mesh(extension, content):
    return bytes([FORMATS.index(extension)]) + (content.encode() if isinstance(content, str) else content)


def meshes():
    yield "obj", mesh("obj", obj())
    yield "ply", mesh("ply", ply(False))
    yield "ply_colours", mesh("ply", ply(True))
    yield "ply_binary", mesh("ply", binary_ply())
    yield "stl", mesh("stl", text_stl())
    yield "stl_binary", mesh("stl", binary_stl())
    yield "off", mesh("off", off())
    yield "dae", mesh("dae", dae())
    yield "glb", mesh("glb", glb())
    yield "gltf", mesh("gltf", gltf())


# --- YAML and URDF ----------------------------------------------------------------------------------------------------

KITCHEN = """<robot name="k"><link name="world"/><link name="counter">
<visual><origin xyz="0 0 0.1" rpy="0 0 0.5"/><geometry><cylinder radius="0.2" length="0.5"/></geometry>
<material name="m"><color rgba="0.5 0.4 0.3 1"/></material></visual>
<visual><geometry><mesh filename="box.obj" scale="1 1 2"/></geometry></visual>
<collision><geometry><box size="0.6 1.2 0.04"/></geometry></collision>
<collision><origin xyz="0 0 0.5"/><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="j" type="fixed"><parent link="world"/><child link="counter"/><origin xyz="0.5 0 0.9" rpy="0 0 0"/></joint>
</robot>
"""

# A pan-tilt unit whose tilt turns upwards, with a safety controller.
UNIT = """<robot name="u"><link name="base"/><link name="pan"/><link name="tilt"/><link name="camera_optical_frame"/>
<joint name="pan_joint" type="continuous"><parent link="base"/><child link="pan"/><axis xyz="0 0 1"/></joint>
<joint name="tilt_joint" type="revolute"><parent link="pan"/><child link="tilt"/><origin xyz="0 0 0.1"/>
<axis xyz="0 -1 0"/><limit lower="-0.7" upper="0.5" effort="1" velocity="1"/>
<safety_controller soft_lower_limit="-0.6" soft_upper_limit="0.4" k_velocity="1"/></joint>
<joint name="o" type="fixed"><parent link="tilt"/><child link="camera_optical_frame"/>
<origin xyz="0 0 0" rpy="-1.5707963 0 -1.5707963"/></joint></robot>
"""


def yaml_texts():
    yield "task/flow", "{instances: 6, requested: 2}"
    yield "task/name", "simple"
    yield "options/few", "{seed: 7, channels: 32, learning_rate: 1e-3, kind: late_fusion, precision: f32, resume: true}"
    yield "object_set/two", ("objects:\n  - {name: box, mesh: box.obj, scale: 0.5}\n"
                             "  - {name: other, mesh: box.obj, scale: [1, 2, 1], rotation: [90, 0, -30.5]}\n")
    yield "kitchen_urdf/small", KITCHEN
    yield "camera_urdf/unit", UNIT


# --- Messages ---------------------------------------------------------------------------------------------------------

def images():
    info = numbers("II", 8, 6) + numbers("9f", 6, 0, 3.5, 0, 6, 2.5, 0, 0, 1) + numbers(
        "12f", 6, 0, 3.5, 0, 0, 6, 2.5, 0, 0, 0, 1, 0) + numbers("6I", 0, 0, 0, 0, 0, 0)
    for encoding, bytes_each in [("rgb8", 3), ("bgra8", 4), ("mono8", 1), ("rgb16", 6), ("mono16", 2),
                                 ("bayer_rggb8", 1), ("bayer_grbg16", 2), ("yuv422", 2), ("8UC3", 3), ("16UC1", 2)]:
        step = 8 * bytes_each + 2
        yield encoding, (text(encoding) + numbers("IIIBBB", 8, 6, step, 1, 0, 59) + info +
                         bytes(i % 251 for i in range(step * 6)))


def requests():
    def request(stamp, episode, step, items):
        return numbers("BBBI", 1, stamp, episode, step) + texts(items)

    def image(stamp):
        return numbers("BB", 0, stamp)

    yield "pairs", b"".join(request(s, 1, s, ["mug", "bowl"]) + image(s) for s in range(4))
    yield "images_first", image(5) + image(6) + request(6, 2, 0, ["plate"]) + request(5, 2, 1, []) + image(5)
    yield "unknown_item", request(1, 1, 0, ["hammer"]) + image(1)


def scenes():
    action = text("PAN_LEFT") + text("w") + text("argmax") + numbers("B", 1)
    begin = numbers("BB", 1, 1) + action  # the simulator's first scene, with the stamp 1
    instance = text("mug") + numbers("dddB", 0.5, 0.1, 0.3, 1)
    scene = (numbers("BB", 0, 2) + text("custom") + numbers("BBII", 1, 0, 1, 3) + bytes([1]) + instance +
             numbers("ii", 1, 0) + texts(["mug"]) + text("PAN_LEFT"))
    yield "begin", begin
    yield "other_scene", begin + scene + action
    yield "restart", begin * 2 + scene + action + begin


def goals():
    def goal(task, most, pairs, held_out, share, per, expert):
        return (text(task) + numbers("I", most) + text(pairs) + numbers("dQQQd", held_out, 1, 2, 3, share) + text(per) +
                text(expert))

    yield "simple", goal("simple", 0, "", 0, 0, "", "")
    yield "options", goal("{instances: 6, requested: 2}", 12, "trained", 0.5, 0.25, "trajectory", "searching")
    yield "held_out", goal("medium", 0, "held_out", 0.3, 1, "step", "greedy")


# --- The corpus -------------------------------------------------------------------------------------------------------

def generated():
    yield from yaml_texts()
    for target, seeds in [("texture", textures()), ("mesh", meshes()), ("camera_image", images()),
                          ("request", requests()), ("scene", scenes()), ("goal", goals())]:
        for name, content in seeds:
            yield target + "/" + name, content


def shipped(package):
    """(target, path) of files that the package ships."""
    def files(folder):
        return [os.path.join(package, folder, name) for name in sorted(os.listdir(os.path.join(package, folder)))]

    yield from (("task", path) for path in files("config/tasks"))
    yield from (("options", path) for path in files("config/presets"))
    yield "camera_urdf", os.path.join(package, "urdf/pan_tilt_camera.urdf")
    yield "kitchen_urdf", os.path.join(package, "urdf/kitchen.urdf")


def cases(package):
    """(target, name, content) of the files that another script makes, if it is there."""
    script = os.path.join(package, "..", "shared", "cases", "make_cases.py")
    if not os.path.exists(script):
        return
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, script, folder], check=True, stdout=subprocess.DEVNULL)
        for target, part in [("camera_urdf", "urdf"), ("weights", "weights"), ("mesh", "meshes")]:
            for name in sorted(os.listdir(os.path.join(folder, part))):
                with open(os.path.join(folder, part, name), "rb") as file:
                    content = file.read()
                extension = name.rsplit(".", 1)[-1]
                if target == "mesh" and extension not in FORMATS:
                    continue
                yield target, name, mesh(extension, content) if target == "mesh" else content


def write(folder, target, name, content):
    os.makedirs(os.path.join(folder, target), exist_ok=True)
    with open(os.path.join(folder, target, name), "wb") as file:
        file.write(content.encode() if isinstance(content, str) else content)


def main():
    package, folder = sys.argv[1:]
    shutil.rmtree(folder, ignore_errors=True)
    for name, content in generated():
        write(folder, *name.split("/"), content)
    for target, path in shipped(package):
        with open(path, "r", encoding="utf-8") as file:
            # Boxes instead of meshes, for each of which the importer starts a process.
            content = re.sub("<mesh [^>]*>", '<box size="0.1 0.2 0.3"/>', file.read())
        write(folder, target, "shipped_" + os.path.basename(path), content)
    for target, name, content in cases(package):
        write(folder, target, "case_" + name, content)
    for target in os.listdir(folder) + ["weights", "weights_message", "checkpoint"]:
        os.makedirs(os.path.join(folder, "found", target), exist_ok=True)


if __name__ == "__main__":
    main()

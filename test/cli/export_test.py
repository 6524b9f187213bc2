#!/usr/bin/python3
"""Exported ONNX files, read with the package onnx. Usage: export_test.py SOURCE PROGRAM"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import onnx
except ImportError:
    print("skipped: needs the Python package onnx (python3-onnx)")
    sys.exit(77)

SOURCE, PROGRAM = sys.argv[1:3]
FLOAT, UINT8 = onnx.TensorProto.FLOAT, onnx.TensorProto.UINT8


def run(*arguments):
    subprocess.run([PROGRAM, *arguments], check=True, capture_output=True)


def shape_of(value):
    return [dimension.dim_value for dimension in value.type.tensor_type.shape.dim]


class ExportedModel(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def weights(self, kind, *options):
        """An almost untrained policy of the kind."""
        with open(self.path("task.yaml"), "w") as task:
            task.write("{instances: 2, requested: 1, steps: 2}")
        output = tempfile.mkdtemp(dir=self.folder.name)
        run("train", "--task", self.path("task.yaml"), "--output", output, "--kind", kind, "--trajectories", "2",
            "--evaluation-episodes", "1", *options)
        return os.path.join(output, "weights.safetensors")

    def export(self, weights, *options):
        run("export", weights, "--out", self.path("policy.onnx"), *options)
        model = onnx.load(self.path("policy.onnx"))
        # With full_check, the shapes of all values are inferred, and differences to the declared ones are errors.
        onnx.checker.check_model(model, full_check=True)
        return model

    def test_networks_of_all_kinds_pass_the_checker(self):
        for kind, options in (("early_fusion", ["--fusion-block", "0", "--spatial-grid", "true"]),
                              ("early_fusion", []), ("late_fusion", []), ("attention_map", []),
                              ("softmax_attention_map", [])):
            with self.subTest(kind=kind, options=options):
                weights = self.weights(kind, *options)
                for frames, element in (("bytes", UINT8), ("float", FLOAT)):
                    graph = self.export(weights, "--frames", frames).graph
                    self.assertEqual([value.name for value in graph.input], ["frames", "request"])
                    self.assertEqual([value.name for value in graph.output], ["probabilities"])
                    self.assertEqual([value.type.tensor_type.elem_type for value in graph.input], [element, FLOAT])
                    self.assertEqual([shape_of(value) for value in graph.input], [[3, 128, 128, 3], [1, 16]])
                    self.assertEqual(shape_of(graph.output[0]), [1, 7])

    def test_the_model_says_what_it_takes_and_gives(self):
        model = self.export(os.path.join(SOURCE, "models/medium.safetensors"))
        metadata = {entry.key: entry.value for entry in model.metadata_props}
        self.assertEqual(metadata["kind"], "early_fusion")
        self.assertEqual(metadata["image_size"], "128")
        self.assertEqual(metadata["horizontal_fov_deg"], "60")
        self.assertEqual(metadata["task"], "medium")
        self.assertNotIn("digest", metadata)
        self.assertEqual(json.loads(metadata["vocabulary"])[10:12], ["mug", "bowl"])
        self.assertEqual(json.loads(metadata["actions"])[4:], ["COLLECT", "REMOVE", "IDLE"])
        frames, request = model.graph.input
        self.assertIn("the newest first", frames.doc_string)
        self.assertIn("rubiks_cube, mug, bowl", request.doc_string)
        self.assertIn("PAN_LEFT, PAN_RIGHT, TILT_UP", model.graph.output[0].doc_string)
        self.assertEqual([(operators.domain, operators.version) for operators in model.opset_import], [("", 11)])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

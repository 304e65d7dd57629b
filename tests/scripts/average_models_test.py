"""scripts/average_models.py: the mean of each number, the training clips of all, all else the last model's, nothing
of unlike models; and scripts/share_model.py: no folders, the acknowledgement, which models the start was a mean of.

    average_models_test.py
"""

import hashlib
import json
import pathlib
import struct
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


def header_of(path):
    content = path.read_bytes()
    (length,) = struct.unpack_from("<Q", content)
    return json.loads(content[8 : 8 + length])


def write_model(path, half, single, seed, fps=30.0, dtype="F32", **more):
    about = {"config": {"seed": seed}, "modalities": {"fps": fps}, **more}
    header = {
        "__metadata__": {"mcdbn": json.dumps(about)},
        "W": {"dtype": "F16", "shape": [1, len(half)], "data_offsets": [0, 2 * len(half)]},
        "b": {"dtype": dtype, "shape": [len(single)],
              "data_offsets": [2 * len(half), 2 * len(half) + 4 * len(single)]},
    }
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + struct.pack(f"<{len(half)}e", *half) +
                     struct.pack(f"<{len(single)}f", *single))


class AverageModels(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.model, self.second, self.further, self.out = (
            self.folder / name
            for name in ("model.safetensors", "second.safetensors", "further.safetensors", "out"))
        write_model(self.model, [1.0, -2.0, 0.5], [10.0, 20.0], seed=1)
        write_model(self.second, [2.0, -3.0, 0.75], [9.0, 3.0], seed=3)

    def tearDown(self):
        self.temporary.cleanup()

    def average(self, *models):
        return subprocess.run([SCRIPTS / "average_models.py", self.out, *models], capture_output=True,
                              text=True, check=False)

    def test_means_and_the_rest_of_the_last(self):
        write_model(self.further, [3.0, -4.0, 0.25], [11.0, -20.0], seed=2)
        result = self.average(self.model, self.second, self.further)
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.out.read_bytes()
        (length,) = struct.unpack_from("<Q", content)
        header = json.loads(content[8 : 8 + length])
        self.assertEqual(length % 8, 0)
        self.assertEqual(struct.unpack_from("<3e", content, 8 + length), (2.0, -3.0, 0.5))
        self.assertEqual(struct.unpack_from("<2f", content, 8 + length + 6), (10.0, 1.0))
        self.assertEqual(len(content), 8 + length + 14)
        self.assertEqual(json.loads(header["__metadata__"]["mcdbn"])["config"], {"seed": 2})
        self.assertEqual(json.loads(header["__metadata__"]["mean_of"]),
                         [{"model": model.name, "sha256": hashlib.sha256(model.read_bytes()).hexdigest()}
                          for model in (self.model, self.second, self.further)])

    def test_training_clips_of_all_and_no_ones_early_stopping(self):
        def clips(*numbers):
            return [{"path": f"/clips/{number}.bvh", "fingerprint": str(number)} for number in numbers]

        stopped = {"held_out": ["4.bvh"], "steps": 200, "loss": 0.5}
        write_model(self.model, [1.0], [1.0], seed=1, training_clips=clips(1, 2))
        write_model(self.second, [1.0], [1.0], seed=2, training_clips=clips(1, 2, 3), early_stopping=stopped)
        write_model(self.further, [1.0], [1.0], seed=3, training_clips=clips(2, 4),
                    early_stopping={**stopped, "held_out": ["3.bvh"]})
        result = self.average(self.model, self.second, self.further)
        self.assertEqual(result.returncode, 0, result.stderr)
        about = json.loads(header_of(self.out)["__metadata__"]["mcdbn"])
        self.assertCountEqual(about["training_clips"], clips(1, 2, 3, 4))
        self.assertNotIn("early_stopping", about)
        self.assertEqual(about["config"], {"seed": 3})

    def test_one_model_has_no_mean(self):
        self.assertNotEqual(self.average(self.model).returncode, 0)
        self.assertFalse(self.out.exists())

    def test_unlike_models_are_refused(self):
        for unlike, words in (({"fps": 25.0}, "features, scaling, camera or sizes"),
                              ({"dtype": "I32"}, "b is not of one type"),
                              ({"single": [1.0, 2.0, 3.0]}, "b is not of one type")):
            single = unlike.pop("single", [1.0, 2.0])
            write_model(self.further, [1.0, 2.0, 3.0], single, seed=2, **unlike)
            result = self.average(self.model, self.second, self.further)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(words, result.stderr)
            self.assertFalse(self.out.exists())

    def test_what_is_passed_on(self):
        write_model(self.further, [1.0], [2.0], seed=2,
                    training_clips=[{"path": "/home/me/walk.bvh", "fingerprint": "1", "person": "Anna",
                                     "action": "walk"}],
                    started_from={"model": "/home/me/mean.safetensors", "fingerprint": "2"})
        start = self.folder / "mean.safetensors"
        for models, kept in (((self.model, self.second), True), ((), False)):
            if models:
                self.average(*models)
                self.out.rename(start)
            else:
                start.write_bytes(self.model.read_bytes())
            subprocess.run([SCRIPTS / "share_model.py", self.further, self.out, "thanks", start], check=True)
            metadata = header_of(self.out)["__metadata__"]
            self.assertEqual("mean_of" in metadata, kept)
            if kept:
                self.assertEqual(metadata["mean_of"], header_of(start)["__metadata__"]["mean_of"])
            self.assertEqual(metadata["acknowledgement"], "thanks")
            about = json.loads(metadata["mcdbn"])
            self.assertEqual(about["training_clips"], [{"path": "walk.bvh", "fingerprint": "1"}])
            self.assertEqual(about["started_from"], {"model": "mean.safetensors", "fingerprint": "2"})


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""The figures of scripts/real_trial, on a trial made up so that each is known beforehand.

    real_trial_test.py

Where there is no numpy, exit code 77, which CTest takes for "skipped".
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/real_trial"
FRAMES, FPS = 8, 60
TRIAL = "S00_P00_SingleParticipant/S00_P00_T01_BalancingTrial"
# Upright in the plane z = 0 of the program's world: metres, +y up, the person's left at +x.
BODY = {"LShoulder": (0.2, 1.4), "RShoulder": (-0.2, 1.4), "LElbow": (0.3, 1.1), "RElbow": (-0.3, 1.1),
        "LWrist": (0.3, 0.8), "RWrist": (-0.3, 0.8), "LHip": (0.1, 0.9), "RHip": (-0.1, 0.9),
        "LKnee": (0.1, 0.5), "RKnee": (-0.1, 0.5), "LAnkle": (0.1, 0.1), "RAnkle": (-0.1, 0.1)}
BVH_NAMES = {"Shoulder": "Arm", "Elbow": "ForeArm", "Wrist": "Hand", "Hip": "UpLeg", "Knee": "Leg",
             "Ankle": "Foot"}
BODY_25B = ("Nose LEye REye LEar REar LShoulder RShoulder LElbow RElbow LWrist RWrist LHip RHip LKnee "
            "RKnee LAnkle RAnkle Neck Head LBigToe LSmallToe LHeel RBigToe RSmallToe RHeel").split()
HALPE_26 = ("Nose LEye REye LEar REar LShoulder RShoulder LElbow RElbow LWrist RWrist LHip RHip LKnee "
            "RKnee LAnkle RAnkle Head Neck MidHip LBigToe RBigToe LSmallToe RSmallToe LHeel "
            "RHeel").split()
FOCAL, DEPTH = 1000.0, 5.0
# Does what the program would: hands out the answer laid ready for a folder and a camera.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, shutil, sys
options = dict(zip(sys.argv[2::2], sys.argv[3::2]))
here = pathlib.Path(__file__).parent
with (here / "calls.jsonl").open("a") as calls:
    calls.write(json.dumps(sys.argv[1:]) + "\\n")
known = "known" if "--camera" in options else "unknown"
shutil.copy(here / f"{pathlib.Path(options['--input']).name}_{known}.bvh", options["-o"])
if (here / "failing").exists():
    sys.exit(1)
if "--write-camera" in options:
    shutil.copy(here / "camera.json", options["--write-camera"])
"""
# The camera that it found: to the person's left, along -x, and 20 degrees down. Rows are right, down, ahead.
SIN, COS = math.sin(math.radians(20)), math.cos(math.radians(20))
FOUND = [[0, 0, -1], [SIN, -COS, 0], [-COS, -SIN, 0]]


def as_found(place):
    """What that camera has to see to see the same as the real one, which is level."""
    return tuple(place[0] * right - place[1] * down for right, down in zip(FOUND[0], FOUND[1]))


def world(frame, joint):
    """Everybody walks to the left of the camera by 10 mm a frame."""
    x, y = BODY[joint]
    return x + 0.01 * frame, y, 0.0


def trc(path, places):
    """@param places (frame, joint) -> the program's world; the file has x where that has -z."""
    lines = ["PathFileType\t4\t(X/Y/Z)\ta.trc", "DataRate\tUnits", "60\tm",
             "Frame#\tTime\t" + "\t\t\t".join(BODY) + "\t\t",
             "\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(len(BODY)))]
    for frame in range(FRAMES):
        cells = [frame, frame / FPS]
        for joint in BODY:
            x, y, z = places(frame, joint)
            cells += [-z, y, x]
        lines.append("\t".join(map(str, cells)))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def openpose(folder, names, frames, shift_px):
    """What a camera 5 m before the person sees; `frames` are the rows of the truth."""
    folder.mkdir(parents=True)
    for number, frame in enumerate(frames):
        values = []
        for name in names:
            if name not in BODY or frame < 0:
                values += [0, 0, 0]
                continue
            x, y, _ = world(frame, name)
            values += [500 + FOCAL * x / DEPTH + shift_px, 800 - FOCAL * y / DEPTH, 0.9]
        (folder / f"frame_{number:05}.json").write_text(
            json.dumps({"people": [{"pose_keypoints_2d": values}]}))


def bvh(path, places, frames=FRAMES):
    """Hips turned by 90 degrees about y, all other joints beside it, but the left elbow, which hangs
    on a shoulder turned by 90 degrees about z and has its place by its offset alone.
    @param places (frame, joint) -> world, in units of which 2 are a metre"""
    def local(at):  # what the hips' turn takes to that place
        return -at[2], at[1], at[0]

    lines = ["HIERARCHY", "ROOT Hips", "{", "OFFSET 0 0 0", "CHANNELS 4 Xposition Yposition Zposition "
             "Yrotation"]
    shin = 1.7 * 0.491  # two of them, in units of half a metre
    order = [joint for joint in BODY if joint != "LElbow"]
    for joint in order:
        name = {"L": "Left", "R": "Right"}[joint[0]] + BVH_NAMES[joint[1:]]
        offset = f"0 {-shin} 0" if joint in ("LKnee", "LAnkle") else "0 0 0"
        turn = "4 Xposition Yposition Zposition Zrotation" if joint == "LShoulder" else \
            "3 Xposition Yposition Zposition"
        lines += [f"JOINT {name}", "{", f"OFFSET {offset}", f"CHANNELS {turn}"]
        if joint == "LShoulder":
            here, elbow = local(places(0, "LShoulder")), local(places(0, "LElbow"))
            x, y, z = (2 * (b - a) for a, b in zip(here, elbow))
            lines += ["JOINT LeftForeArm", "{", f"OFFSET {y} {-x} {z}", "CHANNELS 0", "End Site", "{",
                      "OFFSET 0 1 0", "}", "}"]
        lines += ["End Site", "{", "OFFSET 0 1 0", "}", "}"]
    lines += ["}", "MOTION", f"Frames: {frames}", f"Frame Time: {1 / FPS}"]
    for frame in range(frames):
        cells = [0, 0, 0, 90]
        for joint in order:
            cells += [2 * part for part in local(places(frame, joint))]
            if joint == "LShoulder":
                cells.append(90)
        lines.append(" ".join(map(str, cells)))
    path.write_text("\n".join(lines) + "\n")


class RealTrial(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.data = self.folder / "data"
        markers = self.data / TRIAL / "pose-3d" / "S00_P00_T01_BalancingTrial_0-100.trc"
        trc(markers, world)
        # The filtered markers' right knee rises with 24 m/s2: 2 m/s2 on the mean of twelve joints.
        trc(markers.with_name(markers.stem + "_filt_butterworth.trc"), lambda frame, joint: (
            world(frame, joint)[0],
            world(frame, joint)[1] + (12 * (frame / FPS) ** 2 if joint == "RKnee" else 0), 0))
        calibration = self.data / "S00_Calibration" / "Calib_qualisys.toml"
        calibration.parent.mkdir()
        calibration.write_text("\n".join(
            f"[cam_{number:02}]\nmatrix = [[{FOCAL}, 0, 500], [0, {FOCAL}, 800], [0, 0, 1]]\n"
            f"distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = [{math.pi / 2}, 0, 0]\n"
            f"translation = [0, 0, {DEPTH}]" for number in (1, 2, 3)))
        for number in (1, 2, 3):
            openpose(self.data / TRIAL / f"pose/cam{number:02}_json", BODY_25B, range(FRAMES), 3)
        # The second file of RTMPose shows the first row.
        openpose(self.data / "pose2sim_rtmpose_S00P00T01/cam03", HALPE_26, range(-1, FRAMES), 4)
        self.model = self.folder / "model.safetensors"
        self.model.write_text("a model")
        (self.folder / "camera.json").write_text(json.dumps(
            {"R": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": sum(FOUND, [])}}))
        self.program = self.folder / "program"
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)

    def tearDown(self):
        self.temporary.cleanup()

    def lay_answer(self, name, places, frames=FRAMES):
        bvh(self.folder / f"{name}.bvh", places, frames)

    def run_script(self, *arguments, code=0):
        done = subprocess.run([sys.executable, "-B", SCRIPT, self.model, "--data", self.data, "--cli",
                               "./program", "--work", self.folder / "work", "--methods", "model",
                               *arguments], capture_output=True, text=True, check=False, cwd=self.folder)
        self.assertEqual(done.returncode, code, done.stderr)
        return [[cell.strip() for cell in line.strip("|").split("|")]
                for line in done.stdout.splitlines() if line.startswith("|")]

    def calls(self):
        return [json.loads(line) for line in (self.folder / "calls.jsonl").read_text().splitlines()]

    def test_a_wrist_elsewhere_and_all_of_it_aside(self):
        def wrong(frame, joint):
            x, y, z = world(frame, joint)
            return x + 0.1, y - (0.12 if joint == "LWrist" else 0), z

        for name in ("cam01_json", "truth_cam01"):
            self.lay_answer(f"{name}_known", wrong)
            self.lay_answer(f"{name}_unknown", lambda frame, joint: as_found(world(frame, joint)))
        rows = self.run_script("--cameras", "1", "--joints")
        known, unknown = rows[2], rows[3]
        self.assertEqual(known[:4], ["1", "OpenPose", "yes", "model"])
        self.assertEqual(known[4], "10")  # 120 mm of one of twelve
        self.assertLess(int(known[5]), 20)  # a little turned towards the wrist
        self.assertLess(int(known[6]), 20)
        self.assertEqual(known[7:], ["100", "2", "17.0", "3.0", ""])  # 100 mm are 20 px, the track's 3 less
        self.assertEqual(unknown[:4], ["1", "OpenPose", "no", "model"])
        self.assertEqual(unknown[4:], ["0", "0", "0", "", "2", "", "3.0", "20"])
        self.assertEqual(rows[4][1], "truth, projected")
        self.assertEqual(rows[4][-3:], ["20.0", "0.0", ""])
        joints = dict(zip(rows[-6][4:], rows[-4][4:]))
        self.assertEqual(joints.pop("LWrist"), "120")
        self.assertEqual(set(joints.values()), {"0"})
        calls = self.calls()
        self.assertEqual(len(calls), 4)
        for call in calls:
            self.assertEqual(call[call.index("--fps") + 1], "60")
        self.assertTrue(calls[0][calls[0].index("--camera") + 1].endswith("Calib_qualisys.toml:cam_01"))
        # What is there is not made again, and gives the same.
        self.assertEqual(self.run_script("--cameras", "1", "--joints"), rows)
        self.assertEqual(len(self.calls()), 4)
        # An answer of an unknown camera is whole with its camera alone.
        (self.folder / "work" / "cam01_openpose_unknown_model.json").unlink()
        self.assertEqual(self.run_script("--cameras", "1", "--joints"), rows)
        self.assertEqual(len(self.calls()), 5)

    def test_answers_are_those_of_this_model_and_program_and_of_these_tracks(self):
        def lay_answers(aside_m):
            for name in ("cam01_json", "truth_cam01"):
                for known in ("known", "unknown"):
                    self.lay_answer(f"{name}_{known}", lambda frame, joint: (
                        world(frame, joint)[0] + aside_m, *world(frame, joint)[1:]))

        def root_mm():
            return int(self.run_script("--cameras", "1")[2][7])

        lay_answers(0.1)
        self.assertEqual(root_mm(), 100)
        self.assertEqual(len(self.calls()), 4)
        lay_answers(0.2)
        self.assertEqual(root_mm(), 100)  # what is there
        self.model.write_text("another")
        self.assertEqual(root_mm(), 200)
        self.assertEqual(len(self.calls()), 8)
        lay_answers(0.3)
        self.program.write_text(PROGRAM + "\n")
        self.assertEqual(root_mm(), 300)
        self.assertEqual(len(self.calls()), 12)
        lay_answers(0.4)
        frame = next((self.data / TRIAL / "pose/cam01_json").iterdir())
        frame.write_text(frame.read_text() + "\n")
        self.assertEqual(root_mm(), 400)
        self.assertEqual(len(self.calls()), 14)  # the projected truth is as it was
        calibration = self.data / "S00_Calibration/Calib_qualisys.toml"
        calibration.write_text(calibration.read_text() + "\n")
        lay_answers(0.5)
        self.assertEqual(root_mm(), 500)
        self.assertEqual(len(self.calls()), 18)
        # What another model began to replace is no longer the first one's.
        self.model.write_text("a third")
        lay_answers(0.6)
        (self.folder / "failing").touch()
        self.run_script("--cameras", "1", code=1)
        (self.folder / "failing").unlink()
        lay_answers(0.7)
        self.model.write_text("another")
        self.assertEqual(root_mm(), 700)

    def test_turned_and_taller_answers_and_the_mean_of_cameras(self):
        def turned(frame, joint):
            # By 60 degrees about the middle of the hips: as far off as it is from their axis.
            middle = world(frame, "LHip")[0] - 0.1
            x, y, _ = world(frame, joint)
            return middle + 0.5 * (x - middle), y, -math.sqrt(0.75) * (x - middle)

        def taller(frame, joint):
            x, y, z = world(frame, joint)
            return 1.5 * x, 1.5 * y, 1.5 * z

        for name in ("cam01_json", "truth_cam01"):
            for known in ("known", "unknown"):
                self.lay_answer(f"{name}_{known}", turned)
        for name in ("cam02_json", "truth_cam02"):
            for known in ("known", "unknown"):
                self.lay_answer(f"{name}_{known}", taller)
        rows = self.run_script("--cameras", "1,2")
        of = {(row[0], row[1], row[2]): row[4:] for row in rows[2:]}
        aside = sum(abs(x) for x, _ in BODY.values()) / len(BODY)
        self.assertEqual(of["1", "OpenPose", "yes"][:3], [f"{1000 * aside:.0f}", "0", "0"])
        away = sum(math.hypot(x, y - 0.9) for x, y in BODY.values()) / len(BODY)
        self.assertEqual(of["2", "OpenPose", "yes"][:3],
                         [f"{500 * away:.0f}", f"{500 * away:.0f}", "0"])
        self.assertEqual(of["mean of 2", "OpenPose", "yes"][0],
                         f"{(1000 * aside + 500 * away) / 2:.0f}")

    def test_the_second_detector_is_a_frame_late(self):
        for name in ("cam03_json", "truth_cam03"):
            for known in ("known", "unknown"):
                self.lay_answer(f"{name}_{known}", world)
        for known in ("known", "unknown"):
            self.lay_answer(f"cam03_{known}", lambda frame, joint: world(frame - 1, joint), FRAMES + 1)
        rows = {(row[1], row[2]): row[4:] for row in self.run_script("--cameras", "3")[2:]}
        self.assertEqual(rows["RTMPose", "yes"], ["0", "0", "0", "0", "2", "4.0", "4.0", ""])
        self.assertEqual(rows["OpenPose", "yes"], ["0", "0", "0", "0", "2", "3.0", "3.0", ""])

    def test_missing_data_is_reported(self):
        done = subprocess.run([sys.executable, "-B", SCRIPT, self.model, "--data", self.folder / "none"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("skipped: no data"))


if __name__ == "__main__":
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("SKIPPED: no numpy here; scripts/install_dependencies --test installs it")
        sys.exit(77)
    unittest.main()

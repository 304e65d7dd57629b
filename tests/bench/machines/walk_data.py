"""Walks as matrices: frames of BVH files as joint angles and the root's motion in its own direction."""

import numpy
from scipy.spatial.transform import Rotation

FPS = 30.0
HANDS = ("Hand", "Finger", "Thumb")  # hardly recorded, and otherwise for each person


def read_bvh(path):
    """(name and columns of each channel, for each joint but the hands'; [frames x channels]; seconds)."""
    lines = path.read_text().split("\n")
    motion = next(i for i, line in enumerate(lines) if line.strip() == "MOTION")
    joints, column, joint = [], 0, ""
    for line in lines[:motion]:
        words = line.split()
        if words[:1] in (["ROOT"], ["JOINT"]):
            joint = words[1]
        if words[:1] == ["CHANNELS"]:
            if not any(part in joint for part in HANDS):
                joints.append([(name, column + i) for i, name in enumerate(words[2:])])
            column += int(words[1])
    rest = [line for line in lines[motion + 1:] if line.strip()]
    frame_s = float(rest[1].split(":")[1])
    values = numpy.array([line.split() for line in rest[2:]], float)
    return joints, values[1:], frame_s  # the first frame is a T-pose


def rotation_of(joint, values):
    turns = [(name[0], column) for name, column in joint if name.endswith("rotation")]
    angles = values[:, [column for _, column in turns]]
    return Rotation.from_euler("".join(axis for axis, _ in turns), angles, degrees=True)


def features_of(path):
    """[frames x features]: each joint's rotation vector; of the root its tilt, its height, and its
    velocities on the ground and about the vertical, seen in the direction that it faces."""
    joints, values, frame_s = read_bvh(path)
    values = values[::max(1, round(1 / (FPS * frame_s)))]
    root = rotation_of(joints[0], values)
    forward = root.apply([0, 0, 1])
    yaw = numpy.unwrap(numpy.arctan2(forward[:, 0], forward[:, 2]))
    facing = Rotation.from_euler("Y", yaw[:, None])
    place = values[:, [column for name, column in joints[0] if name.endswith("position")]]
    step = facing[1:].inv().apply(numpy.diff(place, axis=0))
    columns = [(facing.inv() * root).as_rotvec()[1:], place[1:, 1:2], step[:, [0, 2]],
               numpy.diff(yaw)[:, None]]
    columns += [rotation_of(joint, values).as_rotvec()[1:] for joint in joints[1:]]
    return numpy.hstack(columns)


class Walks:
    """Standardized by the training clips, without columns that hardly move.
    training, test: lists of [frames x features]"""

    def __init__(self, folder, held_out=("05", "08", "16")):
        clips = {path.stem: features_of(path) for path in sorted(folder.glob("*.bvh"))}
        training = [c for name, c in clips.items() if name.split("_")[0] not in held_out]
        test = [c for name, c in clips.items() if name.split("_")[0] in held_out]
        rows = numpy.vstack(training)
        moving = rows.std(0) > 0.01
        mean, deviation = rows.mean(0)[moving], rows.std(0)[moving]
        self.training, self.test = ([(c[:, moving] - mean) / deviation for c in part]
                                    for part in (training, test))

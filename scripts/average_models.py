#!/usr/bin/env python3
"""The mean of several models' parameters: average_models.py OUT MODEL MODEL…

Models that `train --from` made from one start, and that start. Each forgot or overfitted something else, and
between them lie parameters that do better than any (docs/corpus.md). The training clips are those of all models;
where a person was held out (`early_stopping`) is not kept, as that was of one model. All else but the numbers is
the last model's. The metadata name the models, with their SHA-256, in `mean_of`.
"""

import hashlib
import json
import pathlib
import struct
import sys

from model_file import read_model, write_model

LETTERS = {"F16": "e", "F32": "f", "F64": "d"}  # of struct
MAY_DIFFER = ("config", "early_stopping", "sampling", "started_from", "training_clips")


def about(header: dict) -> dict:
    return json.loads(header["__metadata__"]["mcdbn"])


def network(header: dict) -> dict:
    """What the models must have in common: features, scaling, camera, sizes."""
    return {name: value for name, value in about(header).items() if name not in MAY_DIFFER}


def about_mean(headers: list[dict]) -> dict:
    """What is said of the mean: the last model's, with the training clips of all, each once."""
    clips = {clip["fingerprint"]: clip for header in headers for clip in about(header).get("training_clips", [])}
    mean = {**about(headers[-1]), "training_clips": list(clips.values())}
    mean.pop("early_stopping", None)
    return mean


def numbers(tensor: dict, content: bytes) -> tuple[float, ...]:
    begin, end = tensor["data_offsets"]
    return tuple(number for (number,) in struct.iter_unpack("<" + LETTERS[tensor["dtype"]],
                                                            content[begin:end]))


def averaged(models: list[tuple[dict, bytes]]) -> bytes:
    """The numbers of the last model's tensors, each the mean over the models."""
    last_header, last_content = models[-1]
    if any(network(header) != network(last_header) for header, _ in models):
        sys.exit("the models differ in features, scaling, camera or sizes")
    result = bytearray(last_content)
    for name, tensor in last_header.items():
        if name == "__metadata__":
            continue
        kinds = [(header.get(name, {}).get("dtype"), header.get(name, {}).get("shape"))
                 for header, _ in models]
        if any(kind != kinds[-1] for kind in kinds):
            sys.exit(f"{name} is not of one type and shape in all models")
        means = [sum(values) / len(models)
                 for values in zip(*(numbers(header[name], content) for header, content in models))]
        begin, end = tensor["data_offsets"]
        result[begin:end] = struct.pack(f"<{len(means)}{LETTERS[tensor['dtype']]}", *means)
    return bytes(result)


def named(model: pathlib.Path) -> dict:
    return {"model": model.name, "sha256": hashlib.sha256(model.read_bytes()).hexdigest()}


def main() -> None:
    if len(sys.argv) < 4:
        sys.exit("average_models.py OUT MODEL MODEL…")
    out, *paths = sys.argv[1:]
    models = [read_model(path) for path in paths]
    header = models[-1][0]
    means = averaged(models)
    header["__metadata__"].update(
        mcdbn=json.dumps(about_mean([model[0] for model in models])),
        mean_of=json.dumps([named(pathlib.Path(path)) for path in paths]))
    write_model(out, header, means)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The mean of several models' parameters: average_models.py OUT MODEL MODEL…

Models that `train --from` made from one start, and that start. Each forgot or overfitted something else, and
between them lie parameters that do better than any (docs/corpus.md). All but the numbers is the last model's;
the metadata name the models, with their SHA-256, in `mean_of`.
"""

import hashlib
import json
import pathlib
import struct
import sys

from model_file import read_model, write_model

LETTERS = {"F16": "e", "F32": "f", "F64": "d"}  # of struct
MAY_DIFFER = ("config", "sampling", "started_from", "training_clips")


def network(header: dict) -> dict:
    """What the models must have in common: features, scaling, camera, sizes."""
    about = json.loads(header["__metadata__"]["mcdbn"])
    return {name: value for name, value in about.items() if name not in MAY_DIFFER}


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
    header["__metadata__"]["mean_of"] = json.dumps([named(pathlib.Path(path)) for path in paths])
    write_model(out, header, means)


if __name__ == "__main__":
    main()

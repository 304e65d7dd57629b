#!/usr/bin/env python3
"""The mean of a model's parameters and of those that it came to: average_models.py MODEL FURTHER OUT

FURTHER is what `train --from MODEL` made. Each forgot or overfitted something else, and between them lie
parameters that do better than either (docs/corpus.md). All but the numbers is FURTHER's; the metadata
name MODEL in `averaged_with`.
"""

import json
import pathlib
import struct
import sys

from model_file import read_model, write_model

LETTERS = {"F16": "e", "F32": "f", "F64": "d"}  # of struct
MAY_DIFFER = ("config", "sampling", "started_from", "training_clips")


def network(header: dict) -> dict:
    """What two models must have in common: features, scaling, camera, sizes."""
    about = json.loads(header["__metadata__"]["mcdbn"])
    return {name: value for name, value in about.items() if name not in MAY_DIFFER}


def numbers(tensor: dict, content: bytes) -> tuple[float, ...]:
    begin, end = tensor["data_offsets"]
    return tuple(number for (number,) in struct.iter_unpack("<" + LETTERS[tensor["dtype"]],
                                                            content[begin:end]))


def averaged(model: tuple[dict, bytes], further: tuple[dict, bytes]) -> bytes:
    """The further model's numbers, each the mean of both models'."""
    (header, content), (further_header, further_content) = model, further
    if network(header) != network(further_header):
        sys.exit("the models differ in features, scaling, camera or sizes")
    result = bytearray(further_content)
    for name, tensor in further_header.items():
        if name == "__metadata__":
            continue
        other = header.get(name, {})
        if (tensor["dtype"], tensor["shape"]) != (other.get("dtype"), other.get("shape")):
            sys.exit(f"{name} is not of one type and shape in both models")
        begin, end = tensor["data_offsets"]
        means = [(a + b) / 2
                 for a, b in zip(numbers(other, content), numbers(tensor, further_content))]
        result[begin:end] = struct.pack(f"<{len(means)}{LETTERS[tensor['dtype']]}", *means)
    return bytes(result)


def main() -> None:
    model, further, out = sys.argv[1:]
    header, content = read_model(further)
    means = averaged(read_model(model), (header, content))
    header["__metadata__"]["averaged_with"] = pathlib.Path(model).name
    write_model(out, header, means)


if __name__ == "__main__":
    main()

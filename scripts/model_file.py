"""A model's file, as bytes: a header of JSON, and the tensors' numbers behind it."""

import json
import pathlib
import struct


def read_model(path: str) -> tuple[dict, bytes]:
    content = pathlib.Path(path).read_bytes()
    (length,) = struct.unpack_from("<Q", content)
    return json.loads(content[8 : 8 + length]), content[8 + length :]


def write_model(path: str, header: dict, numbers: bytes) -> None:
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    pathlib.Path(path).write_bytes(struct.pack("<Q", len(text)) + text + numbers)
